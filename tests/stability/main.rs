//! Hard cases: what must still hold where a mechanism or a host goes to extremes.
//!
//! A case is a scene file in `cases/`, whose head tells what makes it hard, and a row of claims in `table.rs`.
#![allow(clippy::panic)]

mod claims;
mod ends;
mod law;
mod run;
mod special;
mod statistics;
mod table;
