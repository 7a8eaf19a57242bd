//! A scene file through a simulation, communication point by communication point, as a host does it.

use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::Scene;
use slidercrank::scene::read::{SceneFile, read};
use slidercrank::simulation::Simulation;
use std::path::{Path, PathBuf};

/// What came of a run.
pub struct Trace {
    /// [s] Communication points.
    pub times: Vec<f64>,
    /// The outputs there, the start's first.
    pub outputs: Vec<Outputs>,
    /// Why it ended before its time, if it did.
    pub failure: Option<String>,
}

impl Trace {
    /// The outputs of the last communication point.
    pub fn last(&self) -> &Outputs {
        self.outputs.last().expect("a run has a start")
    }

    /// The outputs from the middle of the run on.
    pub fn second_half(&self) -> &[Outputs] {
        &self.outputs[self.outputs.len() / 2..]
    }

    /// The largest of what `of` gives, in size.
    pub fn greatest(&self, of: impl Fn(&Outputs) -> f64) -> f64 {
        self.outputs.iter().map(|outputs| of(outputs).abs()).fold(0.0, f64::max)
    }
}

/// The first real output that is no number, and its value.
pub fn not_finite(outputs: &Outputs) -> Option<(&'static str, f64)> {
    let reals = VARIABLES.iter().filter_map(|variable| match variable.access {
        Access::RealOutput(get) => Some((variable.name, get(outputs))),
        _ => None,
    });
    reals.into_iter().find(|(_, value)| !value.is_finite())
}

/// Where scene files of this kind are.
pub fn folder(kind: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("stability").join(kind)
}

/// The scene file of a case.
pub fn case(name: &str) -> SceneFile {
    file(&folder("cases"), name)
}

/// The file of a scene that is shipped.
pub fn shipped(name: &str) -> SceneFile {
    file(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../fmu-harness/scenes"), name)
}

fn file(folder: &Path, name: &str) -> SceneFile {
    let path = folder.join(format!("{name}.toml"));
    let text = std::fs::read_to_string(&path).expect("a scene file");
    read(&text, &path.display().to_string()).unwrap_or_else(|error| panic!("{error}"))
}

/// The inputs of a communication point.
pub fn inputs(file: &SceneFile, time: f64, crank_angle: f64) -> Inputs {
    let profiles = &file.inputs;
    Inputs {
        crank_torque: profiles.crank_torque.value(time, crank_angle),
        slider_load: profiles.slider_load.value(time, crank_angle),
    }
}

/// The scene at its start, with its inputs.
pub fn start(file: &SceneFile) -> Simulation {
    let inputs = inputs(file, 0.0, file.scene.crank.angle_start);
    Simulation::start(&file.scene, inputs).expect("a scene whose loop closes")
}

/// Runs it to its end, or as far as it comes. Inputs are set at each communication point and held.
pub fn run(file: &SceneFile) -> Trace {
    let mut simulation = start(file);
    let mut trace = Trace { times: vec![0.0], outputs: vec![simulation.outputs()], failure: None };
    let stop = file.run.stop(&file.scene);
    let points = (stop / file.run.step).round() as u32;
    for point in 1..=points {
        let time = stop * f64::from(point) / f64::from(points);
        let angle = trace.last().crank.angle;
        simulation.set_inputs(inputs(file, simulation.time(), angle), Inputs::default());
        if let Err(error) = simulation.advance_to(time) {
            trace.failure = Some(error.to_string());
            break;
        }
        trace.times.push(time);
        trace.outputs.push(simulation.outputs());
    }
    trace
}

/// The file with something changed in its scene.
pub fn with(file: &SceneFile, edit: impl FnOnce(&mut Scene)) -> SceneFile {
    let mut file = file.clone();
    edit(&mut file.scene);
    file.scene.check().expect("a legal scene");
    file
}
