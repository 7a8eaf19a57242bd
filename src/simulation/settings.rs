//! What a scene asks of its integrator.

use crate::integrator::{Settings, WorkLimit};
use crate::scene::{Scene, Solver};

/// Where the scene sets no bound: seconds of computing for a communication step that leads nowhere, and several times
/// what any shipped scene needs.
const EFFORT: WorkLimit = WorkLimit { base: 20_000_000, per_second: 50_000_000 };

/// What a scene asks of its integrator.
pub fn settings(scene: &Scene) -> Settings {
    let Solver { tolerance, step, max_evaluations, .. } = scene.solver;
    let effort = match u64::try_from(max_evaluations) {
        Ok(base @ 1..) => WorkLimit { base, per_second: 0 },
        _ => EFFORT,
    };
    Settings { tolerance, fixed_step: step, effort }
}
