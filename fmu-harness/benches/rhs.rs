//! Nanoseconds per evaluation of the right-hand side, over states of a run: `cargo bench --bench rhs`.

use cpu_time::ThreadTime;
use fmu_harness::scenes::Scenario;
use slidercrank::integrator::methods::Verner7;
use slidercrank::integrator::{Integrator, Settings};
use slidercrank::model::closed::Closed;
use slidercrank::model::open::Open;
use slidercrank::model::plant::Plant;
use slidercrank::model::start::StartPose;
use slidercrank::scene::Scene;
use std::hint::black_box;

/// States along a run at which the right-hand side is evaluated.
const STATES: usize = 2000;
/// Evaluations of each in one measurement.
const REPEATS: usize = 50;
/// Measurements, of which the least counts.
const MEASUREMENTS: usize = 7;

fn main() -> anyhow::Result<()> {
    println!("scene       states  events  ns per evaluation  share of states in contact");
    measure("ideal", |scene| Closed::<true, 0>::assemble(scene, 0.0))?;
    measure("wornpin", |scene| Open::<true, true, false, true, true, 4>::assemble(scene, 0.0))?;
    measure("guideplay", |scene| Open::<true, true, true, false, false, 6>::assemble(scene, 0.0))?;
    measure("press", |scene| Open::<false, false, false, false, false, 18>::assemble(scene, 0.0))?;
    measure("allplay", |scene| Open::<false, false, false, false, true, 16>::assemble(scene, 0.0))
}

fn measure<const N: usize, P: Plant<N>>(name: &str, assemble: impl Fn(&Scene) -> P) -> anyhow::Result<()> {
    let scene = Scenario::find(name)?.file.scene;
    let plant = assemble(&scene);
    let pose = StartPose::of(&scene).ok_or_else(|| anyhow::anyhow!("the loop of {name} does not close"))?;
    let y = plant.start(&pose);
    let settings = Settings { tolerance: 1e-6, fixed_step: 1e-6 };
    let contacts = plant.start_contacts(0.0, &y);
    let mut integrator = Integrator::<N, _, Verner7>::start(&plant, settings, 0.0, y, contacts);
    let mut fronts = Vec::new();
    while fronts.len() < STATES {
        integrator.advance(&plant, integrator.memory().front.t.next_up())?;
        fronts.push(integrator.memory().front);
    }
    let mut rates = [0.0; N];
    let mut least = f64::INFINITY;
    for _ in 0..MEASUREMENTS {
        let start = ThreadTime::now();
        for _ in 0..REPEATS {
            for front in &fronts {
                plant.rates(black_box(&front.modes), front.t, black_box(&front.y), &mut rates);
                black_box(&rates);
            }
        }
        least = least.min(start.elapsed().as_secs_f64() / (REPEATS * STATES) as f64);
    }
    let touching = fronts.iter().filter(|front| front.modes.iter().any(|mode| mode.closed)).count();
    let share = touching as f64 / STATES as f64;
    println!("{name:10}  {N:6}  {:6}  {:17.1}  {share:26.2}", plant.guard_count(), least * 1e9);
    Ok(())
}
