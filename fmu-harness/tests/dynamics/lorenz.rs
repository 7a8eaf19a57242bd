//! Lorenz's equations at their classical parameters, whose exponent is 0.9056 (J. C. Sprott, Chaos and Time-Series
//! Analysis, Oxford 2003, appendix A).

use super::system::System;
use fmu_harness::dynamics::Flow;
use fmu_harness::dynamics::lyapunov::Probe;
use slidercrank::integrator::{Events, Linearizable, Ode, SeveralInstants, StateLayout};

pub struct Lorenz;

static SCALES: [f64; 3] = [1.0; 3];

impl Ode for Lorenz {
    type Discrete = ();

    fn layout(&self) -> StateLayout {
        StateLayout { positions: 0, places: 0, weighted: 3, states: 3 }
    }

    fn rates(&self, _: &(), _: f64, y: &[f64], rates: &mut [f64]) {
        let [x, y, z] = [y[0], y[1], y[2]];
        rates.copy_from_slice(&[10.0 * (y - x), x * (28.0 - z) - y, x * y - 8.0 / 3.0 * z]);
    }

    fn scales(&self) -> &[f64] {
        &SCALES
    }

    fn longest_step(&self) -> f64 {
        1.0
    }
}

impl Linearizable for Lorenz {}

impl SeveralInstants for Lorenz {}

impl Events for Lorenz {}

#[test]
fn the_exponent_of_lorenz_is_found_within_its_own_error() {
    let mut flow = System::start(Lorenz, [1.0, 1.0, 20.0]);
    flow.advance(50.0).expect("it goes on");
    let probe = Probe { interval: 0.5, count: 8000, settling: 20, distance: 1e-4 };
    let exponent = probe.measure(&mut flow, &mut System::start(Lorenz, [0.0; 3]), || {}).expect("an exponent");
    assert!(exponent.error < 0.01, "{}", exponent.error);
    let apart = (exponent.value - 0.9056) / exponent.error;
    assert!(apart.abs() < 4.0, "{} ± {}", exponent.value, exponent.error);
}
