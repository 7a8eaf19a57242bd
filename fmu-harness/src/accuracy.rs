//! Kinematic accuracy: the slider's error against the ideal mechanism with the same crank motion, and its motion at
//! bottom dead centre.

use crate::dynamics::Machine;
use anyhow::{Context, Result};
use rayon::prelude::*;
use slidercrank::model::ideal::IdealMechanism;
use slidercrank::model::rod::Rod;
use slidercrank::model::signals::Outputs;
use slidercrank::scene::check::MAX_ROUGHNESS;
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{JointModel, Lubrication, Scene};
use std::f64::consts::{PI, TAU};

/// Communication points per turn.
const POINTS: usize = 7200;

/// [rad] Crank angle at which the slider of the ideal mechanism is farthest from the crank: crank and rod are in line.
pub fn farthest(scene: &Scene) -> f64 {
    sine_in_line(&IdealMechanism::new(scene), 1.0).asin()
}

/// [rad] Crank angle at which the slider of the ideal mechanism is nearest to the crank.
pub fn nearest(scene: &Scene) -> f64 {
    PI + sine_in_line(&IdealMechanism::new(scene), -1.0).asin()
}

/// [rad per unit of the parameter] Derivative of the angle by a parameter: of that of [`farthest`] if `side` is 1, of that of
/// [`nearest`] if it is −1.
pub fn slope_of_dead_centre(scene: &Scene, side: f64, parameter: &Parameter) -> f64 {
    let Kind::Real { get, set, .. } = parameter.kind else { return 0.0 };
    // The dimensions are linear in all parameters.
    let [less, more] = [-1.0, 1.0].map(|change| {
        let mut changed = scene.clone();
        set(&mut changed, get(scene) + change);
        IdealMechanism::new(&changed)
    });
    let slope = |of: fn(&IdealMechanism) -> f64| (of(&more) - of(&less)) / 2.0;
    let ideal = IdealMechanism::new(scene);
    let sine = sine_in_line(&ideal, side);
    let lengths = slope(|ideal| ideal.rod) + side * slope(|ideal| ideal.crank);
    let length = ideal.rod + side * ideal.crank;
    (slope(|ideal| ideal.height) - sine * lengths) / (length * ((1.0 - sine) * (1.0 + sine)).sqrt())
}

/// Sine of the angle to the guide of crank and rod in line, one behind the other (1) or side by side (−1).
fn sine_in_line(ideal: &IdealMechanism, side: f64) -> f64 {
    ideal.height / (ideal.rod + side * ideal.crank)
}

/// Length of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Turns before the evaluation starts.
    pub transient: usize,
    /// Turns that are evaluated.
    pub turns: usize,
}

/// The error of one quantity over time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Largest absolute value.
    pub max: f64,
    /// Root mean square.
    pub rms: f64,
    /// Mean.
    pub mean: f64,
    /// Mean absolute deviation from the mean.
    pub mad: f64,
    /// Ratio of the quantity's largest absolute value to that of the ideal mechanism.
    pub peak_ratio: f64,
}

impl Deviation {
    /// Statistics of a list of errors, from the quantity's values with and without them.
    fn of(errors: &[f64], actual: &[f64]) -> Self {
        let count = errors.len().max(1) as f64;
        let mean = errors.iter().sum::<f64>() / count;
        let peak = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |peak: f64, value| peak.max(value.abs()));
        let ideal = peak(&mut errors.iter().zip(actual).map(|(error, actual)| actual - error));
        Self {
            max: peak(&mut errors.iter().copied()),
            rms: (errors.iter().map(|error| error * error).sum::<f64>() / count).sqrt(),
            mean,
            mad: errors.iter().map(|error| (error - mean).abs()).sum::<f64>() / count,
            peak_ratio: peak(&mut actual.iter().copied()) / ideal,
        }
    }
}

/// Position error and tilt of the slider at bottom dead centre, over all strokes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeadCentre {
    /// [m] Mean position error.
    pub error: f64,
    /// [m] Its standard deviation from stroke to stroke.
    pub spread: f64,
    /// [m] Its range.
    pub range: f64,
    /// [rad] Mean tilt.
    pub tilt: f64,
    /// [rad] Largest tilt.
    pub most_tilt: f64,
}

