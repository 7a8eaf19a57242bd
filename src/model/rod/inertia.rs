//! Inertia of the deformed rod: mass matrix blocks, and the centrifugal and Coriolis terms beside them.

use super::{Rod, Shape, dot};
use crate::model::plane::Vec2;

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
    /// [kg] Of η with η.
    pub modal: [[f64; K]; K],
    /// [N] What centrifugal and Coriolis accelerations ask for: force along the frame's axes,
    pub force: Vec2,
    /// [N·m] moment about the origin,
    pub couple: f64,
    /// [N] and force on η.
    pub modal_force: [f64; K],
}

impl Rod {
    /// The inertia of a shape whose frame turns at `speed` [rad/s].
    pub fn inertia<const K: usize, const F: usize>(
        &self,
        shape: &Shape<K, F>,
        eta: &[f64],
        rate: &[f64],
        speed: f64,
    ) -> Inertia<K> {
        let Self { bending: n, axial, .. } = *self;
        let count = self.first.len();
        let (q, dq) = (&eta[..n], &rate[..n]);
        let (xi, xi_bias) = (&shape.xi[..count], &shape.xi_bias[..count]);
        let mut inertia = Inertia {
            first: Vec2::ZERO,
            about_origin: 0.0,
            first_slope: [Vec2::ZERO; K],
            turning: [0.0; K],
            modal: [[0.0; K]; K],
            force: Vec2::ZERO,
            couple: 0.0,
            modal_force: [0.0; K],
        };
        // Rates of ξ, and K·ξ, K·ξ_bias, C·q, C·q̇ over the functions; Cᵀ·ξ, Cᵀ·ξ̇ over the modes.
        let mut dxi = [0.0; F];
        dxi[1..=axial].copy_from_slice(&rate[n..n + axial]);
        for (k, &(i, j)) in self.pairs.iter().enumerate() {
            let twice = if i == j { 1.0 } else { 2.0 };
            dxi[1 + axial + k] = -twice * (q[i] * dq[j] + dq[i] * q[j]);
        }
        let (mut kxi, mut kbias) = ([0.0; F], [0.0; F]);
        let (mut cq, mut cdq) = ([0.0; F], [0.0; F]);
        let (mut ctxi, mut ctdxi) = ([0.0; K], [0.0; K]);
        for k in 0..count {
            let row = &self.second[k * count..(k + 1) * count];
            kxi[k] = dot(row, xi);
            kbias[k] = if self.pairs.is_empty() { 0.0 } else { dot(&row[1 + axial..], &xi_bias[1 + axial..]) };
            let row = &self.coupling[k * n..(k + 1) * n];
            (cq[k], cdq[k]) = (dot(row, q), dot(row, dq));
            for (i, c) in row.iter().enumerate() {
                ctxi[i] += c * xi[k];
                ctdxi[i] += c * dxi[k];
            }
        }
        let dxi = &dxi[..count];
        let modal = &self.modal_mass[..n];
        let along = dot(&self.first, xi);
        let across = dot(&self.moment, q);
        let spread: f64 = modal.iter().zip(q).map(|(m, q)| m * q * q).sum();
        let opening: f64 = modal.iter().zip(q).zip(dq).map(|((m, q), dq)| m * q * dq).sum();
        inertia.first = Vec2::new(along, across);
        inertia.about_origin = dot(&kxi[..count], xi) + spread;
        let first_rate = Vec2::new(dot(&self.first, dxi), dot(&self.moment, dq));
        let square = speed * speed;
        inertia.force = -square * inertia.first
            + 2.0 * speed * Vec2::new(-first_rate.y, first_rate.x)
            + Vec2::new(dot(&self.first, xi_bias), 0.0);
        inertia.couple = 2.0 * speed * (dot(&kxi[..count], dxi) + opening) - dot(&cq[..count], xi_bias);

        // Columns of ∂ξ/∂η: one place of an axial mode, the pairs of a bending mode.
        for j in 0..axial {
            let (a, k) = (n + j, 1 + j);
            inertia.first_slope[a] = Vec2::new(self.first[k], 0.0);
            inertia.turning[a] = -cq[k];
            inertia.modal_force[a] = -square * kxi[k] - 2.0 * speed * cdq[k] + kbias[k];
            for i in 0..axial {
                inertia.modal[a][n + i] = self.second[k * count + 1 + i];
            }
        }
        for i in 0..n {
            inertia.first_slope[i] = Vec2::new(0.0, self.moment[i]);
            inertia.turning[i] = ctxi[i];
            inertia.modal_force[i] = -square * modal[i] * q[i] + 2.0 * speed * ctdxi[i];
            inertia.modal[i][i] = modal[i];
        }
        self.add_foreshortening(&mut inertia, q, speed, &kxi, &kbias, &cq, &cdq);
        inertia
    }

    /// What ∂ξ/∂q adds: each pair (i, j) moves with q_i by −2·q_j and with q_j by −2·q_i (with q_i by
    /// −2·q_i where they are the same).
    #[allow(clippy::too_many_arguments)]
    fn add_foreshortening<const K: usize, const F: usize>(
        &self,
        inertia: &mut Inertia<K>,
        q: &[f64],
        speed: f64,
        kxi: &[f64; F],
        kbias: &[f64; F],
        cq: &[f64; F],
        cdq: &[f64; F],
    ) {
        let Self { bending: n, axial, .. } = *self;
        let count = self.first.len();
        let square = speed * speed;
        // K·∂ξ/∂q_i, column by column.
        let mut moved = [[0.0; F]; K];
        for (k, &(i, j)) in self.pairs.iter().enumerate() {
            let place = 1 + axial + k;
            let row = &self.second[place * count..(place + 1) * count];
            let ends = [(i, -2.0 * q[j]), (j, -2.0 * q[i])];
            for &(mode, slope) in &ends[..if i == j { 1 } else { 2 }] {
                inertia.first_slope[mode].x += slope * self.first[place];
                inertia.turning[mode] -= slope * cq[place];
                inertia.modal_force[mode] += slope * (kbias[place] - square * kxi[place] - 2.0 * speed * cdq[place]);
                for (moved, element) in moved[mode].iter_mut().zip(row) {
                    *moved += slope * element;
                }
            }
        }
        if self.pairs.is_empty() {
            return;
        }
        for (k, &(i, j)) in self.pairs.iter().enumerate() {
            let place = 1 + axial + k;
            let ends = [(i, -2.0 * q[j]), (j, -2.0 * q[i])];
            for &(mode, slope) in &ends[..if i == j { 1 } else { 2 }] {
                for (other, moved) in moved.iter().enumerate().take(n) {
                    inertia.modal[mode][other] += slope * moved[place];
                }
            }
        }
        for (i, moved) in moved.iter().enumerate().take(n) {
            for j in 0..axial {
                inertia.modal[i][n + j] = moved[1 + j];
                inertia.modal[n + j][i] = moved[1 + j];
            }
        }
    }
}
