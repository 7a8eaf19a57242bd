//! Where events happen, against closed forms.

use super::free::{begin, power};
use slidercrank::integrator::{
    EventFunction, EventFunctions, Events, Linearizable, MAX_EVENTS, Ode, Reset, Settings, SeveralInstants,
    StateLayout, Triggered, WorkLimit,
};
use std::cell::RefCell;
use std::f64::consts::PI;

/// What happened: when, to which event functions, in which state.
type Log = RefCell<Vec<(f64, Triggered, [f64; 2])>>;

/// One position with acceleration a(mode, t, q, v) and event functions that each event negates: event function i is
/// (value, rate)(q, v) while the mode's flag i is false and its negative while it is true.
struct Switching<A, G> {
    acceleration: A,
    functions: G,
    count: usize,
    longest_step: f64,
    log: Log,
}

impl<A, G> Switching<A, G>
where
    A: Fn(&Triggered, f64, f64, f64) -> f64,
    G: Fn(usize, f64, f64) -> (f64, f64),
{
    fn new(acceleration: A, count: usize, functions: G) -> Self {
        Self { acceleration, functions, count, longest_step: 10.0, log: RefCell::default() }
    }

    fn run(&self, method: &str, tolerance: f64, start: [f64; 2], end: f64) -> Vec<f64> {
        self.run_with(method, Settings { tolerance, fixed_step: 0.0, effort: WorkLimit::ANY }, start, end)
    }

    fn run_with(&self, method: &str, settings: Settings, start: [f64; 2], end: f64) -> Vec<f64> {
        self.log.borrow_mut().clear();
        let mut integrator = begin(method, self, settings, 0.0, start, [false; MAX_EVENTS]);
        integrator.advance(self, end).expect("a motion without trouble");
        self.log.borrow().iter().map(|event| event.0).filter(|&t| t <= end).collect()
    }
}

impl<A, G> Ode for Switching<A, G>
where
    A: Fn(&Triggered, f64, f64, f64) -> f64,
    G: Fn(usize, f64, f64) -> (f64, f64),
{
    type Discrete = Triggered;

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(2)
    }

    fn rates(&self, modes: &Triggered, t: f64, y: &[f64], rates: &mut [f64]) {
        rates.copy_from_slice(&[y[1], (self.acceleration)(modes, t, y[0], y[1])]);
    }

    fn scales(&self) -> &[f64] {
        &[1.0, 1.0]
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }
}

impl<A, G> Linearizable for Switching<A, G>
where
    A: Fn(&Triggered, f64, f64, f64) -> f64,
    G: Fn(usize, f64, f64) -> (f64, f64),
{
}

impl<A, G> SeveralInstants for Switching<A, G>
where
    A: Fn(&Triggered, f64, f64, f64) -> f64,
    G: Fn(usize, f64, f64) -> (f64, f64),
{
}

impl<A, G> Events for Switching<A, G>
where
    A: Fn(&Triggered, f64, f64, f64) -> f64,
    G: Fn(usize, f64, f64) -> (f64, f64),
{
    fn event_count(&self) -> usize {
        self.count
    }

    fn event_functions(&self, modes: &Triggered, _: f64, y: &[f64], functions: &mut EventFunctions) {
        for (i, event) in functions.iter_mut().enumerate().take(self.count) {
            let (value, rate) = (self.functions)(i, y[0], y[1]);
            *event =
                if modes[i] { EventFunction { value: -value, rate: -rate } } else { EventFunction { value, rate } };
        }
    }

    fn reset(&self, modes: &Triggered, t: f64, y: &mut [f64], crossed: &Triggered) -> Reset<Triggered> {
        self.log.borrow_mut().push((t, *crossed, [y[0], y[1]]));
        Reset { discrete: std::array::from_fn(|i| modes[i] != crossed[i]), impact: None }
    }
}

const GRAVITY: f64 = 9.81;
const STIFFNESS: f64 = 4000.0;
const HEIGHT: f64 = 0.3;

/// Times at which a unit mass that falls from `HEIGHT` meets and leaves a spring floor, thrice.
///
/// It meets the floor at v = √(2gh); on it q = −g/k + A·cos(ωt + φ) with q(0) = 0, q̇(0) = −v, so it
/// leaves after 2(π − atan2(v·ω, g))/ω... by symmetry about the deepest point, at speed v upwards.
fn bounces() -> Vec<f64> {
    let omega = STIFFNESS.sqrt();
    let speed = (2.0 * GRAVITY * HEIGHT).sqrt();
    let fall = speed / GRAVITY;
    // From the floor to the deepest point: tan(ω·t) = −ω·v/g in the second quadrant.
    let on_floor = 2.0 * (PI - (omega * speed / GRAVITY).atan()) / omega;
    let mut times = vec![];
    let mut t = fall;
    for _ in 0..3 {
        times.push(t);
        times.push(t + on_floor);
        t += on_floor + 2.0 * fall;
    }
    times
}

