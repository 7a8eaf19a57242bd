//! Condensation: eliminates the modal coordinates from the equations of motion, so that those of the angles are solved
//! as with a rigid rod.
//!
//! ```text
//!     | M_ηη  C  | | η̈ |   | Q_η |
//!     | Cᵀ    M  |·| θ̈ | = | Q   |      M − Cᵀ·M_ηη⁻¹·C,   Q − Cᵀ·M_ηη⁻¹·Q_η
//! ```
//!
//! M_ηη is positive definite and is factorised into L·D·Lᵀ. D has 2×2 blocks, because each pivot waits for the division
//! of the pivot before it, and blocks halve the number of divisions.

#![allow(clippy::needless_range_loop)] // triangles are read by their indices

use super::dynamics::Equations;
use super::rod::CompiledCounts;
use crate::math::{Real, unroll};

/// The equations of at most `K` modal coordinates.
pub struct ModalEquations<R, const K: usize> {
    /// Number of modal coordinates.
    pub size: usize,
    /// [kg] M_ηη; the upper triangle.
    pub matrix: [[R; K]; K],
    /// [kg·m] C: coupling of each mode with the angles of crank, rod and slider.
    pub with: [[R; 3]; K],
    /// [N] Q_η: right-hand side.
    pub right: [R; K],
}

/// A 2×2 block |a b; b d| that is eliminated at once, and its inverse determinant.
#[derive(Clone, Copy)]
struct Block<R> {
    a: R,
    b: R,
    d: R,
    per: R,
}

impl<R: Real> Block<R> {
    /// The adjugate of the block times a column.
    #[inline(always)]
    fn adjugate(&self, [one, two]: [R; 2]) -> [R; 2] {
        let Self { a, b, d, .. } = *self;
        [d.multiply_add(one, -(b * two)), a.multiply_add(two, -(b * one))]
    }

    /// The element that remains after the elimination of the block.
    #[inline(always)]
    fn reduced(&self, [p, q]: [R; 2], [one, two]: [R; 2], element: R) -> R {
        p.multiply_add(one, q * two).multiply_add(-self.per, element)
    }
}

impl<R: Real, const K: usize> ModalEquations<R, K> {
    /// Equations of zeros for `size` coordinates.
    #[inline(always)]
    pub fn new(size: usize) -> Self {
        Self { size, matrix: [[R::ZERO; K]; K], with: [[R::ZERO; 3]; K], right: [R::ZERO; K] }
    }

    /// Eliminates the modal coordinates from the equations of the `angles`.
    #[inline(always)]
    pub(super) fn condense<C: CompiledCounts>(&mut self, angles: &mut Equations<R>) {
        let size = self.size;
        unroll!(C::KNOWN, half < size / 2, C::MODES.div_ceil(2) => {
            let k = 2 * half;
            let block = self.block(k);
            unroll!(C::KNOWN, i in k + 2..size, C::MODES => {
                self.eliminate::<C>(&block, k, i);
            });
            angles.reduce(&block, self.with[k], self.with[k + 1], [self.right[k], self.right[k + 1]]);
        });
        if !size.is_multiple_of(2) {
            // A last coordinate without partner is paired with one that is decoupled.
            let last = size - 1;
            let (b, d) = (R::ZERO, R::ONE);
            let a = self.matrix[last][last];
            let block = Block { a, b, d, per: a.recip() };
            angles.reduce(&block, self.with[last], [R::ZERO; 3], [self.right[last], R::ZERO]);
        }
    }

    /// Eliminates the block of coordinates `k` and `k` + 1 from the equation of `i`.
    #[inline(always)]
    fn eliminate<C: CompiledCounts>(&mut self, block: &Block<R>, k: usize, i: usize) {
        let own = block.adjugate([self.matrix[k][i], self.matrix[k + 1][i]]);
        unroll!(C::KNOWN, j in i..self.size, C::MODES => {
            let other = [self.matrix[k][j], self.matrix[k + 1][j]];
            self.matrix[i][j] = block.reduced(own, other, self.matrix[i][j]);
        });
        let (one, two) = (self.with[k], self.with[k + 1]);
        for angle in 0..3 {
            self.with[i][angle] = block.reduced(own, [one[angle], two[angle]], self.with[i][angle]);
        }
        self.right[i] = block.reduced(own, [self.right[k], self.right[k + 1]], self.right[i]);
    }

    /// The block of coordinates `k` and `k` + 1.
    #[inline(always)]
    fn block(&self, k: usize) -> Block<R> {
        let (a, b, d) = (self.matrix[k][k], self.matrix[k][k + 1], self.matrix[k + 1][k + 1]);
        Block { a, b, d, per: a.multiply_add(d, -(b * b)).recip() }
    }

