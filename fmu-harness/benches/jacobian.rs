//! Nanoseconds per Jacobian, and per evaluation of the right-hand side, at states along a run:
//! `cargo bench --bench jacobian`.

use fmu_harness::effects::fastest;
use fmu_harness::scenes::{Scenario, directory, ladder, names};
use slidercrank::model::signals::Inputs;
use slidercrank::simulation::{Simulation, Size};

/// [s] Longest run.
const SPAN: f64 = 0.02;
/// States on it.
const STATES: usize = 40;
/// Measurements at a state, of which the fastest counts, and calls in each.
const MEASUREMENTS: usize = 10;
const CALLS: usize = 50;

fn main() -> anyhow::Result<()> {
    println!("scene                  states  ns per evaluation  ns per Jacobian  ratio");
    for name in [names(&directory()), ladder()].concat() {
        let file = Scenario::find(&name)?.file;
        let mut simulation = Simulation::start(&file.scene, Inputs::at_start(&file))?;
        let Size { states, .. } = simulation.size();
        let span = file.run.stop(&file.scene).min(SPAN);
        let (mut evaluation, mut jacobian) = (0.0, 0.0);
        for state in 1..=STATES {
            simulation.advance_to(span * state as f64 / STATES as f64)?;
            evaluation += fastest(MEASUREMENTS, || simulation.evaluate(CALLS));
            jacobian += fastest(MEASUREMENTS, || simulation.differentiate(CALLS));
        }
        let per = 1e9 / (STATES * CALLS) as f64;
        let ratio = jacobian / evaluation;
        println!("{name:22} {states:6}  {:17.1}  {:15.0}  {ratio:5.1}", evaluation * per, jacobian * per);
    }
    Ok(())
}
