//! Every command on the scenes that are shipped with it: it ends well, and no row of a table is without numbers.
//!
//! `peers` is left out, as what it compares with comes from elsewhere, and so is `ssp`, which the tests of the hosts run.

use fmu_harness::scenes::{contests, directory, names};
use rayon::prelude::*;
use std::path::Path;
use std::process::Command;

/// The one shipped scene whose crank stands: it has no turns.
const STANDING: &str = "hold";
/// The one whose prescribed crank leaves nothing free: its motion has no neighbours.
const PRESCRIBED: &str = "ideal";
/// Under each table stands a sentence for every row without numbers.
const GAP: &str = "has no numbers";

/// Runs a command and tells what is wrong with it.
fn wrong(arguments: &[&str], out: &Path) -> Option<String> {
    let output = Command::new(env!("CARGO_BIN_EXE_fmu-harness")).args(arguments).arg("-o").arg(out).output();
    let output = output.expect("the program starts");
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    let well = output.status.success() && !text.contains(GAP) && !text.contains("NaN");
    (!well).then(|| format!("{}: {}\n{text}", arguments.join(" "), output.status))
}

/// Runs all of these, each with a directory of its own, and finds nothing wrong.
fn all_end_well(commands: &[Vec<&str>]) {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let one = |(number, arguments): (usize, &Vec<&str>)| wrong(arguments, &folder.path().join(number.to_string()));
    let found: Vec<String> = commands.par_iter().enumerate().filter_map(one).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

fn shipped() -> Vec<String> {
    [names(&directory()), contests()].concat()
}

#[test]
fn accuracy_has_a_number_in_every_row_of_every_scene() {
    let scenes = shipped();
    let moving = scenes.iter().filter(|scene| *scene != STANDING);
    all_end_well(
        &moving.map(|scene| vec!["accuracy", "--scene", scene, "--transient", "0", "--turns", "1"]).collect::<Vec<_>>(),
    );
}

#[test]
fn dynamics_comes_to_a_verdict_on_every_scene() {
    let scenes = shipped();
    let moving = scenes.iter().filter(|scene| ![STANDING, PRESCRIBED].contains(&scene.as_str()));
    let mut commands: Vec<Vec<&str>> =
        moving.map(|scene| vec!["dynamics", "--scene", scene, "--transient", "1", "--turns", "6"]).collect();
    let range = ["--parameter", "joint.C.clearance", "--from", "1e-4", "--to", "5e-4", "--values", "3"];
    commands.push([&["dynamics", "--transient", "1", "--turns", "6", "--value-turns", "6"], &range[..]].concat());
    all_end_well(&commands);
}

#[test]
fn run_comes_to_the_end_of_every_scene() {
    let scenes = shipped();
    let one = |scene: &'_ String| if scene == STANDING { vec![] } else { vec!["--turns", "0.5"] };
    let commands: Vec<Vec<&str>> =
        scenes.iter().map(|scene| [vec!["run", "--scene", scene.as_str()], one(scene)].concat()).collect();
    // One after the other: each packages the library that it runs.
    commands.iter().for_each(|command| all_end_well(std::slice::from_ref(command)));
}

#[test]
fn the_other_commands_have_a_number_in_every_row() {
    let study = directory().with_file_name("studies").join("speed-and-clearance.toml").display().to_string();
    let commands = [
        vec!["effects", "--quick"],
        vec!["realtime", "--steps", "100", "--budget", "20"],
        vec!["precision", "--quick", "--scene", "wornpin", "--window", "2 ms", "--span", "4 ms"],
        vec!["report", "--unmeasured", "--transient", "2", "--turns", "6"],
        vec!["campaign", "--kind", "machines", "--scenes", "8", "--turns", "5"],
        vec!["sweep", &study, "--plan"],
    ];
    commands.iter().for_each(|command| all_end_well(std::slice::from_ref(command)));
}

#[test]
fn a_row_without_numbers_is_told_under_the_table_and_fails_the_command() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    // A crank that must pass where its rod stands across the guide.
    let scene = folder.path().join("stuck.toml");
    let text = std::fs::read_to_string(directory().join("press.toml")).expect("a scene");
    std::fs::write(&scene, text.replace("length = \"500 mm\"\nmass = 60", "length = \"15 mm\"\nmass = 60"))
        .expect("written");
    let scene = scene.display().to_string();
    let arguments = ["accuracy", "--scene", &scene, "--transient", "0", "--turns", "1"];
    let found = wrong(&arguments, folder.path()).expect("some of its mechanisms cannot go round");
    assert!(found.contains("none has no numbers: none: "), "{found}");
    assert!(found.contains("error: ") && found.contains("of the rows above"), "{found}");
}
