//! When the integrator gives up: the right error, at the right time, with the state intact.

use super::free::{Free, begin};
use slidercrank::integrator::{
    EventFunction, EventFunctions, Events, IntegrationError, Linearizable, Ode, Settings, SeveralInstants, StateLayout,
    WorkLimit,
};

const SETTINGS: Settings = Settings { tolerance: 1e-8, fixed_step: 1e-3, effort: WorkLimit::ANY };

#[test]
fn rates_that_are_not_a_number_at_the_start_are_named() {
    let problem = Free::<_, 4> {
        accelerations: |_: f64, _: &[f64], _: &[f64], a: &mut [f64]| a.copy_from_slice(&[1.0, f64::NAN]),
    };
    let start = [1.0, 2.0, 3.0, 4.0];
    let mut integrator = begin("verner7", &problem, SETTINGS, 5.0, start, ());
    let error = integrator.advance(&problem, 6.0);
    assert_eq!(error, Err(IntegrationError::NotFinite { time: 5.0, component: 3 }));
    assert_eq!(integrator.state_at(&problem, 5.0).0, start);
}

#[test]
fn a_wall_of_nans_is_approached_and_the_step_runs_out() {
    let wall = 0.5;
    let problem = Free::<_, 2> {
        accelerations: move |t: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = if t < wall { 2.0 } else { f64::NAN },
    };
    let mut integrator = begin("verner7", &problem, SETTINGS, 0.0, [0.0, 0.0], ());
    let error = integrator.advance(&problem, 1.0).expect_err("there is no way on");
    let IntegrationError::StepUnderflow { time, step, .. } = error else {
        unreachable!("{error}");
    };
    assert!(time < wall && wall - time <= 4.0 * f64::EPSILON && step < f64::EPSILON, "{error:?}");
    // q = t²: what was reached before the wall stays exact and can still be asked for.
    let (y, ()) = integrator.state_at(&problem, time);
    let (q, v) = (y[0], y[1]);
    let bound = 1e3 * f64::EPSILON;
    assert!((q - time * time).abs() < bound && (v - 2.0 * time).abs() < bound, "{q}, {v} at {time}");
    // And it gives up again where it gave up before.
    assert_eq!(integrator.advance(&problem, 1.0).map_err(|error| error.time()), Err(time));
}

#[test]
fn a_state_that_blows_up_stops_where_it_does() {
    // v̇ = v²: v = 1/(1 − t).
    let problem = Free::<_, 2> { accelerations: |_: f64, _: &[f64], v: &[f64], a: &mut [f64]| a[0] = v[0] * v[0] };
    let mut integrator = begin("dopri5", &problem, SETTINGS, 0.0, [0.0, 1.0], ());
    let error = integrator.advance(&problem, 2.0).expect_err("there is nothing beyond");
    assert!((error.time() - 1.0).abs() < 1e-7, "{error:?}");
    let front = integrator.state().front().clone();
    assert_eq!(front.t, error.time());
    assert!(front.y.iter().all(|y| y.is_finite()), "{front:?}");
}

#[test]
fn work_beyond_its_bound_is_refused_and_can_be_gone_on_with() {
    let problem = Free::<_, 2> { accelerations: |_: f64, q: &[f64], _: &[f64], a: &mut [f64]| a[0] = -q[0] };
    let start = |effort| {
        let settings = Settings { effort, ..SETTINGS };
        begin("verner7", &problem, settings, 0.0, [1.0, 0.0], ())
    };
    let mut free = start(WorkLimit::ANY);
    assert_eq!(free.advance(&problem, 50.0), Ok(()));
    let mut bound = start(WorkLimit { base: 100, per_second: 2 });
    let mut refusals = 0_u64;
    while let Err(error) = bound.advance(&problem, 50.0) {
        let IntegrationError::TooMuchWork { time, evaluations } = error else { unreachable!("{error}") };
        assert_eq!(time, bound.state().front().t);
        assert!(evaluations > 100 && evaluations < 300, "{evaluations} at {time} s");
        refusals += 1;
    }
    assert!(refusals >= free.state().statistics.evaluations / 300, "{refusals}");
    assert_eq!(bound.state_at(&problem, 50.0), free.state_at(&problem, 50.0));
}

