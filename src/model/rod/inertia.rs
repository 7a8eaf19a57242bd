//! Inertia of the deformed rod: mass matrix blocks, and the centrifugal and Coriolis terms beside them.

#![allow(clippy::needless_range_loop)] // several arrays are read by the number of one mode

use super::{Rod, Shape};
use crate::math::Real;
use crate::model::plane::{Vec2, perp};
use std::ops::Mul;

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

/// The rod's integrals in arrays for the inner loop: room for `K` modes and `F` functions, zero where
/// there is none, so that sums over functions have a length known to the compiler.
#[derive(Clone, Debug)]
pub struct Integrals<const K: usize, const F: usize> {
    bending: usize,
    axial: usize,
    /// How many bending modes foreshorten: all, or none without geometric stiffness.
    shortening: usize,
    /// Where the foreshortening of two bending modes stands among the functions.
    pair: [[usize; K]; K],
    /// [kg·m] ∫B dm.
    first: [f64; F],
    /// [kg·m²] ∫B·Bᵀ dm.
    second: [[f64; F]; F],
    /// [kg·m] ∫φ·Bᵀ dm.
    coupling: [[f64; F]; K],
    /// [kg] ∫φ dm.
    moment: [f64; K],
    /// [kg] ∫φ² dm.
    modal_mass: [f64; K],
}

impl<const K: usize, const F: usize> Integrals<K, F> {
    /// Of a rod that has room here.
    pub fn new(rod: &Rod) -> Self {
        let (n, count) = (rod.bending, rod.first.len());
        let mut integrals = Self {
            bending: n,
            axial: rod.axial,
            shortening: if rod.pairs.is_empty() { 0 } else { n },
            pair: [[0; K]; K],
            first: [0.0; F],
            second: [[0.0; F]; F],
            coupling: [[0.0; F]; K],
            moment: [0.0; K],
            modal_mass: [0.0; K],
        };
        integrals.first[..count].copy_from_slice(&rod.first);
        integrals.moment[..n].copy_from_slice(&rod.moment);
        integrals.modal_mass[..n].copy_from_slice(&rod.modal_mass[..n]);
        for k in 0..count {
            integrals.second[k][..count].copy_from_slice(&rod.second[k * count..][..count]);
            for i in 0..n {
                integrals.coupling[i][k] = rod.coupling[k * n + i];
            }
        }
        for (place, &(i, j)) in rod.pairs.iter().enumerate() {
            integrals.pair[i][j] = 1 + rod.axial + place;
            integrals.pair[j][i] = 1 + rod.axial + place;
        }
        integrals
    }

    /// The inertia of a shape, with its modal coordinates and their rates, whose frame turns at `speed`
    /// [rad/s].
    #[inline(always)]
    pub fn inertia<R: Real>(&self, shape: &Shape<R, K, F>, eta: &[R], rate: &[R], speed: R) -> Inertia<R, K> {
        let Self { bending: n, axial, shortening, .. } = *self;
        let Shape { xi, xi_rate, xi_bias, .. } = shape;
        let (q, dq) = (&eta[..n], &rate[..n]);
        // S·∂ξ/∂q_i, S·ξ, S·ξ_bias over the functions, where S = ∫B·Bᵀ dm. Foreshortenings are of second
        // degree: their part of ξ is half of Σ q_i·∂ξ/∂q_i.
        let mut moved = [[R::ZERO; F]; K];
        let mut of_xi = self.second[0].map(R::constant);
        let mut of_bias = [R::ZERO; F];
        for j in 0..axial {
            add(&mut of_xi, xi[1 + j], &self.second[1 + j]);
        }
        for i in 0..shortening {
            for j in 0..n {
                add(&mut moved[i], q[j] * -2.0, &self.second[self.pair[i][j]]);
            }
            add(&mut of_xi, q[i] * 0.5, &moved[i]);
            for j in 0..=i {
                let place = self.pair[i][j];
                add(&mut of_bias, xi_bias[place], &self.second[place]);
            }
        }
        // Cᵀ·q, Cᵀ·q̇ over the functions, where C = ∫φ·Bᵀ dm.
        let (mut across, mut across_rate) = ([R::ZERO; F], [R::ZERO; F]);
        for i in 0..n {
            add(&mut across, q[i], &self.coupling[i]);
            add(&mut across_rate, dq[i], &self.coupling[i]);
        }
        let square = speed * speed;
        // What accelerations at ξ̈ = ξ_bias, q̈ = 0 ask of each function.
        let asked: [R; F] = std::array::from_fn(|k| of_bias[k] - square * of_xi[k] - speed * 2.0 * across_rate[k]);

        let mut inertia = Inertia {
            first: Vec2::new(dot(xi, &self.first), R::ZERO),
            about_origin: dot(&of_xi, xi),
            first_slope: [Vec2::ZERO; K],
            turning: [R::ZERO; K],
            modal: [[R::ZERO; K]; K],
            force: Vec2::ZERO,
            couple: speed * 2.0 * dot(&of_xi, xi_rate) - dot(&across, xi_bias),
            modal_force: [R::ZERO; K],
        };
        let mut first_rate = Vec2::new(dot(xi_rate, &self.first), R::ZERO);
        for i in 0..n {
            let (m, moment) = (self.modal_mass[i], self.moment[i]);
            inertia.first.y += q[i] * moment;
            first_rate.y += dq[i] * moment;
            inertia.about_origin += q[i] * m * q[i];
            inertia.couple += speed * 2.0 * m * q[i] * dq[i];
            inertia.first_slope[i] = Vec2::new(R::ZERO, R::constant(moment));
            inertia.turning[i] = dot(xi, &self.coupling[i]);
            inertia.modal_force[i] = speed * 2.0 * dot(xi_rate, &self.coupling[i]) - square * m * q[i];
            inertia.modal[i][i] = R::constant(m);
        }
        for i in 0..shortening {
            for k in 0..n {
                let (place, slope) = (self.pair[i][k], q[k] * -2.0);
                inertia.first_slope[i].x += slope * self.first[place];
                inertia.turning[i] -= slope * across[place];
                inertia.modal_force[i] += slope * asked[place];
                for j in 0..=i {
                    inertia.modal[i][j] += slope * moved[j][place];
                }
            }
        }
        for j in 0..axial {
            let (a, place) = (n + j, 1 + j);
            inertia.first_slope[a] = Vec2::constant(Vec2::new(self.first[place], 0.0));
            inertia.turning[a] = -across[place];
            inertia.modal_force[a] = asked[place];
            for i in 0..shortening {
                inertia.modal[a][i] = moved[i][place];
            }
            for i in 0..=j {
                inertia.modal[a][n + i] = R::constant(self.second[place][1 + i]);
            }
        }
        inertia.force =
            Vec2::new(dot(xi_bias, &self.first), R::ZERO) - square * inertia.first + speed * 2.0 * perp(first_rate);
        inertia
    }
}

#[inline(always)]
fn add<R: Real + Mul<S, Output = R>, S: Copy, const F: usize>(sum: &mut [R; F], factor: R, column: &[S; F]) {
    for (sum, element) in sum.iter_mut().zip(column) {
        *sum += factor * *element;
    }
}

#[inline(always)]
fn dot<R: Real + Mul<S, Output = R>, S: Copy, const F: usize>(a: &[R; F], b: &[S; F]) -> R {
    a.iter().zip(b).fold(-R::ZERO, |sum, (a, b)| sum + *a * *b)
}