/// Largest error of the event times of three bounces.
fn bounce_error(method: &str, settings: Settings) -> f64 {
    let spring = |modes: &Triggered, _: f64, q: f64, _: f64| if modes[0] { -GRAVITY - STIFFNESS * q } else { -GRAVITY };
    let problem = Switching::new(spring, 1, |_, q, v| (q, v));
    let times = problem.run_with(method, settings, [HEIGHT, 0.0], 1.7);
    let exact = bounces();
    assert_eq!(times.len(), exact.len(), "{}: {times:?}", method);
    times.iter().zip(&exact).map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max)
}

#[test]
fn bounces_happen_when_they_should_and_better_so_at_a_tighter_tolerance() {
    fn shrinks(method: &str) {
        let points = [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10].map(|tolerance| {
            (tolerance, bounce_error(method, Settings { tolerance, fixed_step: 0.0, effort: WorkLimit::ANY }))
        });
        let found = power(&points);
        println!("{}: error/tolerance {:.2?} s, power {found:.2}", method, points.map(|point| point.1 / point.0));
        // The floor is met at 2.4 m/s and a step's error is at most the tolerance; a bounce of 30 steps
        // adds them up and each later one turns 1 m/s of error into 0.2 s: measured 0.5 s at most.
        for (tolerance, error) in points {
            assert!(error <= 2.0 * tolerance, "{}: {error:e} s at {tolerance:e}", method);
        }
        assert!((found - 1.0).abs() < 0.3, "{}: error ~ tolerance^{found}", method);
    }
    shrinks("dopri5");
    shrinks("verner7");
    shrinks("dop853");
}

#[test]
fn with_a_fixed_step_event_times_keep_the_method_s_order() {
    let points = [2e-4, 1.4e-4, 1e-4, 7e-5, 5e-5].map(|step| {
        (step, bounce_error("rk4", Settings { tolerance: 1e-13, fixed_step: step, effort: WorkLimit::ANY }))
    });
    let order = power(&points);
    // The last step before an event is a shorter one, of any length, whose error is then missing.
    println!("rk4: {:.2?} ps, order {order:.2}", points.map(|point| 1e12 * point.1));
    assert!((order - 4.0).abs() < 0.3, "order {order}");
}

/// A unit oscillator, q = cos t, with `count` event functions.
fn cosine<G: Fn(usize, f64, f64) -> (f64, f64)>(
    count: usize,
    functions: G,
) -> Switching<impl Fn(&Triggered, f64, f64, f64) -> f64, G> {
    Switching::new(|_: &Triggered, _: f64, q: f64, _: f64| -q, count, functions)
}

#[test]
fn a_level_is_crossed_where_the_cosine_crosses_it() {
    let level = 0.3;
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        let problem = cosine(1, |_, q, v| (q - level, v));
        let times = problem.run("verner7", tolerance, [1.0, 0.0], 6.0);
        let exact = [level.acos(), 2.0 * PI - level.acos()];
        assert_eq!(times.len(), 2);
        let error = (times[0] - exact[0]).abs().max((times[1] - exact[1]).abs());
        println!("{tolerance:e}: {error:.1e} s");
        // Slope 0.95 at the level; some ten steps, each with an error of at most the tolerance.
        assert!(error < 10.0 * tolerance + 1e-14, "{error:e} s at {tolerance:e}");
    }
}

#[test]
fn the_state_at_an_event_lies_on_the_guard() {
    let problem = cosine(1, |_, q, v| (q - 0.3, v));
    for tolerance in [1e-4, 1e-6, 1e-10] {
        problem.run("dopri5", tolerance, [1.0, 0.0], 6.0);
        for (t, _, y) in problem.log.borrow().iter() {
            // Landings repeat until a tenth of a tolerable error is left.
            assert!((y[0] - 0.3).abs() <= 0.1 * tolerance, "off by {:e} at {t} s", y[0] - 0.3);
        }
    }
}

#[test]
fn guards_that_fall_together_are_crossed_together() {
    let problem = cosine(3, |_, q, v| (q - 0.3, v));
    problem.run("verner7", 1e-9, [1.0, 0.0], 6.0);
    let log = problem.log.borrow();
    assert_eq!(log.len(), 2, "{log:?}");
    assert!(log.iter().all(|(_, crossed, _)| crossed[..3] == [true; 3] && crossed[3..] == [false; MAX_EVENTS - 3]));
}