#[test]
fn a_point_beyond_all_steps_is_told_before_the_first() {
    let problem = Free::<_, 2> { accelerations: |_: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = 0.0 };
    let settings = Settings { fixed_step: 1e-9, effort: WorkLimit { base: 1000, per_second: 1_000_000 }, ..SETTINGS };
    let mut integrator = begin("rk4", &problem, settings, 0.0, [0.0, 1.0], ());
    for far in [1e-3, 1.0, 1e300, f64::MAX] {
        let error = integrator.advance(&problem, far).expect_err("too many steps");
        assert!(matches!(error, IntegrationError::TooMuchWork { time: 0.0, .. }), "{far:e}: {error:?}");
    }
    assert_eq!(integrator.state().statistics.steps, 0);
    assert_eq!(integrator.advance(&problem, 1e-7), Ok(()));
}

#[test]
fn a_fixed_step_that_overflows_is_taken_back() {
    // v̇ = v³ from 1: v has no bound before t = ½, and no error estimate tells.
    let problem = Free::<_, 2> { accelerations: |_: f64, _: &[f64], v: &[f64], a: &mut [f64]| a[0] = v[0].powi(3) };
    let settings = Settings { fixed_step: 0.05, ..SETTINGS };
    let mut integrator = begin("rk4", &problem, settings, 0.0, [0.0, 1.0], ());
    for k in 1.. {
        let t = f64::from(k) * 1e-3;
        let error = integrator.advance(&problem, t).err();
        let time = error.as_ref().map_or(t, IntegrationError::time);
        let (y, ()) = integrator.state_at(&problem, time);
        assert!(y.iter().all(|y| y.is_finite()), "{y:?} at {time}: {error:?}");
        if error.is_some() {
            assert_eq!(integrator.state().front().t, time, "{error:?}");
            break;
        }
    }
}

#[test]
fn a_fixed_step_into_a_wall_underflows_too() {
    let problem = Free::<_, 2> {
        accelerations: |t: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = if t < 0.5 { 2.0 } else { f64::NAN },
    };
    let mut integrator = begin("rk4", &problem, SETTINGS, 0.0, [0.0, 0.0], ());
    let error = integrator.advance(&problem, 1.0).expect_err("there is no way on");
    assert!(matches!(error, IntegrationError::StepUnderflow { time, .. } if (time - 0.5).abs() < 1e-12), "{error:?}");
}

/// A fall onto a floor that no event clears: the event function is still below zero after each.
struct Stuck {
    /// Nothing lies beyond the floor.
    ends: bool,
    /// Acceleration at a time.
    pull: fn(f64) -> f64,
}

const STUCK: Stuck = Stuck { ends: false, pull: |_| -2.0 };

impl Ode for Stuck {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(2)
    }

    fn rates(&self, (): &(), t: f64, y: &[f64], rates: &mut [f64]) {
        rates.copy_from_slice(&[y[1], (self.pull)(t)]);
    }

    fn scales(&self) -> &[f64] {
        &[1.0, 1.0]
    }

    fn longest_step(&self) -> f64 {
        1.0
    }
}

impl Linearizable for Stuck {}
impl SeveralInstants for Stuck {}

impl Events for Stuck {
    fn event_count(&self) -> usize {
        2
    }

    fn event_functions(&self, (): &(), _: f64, y: &[f64], functions: &mut EventFunctions) {
        functions[0] = EventFunction { value: 1.0, rate: 0.0 };
        functions[1] = EventFunction { value: y[0], rate: y[1] };
    }

    fn is_dead_end(&self, event: usize) -> bool {
        self.ends && event == 1
    }

    fn event_scale(&self) -> f64 {
        if self.ends { 1e-9 } else { 1.0 }
    }
}

