//! A method that changes to a linearly implicit one where the motion is stiff, on a motion that is so for a while.

use super::free::begin;
use slidercrank::integrator::methods::named;
use slidercrank::integrator::{
    Events, Integrator, Jacobian, Linearizable, MethodKind, Ode, Reader, Settings, SeveralInstants, Snapshot,
    SolverState, StateLayout, WorkLimit,
};
use std::f64::consts::PI;
use std::ops::Range;

/// [s] When the damper is there.
const DAMPED: Range<f64> = 2.0..6.0;
const END: f64 = 10.0;

/// q̈ = −q, and a body whose damper of at most this rate [1/s] follows sin t (A. Prothero, A. Robinson, Math. Comp. 28 (1974)
/// 145): from (0, 1), both are at sin t.
struct Following {
    rate: f64,
    blocks: bool,
}

impl Following {
    /// The damper's rate at a time, and its slope: it comes and goes as sin² does.
    fn damping(&self, t: f64) -> [f64; 2] {
        if !DAMPED.contains(&t) {
            return [0.0; 2];
        }
        let pace = PI / (DAMPED.end - DAMPED.start);
        let (sin, cos) = (pace * (t - DAMPED.start)).sin_cos();
        [self.rate * sin * sin, self.rate * 2.0 * pace * sin * cos]
    }
}

impl Ode for Following {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(4)
    }

    fn rates(&self, (): &(), t: f64, y: &[f64], rates: &mut [f64]) {
        let (sin, cos) = t.sin_cos();
        rates.copy_from_slice(&[y[2], y[3], -y[0], -sin - self.damping(t)[0] * (y[3] - cos)]);
    }

    fn scales(&self) -> &[f64] {
        &[1.0; 4]
    }

    fn longest_step(&self) -> f64 {
        0.5
    }
}

impl Linearizable for Following {
    fn jacobian(&self, (): &(), t: f64, y: &[f64], jacobian: &mut Jacobian) {
        let (sin, cos) = t.sin_cos();
        let [damping, slope] = self.damping(t);
        let rows = [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -damping]];
        for (i, row) in rows.iter().enumerate() {
            jacobian.row_mut(i).copy_from_slice(row);
        }
        jacobian.time.copy_from_slice(&[0.0, 0.0, 0.0, -cos - damping * sin - slope * (y[3] - cos)]);
    }
}

impl SeveralInstants for Following {
    fn suits_blocks(&self) -> bool {
        self.blocks
    }
}

impl Events for Following {}

fn settings(tolerance: f64) -> Settings {
    Settings { tolerance, fixed_step: 0.0, effort: WorkLimit::ANY }
}

fn start(method: &str, problem: &Following, tolerance: f64) -> Integrator<()> {
    begin(method, problem, settings(tolerance), 0.0, [0.0, 0.0, 1.0, 1.0], ())
}

/// Another integrator that goes on from where this one is.
fn resumed(problem: &Following, tolerance: f64, integrator: &Integrator<()>) -> Integrator<()> {
    let (mut saved, mut method) = (Snapshot::default(), named("automatic", 4).expect("a method of this name"));
    integrator.method().save(&mut saved);
    method.load(&mut Reader::new(&saved)).expect("what was saved");
    Integrator::resume(problem, method, settings(tolerance), integrator.state().clone())
}

/// All that is remembered.
fn remembered(integrator: &Integrator<()>) -> (SolverState<()>, Snapshot) {
    let mut saved = Snapshot::default();
    integrator.method().save(&mut saved);
    (integrator.state().clone(), saved)
}

/// Largest error, and all that is remembered at the end.
fn run(method: &str, problem: &Following, tolerance: f64) -> (f64, Integrator<()>) {
    let mut integrator = start(method, problem, tolerance);
    let mut worst = 0.0_f64;
    for i in 1..=100 {
        let t = 0.01 * END * f64::from(i);
        integrator.advance(problem, t).expect("no trouble");
        let (y, ()) = integrator.state_at(problem, t);
        let (sin, cos) = t.sin_cos();
        let errors = y.iter().zip([sin, sin, cos, cos]).map(|(found, wanted)| (found - wanted).abs());
        worst = errors.fold(worst, f64::max);
    }
    (worst, integrator)
}

#[test]
fn a_stiff_stretch_costs_little_and_no_accuracy() {
    for (rate, tolerance) in [(1e4, 1e-4), (1e5, 1e-6), (1e6, 1e-8)] {
        let problem = Following { rate, blocks: false };
        let (error, mut memory) = run("automatic", &problem, tolerance);
        let (explicit_error, explicit) = run("verner7", &problem, tolerance);
        let (implicit_error, implicit) = run("radau13", &problem, tolerance);
        println!(
            "{rate:e} 1/s at {tolerance:e}: {error:.1e} in {:?}; verner7 {explicit_error:.1e} in {:?}; radau13 {implicit_error:.1e} in {:?}",
            memory.state().statistics,
            explicit.state().statistics,
            implicit.state().statistics
        );
        assert!(error <= 30.0 * tolerance, "{error:e} at {tolerance:e}");
        let evaluations = memory.state().statistics.evaluations;
        assert!(evaluations * 20 < explicit.state().statistics.evaluations, "{:?}", memory.state().statistics);
        assert!(evaluations < 2 * implicit.state().statistics.evaluations, "{:?}", memory.state().statistics);
        memory.advance(&problem, END + 1.0).expect("no trouble");
        assert_eq!(memory.method().next_kind(), MethodKind::Explicit, "the damper is gone");
    }
}

