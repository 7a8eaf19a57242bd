//! Bogacki–Shampine 3(2): P. Bogacki, L. F. Shampine, A 3(2) pair of Runge-Kutta formulas, Appl. Math. Lett. 2 (1989)
//! 321-325.

use crate::integrator::tableau::Tableau;

const WEIGHTS: [f64; 4] = [2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0, 0.0];
const EMBEDDED: [f64; 4] = [7.0 / 24.0, 1.0 / 4.0, 1.0 / 3.0, 1.0 / 8.0];

/// The order-3 pair of four stages; the last stage is the first of the next step.
pub static BS3: Tableau = Tableau {
    name: "bs3",
    stages: 4,
    order: 3,
    c: Tableau::row(&[0.0, 0.5, 0.75, 1.0]),
    a: Tableau::rows(&[&[], &[0.5], &[0.0, 0.75], &WEIGHTS]),
    b: Tableau::row(&WEIGHTS),
    error: Tableau::difference(&WEIGHTS, &EMBEDDED),
    coarse_error: None,
    error_power: 3.0,
    first_same_as_last: true,
    locates: true,
};

const _: () = assert!(BS3.is_consistent());