#[test]
fn events_without_end_are_refused_where_they_happen() {
    let mut integrator = begin("verner7", &STUCK, SETTINGS, 0.0, [1.0, 0.0], ());
    let error = integrator.advance(&STUCK, 3.0).expect_err("the floor is never passed");
    assert!(matches!(error, IntegrationError::EventsAccumulate { event: 1, .. }), "{error:?}");
    assert!((error.time() - 1.0).abs() < 1e-9, "{error:?}");
    // There, q = 1 − t².
    let t = error.time();
    let y = integrator.state_at(&STUCK, t).0;
    assert!((y[0] - (1.0 - t * t)).abs() < 1e-13 && (y[1] + 2.0 * t).abs() < 1e-13, "{y:?} at {t}");
}

/// At rest on the floor the event function is not falling yet, and falls in every step at its very start.
#[test]
fn events_at_the_start_of_every_step_are_refused_too() {
    let mut integrator = begin("verner7", &STUCK, SETTINGS, 0.0, [0.0, 0.0], ());
    let error = integrator.advance(&STUCK, 3.0).expect_err("time stands still");
    assert_eq!(error, IntegrationError::EventsAccumulate { time: 0.0, event: 1 });
    assert_eq!(integrator.state_at(&STUCK, 0.0).0, [0.0, 0.0]);
}

#[test]
fn a_motion_goes_up_to_its_dead_end_and_no_further() {
    let problem = Stuck { ends: true, ..STUCK };
    let mut integrator = begin("verner7", &problem, SETTINGS, 0.0, [1.0, 0.0], ());
    assert_eq!(integrator.advance(&problem, 0.9), Ok(()));
    for _ in 0..2 {
        let error = integrator.advance(&problem, 3.0).expect_err("there is no way on");
        assert!(matches!(error, IntegrationError::DeadEnd { event: 1, .. }), "{error:?}");
        assert!((error.time() - 1.0).abs() < 1e-9, "{error:?}");
        let y = integrator.state_at(&problem, error.time()).0;
        assert!(y[0].abs() < 1e-9 && (y[1] + 2.0).abs() < 1e-9, "{y:?}");
    }
    assert_eq!(integrator.state().statistics.events, 0, "nothing was crossed");
    // A method that does not locate events locates this one.
    let mut coarse = begin("rk4_unlocated", &problem, SETTINGS, 0.0, [1.0, 0.0], ());
    let error = coarse.advance(&problem, 3.0).expect_err("there is no way on");
    assert!(matches!(error, IntegrationError::DeadEnd { event: 1, .. }), "{error:?}");
    assert!((error.time() - 1.0).abs() < 1e-9, "{error:?}");
}

/// A step of 1 from 0 looks at 0, ½ and 1, and one up to the event at ½ at ¼ too, where the force is beyond all measure.
#[test]
fn a_step_that_is_lost_on_the_way_to_its_event_is_taken_back() {
    let pull = |t: f64| if (t - 0.25).abs() < 0.1 { 1e30 } else { -2.0 };
    let problem = Stuck { pull, ..STUCK };
    let settings = Settings { fixed_step: 1.0, ..SETTINGS };
    let start = [0.25, 0.0];
    let mut integrator = begin("rk4", &problem, settings, 0.0, start, ());
    let error = integrator.advance(&problem, 1.0).expect_err("no state at the event");
    assert!(matches!(error, IntegrationError::NotFinite { time: 0.0, .. }), "{error:?}");
    let state = integrator.state();
    let (before, end, front) = (state.start(), state.end(), state.front());
    assert!([before, end, front].iter().all(|front| front.t == 0.0 && front.y == start), "{:?}", integrator.state());
    assert_eq!((state.crossings, state.statistics.events, state.statistics.steps), (0, 0, 0));
}

