//! What a friction law says: forces and bristles as functions of the sliding speed.

use crate::math::Real;
use crate::scene;

/// What sliding does to a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionResponse<R = f64> {
    /// f_t/f_n.
    pub ratio: R,
    /// [m/s] Rate of the bristles' deflection; 0 of a law without them.
    pub bristle_rate: R,
}

impl<R: Real> FrictionResponse<R> {
    /// Of a law without bristles.
    #[inline(always)]
    pub(super) fn without_bristles(ratio: R) -> Self {
        Self { ratio, bristle_rate: R::ZERO }
    }
}

/// A friction law, one a file. A new one is its file, which defines a type of the item's name, and an item of
/// `FrictionLaw` in `modelDescription/variables.toml`.
pub trait Law: Copy {
    /// Of this friction.
    fn new(friction: &scene::Friction) -> Self;
    /// At the sliding speed `v` [m/s], with the bristles deflected by `z` [m].
    fn response<R: Real>(&self, v: R, z: R) -> FrictionResponse<R>;
    /// [m/s] Sliding speeds at which the law has corners.
    fn corners(&self) -> [Option<f64>; 2] {
        [None; 2]
    }
    /// [m] The deflection at which bristles at rest let go, where there are bristles.
    fn greatest_deflection(&self) -> Option<f64> {
        None
    }
}