    /// The accelerations [m/s²] of the modal coordinates, given those of the angles [rad/s²].
    #[inline(always)]
    pub(super) fn accelerations<C: CompiledCounts>(self, angles: [R; 3]) -> [R; K] {
        let (size, mut found) = (self.size, self.right);
        unroll!(C::KNOWN, k < size, C::MODES => {
            let [with_crank, with_rod, with_slider] = self.with[k];
            let known = with_crank.multiply_add(angles[0], with_rod.multiply_add(angles[1], with_slider * angles[2]));
            found[k] -= known;
        });
        if !size.is_multiple_of(2) {
            let last = size - 1;
            found[last] = found[last] * self.matrix[last][last].recip();
        }
        unroll!(C::KNOWN, done < size / 2, C::MODES.div_ceil(2) => {
            self.substitute::<C>(2 * (size / 2 - 1 - done), &mut found);
        });
        found
    }

    /// Replaces the right-hand sides of `k` and `k` + 1 by the solution, given the solution of all later coordinates.
    #[inline(always)]
    fn substitute<C: CompiledCounts>(&self, k: usize, found: &mut [R; K]) {
        unroll!(C::KNOWN, later in k + 2..self.size, C::MODES => {
            found[k] = (-self.matrix[k][later]).multiply_add(found[later], found[k]);
            found[k + 1] = (-self.matrix[k + 1][later]).multiply_add(found[later], found[k + 1]);
        });
        let block = self.block(k);
        let [one, two] = block.adjugate([found[k], found[k + 1]]);
        (found[k], found[k + 1]) = (one * block.per, two * block.per);
    }
}

impl<R: Real> Equations<R> {
    /// Subtracts the contribution of an eliminated block of modal coordinates. `one` and `two` are its columns of C,
    /// `right` its right-hand sides.
    #[inline(always)]
    fn reduce(&mut self, block: &Block<R>, one: [R; 3], two: [R; 3], right: [R; 2]) {
        let column = |angle: usize| [one[angle], two[angle]];
        let [first, second, third] = [block.adjugate(column(0)), block.adjugate(column(1)), block.adjugate(column(2))];
        let m = &mut self.m;
        m.d1 = block.reduced(first, column(0), m.d1);
        m.m12 = block.reduced(first, column(1), m.m12);
        m.m13 = block.reduced(first, column(2), m.m13);
        m.d2 = block.reduced(second, column(1), m.d2);
        m.m23 = block.reduced(second, column(2), m.m23);
        m.d3 = block.reduced(third, column(2), m.d3);
        self.q1 = block.reduced(first, right, self.q1);
        self.q2 = block.reduced(second, right, self.q2);
        self.q3 = block.reduced(third, right, self.q3);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::dynamics::MassMatrix;
    use crate::model::plane::Vec2;
    use crate::model::rod::{FixedCounts, RuntimeCounts};

    const ROOM: usize = 12;

    /// Element of the matrix of a chain of springs and masses, with fill-in far from the diagonal.
    fn element(i: usize, j: usize) -> f64 {
        match i.abs_diff(j) {
            0 => 3.0 + i as f64,
            1 => -1.0,
            distance => 0.1 / distance as f64,
        }
    }

    fn solution(k: usize) -> f64 {
        if k.is_multiple_of(2) { k as f64 + 1.0 } else { -(k as f64 + 1.0) }
    }

    /// The modal coordinates at the exact accelerations of the angles, and the residual of the angles' condensed
    /// equations.
    fn found<C: CompiledCounts>(size: usize) -> ([f64; ROOM], [f64; 3]) {
        let right = |i: usize| (0..size + 3).map(|j| element(i, j) * solution(j)).sum::<f64>();
        let mut modal = ModalEquations::<f64, ROOM>::new(size);
        for i in 0..size {
            for j in i..size {
                modal.matrix[i][j] = element(i, j);
            }
            modal.with[i] = [0, 1, 2].map(|k| element(i, size + k));
            modal.right[i] = right(i);
        }
        let of = |i: usize, j: usize| element(size + i, size + j);
        let m = MassMatrix { d1: of(0, 0), d2: of(1, 1), d3: of(2, 2), m12: of(0, 1), m23: of(1, 2), m13: of(0, 2) };
        let [q1, q2, q3] = [0, 1, 2].map(|k| right(size + k));
        let mut angles = Equations { m, q1, q2, q3, h1: Vec2::ZERO, h2: Vec2::ZERO };
        modal.condense::<C>(&mut angles);
        let wanted = [0, 1, 2].map(|k| solution(size + k));
        let [a1, a2, a3] = wanted;
        let Equations { m, q1, q2, q3, .. } = angles;
        let left = [
            q1 - m.d1 * a1 - m.m12 * a2 - m.m13 * a3,
            q2 - m.m12 * a1 - m.d2 * a2 - m.m23 * a3,
            q3 - m.m13 * a1 - m.m23 * a2 - m.d3 * a3,
        ];
        (modal.accelerations::<C>(wanted), left)
    }

    #[test]
    fn what_is_condensed_has_the_solution_of_the_whole() {
        for size in 1..=ROOM {
            let (modal, left) = found::<RuntimeCounts>(size);
            assert_eq!((modal, left), found::<FixedCounts<ROOM, 0>>(size), "{size}");
            for (k, modal) in modal.iter().enumerate().take(size) {
                assert!((modal - solution(k)).abs() < 1e-11, "{size}: {modal} for {}", solution(k));
            }
            assert!(left.iter().all(|left| left.abs() < 1e-10), "{size}: {left:?}");
        }
    }
}
