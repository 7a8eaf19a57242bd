//! A method that changes to a linearly implicit one where the motion is stiff, on a motion that is so for a while.

use slidercrank::integrator::methods::{Automatic, Cong8, Rodas4, Verner7};
use slidercrank::integrator::{
    Crossed, Effort, GUARDS, Guard, Integrator, Jacobian, Manner, Memory, Method, Problem, Reset, Settings,
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

impl Problem<4> for Following {
    type Modes = ();

    fn rates(&self, (): &(), t: f64, y: &[f64; 4], rates: &mut [f64; 4]) {
        let (sin, cos) = t.sin_cos();
        *rates = [y[2], y[3], -y[0], -sin - self.damping(t)[0] * (y[3] - cos)];
    }

    fn jacobian(&self, (): &(), t: f64, y: &[f64; 4], jacobian: &mut Jacobian<4>) {
        let (sin, cos) = t.sin_cos();
        let [damping, slope] = self.damping(t);
        jacobian.state = [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -damping]];
        jacobian.time = [0.0, 0.0, 0.0, -cos - damping * sin - slope * (y[3] - cos)];
    }

    fn suits_blocks(&self) -> bool {
        self.blocks
    }

    fn scales(&self) -> &[f64; 4] {
        &[1.0; 4]
    }

    fn longest_step(&self) -> f64 {
        0.5
    }

    fn guard_count(&self) -> usize {
        0
    }

    fn guards(&self, (): &(), _: f64, _: &[f64; 4], _: &mut [Guard; GUARDS]) {}

    fn guard_scale(&self) -> f64 {
        1.0
    }

    fn cross(&self, (): &(), _: f64, _: &mut [f64; 4], _: &Crossed) -> Reset<()> {
        Reset { modes: (), impact: None }
    }
}

fn settings(tolerance: f64) -> Settings {
    Settings { tolerance, fixed_step: 0.0, effort: Effort::ANY }
}

fn start<M: Method>(problem: &Following, tolerance: f64) -> Integrator<4, (), M> {
    Integrator::start(problem, settings(tolerance), 0.0, [0.0, 0.0, 1.0, 1.0], ())
}

/// Largest error, and all that is remembered at the end.
fn run<M: Method>(problem: &Following, tolerance: f64) -> (f64, Memory<4, ()>) {
    let mut integrator = start::<M>(problem, tolerance);
    let mut worst = 0.0_f64;
    for i in 1..=100 {
        let t = 0.01 * END * f64::from(i);
        integrator.advance(problem, t).expect("no trouble");
        let (y, ()) = integrator.state_at(problem, t);
        let (sin, cos) = t.sin_cos();
        let errors = y.iter().zip([sin, sin, cos, cos]).map(|(found, wanted)| (found - wanted).abs());
        worst = errors.fold(worst, f64::max);
    }
    (worst, *integrator.memory())
}

#[test]
fn a_stiff_stretch_costs_little_and_no_accuracy() {
    for (rate, tolerance) in [(1e4, 1e-4), (1e5, 1e-6), (1e6, 1e-8)] {
        let problem = Following { rate, blocks: false };
        let (error, memory) = run::<Automatic>(&problem, tolerance);
        let (explicit_error, explicit) = run::<Verner7>(&problem, tolerance);
        let (implicit_error, implicit) = run::<Rodas4>(&problem, tolerance);
        println!(
            "{rate:e} 1/s at {tolerance:e}: {error:.1e} in {:?}; verner7 {explicit_error:.1e} in {:?}; rodas4 {implicit_error:.1e} in {:?}",
            memory.statistics, explicit.statistics, implicit.statistics
        );
        assert!(error <= 30.0 * tolerance, "{error:e} at {tolerance:e}");
        let evaluations = memory.statistics.evaluations;
        assert!(evaluations * 20 < explicit.statistics.evaluations, "{:?}", memory.statistics);
        assert!(evaluations < 2 * implicit.statistics.evaluations, "{:?}", memory.statistics);
        assert_eq!(memory.regime.manner, Manner::Explicit, "the damper is gone");
    }
}

#[test]
fn what_is_not_stiff_is_left_to_the_explicit_method_to_the_bit() {
    for tolerance in [1e-3, 1e-7, 1e-11] {
        let problem = Following { rate: 1.0, blocks: false };
        let (_, memory) = run::<Automatic>(&problem, tolerance);
        let (_, explicit) = run::<Verner7>(&problem, tolerance);
        assert_eq!((memory.front, memory.statistics), (explicit.front, explicit.statistics), "at {tolerance:e}");
    }
}