#[test]
fn guards_that_fall_close_to_each_other_are_crossed_in_their_order() {
    // Two levels that the cosine crosses 1e-7 s after each other, written against their order.
    let gap = 1e-7;
    let levels = [0.3 - gap, 0.3];
    let problem = cosine(2, |i, q, v| (q - levels[i], v));
    problem.run("verner7", 1e-10, [1.0, 0.0], 3.0);
    let log = problem.log.borrow();
    assert_eq!(log.len(), 2, "{log:?}");
    assert!(log[0].1[1] && !log[0].1[0] && log[1].1[0] && !log[1].1[1], "{log:?}");
    let apart = log[1].0 - log[0].0;
    assert!((apart - gap / (1.0f64 - 0.09).sqrt()).abs() < 1e-9, "{apart:e} s apart");
}

#[test]
fn a_grazing_dip_is_found_and_a_near_miss_is_not_made_one() {
    // cos t + 1 ∓ depth, at a tolerance at which the motion is known better than the depth.
    for depth in [1e-3, 1e-6, 1e-9] {
        let tolerance = 1e-3 * depth;
        let dip = cosine(1, |_, q, v| (q + 1.0 - depth, v));
        let times = dip.run("verner7", tolerance, [1.0, 0.0], 6.0);
        let half = (depth - 1.0f64).acos() - PI;
        assert_eq!(times.len(), 2, "depth {depth:e}: {times:?}");
        // The dip is √(2·depth) wide, so that an error of its height moves it by height/√(2·depth).
        let bound = 30.0 * tolerance / (2.0 * depth).sqrt();
        for (found, exact) in times.iter().zip([PI + half, PI - half]) {
            assert!((found - exact).abs() < bound, "depth {depth:e}: {:e} s", found - exact);
        }
        let miss = cosine(1, |_, q, v| (q + 1.0 + depth, v));
        assert_eq!(miss.run("verner7", tolerance, [1.0, 0.0], 6.0), []);
    }
}

#[test]
fn a_dip_inside_one_large_step_is_found() {
    // q = (t − 4.5)² − d: the error vanishes, so the steps grow to the longest, of 10.
    for depth in [0.25, 1e-4, 1e-8] {
        let problem = Switching::new(|_: &Triggered, _: f64, _: f64, _: f64| 2.0, 1, |_, q, v| (q, v));
        let times = problem.run("verner7", 1e-9, [4.5 * 4.5 - depth, -9.0], 9.0);
        let reach = f64::sqrt(depth);
        assert_eq!(times.len(), 2, "depth {depth:e}: {times:?}");
        for (found, exact) in times.iter().zip([4.5 - reach, 4.5 + reach]) {
            // An error of the event function of 0.1·tolerance over its slope 2·reach, and rounding of q ~ 20.
            let bound = (1e-10 + 64.0 * 20.0 * f64::EPSILON) / (2.0 * reach);
            assert!((found - exact).abs() < bound, "depth {depth:e}: {:e} s", found - exact);
        }
    }
}

#[test]
fn two_dips_of_two_guards_inside_one_step_come_in_order() {
    // As above with two floors, the higher one met first and left last.
    let floors = [0.0, 0.5];
    let problem = Switching::new(|_: &Triggered, _: f64, _: f64, _: f64| 2.0, 2, move |i, q, v| (q - floors[i], v));
    problem.run("verner7", 1e-9, [4.5 * 4.5 - 0.25, -9.0], 9.0);
    let log = problem.log.borrow();
    let order: Vec<usize> = log.iter().map(|(_, crossed, _)| usize::from(crossed[1])).collect();
    assert_eq!(order, [1, 0, 0, 1]);
}

#[test]
fn a_start_on_the_guard_counts_only_if_it_falls() {
    let rising = cosine(1, |_, q, v| (q, v));
    assert_eq!(rising.run("verner7", 1e-9, [0.0, 1.0], 4.0).len(), 1, "sin t falls at π only");
    let falling = cosine(1, |_, q, v| (q, v));
    let times = falling.run("verner7", 1e-9, [0.0, -1.0], 3.0);
    assert_eq!(times.first(), Some(&0.0), "−sin t falls at once");
    assert_eq!(times.len(), 1);
}

#[test]
fn every_event_of_a_hundred_oscillations_is_found() {
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let problem = cosine(1, |_, q, v| (0.9 - q, -v));
        let times = problem.run("verner7", tolerance, [0.5, 0.0], 200.0 * PI - 1.0);
        assert_eq!(times.len(), 0, "never that high");
        let problem = cosine(2, |i, q, v| ([0.45 - q, q + 0.49][i], [-v, v][i]));
        let times = problem.run("verner7", tolerance, [0.0, 0.5], 200.0 * PI - 1.0);
        assert_eq!(times.len(), 400, "at {tolerance:e}");
    }
}
