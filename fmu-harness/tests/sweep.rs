//! Studies: what is run, once, whatever kills or splits them.

use crate::program::stock;
use fmu_harness::frame::{Column, Frame};
use fmu_harness::scenes::Scenario;
use fmu_harness::sweep::journal::{Line, Outcome, path};
use fmu_harness::sweep::{Journal, Plan, Study, Sweep};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

const STUDY: &str = r#"
name = "own"
scene = "wornpin"
seed = 3
draws = 2

[run]
turns = 0.5
transient = 0.1
step = 1e-4

[grid]
"joint.C.clearance" = { from = "20 um", to = "80 um", count = 3, logarithmic = true }
"joint.C.law" = ["hertz", 3]

[random]
"joint.C.restitution" = { uniform = { min = 0.5, max = 0.9 } }
"slider.mass" = { normal = { mean = "140 g", deviation = 0.01, min = "130 g", max = "150 g" } }

[keep]
peak_force = { of = "joint.C.force", reduce = "peak" }
position = { of = "accuracy.position", reduce = "rms" }
"#;

fn write(directory: &Path, text: &str) -> PathBuf {
    let file = directory.join("study.toml");
    fs::write(&file, text).expect("a file");
    file
}

fn study(text: &str) -> anyhow::Result<(Study, Plan)> {
    let directory = tempfile::tempdir()?;
    let study = Study::read(&write(directory.path(), text))?;
    let plan = Plan::of(&study)?;
    Ok((study, plan))
}

/// The scene of the study, and its package in a directory.
fn packaged(directory: &Path) -> (Scenario, PathBuf) {
    let scenario = Scenario::find("wornpin").expect("a scene");
    let fmu = directory.join("wornpin.fmu");
    stock().package(&scenario).expect("a package").save(&fmu).expect("a file");
    (scenario, fmu)
}

/// What became of each run.
fn statuses(frame: &Frame) -> Vec<String> {
    let status = frame.columns().iter().find(|(name, _)| name == "status").map(|(_, column)| column.clone());
    let Some(Column::Texts(status)) = status else { unreachable!("a status") };
    status
}

#[test]
fn a_plan_is_the_whole_product_of_grid_and_draws() {
    let (_, plan) = study(STUDY).expect("a plan");
    assert_eq!(plan.names(), ["joint.C.clearance", "joint.C.law", "joint.C.restitution", "slider.mass"]);
    assert_eq!(plan.len(), 3 * 2 * 2);
    let column = |place: usize| (0..plan.len()).map(|run| plan.value(run, place)).collect::<Vec<_>>();
    assert_eq!(column(0)[..5], [2e-5, 2e-5, 2e-5, 2e-5, 4e-5].map(|x: f64| (x * 1e9).round() / 1e9));
    // The same two draws at every point of the grid.
    let draws = column(2);
    assert!(draws.chunks(2).all(|pair| pair == &draws[..2]) && draws[0] != draws[1], "{draws:?}");
    assert!(column(3).iter().all(|mass| (0.13..=0.15).contains(mass)));
}

#[test]
fn a_draw_does_not_depend_on_how_many_there_are() {
    let (_, few) = study(STUDY).expect("a plan");
    let (_, many) = study(&STUDY.replace("draws = 2", "draws = 50")).expect("a plan");
    assert_eq!((few.value(0, 2), few.value(1, 3)), (many.value(0, 2), many.value(1, 3)));
    let (_, other) = study(&STUDY.replace("seed = 3", "seed = 4")).expect("a plan");
    assert_ne!(few.value(0, 2), other.value(0, 2));
}

