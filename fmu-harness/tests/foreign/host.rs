//! The host and the run, from inside.

use super::workshop::{Workshop, XML};
use fmu_harness::host::{Fmu, Kind, PLATFORM, Setting};
use fmu_harness::inputs::Input;
use fmu_harness::package::archive::Part;
use fmu_harness::run::{Experiment, Until, run};
use slidercrank::scene::profile::{Profile, ProfileArgument};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

fn complaint<T>(result: Result<T, impl std::fmt::Display>) -> String {
    result.err().expect("a complaint").to_string()
}

fn experiment(until: Until) -> Experiment {
    Experiment { settings: vec![], inputs: vec![], start: 0.0, until, step: 0.01, tolerance: None }
}

#[test]
fn the_description_is_understood() {
    let fmu = Fmu::open(&Workshop::open().good()).expect("a good FMU");
    let description = fmu.description();
    assert_eq!(description.name(), "Decay");
    assert_eq!(description.units, ["m", "rad"]);
    assert_eq!(description.log_categories, ["logStatusError"]);
    assert_eq!(description.experiment.number("stepSize"), Some(0.01));
    let x = description.variable("x").expect("x");
    assert_eq!((description.unit(x), description.display_unit(x)), (Some("m"), Some("mm")));
    assert_eq!(x.attributes.get("description"), Some("a < b & c"));
    let law = description.variable("law").expect("law");
    assert_eq!((law.kind, description.items(law).len()), (Kind::Enumeration, 2));
    let dependencies: Vec<_> = description.structure.outputs.iter().map(|output| output.dependencies.clone()).collect();
    assert_eq!(dependencies, [Some(vec![]), None, None, None]);
}

#[test]
fn a_run_follows_the_closed_form() {
    let fmu = Fmu::open(&Workshop::open().good()).expect("a good FMU");
    let mut experiment = experiment(Until::Time(1.005));
    experiment.settings = ["k=2", "law=driven", "label=decay"].map(|text| text.parse().expect("a setting")).into();
    experiment.inputs = vec![Input { name: "u".into(), profile: Profile::Constant(3.0) }];
    let trajectory = run(&fmu, &experiment, |_| {}, |_| {}).expect("a run").trajectory;
    assert_eq!(trajectory.len(), 102, "a hundred steps and half a one");
    assert_eq!(trajectory.times().last(), Some(&1.005));
    for (time, x) in trajectory.times().iter().zip(trajectory.column("x").expect("x")) {
        let exact = 1.5 - 0.5 * (-2.0 * time).exp();
        assert!((x - exact).abs() <= 102.0 * 4.0 * f64::EPSILON, "x = {x} at {time} s, not {exact}");
    }
    assert_eq!(trajectory.column("steps").expect("steps").last(), Some(&101.0));
    assert_eq!(trajectory.column("high").expect("high")[101], 1.0);
}

/// x at the end of ten steps with an input that rises by 1 a radian or a second.
fn risen(xml: &str, against: ProfileArgument) -> f64 {
    let workshop = Workshop::open();
    let fmu = Fmu::open(&workshop.fmu(xml, "binaries/linux64/decay.so")).expect("a good FMU");
    let mut experiment = experiment(Until::Time(0.1));
    let profile = Profile::Points { against, points: vec![[0.0, 0.0], [TAU, TAU]] };
    experiment.inputs = vec![Input { name: "u".into(), profile }];
    let trajectory = run(&fmu, &experiment, |_| {}, |_| {}).expect("a run").trajectory;
    *trajectory.column("x").expect("x").last().expect("a row")
}

#[test]
fn inputs_follow_lines_where_the_fmu_takes_them_and_are_held_elsewhere() {
    let near = |found: f64, exact: f64| assert!((found - exact).abs() < 100.0 * f64::EPSILON, "{found}, not {exact}");
    // dx/dt = r·t − x from 1, and with r·t held over ten steps.
    let line = |r: f64| -r + r * 0.1 + (1.0 + r) * (-0.1_f64).exp();
    let held = |r: f64| {
        (0..10).fold(1.0, |x: f64, step| {
            let u = r * 0.01 * f64::from(step);
            u + (x - u) * (-0.01_f64).exp()
        })
    };
    let takes = XML.replace("<CoSimulation ", "<CoSimulation canInterpolateInputs=\"true\" ");
    near(risen(XML, ProfileArgument::Time), held(1.0));
    near(risen(&takes, ProfileArgument::Time), line(1.0));
    // Its angle turns by 10 rad/s, which only an output `crank.speed` would say.
    near(risen(&takes, ProfileArgument::CrankAngle), held(10.0));
}

