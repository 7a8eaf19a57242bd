//! A ball that bounces on a table which moves as A·sin ωt (P. J. Holmes, J. Sound Vib. 84 (1982) 173).
//!
//! With one impact in each period T the ball leaves at g·T/2, so that cos φ = π·(1 − e)/(Γ·(1 + e)), Γ = Aω²/g. From one
//! impact to the next phase and speed change by a map of determinant e². Where its eigenvalues are complex both have the
//! size e: the exponent is ln e / T. The motion is stable for 0 < Γ sin φ < 2·(1 + e²)/(1 + e)², where the period doubles.

use super::system::System;
use fmu_harness::dynamics::lyapunov::{Exponent, Probe};
use fmu_harness::dynamics::verdict::{Verdict, judge};
use fmu_harness::dynamics::{Flow, Point};
use slidercrank::integrator::{
    EventFunction, EventFunctions, Events, Linearizable, Ode, Reset, SeveralInstants, StateLayout, Triggered,
};
use std::f64::consts::{PI, TAU};

/// Restitution.
pub const E: f64 = 0.9;
/// Gravity; the table's period is 1.
pub const G: f64 = 1.0;

struct Ball {
    /// Γ = Aω²/g.
    gamma: f64,
}

static SCALES: [f64; 2] = [1.0; 2];

impl Ball {
    fn amplitude(&self) -> f64 {
        self.gamma * G / (TAU * TAU)
    }

    fn table(&self, t: f64) -> [f64; 2] {
        let (sin, cos) = (TAU * t).sin_cos();
        [self.amplitude() * sin, self.amplitude() * TAU * cos]
    }
}

impl Ode for Ball {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(2)
    }

    fn rates(&self, _: &(), _: f64, y: &[f64], rates: &mut [f64]) {
        rates.copy_from_slice(&[y[1], -G]);
    }

    fn scales(&self) -> &[f64] {
        &SCALES
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

    fn event_functions(&self, _: &(), t: f64, y: &[f64], functions: &mut EventFunctions) {
        let [height, speed] = self.table(t);
        functions[0] = EventFunction { value: y[0] - height, rate: y[1] - speed };
    }

    fn reset(&self, _: &(), t: f64, y: &mut [f64], _: &Triggered) -> Reset<()> {
        let [height, speed] = self.table(t);
        y.copy_from_slice(&[height, (1.0 + E) * speed - E * y[1]]);
        Reset { discrete: (), impact: None }
    }
}

/// Γ at which the period doubles.
pub fn doubling() -> f64 {
    (PI * (1.0 - E) / (1.0 + E)).hypot(2.0 * (1.0 + E * E) / (1.0 + E).powi(2))
}

/// The ball in its motion of period 1, stable or not, after `transient` periods.
fn bouncing(gamma: f64, transient: f64) -> System<2, Ball> {
    let ball = Ball { gamma };
    let phase = (PI * (1.0 - E) / (gamma * (1.0 + E))).acos() / TAU;
    // Half a period after the impact the ball is at the top of its flight.
    let mut system = System::start(Ball { gamma }, [ball.table(phase)[0] + G / 8.0, 0.0]);
    let top = Point { time: phase + 0.5, ..system.point() };
    system.place(&top);
    system.advance(phase + 0.5 + transient).expect("it bounces on");
    system
}

fn visits(system: &mut System<2, Ball>, count: usize) -> Vec<Vec<f64>> {
    let start = system.time();
    (1..=count)
        .map(|n| {
            system.advance(start + n as f64).expect("it bounces on");
            system.state().to_vec()
        })
        .collect()
}

fn exponent(gamma: f64) -> Exponent {
    let probe = Probe { interval: 1.0, count: 400, settling: 40, distance: 1e-3 };
    probe.measure(&mut bouncing(gamma, 200.0), &mut bouncing(gamma, 0.0), || {}).expect("an exponent")
}

#[test]
fn the_exponent_of_one_bounce_a_period_is_that_of_the_map() {
    // The trace vanishes halfway between the ends of the stable range: eigenvalues are ±i·e there.
    let (lower, upper) = (PI * (1.0 - E) / (1.0 + E), doubling());
    let middle = lower.hypot(0.5 * (upper * upper - lower * lower).sqrt());
    let found = exponent(middle);
    assert!((found.value - E.ln()).abs() < 1e-3, "{} for {}", found.value, E.ln());
}

#[test]
fn the_period_doubles_where_the_map_s_does() {
    for (gamma, period) in [(0.98 * doubling(), 1), (1.02 * doubling(), 2)] {
        let seen = visits(&mut bouncing(gamma, 2000.0), 60);
        let evidence = judge(&seen, &exponent(gamma));
        assert_eq!(evidence.verdict, Verdict::Periodic(period), "{gamma}: {evidence:?}");
        assert!(evidence.exponent < 0.0, "{gamma}: {evidence:?}");
    }
}

/// [1/period] From the map of impact times t and speeds v after impact, and its tangent: with τ the table's speed and w
/// that of the ball on arrival, (w − τ')·δs = (τ' − τ)·δt − s·δv, δt' = δt + δs, δv' = (1 + e)·τ̇'·δt' − e·(δv − g·δs).
fn exponent_of_the_map(gamma: f64, impacts: usize) -> f64 {
    let ball = Ball { gamma };
    let mut time = (PI * (1.0 - E) / (gamma * (1.0 + E))).acos() / TAU;
    let mut speed = 0.5 * G;
    let (mut along, mut growth, mut span) = ([1.0, 0.3], 0.0, 0.0);
    for impact in 0..impacts {
        let [height, moved] = ball.table(time);
        let gap = |s: f64| height + speed * s - 0.5 * G * s * s - ball.table(time + s)[0];
        // The first time that the ball is below the table, then halved.
        let (mut above, mut below) = (1e-7, 1e-7);
        while gap(below) > 0.0 {
            (above, below) = (below, below + 1e-4);
        }
        for _ in 0..60 {
            let middle = 0.5 * (above + below);
            if gap(middle) > 0.0 { above = middle } else { below = middle }
        }
        let s = below;
        let [_, table] = ball.table(time + s);
        let acceleration = -ball.amplitude() * TAU * TAU * (TAU * (time + s)).sin();
        let arrival = speed - G * s;
        let [dt, dv] = along;
        let ds = ((table - moved) * dt - s * dv) / (arrival - table);
        let later = dt + ds;
        let faster = (1.0 + E) * acceleration * later - E * (dv - G * ds);
        let size = later.hypot(faster);
        along = [later / size, faster / size];
        if impact >= 1000 {
            (growth, span) = (growth + size.ln(), span + s);
        }
        (time, speed) = ((time + s).rem_euclid(1.0), (1.0 + E) * table - E * arrival);
    }
    growth / span
}

#[test]
fn the_ball_goes_to_chaos() {
    let gamma = 2.3;
    let probe = Probe { interval: 1.0, count: 1500, settling: 100, distance: 1e-3 };
    let measured = probe.measure(&mut bouncing(gamma, 500.0), &mut bouncing(gamma, 0.0), || {}).expect("an exponent");
    let evidence = judge(&visits(&mut bouncing(gamma, 500.0), 300), &measured);
    assert_eq!(evidence.verdict, Verdict::Chaotic, "{evidence:?}");
    let expected = exponent_of_the_map(gamma, 12_000);
    let apart = (measured.value - expected) / measured.error;
    assert!(
        apart.abs() < 4.0 && measured.error < 0.1 * expected,
        "{} ± {} for {expected}",
        measured.value,
        measured.error
    );
}