#[test]
fn what_is_wrong_in_a_study_is_named() {
    for (from, to, word) in [
        ("joint.C.law", "joint.C.lore", "joint.C.lore"),
        ("\"hertz\"", "\"herz\"", "herz"),
        ("\"20 um\"", "\"20 kg\"", "kg"),
        ("\"20 um\"", "-1e-6", "1e-9 to 0.1 m"),
        ("turns = 0.5", "turns = 0", "run.turns"),
        ("transient = 0.1", "transient = 2", "run.transient"),
        ("draws = 2", "draws = 0", "draws"),
        ("reduce = \"rms\"", "reduce = \"middle\"", "middle"),
        ("min = \"130 g\", max = \"150 g\"", "min = \"500 g\"", "outside"),
        (
            "min = \"130 g\", max = \"150 g\"",
            "min = \"150 g\", max = \"130 g\"",
            "`slider.mass`: min = 0.15 is above max = 0.13",
        ),
        ("min = 0.5, max = 0.9", "min = 0.9, max = 0.5", "`joint.C.restitution`: min = 0.9 is above max = 0.5"),
        ("deviation = 0.01", "deviation = -0.01", "`slider.mass`: deviation = -0.01 is not allowed: 0 or more"),
        ("deviation = 0.01", "deviation = inf", "`slider.mass`: deviation = inf is not allowed: 0 or more"),
        ("position =", "run =", "`run` in [keep]"),
        ("\"accuracy.position\"", "\"accuracy.place\"", "`position` in [keep]: `accuracy.place` is neither an output"),
        ("position =", "status =", "`status` in [keep]"),
        ("position =", "\"slider.mass\" =", "`slider.mass` in [keep]"),
        ("count = 3", "counts = 3", "unknown field `counts`, expected one of `from`, `to`, `count`, `logarithmic`"),
        ("[\"hertz\", 3]", "\"hertz\"", "expected a list of values, or a range { from, to, count, logarithmic }"),
        ("[\"hertz\", 3]", "[\"hertz\", true]", "joint.C.law = true is not allowed: 1 (hertz)"),
        ("[\"hertz\", 3]", "[[3]]", "expected a number in SI units, a text with"),
        (
            "\"joint.C.law\" = [\"hertz\", 3]",
            "\"rod.flexible.bending_modes\" = [1, 2.5]",
            "bending_modes = 2.5 is not allowed: an integer, 0 to 8",
        ),
        ("count = 3", "count = 1", "`joint.C.clearance`: a range needs at least 2 values, not 1"),
        (
            "\"joint.C.clearance\" = { from = \"20 um\", to = \"80 um\"",
            "gravity = { from = -1, to = 1",
            "`gravity`: logarithmic spacing needs",
        ),
        ("step = 1e-4", "step = \"10 kg\"", "\"10 kg\": `kg` measures something else; units are s, ms"),
        ("step = 1e-4", "step = true", "true is no number"),
        (
            "reduce = \"rms\"",
            "reduce = \"rms\", at = \"90 mm\"",
            "\"90 mm\": `mm` measures something else; units are rad",
        ),
        ("name = \"own\"", "name = \"my/own\"", "name = \"my/own\" is not allowed"),
        ("name = \"own\"", "name = 'my\\own'", "is not allowed"),
        ("[grid]", "[gird]", "gird"),
        ("\"slider.mass\"", "\"joint.C.clearance\"", "both"),
        ("count = 3", "count = 100000000", "10000000"),
    ] {
        assert!(STUDY.contains(from), "{from}");
        let error = study(&STUDY.replace(from, to)).expect_err(word);
        assert!(format!("{error:#}").contains(word), "{word}: {error:#}");
    }
}

#[test]
fn values_have_units_and_truth_values_their_names() {
    let told = STUDY
        .replace("step = 1e-4", "step = \"100 us\"")
        .replace("reduce = \"rms\"", "reduce = \"rms\", at = \"90 deg\"")
        .replace("[random]", "\"energy.audit\" = [true, false]\n[random]");
    let (told, plan) = study(&told).expect("a plan");
    assert_eq!((told.run.step, told.keep["position"].at), (1e-4, Some(std::f64::consts::FRAC_PI_2)));
    let place = plan.names().iter().position(|name| name == "energy.audit").expect("a parameter");
    assert_eq!([0, plan.len() - 1].map(|run| plan.value(run, place)), [1.0, 0.0]);
    assert_eq!((told.keep["peak_force"].at, plan.len()), (None, 24));
}

#[test]
fn another_table_of_modes_is_another_study() {
    let (study, plan) = study(STUDY).expect("a plan");
    let told = |scenario: &Scenario| {
        let recipe = Sweep::recipe(&study, scenario, &plan);
        ["digest", "origin"].map(|key| recipe[key].to_string())
    };
    let [first, again, mut other] = [(); 3].map(|()| Scenario::find("ferod").expect("a scene"));
    // The file that the scene names has changed, the scene's own text has not.
    other.file.scene.rod.flexible.table.as_mut().expect("a table").mass *= 2.0;
    assert_eq!(told(&first), told(&again));
    assert!(told(&first).iter().zip(told(&other)).all(|(first, other)| *first != other));
}

#[test]
fn the_shipped_studies_can_be_planned() {
    let directory = fmu_harness::scenes::directory().with_file_name("studies");
    let mut runs = 0;
    for entry in fs::read_dir(directory).expect("studies") {
        let file = entry.expect("a file").path();
        // Tables of studies are beside them.
        if file.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let study = Study::read(&file).expect("a study");
        Scenario::find(&study.scene()).expect("a scene");
        runs += Plan::of(&study).expect("a plan").len();
    }
    assert!(runs >= 200);
}

