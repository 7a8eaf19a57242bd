//! The guide with clearance: four corners of the slider between two lines.
//!
//! Corner k is at the offsets (±a, ±b) from the rectangle's centre. An upper one penetrates by
//! y_k − (h + b + c_T), a lower one by (h − b − c_T) − y_k. Each is a contact of its own; faces and
//! jamming follow.

use super::{KernelFamily, choose, compliance, parameters};
use crate::integrator::Guard;
use crate::model::contact::{ContactMode, ContactParameters, Damped, Elastic, Forces, force};
use crate::model::friction::Friction;
use crate::model::joint::revolute::guard;
use crate::model::plane::{Rotation, Vec2, cross};
use crate::scene::{self, Elasticity};

/// How many corners the slider has.
pub const CORNERS: usize = 4;

/// Where the slider is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SliderPose {
    /// [m] Pin centre.
    pub pin: Vec2,
    /// [m/s] Its velocity.
    pub pin_velocity: Vec2,
    /// Tilt.
    pub rotation: Rotation,
    /// [rad/s] Rate of tilt.
    pub speed: f64,
}

/// The guide's forces on the slider, reduced to the pin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// [N]
    pub force: Vec2,
    /// [N·m] About the pin.
    pub couple: f64,
}

/// Most contacts of the slider with the guide.
pub const GUIDE_CONTACTS: usize = CORNERS;

/// How many contacts the slider of a scene has with the guide.
pub fn guide_contacts(_: &scene::Scene) -> usize {
    CORNERS
}

#[derive(Clone, Copy, Debug)]
struct Corner {
    /// [m] From the pin, in the slider's axes.
    offset: Vec2,
    /// Of the line's inner normal: −1 for the upper line, +1 for the lower.
    normal: f64,
    /// [m] Height of the line.
    line: f64,
}

/// Penetration, its rate and the sliding speed of one corner.
struct CornerState {
    arm: Vec2,
    depth: f64,
    rate: f64,
    sliding: f64,
}

type Kernel = fn(&ContactParameters, f64, &CornerState, f64) -> Forces;

/// The guide with clearance.
#[derive(Clone, Copy, Debug)]
pub struct Guide {
    corners: [Corner; CORNERS],
    /// The contact's numbers, the same for every corner.
    pub contact: ContactParameters,
    kernel: Kernel,
}

struct Family;

impl KernelFamily for Family {
    type Kernel = Kernel;
    fn kernel<E: Elastic, D: Damped, F: Friction>() -> Kernel {
        |contact, per_approach, corner, z| {
            force::<E, D, F>(contact, per_approach, corner.depth, corner.rate, z, || corner.sliding)
        }
    }
}

impl Guide {
    /// From the scene.
    pub fn new(scene: &scene::Scene) -> Self {
        let joint = &scene.joint.t;
        let slider = &scene.slider;
        let (a, b) = (0.5 * slider.length, 0.5 * slider.height);
        let reach = b + joint.clearance;
        let corner = |x: f64, side: f64| Corner {
            offset: Vec2::new(slider.centre.x + x, slider.centre.y + side * b),
            normal: -side,
            line: scene.guide.offset + side * reach,
        };
        let contact = &joint.contact;
        // Sphere on plane.
        let hertz = 4.0 / (3.0 * compliance(contact)) * joint.corner_radius.sqrt();
        let stiffness = if contact.stiffness > 0.0 { contact.stiffness } else { hertz };
        Self {
            corners: [corner(a, 1.0), corner(-a, 1.0), corner(a, -1.0), corner(-a, -1.0)],
            contact: parameters(contact, stiffness, 0.0),
            kernel: choose::<Family>(Elasticity::Hertz, contact),
        }
    }

    #[inline(always)]
    fn corner(&self, k: usize, pose: &SliderPose) -> CornerState {
        let corner = &self.corners[k];
        let arm = pose.rotation.apply(corner.offset);
        CornerState {
            arm,
            depth: corner.normal * (corner.line - (pose.pin.y + arm.y)),
            rate: -corner.normal * (pose.pin_velocity.y + pose.speed * arm.x),
            sliding: pose.pin_velocity.x - pose.speed * arm.y,
        }
    }

    /// [m] Penetration of corner `k`, negative when open.
    pub fn penetration(&self, k: usize, pose: &SliderPose) -> f64 {
        self.corner(k, pose).depth
    }

    /// [m/s] Its rate.
    pub fn penetration_rate(&self, k: usize, pose: &SliderPose) -> f64 {
        self.corner(k, pose).rate
    }

    /// The event at which corner `k` changes.
    #[inline(always)]
    pub fn guard(&self, k: usize, mode: &ContactMode, pose: &SliderPose) -> Guard {
        let corner = self.corner(k, pose);
        guard(mode, corner.depth, corner.rate)
    }

    /// The load of the closed corners, whose bristles are deflected by `z` [m] and move at `bristle_rate`
    /// [m/s].
    #[inline(always)]
    pub fn load(
        &self,
        modes: &[ContactMode],
        pose: &SliderPose,
        z: &[f64; GUIDE_CONTACTS],
        bristle_rate: &mut [f64; GUIDE_CONTACTS],
    ) -> Load {
        let mut load = Load::default();
        for (k, mode) in modes.iter().enumerate().take(CORNERS) {
            if mode.closed {
                let state = self.corner(k, pose);
                let Forces { normal, tangential, bristle_rate: rate } =
                    (self.kernel)(&self.contact, mode.per_approach, &state, z[k]);
                bristle_rate[k] = rate;
                let force = Vec2::new(-tangential, self.corners[k].normal * normal);
                load.force += force;
                load.couple += cross(state.arm, force);
            }
        }
        load
    }
}
