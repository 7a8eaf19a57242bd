//! The slider's faces on elastic foundations: a bed of springs with the line load k_w·max(0, δ(x)).
//!
//! ```text
//!    open part  ──__            face of the slider, tilted
//!    ────────────────‾‾──__────────────────────────── line of the guide, δ = 0
//!                          ‾‾──__      | δ(x) = middle + slope·x
//!    pressed part                ‾‾──__|
//!    x = −a               x = 0               x = a
//! ```
//!
//! A face is straight, so that δ(x) is linear along it. The resulting force K·(mean of max(0, δ)) with K = k_w·2a, its
//! centre and its energy have closed forms. One law with a continuous derivative covers contact of one corner, of part
//! of the face, and of the whole face.
//!
//! The damping is one factor for the whole face. It depends on the rate at the centre of the undamped pressure: force
//! times that rate is the rate of the elastic energy, so that damping never supplies energy. Force and friction act at
//! that centre.

use super::rectangle::{CORNERS, Rectangle, SliderPose, Surface, SurfaceContact};
use crate::integrator::EventFunction;
use crate::math::{self, Real};
use crate::model::contact::compliance::compliance;
use crate::model::contact::{ContactState, Elastic};
use crate::model::plane::Vec2;
use crate::scene::Scene;
use std::f64::consts::PI;

/// Penetration along a face: δ(x) = middle + slope·x, |x| ≤ half.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FacePenetration<R = f64> {
    /// [m] a: half the length of the face.
    pub half: f64,
    /// [m] δ at the middle of the face.
    pub middle: R,
    /// dδ/dx: slope.
    pub slope: R,
}

/// The part of a face in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactZone<R = f64> {
    /// [m] ∫max(0, δ)dx/(2a).
    pub mean: R,
    /// [m] x of the centre of pressure, ∫x·max(0, δ)dx/∫max(0, δ)dx.
    pub centre: R,
}

impl<R: Real> FacePenetration<R> {
    /// δ [m] at the deeper end and at the other end.
    #[inline(always)]
    fn ends(&self) -> (R, R) {
        let rise = self.slope.abs() * self.half;
        (self.middle + rise, self.middle - rise)
    }

    /// Mean penetration and centre of pressure. If the whole face is open, these are 0 and the end that touches first.
    #[inline(always)]
    pub fn pressed(&self) -> ContactZone<R> {
        let Self { half, middle, slope } = *self;
        let (deep, shallow) = self.ends();
        // Trapezoid: the whole face is in contact. For parallel faces this is no difference of large numbers.
        let trapezoid = || ContactZone { mean: middle, centre: slope * half / middle * (half / 3.0) };
        // Triangle: only this length at the deeper end is in contact.
        let triangle = || {
            let length = deep / slope.abs();
            ContactZone { mean: deep * length / (4.0 * half), centre: (-(length / 3.0) + half).copysign(slope) }
        };
        let open = || ContactZone { mean: R::ZERO, centre: R::constant(half).copysign(slope) };
        if R::MANY {
            let (whole, part, open) = (trapezoid(), triangle(), open());
            let of = |whole, part, open| (-deep).choose(|| open, || (-shallow).choose(|| part, || whole));
            ContactZone {
                mean: of(whole.mean, part.mean, open.mean),
                centre: of(whole.centre, part.centre, open.centre),
            }
        } else if deep <= 0.0 {
            open()
        } else if shallow >= 0.0 {
            trapezoid()
        } else {
            triangle()
        }
    }

    /// [m²] Mean of max(0, δ)²: the elastic energy is half the stiffness K of the face times this.
    pub fn mean_square(&self) -> R {
        let Self { half, middle, slope } = *self;
        let (deep, shallow) = self.ends();
        let trapezoid = || {
            let rise = slope * half;
            middle * middle + rise * rise / 3.0
        };
        let triangle = || deep * deep * (deep / slope.abs()) / (6.0 * half);
        (-deep).choose(|| R::ZERO, || (-shallow).choose(triangle, trapezoid))
    }
}

/// [N/m] K = k_w·2a: stiffness of a face with uniform penetration.
pub fn stiffness(scene: &Scene) -> f64 {
    let joint = &scene.joint.t;
    let length = scene.slider.length;
    if joint.foundation_stiffness > 0.0 {
        joint.foundation_stiffness * length
    } else {
        half_space_stiffness(length, joint.contact.width, compliance(&joint.contact))
    }
}

