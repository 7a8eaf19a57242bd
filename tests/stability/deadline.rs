//! Deadlines that no motion can keep: it arrives nevertheless, with numbers, and says what it gave up.

use crate::run::{Trace, case, not_finite, run};
use slidercrank::scene::run::End;

/// Hard scenes, and the span [s] of each that takes long enough.
const HARD: [(&str, f64); 5] =
    [("chatter", 0.02), ("blanking", 0.02), ("friction", 0.02), ("fast", 2e-3), ("equal-worn", 0.02)];
/// [1/s] Three evaluations in each millisecond.
const HARDLY_ANY: f64 = 3e3;

#[test]
fn hard_scenes_arrive_within_next_to_no_evaluations() {
    for (name, span) in HARD {
        let mut file = case(name);
        let steps = (span / file.run.step).clamp(20.0, 200.0).round();
        (file.run.end, file.run.step) = (End::Time(span), span / steps);
        let free = run(&file);
        file.scene.solver.deadline = HARDLY_ANY;
        let hasty = run(&file);
        for trace in [&free, &hasty] {
            assert_eq!(trace.failure, None, "{name}");
            assert_eq!(trace.outputs.iter().find_map(not_finite), None, "{name}");
        }
        let estimate = |trace: &Trace| trace.greatest(|outputs| outputs.solver.error_estimate);
        let [calm, hurried] = [&free, &hasty].map(estimate);
        println!("{name}: estimates {calm:e} and {hurried:e}, {} steps too large", hasty.last().solver.deadline_hits);
        assert_eq!(free.last().solver.deadline_hits, 0, "{name}");
        assert!(hasty.last().solver.deadline_hits > 0, "{name}");
        assert!(hurried > 10.0 * calm, "{name}: {hurried:e} after {calm:e}");
    }
}

#[test]
fn an_implicit_step_that_has_not_converged_is_too_large_for_any_budget() {
    let flexrod = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fmu-harness/scenes/flexrod.toml");
    let text = std::fs::read_to_string(&flexrod).expect("a shipped scene");
    let mut file = slidercrank::scene::read::read(&text, "flexrod.toml").expect("a scene");
    (file.run.end, file.run.step) = (End::Time(0.04), 1e-5);
    for deadline in [4e5, 7e5, 1e6, 2e6] {
        file.scene.solver.deadline = deadline;
        let trace = run(&file);
        assert_eq!(trace.failure, None, "{deadline:e} evaluations a second");
        let farthest = trace.greatest(|outputs| outputs.slider.x.abs());
        assert!(farthest < 1.0, "{deadline:e} evaluations a second: {farthest:e} m");
    }
}
