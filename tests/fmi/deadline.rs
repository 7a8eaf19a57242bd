//! A deadline through the interface: its evaluations, its outputs, and the methods that refuse it.

use host::Slave;
use slidercrank::fmi::v2::Status;

/// [s] Communication step.
const STEP: f64 = 1e-3;
/// Number of communication steps.
const COUNT: u32 = 40;
/// Largest excess over a budget, as a share of it, where contacts open and close in a step: the mean of neighbouring motions, of
/// which rounding chooses one (measured: 0.12 to 0.23).
const EXCESS: f64 = 0.2;
/// The same for each of them.
const LARGEST_EXCESS: f64 = 0.3;
/// Number of neighbouring motions.
const NEIGHBOURS: u32 = 16;

/// The evaluations of each communication step, the largest estimate of an error and the number of hits. The clearance is longer
/// by `neighbour` millionths.
fn run(deadline: f64, neighbour: u32) -> (Vec<i32>, f64, i32) {
    let slave = Slave::new();
    slave.wear();
    assert_eq!(slave.set("joint.C.clearance", 0.5e-3 * (1.0 + 1e-6 * f64::from(neighbour))), Status::Ok);
    assert_eq!(slave.set("solver.deadline", deadline), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    assert_eq!((slave.get("solver.error_estimate"), slave.get_integer("solver.deadline_hits")), (0.0, 0));
    let (mut spent, mut before, mut estimate) = (vec![], slave.get_integer("solver.evaluations"), 0.0_f64);
    let mut time = 0.0;
    for _ in 0..COUNT {
        time = slave.steps(time, STEP, 1);
        let now = slave.get_integer("solver.evaluations");
        spent.push(now - before);
        before = now;
        estimate = estimate.max(slave.get("solver.error_estimate"));
    }
    (spent, estimate, slave.get_integer("solver.deadline_hits"))
}

#[test]
fn every_communication_step_keeps_its_evaluations_and_tells_what_it_gave_up() {
    let shares = (0..NEIGHBOURS).map(|neighbour| {
        let (free, calm, none) = run(0.0, neighbour);
        assert_eq!(none, 0);
        assert!(calm > 0.0 && calm < 1e-3, "{calm:e}");
        let budget = free.into_iter().max().unwrap_or_default() / 2;
        let (spent, estimate, hits) = run(f64::from(budget) / STEP, neighbour);
        assert!(hits > 0 && estimate > calm, "{hits} hits, {estimate:e} after {calm:e}");
        f64::from(spent.into_iter().max().unwrap_or_default()) / f64::from(budget)
    });
    let shares: Vec<f64> = shares.collect();
    let mean = shares.iter().sum::<f64>() / f64::from(NEIGHBOURS);
    assert!(mean <= 1.0 + EXCESS, "{mean} of {shares:?}");
    assert!(shares.iter().all(|share| *share <= 1.0 + LARGEST_EXCESS), "{shares:?}");
}

#[test]
fn methods_with_a_fixed_step_refuse_a_deadline() {
    for method in [4, 6, 8, 11] {
        let slave = Slave::new();
        slave.wear();
        assert_eq!(slave.set("solver.deadline", 1e6), Status::Ok);
        assert_eq!(slave.set_integer("solver.method", method), Status::Ok);
        assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Error));
        let text = slave.log.only().text;
        assert!(text.contains("solver.deadline = 1e6") && text.contains("0 for method "), "{text}");
    }
}
