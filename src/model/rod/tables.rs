//! Moments of the rod's modes, in the tables from which its inertia is summed.
//!
//! Positions along the rod are x = Σ ξ_p·B_p over the functions B: the rod itself (ξ = 1), axial modes, and
//! foreshortenings of pairs (ξ_kl = −q_k·q_l, twice that if k ≠ l). With w = Σ q_i·φ_i and ∂x/∂q_i = −2·Σ_k q_k·B_ik,
//! every integral over the rod is a sum over few products of modal coordinates and rates.

use super::counts::RodCapacity;
use super::flexible::Rod;

/// Rows of `width` numbers.
#[derive(Clone, Debug)]
struct Table {
    width: usize,
    numbers: Vec<f64>,
}

impl Table {
    fn new(rows: usize, width: usize) -> Self {
        Self { width, numbers: vec![0.0; rows * width] }
    }

    fn row(&mut self, row: usize) -> &mut [f64] {
        &mut self.numbers[row * self.width..][..self.width]
    }

    #[inline(always)]
    fn rows<const WIDTH: usize>(&self) -> &[[f64; WIDTH]] {
        self.numbers.as_chunks().0
    }
}

/// The tables; each has a row for a factor and a column for a result. A factor [1, m, m² or their rates] times its row
/// gives its part of the results.
#[derive(Clone, Debug)]
pub struct Tables {
    second: Table,
    with_modes: Table,
    placing: Table,
    moving: Table,
    twisting: Table,
    products: Table,
    shifting: Table,
    stretching: Vec<Table>,
    shortening: Table,
}

/// The tables as rows of arrays for `K` modes and `F` functions.
#[derive(Clone, Copy, Debug)]
pub(super) struct TableView<'a, const K: usize, const F: usize> {
    tables: &'a Tables,
    /// ∫B·Bᵀ dm, for a product of two factors [kg·m²].
    pub second: &'a [[f64; F]],
    /// ∫B·φ_i dm for every bending mode and, last, ∫B dm [kg·m].
    pub with_modes: &'a [[f64; F]],
    /// Factors ξ; results ∫(x·φ_i − w·∂x/∂q_i) dm, and ∫x dm [kg·m].
    pub placing: &'a [[f64; F]],
    /// Factors ξ̇; results, together with those of `twisting`: ∫(ẋ·φ_i − ẇ·∂x/∂q_i) dm, and ∫ẋ dm [kg·m/s].
    pub moving: &'a [[f64; F]],
    /// Factors q_j·q̇_k − q_k·q̇_j for j < k, ordered by k.
    pub twisting: &'a [[f64; F]],
    /// Factors ξ; results ∫(∂x/∂q_i)·(∂x/∂q_j) dm [kg] for pairs i ≤ j.
    pub products: &'a [[f64; F]],
    /// Factors q; results ∫∂x/∂q_i dm [kg].
    pub shifting: &'a [[f64; F]],
    /// Factors q; results ∂x/∂q_i at the small end.
    pub shortening: &'a [[f64; K]],
}

impl<'a, const K: usize, const F: usize> TableView<'a, K, F> {
    /// Factors q; results ∫B_j·∂x/∂q_i dm [kg] for the axial mode `j`.
    #[inline(always)]
    pub fn stretching(&self, j: usize) -> &'a [[f64; K]] {
        self.tables.stretching[j].rows()
    }
}

impl Tables {
    /// The tables of a rod, with the array sizes of `room`.
    pub fn new(rod: &Rod, room: RodCapacity) -> Self {
        let counts = rod.counts;
        let (n, axial, count) = (counts.bending, counts.axial, counts.functions());
        let [modes, functions] = room.size();
        let of_functions = |rows: usize| Table::new(rows, functions);
        let mut tables = Self {
            second: of_functions(count),
            with_modes: of_functions(count),
            placing: of_functions(count),
            moving: of_functions(count),
            twisting: of_functions(counts.twists(counts.shortening)),
            products: of_functions(count),
            shifting: of_functions(counts.shortening),
            stretching: vec![Table::new(counts.shortening, modes); axial],
            shortening: Table::new(counts.shortening, modes),
        };
        let Self { second, with_modes, placing, moving, twisting, products, shifting, stretching, shortening } =
            &mut tables;
        for p in 0..count {
            second.row(p)[..count].copy_from_slice(&rod.second[p * count..][..count]);
            for table in [&mut *with_modes, placing, moving] {
                table.row(p)[..n].copy_from_slice(&rod.coupling[p * n..][..n]);
                table.row(p)[n] = rod.first[p];
            }
        }
        let pair = |i, j| counts.pair(i, j);
        for (k, l) in counts.all_pairs() {
            let row = pair(k, l);
            for i in 0..n {
                let (with, crossed) = (with_modes.row(pair(i, l))[k], with_modes.row(pair(i, k))[l]);
                placing.row(row)[i] -= with + crossed;
                moving.row(row)[i] -= 0.5 * (with + crossed);
                if k < l {
                    twisting.row(l * (l - 1) / 2 + k)[i] = crossed - with;
                }
            }
            for (i, j) in counts.all_pairs() {
                let product = second.row(pair(i, k))[pair(j, l)] + second.row(pair(i, l))[pair(j, k)];
                products.row(row)[pair(i, j) - 1 - axial] = -2.0 * product;
            }
        }
        for k in 0..counts.shortening {
            for i in 0..n {
                shifting.row(k)[i] = -2.0 * with_modes.row(pair(i, k))[n];
                shortening.row(k)[i] = -2.0 * rod.end[pair(i, k)];
                for (j, stretching) in stretching.iter_mut().enumerate() {
                    stretching.row(k)[i] = -2.0 * second.row(pair(i, k))[1 + j];
                }
            }
        }
        tables
    }

    /// Views the tables as rows of arrays of their own width.
    #[inline(always)]
    pub(super) fn viewed<const K: usize, const F: usize>(&self) -> TableView<'_, K, F> {
        TableView {
            tables: self,
            second: self.second.rows(),
            with_modes: self.with_modes.rows(),
            placing: self.placing.rows(),
            moving: self.moving.rows(),
            twisting: self.twisting.rows(),
            products: self.products.rows(),
            shifting: self.shifting.rows(),
            shortening: self.shortening.rows(),
        }
    }
}
