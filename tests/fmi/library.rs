//! The shared library as a host loads it.

use crate::host::Slave;
use crate::host::api::Api;
use slidercrank::fmi::Status;
use slidercrank::fmi::lifecycle::Call;
use std::path::PathBuf;
use std::process::Command;

/// The library that cargo built beside this test.
fn library() -> PathBuf {
    let test = std::env::current_exe().expect("a path");
    let name = libloading::library_filename("slidercrank");
    let beside = test.parent().expect("a folder").join(&name);
    if beside.exists() { beside } else { test.ancestors().nth(2).expect("a folder").join(name) }
}

#[test]
fn a_loaded_library_runs_as_the_linked_one() {
    // SAFETY: our own library, whose initializers do nothing.
    let library = unsafe { libloading::Library::new(library()) }.expect("a shared library");
    let loaded = Slave::of(Api::loaded(&library).expect("all functions"), "loaded", true);
    assert_eq!(loaded.enter(), Status::Ok);
    loaded.wear();
    assert_eq!(loaded.exit(), Status::Ok);
    let linked = Slave::running();
    for slave in [&loaded, &linked] {
        slave.steps(0.0, 1e-4, 20);
    }
    assert_eq!(loaded.picture(), linked.picture());
    drop(loaded);
    library.close().expect("an unloaded library");
}

#[test]
fn the_list_of_calls_is_the_list_of_functions() {
    let mut calls: Vec<_> = Call::ALL.iter().map(|call| call.name()).collect();
    let mut functions = Api::NAMES.to_vec();
    calls.sort_unstable();
    functions.sort_unstable();
    assert_eq!(calls, functions);
    assert_eq!(calls.len(), 44);
}

#[test]
#[cfg(target_os = "linux")]
fn the_functions_of_the_standard_are_exported_and_nothing_else() {
    let output = Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output().expect("nm");
    let text = String::from_utf8(output.stdout).expect("text");
    let mut exported: Vec<_> = text.lines().filter_map(|line| line.split(' ').nth(2)).collect();
    let mut expected = Api::NAMES.to_vec();
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
