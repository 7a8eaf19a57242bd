//! One scene with every elasticity and every damping law in its joints with clearance.
//!
//! The literature compares these laws by the peak forces and the errors of a mechanism. Everything but the laws is the
//! scene's own. A clearance joint's motion is often chaotic, so that two laws differ in their peaks even if they return
//! the same impacts: the peaks of the single turns show by how much peaks differ under one law.

use crate::host::{Fmu, Setting};
use crate::inputs;
use crate::run::{ANGLE, Experiment, JOINTS, Look, Until, ideal_joints, march};
use crate::sweep::quantity::{Quantity, Reduction};
use crate::trajectory::Trajectory;
use anyhow::{Result, anyhow, ensure};
use rayon::prelude::*;
use slidercrank::scene::parameter::Parameter;
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{DampingLaw, Elasticity, JointModel, Scene};
use std::f64::consts::TAU;
use std::path::Path;
use std::time::Duration;

/// Number of turns that a comparison runs by default, if the scene's run is not shorter.
pub const TURNS: f64 = 5.0;
/// The joint that has damping laws but no elasticity of its own.
const GUIDE: &str = "T";
/// A turn that lacks so small a part of it is complete.
const ROUNDING: f64 = 1e-6;

/// The laws of one run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    /// All joints are ideal.
    Ideal,
    /// The joints that are varied have these laws.
    Laws {
        /// Elasticity of the revolute joints; `None` if only the guide is varied.
        elasticity: Option<Elasticity>,
        /// Damping law.
        law: DampingLaw,
    },
}

impl Case {
    /// Its name in tables.
    pub fn name(self) -> String {
        match self {
            Self::Ideal => "ideal joints".into(),
            Self::Laws { elasticity: Some(elasticity), law } => format!("{}, {}", elasticity.name(), law.name()),
            Self::Laws { elasticity: None, law } => law.name().into(),
        }
    }

    /// Its elasticity, if one is varied.
    pub fn elasticity(self) -> Option<Elasticity> {
        if let Self::Laws { elasticity, .. } = self { elasticity } else { None }
    }

    /// Its damping law, unless the joints are ideal.
    pub fn law(self) -> Option<DampingLaw> {
        if let Self::Laws { law, .. } = self { Some(law) } else { None }
    }
}

/// The loads of one joint in one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointLoads {
    /// [N] Largest force, between communication points too.
    pub peak: f64,
    /// [N] Largest force of each complete turn.
    pub turn_peaks: Vec<f64>,
    /// [m/s] Largest approach speed at a touch.
    pub approach: f64,
    /// Number of touches.
    pub touches: f64,
    /// [m] Largest penetration at a communication point, at least 0.
    pub penetration: f64,
}

/// The results of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loads {
    /// Loads of the joints that have clearance in the scene.
    pub joints: Vec<JointLoads>,
    /// [m] Largest absolute value of the slider's position error.
    pub error_max: f64,
    /// [m] Its root mean square.
    pub error_rms: f64,
    /// [N·m] Largest absolute value of the torque on the crank.
    pub torque: f64,
    /// [J] Energy dissipated per turn; NaN without the energy audit or without a turn.
    pub loss: f64,
    /// [s/s] CPU time in fmi2DoStep per simulated second, of a second run that reads no outputs.
    pub time: f64,
}

/// A comparison of laws.
pub struct Comparison<'a> {
    /// The scene.
    pub file: &'a SceneFile,
    /// The joints that have clearance.
    pub joints: Vec<&'static str>,
    /// Those of them whose laws are varied.
    pub varied: Vec<&'static str>,
    /// [s] Simulated time of a run.
    pub span: f64,
    /// Longest time for one run.
    pub budget: Duration,
}

impl<'a> Comparison<'a> {
    /// Varies the laws of all joints with clearance, or of `only` one of them, over so many turns at the crank's start
    /// speed.
    ///
    /// # Errors
    /// If there is no such joint with clearance, if the contacts are rigid, or if there are no turns to count.
    pub fn of(file: &'a SceneFile, only: Option<&str>, turns: Option<f64>, budget: Duration) -> Result<Self> {
        let scene = &file.scene;
        let method = scene.solver.method;
        ensure!(
            !method.has("rigid contacts"),
            "solver.method = {}: its rigid contacts have no elasticity and no damping law",
            method.name()
        );
        let joints: Vec<&str> = JOINTS.into_iter().filter(|joint| has_clearance(scene, joint)).collect();
        ensure!(!joints.is_empty(), "the scene has no joint with clearance");
        let varied: Vec<&str> = joints.iter().copied().filter(|joint| only.is_none_or(|only| only == *joint)).collect();
        ensure!(
            !varied.is_empty(),
            "joint {} has no clearance; those with clearance: {}",
            only.unwrap_or_default(),
            joints.join(", ")
        );
        let speed = scene.crank.speed_start.abs();
        let whole = file.run.stop(scene);
        let span = match turns {
            Some(turns) => {
                ensure!(speed > 0.0, "crank.speed_start = 0 rad/s: turns cannot be counted");
                turns * TAU / speed
            }
            None if speed > 0.0 => whole.min(TURNS * TAU / speed),
            None => whole,
        };
        Ok(Self { file, joints, varied, span, budget })
    }

