//! Frequency responses of oscillators with one degree of freedom, through the product's integrator and its tangent:
//! x″ + 2·ζ·x′ + x + α·x³ + stop = F·cos ωt. Time is counted in periods of the drive, and ω is a state that stays.

use anyhow::{Result, anyhow};
use fmu_harness::dynamics::continuation::{Bifurcation, Branch, Continuation};
use fmu_harness::dynamics::orbit::{Orbit, Return, ReturnMap, multipliers};
use nalgebra::{DMatrix, DVector};
use slidercrank::integrator::methods::named;
use slidercrank::integrator::tangent::{Crossing, Gradient, Tangents, Variational};
use slidercrank::integrator::{
    EventFunction, EventFunctions, Events, Integrator, Jacobian, Linearizable, Ode, Reset, Settings, SeveralInstants,
    StateLayout, System, Triggered, WorkLimit,
};
use slidercrank::simulation::Phase;
use std::f64::consts::TAU;

struct Oscillator {
    zeta: f64,
    alpha: f64,
    drive: f64,
    stop: Stop,
}

/// A spring and a damper behind a gap.
struct Stop {
    gap: f64,
    stiffness: f64,
    damping: f64,
}

/// A stop that is never reached.
const FREE: Stop = Stop { gap: 1e3, stiffness: 0.0, damping: 0.0 };
const TOLERANCE: f64 = 1e-11;
static SCALES: [f64; 3] = [1.0; 3];
/// Noticeable differences.
static NOTICED: [f64; 2] = [1e-3; 2];

impl Oscillator {
    /// Stiffness and damping of the oscillator with the stop.
    fn linear(&self, touches: bool) -> [f64; 2] {
        let share = f64::from(u8::from(touches));
        [1.0 + share * self.stop.stiffness, 2.0 * self.zeta + share * self.stop.damping]
    }
}

impl Ode for Oscillator {
    /// Whether the stop is touched.
    type Discrete = bool;

    fn layout(&self) -> StateLayout {
        StateLayout { positions: 1, places: 1, weighted: 3, states: 3 }
    }

    fn rates(&self, touches: &bool, t: f64, y: &[f64], rates: &mut [f64]) {
        let [x, v, omega] = [y[0], y[1], y[2]];
        let period = TAU / omega;
        let [stiffness, damping] = self.linear(*touches);
        let force =
            self.drive * (TAU * t).cos() - stiffness * x - self.alpha * x.powi(3) + (stiffness - 1.0) * self.stop.gap;
        rates.copy_from_slice(&[v, period * period * force - period * damping * v, 0.0]);
    }

    fn scales(&self) -> &[f64] {
        &SCALES
    }

    fn longest_step(&self) -> f64 {
        0.05
    }
}

impl Linearizable for Oscillator {
    fn jacobian(&self, touches: &bool, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        let [x, v, omega] = [y[0], y[1], y[2]];
        let period = TAU / omega;
        let [stiffness, damping] = self.linear(*touches);
        let mut rates = [0.0; 3];
        self.rates(touches, t, y, &mut rates);
        // The force counts with T², the damping with T, and dT/dω = −T/ω.
        let by_omega = -(2.0 * rates[1] + period * damping * v) / omega;
        let slope = -period * period * (stiffness + 3.0 * self.alpha * x * x);
        jacobian.row_mut(0).copy_from_slice(&[0.0, 1.0, 0.0]);
        jacobian.row_mut(1).copy_from_slice(&[slope, -period * damping, by_omega]);
        jacobian.row_mut(2).fill(0.0);
        jacobian.time = vec![0.0, -period * period * self.drive * TAU * (TAU * t).sin(), 0.0];
    }
}

impl SeveralInstants for Oscillator {}

impl Events for Oscillator {
    fn event_count(&self) -> usize {
        1
    }

    fn event_functions(&self, touches: &bool, _: f64, y: &[f64], functions: &mut EventFunctions) {
        let sign = if *touches { 1.0 } else { -1.0 };
        functions[0] = EventFunction { value: sign * (y[0] - self.stop.gap), rate: sign * y[1] };
    }

    fn reset(&self, touches: &bool, _: f64, _: &mut [f64], _: &Triggered) -> Reset<bool> {
        Reset { discrete: !touches, impact: None }
    }
}

impl Variational for Oscillator {
    type Discrete = bool;

    fn system(&self) -> &dyn System<Discrete = bool> {
        self
    }

    fn crossings(&self, before: &bool, after: &bool, _: f64, _: &[f64]) -> Vec<Crossing<bool>> {
        let gradient = |by_state: [f64; 3]| Gradient { by_state: by_state.to_vec(), ..Gradient::default() };
        let crossing = Crossing {
            contact: 0,
            after: *after,
            distance: gradient([1.0, 0.0, 0.0]),
            rate: gradient([0.0, 1.0, 0.0]),
            memory: None,
            reset: 0..0,
        };
        if self.differ(before, after) { vec![crossing] } else { vec![] }
    }

    fn differ(&self, before: &bool, after: &bool) -> bool {
        before != after
    }
}

impl ReturnMap for Oscillator {
    fn name(&self) -> &str {
        "omega"
    }

    fn scales(&self) -> &[f64] {
        &NOTICED
    }

