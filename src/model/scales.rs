//! Scales of the error norm: sizes of just tolerable errors.
//!
//! With clearance, micrometre penetrations determine the forces. Hertz's penetration at equal force grows with c^(1/3),
//! so the scale of lengths is 1 µm at c = 0.5 mm and is proportional to c^(1/3). Rates are scaled with the frequency of
//! the contact at that penetration, and angles with the length that converts them into displacements. Without clearance
//! the scale is that of the crank's angle.

use super::bodies::bodies;
use super::ideal::IdealMechanism;
use super::joint::guide::Guide;
use super::joint::revolute::Revolute;
use crate::math;
use crate::scene::{DriveMode, JointModel, Scene};

/// [m] Scale of lengths at the clearance [`CLEARANCE`].
const LENGTH: f64 = 1e-6;
/// [m] Reference clearance.
const CLEARANCE: f64 = 0.5e-3;
/// [rad] Scale of angles in a mechanism without clearance.
const ANGLE: f64 = 0.01;
/// [rad/s] Smallest crank speed that enters the scales.
const MIN_CRANK_SPEED: f64 = 1.0;
/// [rad] Maximum rotation of a crank within a step at its start speed, so that few looks within a step find every contact.
const MAX_ROTATION: f64 = 0.1;
/// [rad] Maximum rotation without clearance, where the only event is the change point of a short rod. In an hour of
/// free running the energy then drifts by a millionth at the default tolerance.
const MAX_ROTATION_WITHOUT_CLEARANCE: f64 = 0.15;
/// [s] Upper bound of any step.
const MAX_STEP: f64 = 0.02;

/// Share of the distance to the next singularity that a step may turn if nothing else controls its error. The works then err by 1e-10
/// of themselves, measured with rods of 1.0002 to 3 times the crank's length.
const SMOOTH_SHARE: f64 = 0.1;
/// [rad] The least such rotation, of a rod that is no longer than the crank.
const LEAST_SMOOTH_ROTATION: f64 = 1e-3;

/// Scales of one scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// [m] Scale of positions.
    pub length: f64,
    /// [rad] Scales of the angles of crank, rod and slider.
    pub angle: [f64; 3],
    /// [m] Scale of the modal coordinates of a flexible rod.
    pub deflection: f64,
    /// [1/s] Scale of rates over that of positions.
    pub frequency: f64,
    /// Scale of positions over the smallest clearance or, without clearance, over the crank's length.
    pub relative: f64,
    /// [s] Upper bound of a step.
    pub longest_step: f64,
}

impl Scale {
    /// The scales of a scene.
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
        let crank_speed = scene.crank.speed_start.abs().max(MIN_CRANK_SPEED);
        let within = |rotation: f64| (rotation / crank_speed).min(MAX_STEP);
        if clearance == f64::INFINITY {
            let swing = (scene.gravity.abs() / scene.crank.length).sqrt();
            let frequency = crank_speed.max(swing);
            let longest_step = within(MAX_ROTATION_WITHOUT_CLEARANCE.min(smooth_rotation(scene)));
            let (angle, relative) = ([ANGLE; 3], ANGLE);
            return Self { length: ANGLE, angle, deflection: LENGTH, frequency, relative, longest_step };
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
        // A soft contact must not make the tolerance of the crank's own motion stricter.
        let frequency = frequency.max(10.0 * crank_speed);
        let reach = [scene.crank.length, scene.rod.length, 0.5 * scene.slider.length];
        let longest_step = within(MAX_ROTATION);
        let (angle, relative) = (reach.map(|reach| length / reach), length / clearance);
        Self { length, angle, deflection: length, frequency, relative, longest_step }
    }
}

/// [rad] Rotation over which the works in an ideal mechanism with a prescribed crank are smooth; infinite if they are not asked
/// for, or if the motion has an error that controls the step. The rod's angle has a branch point where r·sin θ = h ± l for complex
/// angles, h being the height of the pin's line: acosh((l − |h|)/r) beside the real axis.
fn smooth_rotation(scene: &Scene) -> f64 {
    let modes = scene.rod.flexible.bending_modes + scene.rod.flexible.axial_modes;
    if !(scene.energy.audit && scene.drive.mode == DriveMode::Speed && modes == 0) {
        return f64::INFINITY;
    }
    let IdealMechanism { crank, rod, height } = IdealMechanism::new(scene);
    let reach = (rod - height.abs()) / crank;
    let distance = math::asinh((reach * reach - 1.0).max(0.0).sqrt());
    (SMOOTH_SHARE * distance).max(LEAST_SMOOTH_ROTATION)
}
