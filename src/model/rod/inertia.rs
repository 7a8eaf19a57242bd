//! Inertia of the deformed rod: mass matrix blocks, and the centrifugal and Coriolis terms beside them, all of them
//! sums over the rod's tables.

#![allow(clippy::needless_range_loop)] // several arrays are read by the number of one mode

use super::Shape;
use super::modes::{Counts, Modes};
use crate::math::{Real, each};
use crate::model::plane::{Vec2, perp};
use std::ops::Range;

/// Inertia of the rod in its own frame, for the acceleration of its origin, its angle and η, and what
/// its motion asks for besides.
#[derive(Clone, Copy, Debug)]
pub struct Inertia<R, const K: usize> {
    /// [kg·m] First moment D.
    pub first: Vec2<R>,
    /// [kg·m²] About the origin.
    pub about_origin: R,
    /// [kg] ∂D/∂η.
    pub first_slope: [Vec2<R>; K],
    /// [kg·m] Of the angle with η.
    pub turning: [R; K],
    /// [kg] Of η with η; the lower triangle.
    pub modal: [[R; K]; K],
    /// [N] What centrifugal and Coriolis accelerations ask for: force along the frame's axes,
    pub force: Vec2<R>,
    /// [N·m] moment about the origin,
    pub couple: R,
    /// [N] and force on η.
    pub modal_force: [R; K],
}

/// So many columns are summed at a time: as many as stay in registers.
pub const LANES: usize = 4;

impl<const K: usize, const F: usize> Modes<K, F> {
    /// Σ factor·row over `rows` of a table, of which there are so many columns.
    #[inline(always)]
    fn sum<R: Real, const FEW: bool>(
        table: &[[f64; F]],
        rows: Range<usize>,
        factors: &[R],
        columns: usize,
        start: [R; F],
    ) -> [R; F] {
        let mut sums = start;
        for first in (0..columns).step_by(LANES) {
            let lanes = first..first + LANES;
            let mut sum = [R::ZERO; LANES];
            sum.copy_from_slice(&sums[lanes.clone()]);
            each!(FEW, row < rows.end => {
                if row >= rows.start {
                    for (sum, &number) in sum.iter_mut().zip(&table[row][lanes.clone()]) {
                        *sum = factors[row].times_plus(number, *sum);
                    }
                }
            });
            sums[lanes].copy_from_slice(&sum);
        }
        sums
    }

