//! Bogacki and Shampine 3(2): P. Bogacki, L. F. Shampine, A 3(2) pair of Runge-Kutta formulas, Appl.
//! Math. Lett. 2 (1989) 321-325.

use crate::integrator::tableau::{Explicit, Tableau};

/// The order-3 pair of four stages, the last of which is the next step's first.
#[derive(Clone, Copy, Debug)]
pub struct Bs3;

const WEIGHTS: [f64; 4] = [2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0, 0.0];
const EMBEDDED: [f64; 4] = [7.0 / 24.0, 1.0 / 4.0, 1.0 / 3.0, 1.0 / 8.0];

impl Explicit for Bs3 {
    const NAME: &'static str = "bs3";
    const TABLEAU: Tableau = Tableau {
        stages: 4,
        order: 3,
        c: Tableau::row(&[0.0, 0.5, 0.75, 1.0]),
        a: Tableau::rows(&[&[], &[0.5], &[0.0, 0.75], &WEIGHTS]),
        b: Tableau::row(&WEIGHTS),
        error: Tableau::difference(&WEIGHTS, &EMBEDDED),
        coarse_error: None,
        error_power: 3.0,
        first_same_as_last: true,
    };
}

const _: () = assert!(Bs3::TABLEAU.is_consistent());
