//! Points of the slider against the guide's lines, and its four corners as contacts of their own.

use super::guide::{CORNERS, Guide, SliderPose, Surface};
use super::revolute::guard;
use crate::integrator::EventFunction;
use crate::math::{Fused, Real};
use crate::model::contact::ContactMode;
use crate::model::plane::Vec2;
use std::ops::Mul;

/// A point of the slider and the line that it may touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    /// [m] From the pin, in the slider's axes.
    pub offset: Vec2,
    /// Of the line's inner normal: −1 for the upper line, +1 for the lower.
    pub normal: f64,
    /// [m] Height of the line.
    pub line: f64,
}

/// Where a contact's force acts, and the motion of the slider's material there.
pub(super) struct Touch<R = f64> {
    /// [m] From the pin.
    pub arm: Vec2<R>,
    /// Of the line's inner normal, as in [`Mark`].
    pub normal: f64,
    /// [m] Penetration; a face's mean.
    pub depth: R,
    /// [m/s] Into the line.
    pub rate: R,
    /// [m/s] Along the line.
    pub sliding: R,
}

impl Mark {
    /// The contact of this point alone.
    #[inline(always)]
    pub fn touch<R: Real>(&self, pose: &SliderPose<R>) -> Touch<R> {
        self.touch_at(self.offset, pose)
    }

    /// The contact of the point at another `offset` [m] with the same line.
    #[inline(always)]
    pub fn touch_at<R: Real + Mul<S, Output = R> + Fused<S>, S: Copy>(
        &self,
        offset: Vec2<S>,
        pose: &SliderPose<R>,
    ) -> Touch<R> {
        let arm = pose.rotation.apply(offset);
        Touch {
            arm,
            normal: self.normal,
            depth: (-(pose.pin.y + arm.y) + self.line) * self.normal,
            rate: pose.speed.times_plus(arm.x, pose.pin_velocity.y) * -self.normal,
            sliding: (-pose.speed).times_plus(arm.y, pose.pin_velocity.x),
        }
    }
}

/// Each corner is a contact of its own.
pub(super) struct Corners;

impl Surface for Corners {
    const CONTACT_OF_CORNER: [usize; CORNERS] = [0, 1, 2, 3];

    #[inline(always)]
    fn touch<R: Real>(guide: &Guide, k: usize, pose: &SliderPose<R>) -> Touch<R> {
        guide.corners[k].touch(pose)
    }

    fn approach(guide: &Guide, k: usize, pose: &SliderPose) -> (f64, f64) {
        let Touch { depth, rate, .. } = guide.corners[k].touch(pose);
        (depth, rate)
    }

    fn guards(guide: &Guide, modes: &[ContactMode], pose: &SliderPose) -> [EventFunction; CORNERS] {
        std::array::from_fn(|k| {
            let Touch { depth, rate, .. } = guide.corners[k].touch(pose);
            guard(&modes[k], depth, rate)
        })
    }

    fn energy<R: Real>(guide: &Guide, k: usize, pose: &SliderPose<R>) -> R {
        guide.contact.elastic.energy(guide.corners[k].touch(pose).depth.max(0.0))
    }
}
