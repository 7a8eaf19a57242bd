//! The slider's rectangle between the guide's lines: corners, faces, and the penetration of a point.

use crate::integrator::EventFunction;
use crate::math::{Fused, Real};
use crate::model::contact::{ContactState, Elastic};
use crate::model::plane::{Rotation, Vec2};
use crate::scene::Scene;
use std::ops::Mul;

/// Number of corners of the slider.
pub const CORNERS: usize = 4;

/// Pose and velocity of the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SliderPose<R = f64> {
    /// [m] Centre of the pin.
    pub pin: Vec2<R>,
    /// [m/s] Velocity of the pin.
    pub pin_velocity: Vec2<R>,
    /// Rotation of the slider (tilt).
    pub rotation: Rotation<R>,
    /// [rad/s] Angular velocity.
    pub speed: R,
}

/// A point of the slider and the line that it may touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct CornerOnLine {
    /// [m] Position from the pin, in slider axes.
    pub offset: Vec2,
    /// y component of the line's inner normal: −1 for the upper line, +1 for the lower line.
    pub normal: f64,
    /// [m] Height of the line.
    pub line: f64,
}

/// Point of action of a contact force, and the motion of the slider's material there.
pub(super) struct SurfaceContact<R = f64> {
    /// [m] Position from the pin, in inertial axes.
    pub arm: Vec2<R>,
    /// y component of the line's inner normal, as in [`CornerOnLine`].
    pub normal: f64,
    /// [m] Penetration; for a face its mean.
    pub depth: R,
    /// [m/s] Velocity into the line.
    pub rate: R,
    /// [m/s] Velocity along the line.
    pub sliding: R,
}

impl CornerOnLine {
    /// The contact of this point.
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
    /// The corners: the upper two, then the lower two.
    pub corners: [CornerOnLine; CORNERS],
    /// Middle points of the upper and the lower face.
    pub middles: [CornerOnLine; 2],
    /// [m] a: half the length.
    pub half_length: f64,
}

impl Rectangle {
    /// The rectangle of a scene.
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

/// Contact model between the slider and the lines.
pub(super) trait Surface {
    /// The contact to which each corner belongs.
    const CONTACT_OF_CORNER: [usize; CORNERS];
    /// Number of contacts.
    const CONTACTS: usize = Self::CONTACT_OF_CORNER[CORNERS - 1] + 1;
    /// Contact `k` as the force law needs it.
    fn touch<R: Real>(rectangle: &Rectangle, k: usize, pose: &SliderPose<R>) -> SurfaceContact<R>;
    /// Largest penetration [m] in contact `k`, and its approach speed [m/s] should it close now.
    fn approach<R: Real>(rectangle: &Rectangle, k: usize, pose: &SliderPose<R>) -> (R, R);
    /// The event functions at which contacts close or open, one per corner.
    fn event_functions(rectangle: &Rectangle, states: &[ContactState], pose: &SliderPose) -> [EventFunction; CORNERS];
    /// [J] Elastic energy of contact `k` under the law `elastic`.
    fn energy<R: Real>(rectangle: &Rectangle, elastic: &Elastic, k: usize, pose: &SliderPose<R>) -> R;
}
