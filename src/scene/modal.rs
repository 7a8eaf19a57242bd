//! Modal table: elastic modes of a rod as exported from a finite-element code, in place of those of the uniform beam.
//!
//! In a scene the table is `[rod.flexible.table]`, or `rod.flexible.table = "beam.toml"` names a file next to the scene
//! file with the same keys. Numbers are in SI units without a unit. Example: the first mode of a uniform rod of 0.12 m
//! and 0.21 kg, φ = sin(πx/l), at 1 kHz:
//!
//! ```
//! let text = r#"
//! [rod.flexible]
//! bending_modes = 1
//! [rod.flexible.table]
//! mass = 0.21
//! bending = [
//!   { frequency = 6283.2, mass = 0.105, moment = 0.13369, middle = 1.0, slope_start = 26.180, slope_end = -26.180 },
//! ]
//! axial = []
//! shortening = [20.562]                               # of B, two functions here: x and Γ11
//! first = [0.0126, 2.1590]
//! second = [[1.008e-3, 0.15959], [0.15959, 26.221]]
//! coupling = [[8.0214e-3], [1.3745]]
//! "#;
//! let scene = slidercrank::scene::read::read(text, "scene.toml")?.scene;
//! assert!(scene.rod.flexible.table.is_some_and(|table| table.bending.len() == 1));
//! # Ok::<(), slidercrank::scene::problem::ReadError>(())
//! ```

use serde::{Deserialize, Serialize};

/// Modes of a rod and the integrals of their shapes over its mass, in SI units.
///
/// The rod lies along x from 0 (big end) to l (small end); y points to the left of that direction. The shapes keep the
/// ends on the x axis: φ_i(0) = φ_i(l) = 0. Bending mode i deflects the rod by φ_i(x) along y, axial mode j displaces
/// it by ψ_j(x) along x, ψ_j(0) = 0. The foreshortening of two bending modes i ≤ j is Γ_ij(x) = ½∫₀ˣ φ_i'·φ_j' ds.
/// Displacements along x are sums of the functions B = (x, ψ_1, ψ_2, …, Γ_11, Γ_12, …, Γ_1n, Γ_22, …, Γ_nn), in this
/// order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModalTable {
    /// [kg] ∫dm: mass.
    pub mass: f64,
    /// Bending modes, in ascending order of frequency; orthogonal.
    #[serde(default)]
    pub bending: Vec<BendingMode>,
    /// Axial modes, in ascending order of frequency; orthogonal.
    #[serde(default)]
    pub axial: Vec<AxialMode>,
    /// Γ_ij(l) for i ≤ j, in the order of B.
    #[serde(default)]
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
#[serde(deny_unknown_fields)]
pub struct BendingMode {
    /// [rad/s] Natural angular frequency.
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
#[serde(deny_unknown_fields)]
pub struct AxialMode {
    /// [rad/s] Natural angular frequency.
    pub frequency: f64,
    /// ∫ψ² dm.
    pub mass: f64,
    /// ψ(l).
    pub end: f64,
}

/// Maximum number of bending modes, and of axial modes.
pub const MAX_MODES: usize = 8;

/// Number of pairs i ≤ j of `n` bending modes.
pub const fn pairs(n: usize) -> usize {
    n * (n + 1) / 2
}

/// Number of functions B of `bending` and `axial` modes.
pub const fn functions(bending: usize, axial: usize) -> usize {
    1 + axial + pairs(bending)
}

/// Maximum number of numbers of a table.
pub const MAX_NUMBERS: usize = numbers(MAX_MODES, MAX_MODES);

/// Length of [`ModalTable::numbers`] with these numbers of modes.
const fn numbers(bending: usize, axial: usize) -> usize {
    let functions = functions(bending, axial);
    3 + 6 * bending + 3 * axial + pairs(bending) + functions * (1 + functions + bending)
}

impl ModalTable {
    /// Numbers of bending and of axial modes.
    pub fn modes(&self) -> [usize; 2] {
        [self.bending.len(), self.axial.len()]
    }

    /// All numbers of the table in the order of declaration, after the numbers of bending and of axial modes.
    pub fn numbers(&self) -> Vec<f64> {
        let mut out = vec![self.bending.len() as f64, self.axial.len() as f64, self.mass];
        for BendingMode { frequency, mass, moment, middle, slope_start, slope_end } in &self.bending {
            out.extend([frequency, mass, moment, middle, slope_start, slope_end]);
        }
        for AxialMode { frequency, mass, end } in &self.axial {
            out.extend([frequency, mass, end]);
        }
        out.extend(self.shortening.iter().chain(&self.first));
        out.extend(self.second.iter().chain(&self.coupling).flatten());
        out
    }

    /// The table of these [`numbers`](Self::numbers); `None` if the length of the list does not fit.
    pub fn from_numbers(list: &[f64]) -> Option<Self> {
        // A number that is not a count saturates in the cast, or does not fit the length of the list.
        let (bending, axial) = (*list.first()? as usize, *list.get(1)? as usize);
        if bending > MAX_MODES || axial > MAX_MODES || list.len() != numbers(bending, axial) {
            return None;
        }
        let mut rest = list[2..].iter().copied();
        let mut next = || rest.next().unwrap_or_default();
        let mut several = |count: usize| -> Vec<f64> { (0..count).map(|_| next()).collect() };
        let functions = functions(bending, axial);
        let mass = several(1)[0];
        let bending_mode = |of: Vec<f64>| BendingMode {
            frequency: of[0],
            mass: of[1],
            moment: of[2],
            middle: of[3],
            slope_start: of[4],
            slope_end: of[5],
        };
        let axial_mode = |of: Vec<f64>| AxialMode { frequency: of[0], mass: of[1], end: of[2] };
        Some(Self {
            mass,
            bending: (0..bending).map(|_| bending_mode(several(6))).collect(),
            axial: (0..axial).map(|_| axial_mode(several(3))).collect(),
            shortening: several(pairs(bending)),
            first: several(functions),
            second: (0..functions).map(|_| several(functions)).collect(),
            coupling: (0..functions).map(|_| several(bending)).collect(),
        })
    }
}
