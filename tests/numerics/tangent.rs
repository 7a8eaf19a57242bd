//! Tangents of motions with impacts, against closed forms.

use super::free::begin;
use nalgebra::{DMatrix, Matrix2, Vector2};
use slidercrank::integrator::tangent::{Crossing, Gradient, Tangents, Variational};
use slidercrank::integrator::{
    EventFunction, EventFunctions, Events, Integrator, Linearizable, Ode, Reset, Settings, SeveralInstants,
    StateLayout, System, Triggered, WorkLimit,
};

/// A ball above a table that moves by a·sin(w·t): free above it; below, a spring and a damper push it up. With `jump` the
/// table pushes with a constant force instead, so that the acceleration jumps.
struct Ball {
    gravity: f64,
    stiffness: f64,
    damping: f64,
    jump: f64,
    amplitude: f64,
    frequency: f64,
}

/// A spring without gravity and a table at rest.
const OSCILLATOR: Ball =
    Ball { gravity: 1.0, stiffness: 400.0, damping: 3.0, jump: 0.0, amplitude: 0.0, frequency: 0.0 };

impl Ball {
    /// Height of the table and its rates.
    fn table(&self, t: f64) -> [f64; 3] {
        let Self { amplitude: a, frequency: w, .. } = *self;
        let (sin, cos) = (w * t).sin_cos();
        [a * sin, a * w * cos, -a * w * w * sin]
    }
}

impl Ode for Ball {
    type Discrete = bool;

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(2)
    }

    fn rates(&self, touching: &bool, t: f64, y: &[f64], rates: &mut [f64]) {
        let [height, speed, _] = self.table(t);
        let push = -self.stiffness * (y[0] - height) - self.damping * (y[1] - speed) + self.jump;
        rates.copy_from_slice(&[y[1], -self.gravity + if *touching { push } else { 0.0 }]);
    }

    fn scales(&self) -> &[f64] {
        &[1.0, 1.0]
    }

    fn longest_step(&self) -> f64 {
        0.05
    }
}

impl Linearizable for Ball {}

impl SeveralInstants for Ball {}

impl Events for Ball {
    fn event_count(&self) -> usize {
        1
    }

    fn event_functions(&self, touching: &bool, t: f64, y: &[f64], functions: &mut EventFunctions) {
        let [height, speed, _] = self.table(t);
        let sign = if *touching { -1.0 } else { 1.0 };
        functions[0] = EventFunction { value: sign * (y[0] - height), rate: sign * (y[1] - speed) };
    }

    fn reset(&self, touching: &bool, _: f64, _: &mut [f64], _: &Triggered) -> Reset<bool> {
        Reset { discrete: !touching, impact: None }
    }
}

impl Variational for Ball {
    type Discrete = bool;

    fn system(&self) -> &dyn System<Discrete = bool> {
        self
    }

    fn crossings(&self, before: &bool, after: &bool, t: f64, _: &[f64]) -> Vec<Crossing<bool>> {
        if before == after {
            return vec![];
        }
        let [_, speed, acceleration] = self.table(t);
        let gradient =
            |by_state: [f64; 2], by_time| Gradient { by_state: by_state.to_vec(), by_time, by_parameter: vec![] };
        vec![Crossing {
            contact: 0,
            after: *after,
            distance: gradient([1.0, 0.0], -speed),
            rate: gradient([0.0, 1.0], -acceleration),
            memory: None,
            reset: 0..0,
        }]
    }

    fn differ(&self, before: &bool, after: &bool) -> bool {
        before != after
    }
}

fn settings(tolerance: f64) -> Settings {
    Settings { tolerance, fixed_step: 0.0, effort: WorkLimit::ANY }
}

/// The motion from `start` to `end` and its tangent along both states.
fn followed(ball: &Ball, method: &str, start: [f64; 2], end: f64) -> (Integrator<bool>, Tangents<bool>) {
    let mut integrator = begin(method, ball, settings(1e-11), 0.0, start, false);
    let (both, none) = (DMatrix::identity(2, 2), DMatrix::zeros(0, 2));
    let mut tangents = Tangents::new(ball, integrator.state(), both, none, vec![1.0; 2], 1e-10);
    integrator.advance_watched(ball, end, &mut |integrator| tangents.follow(ball, integrator)).expect("a motion");
    (integrator, tangents)
}

/// The flow over `t` of x″ = −k·(x − h) − c·(x′ − h′), as a matrix.
fn spring(k: f64, c: f64, t: f64) -> Matrix2<f64> {
    let (decay, w) = (c / 2.0, (k - c * c / 4.0).sqrt());
    let (sin, cos) = (w * t).sin_cos();
    (-decay * t).exp() * Matrix2::new(cos + decay / w * sin, sin / w, -k / w * sin, cos - decay / w * sin)
}

/// Position and speed when the free ball from `start` touches a table at rest, and the time.
fn touch(ball: &Ball, [x, v]: [f64; 2]) -> (f64, f64) {
    let g = ball.gravity;
    let speed = (v * v + 2.0 * g * x).sqrt();
    ((v + speed) / g, -speed)
}

