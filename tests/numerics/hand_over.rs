//! A step that cannot be made in one manner is made in another, long before it is as short as a rounding of time; and an
//! attempt that went astray does not lead the next one astray.

use super::free::begin;
use slidercrank::integrator::system::one_by_one;
use slidercrank::integrator::{
    Events, Integrator, Jacobian, Linearizable, MethodKind, Ode, Settings, SeveralInstants, StateLayout, WorkLimit,
};
use slidercrank::math::{F64x8, Real};

const SETTINGS: Settings = Settings { tolerance: 1e-8, fixed_step: 0.0, effort: WorkLimit::ANY };

/// Two freedoms that pull at one another: q̈₀ = −pull·q₀ + bend·v₁², q̈₁ = −pull·q₁ + bend·v₀².
struct Pulled {
    pull: f64,
    bend: f64,
    /// [s] Until then eight states together have no rates.
    blind_until: f64,
}

impl Ode for Pulled {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(4)
    }

    fn rates(&self, (): &(), _: f64, y: &[f64], rates: &mut [f64]) {
        let [q0, q1, v0, v1] = [y[0], y[1], y[2], y[3]];
        let forced = [-self.pull * q0 + self.bend * v1 * v1, -self.pull * q1 + self.bend * v0 * v0];
        rates.copy_from_slice(&[v0, v1, forced[0], forced[1]]);
    }

    fn scales(&self) -> &[f64] {
        &[1.0; 4]
    }

    fn longest_step(&self) -> f64 {
        0.1
    }
}

impl SeveralInstants for Pulled {
    fn rates_in_row(&self, (): &(), t: &F64x8, y: &[F64x8], rates: &mut [F64x8]) {
        one_by_one(&|t, y, rates| self.rates(&(), t, y, rates), t, y, rates);
        if t.last() < self.blind_until {
            rates.fill(F64x8::constant(f64::NAN));
        }
    }

    fn suits_blocks(&self) -> bool {
        true
    }
}

impl Linearizable for Pulled {
    fn jacobian(&self, (): &(), _: f64, y: &[f64], jacobian: &mut Jacobian) {
        let rows = [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-self.pull, 0.0, 0.0, 2.0 * self.bend * y[3]],
            [0.0, -self.pull, 2.0 * self.bend * y[2], 0.0],
        ];
        for (i, row) in rows.iter().enumerate() {
            jacobian.row_mut(i).copy_from_slice(row);
        }
        jacobian.time.fill(0.0);
    }
}

impl Events for Pulled {}

/// Free for a second, so that steps get long; then pulled all at once, as an input's jump does it.
fn pulled_at_once(method: &str, pull: f64, bend: f64) -> [f64; 4] {
    let free = Pulled { pull: 0.0, bend: 0.0, blind_until: 0.0 };
    let mut integrator = begin(method, &free, SETTINGS, 0.0, [1e-6, 0.0, 1e-3, -1e-3], ());
    integrator.advance(&free, 1.0).expect("nothing acts");
    integrator.truncate(&free, 1.0);
    let pulled = Pulled { pull, bend, blind_until: 0.0 };
    integrator.set_discrete(&pulled, ());
    let end = 1.0 + 0.5 / pull.sqrt();
    integrator.advance(&pulled, end).unwrap_or_else(|error| unreachable!("{method} at {pull:e}, {bend:e}: {error}"));
    let (y, ()) = integrator.state_at(&pulled, end);
    [y[0], y[1], y[2], y[3]]
}

#[test]
fn a_pull_that_sets_in_at_once_is_met_however_strong_it_is() {
    for pull in [1e4, 1e8, 1e12] {
        for bend in [0.0, 1.0, 1e2] {
            let wanted = pulled_at_once("verner7", pull, bend);
            for method in ["cong8", "automatic"] {
                let found = pulled_at_once(method, pull, bend);
                let apart = found.iter().zip(&wanted).map(|(found, wanted)| (found - wanted).abs());
                let apart = apart.fold(0.0, f64::max);
                // Velocities reach 480 at the strongest pull.
                let size = wanted.iter().fold(1.0_f64, |size, wanted| size.max(wanted.abs()));
                assert!(apart < 1e-5 * size, "{method}: {found:?}, not {wanted:?}, at {pull:e}, {bend:e}");
            }
        }
    }
}

#[test]
fn a_step_that_no_block_makes_is_handed_over_and_blocks_come_back() {
    let problem = Pulled { pull: 1e4, bend: 0.0, blind_until: 0.5 };
    let mut integrator = begin("automatic", &problem, SETTINGS, 0.0, [1.0, 0.0, 0.0, 0.0], ());
    assert_eq!(integrator.method().kind(), MethodKind::Block);
    integrator.advance(&problem, 0.1).expect("explicit steps are made");
    assert_eq!(integrator.method().kind(), MethodKind::Explicit);
    integrator.advance(&problem, 1.0).expect("explicit steps, then blocks are made");
    let (mut steps, mut blocks) = (0, 0);
    let mut count = |integrator: &mut Integrator<()>| {
        steps += 1;
        blocks += usize::from(integrator.method().kind() == MethodKind::Block);
    };
    integrator.advance_watched(&problem, 2.0, &mut count).expect("blocks are made, and other steps tried");
    assert!(10 * blocks > 9 * steps, "blocks can be made again: {blocks} of {steps} steps");
    let (y, ()) = integrator.state_at(&problem, 2.0);
    assert!((y[0] - 200.0_f64.cos()).abs() < 1e-4, "{y:?}");
    // No attempt came near a rounding of time.
    assert!(integrator.state().statistics.rejected < 200, "{:?}", integrator.state().statistics);
}

#[test]
fn a_step_that_nothing_makes_is_an_error_after_all() {
    let problem = Pulled { pull: 1e4, bend: f64::NAN, blind_until: 0.0 };
    let mut integrator = begin("automatic", &problem, SETTINGS, 0.0, [1.0, 0.0, 0.0, 0.0], ());
    assert!(integrator.advance(&problem, 1.0).is_err());
}
