//! Steps that end at discontinuities of the rates: sliding that turns round, against its closed form.

use super::free::begin;
use slidercrank::integrator::{
    Discontinuities, Events, Linearizable, Ode, Settings, SeveralInstants, StateLayout, Statistics, WorkLimit,
};

/// Of the speeds over which friction turns round.
const WIDTH: f64 = 1e-2;
const PUSH: f64 = 2.0;
const FRICTION: f64 = 1.0;
const END: f64 = 1.0;

/// A body that moves along a line.
struct Sliding {
    /// By its speed.
    acceleration: fn(f64) -> f64,
    /// Speeds at corners of that, as far as the integrator is told.
    corners: &'static [f64],
}

/// Of a body on a table, pushed: v̇ = PUSH − FRICTION·clamp(v/WIDTH, −1, 1).
fn rubbing(v: f64) -> f64 {
    PUSH - FRICTION * (v / WIDTH).clamp(-1.0, 1.0)
}

impl Ode for Sliding {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(2)
    }

    fn rates(&self, (): &(), _: f64, y: &[f64], rates: &mut [f64]) {
        rates.copy_from_slice(&[y[1], (self.acceleration)(y[1])]);
    }

    fn scales(&self) -> &[f64] {
        &[1.0, 1.0]
    }

    fn longest_step(&self) -> f64 {
        0.1
    }
}

impl Linearizable for Sliding {}

impl SeveralInstants for Sliding {}

impl Events for Sliding {
    fn discontinuities(&self, (): &(), _: f64, y: &[f64], functions: &mut Discontinuities) {
        for corner in self.corners {
            functions.push(y[1] - corner);
        }
    }
}

/// Speed at the end of a slide that starts at −1: at PUSH + FRICTION up to −WIDTH, on
/// v = w·(2 − 3·e^(−t/w)) for w·ln 3 up to WIDTH, and at PUSH − FRICTION from there.
fn exact() -> f64 {
    WIDTH + END - (1.0 - WIDTH) / 3.0 - WIDTH * 3f64.ln()
}

/// Error of the speed at the end, and the work.
fn slide(method: &str, tells: bool, tolerance: f64) -> (f64, Statistics) {
    let problem = Sliding { acceleration: rubbing, corners: if tells { &[WIDTH, -WIDTH] } else { &[] } };
    let settings = Settings { tolerance, fixed_step: 0.0, effort: WorkLimit::ANY };
    let mut integrator = begin(method, &problem, settings, 0.0, [0.0, -1.0], ());
    integrator.advance(&problem, END).expect("a motion without trouble");
    let (y, ()) = integrator.state_at(&problem, END);
    ((y[1] - exact()).abs(), integrator.state().statistics)
}

#[test]
fn a_step_that_fails_ends_at_the_kink_that_it_fails_by() {
    /// With a method.
    fn compare(method: &str) {
        for tolerance in [1e-8, 1e-9, 1e-10] {
            let [(blind, searched), (error, told)] = [false, true].map(|tells| slide(method, tells, tolerance));
            println!("{} at {tolerance:e}: {blind:.1e} in {searched:?}, told {error:.1e} in {told:?}", method);
            assert!(error <= 10.0 * tolerance, "{}: {error:e} at {tolerance:e}", method);
            let work = told.evaluations as f64 / searched.evaluations as f64;
            assert!(work < 0.9, "{} at {tolerance:e}: {told:?} against {searched:?}", method);
            // The second corner is foreseen from the first.
            let failed = told.rejected as f64 / searched.rejected as f64;
            assert!(failed < 0.67, "{} at {tolerance:e}: {told:?} against {searched:?}", method);
        }
    }
    compare("dopri5");
    compare("verner7");
    compare("dop853");
}

/// A body that is pushed against a damper from a corner on: v̇ = GENTLE − RATE·max(v, 0) settles just beyond the corner,
/// so close that every step beyond its stability has the corner in it.
fn creeping(v: f64) -> f64 {
    GENTLE - RATE * v.max(0.0)
}

const GENTLE: f64 = 1e-2;
const RATE: f64 = 1e6;

#[test]
fn a_motion_that_creeps_along_a_kink_is_not_cut_to_pieces() {
    for tolerance in [1e-5, 1e-6, 1e-7, 1e-8, 1e-9] {
        let [blind, told] = [false, true].map(|tells| {
            let problem = Sliding { acceleration: creeping, corners: if tells { &[0.0] } else { &[] } };
            let settings = Settings { tolerance, fixed_step: 0.0, effort: WorkLimit::ANY };
            let mut integrator = begin("verner7", &problem, settings, 0.0, [0.0, -1e-6], ());
            integrator.advance(&problem, 0.01).expect("a motion without trouble");
            integrator.state().statistics
        });
        println!("at {tolerance:e}: {blind:?}, told {told:?}");
        assert!(told.evaluations < 2 * blind.evaluations, "at {tolerance:e}: {told:?} against {blind:?}");
    }
}
