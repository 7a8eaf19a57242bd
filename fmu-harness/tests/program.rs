//! The program under test, and libraries as it builds them.
//!
//! zig comes first, where it can be installed: the command `package` would install it between two tests, and the
//! libraries, linked by the machine's own linker until then, would be built a second time.

use fmu_harness::package::Stock;
use fmu_harness::package::build::prepare;
use fmu_harness::package::platform::Platform;
use std::process::Command;
use std::sync::{Once, OnceLock};

/// Sets up the tools that build for this machine. What is missing is told by the tests that need it.
fn tools() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| drop(Platform::here().and_then(prepare)));
}

/// The program.
pub fn program() -> Command {
    tools();
    Command::new(env!("CARGO_BIN_EXE_fmu-harness"))
}

/// The libraries for this machine, built once for all tests.
pub fn stock() -> &'static Stock {
    static STOCK: OnceLock<Stock> = OnceLock::new();
    STOCK.get_or_init(|| {
        tools();
        Stock::build().expect("libraries")
    })
}
