//! Outputs of a rod's elasticity.

use super::flexible::Rod;
use crate::math::Real;

/// Deflection, stretch, elastic energy and modal loss of a rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Elastic<R = f64> {
    /// [m] Deflection at mid-span.
    pub deflection: R,
    /// [m] Change of the chord's length, L − l.
    pub stretch: R,
    /// [J] Elastic energy.
    pub energy: R,
    /// [W] Power lost in modal damping.
    pub modal_loss: R,
}

impl Rod {
    /// Deflection, elastic energy and modal loss of a rod with this `stretch` [m] and the modal coordinates `eta` [m] with
    /// their `rate` [m/s].
    pub fn elastic<R: Real>(&self, stretch: R, eta: &[R], rate: &[R]) -> Elastic<R> {
        let mut elastic = Elastic { stretch, ..Elastic::default() };
        elastic.deflection = eta.iter().zip(&self.middle).fold(R::ZERO, |sum, (eta, middle)| sum + *eta * *middle);
        for k in 0..self.modes() {
            let (m, omega) = (self.modal_mass[k], self.frequency[k]);
            elastic.energy += eta[k] * (0.5 * m * omega * omega) * eta[k];
            elastic.modal_loss += rate[k] * (2.0 * self.damping_ratio * m * omega) * rate[k];
        }
        elastic
    }
}
