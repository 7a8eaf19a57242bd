//! Scene files: what is read, and how what is wrong is told.

mod modal_table;

use slidercrank::scene::profile::{Profile, ProfileArgument};
use slidercrank::scene::read::{SceneFile, read};
use slidercrank::scene::run::{End, Run};
use slidercrank::scene::{DampingLaw, DriveMode, FrictionLaw, JointModel, Scene, write::write};

/// The messages of a file that is refused.
fn refused(text: &str) -> String {
    read(text, "x.toml").expect_err("a file with a fault").to_string()
}

#[test]
fn an_empty_file_is_the_declared_scene() {
    assert_eq!(read("", "x.toml"), Ok(SceneFile::default()));
}

#[test]
fn keys_are_the_fmu_s_names_and_units_are_people_s() {
    let text = r#"
name = "worn"
gravity = 9.81
drive.mode = "speed"
[run]
turns = 20
step = "10 us"
[crank]
length = "60 mm"
speed_start = "5000 rpm"
torque = "2 kN.m"
[joint.C]
model = "clearance"
clearance = "250 µm"
law = "flores"
friction.law = "ambrosio"
[slider]
load = { against = "crank.angle", points = [["0 deg", 0], ["180 deg", "-2 kN"], ["360 deg", 0.0]] }
"#;
    let file = read(text, "x.toml").expect("a legal file");
    let mut scene = Scene { gravity: 9.81, ..Scene::default() };
    scene.drive.mode = DriveMode::Speed;
    scene.crank.length = 0.06;
    scene.crank.speed_start = 523.598_775_598_298_9;
    scene.joint.c.model = JointModel::Clearance;
    scene.joint.c.clearance = 2.5e-4;
    scene.joint.c.contact.law = DampingLaw::Flores;
    scene.joint.c.contact.friction.law = FrictionLaw::Ambrosio;
    assert_eq!(file.scene, scene);
    assert_eq!(file.name, "worn");
    assert_eq!(file.run, Run { end: End::Turns(20.0), step: 1e-5 });
    assert_eq!(file.inputs.crank_torque, Profile::Constant(2000.0));
    let points = vec![[0.0, 0.0], [std::f64::consts::PI, -2000.0], [std::f64::consts::TAU, 0.0]];
    assert_eq!(file.inputs.slider_load, Profile::Points { against: ProfileArgument::CrankAngle, points });
    assert!((file.run.stop(&file.scene) - 0.24).abs() < 1e-15);
}

#[test]
fn what_is_written_is_read_back_to_the_bit() {
    let mut file = SceneFile { name: "a \"b\"".into(), description: "c\nd".into(), ..SceneFile::default() };
    file.scene.joint.a.clearance = 0.1 + 0.2;
    file.scene.crank.speed_start = -std::f64::consts::TAU;
    file.scene.joint.a.radius = 1.0;
    file.scene.joint.t.model = JointModel::Clearance;
    file.scene.joint.t.contact.law = DampingLaw::ZhangSharf;
    file.run = Run { end: End::Turns(1.0 / 3.0), step: 1e-7 };
    file.inputs.slider_load =
        Profile::Points { against: ProfileArgument::Time, points: vec![[-1.0, 0.1], [0.3, 1e-300]] };
    file.scene.joint.a.clearance = 0.03;
    file.scene.rod.flexible.bending_modes = 8;
    file.scene.rod.flexible.geometric_stiffness = false;
    file.scene.energy.audit = true;
    assert_eq!(read(&write(&file), "x.toml"), Ok(file));
}

#[test]
fn a_wrong_key_names_its_neighbour() {
    assert_eq!(refused("[crank]\nlenght = 1\n"), "x.toml:2:1: unknown key `crank.lenght`; is it `crank.length`?");
    assert_eq!(refused("[joint.c]\nmodel = \"ideal\"\n"), "x.toml:1:8: unknown key `joint.c`; is it `joint.C`?");
    assert_eq!(
        refused("[run]\nfoo = 1\n"),
        "x.toml:2:1: unknown key `run.foo`; known here: run.turns, run.stop, run.step"
    );
    assert_eq!(
        refused("slider.load.agianst = 1"),
        "x.toml:1:13: unknown key `slider.load.agianst`; is it `slider.load.against`?"
    );
}