#[test]
fn killed_or_split_a_study_gives_the_same_and_runs_nothing_twice() {
    let directory = tempfile::tempdir().expect("a directory");
    let (study, plan) = study(STUDY).expect("a plan");
    let (scenario, fmu) = packaged(directory.path());
    let budget = Duration::from_secs(60);
    let sweep = Sweep { study: &study, scenario: &scenario, plan: &plan, fmu: &fmu, budget };
    let file = path(directory.path(), "own");
    let run = |workers: usize| {
        let journal = Journal::open(&file, "digest").expect("a journal");
        let before = journal.len();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(workers).build().expect("threads");
        pool.install(|| sweep.run(&journal, || {})).expect("a study");
        (journal.len() - before, sweep.frame(&journal).expect("a table"))
    };
    let (all, first) = run(2);
    assert_eq!((all, first.rows()), (12, 12));
    let parquet = |name: &str| {
        let file = directory.path().join(name);
        first.save_parquet(&file).expect("a file");
        fs::read(file).expect("a file")
    };
    assert_eq!(parquet("one.parquet"), parquet("two.parquet"));
    // Killed within the sixth line.
    let text = fs::read_to_string(&file).expect("a journal");
    let lines: Vec<&str> = text.lines().collect();
    let cut = lines[..6].join("\n") + "\n" + &lines[6][..10];
    fs::write(&file, cut).expect("a journal");
    let (again, second) = run(1);
    assert_eq!(again, 7);
    assert_eq!(second, first);
    assert_eq!(run(1).0, 0);
}

#[test]
fn a_journal_whose_lines_are_none_of_the_study_s_is_refused() {
    let directory = tempfile::tempdir().expect("a directory");
    let (study, plan) = study(STUDY).expect("a plan");
    let (scenario, fmu) = packaged(directory.path());
    let sweep = Sweep { study: &study, scenario: &scenario, plan: &plan, fmu: &fmu, budget: Duration::MAX };
    let kept = study.keep.len();
    for (name, run, values) in [("short", 3, kept - 1), ("long", 3, kept + 1), ("beyond", plan.len(), kept)] {
        let journal = Journal::open(&path(directory.path(), name), "digest").expect("a journal");
        journal.add(&Line { run, outcome: Outcome::Values(vec![0.0; values]) }).expect("a line");
        let error = sweep.run(&journal, || {}).expect_err("a damaged journal").to_string();
        assert!(error.contains(&format!("line of run {run}")), "{error}");
    }
}

#[test]
fn what_the_budget_stopped_is_run_again() {
    let directory = tempfile::tempdir().expect("a directory");
    let (study, plan) =
        study(&STUDY.replace("[\"hertz\", 3]", "[\"hertz\"]").replace("count = 3", "count = 2")).expect("a plan");
    let (scenario, fmu) = packaged(directory.path());
    let ok = [Duration::ZERO, Duration::from_secs(60)].map(|budget| {
        let sweep = Sweep { study: &study, scenario: &scenario, plan: &plan, fmu: &fmu, budget };
        let journal = Journal::open(&path(directory.path(), "own"), "digest").expect("a journal");
        sweep.run(&journal, || {}).expect("a study");
        let frame = sweep.frame(&journal).expect("a table");
        statuses(&frame).iter().filter(|status| *status == "ok").count()
    });
    assert_eq!(ok, [0, plan.len()]);
}

#[test]
fn a_run_of_too_many_communication_points_fails_at_once() {
    let directory = tempfile::tempdir().expect("a directory");
    let (study, plan) = study(&STUDY.replace("step = 1e-4", "step = 1e-12")).expect("a plan");
    let (scenario, fmu) = packaged(directory.path());
    let sweep = Sweep { study: &study, scenario: &scenario, plan: &plan, fmu: &fmu, budget: Duration::MAX };
    let journal = Journal::open(&path(directory.path(), "own"), "digest").expect("a journal");
    sweep.run(&journal, || {}).expect("a study");
    let status = statuses(&sweep.frame(&journal).expect("a table"));
    assert!(status.iter().all(|status| status.contains("more than 20000000 communication points")), "{status:?}");
}

#[test]
fn a_run_that_fails_stops_no_other() {
    let directory = tempfile::tempdir().expect("a directory");
    // Rigid contacts have no bristles.
    let text = STUDY.replace("[\"hertz\", 3]", "[\"hertz\"]").replace(
        "[random]",
        "\"solver.method\" = [\"verner7\", \"moreau\"]\n\"joint.C.friction.law\" = [\"lugre\"]\n\"joint.C.friction.static_coefficient\" = [0.2]\n[random]",
    );
    let (study, plan) = study(&text).expect("a plan");
    let (scenario, fmu) = packaged(directory.path());
    let sweep = Sweep { study: &study, scenario: &scenario, plan: &plan, fmu: &fmu, budget: Duration::from_secs(60) };
    let journal = Journal::open(&path(directory.path(), "own"), "digest").expect("a journal");
    sweep.run(&journal, || {}).expect("a study");
    let frame = sweep.frame(&journal).expect("a table");
    let status = statuses(&frame);
    let failed = status.iter().filter(|status| status.contains("moreau")).count();
    assert_eq!((failed, status.iter().filter(|status| *status == "ok").count()), (6, 6), "{status:?}");
}