#[test]
fn a_stiff_stretch_is_gone_on_with_from_a_saved_state_and_from_a_step_taken_back() {
    let problem = Following { rate: 1e5, blocks: false };
    let mut whole = start::<Automatic>(&problem, 1e-6);
    whole.advance(&problem, 4.0).expect("no trouble");
    assert_eq!([whole.memory().manner, whole.memory().regime.manner], [Manner::Implicit; 2]);
    let mut again = Integrator::<4, (), Automatic>::resume(&problem, settings(1e-6), *whole.memory());
    let mut taken_back = Integrator::<4, (), Automatic>::resume(&problem, settings(1e-6), *whole.memory());
    whole.advance(&problem, END).expect("no trouble");
    again.advance(&problem, END).expect("no trouble");
    assert_eq!(again.memory(), whole.memory());
    let told = taken_back.state_at(&problem, 4.0).0;
    taken_back.rewind(&problem, 4.0);
    assert_eq!((taken_back.memory().front.t, taken_back.memory().front.y), (4.0, told));
    taken_back.advance(&problem, END).expect("no trouble");
    let (y, ()) = taken_back.state_at(&problem, END);
    assert!((y[1] - END.sin()).abs() < 1e-5 && taken_back.memory().regime.manner == Manner::Explicit);
}

#[test]
fn what_suits_blocks_is_made_in_blocks_until_a_damper_asks_for_other_steps() {
    let calm = Following { rate: 1.0, blocks: true };
    let (_, memory) = run::<Automatic>(&calm, 1e-9);
    let (_, in_blocks) = run::<Cong8>(&calm, 1e-9);
    assert_eq!((memory.front, memory.statistics.steps), (in_blocks.front, in_blocks.statistics.steps));
    // Too fast for blocks of the accuracy, not yet for the explicit method.
    let damped = Following { rate: 400.0, blocks: true };
    let mut whole = start::<Automatic>(&damped, 1e-9);
    whole.advance(&damped, 4.0).expect("no trouble");
    assert_ne!(whole.memory().manner, Manner::Block, "{:?}", whole.memory().regime);
    let mut again = Integrator::<4, (), Automatic>::resume(&damped, settings(1e-9), *whole.memory());
    for integrator in [&mut whole, &mut again] {
        integrator.advance(&damped, END).expect("no trouble");
    }
    assert_eq!(again.memory(), whole.memory());
    let (y, ()) = whole.state_at(&damped, END);
    assert!((y[1] - END.sin()).abs() < 1e-7, "{y:?}");
    let (_, in_blocks) = run::<Cong8>(&damped, 1e-9);
    let [found, all] = [whole.memory(), &in_blocks].map(|memory| memory.statistics.evaluations);
    assert!(3 * found < 2 * all, "{found} evaluations, in blocks alone {all}");
    // And on to the implicit one.
    let mut stiff = start::<Automatic>(&Following { rate: 1e5, ..damped }, 1e-6);
    stiff.advance(&Following { rate: 1e5, ..damped }, 4.0).expect("no trouble");
    assert_eq!(stiff.memory().manner, Manner::Implicit, "{:?}", stiff.memory().regime);
}

/// The same motion, but without derivatives.
struct Unknown(Following);

impl Problem<4> for Unknown {
    type Modes = ();

    fn rates(&self, modes: &(), t: f64, y: &[f64; 4], rates: &mut [f64; 4]) {
        self.0.rates(modes, t, y, rates);
    }

    fn jacobian(&self, (): &(), _: f64, _: &[f64; 4], jacobian: &mut Jacobian<4>) {
        jacobian.state = [[f64::NAN; 4]; 4];
    }

    fn scales(&self) -> &[f64; 4] {
        self.0.scales()
    }

    fn longest_step(&self) -> f64 {
        self.0.longest_step()
    }

    fn guard_count(&self) -> usize {
        0
    }

    fn guards(&self, (): &(), _: f64, _: &[f64; 4], _: &mut [Guard; GUARDS]) {}

    fn guard_scale(&self) -> f64 {
        1.0
    }

    fn cross(&self, modes: &(), t: f64, y: &mut [f64; 4], crossed: &Crossed) -> Reset<()> {
        self.0.cross(modes, t, y, crossed)
    }
}

#[test]
fn where_derivatives_are_none_the_explicit_method_goes_on() {
    let problem = Unknown(Following { rate: 1e4, blocks: false });
    let mut integrator = Integrator::<4, (), Automatic>::start(&problem, settings(1e-6), 0.0, [0.0, 0.0, 1.0, 1.0], ());
    integrator.advance(&problem, END).expect("a motion without trouble");
    let (y, ()) = integrator.state_at(&problem, END);
    assert!((y[1] - END.sin()).abs() < 1e-5, "{y:?}");
    let Memory { regime, statistics, .. } = integrator.memory();
    println!("{statistics:?}");
    assert!(regime.patience > 32 && statistics.rejected >= 8, "never tried: {regime:?}");
}
