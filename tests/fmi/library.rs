//! The shared library as a host loads it.

use host::api::Api;
use host::library;
use slidercrank::fmi::v2::abi::{estimation, functions};
use slidercrank::fmi::v2::lifecycle::Call;
use slidercrank::fmi::v3;
use std::process::Command;

#[test]
fn the_library_the_lifecycle_and_the_standard_have_the_same_functions() {
    let mut calls: Vec<_> = Call::ALL.iter().map(|call| call.name()).collect();
    let mut functions = Api::NAMES.to_vec();
    calls.sort_unstable();
    functions.sort_unstable();
    assert_eq!(calls, functions);
    assert_eq!(calls.len(), 44);
    let mut declared = functions::NAMES.to_vec();
    declared.sort_unstable();
    assert_eq!(declared, functions);
}

#[test]
#[cfg(target_os = "linux")]
fn the_functions_of_the_standard_and_of_estimation_are_exported_and_nothing_else() {
    let output = Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output().expect("nm");
    let text = String::from_utf8(output.stdout).expect("text");
    let mut exported: Vec<_> = text.lines().filter_map(|line| line.split(' ').nth(2)).collect();
    let mut expected = [Api::NAMES, estimation::NAMES, v3::abi::functions::NAMES, v3::abi::estimation::NAMES].concat();
    exported.sort_unstable();
    expected.sort_unstable();
    assert_eq!(exported, expected);
}

#[test]
#[cfg(target_os = "linux")]
fn the_library_stays_in_memory_and_needs_the_c_library_only() {
    let output = Command::new("readelf").arg("-d").arg(library()).output().expect("readelf");
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(text.contains("NODELETE"), "{text}");
    let needed = text.lines().filter(|line| line.contains("(NEEDED)"));
    for line in needed {
        let known = ["libc.so", "libm.so", "libgcc_s.so", "ld-linux", "libdl.so", "libpthread.so"];
        assert!(known.iter().any(|name| line.contains(name)), "{line}");
    }
}
