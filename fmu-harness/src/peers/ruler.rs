//! Measures the error of a program: the largest difference from a reference, over equidistant instants, of the
//! components of every joint's eccentricity, divided by its clearance.
//!
//! In a guide, the eccentricity is replaced by the slider's displacement across the guide and by its tilt times half
//! its length. Without any clearance, the angles of crank and rod [rad] and the slider's position divided by the
//! crank's length are compared.

use super::Task;
use super::child::Found;
use crate::precision::reference::AGREEMENT;
use anyhow::{Result, ensure};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{JointModel, Method, Scene};
use slidercrank::simulation::{Simulation, System};

/// Sets method and tolerance of a scene. For Moreau's rule `tolerance` is the step [s].
pub fn choose(scene: &mut Scene, method: Method, tolerance: f64) {
    scene.solver.method = method;
    match method {
        Method::Moreau => scene.solver.step = tolerance,
        _ => scene.solver.tolerance = tolerance,
    }
}

/// Tolerance of the reference solutions with compliant contacts.
const REFERENCE: f64 = 1e-12;
/// [s] Step of the reference solution with rigid contacts.
const RIGID_STEP: f64 = 5e-8;

/// Measured quantities, one list for each instant.
pub type Paths = Vec<Vec<f64>>;

/// A reference solution.
pub struct Ruler {
    scene: Scene,
    times: Vec<f64>,
    reference: Paths,
    /// Difference between two reference solutions with different methods or steps.
    pub own_error: f64,
}

impl Ruler {
    /// Solves the task with two of our methods at a tight tolerance, and shortens it to the time at which they begin to
    /// differ; the motion is not known after that.
    pub fn new(task: &mut Task) -> Result<Self> {
        let mut ruler = Self::bare(task);
        let mut one = ruler.start(task, Method::Dop853, REFERENCE)?;
        let mut other = ruler.start(task, Method::Verner7, REFERENCE)?;
        for &time in &ruler.times {
            let [found, check] = [&mut one, &mut other].map(|simulation| ruler.at(simulation, time));
            let found = vec![found?];
            let apart = Self::distance(&found, &vec![check?]);
            if apart > AGREEMENT {
                break;
            }
            ruler.own_error = ruler.own_error.max(apart);
            ruler.reference.extend(found);
        }
        let known = ruler.reference.len();
        ensure!(known > 0, "two reference solutions differ already at {} s", task.span / task.points as f64);
        task.shorten(known);
        ruler.times.truncate(known);
        Ok(ruler)
    }

    /// Solves the task with rigid contacts by Moreau's rule, at a short step and at twice that step.
    pub fn rigid(task: &Task) -> Result<Self> {
        let mut ruler = Self::bare(task);
        ruler.reference = ruler.solve(task, Method::Moreau, RIGID_STEP)?;
        ruler.own_error = ruler.error(&ruler.solve(task, Method::Moreau, 2.0 * RIGID_STEP)?);
        Ok(ruler)
    }

    fn bare(task: &Task) -> Self {
        let times = (1..=task.points).map(|i| task.span * i as f64 / task.points as f64).collect();
        Self { scene: task.scenario.file.scene.clone(), times, reference: vec![], own_error: 0.0 }
    }

    /// The measured quantities of a run of our methods. For Moreau's rule `tolerance` is the step [s].
    pub fn solve(&self, task: &Task, method: Method, tolerance: f64) -> Result<Paths> {
        let mut simulation = self.start(task, method, tolerance)?;
        self.times.iter().map(|&time| self.at(&mut simulation, time)).collect()
    }

    fn start(&self, task: &Task, method: Method, tolerance: f64) -> Result<Simulation> {
        let mut scene = self.scene.clone();
        choose(&mut scene, method, tolerance);
        Ok(Simulation::start(&scene, Inputs::at_start(&task.scenario.file))?)
    }

    fn at(&self, simulation: &mut Simulation, time: f64) -> Result<Vec<f64>> {
        simulation.advance_to(time)?;
        Ok(self.measure(&simulation.outputs()))
    }

    /// The measured quantities of another program's run.
    pub fn paths(&self, system: &System, found: &Found) -> Paths {
        let positions = match found {
            Found::Measured(all) => {
                let count = self.reference.first().map_or(1, Vec::len).max(1);
                return all.chunks(count).map(<[f64]>::to_vec).collect();
            }
            Found::Positions(positions) => positions,
        };
        let size = system.size();
        let mut y = vec![0.0; size.states];
        let instants = positions.chunks(size.degrees_of_freedom.max(1)).zip(&self.times);
        instants
            .map(|(now, t)| {
                y[..now.len()].copy_from_slice(now);
                self.measure(&system.outputs(*t, &y))
            })
            .collect()
    }

    /// The measured quantities of outputs.
    pub fn measure(&self, outputs: &Outputs) -> Vec<f64> {
        let Outputs { joint_a, joint_b, joint_c, slider, crank, rod, .. } = outputs;
        let joint = &self.scene.joint;
        let mut all = vec![];
        for (own, found) in [(&joint.a, joint_a), (&joint.b, joint_b), (&joint.c, joint_c)] {
            if own.model == JointModel::Clearance {
                all.extend(found.eccentricity.map(|e| e / own.clearance));
            }
        }
        if joint.t.model == JointModel::Clearance {
            all.extend([slider.y, 0.5 * self.scene.slider.length * slider.angle].map(|e| e / joint.t.clearance));
        }
        if all.is_empty() {
            all.extend([crank.angle, rod.angle, slider.x / self.scene.crank.length]);
        }
        all
    }

    /// The error of a run.
    pub fn error(&self, paths: &Paths) -> f64 {
        Self::distance(paths, &self.reference)
    }

    /// Largest difference between two runs; infinite if one of them is shorter or contains NaN.
    pub fn distance(one: &Paths, other: &Paths) -> f64 {
        if one.len() != other.len() {
            return f64::INFINITY;
        }
        let pairs = one.iter().zip(other).flat_map(|(a, b)| a.iter().zip(b));
        let largest = |all: f64, (a, b): (&f64, &f64)| {
            let difference = (a - b).abs();
            if difference.is_nan() { f64::INFINITY } else { all.max(difference) }
        };
        pairs.fold(0.0, largest)
    }
}
