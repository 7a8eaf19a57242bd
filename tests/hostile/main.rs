//! Hosts that call the FMU as no sane host would.
//!
//! Under valgrind, with a part of every product only (some two minutes):
//!
//! ```sh
//! export SLIDERCRANK_TEST_BRIEF=1
//! export CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER="valgrind --leak-check=full --errors-for-leak-kinds=definite --error-exitcode=9"
//! cargo test --test hostile -- --test-threads=1
//! ```
//!
//! With `--tool=helgrind` and the filter `concurrency`, what is reported are atomics of the standard library, of the C library
//! and of [`slidercrank::fmi::abi::component`]: valgrind takes them for plain memory.
#![allow(unsafe_code, reason = "the tests call the C functions")]
#![allow(clippy::panic, reason = "a test that cannot go on")]

#[path = "../fmi3/importer.rs"]
mod importer;
#[macro_use]
mod face;

mod arguments;
mod bytes;
mod concurrency;
mod estimators;
mod exchange_of_all;
mod exchanged;
mod extremes;
mod forged;
mod importers_memory;
mod instantiate;
mod invalid_arguments;
mod invoke;
mod memory;
mod mixed;
mod product;
mod random;
mod references;
mod reload;
mod scenes;
mod stage;
mod three;
mod two;

/// Whether a part of every product is enough.
fn brief() -> bool {
    std::env::var_os("SLIDERCRANK_TEST_BRIEF").is_some()
}

/// Set for copies of this program with other mechanisms.
const COPY: &str = "SLIDERCRANK_TEST_COPY";

/// How many of so many cases are tried. Copies of this program share them.
fn tried(cases: u32) -> u32 {
    if std::env::var_os(COPY).is_some() { cases / 5 } else { cases }
}
