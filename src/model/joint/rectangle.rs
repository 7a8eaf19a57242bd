//! The slider's rectangle between the guide's lines: its corners and faces, and how deep a point of it lies beyond a line.

use crate::integrator::EventFunction;
use crate::math::{Fused, Real};
use crate::model::contact::{ContactState, Elastic};
use crate::model::plane::{Rotation, Vec2};
use crate::scene::Scene;
use std::ops::Mul;

/// How many corners the slider has.
pub const CORNERS: usize = 4;

/// Where the slider is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SliderPose<R = f64> {
    /// [m] Pin centre.
    pub pin: Vec2<R>,
    /// [m/s] Its velocity.
    pub pin_velocity: Vec2<R>,
    /// Tilt.
    pub rotation: Rotation<R>,
    /// [rad/s] Rate of tilt.
    pub speed: R,
}

/// A point of the slider and the line that it may touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct CornerOnLine {
    /// [m] From the pin, in the slider's axes.
    pub offset: Vec2,
    /// Of the line's inner normal: −1 for the upper line, +1 for the lower.
    pub normal: f64,
    /// [m] Height of the line.
    pub line: f64,
}

/// Where a contact's force acts, and the motion of the slider's material there.
pub(super) struct SurfaceContact<R = f64> {
    /// [m] From the pin.
    pub arm: Vec2<R>,
    /// Of the line's inner normal, as in [`CornerOnLine`].
    pub normal: f64,
    /// [m] Penetration; a face's mean.
    pub depth: R,
    /// [m/s] Into the line.
    pub rate: R,
    /// [m/s] Along the line.
    pub sliding: R,
}

impl CornerOnLine {
    /// The contact of this point alone.
    #[inline(always)]
    pub fn touch<R: Real>(&self, pose: &SliderPose<R>) -> SurfaceContact<R> {
        self.touch_at(self.offset, pose)
    }

    /// The contact of the point at another `offset` [m] with the same line.
    #[inline(always)]
    pub fn touch_at<R: Real + Mul<S, Output = R> + Fused<S>, S: Copy>(
        &self,
        offset: Vec2<S>,
        pose: &SliderPose<R>,
    ) -> SurfaceContact<R> {
        let arm = pose.rotation.apply(offset);
        SurfaceContact {
            arm,
            normal: self.normal,
            depth: (-(pose.pin.y + arm.y) + self.line) * self.normal,
            rate: pose.speed.multiply_add(arm.x, pose.pin_velocity.y) * -self.normal,
            sliding: (-pose.speed).multiply_add(arm.y, pose.pin_velocity.x),
        }
    }
}

/// The slider's rectangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    /// Its corners: the upper ones, then the lower ones.
    pub corners: [CornerOnLine; CORNERS],
    /// Middles of the upper and of the lower face.
    pub middles: [CornerOnLine; 2],
    /// [m] a.
    pub half_length: f64,
}

impl Rectangle {
    /// From the scene.
    pub fn new(scene: &Scene) -> Self {
        let slider = &scene.slider;
        let (a, b) = (0.5 * slider.length, 0.5 * slider.height);
        let reach = b + scene.joint.t.clearance;
        let mark = |x: f64, side: f64| CornerOnLine {
            offset: Vec2::new(slider.centre.x + x, slider.centre.y + side * b),
            normal: -side,
            line: scene.guide.offset + side * reach,
        };
        Self {
            corners: [mark(a, 1.0), mark(-a, 1.0), mark(a, -1.0), mark(-a, -1.0)],
            middles: [mark(0.0, 1.0), mark(0.0, -1.0)],
            half_length: a,
        }
    }
}

/// What the slider touches its lines with.
pub(super) trait Surface {
    /// The contact that each corner is part of.
    const CONTACT_OF_CORNER: [usize; CORNERS];
    /// How many contacts there are.
    const CONTACTS: usize = Self::CONTACT_OF_CORNER[CORNERS - 1] + 1;
    /// Contact `k` as its force law needs it.
    fn touch<R: Real>(rectangle: &Rectangle, k: usize, pose: &SliderPose<R>) -> SurfaceContact<R>;
    /// [m], [m/s] Greatest penetration in contact `k`, and the approach speed if it closes now.
    fn approach(rectangle: &Rectangle, k: usize, pose: &SliderPose) -> (f64, f64);
    /// The events at which contacts change, each at the place of a corner.
    fn event_functions(rectangle: &Rectangle, states: &[ContactState], pose: &SliderPose) -> [EventFunction; CORNERS];
    /// [J] Elastic energy of contact `k` under this law.
    fn energy<R: Real>(rectangle: &Rectangle, elastic: &Elastic, k: usize, pose: &SliderPose<R>) -> R;
}
