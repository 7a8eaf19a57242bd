//! Budgets of evaluations: kept in every interval, spent where errors are largest, the same for any communication steps.

use super::free::{Free, begin};
use slidercrank::integrator::{Account, Deadline, Integrator, Settings, WorkLimit};

const SETTINGS: Settings = Settings { tolerance: 1e-12, fixed_step: 0.0, effort: WorkLimit::ANY };
/// [s] Length of the intervals.
const INTERVAL: f64 = 0.5;
/// Number of intervals of a run.
const INTERVALS: u32 = 40;
/// Most evaluations of a step of `verner7` with its attempts, and so the most by which an interval exceeds its budget.
const STEP: u64 = 40;

type Accelerations = Box<dyn Fn(f64, &[f64], &[f64], &mut [f64])>;

/// q̈ = −ω²·q from q = 1 with ω = `slow`, and vibrations forced at ω = `fast` for about a tenth of every interval.
fn oscillator(fast: f64, slow: f64) -> Free<Accelerations, 2> {
    Free {
        accelerations: Box::new(move |t: f64, q: &[f64], _: &[f64], a: &mut [f64]| {
            let from_peak = ((t / INTERVAL).fract() - 0.5) / 0.05;
            let forced = fast * fast * (-from_peak * from_peak).exp() * (fast * t).cos();
            a[0] = forced - slow * slow * q[0];
        }),
    }
}

/// What a run came to.
struct Ran {
    /// Evaluations in each interval.
    spent: Vec<u64>,
    account: Account,
    /// Bits of the state at the end.
    bits: Vec<u64>,
    position: f64,
}

/// Runs the oscillator with a budget of so many evaluations in each interval, with `points` communication points in each.
fn run(fast: f64, slow: f64, budget: Option<f64>, points: u32) -> Ran {
    run_by("verner7", &oscillator(fast, slow), budget, points)
}

/// As [`run`], by another method and of another problem.
fn run_by(method: &str, problem: &Free<Accelerations, 2>, budget: Option<f64>, points: u32) -> Ran {
    let deadline = budget.map(|budget| Deadline { per_second: budget / INTERVAL, interval: INTERVAL });
    let mut integrator = begin(method, problem, SETTINGS, 0.0, [1.0, 0.0], ()).with_deadline(deadline);
    let spent_by = |integrator: &Integrator<()>| integrator.state().statistics.evaluations;
    let (mut spent, mut before) = (vec![], spent_by(&integrator));
    for interval in 0..INTERVALS {
        for point in 1..=points {
            let t = INTERVAL * (f64::from(interval) + f64::from(point) / f64::from(points));
            integrator.advance(problem, t).expect("a motion without trouble");
        }
        spent.push(spent_by(&integrator) - before);
        before = spent_by(&integrator);
    }
    let account = integrator.state().account;
    let y = integrator.state_at(problem, INTERVAL * f64::from(INTERVALS)).0.to_vec();
    Ran { spent, account, bits: y.iter().map(|y| y.to_bits()).collect(), position: y[0] }
}

#[test]
fn each_interval_keeps_its_budget_and_errors_grow_as_it_shrinks() {
    let free = run(0.0, 50.0, None, 1);
    let needed = free.spent.iter().max().copied().unwrap_or_default();
    let truth = (50.0 * INTERVAL * f64::from(INTERVALS)).cos();
    let mut errors = vec![(free.position - truth).abs()];
    let mut estimates = vec![free.account.error];
    for share in [2, 3, 4] {
        let budget = needed / share;
        let ran = run(0.0, 50.0, Some(budget as f64), 1);
        let most = ran.spent.iter().max().copied().unwrap_or_default();
        assert!(most <= budget + STEP, "{most} evaluations of {budget}");
        // An interval that leaves much unspent gives up accuracy for nothing.
        let least = ran.spent.iter().min().copied().unwrap_or_default();
        assert!(4 * least > 3 * budget, "{least} evaluations of {budget}");
        assert!(ran.account.hits > 0);
        errors.push((ran.position - truth).abs());
        estimates.push(ran.account.error);
    }
    assert!(errors.windows(2).all(|pair| pair[0] < pair[1]), "{errors:?}");
    assert!(estimates.windows(2).all(|pair| pair[0] < pair[1]), "{estimates:?}");
    // The sum of the errors of all steps bounds that of a motion that does not amplify them.
    assert!(errors.iter().zip(&estimates).all(|(error, estimate)| error < estimate), "{errors:?}, {estimates:?}");
    assert!(errors[2] < 1e-4, "a third of the evaluations: {errors:?}");
}

