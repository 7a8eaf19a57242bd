//! Collocation at the four nodes of Radau's right quadrature, in Legendre polynomials (E. Hairer, G. Wanner, Solving
//! Ordinary Differential Equations II, IV.5: order 7, L-stable).

use std::array::from_fn;

/// Number of nodes.
pub const NODES: usize = 4;

/// Nodes as shares of a step: the last is its end.
pub const SHARES: [f64; NODES] = [0.088_587_959_512_703_95, 0.409_466_864_440_734_7, 0.787_659_461_760_847_1, 1.0];
/// Weights of the nodes.
pub const WEIGHTS: [f64; NODES] = [0.220_462_211_176_768_38, 0.388_193_468_843_171_9, 0.328_844_319_980_059_74, 0.0625];

/// Integrals of the cardinal polynomials, and values of Legendre polynomials.
#[derive(Clone, Debug)]
pub struct Legendre {
    /// a_ij = ∫₀^{c_i} ℓ_j.
    pub integrals: [[f64; NODES]; NODES],
    /// (2m + 1)·w_j·P_m(c_j) in row m: the numbers that give the coefficient of P_m.
    pub analysis: [[f64; NODES]; NODES],
}

/// P_0 … P_4 on 0 to 1 at the share `s`.
fn polynomials(s: f64) -> [f64; NODES + 1] {
    let x = 2.0 * s - 1.0;
    let mut p = [1.0, x, 0.0, 0.0, 0.0];
    for m in 1..NODES {
        let degree = m as f64;
        p[m + 1] = ((2.0 * degree + 1.0) * x * p[m] - degree * p[m - 1]) / (degree + 1.0);
    }
    p
}

impl Legendre {
    /// The tables.
    pub fn new() -> Self {
        let at: [_; NODES] = from_fn(|j| polynomials(SHARES[j]));
        // ∫₀^c P_m = (P_{m+1}(c) − P_{m−1}(c))/(2·(2m + 1)).
        let integral = |i: usize, j: usize| {
            let higher = (1..NODES).map(|m: usize| at[j][m] * 0.5 * (at[i][m + 1] - at[i][m - 1])).sum::<f64>();
            WEIGHTS[j] * (SHARES[i] + higher)
        };
        Self {
            integrals: from_fn(|i| from_fn(|j| integral(i, j))),
            analysis: from_fn(|m| from_fn(|j| (2.0 * m as f64 + 1.0) * WEIGHTS[j] * at[j][m])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_integrated_exactly() {
        let Legendre { integrals, analysis } = Legendre::new();
        for power in 0..4_i32 {
            for (i, row) in integrals.iter().enumerate() {
                let sum: f64 = row.iter().zip(SHARES).map(|(a, c)| a * c.powi(power)).sum();
                let exact = SHARES[i].powi(power + 1) / f64::from(power + 1);
                assert!((sum - exact).abs() < 1e-15, "{power} {i}: {sum} {exact}");
            }
        }
        // s² = P₂/6 + P₁/2 + P₀/3.
        for (row, exact) in analysis.iter().zip([1.0 / 3.0, 0.5, 1.0 / 6.0, 0.0]) {
            let coefficient: f64 = row.iter().zip(SHARES).map(|(a, c)| a * c * c).sum();
            assert!((coefficient - exact).abs() < 1e-15, "{coefficient} {exact}");
        }
    }
}
