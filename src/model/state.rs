//! A mechanism at one instant, the same for every topology: what outputs are made from.

use super::contact::ContactMode;
use super::demand::Demand;
use super::drive::Rotor;
use super::joint::rectangle::{CORNERS, SliderPose};
use super::joint::revolute::Play;
use super::joint_set::Pin;
use super::kinematics::{JointCentres, Turning};
use super::loads::Loads;
use super::plane::Rotation;
use super::rod::Elastic;
use super::structure::{CRANK, ROD, SLIDER, Structure};
use crate::math::Real;

/// Contacts of the joints A, B, C and of the guide: its four corners, or its two faces and two idle ones.
pub const CONTACTS: usize = 3 + CORNERS;

/// The discrete state: every contact's memory.
pub type Contacts = [ContactMode; CONTACTS];

/// Angles, positions and velocities of an open mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<R = f64> {
    /// Angles and angular speeds.
    pub turning: Turning<R>,
    /// [m]
    pub place: JointCentres<R>,
    /// [m/s]
    pub velocity: JointCentres<R>,
    /// [rad/s] Of the rod's sections at its big and small end.
    pub section_speed: [R; 2],
}

impl<R: Real> Pose<R> {
    /// The journal of a pin in its bearing.
    #[inline(always)]
    pub fn play(&self, pin: Pin) -> Play<R> {
        let (p, v, speed, section) = (&self.place, &self.velocity, &self.turning.speed, &self.section_speed);
        match pin {
            Pin::MainBearing => {
                Play { eccentricity: p.crank, rate: v.crank, journal_speed: speed[CRANK], bearing_speed: R::ZERO }
            }
            Pin::CrankPin => Play {
                eccentricity: p.crank_pin - p.big_end,
                rate: v.crank_pin - v.big_end,
                journal_speed: speed[CRANK],
                bearing_speed: section[0],
            },
            Pin::SliderPin => Play {
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
            rotation: self.turning.rotation[SLIDER],
            speed: self.turning.speed[SLIDER],
        }
    }
}

/// Everything about one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant<R = f64> {
    /// Angles, positions and velocities.
    pub pose: Pose<R>,
    /// [m/s²] Of the joint centres.
    pub acceleration: JointCentres<R>,
    /// [rad/s²] Of crank, rod and slider.
    pub angle_acceleration: [R; 3],
    /// Loads, with the contact forces in them.
    pub loads: Loads<R>,
    /// Of a flexible rod.
    pub flexible: Option<FlexibleInstant<R>>,
}

/// What only a flexible rod has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexibleInstant<R = f64> {
    /// What the rod's motion needs of forces and moments.
    pub demand: Demand<R>,
    /// Its elasticity.
    pub elastic: Elastic<R>,
    /// [J] Its kinetic energy.
    pub kinetic: R,
    /// [kg·m] ∫y dm.
    pub mass_height: R,
}

/// Turning from `positions` and their `rates` at `t`; a crank whose angle is no coordinate follows `rotor`. The rod of a
/// closed loop counts as lying along the guide: it has no coordinate.
#[inline(always)]
pub fn turning_at<R: Real>(structure: &Structure, rotor: &Rotor, t: R, positions: &[R], rates: &[R]) -> Turning<R> {
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
    turning(angle, speed, structure.slider_angle.is_some())
}

/// Turning from angles and rates; the slider on an ideal guide does not turn.
#[inline(always)]
pub fn turning<R: Real>(angle: [R; 3], speed: [R; 3], slider_turns: bool) -> Turning<R> {
    let [crank, rod] = Rotation::all([angle[CRANK], angle[ROD]]);
    let slider = if slider_turns { Rotation::new(angle[SLIDER]) } else { Rotation::NONE };
    Turning { angle, speed, rotation: [crank, rod, slider] }
}
