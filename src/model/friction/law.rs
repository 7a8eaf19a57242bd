//! Interface of a friction law: force ratio and bristle rate as functions of the sliding speed.

use crate::math::Real;
use crate::scene;

/// Response of a friction law to sliding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionResponse<R = f64> {
    /// f_t/f_n.
    pub ratio: R,
    /// [m/s] Rate of the bristle deflection; 0 for a law without bristles.
    pub bristle_rate: R,
}

impl<R: Real> FrictionResponse<R> {
    /// The response of a law without bristles.
    #[inline(always)]
    pub(super) fn without_bristles(ratio: R) -> Self {
        Self { ratio, bristle_rate: R::ZERO }
    }
}

/// A friction law; each law has a file. A new law needs a file that defines a type of the item's name, and an item of
/// `FrictionLaw` in `modelDescription/variables.toml`.
pub trait Law: Copy {
    /// The law with the parameters of this friction.
    fn new(friction: &scene::Friction) -> Self;
    /// The response at the sliding speed `v` [m/s] and the bristle deflection `z` [m].
    fn response<R: Real>(&self, v: R, z: R) -> FrictionResponse<R>;
    /// [m/s] Sliding speeds at which the law has corners.
    fn corners(&self) -> [Option<f64>; 2] {
        [None; 2]
    }
    /// [m] The largest deflection of bristles at rest, at which they slip; `None` without bristles.
    fn max_deflection(&self) -> Option<f64> {
        None
    }
}
