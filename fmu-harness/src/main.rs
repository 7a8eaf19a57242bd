//! Builds, packages, loads and runs the FMU.
fn main() {}
