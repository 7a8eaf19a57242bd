//! Forces and couples on the bodies.

use super::joint::{guide, revolute};
use super::joint_set::Pin;
use super::plane::Vec2;
use crate::math::Real;

/// Loads on the bodies, without gravity and the reactions of ideal joints: forces at the joint centres, and couples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loads<R = f64> {
    /// [N] Force on the crank at its main journal.
    pub crank: Vec2<R>,
    /// [N] Force on the crank at its pin.
    pub crank_pin: Vec2<R>,
    /// [N] Force on the rod at its big end.
    pub big_end: Vec2<R>,
    /// [N] Force on the rod at its small end.
    pub small_end: Vec2<R>,
    /// [N] Force on the slider at its pin.
    pub pin: Vec2<R>,
    /// [N·m] Couple on the crank.
    pub crank_couple: R,
    /// [N·m] Couples on the rod's sections at its big and small end.
    pub end_couple: [R; 2],
    /// [N·m] Couple on the slider, about its pin.
    pub slider_couple: R,
    /// [N] The part of the force on the slider's pin that is an input.
    pub slider_load: R,
    /// The guide's part of the load on the slider: contact forces, or viscous friction of an ideal guide.
    pub guide: guide::Load<R>,
}

impl<R: Real> Loads<R> {
    /// Adds the contact load of a pin in its bearing.
    #[inline(always)]
    pub fn add_contact(&mut self, pin: Pin, load: &revolute::Load<R>) {
        match pin {
            Pin::MainBearing => self.crank += load.force,
            Pin::CrankPin => {
                self.crank_pin += load.force;
                self.big_end -= load.force;
            }
            Pin::SliderPin => {
                self.pin += load.force;
                self.small_end -= load.force;
            }
        }
        self.add_couples(pin, load.journal_couple, load.bearing_couple);
    }

    /// Adds couples on the journal and on the bearing of a pin.
    #[inline(always)]
    pub fn add_couples(&mut self, pin: Pin, journal: R, bearing: R) {
        match pin {
            Pin::MainBearing => self.crank_couple += journal,
            Pin::CrankPin => {
                self.crank_couple += journal;
                self.end_couple[0] += bearing;
            }
            Pin::SliderPin => {
                self.slider_couple += journal;
                self.end_couple[1] += bearing;
            }
        }
    }

    /// [N·m] Couples on crank, rod and slider.
    #[inline(always)]
    pub fn couples(&self) -> [R; 3] {
        [self.crank_couple, self.end_couple[0] + self.end_couple[1], self.slider_couple]
    }

    /// Adds the guide's load on the slider.
    #[inline(always)]
    pub fn add_guide(&mut self, load: &guide::Load<R>) {
        self.pin += load.force;
        self.slider_couple += load.couple;
        self.guide.force += load.force;
        self.guide.couple += load.couple;
    }
}
