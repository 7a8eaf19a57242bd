//! What an elastic law says: force and energy as functions of penetration.

use crate::math::Real;
use crate::scene;

/// An elastic law of a revolute joint, one a file. A new one is its file, which defines a type of the item's name, and an
/// item of `Elasticity` in `modelDescription/variables.toml`.
pub trait ElasticLaw: Copy {
    /// Of this joint.
    fn new(joint: &scene::Revolute) -> Self;
    /// [N] F at the penetration `depth` [m], which is not negative.
    fn force<R: Real>(&self, depth: R) -> R;
    /// [J] ∫F dδ from 0 to `depth` [m].
    fn energy<R: Real>(&self, depth: R) -> R;
    /// The power law that this one is, or becomes as δ goes to 0.
    fn for_small_penetrations(&self) -> PowerLaw;
}

/// K·δ^p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// [N/m^p] K.
    pub stiffness: f64,
    /// p.
    pub exponent: f64,
}