/// The accuracy of one mechanism.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accuracy {
    /// [m]
    pub position: Deviation,
    /// [m/s]
    pub velocity: Deviation,
    /// [m/s²]
    pub acceleration: Deviation,
    /// At bottom dead centre.
    pub dead_centre: DeadCentre,
    /// [N] Largest force in any joint.
    pub peak_force: f64,
}

/// One case of a comparison.
pub struct Case {
    /// The difference from the other cases.
    pub name: String,
    /// The scene.
    pub file: SceneFile,
}

/// Factors of clearance and speed.
const FACTORS: [f64; 5] = [0.25, 0.5, 1.0, 1.5, 2.0];

/// All comparisons of a scene, with their titles.
pub fn comparisons(file: &SceneFile) -> Vec<(&'static str, Vec<Case>)> {
    let mut parts = vec![
        ("joints with play", sixteen(file)),
        ("clearances", clearances(file, &FACTORS)),
        ("speed", speeds(file, &FACTORS)),
        ("rod", rods(file)),
    ];
    parts.retain(|(_, cases)| !cases.is_empty());
    parts
}

/// The sixteen choices of joints with clearance. Each joint has the scene's clearance, and the rod is the scene's.
pub fn sixteen(file: &SceneFile) -> Vec<Case> {
    (0..16)
        .map(|choice| {
            let mut file = file.clone();
            let joint = &mut file.scene.joint;
            let models = [&mut joint.a.model, &mut joint.b.model, &mut joint.c.model, &mut joint.t.model];
            let mut name = String::new();
            for (number, (model, letter)) in models.into_iter().zip("ABCT".chars()).enumerate() {
                let play = choice >> number & 1 == 1;
                *model = if play { JointModel::Clearance } else { JointModel::Ideal };
                if play {
                    name.push(letter);
                }
            }
            let name = if name.is_empty() { "none".into() } else { name };
            Case { name, file }
        })
        .collect()
}

/// The scene with all clearances multiplied by each factor; the surfaces of lubricated joints are then at most as rough as
/// their clearance admits.
pub fn clearances(file: &SceneFile, factors: &[f64]) -> Vec<Case> {
    let scaled = |factor: &f64| {
        let mut file = file.clone();
        let joint = &mut file.scene.joint;
        for clearance in
            [&mut joint.a.clearance, &mut joint.b.clearance, &mut joint.c.clearance, &mut joint.t.clearance]
        {
            *clearance *= factor;
        }
        for joint in [&mut joint.a, &mut joint.b, &mut joint.c] {
            if joint.lubrication != Lubrication::None {
                joint.roughness = joint.roughness.min(MAX_ROUGHNESS * joint.clearance);
            }
        }
        Case { name: format!("clearance × {factor}"), file }
    };
    factors.iter().map(scaled).collect()
}

/// The scene with its speed multiplied by each factor.
pub fn speeds(file: &SceneFile, factors: &[f64]) -> Vec<Case> {
    let faster = |factor: &f64| {
        let mut file = file.clone();
        file.scene.crank.speed_start *= factor;
        Case { name: format!("speed × {factor}"), file }
    };
    factors.iter().map(faster).collect()
}

/// A scene with its flexible rod and with a rigid rod of the same mass; no cases if the scene's rod is rigid.
pub fn rods(file: &SceneFile) -> Vec<Case> {
    let Some(body) = Rod::new(&file.scene).map(|rod| rod.undeformed()) else { return vec![] };
    let mut rigid = file.clone();
    let rod = &mut rigid.scene.rod;
    (rod.flexible.bending_modes, rod.flexible.axial_modes) = (0, 0);
    (rod.mass, rod.inertia, rod.com.x, rod.com.y) = (body.mass, body.inertia, body.com.x, body.com.y);
    vec![Case { name: "rigid rod".into(), file: rigid }, Case { name: "flexible rod".into(), file: file.clone() }]
}

