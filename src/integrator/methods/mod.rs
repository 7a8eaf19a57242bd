//! Integration methods, one per file: coefficients as printed in the source, with the citation.
#![expect(clippy::excessive_precision, reason = "coefficients stand as printed")]

pub mod automatic;
pub mod bathe;
pub mod block;
mod bs3;
mod dop853;
mod dopri5;
pub mod explicit;
pub mod moreau;
mod radau13;
mod rk4;
mod rodas4;
pub mod rosenbrock;
mod stiffness_switch;
mod verner7;

pub use bs3::BS3;
pub use dop853::DOP853;
pub use dopri5::DOPRI5;
pub use rk4::{RK4, RK4_UNLOCATED};
pub use rodas4::RODAS4;
pub use verner7::VERNER7;

use super::method::Method;
use super::tableau::Tableau;
use automatic::Automatic;
use bathe::Bathe;
use block::Cong8;
use explicit::Explicit;
use radau13::Radau13;
use rosenbrock::Rosenbrock;

/// All explicit Runge-Kutta methods.
pub static EXPLICIT: [&Tableau; 6] = [&BS3, &DOPRI5, &VERNER7, &DOP853, &RK4, &RK4_UNLOCATED];

/// The method of this name in the `solver.method` enumeration, for `states` states; `None` for an unknown name.
pub fn named<D: Copy + 'static>(name: &str, states: usize) -> Option<Box<dyn Method<D>>> {
    if let Some(tableau) = EXPLICIT.into_iter().find(|tableau| tableau.name == name) {
        return Some(Box::new(Explicit::new(tableau, states)));
    }
    match name {
        "automatic" => Some(Box::new(Automatic::new(states))),
        "bathe" => Some(Box::new(Bathe::new(states))),
        "cong8" => Some(Box::new(Cong8::new(states))),
        "radau13" => Some(Box::new(Radau13::new(states))),
        "rodas4" => Some(Box::new(Rosenbrock::new(&RODAS4, states))),
        _ => None,
    }
}
