//! Elastic modes of a rod as a finite-element code exports them, in place of the uniform beam's.

use serde::{Deserialize, Serialize};

/// Modes of a rod and the integrals of their shapes over its mass, in SI units.
///
/// The rod lies along x from 0 to l. Bending mode i deflects it by φ_i(x) across, axial mode j
/// stretches it by ψ_j(x) along, ψ_j(0) = 0. The foreshortening of two bending modes i ≤ j is
/// Γ_ij(x) = ½∫₀ˣ φ_i'·φ_j' ds. Displacements along x are sums of the functions
/// B = (x, ψ_1, ψ_2, …, Γ_11, Γ_12, …, Γ_1n, Γ_22, …, Γ_nn), in this order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModalTable {
    /// [kg] ∫dm.
    pub mass: f64,
    /// Bending modes, by frequency; orthogonal.
    pub bending: Vec<BendingMode>,
    /// Axial modes, by frequency; orthogonal.
    pub axial: Vec<AxialMode>,
    /// Γ_ij(l), in the order of B.
    pub shortening: Vec<f64>,
    /// ∫B dm.
    pub first: Vec<f64>,
    /// ∫B·Bᵀ dm, symmetric.
    pub second: Vec<Vec<f64>>,
    /// ∫B·φᵀ dm: one row for each function of B, one column for each bending mode.
    pub coupling: Vec<Vec<f64>>,
}

/// A bending mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BendingMode {
    /// [rad/s]
    pub frequency: f64,
    /// ∫φ² dm.
    pub mass: f64,
    /// ∫φ dm.
    pub moment: f64,
    /// φ(l/2).
    pub middle: f64,
    /// φ'(0).
    pub slope_start: f64,
    /// φ'(l).
    pub slope_end: f64,
}

/// An axial mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AxialMode {
    /// [rad/s]
    pub frequency: f64,
    /// ∫ψ² dm.
    pub mass: f64,
    /// ψ(l).
    pub end: f64,
}

/// Most bending modes, and most axial modes.
pub const MOST_MODES: usize = 8;

/// Number of pairs i ≤ j of `n` bending modes.
pub const fn pairs(n: usize) -> usize {
    n * (n + 1) / 2
}
