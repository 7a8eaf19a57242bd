//! A mechanism at one instant, the same for every topology: what outputs are made from.

use super::contact::ContactState;
use super::drive::{InputSignal, Rotor};
use super::inertial_load::InertialLoad;
use super::joint::rectangle::{CORNERS, SliderPose};
use super::joint::revolute::JournalMotion;
use super::joint_set::Pin;
use super::kinematics::{BodyRotations, JointVectors};
use super::loads::Loads;
use super::plane::Rotation;
use super::rod::Elastic;
use super::structure::{CRANK, ROD, SLIDER, Structure};
use crate::math::Real;

/// Contacts of the joints A, B, C and of the guide: its four corners, or its two faces and two idle ones.
pub const CONTACTS: usize = 3 + CORNERS;

/// The state of every contact.
pub type Contacts = [ContactState; CONTACTS];

/// What is constant within a step of the integrator: the state of every contact, and the course of the inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conditions {
    /// The discrete state.
    pub contacts: Contacts,
    /// Inputs as a function of time.
    pub inputs: InputSignal,
}

impl Conditions {
    /// These contacts, and inputs that are 0 throughout.
    pub fn without_inputs(contacts: Contacts) -> Self {
        Self { contacts, inputs: InputSignal::default() }
    }

    /// These inputs, and open contacts.
    pub fn without_contacts(inputs: InputSignal) -> Self {
        Self { contacts: Contacts::default(), inputs }
    }
}

/// Angles, positions and velocities of an open mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<R = f64> {
    /// Angles and angular speeds.
    pub rotations: BodyRotations<R>,
    /// [m]
    pub place: JointVectors<R>,
    /// [m/s]
    pub velocity: JointVectors<R>,
    /// [rad/s] Of the rod's sections at its big and small end.
    pub section_speed: [R; 2],
}

impl<R: Real> Pose<R> {
    /// The journal of a pin in its bearing.
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

    /// The slider in its guide.
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

/// Everything about one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation<R = f64> {
    /// Angles, positions and velocities.
    pub pose: Pose<R>,
    /// [m/s²] Of the joint centres.
    pub acceleration: JointVectors<R>,
    /// [rad/s²] Of crank, rod and slider.
    pub angle_acceleration: [R; 3],
    /// Loads, with the contact forces in them.
    pub loads: Loads<R>,
    /// Of a flexible rod.
    pub flexible: Option<FlexibleEvaluation<R>>,
}

/// What only a flexible rod has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexibleEvaluation<R = f64> {
    /// What the rod's motion needs of forces and moments.
    pub demand: InertialLoad<R>,
    /// Its elasticity.
    pub elastic: Elastic<R>,
    /// [J] Its kinetic energy.
    pub kinetic: R,
    /// [kg·m] ∫y dm.
    pub mass_height: R,
}

/// Rotations from `positions` and their `rates` at `t`; a crank whose angle is no coordinate follows `rotor`. The rod of a
/// closed loop counts as lying along the guide: it has no coordinate.
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

/// Rotations from angles and rates; the slider on an ideal guide does not turn.
#[inline(always)]
pub fn rotations<R: Real>(angle: [R; 3], speed: [R; 3], slider_turns: bool) -> BodyRotations<R> {
    let [crank, rod] = Rotation::all([angle[CRANK], angle[ROD]]);
    let slider = if slider_turns { Rotation::new(angle[SLIDER]) } else { Rotation::NONE };
    BodyRotations { angle, speed, rotation: [crank, rod, slider] }
}
