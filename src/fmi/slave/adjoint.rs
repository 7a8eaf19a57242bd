//! Adjoint derivatives: the transposed Jacobian of outputs with respect to inputs, times a vector.

use super::{Error, Permission, Slave};

impl Slave {
    /// Σᵢ `seeds`ᵢ·∂unknownᵢ/∂knownⱼ for each known j. There are few inputs, so the derivatives
    /// with respect to each are computed separately.
    pub fn adjoint_derivative(
        &mut self,
        permission: Permission,
        unknowns: &[u32],
        knowns: &[u32],
        seeds: &[f64],
        values: &mut [f64],
    ) -> Result<(), Error> {
        let mut column = vec![0.0; unknowns.len()];
        let mut sums = Vec::with_capacity(knowns.len());
        for &known in knowns {
            self.directional_derivative(permission, unknowns, &[known], &[1.0], &mut column)?;
            sums.push(column.iter().zip(seeds).map(|(slope, seed)| slope * seed).sum());
        }
        values.copy_from_slice(&sums);
        Ok(())
    }
}
