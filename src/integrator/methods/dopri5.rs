//! Dormand–Prince 5(4): J. R. Dormand, P. J. Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math.
//! 6 (1980) 19-26, RK5(4)7M.

use crate::integrator::tableau::Tableau;

const WEIGHTS: [f64; 7] = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0, 0.0];
const EMBEDDED: [f64; 7] =
    [5179.0 / 57600.0, 0.0, 7571.0 / 16695.0, 393.0 / 640.0, -92097.0 / 339200.0, 187.0 / 2100.0, 1.0 / 40.0];

/// The order-5 pair of seven stages; the last stage is the first of the next step.
pub static DOPRI5: Tableau = Tableau {
    name: "dopri5",
    stages: 7,
    order: 5,
    c: Tableau::row(&[0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0]),
    a: Tableau::rows(&[
        &[],
        &[1.0 / 5.0],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
        &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
        &WEIGHTS,
    ]),
    b: Tableau::row(&WEIGHTS),
    error: Tableau::difference(&WEIGHTS, &EMBEDDED),
    coarse_error: None,
    error_power: 5.0,
    first_same_as_last: true,
    locates: true,
};

const _: () = assert!(DOPRI5.is_consistent());
