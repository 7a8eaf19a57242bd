//! The program, from outside.

use super::workshop::Workshop;
use crate::program::program;
use fmu_harness::trajectory::Trajectory;
use std::fs;
use std::process::Output;

fn harness(arguments: &[&str]) -> Output {
    program().args(arguments).output().expect("the program starts")
}

/// One line of complaint and a failure.
fn refusal(arguments: &[&str]) -> String {
    let output = harness(arguments);
    let words = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    assert!(!output.status.success(), "{arguments:?} must fail");
    words
}

#[test]
fn a_foreign_fmu_runs_with_inputs_from_a_table() {
    let workshop = Workshop::open();
    let (fmu, out) = (workshop.good(), workshop.directory.path().join("out"));
    let table = workshop.directory.path().join("inputs.csv");
    fs::write(&table, "time,u\n0,0\n1,0\n1.5,4\n").expect("written");
    let [fmu, table, directory] = [&fmu, &table, &out].map(|path| path.to_str().expect("UTF-8"));
    let output = harness(&["run", "--fmu", fmu, "--input", table, "--set", "k=8", "--step", "0.25", "-o", directory]);
    let words = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(words.contains("least") && words.contains("steps"), "{words}");
    let trajectory = Trajectory::read_csv(&out.join("decay.csv")).expect("a table");
    assert_eq!(trajectory.times().last(), Some(&2.0), "the FMU's own stop time");
    // u is held at 0, 2, 4, 4 over the intervals from 1 s on, and x comes e⁻² times nearer to u/k in each.
    let mut x = (-8.0_f64).exp();
    for level in [0.0, 0.25, 0.5, 0.5] {
        x = level + (x - level) * (-2.0_f64).exp();
    }
    let found = trajectory.column("x").expect("x").last().copied().expect("a row");
    assert!((found - x).abs() < 16.0 * f64::EPSILON, "{found}, not {x}");
}

#[test]
fn inspection_shows_a_foreign_fmu() {
    let workshop = Workshop::open();
    let output = harness(&["inspect", workshop.good().to_str().expect("UTF-8")]);
    let words = String::from_utf8_lossy(&output.stdout).into_owned();
    for line in ["model: Decay", "binaries: linux64", "default experiment: startTime 0, stepSize 0.01, stopTime 2"] {
        assert!(words.contains(line), "{line} in {words}");
    }
    let x: Vec<&str> =
        words.lines().find(|line| line.trim().starts_with("x ")).expect("x").split_whitespace().collect();
    assert_eq!(x, ["x", "0", "output", "continuous", "Real", "1", "m", "mm"]);
    assert!(words.lines().any(|line| line.contains("law") && line.ends_with("driven")), "an item by its name");
}

#[test]
fn a_refusal_is_one_clear_line() {
    let words = refusal(&["package", "--scene", "wornpn"]);
    assert!(
        words.starts_with(
            "error: there is no scene `wornpn`; the shipped scenes are allplay, ferod, flexrod, guideplay, hold, ideal, oilpress, press, seed, wornpin"
        ),
        "{words}"
    );
    assert_eq!(words.lines().count(), 1);
    assert!(refusal(&["package", "--scene", "none.toml"]).contains("cannot read none.toml: No such file"));
    let words = refusal(&["dynamics", "--section", "nan"]);
    assert!(words.contains("the section must be an angle in degrees, not NaN"), "{words}");
    for sum in ["energy.input:last", "joint.C.sliding:range", "joint.C.impact.speed:max"] {
        let words = refusal(&["dynamics", "--parameter", "joint.C.clearance", "--response", sum]);
        assert!(words.contains("an output that the state determines"), "{words}");
    }

    let workshop = Workshop::open();
    let scene = workshop.directory.path().join("bad.toml");
    fs::write(&scene, "[joint.C]\nclearence = \"0.5 mm\"\n").expect("written");
    let words = refusal(&["package", "--scene", scene.to_str().expect("UTF-8")]);
    assert!(words.contains("bad.toml") && words.contains("2:1") && words.contains("clearance"), "{words}");

    let fmu = workshop.good();
    let fmu = fmu.to_str().expect("UTF-8");
    let out = workshop.directory.path().join("out");
    let run = |more: &[&str]| refusal(&[&["run", "--fmu", fmu, "-o", out.to_str().expect("UTF-8")], more].concat());
    assert!(run(&["--step", "0"]).contains("the communication step is 0 s; it must be finite and above 0"));
    assert!(run(&["--stop=-1"]).contains("the end, -1 s, is not after the start, 0 s"));
    assert!(run(&["--turns", "3"]).contains("give a --stop time"));
    assert!(run(&["--set", "k"]).contains("expected name=value"));
    let table = workshop.directory.path().join("inputs.csv");
    fs::write(&table, "time,x\n0,0\n").expect("written");
    assert!(
        run(&["--input", table.to_str().expect("UTF-8")])
            .contains("`x` is not a real input: causality output, type Real")
    );
}
