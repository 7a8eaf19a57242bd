//! Settings of the integrator from a scene.

use crate::integrator::{Deadline, Settings, WorkLimit};
use crate::scene::{Scene, Solver};

/// Work limit if the scene sets none: seconds of computation in a communication step that does not end, and several
/// times the work of any scene that is shipped.
const DEFAULT_WORK_LIMIT: WorkLimit = WorkLimit { base: 20_000_000, per_second: 50_000_000 };

/// Settings of the integrator from a scene.
pub fn settings(scene: &Scene) -> Settings {
    let Solver { tolerance, step, max_evaluations, .. } = scene.solver;
    let effort = match u64::try_from(max_evaluations) {
        Ok(base @ 1..) => WorkLimit { base, per_second: 0 },
        _ => DEFAULT_WORK_LIMIT,
    };
    Settings { tolerance, fixed_step: step, effort }
}

/// The budget of evaluations that a scene gives, if it gives one. Less than one a second is as little.
pub fn deadline(scene: &Scene) -> Option<Deadline> {
    let Solver { deadline, deadline_interval, .. } = scene.solver;
    (deadline > 0.0).then_some(Deadline { per_second: deadline.max(1.0), interval: deadline_interval })
}
