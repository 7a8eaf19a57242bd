//! Linear tolerance analysis against Monte Carlos, where the map is smooth and where it is chaotic.

use fmu_harness::frame::Frame;
use fmu_harness::report::study as report;
use fmu_harness::scenes::Scenario;
use fmu_harness::sensitivity::{Experiment, Wanted};
use fmu_harness::sweep::distribution::Law;
use fmu_harness::sweep::linear::Comparison;
use fmu_harness::sweep::study::parameter;
use fmu_harness::sweep::{Linear, Plan, Study};
use rand::SeedableRng;
use slidercrank::scene::DriveMode;
use slidercrank::scene::profile::Profile;

/// The first impacts of a worn pin, whose tolerances are narrower than what they change.
const STUDY: &str = r#"
name = "pin"
scene = "wornpin"
seed = 5
draws = 60

[run]
turns = 0.15
step = 1e-5

[random]
"joint.C.clearance" = { normal = { mean = "20 um", deviation = 2e-9, min = "19 um" } }
"joint.C.restitution" = { uniform = { min = 0.8999, max = 0.9001 } }
"rod.length" = { log_uniform = { min = 0.1199999, max = 0.1200001 } }

[keep]
contact = { of = "joint.C.contact", reduce = "mean" }
dead_centre = { of = "slider.x", reduce = "mean", at = 0.6 }
force = { of = "joint.C.force", reduce = "peak" }
speed = { of = "slider.v", reduce = "rms" }
"#;

fn study(text: &str) -> Study {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("study.toml");
    std::fs::write(&file, text).expect("a file");
    Study::read(&file).expect("a study")
}

/// All runs of a study, in this process.
fn monte_carlo(study: &Study, scenario: &Scenario) -> Frame {
    let plan = Plan::of(study).expect("a plan");
    let kept = study.keep.iter().filter_map(|(name, quantity)| Wanted::kept(name, quantity).ok());
    let kept: Vec<Wanted> = kept.collect();
    let mut frame = Frame::default();
    for (place, name) in plan.names().iter().enumerate() {
        frame = frame.reals(name.clone(), (0..plan.len()).map(|run| plan.value(run, place)));
    }
    let runs = (0..plan.len()).map(|run| {
        let mut file = scenario.file.clone();
        plan.row(run).for_each(|(name, value)| {
            parameter(name).expect("a parameter").write(&mut file.scene, value).expect("a value");
        });
        let (turns, transient) = (study.run.turns, study.run.transient);
        Experiment { file: &file, turns, transient, counted: true }.values(&kept).expect("a run")
    });
    let runs: Vec<Vec<f64>> = runs.collect();
    let columns = kept.iter().enumerate();
    columns.fold(frame, |frame, (i, wanted)| frame.reals(wanted.text.clone(), runs.iter().map(|run| run[i])))
}

#[test]
fn a_smooth_map_has_the_standard_deviations_of_its_derivatives() {
    let scenario = Scenario::find("wornpin").expect("a scene");
    let study = study(STUDY);
    let linear = Linear::of(&study, &scenario).expect("a linear analysis");
    let runs = monte_carlo(&study, &scenario);
    for (name, row) in linear.rows.iter().filter(|(name, _)| name != "contact") {
        let found = linear.compare(name, row, &runs).expect("numbers");
        let Comparison { deviation, linear, explained, .. } = found;
        assert!(found.agrees() && explained > 0.999, "{name}: {deviation} {linear} {explained}");
        assert!(found.half_width() < 0.3 * deviation, "{name}");
    }
    let (tables, sentences) = report::linear(&linear, &runs);
    assert!(matches!(&sentences[..], [only] if only.contains("`joint.C.contact`")), "{sentences:?}");
    let shares = tables[1].lines();
    for row in &shares[1..] {
        let total: f64 = row[1..].iter().map(|share| share.parse::<f64>().expect("a share")).sum();
        assert!((total - 100.0).abs() < 1.0, "{row:?}");
    }
    assert_eq!(shares.len(), 4);
}