/// The same without an event, taken back to ½.
#[test]
fn a_step_that_is_lost_when_it_is_shortened_leaves_a_state_that_is_not() {
    let problem = Free::<_, 2> {
        accelerations: |t: f64, _: &[f64], _: &[f64], a: &mut [f64]| {
            a[0] = if (t - 0.25).abs() < 0.1 { 1e30 } else { -2.0 };
        },
    };
    let settings = Settings { fixed_step: 1.0, ..SETTINGS };
    let mut integrator = begin("rk4", &problem, settings, 0.0, [0.25, 0.0], ());
    integrator.advance(&problem, 1.0).expect("nobody looks at ¼");
    integrator.truncate(&problem, 0.5);
    let front = integrator.state().front().clone();
    assert_eq!(front.t, 0.5);
    assert!(front.y[0].abs() < 1e-14 && (front.y[1] + 1.0).abs() < 1e-14, "{front:?}");
}

/// The same where only the full step's own stages are not lost, so that the curve between its ends is.
#[test]
fn a_step_that_is_lost_when_it_is_shortened_leaves_a_state_between_its_ends() {
    let problem = Free::<_, 2> {
        accelerations: |t: f64, _: &[f64], v: &[f64], a: &mut [f64]| {
            a[0] = if t == 0.0 || t == 1.0 {
                -2.0
            } else if t == 0.5 {
                10.0 * v[0]
            } else {
                1e30
            };
        },
    };
    let settings = Settings { fixed_step: 1.0, ..SETTINGS };
    let mut integrator = begin("rk4", &problem, settings, 0.0, [0.25, 0.0], ());
    integrator.advance(&problem, 1.0).expect("nobody looks between");
    assert!(integrator.state_at(&problem, 0.5).0.iter().any(|y| y.abs() > 1e25), "not lost");
    integrator.truncate(&problem, 0.5);
    let front = integrator.state().front().clone();
    assert_eq!(front.t, 0.5);
    // Accelerations of -2, -10, -50 and -2, speeds of 0, -1, -5 and -50.
    let [position, speed] = [0.25 - 62.0 / 6.0, -124.0 / 6.0];
    assert!((front.y[0] - 0.5 * (0.25 + position)).abs() < 1e-12, "{front:?}");
    assert!((front.y[1] - 0.5 * speed).abs() < 1e-12, "{front:?}");
}

/// The same with a method whose attempts give the rates at their ends, too.
#[test]
fn a_state_that_is_kept_has_its_own_rates() {
    let falling = Free::<_, 2> { accelerations: |_: f64, _: &[f64], _: &[f64], a: &mut [f64]| a[0] = -2.0 };
    let mut integrator = begin("bs3", &falling, SETTINGS, 0.0, [0.0, 0.0], ());
    integrator.advance(&falling, 4.0).expect("nothing is in the way");
    let [start, end] = [integrator.state().start().t, integrator.state().end().t];
    assert_eq!(end - start, 1.0);
    // The whole step looked at ½, ¾ and 1; one of half its length looks at ¼.
    let hollow = Free::<_, 2> {
        accelerations: move |t: f64, _: &[f64], _: &[f64], a: &mut [f64]| {
            a[0] = if (t - start - 0.25).abs() < 0.1 { 1e30 } else { -2.0 };
        },
    };
    let t = start + 0.5;
    integrator.truncate(&hollow, t);
    let front = integrator.state().front().clone();
    assert!((front.y[0] + t * t).abs() < 1e-12 && (front.y[1] + 2.0 * t).abs() < 1e-12, "{front:?}");
    assert_eq!(front.rates, [front.y[1], -2.0]);
}

#[test]
fn errors_say_what_where_and_how_much() {
    let error = IntegrationError::StepUnderflow { time: 0.1234, step: 3.1e-18, component: 2 };
    assert_eq!(error.to_string(), "a step of 3.1e-18 s no longer moves time; component 2 sets the error");
    assert_eq!(error.time(), 0.1234);
    let error = IntegrationError::EventsAccumulate { time: 2.0, event: 4 };
    assert_eq!(error.to_string(), "events accumulate; event function 4 is lowest");
}
