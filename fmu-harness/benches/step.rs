//! Work against accuracy of each adaptive method on each scene, without an FMU around it:
//! `cargo bench --bench step`. The error is the slider's and the rod's over the first milliseconds, before
//! the motion decorrelates, against the order-8 method at a hundredth of the least tolerance.

use cpu_time::ThreadTime;
use fmu_harness::scenes::Scenario;
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{Method, Scene};
use slidercrank::simulation::Simulation;

/// Scene, seconds over which the error is measured, seconds over which the time is.
const SCENES: [(&str, f64, f64); 5] = [
    ("ideal", 0.012, 0.24),
    ("wornpin", 0.012, 0.24),
    ("guideplay", 0.06, 0.4),
    ("allplay", 0.01, 0.08),
    ("press", 0.004, 0.05),
];
const METHODS: [(Method, &str); 3] =
    [(Method::Dopri5, "dopri5"), (Method::Automatic, "automatic"), (Method::Dop853, "dop853")];
const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];
/// Points at which the error is measured.
const POINTS: usize = 1200;

fn main() -> anyhow::Result<()> {
    println!(
        "scene      method   tolerance  error [um]  CPU s/s  x real time  steps/s  evaluations/s  ns/evaluation  events/s"
    );
    for (name, window, span) in SCENES {
        let scene = Scenario::find(name)?.file.scene;
        let reference = run(&scene, Method::Dop853, 1e-12, window, POINTS)?.0;
        for (method, label) in METHODS {
            for tolerance in TOLERANCES {
                let found = run(&scene, method, tolerance, window, POINTS)?.0;
                let error = found.iter().zip(&reference).map(|(a, b)| distance(&scene, a, b)).fold(0.0, f64::max);
                let (outputs, seconds) = run(&scene, method, tolerance, span, (span / 1e-3) as usize)?;
                let Some(last) = outputs.last().map(|outputs| outputs.solver) else { continue };
                println!(
                    "{name:10} {label:8} {tolerance:9.0e}  {:10.1e}  {:7.4}  {:11.1}  {:7.0}  {:13.0}  {:13.1}  {:8.0}",
                    error * 1e6,
                    seconds / span,
                    span / seconds,
                    f64::from(last.steps) / span,
                    f64::from(last.evaluations) / span,
                    seconds / f64::from(last.evaluations) * 1e9,
                    f64::from(last.events) / span,
                );
            }
        }
    }
    Ok(())
}

/// Outputs at equal distances, and the CPU time that they took.
fn run(scene: &Scene, method: Method, tolerance: f64, span: f64, points: usize) -> anyhow::Result<(Vec<Outputs>, f64)> {
    let mut scene = scene.clone();
    scene.solver.method = method;
    scene.solver.tolerance = tolerance;
    let mut simulation = Simulation::start(&scene, Inputs::default())?;
    let start = ThreadTime::now();
    let outputs = (1..=points)
        .map(|point| {
            simulation.advance_to(span * point as f64 / points as f64)?;
            Ok(simulation.outputs())
        })
        .collect::<anyhow::Result<_>>()?;
    Ok((outputs, start.elapsed().as_secs_f64()))
}

/// [m] Slider position, and rod angle times its length.
fn distance(scene: &Scene, a: &Outputs, b: &Outputs) -> f64 {
    let slider = (a.slider.x - b.slider.x).abs();
    slider.max(scene.rod.length * (a.rod.angle - b.rod.angle).abs())
}
