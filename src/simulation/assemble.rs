//! Chooses the compiled mechanism and method that a scene calls for.

use super::motion::Motion;
use super::run::Run;
use super::time_stepping::TimeStepping;
use crate::model::audit::{self, Audited};
use crate::model::bristles::bristled_contacts;
use crate::model::drive::InputSignal;
use crate::model::flexible::{Flexible, most_equations, state_count};
use crate::model::plant::{Plant, ROOM};
use crate::model::rigid::Rigid;
use crate::model::rod::{FEW_MODES, Rod, most_functions};
use crate::model::start::StartPose;
use crate::scene::modal::MOST_MODES;
use crate::scene::{Method, Scene};

/// Room for every mechanism: 9 rigid freedoms, 16 modes, 7 bristles, an audit.
const LARGE: usize = 64;

/// Starts the mechanism of `scene` at `time` [s] from `pose`.
pub fn start(scene: &Scene, time: f64, pose: &StartPose, signal: InputSignal) -> Box<dyn Motion> {
    if let Some(rod) = Rod::new(scene) {
        /// The flexible mechanism in arrays of these sizes.
        macro_rules! flexible {
            ($n:expr, $modes:expr, $with:ident) => {{
                const N: usize = $n;
                const MODES: usize = $modes;
                let plant = Flexible::<N, { most_equations(MODES) }, MODES, { most_functions(MODES) }>::assemble(
                    scene, time, rod,
                );
                $with(scene, time, pose, signal, plant)
            }};
        }
        let audit = if scene.energy.audit { audit::STATES } else { 0 };
        let (modes, states) = (rod.modes(), state_count(scene, &rod) + audit);
        if modes > MOST_MODES {
            return flexible!(LARGE, 2 * MOST_MODES, with_audit);
        } else if modes > FEW_MODES || states > ROOM {
            return flexible!(LARGE, MOST_MODES, with_audit);
        }
        /// In arrays of so many states where there are exactly as many.
        macro_rules! few {
            ($($states:literal)*) => {
                match states {
                    $($states if !has_extra_states(scene) => flexible!($states, FEW_MODES, with_method),)*
                    _ => flexible!(ROOM, FEW_MODES, with_audit),
                }
            };
        }
        return few!(2 4 6 8 10 12 14);
    }
    with_audit(scene, time, pose, signal, Rigid::assemble(scene, time))
}

/// The scene calls for states beside positions and rates.
fn has_extra_states(scene: &Scene) -> bool {
    scene.energy.audit || !bristled_contacts(scene).is_empty()
}

/// Reckons the energy up where the scene asks for it.
fn with_audit<P: Plant + 'static>(
    scene: &Scene,
    time: f64,
    pose: &StartPose,
    signal: InputSignal,
    plant: P,
) -> Box<dyn Motion> {
    if scene.energy.audit {
        with_method(scene, time, pose, signal, Audited::new(scene, Box::new(plant)))
    } else {
        with_method(scene, time, pose, signal, plant)
    }
}

/// Integrators are compiled once and call the mechanism through a table of functions. Only the loop over a step's stages
/// is compiled for some small mechanisms on its own; see [`Ode::stages`](crate::integrator::Ode::stages).
fn with_method<P: Plant + 'static>(
    scene: &Scene,
    time: f64,
    pose: &StartPose,
    signal: InputSignal,
    plant: P,
) -> Box<dyn Motion> {
    let mut plant: Box<dyn Plant> = Box::new(plant);
    plant.set_signal(signal);
    match scene.solver.method {
        Method::Moreau => Box::new(TimeStepping::start(scene, time, pose, plant)),
        _ => Box::new(Run::start(scene, time, pose, plant)),
    }
}
