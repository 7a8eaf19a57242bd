//! What a run says, in figures and in numbers.

pub mod figure;
pub mod plot;
pub mod summary;
pub mod table;
pub mod units;