#[test]
fn a_wrong_type_or_item_names_what_is_allowed() {
    assert_eq!(
        refused("[crank]\nlength = true\n"),
        "x.toml:2:10: crank.length = true: wanted a finite number in m or a text with a unit"
    );
    assert_eq!(refused("joint.A = 3\n").split(": wanted").next(), Some("x.toml:1:11: joint.A = 3"));
    assert_eq!(refused("drive.mode = 1"), "x.toml:1:14: drive.mode = 1: wanted one of the texts torque, speed");
    assert_eq!(refused("drive.mode = \"sped\""), "x.toml:1:14: drive.mode = \"sped\" is not allowed: torque, speed");
    assert_eq!(refused("name = 1"), "x.toml:1:8: name = 1: wanted a text");
}

#[test]
fn integers_and_booleans_are_toml_s_own() {
    let file =
        read("rod.flexible.bending_modes = 3\nrod.flexible.geometric_stiffness = false\nenergy.audit = true", "");
    let scene = file.expect("a legal file").scene;
    assert_eq!((scene.rod.flexible.bending_modes, scene.rod.flexible.axial_modes), (3, 0));
    assert!(!scene.rod.flexible.geometric_stiffness && scene.energy.audit);
    let modes = |value: &str| refused(&format!("[rod.flexible]\nbending_modes = {value}"));
    assert_eq!(modes("9"), "x.toml:2:17: rod.flexible.bending_modes = 9 is not allowed: an integer, 0 to 8");
    assert_eq!(modes("-1"), "x.toml:2:17: rod.flexible.bending_modes = -1 is not allowed: an integer, 0 to 8");
    for wrong in ["1.0", "\"1\"", "true", "[1]"] {
        let wanted = format!("x.toml:2:17: rod.flexible.bending_modes = {wrong}: wanted an integer, 0 to 8");
        assert_eq!(modes(wrong), wanted);
    }
    // What no i64 holds is no integer of TOML's.
    assert!(modes("99999999999999999999").contains("wanted an integer, 0 to 8"));
    for wrong in ["1", "\"true\"", "0.0"] {
        let wanted = format!("x.toml:1:16: energy.audit = {wrong}: wanted true or false");
        assert_eq!(refused(&format!("energy.audit = {wrong}")), wanted);
    }
}

#[test]
fn sections_densities_and_stiffnesses_have_people_s_units_too() {
    let text = r#"
[rod.flexible]
area = "80 mm2"
second_moment = "0.5 cm4"
density = "7.85 g/cm3"
[joint.T]
foundation_stiffness = "12 kN/mm²"
friction = { sigma0 = "100 1/mm", sigma1 = "0.3 s/mm" }
"#;
    let scene = read(text, "x.toml").expect("a legal file").scene;
    let flexible = &scene.rod.flexible;
    assert_eq!((flexible.area, flexible.second_moment, flexible.density), (8e-5, 5e-9, 7850.0));
    let friction = &scene.joint.t.contact.friction;
    assert_eq!((scene.joint.t.foundation_stiffness, friction.sigma0, friction.sigma1), (1.2e10, 1e5, 300.0));
    assert_eq!(
        refused("rod.flexible.area = \"80 mm\""),
        "x.toml:1:21: rod.flexible.area = \"80 mm\": `mm` measures something else; units: m2, mm2, cm2"
    );
    assert!(refused("rod.flexible.density = \"8 x\"").ends_with("units: kg/m3, g/cm3"));
}

#[test]
fn a_wrong_unit_names_those_that_would_do() {
    assert_eq!(
        refused("crank.length = \"50 furlong\""),
        "x.toml:1:16: crank.length = \"50 furlong\": unknown unit `furlong`; units: m, mm, um, nm, cm"
    );
    assert_eq!(
        refused("crank.length = \"50 deg\""),
        "x.toml:1:16: crank.length = \"50 deg\": `deg` measures something else; units: m, mm, um, nm, cm"
    );
}

#[test]
fn a_value_out_of_range_names_the_range() {
    assert_eq!(
        refused("[joint.C]\nclearance = \"200 mm\""),
        "x.toml:2:13: joint.C.clearance = \"200 mm\" is not allowed: 1e-9 to 0.1 m"
    );
    assert_eq!(refused("run.step = 0"), "x.toml:1:12: run.step = 0 is not allowed: above 0, at most 1e6 s");
    assert!(refused("gravity = nan").starts_with("x.toml:1:11: gravity = nan: wanted a finite number"));
    assert!(refused("slider.load = inf").starts_with("x.toml:1:15: slider.load = inf: wanted"));
}