#[test]
fn an_implicit_method_converges_no_further_than_its_budget_allows() {
    let pendulum = Free {
        accelerations: Box::new(|_: f64, q: &[f64], _: &[f64], a: &mut [f64]| a[0] = -2500.0 * q[0].sin())
            as Accelerations,
    };
    let free = run_by("radau13", &pendulum, None, 1);
    let needed = free.spent.iter().max().copied().unwrap_or_default();
    for share in [2, 3] {
        let budget = needed / share;
        let ran = run_by("radau13", &pendulum, Some(budget as f64), 1);
        let most = ran.spent.iter().max().copied().unwrap_or_default();
        println!(
            "{most} evaluations of {budget}, {needed} without a deadline, error {:e}",
            ran.position - free.position
        );
        assert!(most <= budget, "{most} evaluations of {budget}");
        assert!((ran.position - free.position).abs() < 1e-2, "{:e}", ran.position - free.position);
    }
}

#[test]
fn a_budget_that_suffices_changes_no_bit() {
    let free = run(0.0, 50.0, None, 1);
    let needed = free.spent.iter().max().copied().unwrap_or_default() as f64;
    let ran = run(0.0, 50.0, Some(2.0 * needed), 1);
    assert_eq!((ran.bits, ran.account.hits, ran.spent), (free.bits, 0, free.spent));
}

#[test]
fn a_short_peak_is_paid_from_what_the_rest_of_the_interval_leaves() {
    // The peak takes most of what the interval needs, which is an eighth of the budget.
    let free = run(400.0, 3.0, None, 1);
    let needed = free.spent.iter().max().copied().unwrap_or_default() as f64;
    let ran = run(400.0, 3.0, Some(8.0 * needed), 1);
    assert_eq!((ran.account.hits, ran.bits), (0, free.bits));
}

#[test]
fn communication_points_make_no_difference() {
    let free = run(400.0, 20.0, None, 1);
    let needed = free.spent.iter().max().copied().unwrap_or_default() as f64;
    let [whole, split] = [1, 7].map(|points| run(400.0, 20.0, Some(needed / 2.0), points));
    assert!(whole.account.hits > 0);
    assert_eq!((whole.bits, whole.account.hits), (split.bits, split.account.hits));
}

#[test]
fn no_budget_is_too_small_to_arrive() {
    for budget in [1.0, 30.0] {
        let ran = run(0.0, 50.0, Some(budget), 1);
        assert!(ran.position.is_finite() && ran.account.hits > 0);
    }
}

#[test]
fn errors_are_counted_from_the_last_communication_point() {
    let problem = oscillator(0.0, 50.0);
    let mut integrator = begin("verner7", &problem, SETTINGS, 0.0, [1.0, 0.0], ());
    integrator.advance(&problem, 1.0).expect("a motion without trouble");
    let first = integrator.state().account.error;
    integrator.begin_interval();
    let begun = integrator.state().account.error;
    integrator.advance(&problem, 2.0).expect("a motion without trouble");
    let second = integrator.state().account.error;
    // As many steps in as long a time.
    assert!(first > 0.0 && begun == 0.0 && (0.5 * first..2.0 * first).contains(&second), "{first:e}, {second:e}");
}
