//! The classical fourth-order method, Kutta 1901; no error estimate, so its step is fixed.

use crate::integrator::tableau::{Method, STAGES, Tableau};

/// The classical method at a fixed step.
#[derive(Clone, Copy, Debug)]
pub struct Rk4;

impl Method for Rk4 {
    const NAME: &'static str = "rk4";
    const TABLEAU: Tableau = Tableau {
        stages: 4,
        order: 4,
        c: Tableau::row(&[0.0, 0.5, 0.5, 1.0]),
        a: Tableau::rows(&[&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]]),
        b: Tableau::row(&[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]),
        error: [0.0; STAGES],
        coarse_error: None,
        error_power: 4.0,
        first_same_as_last: false,
    };
}

const _: () = assert!(Rk4::TABLEAU.is_consistent());
