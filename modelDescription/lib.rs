//! The declaration of the FMU's face and what is made from it: the library's `build.rs` makes its tables, the command
//! `package` the XML and the page of an FMU.

pub mod arrays;
pub mod clocks;
mod definitions;
mod element;
pub mod exchange;
mod fault;
pub mod guid;
pub mod number;
pub mod page;
pub mod raw;
mod restitution;
pub mod rows;
mod structure;
pub mod tables;
pub mod terminals;
mod typed;
pub mod xml;
pub mod xml_v3;

/// Reads the declaration.
pub fn load() -> Result<rows::Declaration, rows::RowError> {
    rows::read(include_str!("variables.toml"))
}
