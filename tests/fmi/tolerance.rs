//! Which tolerance is in use: the one that the importer set, else the experiment's, else the packaged one.

use host::{Slave, vr};
use slidercrank::fmi::v2::Status;

const USED: &str = "solver.tolerance_used";
const PACKAGED: f64 = 1e-6;

/// Calls of an importer.
type Calls = fn(&Slave);

fn set_up(slave: &Slave, tolerance: Option<f64>) {
    let defined = i32::from(tolerance.is_some());
    assert_eq!(slave.setup_raw(defined, tolerance.unwrap_or(1e-2), 0.0, 0, 0.0), Status::Ok);
}

fn own(slave: &Slave, tolerance: f64) {
    assert_eq!(slave.set("solver.tolerance", tolerance), Status::Ok);
}

/// The tolerance in use in initialization mode and after it, the evaluations of a short run, and where it leads.
fn run(prepare: impl Fn(&Slave), initialize: impl Fn(&Slave)) -> (f64, i32, Vec<u64>) {
    let slave = Slave::new();
    slave.wear();
    prepare(&slave);
    assert_eq!(slave.enter(), Status::Ok);
    initialize(&slave);
    let used = slave.get(USED);
    assert_eq!(slave.exit(), Status::Ok);
    assert_eq!(slave.get(USED), used);
    slave.steps(0.0, 0.01, 1);
    assert_eq!(slave.get(USED), used);
    (used, slave.get_integer("solver.evaluations"), slave.picture())
}

#[test]
fn a_tolerance_that_the_importer_sets_wins_whenever_it_is_set() {
    let nothing = |_: &Slave| ();
    let tight = run(|slave| own(slave, 1e-9), nothing);
    assert_eq!(tight.0, 1e-9);
    let orders: [(Calls, Calls); 4] = [
        // FMPy, whose experiment always has the model description's tolerance.
        (
            |slave| {
                set_up(slave, Some(PACKAGED));
                own(slave, 1e-9);
            },
            |_| (),
        ),
        // cofmupy, which sets values before it sets the experiment up.
        (
            |slave| {
                own(slave, 1e-9);
                set_up(slave, Some(PACKAGED));
            },
            |_| (),
        ),
        (|slave| set_up(slave, Some(1e-4)), |slave| own(slave, 1e-9)),
        (
            |slave| {
                own(slave, 1e-3);
                set_up(slave, Some(1e-4));
            },
            |slave| own(slave, 1e-9),
        ),
    ];
    for (prepare, initialize) in orders {
        assert_eq!(run(prepare, initialize), tight);
    }
    // The same value as the packaged one is a choice, too.
    let chosen = run(|slave| set_up(slave, Some(1e-9)), |slave| own(slave, PACKAGED));
    assert_eq!(chosen, run(nothing, nothing));
    assert_eq!(chosen.0, PACKAGED);
}

#[test]
fn the_experiments_tolerance_comes_before_the_packaged_one() {
    let nothing = |_: &Slave| ();
    let (tight, loose) = (run(|slave| set_up(slave, Some(1e-9)), nothing), run(|slave| set_up(slave, None), nothing));
    assert_eq!((tight.0, loose.0), (1e-9, PACKAGED));
    assert_eq!(tight, run(|slave| own(slave, 1e-9), nothing));
    assert!(loose.1 < tight.1);
    // A value that is refused is not set.
    let refused = |slave: &Slave| {
        set_up(slave, Some(1e-9));
        assert_eq!(slave.set("solver.tolerance", 1.0), Status::Error);
        assert_eq!(slave.set_all(&[vr("solver.tolerance"), vr("rod.length")], &[1e-3, -1.0]), Status::Error);
    };
    assert_eq!(run(refused, nothing), tight);
}

#[test]
fn the_choice_is_saved_restored_and_reset() {
    let slave = Slave::new();
    set_up(&slave, Some(1e-4));
    let mut unset = slave.save();
    own(&slave, 1e-9);
    let bytes = slave.bytes_of(slave.save());
    for (state, used) in [(unset, 1e-4), (slave.deserialize(&bytes).expect("its own state"), 1e-9)] {
        assert_eq!(slave.set_state(state), Status::Ok);
        assert_eq!(slave.enter(), Status::Ok);
        assert_eq!(slave.get(USED), used);
        assert_eq!(slave.exit(), Status::Ok);
        let running = slave.save();
        slave.steps(0.0, 1e-3, 1);
        assert_eq!(slave.set_state(running), Status::Ok);
        assert_eq!(slave.get(USED), used);
    }
    assert_eq!(slave.reset(), Status::Ok);
    set_up(&slave, Some(1e-4));
    assert_eq!(slave.enter(), Status::Ok);
    assert_eq!(slave.get(USED), 1e-4);
    assert_eq!(slave.free(&mut unset), Status::Ok);
}