#[test]
fn a_run_ends_after_the_turns_asked_for() {
    let fmu = Fmu::open(&Workshop::open().good()).expect("a good FMU");
    let turns = |turns, latest| run(&fmu, &experiment(Until::Turns { turns, latest }), |_| {}, |_| {});
    let trajectory = turns(1.0, 9.0).expect("a run").trajectory;
    assert_eq!(trajectory.times().last(), Some(&0.63), "10 rad/s make a turn in 0.6283 s");
    assert!(complaint(turns(3.0, 0.7)).contains("the crank has made 1.114 of 3 turns by t = 0.7 s"));
}

#[test]
fn what_is_wrong_with_a_file_is_said_in_one_sentence() {
    let workshop = Workshop::open();
    let good = workshop.good();
    let whole = fs::read(&good).expect("read");
    fs::write(&good, &whole[..whole.len() / 2]).expect("written");
    assert!(complaint(Fmu::open(&good)).contains("decay.fmu: not a complete ZIP archive"));
    assert!(complaint(Fmu::open(Path::new("/none.fmu"))).starts_with("/none.fmu: No such file"));

    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 0xff;
    fs::write(&good, flipped).expect("written");
    assert!(complaint(Fmu::open(&good)).contains("decay.fmu: not a complete ZIP archive"));

    let nameless = workshop.archive(&[Part::new("model/modelDescription.xml", XML)]);
    assert!(complaint(Fmu::open(&nameless)).ends_with("no modelDescription.xml at the top of the archive"));

    let elsewhere = workshop.fmu(XML, "binaries/c-code/decay.so");
    let wanted = format!("the FMU does not contain `binaries/{PLATFORM}/decay.so`; it has binaries for: c-code");
    assert_eq!(complaint(Fmu::open(&elsewhere)), wanted);

    let windows = workshop.archive(&[Part::new("modelDescription.xml", XML), Part::new("binaries\\x.dll", "")]);
    assert!(complaint(Fmu::open(&windows)).contains("entry `binaries\\x.dll` has a backslash in its name"));
    let outside = workshop.archive(&[Part::new("modelDescription.xml", XML), Part::new("../x", "")]);
    assert!(complaint(Fmu::open(&outside)).contains("entry `../x` would be unpacked outside"));

    for (from, to, words) in [
        ("</ModelStructure>", "", "expected"),
        ("fmiVersion=\"2.0\"", "fmiVersion=\"1.0\"", "the FMI version is 1.0; this program reads 2.0 and 3.0"),
        ("<CoSimulation", "<ModelExchange", "the FMU has no co-simulation interface"),
        ("name=\"k\" valueReference=\"2\"", "name=\"k\"", "`k` has no valueReference"),
    ] {
        let words_said = complaint(Fmu::open(&workshop.fmu(&XML.replace(from, to), "binaries/linux64/decay.so")));
        assert!(words_said.contains("modelDescription.xml") && words_said.contains(words), "{words_said}");
    }

    let text =
        workshop.archive(&[Part::new("modelDescription.xml", XML), Part::new("binaries/linux64/decay.so", "text")]);
    assert!(complaint(Fmu::open(&text)).contains("decay.so cannot be loaded"));
}

#[test]
fn what_the_fmu_refuses_is_said_in_its_own_words() {
    let workshop = Workshop::open();
    let stranger =
        Fmu::open(&workshop.fmu(&XML.replace("{decay}", "{other}"), "binaries/linux64/decay.so")).expect("opened");
    let refusal = complaint(run(&stranger, &experiment(Until::Time(1.0)), |_| {}, |_| {}));
    assert_eq!(refusal, "the FMU could not be instantiated: the GUID is not {decay}");

    let fmu = Fmu::open(&workshop.good()).expect("a good FMU");
    let with = |setting: &str| {
        let settings: Vec<Setting> = vec![setting.parse().expect("a setting")];
        complaint(run(&fmu, &Experiment { settings, ..experiment(Until::Time(1.0)) }, |_| {}, |_| {}))
    };
    assert_eq!(with("k=-1"), "fmi2ExitInitializationMode returned fmi2Error: k must be positive");
    assert_eq!(with("label=rise"), "setting `label` returned fmi2Error: the name is decay");
    assert_eq!(with("crank.angel=1"), "the FMU has no variable `crank.angel`; did you mean `crank.angle`?");
    assert_eq!(with("law=none"), "`law`: `none` is not one of driven, free");
    assert_eq!(with("k=NaN"), "`k`: `NaN` is not a finite number");
    let late = Experiment { start: 2e3, ..experiment(Until::Time(2001.0)) };
    let words = complaint(run(&fmu, &late, |_| {}, |_| {}));
    assert!(
        words.starts_with("fmi2DoStep from 2000 s by 0.0") && words.ends_with("returned fmi2Error: too late"),
        "{words}"
    );
}
