//! Inertia of the deformed rod: mass matrix blocks, and the centrifugal and Coriolis terms beside them.

#![allow(clippy::needless_range_loop)] // several arrays are read by the number of one mode

use super::Shape;
use super::modes::{Counts, Modes};
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

/// Moments of a field along x, over the rod's mass.
#[derive(Clone, Copy, Debug)]
pub struct Moments<R, const K: usize, const F: usize> {
    /// [kg] of the field's unit: with 1,
    pub mass: R,
    /// with the functions B, times m,
    pub functions: [R; F],
    /// with the bending modes φ.
    pub bending: [R; K],
}

impl<R: Real, const K: usize, const F: usize> Moments<R, K, F> {
    /// Of nothing.
    pub const NONE: Self = Self { mass: R::ZERO, functions: [R::ZERO; F], bending: [R::ZERO; K] };

    /// Of a field that depends on nothing.
    #[inline(always)]
    fn constant(of: &Moments<f64, K, F>) -> Self {
        Self {
            mass: R::constant(of.mass),
            functions: of.functions.map(R::constant),
            bending: of.bending.map(R::constant),
        }
    }

    /// Adds `factor` times a field.
    #[inline(always)]
    fn add<S: Copy>(&mut self, counts: Counts, factor: R, field: &Moments<S, K, F>)
    where
        R: Mul<S, Output = R>,
    {
        self.mass += factor * field.mass;
        for k in 0..counts.functions() {
            self.functions[k] += factor * field.functions[k];
        }
        for i in 0..counts.bending {
            self.bending[i] += factor * field.bending[i];
        }
    }
}

impl<const K: usize, const F: usize> Modes<K, F> {
    /// The inertia of a shape, with its modal coordinates and their rates, whose frame turns at `speed`
    /// [rad/s].
    #[inline(always)]
    pub(super) fn inertia<R: Real>(
        &self,
        counts: Counts,
        shape: &Shape<R, K, F>,
        eta: &[R],
        rate: &[R],
        speed: R,
    ) -> Inertia<R, K> {
        let Counts { bending: n, axial, shortening } = counts;
        let Shape { xi, xi_rate, xi_bias, .. } = shape;
        let (q, dq) = (&eta[..n], &rate[..n]);
        // Of ∂x/∂q_i, x, its rate and its bias. Foreshortenings are of second degree: their part of x is half
        // of Σ q_i·∂x/∂q_i.
        let mut slope = [Moments::NONE; K];
        let mut field = Moments::constant(&self.moments[0]);
        let (mut moving, mut bias) = (Moments::NONE, Moments::NONE);
        for j in 0..axial {
            field.add(counts, xi[1 + j], &self.moments[1 + j]);
            moving.add(counts, xi_rate[1 + j], &self.moments[1 + j]);
        }
        for i in 0..shortening {
            for j in 0..n {
                slope[i].add(counts, q[j] * -2.0, &self.moments[counts.pair(i, j)]);
            }
            field.add(counts, q[i] * 0.5, &slope[i]);
            moving.add(counts, dq[i], &slope[i]);
            for j in 0..=i {
                let place = counts.pair(i, j);
                bias.add(counts, xi_bias[place], &self.moments[place]);
            }
        }
        let (square, twice) = (speed * speed, speed * 2.0);
        let mut inertia = Inertia {
            first: Vec2::new(field.mass, R::ZERO),
            about_origin: R::ZERO,
            first_slope: [Vec2::ZERO; K],
            turning: [R::ZERO; K],
            modal: [[R::ZERO; K]; K],
            force: Vec2::ZERO,
            couple: R::ZERO,
            modal_force: [R::ZERO; K],
        };
        let mut first_rate = Vec2::new(moving.mass, R::ZERO);
        let mut spreading = R::ZERO;
        for k in 0..counts.functions() {
            inertia.about_origin += xi[k] * field.functions[k];
            spreading += xi_rate[k] * field.functions[k];
        }
        for i in 0..n {
            let (m, moment) = (self.modal_mass[i], self.moment[i]);
            inertia.first.y += q[i] * moment;
            first_rate.y += dq[i] * moment;
            inertia.about_origin += q[i] * m * q[i];
            spreading += q[i] * m * dq[i];
            inertia.couple -= q[i] * bias.bending[i];
            inertia.first_slope[i] = Vec2::new(slope[i].mass, R::constant(moment));
            inertia.turning[i] = field.bending[i];
            inertia.modal_force[i] = twice * moving.bending[i] - square * m * q[i];
            inertia.modal[i][i] = R::constant(m);
        }
        // What the accelerations of x at q̈ = 0 ask of each function.
        let asked = |place: usize| bias.functions[place] - square * field.functions[place];
        for i in 0..shortening {
            for k in 0..n {
                let (place, with) = (counts.pair(i, k), q[k] * -2.0);
                inertia.turning[i] -= slope[i].bending[k] * q[k];
                inertia.modal_force[i] += with * asked(place) - twice * slope[i].bending[k] * dq[k];
                for j in 0..=i {
                    inertia.modal[i][j] += with * slope[j].functions[place];
                }
            }
        }
        for j in 0..axial {
            let (a, place) = (n + j, 1 + j);
            let Moments { mass, functions, bending } = &self.moments[place];
            inertia.first_slope[a] = Vec2::constant(Vec2::new(*mass, 0.0));
            inertia.modal_force[a] = asked(place);
            for i in 0..n {
                inertia.turning[a] -= q[i] * bending[i];
                inertia.modal_force[a] -= twice * bending[i] * dq[i];
                inertia.modal[a][i] = slope[i].functions[place];
            }
            for i in 0..=j {
                inertia.modal[a][n + i] = R::constant(functions[1 + i]);
            }
        }
        inertia.couple += twice * spreading;
        inertia.force = Vec2::new(bias.mass, R::ZERO) - square * inertia.first + twice * perp(first_rate);
        inertia
    }
}
