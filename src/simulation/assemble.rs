//! Chooses the compiled mechanism and method that a scene calls for.

use super::run::{Motion, Run};
use super::time_stepping::TimeStepping;
use crate::model::audit::{self, Audited};
use crate::model::bristles::bristled_contacts;
use crate::model::closed::Closed;
use crate::model::drive::InputSignal;
use crate::model::flexible::{Flexible, most_equations, state_count};
use crate::model::mechanism::Topology;
use crate::model::open::Open;
use crate::model::plant::{Plant, ROOM};
use crate::model::rod::{FEW_MODES, Rod, most_functions};
use crate::model::start::StartPose;
use crate::scene::modal::MOST_MODES;
use crate::scene::{Method, Scene};

/// Room for every mechanism: 9 rigid freedoms, 16 modes, 7 bristles, an audit.
const LARGE: usize = 64;

/// Starts the mechanism of `scene` at `time` [s] from `pose`.
pub fn start(scene: &Scene, time: f64, pose: &StartPose, signal: InputSignal) -> Box<dyn Motion> {
    /// The open mechanism whose ideal joints and drive are these literals.
    macro_rules! open {
        ($a:literal, $b:literal, $c:literal, $t:literal, $speed:literal) => {{
            const N: usize = 2 * Topology { a: $a, b: $b, c: $c, t: $t, speed: $speed }.freedoms();
            if has_extra_states(scene) {
                let plant = Open::<$a, $b, $c, $t, $speed, ROOM>::assemble(scene, time);
                with_audit(scene, time, pose, signal, plant)
            } else {
                let plant = Open::<$a, $b, $c, $t, $speed, N>::assemble(scene, time);
                with_method(scene, time, pose, signal, plant)
            }
        }};
    }
    /// Both drives.
    macro_rules! driven {
        ($speed:expr, $a:literal, $b:literal, $c:literal, $t:literal) => {
            if $speed { open!($a, $b, $c, $t, true) } else { open!($a, $b, $c, $t, false) }
        };
    }
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
    let Topology { a, b, c, t, speed } = Topology::of(scene);
    match (a, b, c, t) {
        (true, true, true, true) if scene.energy.audit && speed => {
            with_audit(scene, time, pose, signal, Closed::<true, ROOM>::assemble(scene, time))
        }
        (true, true, true, true) if scene.energy.audit => {
            with_audit(scene, time, pose, signal, Closed::<false, ROOM>::assemble(scene, time))
        }
        (true, true, true, true) if speed => {
            let plant = Closed::<true, 0>::assemble(scene, time);
            with_method(scene, time, pose, signal, plant)
        }
        (true, true, true, true) => {
            let plant = Closed::<false, 2>::assemble(scene, time);
            with_method(scene, time, pose, signal, plant)
        }
        (true, true, true, false) => driven!(speed, true, true, true, false),
        (true, true, false, true) => driven!(speed, true, true, false, true),
        (true, true, false, false) => driven!(speed, true, true, false, false),
        (true, false, true, true) => driven!(speed, true, false, true, true),
        (true, false, true, false) => driven!(speed, true, false, true, false),
        (true, false, false, true) => driven!(speed, true, false, false, true),
        (true, false, false, false) => driven!(speed, true, false, false, false),
        (false, true, true, true) => driven!(speed, false, true, true, true),
        (false, true, true, false) => driven!(speed, false, true, true, false),
        (false, true, false, true) => driven!(speed, false, true, false, true),
        (false, true, false, false) => driven!(speed, false, true, false, false),
        (false, false, true, true) => driven!(speed, false, false, true, true),
        (false, false, true, false) => driven!(speed, false, false, true, false),
        (false, false, false, true) => driven!(speed, false, false, false, true),
        (false, false, false, false) => driven!(speed, false, false, false, false),
    }
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
/// is compiled for each small mechanism on its own; see [`Ode::stages`](crate::integrator::Ode::stages).
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
