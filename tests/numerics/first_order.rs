//! First-order states beside positions, and states that the error norm does not weigh.

use super::free::begin;
use slidercrank::integrator::dense_output::{Correction, Step};
use slidercrank::integrator::{Events, Jacobian, Linearizable, Ode, Settings, SeveralInstants, StateLayout, WorkLimit};

/// q̈ = −q from (0, 1), ż = q − z from ½, ẇ = z from 0.
struct Following {
    weighted: usize,
    states: usize,
    /// [s] Longest step.
    longest: f64,
}

impl Following {
    /// Steps short enough for degree five inside them.
    fn in_short_steps(weighted: usize, states: usize) -> Self {
        Self { weighted, states, longest: 0.05 }
    }
}

static UNIT: [f64; 4] = [1.0; 4];

impl Ode for Following {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout { positions: 1, places: 1, weighted: self.weighted, states: self.states }
    }

    fn rates(&self, (): &(), _: f64, y: &[f64], rates: &mut [f64]) {
        let all = [y[1], -y[0], y[0] - y[2], y[2]];
        rates.copy_from_slice(&all[..self.states]);
    }

    fn scales(&self) -> &[f64] {
        &UNIT
    }

    fn longest_step(&self) -> f64 {
        self.longest
    }
}

impl Linearizable for Following {
    fn jacobian(&self, (): &(), _: f64, _: &[f64], jacobian: &mut Jacobian) {
        for (i, j, slope) in [(0, 1, 1.0), (1, 0, -1.0), (2, 0, 1.0), (2, 2, -1.0), (3, 2, 1.0)] {
            jacobian.row_mut(i)[j] = slope;
        }
    }
}

impl SeveralInstants for Following {}

impl Events for Following {}

fn start(problem: &Following) -> &'static [f64] {
    const ALL: [f64; 4] = [0.0, 1.0, 0.5, 0.0];
    &ALL[..problem.states]
}

/// z = e^(−t) + (sin t − cos t)/2, w = ∫z.
fn known(t: f64) -> [f64; 4] {
    let (sin, cos) = t.sin_cos();
    let fading = (-t).exp();
    [sin, cos, fading + 0.5 * (sin - cos), 1.0 - fading + 0.5 * (1.0 - cos - sin)]
}

fn errors(method: &str, problem: &Following, tolerance: f64) -> (f64, u64) {
    let settings = Settings { tolerance, fixed_step: 1e-2, effort: WorkLimit::ANY };
    let mut integrator = begin(method, problem, settings, 0.0, start(problem), ());
    let mut worst = 0.0f64;
    for i in 1..=500 {
        let t = 0.01 * f64::from(i);
        integrator.advance(problem, t).expect("no trouble");
        let (y, ()) = integrator.state_at(problem, t);
        for (found, wanted) in y.iter().zip(known(t)).take(problem.states) {
            worst = worst.max((found - wanted).abs());
        }
    }
    (worst, integrator.state().statistics.steps)
}

#[test]
fn first_order_states_are_as_accurate_as_positions_inside_steps_too() {
    let problem = Following::in_short_steps(4, 4);
    for tolerance in [1e-7, 1e-10] {
        for (name, (error, steps)) in [
            ("dopri5", errors("dopri5", &problem, tolerance)),
            ("verner7", errors("verner7", &problem, tolerance)),
            ("dop853", errors("dop853", &problem, tolerance)),
        ] {
            println!("{name} at {tolerance:e}: {error:.1e} in {steps} steps");
            assert!(error < 10.0 * tolerance, "{name} at {tolerance:e}: {error:e}");
        }
    }
    let (error, _) = errors("rk4", &problem, 1.0);
    assert!(error < 1e-9, "rk4: {error:e}");
}

#[test]
fn inside_long_blocks_all_states_are_as_accurate_as_at_their_ends() {
    let problem = Following { weighted: 4, states: 4, longest: 4.0 };
    for (tolerance, most) in [(1e-6, 16), (1e-9, 24), (1e-12, 40)] {
        let (error, steps) = errors("cong8", &problem, tolerance);
        println!("cong8 at {tolerance:e}: {error:.1e} in {steps} steps");
        assert!(error < 2.0 * tolerance, "{tolerance:e}: {error:e}");
        assert!(steps <= most, "{tolerance:e}: {steps} steps are not long");
    }
}

#[test]
fn a_state_that_is_not_weighed_changes_no_step() {
    let run = |problem: Following| {
        let settings = Settings { tolerance: 1e-13, fixed_step: 0.0, effort: WorkLimit::ANY };
        let mut integrator = begin("verner7", &problem, settings, 0.0, start(&problem), ());
        integrator.advance(&problem, 20.0).expect("no trouble");
        let memory = integrator.state();
        (memory.front().t, memory.front().y[..3].to_vec(), memory.statistics)
    };
    let alone = run(Following::in_short_steps(3, 3));
    assert_eq!(run(Following::in_short_steps(3, 4)), alone);
    assert_ne!(run(Following::in_short_steps(4, 4)).0, alone.0, "a weighted state counts");
}

#[test]
fn inside_a_step_a_polynomial_of_degree_five_is_exact() {
    struct Power;
    impl Ode for Power {
        type Discrete = ();

        fn layout(&self) -> StateLayout {
            StateLayout { positions: 0, places: 0, weighted: 1, states: 1 }
        }

        fn rates(&self, (): &(), t: f64, _: &[f64], rates: &mut [f64]) {
            rates[0] = 5.0 * t.powi(4) - 6.0 * t * t;
        }

        fn scales(&self) -> &[f64] {
            &UNIT
        }

        fn longest_step(&self) -> f64 {
            1.0
        }
    }

    impl Linearizable for Power {
        fn jacobian(&self, (): &(), t: f64, _: &[f64], jacobian: &mut Jacobian) {
            jacobian.row_mut(0)[0] = 0.0;
            jacobian.time[0] = 20.0 * t.powi(3) - 12.0 * t;
        }
    }

    impl SeveralInstants for Power {}

    impl Events for Power {}

    let value = |t: f64| t.powi(5) - 2.0 * t.powi(3);
    let ends = |t: f64| {
        let (mut y, mut f) = ([0.0], [0.0]);
        y[0] = value(t);
        Power.rates(&(), t, &y, &mut f);
        (y, f)
    };
    let ((y0, f0), (y1, f1)) = (ends(0.3), ends(1.1));
    let step = Step { t: 0.3, h: 0.8, y0: &y0, f0: &f0, y1: &y1, f1: &f1, layout: Power.layout() };
    let mut correction = Correction::new(1);
    correction.find(&step, &Power, &(), 1e-6);
    for i in 0..=20 {
        let s = f64::from(i) / 20.0;
        let mut found = [0.0];
        step.state(s, correction.coefficients(), &mut found);
        let [found] = found;
        assert!((found - value(0.3 + 0.8 * s)).abs() < 1e-15, "at {s}: {found}");
    }
}
