//! Inertia of the deformed rod: the blocks of its mass matrix and its centrifugal and Coriolis terms, as sums over the
//! rod's tables. Frame, symbols, formulas and a drawing are in [the module above](super).

#![allow(clippy::needless_range_loop)] // several arrays are read by the number of one mode

use super::counts::{CompiledCounts, Counts};
use super::modes::Arrays;
use super::shape::Shape;
use super::sums::{FunctionsToFunctions, FunctionsToModes, ModesToModes, add_rows};
use super::tables::TableView;
use crate::math::{LANES, Real, unroll, unroll_four};
use crate::model::plane::{Vec2, perp};

/// Inertia of the rod in its own frame, for the accelerations of the frame's origin, of its angle and of the modal
/// coordinates η, and the forces that the motion requires at zero accelerations.
#[derive(Clone, Debug)]
pub struct Inertia<R, const K: usize> {
    /// [kg·m] First moment D = ∫ρ dm about the frame's origin.
    pub first: Vec2<R>,
    /// [kg·m²] Moment of inertia J = ∫|ρ|² dm about the frame's origin.
    pub about_origin: R,
    /// [kg] ∂D/∂η.
    pub first_slope: Vec2<[R; K]>,
    /// [kg·m] T_a: coupling of the frame's angle with η.
    pub with_angle: [R; K],
    /// [kg] m_ab: coupling of η with η; the lower triangle. What solves the equations of motion overwrites it.
    pub modal: [[R; K]; K],
    /// [N] Force ∫a dm that centrifugal and Coriolis accelerations require, in the frame's axes.
    pub force: Vec2<R>,
    /// [N·m] Moment ∫ρ × a dm that centrifugal and Coriolis accelerations require, about the origin.
    pub couple: R,
    /// [N] Force ∫∂ρ/∂η · a dm that centrifugal and Coriolis accelerations require of η.
    pub modal_force: [R; K],
}

impl<R: Real, const K: usize> Default for Inertia<R, K> {
    #[inline(always)]
    fn default() -> Self {
        Self {
            first: Vec2::ZERO,
            about_origin: R::ZERO,
            first_slope: Vec2::new([R::ZERO; K], [R::ZERO; K]),
            with_angle: [R::ZERO; K],
            modal: [[R::ZERO; K]; K],
            force: Vec2::ZERO,
            couple: R::ZERO,
            modal_force: [R::ZERO; K],
        }
    }
}

impl<R: Real, const K: usize> Inertia<R, K> {
    /// [J] η̇ᵀ·m·η̇/2, the kinetic energy of the modal coordinates alone.
    #[inline(always)]
    pub fn modal_energy(&self, rate: &[R]) -> R {
        let mut twice = R::ZERO;
        for (a, &rate_a) in rate.iter().enumerate() {
            let with = self.modal[a].iter().zip(rate).take(a);
            let row = with.fold(R::ZERO, |sum, (m, rate)| sum + *m * *rate);
            twice += rate_a * (row * 2.0 + self.modal[a][a] * rate_a);
        }
        twice * 0.5
    }
}

