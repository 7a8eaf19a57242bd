//! The packaged FMUs in hosts that others wrote: FMPy, fmutool, fmucontainer, ecos, libcosim, fmuloader, fmi-rs.
//!
//! Each test here is a file of Python tests beside this one, run by pytest in an environment that
//! `fmu_harness::python` makes under `target/` from the pinned list `python/hosts.txt`. README.md tells
//! where each of the things that hosts do to an FMU is tested.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]
#![allow(clippy::panic, reason = "a test's way to fail")]

mod mechanisms;
mod packages;
mod price;
mod rust_importer;
mod ssp;

use crate::pytest::Suite;
use fmu_harness::python::sources;
use std::env::join_paths;
use std::path::Path;
use std::sync::OnceLock;

static HOSTS: Suite = Suite {
    python: OnceLock::new(),
    environment: "hosts",
    folder: "hosts",
    source: include_str!("mod.rs"),
    variables: || {
        let modules = join_paths([sources(), sources().join("press")]).expect("paths without a separator");
        vec![("SLIDERCRANK_FMUS", packages::directory().into()), ("PYTHONPATH", modules)]
    },
};

/// The environment's interpreter.
fn python() -> &'static Path {
    HOSTS.python()
}

files! { HOSTS:
    every_validator_accepts_the_package             "test_description.py"
    fmpy_runs_it_as_the_harness_does                "test_simulate.py"
    importers_that_integrate_get_the_same_motion    "test_exchange.py"
    a_restored_run_is_the_run                       "test_states.py"
    no_split_of_time_changes_the_result             "test_steps.py"
    instances_know_nothing_of_each_other            "test_instances.py"
    derivatives_are_what_they_are_called            "test_derivatives.py"
    the_odd_ways_of_hosts_lead_to_the_same_result   "test_odd_hosts.py"
    libcosim_computes_what_fmpy_computes            "test_cosim.py"
    two_in_a_container_equal_two_alone              "test_container.py"
    the_package_of_fmi_3_tells_events               "test_fmi3.py"
    a_press_with_its_drive_is_a_valid_package       "test_ssp.py"
    a_press_with_its_drive_runs_alike_in_two_hosts  "test_ssp_hosts.py"
    masters_of_the_press_keep_their_books           "test_ssp_masters.py"
    the_drive_of_the_press_keeps_its_rules          "test_ssp_drive.py"
}