    /// The inertia of a shape, with its modal coordinates and their rates, whose frame turns at `speed`
    /// [rad/s].
    #[inline(always)]
    pub(super) fn inertia<R: Real, const FEW: bool>(
        &self,
        counts: Counts,
        shape: &Shape<R, K, F>,
        eta: &[R],
        rate: &[R],
        speed: R,
    ) -> Inertia<R, K> {
        const { assert!(F.is_multiple_of(LANES) && F > K) };
        let Counts { bending: n, axial, shortening } = counts;
        let (q, dq) = (&eta[..n], &rate[..n]);
        let Shape { xi, xi_rate, xi_bias, .. } = shape;
        let (functions, pairs, none) = (counts.functions(), 1 + axial..counts.functions(), [R::ZERO; F]);
        // Numbers of columns are not those of `counts`: sums of a constant number of rounds would be mixed up.
        let (every, modes_and_1) = (self.counts.functions(), self.counts.bending + 1);
        let place = Self::sum::<R, FEW>(&self.tables.placing, 0..functions, xi, modes_and_1, none);
        let bias = Self::sum::<R, FEW>(&self.tables.with_modes, pairs.clone(), xi_bias, modes_and_1, none);
        let mut moving = Self::sum::<R, FEW>(&self.tables.moving, 1..functions, xi_rate, modes_and_1, none);
        let mut twist = none;
        each!(FEW, i < shortening => {
            each!(FEW, j < i => {
                twist[i * (i - 1) / 2 + j] = q[j].times_plus(dq[i], -(q[i] * dq[j]));
            });
        });
        let twists = counts.pairs() - shortening;
        moving = Self::sum::<R, FEW>(&self.tables.twisting, 0..twists, &twist, modes_and_1, moving);
        let spread = Self::sum::<R, FEW>(&self.tables.second, 0..functions, xi, every, none);
        let mut asked = Self::sum::<R, FEW>(&self.tables.second, pairs.clone(), xi_bias, every, none);
        let products = Self::sum::<R, FEW>(&self.tables.products, pairs, xi, self.counts.pairs(), none);
        let first_slope = Self::sum::<R, FEW>(&self.tables.shifting, 0..shortening, q, modes_and_1, none);

        let (square, twice) = (speed * speed, speed * 2.0);
        let mut inertia = Inertia {
            first: Vec2::new(place[n], R::ZERO),
            about_origin: R::ZERO,
            first_slope: [Vec2::ZERO; K],
            turning: [R::ZERO; K],
            modal: [[R::ZERO; K]; K],
            force: Vec2::ZERO,
            couple: R::ZERO,
            modal_force: [R::ZERO; K],
        };
        let mut first_rate = Vec2::new(moving[n], R::ZERO);
        let mut spreading = R::ZERO;
        for k in 0..functions {
            inertia.about_origin = xi[k].times_plus(spread[k], inertia.about_origin);
            spreading = xi_rate[k].times_plus(spread[k], spreading);
            // What the accelerations of x at q̈ = 0 ask of each function.
            asked[k] = (-square).times_plus(spread[k], asked[k]);
        }
        for i in 0..n {
            let (m, moment) = (self.modal_mass[i], self.moment[i]);
            let weighted = q[i] * m;
            inertia.first.y = q[i].times_plus(moment, inertia.first.y);
            first_rate.y = dq[i].times_plus(moment, first_rate.y);
            inertia.about_origin = weighted.times_plus(q[i], inertia.about_origin);
            spreading = weighted.times_plus(dq[i], spreading);
            inertia.couple = (-q[i]).times_plus(bias[i], inertia.couple);
            inertia.first_slope[i] = Vec2::new(first_slope[i], R::constant(moment));
            inertia.turning[i] = place[i];
            inertia.modal_force[i] = twice.times_plus(moving[i], -(square * weighted));
            inertia.modal[i][i] = R::constant(m);
        }
        each!(FEW, i < shortening => {
            each!(FEW, k < n => {
                inertia.modal_force[i] = (q[k] * -2.0).times_plus(asked[counts.pair(i, k)], inertia.modal_force[i]);
            });
            each!(FEW, j < i + 1 => {
                inertia.modal[i][j] += products[counts.pair(i, j) - 1 - axial];
            });
        });
        for j in 0..axial {
            let (a, function) = (n + j, 1 + j);
            let with_modes = &self.tables.with_modes[function];
            inertia.first_slope[a] = Vec2::constant(Vec2::new(with_modes[n], 0.0));
            inertia.modal_force[a] = asked[function];
            for i in 0..n {
                inertia.turning[a] = (-q[i]).times_plus(with_modes[i], inertia.turning[a]);
                inertia.modal_force[a] = (-(twice * with_modes[i])).times_plus(dq[i], inertia.modal_force[a]);
            }
            each!(FEW, i < shortening => {
                each!(FEW, k < n => {
                    let number = self.tables.second[counts.pair(i, k)][function];
                    inertia.modal[a][i] = (q[k] * -2.0).times_plus(number, inertia.modal[a][i]);
                });
            });
            for i in 0..=j {
                inertia.modal[a][n + i] = R::constant(self.tables.second[function][1 + i]);
            }
        }
        inertia.couple += twice * spreading;
        inertia.force = Vec2::new(bias[n], R::ZERO) - square * inertia.first + twice * perp(first_rate);
        inertia
    }
}