#[test]
fn the_tangent_over_a_compliant_impact_is_the_product_of_its_parts() {
    let ball = OSCILLATOR;
    let start = [0.2, 0.1];
    let (time, speed) = touch(&ball, start);
    // In contact, around the place where gravity and spring balance; until the ball is back at height 0.
    let balance = -ball.gravity / ball.stiffness;
    let inside = |t: f64| spring(ball.stiffness, ball.damping, t) * Vector2::new(-balance, speed);
    let (mut low, mut high) = (0.01, 0.3);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if inside(middle).x + balance < 0.0 { low = middle } else { high = middle }
    }
    let leaving = inside(low).y;
    let [before, after] = [time, 0.1].map(|t| Matrix2::new(1.0, t, 0.0, 1.0));
    // The acceleration jumps by the damper's force at touch and at parting: S = 1 + (f⁺ − f⁻)·g_yᵀ/(g_y·f⁻).
    let saltation = |jump: f64, speed: f64| Matrix2::new(1.0, 0.0, jump / speed, 1.0);
    let at_touch = saltation(-ball.damping * speed, speed);
    let at_parting = saltation(ball.damping * leaving, leaving);
    let exact = after * at_parting * spring(ball.stiffness, ball.damping, low) * at_touch * before;
    let end = time + low + 0.1;
    for method in ["cong8", "dop853", "dopri5", "radau13", "rodas4"] {
        let (mut integrator, mut tangents) = followed(&ball, method, start, end);
        let found = tangents.at(&ball, &integrator, end).expect("no grazing");
        let miss = (found - exact).abs().max() / exact.abs().max();
        assert!(miss < 1e-8, "{method}: {miss:e}");
        // The impact oscillator's multipliers are the eigenvalues.
        let eigenvalues = exact.complex_eigenvalues();
        assert!((eigenvalues[0] * eigenvalues[1]).re > 0.0);
        assert!(integrator.state_at(&ball, end).0[0] > 0.0);
    }
}

#[test]
fn a_jump_of_the_acceleration_has_its_saltation() {
    // The table pushes with a constant force: parabolas on both sides.
    let ball = Ball { stiffness: 0.0, damping: 0.0, jump: 11.0, ..OSCILLATOR };
    let start = [0.3, 0.0];
    let (time, speed) = touch(&ball, start);
    let end = time + 0.5 * speed.abs() / 10.0;
    let (integrator, mut tangents) = followed(&ball, "dop853", start, end);
    let found = tangents.at(&ball, &integrator, end).expect("no grazing");
    let free = |t: f64| Matrix2::new(1.0, t, 0.0, 1.0);
    let exact = free(end - time) * Matrix2::new(1.0, 0.0, 11.0 / speed, 1.0) * free(time);
    assert!((found - exact).abs().max() < 1e-9 * exact.abs().max());
}

#[test]
fn a_moving_table_counts_in_the_time_of_touch() {
    let ball = Ball { amplitude: 0.01, frequency: 40.0, ..OSCILLATOR };
    let (start, end) = ([0.2, 0.1], 0.9);
    let run = |start: [f64; 2]| {
        let mut integrator = begin("dop853", &ball, settings(1e-12), 0.0, start, false);
        integrator.advance(&ball, end).expect("a motion");
        assert!(integrator.state().statistics.events > 0);
        Vector2::from_row_slice(integrator.state_at(&ball, end).0)
    };
    let (integrator, mut tangents) = followed(&ball, "dop853", start, end);
    let found = tangents.at(&ball, &integrator, end).expect("no grazing");
    for column in 0..2 {
        let moved = |share: f64| {
            let mut start = start;
            start[column] += share;
            run(start)
        };
        let step = 1e-4;
        let difference =
            (8.0 * (moved(step) - moved(-step)) - (moved(2.0 * step) - moved(-2.0 * step))) / (12.0 * step);
        let miss = (found.column(column) - difference).norm() / difference.norm();
        assert!(miss < 1e-7, "{column}: {miss:e}");
    }
}

#[test]
fn a_shorter_last_step_is_followed_from_its_start() {
    let ball = OSCILLATOR;
    let start = [0.2, 0.1];
    let (mut integrator, mut tangents) = followed(&ball, "dop853", start, 0.75);
    let middle = 0.5 * (integrator.state().start().t + integrator.state().front().t);
    let before = tangents.at(&ball, &integrator, middle).expect("no grazing");
    integrator.truncate(&ball, middle);
    tangents.shorten(&ball, &integrator);
    let after = tangents.directions().expect("no grazing");
    assert!((before - after).abs().max() < 1e-8 * after.abs().max());
}

#[test]
fn grazing_ends_the_first_order_with_its_place() {
    // Thrown up from below a ceiling, upside down: the ball just reaches the table, or just fails to.
    let ball = Ball { gravity: -1.0, jump: -2.0, stiffness: 0.0, damping: 0.0, ..OSCILLATOR };
    for (speed, missed) in [(1.0 + 1e-11, false), (1.0 - 1e-11, true)] {
        let start = [0.5, -speed];
        let (integrator, tangents) = followed(&ball, "dop853", start, 1.5);
        assert_eq!(integrator.state().statistics.events == 0, missed, "{speed}");
        let grazing = tangents.directions().expect_err("grazing");
        assert!((grazing.time - 1.0).abs() < 1e-4 && grazing.speed < 1e-4, "{grazing:?}");
        assert_eq!((grazing.contact, grazing.missed), (0, missed));
    }
    // Farther away there is none.
    for speed in [1.0 + 1e-6, 1.0 - 1e-6] {
        let (_, tangents) = followed(&ball, "dop853", [0.5, -speed], 1.5);
        assert!(tangents.directions().is_ok(), "{speed}");
    }
}