    fn apply(&self, omega: f64, phase: &Phase, turns: usize) -> Result<Return> {
        let [x, v] = [phase.states[0], phase.states[1]];
        let (start, touches) = ([x, v, omega], x > self.stop.gap);
        let settings = Settings { tolerance: TOLERANCE, fixed_step: 0.0, effort: WorkLimit::ANY };
        let mut integrator =
            Integrator::start(self, named("verner7", 3).expect("a method"), settings, 0.0, &start, touches);
        let none = DMatrix::zeros(0, 3);
        let state = integrator.state();
        let mut tangents = Tangents::new(self, state, DMatrix::identity(3, 3), none, vec![1.0; 3], TOLERANCE);
        let mut halfway = start;
        for turn in 1..=turns {
            integrator.advance_watched(self, turn as f64, &mut |integrator| tangents.follow(self, integrator))?;
            integrator.truncate(self, turn as f64);
            tangents.shorten(self, &integrator);
            if turn == turns / 2 {
                halfway.copy_from_slice(integrator.state_at(self, turn as f64).0);
            }
        }
        let (end, still) = integrator.state_at(self, turns as f64);
        anyhow::ensure!(still == touches, "the stop is touched at the section");
        let miss = DVector::from_fn(2, |i, _| (end[i] - start[i]) / NOTICED[i]);
        let directions = tangents.directions().map_err(|grazing| anyhow!("{grazing:?}"))?;
        let by_unknowns = directions.view((0, 0), (2, 2)).into_owned();
        let orbit = Orbit {
            value: omega,
            phase: phase.clone(),
            turns,
            multipliers: multipliers(&by_unknowns),
            apart: DVector::from_fn(2, |i, _| (halfway[i] - start[i]) / NOTICED[i]),
            visits: vec![],
            events: i64::try_from(integrator.state().statistics.events)?,
        };
        let by_parameter = DVector::from_fn(2, |i, _| directions[(i, 2)] / NOTICED[i]);
        Ok(Return { miss, by_unknowns, by_parameter, unknowns: vec![0, 1], orbit })
    }
}

/// The branch from `from` to `to`.
fn branch(oscillator: &Oscillator, [from, to]: [f64; 2]) -> Branch {
    let phase = Phase { time: 0.0, states: vec![0.0; 2], approach: vec![] };
    let start = oscillator.solve(from, &phase, 1).expect("a periodic motion");
    let continuation = Continuation { map: oscillator, from, to, doublings: 0 };
    continuation.follow(start, |_| {}).expect("branches").swap_remove(0)
}

/// Going up, Duffing's response folds at the frequency at which it falls down when simulated, and then at that at which it
/// rises when simulated going down. The frequencies are those at which 1 is a multiplier: both equations were solved with
/// SciPy's DOP853 and fsolve to 1e-13.
#[test]
fn duffing_s_response_folds_over_where_another_solver_finds_it() {
    let duffing = Oscillator { zeta: 0.05, alpha: 0.05, drive: 0.3, stop: FREE };
    let branch = branch(&duffing, [0.6, 1.6]);
    let found: Vec<_> = branch.found.iter().map(|found| (found.kind, found.orbit.value)).collect();
    assert_eq!(found.len(), 2, "{found:?}");
    for ((kind, value), known) in found.iter().zip([1.130_728_200_780_517, 1.115_963_970_020_992]) {
        assert!(*kind == Bifurcation::Fold && (value - known).abs() < 1e-8, "{kind} at {value} for {known}");
    }
    // Unstable between the folds, and there alone.
    let falls = |pair: &[Orbit]| pair[1].value < pair[0].value;
    let unstable = branch.orbits.iter().filter(|orbit| !orbit.is_stable()).count();
    let back = branch.orbits.windows(2).filter(|pair| falls(pair)).count();
    assert!(unstable > 2 && unstable.abs_diff(back) <= 1, "{unstable} {back}");
}

/// Without touching, the amplitude is F/√((1 − ω²)² + (2ζω)²); where it is the gap, the branch grazes the stop.
#[test]
fn an_oscillator_grazes_its_stop_where_its_linear_amplitude_is_the_gap() {
    let (zeta, drive, gap) = (0.1_f64, 0.2_f64, 0.6_f64);
    // ω⁴ − 2·(1 − 2ζ²)·ω² + 1 − (F/g)² = 0.
    let middle = 1.0 - 2.0 * zeta * zeta;
    let reach = (middle * middle - 1.0 + (drive / gap).powi(2)).sqrt();
    let known = [middle - reach, middle + reach].map(f64::sqrt);
    for damping in [0.0, 0.05] {
        let stop = Stop { gap, stiffness: 0.4, damping };
        let oscillator = Oscillator { zeta, alpha: 0.0, drive, stop };
        let branch = branch(&oscillator, [0.6, 1.6]);
        let found: Vec<_> = branch.found.iter().map(|found| (found.kind, found.orbit.value)).collect();
        let grazing: Vec<f64> =
            found.iter().filter(|(kind, _)| *kind == Bifurcation::Grazing).map(|(_, value)| *value).collect();
        assert_eq!(grazing.len(), 2, "{found:?}, {}", branch.end);
        for (value, known) in grazing.iter().zip(known) {
            assert!((value - known).abs() < 1e-6, "{value} for {known}");
        }
    }
}
