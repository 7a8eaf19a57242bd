//! A mechanism at one instant, in a form that is the same for every topology.

use super::contact::ContactState;
use super::drive::{InputSignal, Rotor};
use super::inertial_load::InertialLoad;
use super::joint::rectangle::{CORNERS, SliderPose};
use super::joint::revolute::JournalMotion;
use super::joint_set::Pin;
use super::kinematics::{BodyRotations, JointVectors};
use super::loads::Loads;
use super::plane::{Rotation, Vec2};
use super::rod::Elastic;
use super::structure::{CRANK, ROD, SLIDER, Structure};
use super::touches::{JOINTS, Touches};
use crate::math::Real;
use std::array::from_fn;

/// Number of contacts: joints A, B, C and the guide, which has its four corners, or its two faces and two unused
/// contacts.
pub const CONTACTS: usize = 3 + CORNERS;

/// The discrete state of every contact.
pub type Contacts = [ContactState; CONTACTS];

/// Conditions that are constant within a step of the integrator: contact states, and inputs as functions of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conditions {
    /// Discrete states of the contacts.
    pub contacts: Contacts,
    /// Inputs as a function of time.
    pub inputs: InputSignal,
    /// Touches of the joints; they have no influence on the motion.
    pub touches: [Touches; JOINTS],
}

impl Conditions {
    /// These contact states, with inputs that are always 0.
    pub fn without_inputs(contacts: Contacts) -> Self {
        Self { contacts, ..Self::default() }
    }

    /// These contact states under these inputs, without touches before.
    pub fn new(contacts: Contacts, inputs: InputSignal) -> Self {
        Self { contacts, inputs, ..Self::default() }
    }

    /// These inputs, with all contacts open.
    pub fn without_contacts(inputs: InputSignal) -> Self {
        Self { inputs, ..Self::default() }
    }
}

/// Angles, positions and velocities of a mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<R = f64> {
    /// Angles and angular velocities.
    pub rotations: BodyRotations<R>,
    /// [m] Places of the joint centres.
    pub place: JointVectors<R>,
    /// [m/s] Velocities of the joint centres.
    pub velocity: JointVectors<R>,
    /// [rad/s] Angular velocities of the rod's sections at its big and small end.
    pub section_speed: [R; 2],
}

impl<R: Real> Pose<R> {
    /// The motion of a pin's journal in its bearing.
    #[inline(always)]
    pub fn journal(&self, pin: Pin) -> JournalMotion<R> {
        let (p, v, speed, section) = (&self.place, &self.velocity, &self.rotations.speed, &self.section_speed);
        match pin {
            Pin::MainBearing => JournalMotion {
                eccentricity: p.crank,
                rate: v.crank,
                journal_speed: speed[CRANK],
                bearing_speed: R::ZERO,
            },
            Pin::CrankPin => JournalMotion {
                eccentricity: p.crank_pin - p.big_end,
                rate: v.crank_pin - v.big_end,
                journal_speed: speed[CRANK],
                bearing_speed: section[0],
            },
            Pin::SliderPin => JournalMotion {
                eccentricity: p.pin - p.small_end,
                rate: v.pin - v.small_end,
                journal_speed: speed[SLIDER],
                bearing_speed: section[1],
            },
        }
    }

    /// The motion of the slider in its guide.
    #[inline(always)]
    pub fn slider(&self) -> SliderPose<R> {
        SliderPose {
            pin: self.place.pin,
            pin_velocity: self.velocity.pin,
            rotation: self.rotations.rotation[SLIDER],
            speed: self.rotations.speed[SLIDER],
        }
    }
}

