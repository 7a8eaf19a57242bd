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

#![allow(clippy::needless_range_loop)] // several arrays are read by the number of one mode

use super::dynamics::Equations;
use super::rod::{CompiledCounts, in_registers};
use super::structure::{CRANK, ROD, SLIDER};
use crate::math::{Real, unroll};

/// The equations of at most `K` modal coordinates.
pub struct ModalEquations<'a, R, const K: usize> {
    /// Number of modal coordinates.
    pub size: usize,
    /// Which of the angles of crank, rod and slider are coupled with the modes.
    pub angles: [bool; 3],
    /// [kg] M_ηη; the lower triangle. With derivatives it is long, so it stays where the rod's inertia was.
    pub matrix: &'a mut [[R; K]; K],
    /// [kg·m] C: coupling of the angles of crank, rod and slider with each mode.
    pub with: [[R; K]; 3],
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
    /// The inverse of the block times a column.
    #[inline(always)]
    fn inverse(&self, [one, two]: [R; 2]) -> [R; 2] {
        let Self { a, b, d, per } = *self;
        [d.multiply_add(one, -(b * two)) * per, a.multiply_add(two, -(b * one)) * per]
    }
}

/// p·x + q·y + `sum`.
#[inline(always)]
fn add_product<R: Real>([p, q]: [R; 2], [x, y]: [R; 2], sum: R) -> R {
    p.multiply_add(x, q.multiply_add(y, sum))
}

impl<R: Real, const K: usize> ModalEquations<'_, R, K> {
    /// Eliminates the modal coordinates from the equations of the angles and returns the inverse determinants of the
    /// blocks.
    #[inline(always)]
    pub(super) fn condense<C: CompiledCounts>(&mut self, equations: &mut Equations<R>) -> [R; K] {
        let (size, mut per) = (self.size, [R::ZERO; K]);
        unroll!(C::KNOWN, half < size / 2, C::MODES.div_ceil(2) => {
            let block = self.block(2 * half);
            per[half] = block.per;
            self.eliminate::<C>(&block, 2 * half);
            let (k, [crank, rod, slider]) = (2 * half, &self.with);
            let with = [[crank[k], crank[k + 1]], [rod[k], rod[k + 1]], [slider[k], slider[k + 1]]];
            equations.reduce(self.angles, &block, with, [self.right[k], self.right[k + 1]]);
        });
        if !size.is_multiple_of(2) {
            let last = size - 1;
            let block = self.single(last);
            per[last / 2] = block.per;
            let [crank, rod, slider] = &self.with;
            let with = [[crank[last], R::ZERO], [rod[last], R::ZERO], [slider[last], R::ZERO]];
            equations.reduce(self.angles, &block, with, [self.right[last], R::ZERO]);
        }
        per
    }

    /// Eliminates the block of coordinates `k` and `k` + 1 from the equations of all later coordinates.
    #[inline(always)]
    fn eliminate<C: CompiledCounts>(&mut self, block: &Block<R>, k: usize) {
        let Self { size, angles, matrix, with, right } = self;
        // Numbers that stand alone are computed in whole registers, with zeros where nothing is to be eliminated.
        let whole = const { R::PLAIN && !C::KNOWN };
        let count = in_registers::<R, C>(*size, K);
        let later = if whole { 0..count } else { k + 2..*size };
        // M_ik and M_i,k+1, and their products with the block's inverse.
        let (mut one, mut two, mut p, mut q) = ([R::ZERO; K], [R::ZERO; K], [R::ZERO; K], [R::ZERO; K]);
        unroll!(C::KNOWN, i in k + 2..*size, C::MODES => {
            (one[i], two[i]) = (matrix[i][k], matrix[i][k + 1]);
        });
        unroll!(C::KNOWN, i in later.clone(), C::MODES => {
            let [first, second] = block.inverse([one[i], two[i]]);
            (p[i], q[i]) = (-first, -second);
        });
        unroll!(C::KNOWN, i in k + 2..*size, C::MODES => {
            unroll!(C::KNOWN, j in if whole { 0..count } else { k + 2..i + 1 }, C::MODES => {
                matrix[i][j] = add_product([p[i], q[i]], [one[j], two[j]], matrix[i][j]);
            });
        });
        unroll!(C::KNOWN, angle < 3 => {
            if angles[angle] {
                let own = [with[angle][k], with[angle][k + 1]];
                unroll!(C::KNOWN, i in later.clone(), C::MODES => {
                    with[angle][i] = add_product([p[i], q[i]], own, with[angle][i]);
                });
            }
        });
        let own = [right[k], right[k + 1]];
        unroll!(C::KNOWN, i in later, C::MODES => {
            right[i] = add_product([p[i], q[i]], own, right[i]);
        });
    }

    /// The block of coordinates `k` and `k` + 1.
    #[inline(always)]
    fn block(&self, k: usize) -> Block<R> {
        let (a, b, d) = (self.matrix[k][k], self.matrix[k + 1][k], self.matrix[k + 1][k + 1]);
        Block { a, b, d, per: a.multiply_add(d, -(b * b)).recip() }
    }

    /// The coordinate `k` without partner, paired with one that is decoupled.
    #[inline(always)]
    fn single(&self, k: usize) -> Block<R> {
        let a = self.matrix[k][k];
        Block { a, b: R::ZERO, d: R::ONE, per: a.recip() }
    }

    /// The accelerations [m/s²] of the modal coordinates, given those of the angles [rad/s²] and the inverse
    /// determinants that [`condense`](Self::condense) returned.
    #[inline(always)]
    pub(super) fn accelerations<C: CompiledCounts>(&self, per: &[R; K], angles: [R; 3]) -> [R; K] {
        let (size, mut found) = (self.size, self.right);
        let modes = in_registers::<R, C>(size, K);
        unroll!(C::KNOWN, angle < 3 => {
            if self.angles[angle] {
                unroll!(C::KNOWN, i < modes, C::MODES => {
                    found[i] = (-self.with[angle][i]).multiply_add(angles[angle], found[i]);
                });
            }
        });
        if !size.is_multiple_of(2) {
            let last = size - 1;
            found[last] = found[last] * per[last / 2];
            self.substitute::<C>(last, [found[last], R::ZERO], &mut found);
        }
        unroll!(C::KNOWN, done < size / 2, C::MODES.div_ceil(2) => {
            let half = size / 2 - 1 - done;
            let k = 2 * half;
            let (a, b, d) = (self.matrix[k][k], self.matrix[k + 1][k], self.matrix[k + 1][k + 1]);
            let [one, two] = Block { a, b, d, per: per[half] }.inverse([found[k], found[k + 1]]);
            (found[k], found[k + 1]) = (one, two);
            self.substitute::<C>(k, [one, two], &mut found);
        });
        found
    }

    /// Moves the known coordinates `k` and `k` + 1 to the right-hand sides of all earlier ones.
    #[inline(always)]
    fn substitute<C: CompiledCounts>(&self, k: usize, [one, two]: [R; 2], found: &mut [R; K]) {
        let (first, second) = (&self.matrix[k], &self.matrix[(k + 1).min(K - 1)]);
        unroll!(C::KNOWN, i < k, C::MODES => {
            found[i] = add_product([-first[i], -second[i]], [one, two], found[i]);
        });
    }
}

