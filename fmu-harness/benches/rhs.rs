//! Nanoseconds per evaluation of the right-hand side, at states along a run: `cargo bench --bench rhs`.

use fmu_harness::effects::evaluation;
use fmu_harness::scenes::{Scenario, directory, ladder, names};
use slidercrank::model::signals::Inputs;
use slidercrank::simulation::{Simulation, Size};

/// [s] Longest run.
const SPAN: f64 = 0.1;

fn main() -> anyhow::Result<()> {
    println!("scene                  degrees of freedom  states  event functions  ns per evaluation");
    for name in [names(&directory()), ladder()].concat() {
        let file = Scenario::find(&name)?.file;
        let simulation = Simulation::start(&file.scene, Inputs::at_start(&file))?;
        let Size { degrees_of_freedom, states, event_functions } = simulation.size();
        let nanoseconds = 1e9 * evaluation(simulation, file.run.stop(&file.scene).min(SPAN))?;
        println!("{name:22} {degrees_of_freedom:18}  {states:6}  {event_functions:15}  {nanoseconds:17.1}");
    }
    Ok(())
}
