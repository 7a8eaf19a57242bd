//! The classical fourth-order method, Kutta 1901; no error estimate, so its step is fixed.

use crate::integrator::tableau::{Explicit, STAGES, Tableau};

/// The classical method at a fixed step.
#[derive(Clone, Copy, Debug)]
pub struct Rk4;

impl Explicit for Rk4 {
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

/// The same, blind to events within a step: a contact that closes or opens does so at the step's end.
/// For comparison with codes that do not locate impacts.
#[derive(Clone, Copy, Debug)]
pub struct Rk4Unlocated;

impl Explicit for Rk4Unlocated {
    const NAME: &'static str = "rk4_unlocated";
    const TABLEAU: Tableau = Rk4::TABLEAU;
    const LOCATES: bool = false;
}

const _: () = assert!(Rk4::TABLEAU.is_consistent());
