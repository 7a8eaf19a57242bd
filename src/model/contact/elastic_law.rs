//! Interface of an elastic law: force and energy as functions of penetration.

use crate::math::Real;
use crate::scene;

/// An elastic law of a revolute joint; each law has a file. A new law needs a file that defines a type of the item's
/// name, and an item of `Elasticity` in `modelDescription/variables.toml`.
pub trait ElasticLaw: Copy {
    /// The law with the parameters of this joint.
    fn new(joint: &scene::Revolute) -> Self;
    /// [N] F at the penetration `depth` [m] ≥ 0.
    fn force<R: Real>(&self, depth: R) -> R;
    /// [J] ∫F dδ from 0 to `depth` [m].
    fn energy<R: Real>(&self, depth: R) -> R;
    /// The power law that this law is, or tends to as δ tends to 0.
    fn for_small_penetrations(&self) -> PowerLaw;
}

/// A power law K·δ^p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// [N/m^p] K.
    pub stiffness: f64,
    /// p.
    pub exponent: f64,
}