impl<const K: usize, const F: usize> Arrays<'_, K, F> {
    /// Writes the inertia of a `shape` with modal coordinates `eta` [m] and their rates `rate` [m/s], in a frame that
    /// rotates at `speed` [rad/s]; `inertia` must be zero. The lists of sums exist one after the other and share memory.
    #[inline(always)]
    pub fn inertia<R: Real, C: CompiledCounts>(
        &self,
        shape: &Shape<R, K, F>,
        eta: &[R],
        rate: &[R],
        speed: R,
        inertia: &mut Inertia<R, K>,
    ) {
        const { assert!(F.is_multiple_of(LANES) && F > K) };
        let counts = C::COUNTS.unwrap_or(self.counts);
        let Counts { bending: n, axial, shortening } = counts;
        let (q, dq) = (&eta[..n], &rate[..n]);
        let Shape { xi, xi_rate, xi_bias, .. } = shape;
        let (functions, pairs) = (counts.functions(), 1 + axial..counts.functions());
        let zeros = || [R::ZERO; F];
        let (square, twice) = (speed * speed, speed * 2.0);
        let TableView { second, with_modes, placing, moving, twisting, products, shifting, .. } = self.tables;
        let columns = n + 1;
        {
            let mut place = zeros();
            add_rows::<R, FunctionsToModes<C>, _, _>([&mut place], placing, 0..functions, [xi], columns);
            inertia.first.x = place[n];
            unroll_four!(C::KNOWN, i < n, C::MODES => {
                inertia.with_angle[i] = place[i];
            });
        }
        {
            let mut bias = zeros();
            add_rows::<R, FunctionsToModes<C>, _, _>([&mut bias], with_modes, pairs.clone(), [xi_bias], columns);
            inertia.force.x = bias[n];
            unroll_four!(C::KNOWN, i < n, C::MODES => {
                inertia.couple = (-q[i]).multiply_add(bias[i], inertia.couple);
            });
        }
        let mut first_rate = Vec2::<R>::ZERO;
        {
            let (mut twist, mut moved) = (zeros(), zeros());
            unroll_four!(C::KNOWN, i < shortening, C::MODES => {
                let first = counts.twists(i);
                unroll_four!(C::KNOWN, j < i, C::MODES => {
                    twist[first + j] = q[j].multiply_add(dq[i], -(q[i] * dq[j]));
                });
            });
            add_rows::<R, FunctionsToModes<C>, _, _>([&mut moved], moving, 1..functions, [xi_rate], columns);
            add_rows::<R, FunctionsToModes<C>, _, _>(
                [&mut moved],
                twisting,
                0..counts.twists(shortening),
                [&twist],
                columns,
            );
            first_rate.x = moved[n];
            unroll_four!(C::KNOWN, i < n, C::MODES => {
                inertia.modal_force[i] = twice.multiply_add(moved[i], -(square * (q[i] * self.modal_mass[i])));
            });
        }
        {
            let mut first_slope = zeros();
            add_rows::<R, ModesToModes<C>, _, _>([&mut first_slope], shifting, 0..shortening, [q], columns);
            unroll_four!(C::KNOWN, i < n, C::MODES => {
                inertia.first_slope.x[i] = first_slope[i];
            });
        }
        let mut spreading = R::ZERO;
        let mut asked = zeros();
        {
            let mut spread = zeros();
            add_rows::<R, FunctionsToFunctions<C>, _, _>([&mut spread], second, 0..functions, [xi], functions);
            add_rows::<R, FunctionsToFunctions<C>, _, _>([&mut asked], second, pairs.clone(), [xi_bias], functions);
            // The acceleration along x at q̈ = 0 has a centrifugal part.
            unroll!(C::KNOWN, k in 1..functions, C::FUNCTIONS => {
                asked[k] = (-square).multiply_add(spread[k], asked[k]);
            });
            unroll!(C::KNOWN, k < functions, C::FUNCTIONS => {
                inertia.about_origin = xi[k].multiply_add(spread[k], inertia.about_origin);
                spreading = xi_rate[k].multiply_add(spread[k], spreading);
            });
        }
        unroll_four!(C::KNOWN, i < n, C::MODES => {
            let (m, moment) = (self.modal_mass[i], self.moment[i]);
            let weighted = q[i] * m;
            inertia.first.y = q[i].multiply_add(moment, inertia.first.y);
            first_rate.y = dq[i].multiply_add(moment, first_rate.y);
            inertia.about_origin = weighted.multiply_add(q[i], inertia.about_origin);
            spreading = weighted.multiply_add(dq[i], spreading);
            inertia.first_slope.y[i] = R::constant(moment);
            inertia.modal[i][i] = R::constant(m);
        });
        unroll_four!(C::KNOWN, j < axial, C::MODES => {
            let (a, function) = (n + j, 1 + j);
            inertia.first_slope.x[a] = R::constant(with_modes[function][n]);
            inertia.modal_force[a] = asked[function];
            unroll_four!(C::KNOWN, i < n, C::MODES => {
                let number = with_modes[function][i];
                inertia.with_angle[a] = (-q[i]).multiply_add(number, inertia.with_angle[a]);
                inertia.modal_force[a] = (-(twice * number)).multiply_add(dq[i], inertia.modal_force[a]);
            });
            add_rows::<R, ModesToModes<C>, _, _>(
                [&mut inertia.modal[a]],
                self.tables.stretching(j),
                0..shortening,
                [q],
                n,
            );
            unroll_four!(C::KNOWN, i < j + 1, C::MODES => {
                inertia.modal[a][n + i] = R::constant(second[function][1 + i]);
            });
        });
        let mut product = zeros();
        add_rows::<R, FunctionsToFunctions<C>, _, _>([&mut product], products, pairs, [xi], counts.pairs());
        unroll_four!(C::KNOWN, i < shortening, C::MODES => {
            let first = counts.pair(i, i);
            unroll_four!(C::KNOWN, further < shortening - i, C::MODES => {
                let (k, place) = (i + further, first + further);
                inertia.modal[k][i] += product[place - 1 - axial];
                // ∂x/∂q_i contains −2·q_k times the foreshortening of i and k.
                inertia.modal_force[i] = (q[k] * -2.0).multiply_add(asked[place], inertia.modal_force[i]);
                if k > i {
                    inertia.modal_force[k] = (q[i] * -2.0).multiply_add(asked[place], inertia.modal_force[k]);
                }
            });
        });
        inertia.couple += twice * spreading;
        inertia.force = inertia.force - square * inertia.first + twice * perp(first_rate);
    }
}
