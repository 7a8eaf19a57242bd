//! Moments of the rod's modes, in the tables that its inertia is summed from.
//!
//! The field of places along the rod is x = Σ ξ_p·B_p across the functions B: the rod itself (ξ = 1), axial modes,
//! foreshortenings of pairs (ξ_kl = −q_k·q_l, twice that where k ≠ l). With w = Σ q_i·φ_i and ∂x/∂q_i = −2·Σ_k q_k·B_ik,
//! every integral over the rod that its motion asks for is a sum over few products of modal coordinates and rates.

use super::Rod;

/// The tables, each with a row for a factor and a column for a result; with room for `K` modes and `F` functions. Their
/// units are such that a factor [1, m, m² and their rates] makes of a row what stands with it.
#[derive(Clone, Debug)]
#[repr(align(32))] // so are its rows: four numbers of one come out of one line of the cache
pub struct Tables<const K: usize, const F: usize> {
    /// ∫B·Bᵀ dm; of a product of two factors [kg·m²].
    pub second: [[f64; F]; F],
    /// ∫B·φ_i dm for every bending mode and, after them, ∫B dm [kg·m].
    pub with_modes: [[f64; F]; F],
    /// From ξ: ∫(x·φ_i − w·∂x/∂q_i) dm, and ∫x dm [kg·m].
    pub placing: [[f64; F]; F],
    /// From ξ̇, with `twisting`: ∫(ẋ·φ_i − ẇ·∂x/∂q_i) dm, and ∫ẋ dm [kg·m/s].
    pub moving: [[f64; F]; F],
    /// From q_j·q̇_k − q_k·q̇_j for j < k, ordered by k.
    pub twisting: [[f64; F]; F],
    /// From ξ: ∫(∂x/∂q_i)·(∂x/∂q_j) dm [kg], for pairs i ≤ j.
    pub products: [[f64; F]; F],
    /// From q: ∫∂x/∂q_i dm [kg].
    pub shifting: [[f64; F]; K],
    /// From q, for every axial mode j: ∫B_j·∂x/∂q_i dm [kg].
    pub stretching: [[[f64; K]; K]; K],
    /// From q: ∂x/∂q_i at the small end.
    pub shortening: [[f64; K]; K],
}

impl<const K: usize, const F: usize> Tables<K, F> {
    /// Of a rod that has room here.
    pub fn new(rod: &Rod) -> Self {
        let counts = rod.counts;
        let (n, axial, count) = (counts.bending, counts.axial, counts.functions());
        let none = [[0.0; F]; F];
        let mut tables = Self {
            second: none,
            with_modes: none,
            placing: none,
            moving: none,
            twisting: none,
            products: none,
            shifting: [[0.0; F]; K],
            stretching: [[[0.0; K]; K]; K],
            shortening: [[0.0; K]; K],
        };
        let Self { second, with_modes, placing, moving, twisting, products, shifting, stretching, shortening } =
            &mut tables;
        for p in 0..count {
            second[p][..count].copy_from_slice(&rod.second[p * count..][..count]);
            with_modes[p][..n].copy_from_slice(&rod.coupling[p * n..][..n]);
            with_modes[p][n] = rod.first[p];
        }
        (*placing, *moving) = (*with_modes, *with_modes);
        let pair = |i, j| counts.pair(i, j);
        for (k, l) in counts.all_pairs() {
            let row = pair(k, l);
            for i in 0..n {
                let (with, crossed) = (with_modes[pair(i, l)][k], with_modes[pair(i, k)][l]);
                placing[row][i] -= with + crossed;
                moving[row][i] -= 0.5 * (with + crossed);
                if k < l {
                    twisting[l * (l - 1) / 2 + k][i] = crossed - with;
                }
            }
            for (i, j) in counts.all_pairs() {
                let product = second[pair(i, k)][pair(j, l)] + second[pair(i, l)][pair(j, k)];
                products[row][pair(i, j) - 1 - axial] = -2.0 * product;
            }
        }
        for k in 0..counts.shortening {
            for i in 0..n {
                shifting[k][i] = -2.0 * with_modes[pair(i, k)][n];
                shortening[k][i] = -2.0 * rod.end[pair(i, k)];
                for j in 0..axial {
                    stretching[j][k][i] = -2.0 * second[pair(i, k)][1 + j];
                }
            }
        }
        tables
    }
}
