//! Vectors and rotations of the plane.

use crate::math;

/// A vector of the plane, in inertial axes unless said otherwise.
pub type Vec2 = nalgebra::Vector2<f64>;

/// (−v_y, v_x).
#[inline(always)]
pub fn perp(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// a_x·b_y − a_y·b_x: the moment of the force `b` at the arm `a`.
#[inline(always)]
pub fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// rot(θ), as its cosine and sine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rotation {
    /// cos θ
    pub cos: f64,
    /// sin θ
    pub sin: f64,
}

impl Rotation {
    /// No rotation.
    pub const NONE: Self = Self { cos: 1.0, sin: 0.0 };

    /// By `angle` [rad].
    #[inline(always)]
    pub fn new(angle: f64) -> Self {
        let (sin, cos) = math::sin_cos(angle);
        Self { cos, sin }
    }

    /// A vector of body axes in inertial axes.
    #[inline(always)]
    pub fn apply(self, v: Vec2) -> Vec2 {
        Vec2::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }

    /// `length` along the body's x axis, in inertial axes.
    #[inline(always)]
    pub fn axis(self, length: f64) -> Vec2 {
        Vec2::new(self.cos * length, self.sin * length)
    }
}
