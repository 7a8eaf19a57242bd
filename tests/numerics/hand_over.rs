//! A step that cannot be made in one manner is made in another, long before it is as short as a rounding of time; and an
//! attempt that went astray does not lead the next one astray.

use slidercrank::integrator::methods::{Automatic, Cong8, Verner7};
use slidercrank::integrator::{
    Triggered, Effort, MAX_EVENTS, EventFunction, Integrator, Jacobian, Manner, Method, Problem, Reset, Settings,
};
use slidercrank::math::{Real, Row};

const SETTINGS: Settings = Settings { tolerance: 1e-8, fixed_step: 0.0, effort: Effort::ANY };

/// Two freedoms that pull at one another: q̈₀ = −pull·q₀ + bend·v₁², q̈₁ = −pull·q₁ + bend·v₀².
struct Pulled {
    pull: f64,
    bend: f64,
    /// [s] Until then eight states together have no rates.
    blind_until: f64,
}

impl Problem<4> for Pulled {
    type Modes = ();

    fn rates(&self, (): &(), _: f64, y: &[f64; 4], rates: &mut [f64; 4]) {
        let [q0, q1, v0, v1] = *y;
        *rates = [v0, v1, -self.pull * q0 + self.bend * v1 * v1, -self.pull * q1 + self.bend * v0 * v0];
    }

    fn rates_in_row(&self, (): &(), t: &Row, y: &[Row; 4], rates: &mut [Row; 4]) {
        slidercrank::integrator::one_by_one(self, &(), t, y, rates);
        if t.last() < self.blind_until {
            rates.fill(Row::constant(f64::NAN));
        }
    }

    fn suits_blocks(&self) -> bool {
        true
    }

    fn jacobian(&self, (): &(), _: f64, y: &[f64; 4], jacobian: &mut Jacobian<4>) {
        let [_, _, v0, v1] = *y;
        jacobian.state = [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-self.pull, 0.0, 0.0, 2.0 * self.bend * v1],
            [0.0, -self.pull, 2.0 * self.bend * v0, 0.0],
        ];
        jacobian.time = [0.0; 4];
    }

    fn scales(&self) -> &[f64; 4] {
        &[1.0; 4]
    }

    fn longest_step(&self) -> f64 {
        0.1
    }

    fn guard_count(&self) -> usize {
        0
    }

    fn guards(&self, (): &(), _: f64, _: &[f64; 4], _: &mut EventFunctions) {}

    fn guard_scale(&self) -> f64 {
        1.0
    }

    fn cross(&self, (): &(), _: f64, _: &mut [f64; 4], _: &Triggered) -> Reset<()> {
        Reset { modes: (), impact: None }
    }
}

/// Free for a second, so that steps get long; then pulled all at once, as an input's jump does it.
fn pulled_at_once<M: Method>(pull: f64, bend: f64) -> [f64; 4] {
    let free = Pulled { pull: 0.0, bend: 0.0, blind_until: 0.0 };
    let mut integrator = Integrator::<4, (), M>::start(&free, SETTINGS, 0.0, [1e-6, 0.0, 1e-3, -1e-3], ());
    integrator.advance(&free, 1.0).expect("nothing acts");
    integrator.rewind(&free, 1.0);
    let pulled = Pulled { pull, bend, blind_until: 0.0 };
    integrator.refresh(&pulled);
    let end = 1.0 + 0.5 / pull.sqrt();
    integrator.advance(&pulled, end).unwrap_or_else(|error| unreachable!("{} at {pull:e}, {bend:e}: {error}", M::NAME));
    integrator.state_at(&pulled, end).0
}

#[test]
fn a_pull_that_sets_in_at_once_is_met_however_strong_it_is() {
    for pull in [1e4, 1e8, 1e12] {
        for bend in [0.0, 1.0, 1e2] {
            let wanted = pulled_at_once::<Verner7>(pull, bend);
            for found in [pulled_at_once::<Cong8>(pull, bend), pulled_at_once::<Automatic>(pull, bend)] {
                let apart = found.iter().zip(&wanted).map(|(found, wanted)| (found - wanted).abs());
                let apart = apart.fold(0.0, f64::max);
                assert!(apart < 1e-5, "{found:?}, not {wanted:?}, at {pull:e}, {bend:e}");
            }
        }
    }
}

#[test]
fn a_step_that_no_block_makes_is_handed_over_and_blocks_come_back() {
    let problem = Pulled { pull: 1e4, bend: 0.0, blind_until: 0.5 };
    let start = [1.0, 0.0, 0.0, 0.0];
    let mut integrator = Integrator::<4, (), Automatic>::start(&problem, SETTINGS, 0.0, start, ());
    assert_eq!(integrator.memory().regime.manner, Manner::Block);
    integrator.advance(&problem, 0.1).expect("explicit steps are made");
    assert_eq!(integrator.memory().manner, Manner::Explicit);
    integrator.advance(&problem, 2.0).expect("explicit steps, then blocks are made");
    assert_eq!(integrator.memory().manner, Manner::Block, "they can be made again");
    let (y, ()) = integrator.state_at(&problem, 2.0);
    assert!((y[0] - 200.0_f64.cos()).abs() < 1e-4, "{y:?}");
    // No attempt came near a rounding of time.
    assert!(integrator.memory().statistics.rejected < 200, "{:?}", integrator.memory().statistics);
}

#[test]
fn a_step_that_nothing_makes_is_an_error_after_all() {
    let problem = Pulled { pull: 1e4, bend: f64::NAN, blind_until: 0.0 };
    let mut integrator = Integrator::<4, (), Automatic>::start(&problem, SETTINGS, 0.0, [1.0, 0.0, 0.0, 0.0], ());
    assert!(integrator.advance(&problem, 1.0).is_err());
}