impl<R: Real> Pose<R> {
    /// The pose each of whose numbers is `combine` of the same number in all of `poses`.
    pub fn combined<Q: Real, const N: usize>(poses: [&Self; N], combine: &dyn Fn([R; N]) -> Q) -> Pose<Q> {
        // One call for each number: written out, all of them would be long.
        #[inline(never)]
        fn of<P, R, Q, const N: usize>(poses: [&P; N], combine: &dyn Fn([R; N]) -> Q, get: &dyn Fn(&P) -> R) -> Q {
            combine(poses.map(get))
        }
        let number = |get: &dyn Fn(&Self) -> R| of(poses, combine, get);
        let vector =
            |get: &dyn Fn(&Self) -> Vec2<R>| Vec2::new(number(&|pose| get(pose).x), number(&|pose| get(pose).y));
        let points = |get: &dyn Fn(&Self) -> JointVectors<R>| JointVectors {
            crank: vector(&|pose| get(pose).crank),
            crank_pin: vector(&|pose| get(pose).crank_pin),
            big_end: vector(&|pose| get(pose).big_end),
            small_end: vector(&|pose| get(pose).small_end),
            pin: vector(&|pose| get(pose).pin),
        };
        Pose {
            rotations: BodyRotations {
                angle: from_fn(|body| number(&|pose| pose.rotations.angle[body])),
                speed: from_fn(|body| number(&|pose| pose.rotations.speed[body])),
                rotation: from_fn(|body| Rotation {
                    cos: number(&|pose| pose.rotations.rotation[body].cos),
                    sin: number(&|pose| pose.rotations.rotation[body].sin),
                }),
            },
            place: points(&|pose| pose.place),
            velocity: points(&|pose| pose.velocity),
            section_speed: from_fn(|end| number(&|pose| pose.section_speed[end])),
        }
    }
}

/// The evaluation of an instant: all quantities from which outputs are computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation<R = f64> {
    /// Angles, positions and velocities.
    pub pose: Pose<R>,
    /// [m/s²] Accelerations of the joint centres.
    pub acceleration: JointVectors<R>,
    /// [rad/s²] Angular accelerations of crank, rod and slider.
    pub angle_acceleration: [R; 3],
    /// Loads, including contact forces.
    pub loads: Loads<R>,
    /// Quantities of a flexible rod; `None` if the rod is rigid.
    pub flexible: Option<FlexibleEvaluation<R>>,
}

/// Quantities of a flexible rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexibleEvaluation<R = f64> {
    /// Force and moment that the rod's motion requires.
    pub demand: InertialLoad<R>,
    /// Deflection, stretch, elastic energy and modal loss.
    pub elastic: Elastic<R>,
    /// [J] Kinetic energy.
    pub kinetic: R,
    /// [kg·m] ∫r dm, with r from the origin.
    pub mass_moment: Vec2<R>,
}

/// Rotations from `positions` and their `rates` at `t`. A crank whose angle is not a coordinate follows `rotor`. The
/// rod of a closed loop has no coordinate; its angle is set to 0.
#[inline(always)]
pub fn rotations_at<R: Real>(
    structure: &Structure,
    rotor: &Rotor,
    t: R,
    positions: &[R],
    rates: &[R],
) -> BodyRotations<R> {
    let (mut angle, mut speed) = ([R::ZERO; 3], [R::ZERO; 3]);
    (angle[CRANK], speed[CRANK]) = match structure.crank_angle {
        Some(place) => (positions[place], rates[place]),
        None => (rotor.at(t), R::constant(rotor.speed)),
    };
    if let Some(place) = structure.rod_angle {
        (angle[ROD], speed[ROD]) = (positions[place], rates[place]);
    }
    if let Some(place) = structure.slider_angle {
        (angle[SLIDER], speed[SLIDER]) = (positions[place], rates[place]);
    }
    rotations(angle, speed, structure.slider_angle.is_some())
}

/// Rotations from angles and rates; the slider on an ideal guide does not rotate.
#[inline(always)]
pub fn rotations<R: Real>(angle: [R; 3], speed: [R; 3], slider_turns: bool) -> BodyRotations<R> {
    let [crank, rod] = Rotation::all([angle[CRANK], angle[ROD]]);
    let slider = if slider_turns { Rotation::new(angle[SLIDER]) } else { Rotation::NONE };
    BodyRotations { angle, speed, rotation: [crank, rod, slider] }
}
