//! The page that `report` makes, in a browser.
//!
//! The tests are a file of Python tests beside this one. They drive Chromium, where it is installed (on Debian the
//! package `chromium`; or any browser of its kind that `SLIDERCRANK_BROWSER` names), through Playwright, in an
//! environment that `fmu_harness::python` makes under `target/` from the pinned list `python/browser.txt`. Without a
//! browser they are skipped, and say so.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]
#![allow(clippy::panic, reason = "a test's way to fail")]

use crate::program::program;
use crate::pytest::Suite;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

static BROWSER: Suite = Suite {
    python: OnceLock::new(),
    environment: "browser",
    folder: "browser",
    source: include_str!("mod.rs"),
    variables: || vec![("SLIDERCRANK_PAGES", pages().into())],
};

/// Pages of a worn pin, with everything; of a flexible rod with play all around it; and of a crank that stands.
fn pages() -> &'static Path {
    static DIRECTORY: OnceLock<PathBuf> = OnceLock::new();
    DIRECTORY.get_or_init(|| {
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pages");
        let brief = ["--transient", "1", "--turns", "12", "--unmeasured"];
        for (scene, options) in [("wornpin", &brief[..4]), ("seed", &brief[..]), ("hold", &brief[..])] {
            let mut command = program();
            command.args(["report", "--scene", scene]).args(options).arg("-o").arg(&directory);
            let output = command.output().expect("the program starts");
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        }
        directory
    })
}

files! { BROWSER:
    the_page_moves_and_reads_well "test_page.py"
}
