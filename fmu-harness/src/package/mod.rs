//! Library + description + documents → a `.fmu` whose bytes depend on nothing else.

pub mod archive;
mod build;
mod elf;
mod licences;
