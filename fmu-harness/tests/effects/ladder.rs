//! Every scene of the ladder is the one before with its effect.

use crate::program::stock;
use fmu_harness::effects::Price;
use fmu_harness::host::{Fmu, LogLine};
use fmu_harness::inputs;
use fmu_harness::run::{Experiment, Until, run};
use fmu_harness::scenes::{Scenario, ladder};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::Scene;
use slidercrank::scene::parameter::PARAMETERS;
use slidercrank::scene::read::SceneFile;
use slidercrank::simulation::{Simulation, Size};

/// Names, and what the effect adds to degrees of freedom, states and event functions.
///
/// A joint with clearance frees two coordinates, each with its rate, and has an event function, the guide four, one a
/// corner; the guide frees the slider's height and tilt. A mode is one coordinate with its rate. Bristles are a state
/// of every contact that has them, the audit is seven. What is found between communication points has no state, a film
/// neither.
const RUNGS: [(&str, [usize; 3]); 13] = [
    ("01-ideal", [1, 2, 0]),
    ("02-one-play", [2, 4, 1]),
    ("03-three-plays", [4, 8, 2]),
    ("04-four-plays", [2, 4, 4]),
    ("05-friction", [0, 0, 0]),
    ("06-faces", [0, 0, 0]),
    ("07-rod-2-modes", [2, 4, 0]),
    ("08-rod-4-modes", [2, 4, 0]),
    ("09-rod-8-modes", [4, 8, 0]),
    ("10-lugre", [0, 3, 0]),
    ("11-audit", [0, 7, 0]),
    ("12-intervals", [0, 0, 0]),
    ("13-oil", [0, 0, 0]),
];

/// What a scene may change of the one before; a name that ends in a dot stands for all below it.
const CHANGES: [&[&str]; 13] = [
    &[],
    &["joint.C."],
    &["joint.A.", "joint.B."],
    &["joint.T."],
    &["joint.A.friction.", "joint.B.friction.", "joint.C.friction.", "joint.T.friction."],
    &["joint.T.surface", "joint.T.width"],
    &["rod.flexible."],
    &["rod.flexible.bending_modes", "rod.flexible.axial_modes"],
    &["rod.flexible.bending_modes", "rod.flexible.axial_modes"],
    &["joint.A.friction.", "joint.B.friction.", "joint.C.friction."],
    &["energy.audit"],
    &[
        "joint.A.peak.",
        "joint.A.wear.",
        "joint.B.peak.",
        "joint.B.wear.",
        "joint.C.peak.",
        "joint.C.wear.",
        "joint.T.peak.",
        "joint.T.wear.",
    ],
    &["joint.B.lubrication", "joint.B.viscosity", "joint.B.roughness"],
];

fn file(name: &str) -> SceneFile {
    Scenario::find(name).expect("a legal scene").file
}

/// Names of the parameters in which two scenes differ.
fn differences(one: &Scene, other: &Scene) -> Vec<&'static str> {
    let differ = PARAMETERS.iter().filter(|parameter| parameter.value(one) != parameter.value(other));
    differ.map(|parameter| parameter.name).collect()
}

#[test]
fn the_ladder_is_these_scenes() {
    let names: Vec<String> = RUNGS.iter().map(|(name, _)| format!("effects/{name}")).collect();
    assert_eq!(ladder(), names);
    for ((name, _), scene) in RUNGS.iter().zip(&names) {
        assert_eq!(file(scene).name, *name);
        assert_eq!(file(scene).run, file(&names[0]).run);
        assert_eq!(file(scene).inputs, file(&names[0]).inputs);
    }
}

#[test]
fn a_scene_is_the_one_before_with_its_effect() {
    let scenes: Vec<Scene> = ladder().iter().map(|name| file(name).scene).collect();
    for ((pair, changes), (name, _)) in scenes.windows(2).zip(&CHANGES[1..]).zip(&RUNGS[1..]) {
        let differences = differences(&pair[0], &pair[1]);
        let is_change =
            |own: &&str| changes.iter().any(|change| own == change || change.ends_with('.') && own.starts_with(change));
        assert!(!differences.is_empty() && differences.iter().all(is_change), "{name}: {differences:?}");
    }
}

#[test]
fn an_effect_adds_its_own_states_and_events_and_nothing_else() {
    let mut sum = [0; 3];
    for (name, added) in RUNGS {
        sum = std::array::from_fn(|i| sum[i] + added[i]);
        let file = file(&format!("effects/{name}"));
        let simulation = Simulation::start(&file.scene, Inputs::at_start(&file)).expect("a closed loop");
        let [degrees_of_freedom, states, event_functions] = sum;
        assert_eq!(simulation.size(), Size { degrees_of_freedom, states, event_functions }, "{name}");
    }
}

/// The prices are of the same runs as those of the scenes one by one: the same numbers of evaluations, to the last one.
#[test]
fn running_the_scenes_one_by_one_reproduces_the_price_list() {
    let directory = tempfile::tempdir().expect("a directory");
    let stock = stock();
    for name in ladder() {
        let scenario = Scenario::find(&name).expect("a legal scene");
        let path = directory.path().join("scene.fmu");
        stock.package(&scenario).and_then(|package| package.save(&path)).expect("a package");
        let fmu = Fmu::open(&path).expect("an FMU");
        let span = 4e-3;
        let price = Price::of(&scenario.file, &fmu, span).expect("a price");
        let experiment = Experiment {
            settings: vec![],
            inputs: inputs::of_scene(&scenario.file.inputs),
            start: 0.0,
            until: Until::Time(span),
            step: 7e-5,
            tolerance: None,
        };
        let recording = run(&fmu, &experiment, |_: &LogLine| {}, |_| {}).expect("a run without trouble");
        let last = |count: &str| *recording.column(count).expect("an output").last().expect("a row") / span;
        let counts = ["solver.evaluations", "solver.steps", "solver.events"].map(last);
        assert_eq!([price.evaluations, price.steps, price.events], counts, "{name}");
        assert!(price.time > 0.0 && price.evaluation > 0.0);
        assert_eq!(price.events > 0.0, price.size.event_functions > 0, "{name}");
    }
}
