//! Deadlines that no motion can keep: it arrives nevertheless, with numbers, and says what it gave up.

use crate::run::{Trace, case, not_finite, run, shipped};
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

/// In the two hard milliseconds of `oilpress` its guide is stiff: explicit steps of any tolerance take 17 000 evaluations a
/// millisecond, implicit ones of the nominal tolerance 1 800.
#[test]
fn a_stiff_motion_keeps_its_budget_since_the_method_remains_implicit() {
    let mut file = shipped("oilpress");
    (file.run.end, file.run.step) = (End::Time(0.11), 1e-3);
    for deadline in [1e6, 2e6, 4e6] {
        file.scene.solver.deadline = deadline;
        let trace = run(&file);
        assert_eq!(trace.failure, None, "{deadline:e} evaluations a second");
        let spent = trace.outputs.windows(2).map(|pair| pair[1].solver.evaluations - pair[0].solver.evaluations);
        let most = f64::from(spent.max().unwrap_or_default());
        println!("{most} evaluations of {:e}", deadline * file.run.step);
        assert!(most < 1.5 * deadline * file.run.step, "{most} evaluations of {:e}", deadline * file.run.step);
    }
}

#[test]
fn an_implicit_step_that_has_not_converged_is_too_large_for_any_budget() {
    let mut file = shipped("flexrod");
    (file.run.end, file.run.step) = (End::Time(0.04), 1e-5);
    for deadline in [4e5, 7e5, 1e6, 2e6] {
        file.scene.solver.deadline = deadline;
        let trace = run(&file);
        assert_eq!(trace.failure, None, "{deadline:e} evaluations a second");
        let farthest = trace.greatest(|outputs| outputs.slider.x.abs());
        assert!(farthest < 1.0, "{deadline:e} evaluations a second: {farthest:e} m");
    }
}
