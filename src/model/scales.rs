//! What size of error is just noticeable: the absolute weights of the error norm.
//!
//! With clearance, micrometre penetrations decide the forces. Hertz's penetration at equal force grows
//! with c^(1/3), so the length that the tolerance is relative to is 1 µm at c = 0.5 mm and follows
//! that power. Rates are weighted with the frequency of the contact at that penetration, angles with the
//! length that turns them into displacements. Without clearance the crank's angle counts.

use super::bodies::bodies;
use super::joint::guide::Guide;
use super::joint::revolute::Revolute;
use crate::math;
use crate::scene::{JointModel, Scene};

/// [m] At [`CLEARANCE`].
const LENGTH: f64 = 1e-6;
/// [m]
const CLEARANCE: f64 = 0.5e-3;
/// [rad] Of a mechanism without clearance.
const ANGLE: f64 = 0.01;
/// [1/s] Slowest motion that is still weighted as motion.
const SLOWEST: f64 = 1.0;
/// [rad] Most that a prescribed or started crank turns within a step, so that no touch is missed.
const TURN: f64 = 0.1;
/// [rad] The same without clearance, where only the dead ends of a short rod may be met; an hour of free running then loses a
/// millionth of its energy at the default tolerance.
const TURN_WITHOUT_PLAY: f64 = 0.15;
/// [s] Longest step of all.
const LONGEST: f64 = 0.02;

/// Weights of one scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// [m] Of positions.
    pub length: f64,
    /// [rad] Of the angles of crank, rod and slider.
    pub angle: [f64; 3],
    /// [m] Of the modes of a flexible rod.
    pub deflection: f64,
    /// [1/s] Rates over positions.
    pub frequency: f64,
    /// [s] No step is longer.
    pub longest_step: f64,
}

impl Scale {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        let joint = &scene.joint;
        let mass = bodies(scene).map(|body| body.mass);
        let [crank, rod, slider] = mass;
        let lighter = [crank, crank.min(rod), rod.min(slider), slider];
        let mut clearance = f64::INFINITY;
        for (model, gap) in [
            (joint.a.model, joint.a.clearance),
            (joint.b.model, joint.b.clearance),
            (joint.c.model, joint.c.clearance),
            (joint.t.model, joint.t.clearance),
        ] {
            if model == JointModel::Clearance {
                clearance = clearance.min(gap);
            }
        }
        let turning = scene.crank.speed_start.abs().max(SLOWEST);
        let within = |turn: f64| (turn / turning).min(LONGEST);
        if clearance == f64::INFINITY {
            let swing = (scene.gravity.abs() / scene.crank.length).sqrt();
            let frequency = turning.max(swing);
            let longest_step = within(TURN_WITHOUT_PLAY);
            return Self { length: ANGLE, angle: [ANGLE; 3], deflection: LENGTH, frequency, longest_step };
        }
        let length = LENGTH * math::powf(clearance / CLEARANCE, 1.0 / 3.0);
        let mut frequency = f64::INFINITY;
        for (index, revolute) in [&joint.a, &joint.b, &joint.c].into_iter().enumerate() {
            if revolute.model == JointModel::Clearance {
                let contact = Revolute::new(revolute).contact;
                frequency = frequency.min(contact.frequency(lighter[index], length));
            }
        }
        if joint.t.model == JointModel::Clearance {
            let contact = Guide::new(scene).contact;
            frequency = frequency.min(contact.frequency(lighter[3], length));
        }
        // A soft contact does not make the crank's own motion more precious.
        let frequency = frequency.max(10.0 * turning);
        let reach = [scene.crank.length, scene.rod.length, 0.5 * scene.slider.length];
        let longest_step = within(TURN);
        Self { length, angle: reach.map(|reach| length / reach), deflection: length, frequency, longest_step }
    }
}