impl Plan {
    /// Runs all cases on all cores. A case that fails does not stop the others.
    pub fn measure_all(&self, cases: &[Case], tick: impl Fn() + Sync) -> Vec<Result<Accuracy>> {
        let measured = |case: &Case| {
            let found = self.measure(&case.file).with_context(|| case.name.clone());
            tick();
            found
        };
        cases.par_iter().map(measured).collect()
    }

    /// The accuracy of one scene.
    ///
    /// # Errors
    /// If it cannot run.
    pub fn measure(&self, file: &SceneFile) -> Result<Accuracy> {
        file.scene.check()?;
        let mut machine = Machine::start(file)?;
        // Bottom dead centre is one of the points.
        let start = file.scene.crank.angle_start;
        let forwards = file.scene.crank.speed_start.signum();
        let to_bottom = ((farthest(&file.scene) - start) * forwards).rem_euclid(TAU);
        let first = to_bottom + TAU * self.transient as f64;
        let (mut errors, mut actual) = ([vec![], vec![], vec![]], [vec![], vec![], vec![]]);
        let mut strokes: Vec<[f64; 2]> = Vec::new();
        let mut peak_force: f64 = 0.0;
        for point in 0..self.turns * POINTS {
            machine.advance_turned(first + TAU * point as f64 / POINTS as f64)?;
            let outputs = machine.outputs();
            let Outputs { accuracy, slider, .. } = &outputs;
            for (list, value) in errors.iter_mut().zip([accuracy.position, accuracy.velocity, accuracy.acceleration]) {
                list.push(value);
            }
            for (list, value) in actual.iter_mut().zip([slider.x, slider.v, slider.a]) {
                list.push(value);
            }
            if point % POINTS == 0 {
                strokes.push([accuracy.position, slider.angle]);
            }
            peak_force = peak_force.max(largest_force(&outputs));
        }
        let deviation = |which: usize| Deviation::of(&errors[which], &actual[which]);
        Ok(Accuracy {
            position: deviation(0),
            velocity: deviation(1),
            acceleration: deviation(2),
            dead_centre: DeadCentre::of(&strokes),
            peak_force,
        })
    }
}

impl DeadCentre {
    /// Statistics of position errors and tilts, one of each for every stroke.
    fn of(strokes: &[[f64; 2]]) -> Self {
        let count = strokes.len().max(1) as f64;
        let [error, tilt] = [0, 1].map(|which| strokes.iter().map(|stroke| stroke[which]).sum::<f64>() / count);
        let squares: f64 = strokes.iter().map(|stroke| (stroke[0] - error).powi(2)).sum();
        let (low, high) = strokes
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), stroke| (low.min(stroke[0]), high.max(stroke[0])));
        Self {
            error,
            spread: (squares / (count - 1.0).max(1.0)).sqrt(),
            range: high - low,
            tilt,
            most_tilt: strokes.iter().map(|stroke| wrapped(stroke[1]).abs()).fold(0.0, f64::max),
        }
    }
}

/// [rad] The same angle between minus and plus half a turn.
fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

fn largest_force(outputs: &Outputs) -> f64 {
    let forces = [outputs.joint_a.force, outputs.joint_b.force, outputs.joint_c.force, outputs.joint_t.force];
    forces.into_iter().map(|[x, y]| x.hypot(y)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_are_those_of_the_definition() {
        let deviation = Deviation::of(&[1.0, -3.0, 2.0, 0.0], &[5.0, -3.0, 2.0, 1.0]);
        // The ideal values are 4, 0, 0, 1.
        let wanted = Deviation { max: 3.0, rms: 3.5f64.sqrt(), mean: 0.0, mad: 1.5, peak_ratio: 1.25 };
        assert_eq!(deviation, wanted);
    }

    #[test]
    fn strokes_scatter_about_their_mean() {
        let centre = DeadCentre::of(&[[1.0, 0.1], [3.0, -0.3]]);
        assert_eq!((centre.error, centre.spread, centre.range), (2.0, 2.0f64.sqrt(), 2.0));
        assert!((centre.tilt + 0.1).abs() < 1e-15 && (centre.most_tilt - 0.3).abs() < 1e-15, "{centre:?}");
    }
}
