//! The classical fourth-order method of Kutta (1901). It has no error estimate, so its step is fixed.

use crate::integrator::tableau::{MAX_STAGES, Tableau};

/// The classical method at a fixed step, with event location.
pub static RK4: Tableau = Tableau {
    name: "rk4",
    stages: 4,
    order: 4,
    c: Tableau::row(&[0.0, 0.5, 0.5, 1.0]),
    a: Tableau::rows(&[&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]]),
    b: Tableau::row(&[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]),
    error: [0.0; MAX_STAGES],
    coarse_error: None,
    error_power: 4.0,
    first_same_as_last: false,
    locates: true,
};

/// The classical method without event location: a contact closes or opens at the end of a step. It serves to compare
/// with codes that do not locate impacts.
pub static RK4_UNLOCATED: Tableau = Tableau { name: "rk4_unlocated", locates: false, ..RK4 };

const _: () = assert!(RK4.is_consistent());
