//! Results as figures, tables and pages.

pub mod accuracy;
pub mod bars;
pub mod budget;
pub mod campaign;
pub mod contest;
pub mod deadline;
pub mod docs;
pub mod dots;
pub mod dynamics;
pub mod figure;
pub mod interactive;
pub mod laws;
pub mod loglog;
pub mod named;
pub mod page;
pub mod plot;
pub mod precision;
pub mod price;
pub mod realtime;
pub mod sensitivity;
pub mod ssp;
pub mod study;
pub mod summary;
pub mod table;
mod thinning;
pub mod units;
pub mod wear;