/// [N/m] Stiffness of a rectangle on elastic half-spaces whose compliances (1 − ν²)/E sum to `compliance` [1/Pa]:
/// √A/(m·compliance), with m from the mean displacement under uniform pressure (S. P. Timoshenko, J. N. Goodier, Theory
/// of Elasticity, § 139: 0.95 for a square).
pub fn half_space_stiffness(length: f64, width: f64, compliance: f64) -> f64 {
    let r = length.max(width) / length.min(width);
    // 1 + r³ − (1 + r²)^1.5, written without the difference of two large cubes.
    let s = (1.0 + r * r).sqrt();
    let cubes = 1.0 - (s * s + s * r + r * r) / (s + r);
    let sum = 2.0 * r * math::asinh(r) + 2.0 * r * r * math::asinh(1.0 / r) + 2.0 / 3.0 * cubes;
    let m = sum / (PI * r * r.sqrt());
    (length * width).sqrt() / (m * compliance)
}

/// The surface whose two faces are contacts.
pub(super) struct Faces;

impl Faces {
    #[inline(always)]
    fn bed<R: Real>(rectangle: &Rectangle, face: usize, pose: &SliderPose<R>) -> FacePenetration<R> {
        let middle = &rectangle.middles[face];
        FacePenetration {
            half: rectangle.half_length,
            middle: middle.touch(pose).depth,
            slope: pose.rotation.sin * -middle.normal,
        }
    }

    /// The two ends of a face.
    #[inline(always)]
    fn ends<R: Real>(rectangle: &Rectangle, face: usize, pose: &SliderPose<R>) -> [SurfaceContact<R>; 2] {
        [rectangle.corners[2 * face].touch(pose), rectangle.corners[2 * face + 1].touch(pose)]
    }
}

impl Surface for Faces {
    const CONTACT_OF_CORNER: [usize; CORNERS] = [0, 0, 1, 1];

    #[inline(always)]
    fn touch<R: Real>(rectangle: &Rectangle, face: usize, pose: &SliderPose<R>) -> SurfaceContact<R> {
        let ContactZone { mean, centre } = Self::bed(rectangle, face, pose).pressed();
        let middle = &rectangle.middles[face];
        let offset = Vec2::new(centre + middle.offset.x, R::constant(middle.offset.y));
        SurfaceContact { depth: mean, ..middle.touch_at(offset, pose) }
    }

    fn approach<R: Real>(rectangle: &Rectangle, face: usize, pose: &SliderPose<R>) -> (R, R) {
        let [front, rear] = Self::ends(rectangle, face, pose);
        (larger(front.depth, rear.depth), larger(front.rate, rear.rate))
    }

    /// An open face has an event function for each of its corners and closes when one of them touches. A closed face
    /// has one for its deeper corner and opens when that separates.
    fn event_functions(rectangle: &Rectangle, states: &[ContactState], pose: &SliderPose) -> [EventFunction; CORNERS] {
        let mut event_functions = [EventFunction { value: 1.0, rate: 0.0 }; CORNERS];
        for (face, pair) in event_functions.chunks_exact_mut(2).enumerate() {
            let [front, rear] =
                Self::ends(rectangle, face, pose).map(|end| EventFunction { value: end.depth, rate: end.rate });
            if states[face].closed {
                let front_is_deeper = (front.value, front.rate) > (rear.value, rear.rate);
                pair[0] = if front_is_deeper { front } else { rear };
            } else {
                pair.copy_from_slice(&[front, rear].map(|end| EventFunction { value: -end.value, rate: -end.rate }));
            }
        }
        event_functions
    }

    fn energy<R: Real>(rectangle: &Rectangle, elastic: &Elastic, face: usize, pose: &SliderPose<R>) -> R {
        let stiffness = elastic.for_small_penetrations().stiffness;
        Self::bed(rectangle, face, pose).mean_square() * (0.5 * stiffness)
    }
}

/// The larger of two numbers of a face's ends. Of a face that lands flat both are the same, and a derivative is the mean of
/// those on both sides.
#[inline(never)]
fn larger<R: Real>(a: R, b: R) -> R {
    if a > b {
        a
    } else if b > a {
        b
    } else {
        (a + b) * 0.5
    }
}
