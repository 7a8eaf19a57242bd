//! Vectors and rotations of the plane.

use crate::math::{Fused, Real, unroll};
use std::ops::Mul;

pub use crate::math::Vec2;

/// (−v_y, v_x): the vector `v` turned by 90°.
#[inline(always)]
pub fn perp<R: Real>(v: Vec2<R>) -> Vec2<R> {
    Vec2::new(-v.y, v.x)
}

/// a_x·b_y − a_y·b_x: the moment of the force `b` at the arm `a`.
#[inline(always)]
pub fn cross<R: Real>(a: Vec2<R>, b: Vec2<R>) -> R {
    a.x.multiply_add(b.y, -(a.y * b.x))
}

/// Rotation rot(θ), stored as cosine and sine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rotation<R = f64> {
    /// cos θ
    pub cos: R,
    /// sin θ
    pub sin: R,
}

impl<R: Real> Rotation<R> {
    /// The identity.
    pub const NONE: Self = Self { cos: R::ONE, sin: R::ZERO };

    /// The rotation by `angle` [rad].
    #[inline(always)]
    pub fn new(angle: R) -> Self {
        let [own] = Self::all([angle]);
        own
    }

    /// The rotations by each of `angles` [rad].
    #[inline(always)]
    pub fn all<const K: usize>(angles: [R; K]) -> [Self; K] {
        let (found, mut all) = (R::sin_cos(angles), [Self::NONE; K]);
        unroll!(true, k < K => {
            let (sin, cos) = found[k];
            all[k] = Self { cos, sin };
        });
        all
    }

    /// The vector `v`, given in body axes, in inertial axes.
    #[inline(always)]
    pub fn apply<S: Copy>(self, v: Vec2<S>) -> Vec2<R>
    where
        R: Mul<S, Output = R> + Fused<S>,
    {
        Vec2::new(self.cos.multiply_add(v.x, -(self.sin * v.y)), self.sin.multiply_add(v.x, self.cos * v.y))
    }

    /// The vector of `length` along the body's x axis, in inertial axes.
    #[inline(always)]
    pub fn axis<S: Copy>(self, length: S) -> Vec2<R>
    where
        R: Mul<S, Output = R>,
    {
        Vec2::new(self.cos * length, self.sin * length)
    }
}
