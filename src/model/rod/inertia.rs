//! Inertia of the deformed rod: mass matrix blocks, and the centrifugal and Coriolis terms beside them.

#![allow(clippy::needless_range_loop)] // several arrays are read by the number of one mode

use super::{Rod, Shape};
use crate::model::plane::{Vec2, perp};

/// Inertia of the rod in its own frame, for the acceleration of its origin, its angle and η, and what
/// its motion asks for besides.
#[derive(Clone, Copy, Debug)]
pub struct Inertia<const K: usize> {
    /// [kg·m] First moment D.
    pub first: Vec2,
    /// [kg·m²] About the origin.
    pub about_origin: f64,
    /// [kg] ∂D/∂η.
    pub first_slope: [Vec2; K],
    /// [kg·m] Of the angle with η.
    pub turning: [f64; K],
    /// [kg] Of η with η; the lower triangle.
    pub modal: [[f64; K]; K],
    /// [N] What centrifugal and Coriolis accelerations ask for: force along the frame's axes,
    pub force: Vec2,
    /// [N·m] moment about the origin,
    pub couple: f64,
    /// [N] and force on η.
    pub modal_force: [f64; K],
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
    pub fn inertia(&self, shape: &Shape<K, F>, eta: &[f64], rate: &[f64], speed: f64) -> Inertia<K> {
        let Self { bending: n, axial, shortening, .. } = *self;
        let Shape { xi, xi_rate, xi_bias, .. } = shape;
        let (q, dq) = (&eta[..n], &rate[..n]);
        // S·∂ξ/∂q_i, S·ξ, S·ξ_bias over the functions, where S = ∫B·Bᵀ dm. Foreshortenings are of second
        // degree: their part of ξ is half of Σ q_i·∂ξ/∂q_i.
        let mut moved = [[0.0; F]; K];
        let mut of_xi = self.second[0];
        let mut of_bias = [0.0; F];
        for j in 0..axial {
            add(&mut of_xi, xi[1 + j], &self.second[1 + j]);
        }
        for i in 0..shortening {
            for j in 0..n {
                add(&mut moved[i], -2.0 * q[j], &self.second[self.pair[i][j]]);
            }
            add(&mut of_xi, 0.5 * q[i], &moved[i]);
            for j in 0..=i {
                let place = self.pair[i][j];
                add(&mut of_bias, xi_bias[place], &self.second[place]);
            }
        }
        // Cᵀ·q, Cᵀ·q̇ over the functions, where C = ∫φ·Bᵀ dm.
        let (mut across, mut across_rate) = ([0.0; F], [0.0; F]);
        for i in 0..n {
            add(&mut across, q[i], &self.coupling[i]);
            add(&mut across_rate, dq[i], &self.coupling[i]);
        }
        let square = speed * speed;
        // What accelerations at ξ̈ = ξ_bias, q̈ = 0 ask of each function.
        let asked: [f64; F] = std::array::from_fn(|k| of_bias[k] - square * of_xi[k] - 2.0 * speed * across_rate[k]);

        let mut inertia = Inertia {
            first: Vec2::new(dot(&self.first, xi), 0.0),
            about_origin: dot(&of_xi, xi),
            first_slope: [Vec2::zeros(); K],
            turning: [0.0; K],
            modal: [[0.0; K]; K],
            force: Vec2::zeros(),
            couple: 2.0 * speed * dot(&of_xi, xi_rate) - dot(&across, xi_bias),
            modal_force: [0.0; K],
        };
        let mut first_rate = Vec2::new(dot(&self.first, xi_rate), 0.0);
        for i in 0..n {
            let (m, moment) = (self.modal_mass[i], self.moment[i]);
            inertia.first.y += moment * q[i];
            first_rate.y += moment * dq[i];
            inertia.about_origin += m * q[i] * q[i];
            inertia.couple += 2.0 * speed * m * q[i] * dq[i];
            inertia.first_slope[i] = Vec2::new(0.0, moment);
            inertia.turning[i] = dot(&self.coupling[i], xi);
            inertia.modal_force[i] = 2.0 * speed * dot(&self.coupling[i], xi_rate) - square * m * q[i];
            inertia.modal[i][i] = m;
        }
        for i in 0..shortening {
            for k in 0..n {
                let (place, slope) = (self.pair[i][k], -2.0 * q[k]);
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
            inertia.first_slope[a] = Vec2::new(self.first[place], 0.0);
            inertia.turning[a] = -across[place];
            inertia.modal_force[a] = asked[place];
            for i in 0..shortening {
                inertia.modal[a][i] = moved[i][place];
            }
            for i in 0..=j {
                inertia.modal[a][n + i] = self.second[place][1 + i];
            }
        }
        inertia.force =
            Vec2::new(dot(&self.first, xi_bias), 0.0) - square * inertia.first + 2.0 * speed * perp(first_rate);
        inertia
    }
}

#[inline(always)]
fn add<const F: usize>(sum: &mut [f64; F], factor: f64, column: &[f64; F]) {
    for (sum, element) in sum.iter_mut().zip(column) {
        *sum += factor * element;
    }
}

#[inline(always)]
fn dot<const F: usize>(a: &[f64; F], b: &[f64; F]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
