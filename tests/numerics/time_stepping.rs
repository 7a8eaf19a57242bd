//! Time stepping on a ball above a floor: what it does, and when it gives up.

use slidercrank::integrator::complementarity::{MAX_CONTACTS, NORMAL, Pairs};
use slidercrank::integrator::{
    ContactLaw, Events, IntegrationError, Jacobian, Linearizable, Moreau, Ode, Relative, Settings, SeveralInstants,
    StateLayout, Unilateral, WorkLimit,
};

/// A ball of unit mass that falls at `weight` [m/s²] on as many floors as `floors`, from the time `lost` on by a force
/// that is no number.
struct Ball {
    weight: f64,
    restitution: f64,
    floors: usize,
    /// What a unit impulse does to its velocity.
    response: f64,
    lost: f64,
    clearance: f64,
}

const BALL: Ball =
    Ball { weight: 10.0, restitution: 0.5, floors: 1, response: 1.0, lost: f64::INFINITY, clearance: 0.1 };

impl Ode for Ball {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(2)
    }

    fn rates(&self, (): &(), t: f64, y: &[f64], rates: &mut [f64]) {
        rates.copy_from_slice(&[y[1], if t < self.lost { -self.weight } else { f64::NAN }]);
    }

    fn scales(&self) -> &[f64] {
        &[1.0, 1.0]
    }

    fn longest_step(&self) -> f64 {
        1.0
    }
}

impl Linearizable for Ball {
    fn jacobian(&self, (): &(), _: f64, _: &[f64], jacobian: &mut Jacobian) {
        jacobian.row_mut(0)[1] = 1.0;
    }
}

impl SeveralInstants for Ball {}

impl Events for Ball {
    fn event_scale(&self) -> f64 {
        1e-6
    }
}

impl Unilateral for Ball {
    fn contact_laws(&self) -> [ContactLaw; MAX_CONTACTS] {
        [ContactLaw { restitution: self.restitution, friction: 0.0, clearance: self.clearance }; MAX_CONTACTS]
    }

    fn contacts(&self, _: f64, y: &[f64]) -> Relative {
        let mut relative = Relative { gap: [f64::INFINITY; MAX_CONTACTS], velocity: Pairs::default() };
        for floor in 0..self.floors {
            relative.gap[floor] = y[0];
            relative.velocity[floor][NORMAL] = y[1];
        }
        relative
    }

    fn response(&self, _: f64, _: &[f64], _: usize, _: usize, response: &mut [f64]) {
        response.copy_from_slice(&[0.0, self.response]);
    }
}

const STEP: f64 = 1.0 / 4096.0;
const SETTINGS: Settings = Settings { tolerance: 1e-6, fixed_step: STEP, effort: WorkLimit::ANY };

#[test]
fn a_ball_bounces_and_comes_to_rest_in_the_time_that_it_takes() {
    // The sum of its bounces: (2·v/g)·(e + e² + …) after a fall of v/g.
    for floors in [1, 2, MAX_CONTACTS] {
        let ball = Ball { floors, ..BALL };
        let mut run = Moreau::start(SETTINGS, 0.0, &[0.2, 0.0], ());
        let fall = 2.0 / ball.weight;
        let rest = fall * (1.0 + 2.0 * ball.restitution / (1.0 - ball.restitution));
        run.advance(&ball, rest + 50.0 * STEP).expect("a motion without trouble");
        let (y, impulses) = run.state_at(&ball, rest + 50.0 * STEP);
        let (height, speed) = (&y[0], &y[1]);
        assert!(speed.abs() < 1e-12 && height.abs() < 10.0 * STEP * STEP, "{height} m, {speed} m/s");
        // However the floors share it, together they carry the weight.
        let carried: f64 = impulses.forces.iter().map(|force| force[NORMAL]).sum();
        assert!((carried - ball.weight).abs() < 1e-9, "{floors} floors carry {carried} N");
    }
}

#[test]
fn an_impact_returns_the_share_that_it_is_asked_for() {
    for restitution in [0.0, 0.3, 1.0] {
        let ball = Ball { weight: 0.0, restitution, ..BALL };
        let mut run = Moreau::start(SETTINGS, 0.0, &[0.0105, -1.0], ());
        run.advance(&ball, 0.02).expect("a motion without trouble");
        assert!((run.state().front().y[1] - restitution).abs() < 1e-15, "{:?}", run.state().front().y);
        // It comes back from as deep as it was when the impact was noticed.
        assert!(run.state().front().y[0] >= -STEP, "{:?}", run.state().front().y);
        assert_eq!(run.state().statistics.events, 2, "it closes, and opens as nothing presses");
    }
}

#[test]
fn a_contact_that_no_impulse_moves_is_an_error_with_the_state_intact() {
    let ball = Ball { response: 0.0, ..BALL };
    let mut run = Moreau::start(SETTINGS, 0.0, &[0.2, 0.0], ());
    let error = run.advance(&ball, 1.0).expect_err("there is no way on");
    assert_eq!(error, IntegrationError::Complementarity { time: run.state().front().t, contacts: 1 });
    assert_eq!(error.to_string(), "no impulses satisfy the laws of 1 closed contacts at once");
    let t = error.time();
    let (y, _) = run.state_at(&ball, t);
    let (height, speed) = (&y[0], &y[1]);
    assert!((height - (0.2 - 5.0 * t * t)).abs() < 1e-12 && (speed + 10.0 * t).abs() < 1e-12, "{height}, {speed}");
    // And it gives up again where it gave up before.
    assert_eq!(run.advance(&ball, 1.0), Err(error));
}

#[test]
fn a_step_that_ends_deeper_than_the_clearance_is_an_error_with_the_state_intact() {
    // Of all steps on the way down, the one that notices the floor goes deepest: up to half a step's fall.
    let speed = 1.0;
    for (clearance, fits) in [(0.6 * speed * STEP, true), (1e-3 * speed * STEP, false)] {
        let ball = Ball { weight: 0.0, restitution: 0.0, clearance, ..BALL };
        let mut run = Moreau::start(SETTINGS, 0.0, &[10.25 * STEP, -speed], ());
        let advanced = run.advance(&ball, 30.0 * STEP);
        assert_eq!(advanced.is_ok(), fits, "{advanced:?}");
        let Err(error) = advanced else { continue };
        let time = run.state().front().t;
        assert_eq!(error, IntegrationError::TooDeep { time, contact: 0 });
        assert_eq!(run.state().front().y, [10.25 * STEP - time * speed, -speed]);
    }
}

#[test]
fn forces_that_are_no_numbers_are_an_error_where_they_begin() {
    let ball = Ball { lost: 0.1, ..BALL };
    let mut run = Moreau::start(SETTINGS, 0.0, &[0.2, 0.0], ());
    let error = run.advance(&ball, 1.0).expect_err("there is no way on");
    assert!(matches!(error, IntegrationError::NotFinite { component: 0, .. }), "{error:?}");
    // Forces are those of a step's middle.
    assert!((0.0..=STEP).contains(&(error.time() + 0.5 * STEP - ball.lost)), "{error:?}");
    assert!(run.state().front().y.iter().all(|y| y.is_finite()));
}

#[test]
fn steps_that_move_no_time_are_an_error() {
    let mut run = Moreau::start(Settings { fixed_step: 1e-10, ..SETTINGS }, 1e9, &[0.2, 0.0], ());
    assert!(matches!(run.advance(&BALL, 2e9), Err(IntegrationError::StepUnderflow { .. })));
}