#[test]
fn a_deviation_has_the_unit_of_its_parameter_and_not_its_bounds() {
    let drawn = r#""crank.length" = { normal = { mean = "50 mm", deviation = "0.2 um" } }"#;
    let text = STUDY.replace(r#""joint.C.restitution" ="#, &format!("{drawn}\n\"joint.C.restitution\" ="));
    let study = study(&text);
    let of = |name: &str| Law::of(parameter(name).expect("a parameter"), &study.random[name]).map(|law| law.moments());
    let (mean, deviation) = of("crank.length").expect("a law");
    assert!((mean - 0.05).abs() < 1e-12 && (deviation - 2e-7).abs() < 1e-12, "{mean} {deviation}");
}

/// A study's runs end by turns, which a free crank makes in a time of its own.
#[test]
fn turns_of_a_free_crank_end_where_those_of_the_runs_do() {
    let mut scenario = Scenario::find("ideal").expect("a scene");
    scenario.file.scene.drive.mode = DriveMode::Torque;
    scenario.file.inputs.crank_torque = Profile::Constant(5.0);
    let text = r#"
        name = "free"
        scene = "ideal"
        seed = 3
        draws = 40
        run = { turns = 2.25, step = 1e-4 }
        random."crank.inertia" = { uniform = { min = 0.0099, max = 0.0101 } }
        [keep]
        end = { of = "slider.x", reduce = "last" }
        speed = { of = "crank.speed", reduce = "last" }
        fastest = { of = "crank.speed", reduce = "max" }
        passage = { of = "crank.speed", reduce = "mean", at = 0 }
        mean = { of = "crank.speed", reduce = "mean" }
    "#;
    let study = study(text);
    let linear = Linear::of(&study, &scenario).expect("a linear analysis");
    let runs = monte_carlo(&study, &scenario);
    for (name, row) in &linear.rows {
        match (name.as_str(), linear.compare(name, row, &runs)) {
            ("mean", found) => {
                let refusal = found.err().map(|error| error.to_string()).expect("a refusal");
                assert!(refusal.contains("the turns of a free crank"), "{refusal}");
            }
            // At the crank angle of the end it does not move at all.
            ("end", found) => {
                let found = found.expect("numbers");
                assert!(found.deviation < 1e-9 && found.linear < 1e-9, "{} {}", found.deviation, found.linear);
            }
            (_, found) => {
                let Comparison { deviation, linear, explained, .. } = found.expect("numbers");
                assert!((linear / deviation - 1.0).abs() < 0.4 && explained > 0.999, "{name}: {deviation} {linear}");
            }
        }
    }
}

#[test]
fn where_the_reach_is_shorter_than_the_tolerances_the_table_says_so() {
    let scenario = Scenario::find("wornpin").expect("a scene");
    let text = STUDY.replace("deviation = 2e-9", "deviation = 2e-7").replace("turns = 0.15", "turns = 2");
    let study = study(&text.replace("contact = { of = \"joint.C.contact\", reduce = \"mean\" }", ""));
    let linear = Linear::of(&study, &scenario).expect("a linear analysis");
    let (tables, sentences) = report::linear(&linear, &monte_carlo(&study, &scenario));
    let bent: Vec<_> =
        tables[0].lines().iter().filter(|row| row.last().is_some_and(|cell| cell == "not linear")).collect();
    assert!(!bent.is_empty() && bent.len() == sentences.len(), "{}", tables[0].print());
    assert!(
        sentences.iter().all(|sentence| sentence.contains("`joint.C.clearance` has a standard deviation of")),
        "{sentences:?}"
    );
}

#[test]
fn moments_are_those_of_the_draws_and_of_closed_forms() {
    let text = STUDY.replace("min = 0.1199999, max = 0.1200001", "min = 0.01, max = 1");
    let study = study(&text.replace("deviation = 2e-9, min = \"19 um\"", "deviation = 2e-6, min = \"20 um\""));
    let of = |name: &str| Law::of(parameter(name).expect("a parameter"), &study.random[name]).expect("a law");
    // Half of a normal distribution; 1/x between 0.01 and 1; a uniform one.
    let half = (2.0 / std::f64::consts::PI).sqrt();
    let decades = 100f64.ln();
    let mean = 0.99 / decades;
    let known = [
        ("joint.C.clearance", 20e-6 + 2e-6 * half, 2e-6 * (1.0 - half * half).sqrt()),
        ("rod.length", mean, ((1.0 - 1e-4) / (2.0 * decades) - mean * mean).sqrt()),
        ("joint.C.restitution", 0.9, 2e-4 / 12f64.sqrt()),
    ];
    for (name, mean, deviation) in known {
        let law = of(name);
        let found = law.moments();
        assert!((found.0 / mean - 1.0).abs() < 1e-9 && (found.1 / deviation - 1.0).abs() < 1e-9, "{name}: {found:?}");
        let mut generator = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let count = 20_000;
        let draws: Vec<f64> = (0..count).map(|_| law.sample(&mut generator).expect("a draw")).collect();
        let average = draws.iter().sum::<f64>() / f64::from(count);
        let spread = (draws.iter().map(|x| (x - average).powi(2)).sum::<f64>() / f64::from(count)).sqrt();
        assert!((average - mean).abs() < 4.0 * deviation / f64::from(count).sqrt(), "{name}: {average} {mean}");
        assert!((spread / deviation - 1.0).abs() < 0.03, "{name}: {spread} {deviation}");
    }
}

#[test]
fn what_has_no_linear_analysis_is_named() {
    let scenario = Scenario::find("wornpin").expect("a scene");
    let refusal = |from: &str, to: &str| {
        let study = study(&STUDY.replace(from, to));
        format!("{:#}", Linear::of(&study, &scenario).err().expect("a refusal"))
    };
    let grid = refusal("[random]", "[grid]\n\"slider.mass\" = [0.14, 0.15]\n[random]");
    assert!(grid.contains("[grid]"), "{grid}");
    let spin = study(
        &STUDY
            .replace("\"rod.length\"", "\"crank.speed_start\"")
            .replace("0.1199999, max = 0.1200001", "523, max = 524"),
    );
    let linear = Linear::of(&spin, &scenario).expect("a linear analysis");
    let reason = |name: &str| linear.rows.iter().find(|(own, _)| own == name).and_then(|(_, row)| row.as_ref().err());
    assert!(reason("speed").is_some_and(|why| why.to_string().contains("crank.speed_start")));
    assert!(reason("contact").is_some() && reason("dead_centre").is_none() && reason("force").is_none());
}