#[test]
fn values_that_do_not_go_together_stand_at_the_one_to_change() {
    assert_eq!(
        refused("[joint.C]\nmodel = \"clearance\"\nclearance = \"20 mm\"\n"),
        "x.toml:3:1: joint.C.clearance = 0.02 is not allowed: below joint.C.radius = 0.01 m"
    );
    assert_eq!(
        refused("run.turns = 3"),
        "x.toml:1:5: run.turns = 3 is not allowed: run.stop instead, for a crank that starts at rest"
    );
    assert_eq!(
        refused("run.turns = 3\nrun.stop = 1\ncrank.speed_start = 1"),
        "x.toml:1:5: `run.turns, run.stop` is said twice"
    );
}

#[test]
fn the_same_key_twice_is_refused() {
    let toml = refused("[crank]\nlength = 1\nlength = 2\n");
    assert!(toml.starts_with("x.toml:3:1: duplicate key"), "{toml}");
    assert_eq!(refused("crank.length = 1\n\"crank.length\" = 2\n").lines().count(), 1);
}

#[test]
fn every_fault_is_told_in_the_file_s_order() {
    let text = refused("rod.mass = -1\nfoo = 1\ncrank.mass = \"1 N\"\n");
    let places: Vec<&str> = text.lines().map(|line| &line[..11]).collect();
    assert_eq!(places, ["x.toml:1:12", "x.toml:2:1:", "x.toml:3:14"]);
    assert!(refused("a = [").starts_with("x.toml:1:"));
}

#[test]
fn an_input_with_a_parameter_below_it_may_be_a_table() {
    let points = "against = \"time\", points = [[0, 5], [1, 7]]";
    for (text, load) in [
        ("[slider]\n\"load.offset\" = \"1 mm\"".to_owned(), false),
        ("[slider]\nload.offset = \"1 mm\"".to_owned(), false),
        ("slider.load.offset = \"1 mm\"".to_owned(), false),
        (format!("[slider]\nload = {{ offset = \"1 mm\", {points} }}"), true),
    ] {
        let file = read(&text, "own.toml").expect(&text);
        assert_eq!(file.scene.slider.load_offset, 1e-3, "{text}");
        let wanted = if load { 6.0 } else { 0.0 };
        assert_eq!(file.inputs.slider_load.value(0.5, 0.0), wanted, "{text}");
    }
    assert!(refused("[slider]\nload = { offset = \"1 mm\", poins = [] }").contains("slider.load.poins"));
    assert!(refused("[slider]\nload.offset = \"1 mm\"\n\"load.offset\" = 0").contains("twice"));
}

#[test]
fn points_rise_and_the_turn_closes() {
    let load = |points: &str| refused(&format!("slider.load = {{ against = \"crank.angle\", points = {points} }}"));
    assert!(load("[[0, 0], [0, 1]]").contains("rising angles from 0 to 360 deg"));
    assert!(load("[[0, 0], [\"400 deg\", 1]]").contains("rising angles from 0 to 360 deg"));
    assert!(load("[[0, 0], [\"360 deg\", 1]]").contains("the turn repeats"));
    assert!(load("[]").contains("wanted points = [[rad, N], ...]"));
    assert!(load("[[0, 0, 0]]").contains("wanted [rad, N]"));
    assert!(load("[[0, \"1 m\"]]").contains("`m` measures something else"));
    assert!(refused("slider.load.points = [[0, 0]]").contains("against = \"time\" or \"crank.angle\""));
}

#[test]
fn every_shipped_scene_is_legal() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../fmu-harness/scenes");
    let (mut names, mut problems): (Vec<String>, Vec<String>) = (vec![], vec![]);
    let entries = |folder: &str| std::fs::read_dir(folder).expect("a folder of scenes");
    for entry in entries(folder).chain(entries(&format!("{folder}/effects"))) {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("a text");
        let file = match read(&text, &path.display().to_string()) {
            Ok(file) => file,
            Err(error) => {
                problems.push(error.to_string());
                continue;
            }
        };
        assert_eq!(path.file_stem().and_then(|stem| stem.to_str()), Some(file.name.as_str()));
        assert!(!file.description.is_empty() && file.run.stop(&file.scene).is_finite());
        names.push(file.name);
    }
    assert_eq!(problems, Vec::<String>::new());
    names.sort();
    names.retain(|name| !name.starts_with(|first: char| first.is_ascii_digit())); // the ladder of effects
    assert_eq!(
        names,
        ["allplay", "ferod", "flexrod", "guideplay", "hold", "ideal", "oilpress", "press", "seed", "wornpin"]
    );
}
