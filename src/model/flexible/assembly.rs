//! The constants of a mechanism with a flexible rod, and its inputs.

use super::chain::Frame;
use super::configuration::Geometry;
use super::motion::Functions;
use super::solver::Solvers;
use crate::integrator::Extent;
use crate::model::bodies::{Bodies, bodies};
use crate::model::clearances::Clearances;
use crate::model::drive::{InputSignal, RotaryDamper, Rotor, rotary_dampers};
use crate::model::ideal::IdealMechanism;
use crate::model::joint::Kernels;
use crate::model::rod::{Modes, Rod};
use crate::model::structure::Topology;
use crate::scene::Scene;

/// A mechanism with a flexible rod, whatever array its states are in. It has room for `S` equations to solve together,
/// `K` modes and `F` functions of the rod.
#[derive(Clone, Debug)]
pub struct Assembly<const S: usize, const K: usize, const F: usize> {
    /// Lengths, drive and rod.
    pub geometry: Geometry,
    /// The rod's modes.
    pub modes: Modes<K, F>,
    /// The motion, compiled for its topology.
    pub functions: Functions<Self>,
    pub(super) solvers: Kernels<Solvers<S>>,
    pub(super) bodies: Bodies,
    /// [m/s²]
    pub gravity: f64,
    /// The joints with clearance.
    pub clearances: Clearances,
    pub(super) rotary_dampers: Vec<RotaryDamper>,
    pub(super) guide_damping: Option<f64>,
    /// Torque and force.
    pub signal: InputSignal,
    /// How many there are, modal ones among them.
    pub positions: usize,
}

impl<const S: usize, const K: usize, const F: usize> Assembly<S, K, F> {
    /// Of a scene that starts at `time` [s], with its rod.
    pub fn new(scene: &Scene, time: f64, rod: Rod) -> Self {
        let topology = Topology::of(scene);
        let frame = Frame::new(topology);
        let geometry = Geometry { frame, ideal: IdealMechanism::new(scene), rotor: Rotor::new(scene, time), rod };
        let modes = Modes::new(&geometry.rod);
        let functions = Self::functions(topology, modes.counts);
        Self {
            modes,
            functions,
            solvers: Solvers::of(frame.chain.size + geometry.rod.modes()),
            bodies: bodies(scene),
            gravity: scene.gravity,
            clearances: Clearances::new(scene),
            rotary_dampers: rotary_dampers(scene),
            guide_damping: Some(scene.joint.t.damping).filter(|&damping| damping != 0.0),
            signal: InputSignal::default(),
            positions: geometry.modes(frame).end,
            geometry,
        }
    }

    /// Which joints are ideal, and where the coordinates stand.
    pub fn frame(&self) -> Frame {
        self.geometry.frame
    }

    /// How many states there are.
    pub fn extent(&self) -> Extent {
        let states = 2 * self.positions + self.clearances.bristles.len();
        Extent { positions: self.positions, weighed: states, states }
    }
}
