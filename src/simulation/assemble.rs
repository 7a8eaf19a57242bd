//! Chooses the compiled mechanism and method that a scene calls for.

use super::run::{Motion, Run};
use super::time_stepping::TimeStepping;
use crate::integrator::ROOM;
use crate::integrator::methods::{Automatic, Bs3, Cong8, Dop853, Dopri5, Rk4, Rk4Unlocated, Rodas4, Verner7};
use crate::model::audit::{self, Audited};
use crate::model::bristles::bristled_contacts;
use crate::model::drive::InputSignal;
use crate::model::flexible::{Flexible, most_equations, state_count};
use crate::model::plant::Plant;
use crate::model::rigid::Rigid;
use crate::model::rod::{FEW_MODES, Rod, most_functions};
use crate::model::start::StartPose;
use crate::model::structure::{Structure, Topology};
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
                $with::<N, _>(scene, time, pose, signal, plant)
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
    /// The mechanism with a rigid rod in arrays of so many states where there are exactly as many.
    macro_rules! rigid {
        ($($states:literal)*) => {
            match 2 * Structure::new(Topology::of(scene)).positions {
                $($states if !has_extra_states(scene) => {
                    with_method::<$states, _>(scene, time, pose, signal, Rigid::<$states>::assemble(scene, time))
                })*
                _ => with_audit::<ROOM, _>(scene, time, pose, signal, Rigid::<ROOM>::assemble(scene, time)),
            }
        };
    }
    rigid!(0 2 4 6 8 10 12 14 16 18)
}

/// The scene calls for states beside positions and rates.
fn has_extra_states(scene: &Scene) -> bool {
    scene.energy.audit || !bristled_contacts(scene).is_empty()
}

/// Reckons the energy up where the scene asks for it.
fn with_audit<const N: usize, P: Plant<N> + 'static>(
    scene: &Scene,
    time: f64,
    pose: &StartPose,
    signal: InputSignal,
    plant: P,
) -> Box<dyn Motion> {
    if scene.energy.audit {
        with_method::<N, _>(scene, time, pose, signal, Audited::new(scene, Box::new(plant)))
    } else {
        with_method::<N, _>(scene, time, pose, signal, plant)
    }
}

/// A method is compiled once for every number of states and calls the mechanism through a table of
/// functions: that spares a hundred copies of the integrator. Only the loop over a step's stages is compiled
/// for each small mechanism on its own; see [`Problem::stages`](crate::integrator::Problem::stages).
fn with_method<const N: usize, P: Plant<N> + 'static>(
    scene: &Scene,
    time: f64,
    pose: &StartPose,
    signal: InputSignal,
    mut plant: P,
) -> Box<dyn Motion> {
    plant.set_signal(signal);
    let plant: Box<dyn Plant<N>> = Box::new(plant);
    match scene.solver.method {
        Method::Automatic => Box::new(Run::<N, Automatic>::start(scene, time, pose, plant)),
        Method::Cong8 => Box::new(Run::<N, Cong8>::start(scene, time, pose, plant)),
        Method::Dopri5 => Box::new(Run::<N, Dopri5>::start(scene, time, pose, plant)),
        Method::Verner7 => Box::new(Run::<N, Verner7>::start(scene, time, pose, plant)),
        Method::Dop853 => Box::new(Run::<N, Dop853>::start(scene, time, pose, plant)),
        Method::Rk4 => Box::new(Run::<N, Rk4>::start(scene, time, pose, plant)),
        Method::Bs3 => Box::new(Run::<N, Bs3>::start(scene, time, pose, plant)),
        Method::Rodas4 => Box::new(Run::<N, Rodas4>::start(scene, time, pose, plant)),
        Method::Rk4Unlocated => Box::new(Run::<N, Rk4Unlocated>::start(scene, time, pose, plant)),
        Method::Moreau => Box::new(TimeStepping::<N>::start(scene, time, pose, plant)),
    }
}