    /// The ideal mechanism, and then every elasticity with every damping law.
    pub fn cases(&self) -> Vec<Case> {
        let pins = self.varied.iter().any(|joint| *joint != GUIDE);
        let elasticities: Vec<Option<Elasticity>> =
            if pins { Elasticity::ALL.iter().copied().map(Some).collect() } else { vec![None] };
        let laws = |elasticity| DampingLaw::ALL.iter().map(move |&law| Case::Laws { elasticity, law });
        std::iter::once(Case::Ideal).chain(elasticities.into_iter().flat_map(laws)).collect()
    }

    /// Runs all cases on all cores. A case that fails does not stop the others.
    pub fn run(&self, fmu: &Path, tick: impl Fn() + Sync) -> Vec<(Case, Result<Loads>)> {
        let run = |fmu: &mut Result<Fmu, String>, case: Case| {
            let found = fmu.as_ref().map_err(|error| anyhow!("{error}")).and_then(|fmu| self.one(fmu, case));
            tick();
            (case, found)
        };
        self.cases().into_par_iter().map_init(|| Fmu::open(fmu).map_err(|error| error.to_string()), run).collect()
    }

    /// The results of one case.
    ///
    /// # Errors
    /// If the FMU refuses the laws, fails, or takes longer than the budget.
    pub fn one(&self, fmu: &Fmu, case: Case) -> Result<Loads> {
        let experiment = Experiment {
            settings: self.settings(case),
            inputs: inputs::of_scene(&self.file.inputs),
            start: 0.0,
            until: Until::Time(self.span),
            step: self.file.run.step,
            tolerance: None,
        };
        let watched = march(fmu, &experiment, Look::Everywhere, self.budget)?;
        watched.ending.complete(self.budget)?;
        // Reading all outputs can take longer than the steps.
        let timed = march(fmu, &experiment, Look::AtEnds, self.budget)?;
        self.loads(&watched.trajectory, timed.spent.as_secs_f64() / timed.simulated)
    }

    /// Parameters of the FMU that differ from the scene's.
    fn settings(&self, case: Case) -> Vec<Setting> {
        let set = |joint: &str, what: &str, value: &str| Setting::joint(joint, what, value);
        let mut settings: Vec<Setting> = self.joints.iter().map(|joint| set(joint, "peak.audit", "true")).collect();
        match case {
            Case::Ideal => settings.extend(ideal_joints()),
            Case::Laws { elasticity, law } => {
                for joint in &self.varied {
                    settings.push(set(joint, "law", law.name()));
                    let elasticity = elasticity.filter(|_| *joint != GUIDE);
                    settings.extend(elasticity.map(|elasticity| set(joint, "elasticity", elasticity.name())));
                }
            }
        }
        settings
    }

    fn loads(&self, trajectory: &Trajectory, time: f64) -> Result<Loads> {
        let reduced =
            |name: &str, reduce: Reduction| Quantity { of: name.into(), reduce, at: None }.of(trajectory, 0.0);
        let angles = trajectory.column(ANGLE)?;
        let turned = (angles[angles.len() - 1] - angles[0]).abs() / TAU;
        let joint = |joint: &&str| -> Result<JointLoads> {
            let largest = |what: &str| reduced(&format!("joint.{joint}.{what}"), Reduction::Max);
            Ok(JointLoads {
                peak: largest("force.peak")?,
                turn_peaks: largest_of_turns(angles, trajectory.column(&format!("joint.{joint}.force.peak"))?),
                approach: largest("impact.speed")?,
                touches: largest("impacts")?,
                penetration: largest("penetration")?.max(0.0),
            })
        };
        let audited = self.file.scene.energy.audit && turned > ROUNDING;
        Ok(Loads {
            joints: self.joints.iter().map(joint).collect::<Result<_>>()?,
            error_max: reduced("accuracy.position", Reduction::Peak)?,
            error_rms: reduced("accuracy.position", Reduction::Rms)?,
            torque: reduced("drive.torque", Reduction::Peak)?,
            loss: if audited { reduced("energy.dissipated", Reduction::Last)? / turned } else { f64::NAN },
            time,
        })
    }
}

fn has_clearance(scene: &Scene, joint: &str) -> bool {
    let model = Parameter::named(&format!("joint.{joint}.model"));
    model.is_some_and(|model| model.value(scene) == f64::from(JointModel::Clearance.value()))
}

/// The largest value of each complete turn, where a value is that of the interval before it.
fn largest_of_turns(angles: &[f64], values: &[f64]) -> Vec<f64> {
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return vec![] };
    let turn = |angle: &f64| ((angle - first).abs() / TAU + ROUNDING) as usize;
    let mut largest: Vec<f64> = vec![];
    for (before, value) in angles.iter().zip(values.iter().skip(1)) {
        let turn = turn(before);
        largest.resize(largest.len().max(turn + 1), 0.0);
        largest[turn] = largest[turn].max(*value);
    }
    largest.truncate(turn(last));
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_has_the_peaks_of_its_own_intervals() {
        let turns = |turns: &[f64]| turns.iter().map(|turn| 3.0 - TAU * turn).collect::<Vec<_>>();
        let peaks = [9.0, 2.0, 5.0, 1.0, 4.0, 7.0];
        // The first value belongs to no interval, the last one to a turn that is not complete.
        assert_eq!(largest_of_turns(&turns(&[0.0, 0.5, 1.0, 1.5, 2.0, 2.5]), &peaks), [5.0, 4.0]);
        assert_eq!(largest_of_turns(&turns(&[0.0, 0.1, 0.2, 0.3, 0.4, 0.5]), &peaks), [0.0; 0]);
    }
}