impl<R: Real> Equations<R> {
    /// Subtracts the contribution of an eliminated block of modal coordinates. `with` are the block's couplings with the
    /// three angles, of which `angles` exist, and `right` its right-hand sides.
    #[inline(always)]
    fn reduce(&mut self, angles: [bool; 3], block: &Block<R>, with: [[R; 2]; 3], right: [R; 2]) {
        let Self { m, q1, q2, q3, .. } = self;
        let [crank, rod, slider] = with;
        let negative = |pair: [R; 2]| {
            let [one, two] = block.inverse(pair);
            [-one, -two]
        };
        if angles[CRANK] {
            let own = negative(crank);
            m.d1 = add_product(own, crank, m.d1);
            *q1 = add_product(own, right, *q1);
            if angles[ROD] {
                m.m12 = add_product(own, rod, m.m12);
            }
            if angles[SLIDER] {
                m.m13 = add_product(own, slider, m.m13);
            }
        }
        if angles[ROD] {
            let own = negative(rod);
            m.d2 = add_product(own, rod, m.d2);
            *q2 = add_product(own, right, *q2);
            if angles[SLIDER] {
                m.m23 = add_product(own, slider, m.m23);
            }
        }
        if angles[SLIDER] {
            let own = negative(slider);
            m.d3 = add_product(own, slider, m.d3);
            *q3 = add_product(own, right, *q3);
        }
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
        let (mut matrix, with) = ([[0.0; ROOM]; ROOM], [[0.0; ROOM]; 3]);
        let mut modal = ModalEquations { size, angles: [true; 3], matrix: &mut matrix, with, right: [0.0; ROOM] };
        for i in 0..size {
            for j in 0..=i {
                modal.matrix[i][j] = element(i, j);
            }
            for k in 0..3 {
                modal.with[k][i] = element(i, size + k);
            }
            modal.right[i] = right(i);
        }
        let of = |i: usize, j: usize| element(size + i, size + j);
        let m = MassMatrix { d1: of(0, 0), d2: of(1, 1), d3: of(2, 2), m12: of(0, 1), m23: of(1, 2), m13: of(0, 2) };
        let [q1, q2, q3] = [0, 1, 2].map(|k| right(size + k));
        let mut angles = Equations { m, q1, q2, q3, h1: Vec2::ZERO, h2: Vec2::ZERO };
        let per = modal.condense::<C>(&mut angles);
        let wanted = [0, 1, 2].map(|k| solution(size + k));
        let [a1, a2, a3] = wanted;
        let Equations { m, q1, q2, q3, .. } = angles;
        let left = [
            q1 - m.d1 * a1 - m.m12 * a2 - m.m13 * a3,
            q2 - m.m12 * a1 - m.d2 * a2 - m.m23 * a3,
            q3 - m.m13 * a1 - m.m23 * a2 - m.d3 * a3,
        ];
        (modal.accelerations::<C>(&per, wanted), left)
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
