//! Hard cases: what must still hold where a mechanism or a host goes to extremes.
//!
//! A case is a scene file in `cases/`, whose head tells what makes it hard, and a row of claims in `table.rs`. Scenes that
//! a campaign has found are kept in `regressions/`.
#![allow(clippy::panic)]

mod claims;
mod deadline;
mod ends;
mod law;
mod long_steps;
mod regressions;
mod rounding;
mod run;
mod special;
mod statistics;
mod table;
#[path = "../../fmu-harness/src/campaign/trial.rs"]
mod trial;
