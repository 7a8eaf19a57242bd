//! One method a file: coefficients as printed, and where they are printed.
#![expect(clippy::excessive_precision, reason = "coefficients stand as printed")]

mod automatic;
mod bs3;
mod cong8;
mod dop853;
mod dopri5;
mod rk4;
mod rodas4;
mod verner7;

pub use automatic::Automatic;
pub use bs3::Bs3;
pub use cong8::Cong8;
pub use dop853::Dop853;
pub use dopri5::Dopri5;
pub use rk4::{Rk4, Rk4Unlocated};
pub use rodas4::Rodas4;
pub use verner7::Verner7;
