//! Our own methods, without an FMU and in the packaged FMU.

use super::ruler::choose;
use super::{Point, Ruler, Series, Task};
use crate::host::{Fmu, Setting};
use crate::inputs::Input;
use crate::package::Stock;
use crate::run::{Ending, Experiment, Look, March, Until, march};
use anyhow::{Result, ensure};
use cpu_time::ThreadTime;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::Method;
use slidercrank::simulation::Simulation;
use std::time::Duration;

/// The methods, the default first.
const METHODS: [(Method, &str); 6] = [
    (Method::Automatic, "automatic"),
    (Method::Cong8, "cong8"),
    (Method::Radau13, "radau13"),
    (Method::Verner7, "verner7"),
    (Method::Dop853, "dop853"),
    (Method::Dopri5, "dopri5"),
];
const TOLERANCES: [f64; 9] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
/// [s] Steps of Moreau's rule.
const STEPS: [f64; 8] = [1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7];
/// [s] Communication step of the FMU.
const STEP: f64 = 1e-4;
/// Number of runs. The fastest one counts.
const LEAST_RUNS: usize = 3;
const MOST_RUNS: usize = 200;
/// Runs are repeated until they have taken this long together.
const ENOUGH: Duration = Duration::from_millis(200);

/// Our series. The first one is that with which other programs are compared.
pub fn series(task: &Task, ruler: &Ruler, progress: &impl Fn(&str)) -> Result<Vec<Series>> {
    let mut all = vec![];
    for (method, name) in METHODS {
        progress(&format!("SliderCrank {name}"));
        let points =
            TOLERANCES.iter().map(|&tolerance| point(task, ruler, method, tolerance)).collect::<Result<_>>()?;
        all.push(Series { peer: "SliderCrank".into(), method: name.into(), rigid: false, points, notes: vec![] });
    }
    progress("SliderCrank FMU");
    let stock = Stock::build()?;
    let packaged = through_fmu(task, &all[0], &stock, "packaged FMU")?;
    let in_blocks = through_fmu(task, &all[1], &stock, "packaged FMU")?;
    let portable = through_fmu(task, &all[0], &stock.portable(), "portable FMU")?;
    all.splice(0..1, [packaged, all[0].clone(), portable, in_blocks]);
    Ok(all)
}

/// Our time stepping with rigid contacts, against the rigid `ruler`.
pub fn rigid(task: &Task, ruler: &Ruler) -> Result<Series> {
    let points = STEPS.iter().map(|&step| point(task, ruler, Method::Moreau, step)).collect::<Result<_>>()?;
    let note = format!("rigid impacts, as below; fixed steps; reference good to {:.0e}", ruler.own_error);
    Ok(Series { peer: "SliderCrank".into(), method: "moreau".into(), rigid: true, points, notes: vec![note] })
}

fn point(task: &Task, ruler: &Ruler, method: Method, tolerance: f64) -> Result<Point> {
    let error = ruler.error(&ruler.solve(task, method, tolerance)?);
    let mut scene = task.scenario.file.scene.clone();
    choose(&mut scene, method, tolerance);
    let mut evaluations = 0.0;
    let seconds = fastest(|| {
        let mut simulation = Simulation::start(&scene, Inputs::at_start(&task.scenario.file))?;
        let start = ThreadTime::now();
        simulation.advance_to(task.span)?;
        let spent = start.elapsed();
        evaluations = f64::from(simulation.outputs().solver.evaluations);
        Ok(spent)
    })?;
    Ok(Point { tolerance, error, cost: seconds / task.span, evaluations: evaluations / task.span })
}

/// The method of `core` in an FMU with the libraries of `stock`. Its steps and errors are those of `core`, except for
/// rounding in a library for newer processors.
fn through_fmu(task: &Task, core: &Series, stock: &Stock, name: &str) -> Result<Series> {
    let directory = tempfile::tempdir()?;
    let file = directory.path().join("peers.fmu");
    stock.package(&task.scenario)?.save(&file)?;
    let fmu = Fmu::open(&file)?;
    let mut points = vec![];
    for point in &core.points {
        let experiment = Experiment {
            settings: vec![Setting { name: "solver.method".into(), value: core.method.clone() }],
            inputs: Input::constant(Inputs::at_start(&task.scenario.file)),
            start: 0.0,
            until: Until::Time(task.span),
            step: STEP,
            tolerance: Some(point.tolerance),
        };
        let seconds = fastest(|| {
            let March { spent, ending, .. } = march(&fmu, &experiment, Look::AtEnds, Duration::MAX)?;
            ensure!(ending == Ending::Reached, "the run of the packaged FMU ended early: {ending:?}");
            Ok(spent)
        })?;
        points.push(Point { cost: seconds / task.span, ..*point });
    }
    let method = format!("{}, {name}", core.method);
    let notes = vec![format!("communication steps of {:.0} µs", STEP * 1e6)];
    Ok(Series { peer: "SliderCrank".into(), method, rigid: false, points, notes })
}

/// [s] Time of the fastest of several runs.
fn fastest(mut run: impl FnMut() -> Result<Duration>) -> Result<f64> {
    let (mut least, mut total) = (Duration::MAX, Duration::ZERO);
    for count in 1..=MOST_RUNS {
        let spent = run()?;
        (least, total) = (least.min(spent), total + spent);
        if count >= LEAST_RUNS && total >= ENOUGH {
            break;
        }
    }
    Ok(least.as_secs_f64())
}
