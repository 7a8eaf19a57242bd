//! The Python package `slidercrank`: beside the harness, on a Dask cluster, in a notebook.
//!
//! Each test here is a file of Python tests beside this one, run by pytest in an environment that
//! `fmu_harness::python` makes under `target/` from the pinned list `python/analysis.txt`.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]
#![allow(clippy::panic, reason = "a test's way to fail")]

use crate::program::{program, stock};
use crate::pytest::Suite;
use fmu_harness::package::Version;
use fmu_harness::package::build::workspace;
use fmu_harness::python::sources;
use fmu_harness::scenes::Scenario;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

static PACKAGE: Suite = Suite {
    python: OnceLock::new(),
    environment: "analysis",
    folder: "python",
    source: include_str!("mod.rs"),
    variables: || {
        vec![
            ("PYTHONPATH", sources().into()),
            ("SLIDERCRANK_FMUS", packages().into()),
            ("SLIDERCRANK_HOME", workspace().into()),
            ("SLIDERCRANK_PROGRAM", program().get_program().into()),
            ("MPLBACKEND", "agg".into()),
        ]
    },
};

/// The scenes that are run, packaged once for all tests.
fn packages() -> &'static Path {
    static DIRECTORY: OnceLock<PathBuf> = OnceLock::new();
    DIRECTORY.get_or_init(|| {
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python-fmus");
        let stock = stock();
        for (name, scene, version) in [
            ("ideal", "ideal", Version::Fmi2),
            ("press", "press", Version::Fmi2),
            ("wornpin", "wornpin", Version::Fmi2),
            ("ideal3", "ideal", Version::Fmi3),
            ("wornpin3", "wornpin", Version::Fmi3),
            ("press3", "press", Version::Fmi3),
        ] {
            let scenario = Scenario::find(scene).expect("a shipped scene");
            let file = directory.join(format!("{name}.fmu"));
            stock.package_for(version, &scenario).expect("a package").save(&file).expect("a file");
        }
        directory
    })
}

files! { PACKAGE:
    the_program_is_found_and_called             "test_source.py"
    an_input_is_what_its_formula_says           "test_recipe.py"
    a_quantity_is_what_its_definition_says      "test_quantity.py"
    either_program_goes_on_from_the_journal     "test_journal.py"
    a_cluster_finds_the_bits_that_sweep_finds   "test_distributed.py"
    indices_and_optima_are_those_of_theory      "test_analysis.py"
    gradients_are_those_of_differences          "test_gradient.py"
    cycles_are_counted_as_the_standard_does     "test_durability.py"
    the_press_is_measured_as_a_shop_measures_it "test_press.py"
    a_deck_of_no_rod_is_refused                 "test_decks.py"
    a_solid_model_s_modes_are_those_of_theory   "test_modes.py"
    filters_find_what_was_put_in                "test_estimation.py"
    figures_show_what_is_in_the_frame           "test_plots.py"
    the_notebook_runs                           "test_notebook.py"
    the_package_can_be_installed                "test_install.py"
    the_package_is_typed                        "test_types.py"
}