#[test]
fn what_is_not_stiff_is_left_to_the_explicit_method_to_the_bit() {
    for tolerance in [1e-3, 1e-7, 1e-11] {
        let problem = Following { rate: 1.0, blocks: false };
        let (_, memory) = run("automatic", &problem, tolerance);
        let (_, explicit) = run("verner7", &problem, tolerance);
        assert_eq!(
            (memory.state().front(), memory.state().statistics),
            (explicit.state().front(), explicit.state().statistics),
            "at {tolerance:e}"
        );
    }
}

#[test]
fn a_stiff_stretch_is_gone_on_with_from_a_saved_state_and_from_a_step_taken_back() {
    let problem = Following { rate: 1e5, blocks: false };
    let mut whole = start("automatic", &problem, 1e-6);
    whole.advance(&problem, 4.0).expect("no trouble");
    assert_eq!([whole.method().kind(), whole.method().next_kind()], [MethodKind::Implicit; 2]);
    let mut again = resumed(&problem, 1e-6, &whole);
    let mut taken_back = resumed(&problem, 1e-6, &whole);
    whole.advance(&problem, END).expect("no trouble");
    again.advance(&problem, END).expect("no trouble");
    assert_eq!(remembered(&again), remembered(&whole));
    let told = taken_back.state_at(&problem, 4.0).0.to_vec();
    taken_back.truncate(&problem, 4.0);
    let front = taken_back.state().front();
    assert_eq!(front.t, 4.0);
    assert!(front.y.iter().zip(told).all(|(y, told)| (y - told).abs() < 1e-8), "{front:?}");
    taken_back.advance(&problem, END).expect("no trouble");
    let (y, ()) = taken_back.state_at(&problem, END);
    assert!((y[1] - END.sin()).abs() < 1e-5, "{y:?}");
    taken_back.advance(&problem, END + 1.0).expect("no trouble");
    assert_eq!(taken_back.method().next_kind(), MethodKind::Explicit);
}

#[test]
fn what_suits_blocks_is_made_in_blocks_until_a_damper_asks_for_other_steps() {
    let calm = Following { rate: 1.0, blocks: true };
    let (_, memory) = run("automatic", &calm, 1e-9);
    let (_, in_blocks) = run("cong8", &calm, 1e-9);
    assert_eq!(
        (memory.state().front(), memory.state().statistics.steps),
        (in_blocks.state().front(), in_blocks.state().statistics.steps)
    );
    // Too fast for blocks of the accuracy.
    let damped = Following { rate: 400.0, blocks: true };
    let mut whole = start("automatic", &damped, 1e-9);
    whole.advance(&damped, 4.0).expect("no trouble");
    assert_ne!(whole.method().kind(), MethodKind::Block);
    let mut again = resumed(&damped, 1e-9, &whole);
    for integrator in [&mut whole, &mut again] {
        integrator.advance(&damped, END).expect("no trouble");
    }
    assert_eq!(remembered(&again), remembered(&whole));
    let (y, ()) = whole.state_at(&damped, END);
    assert!((y[1] - END.sin()).abs() < 1e-7, "{y:?}");
    let (_, in_blocks) = run("cong8", &damped, 1e-9);
    let [found, all] = [&whole, &in_blocks].map(|integrator| integrator.state().statistics.evaluations);
    assert!(3 * found < 2 * all, "{found} evaluations, in blocks alone {all}");
    let mut stiff = start("automatic", &Following { rate: 1e5, ..damped }, 1e-6);
    stiff.advance(&Following { rate: 1e5, ..damped }, 4.0).expect("no trouble");
    assert_eq!(stiff.method().kind(), MethodKind::Implicit);
}

/// The same motion, but without derivatives.
struct Unknown(Following);

impl Ode for Unknown {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout::second_order(4)
    }

    fn rates(&self, modes: &(), t: f64, y: &[f64], rates: &mut [f64]) {
        self.0.rates(modes, t, y, rates);
    }

    fn scales(&self) -> &[f64] {
        self.0.scales()
    }

    fn longest_step(&self) -> f64 {
        self.0.longest_step()
    }
}

impl Linearizable for Unknown {
    fn jacobian(&self, (): &(), _: f64, _: &[f64], jacobian: &mut Jacobian) {
        for i in 0..4 {
            jacobian.row_mut(i).fill(f64::NAN);
        }
    }
}

impl SeveralInstants for Unknown {}

impl Events for Unknown {}

#[test]
fn where_derivatives_are_none_the_explicit_method_goes_on() {
    let problem = Unknown(Following { rate: 1e4, blocks: false });
    let mut integrator = begin("automatic", &problem, settings(1e-6), 0.0, [0.0, 0.0, 1.0, 1.0], ());
    integrator.advance(&problem, END).expect("a motion without trouble");
    let (y, ()) = integrator.state_at(&problem, END);
    assert!((y[1] - END.sin()).abs() < 1e-5, "{y:?}");
    let statistics = integrator.state().statistics;
    println!("{statistics:?}");
    assert!(statistics.rejected >= 8, "never tried: {statistics:?}");
}
