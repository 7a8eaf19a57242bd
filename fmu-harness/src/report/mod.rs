//! What a run says, in figures and in numbers.

pub mod bars;
pub mod contest;
pub mod figure;
pub mod loglog;
pub mod plot;
pub mod price;
pub mod summary;
pub mod table;
pub mod units;
