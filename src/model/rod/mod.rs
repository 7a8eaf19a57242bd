//! The flexible rod: inertia, elasticity and ends of a floating frame on the chord.
//!
//! In the chord's frame a point of the rod lies at (X, Y) = (Σ_k B_k(x)·ξ_k, Σ_i φ_i(x)·q_i): B holds x,
//! the axial modes and the foreshortenings Γ_ij, ξ their amplitudes 1, p_j and −σ_ij, where σ_ij is
//! q_i² or 2·q_i·q_j. All of the kinetic energy then follows from constant integrals over products of
//! B and φ ([`ModalTable`]) and from how ξ depends on the modal coordinates η = (q, p); nothing is
//! dropped. See A. A. Shabana, Dynamics of Multibody Systems, 5.3, for the floating frame.

pub mod beam;
mod inertia;
mod modes;
mod shape;
mod sums;
mod tables;

pub use inertia::Inertia;
pub(super) use modes::Arrays;
pub use modes::{Any, Counted, Counts, Exactly, Modes, Room};
pub use shape::{Chord, Shape};

use super::bodies::Body;
use super::plane::Vec2;
use crate::math::{LANES, Real};
use crate::scene::modal::{MOST_MODES, ModalTable, pairs};
use crate::scene::{Flexible, Scene};

/// So few modes have arrays of their own, and loops over them that are written out.
pub const FEW_MODES: usize = 4;

/// Number of functions along x that `modes` modes may need at most, in whole lanes.
pub const fn most_functions(modes: usize) -> usize {
    let functions = if modes <= MOST_MODES { 1 + pairs(modes) } else { 1 + modes - MOST_MODES + pairs(MOST_MODES) };
    functions.next_multiple_of(LANES)
}

/// The rod's modes, as the scene calls for them.
#[derive(Clone, Debug)]
pub struct Rod {
    counts: Counts,
    /// [m] Undeformed.
    length: f64,
    /// [kg]
    mass: f64,
    /// [kg·m] ∫B dm.
    first: Vec<f64>,
    /// [kg·m²] ∫B·Bᵀ dm, row by row.
    second: Vec<f64>,
    /// [kg·m] ∫B·φᵀ dm, row by row.
    coupling: Vec<f64>,
    /// [kg] ∫φ dm.
    moment: Vec<f64>,
    /// φ(l/2), φ'(0), φ'(l).
    middle: Vec<f64>,
    slope: [Vec<f64>; 2],
    /// B(l).
    end: Vec<f64>,
    /// [kg] Modal masses of η.
    modal_mass: Vec<f64>,
    /// [rad/s] Frequencies of η.
    pub frequency: Vec<f64>,
    damping_ratio: f64,
}

/// What outputs tell of the rod's elasticity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Elastic<R = f64> {
    /// [m] At mid-span.
    pub deflection: R,
    /// [m] From end to end.
    pub stretch: R,
    /// [J]
    pub energy: R,
    /// [W] That modal damping takes.
    pub modal_loss: R,
}

impl Rod {
    /// Of a scene; `None` of a rigid rod.
    pub fn new(scene: &Scene) -> Option<Self> {
        let Flexible { bending_modes, axial_modes, damping_ratio, geometric_stiffness, table, .. } =
            &scene.rod.flexible;
        let count = |modes: i32| usize::try_from(modes).unwrap_or(0).min(MOST_MODES);
        let (bending, axial) = (count(*bending_modes), count(*axial_modes));
        if bending + axial == 0 {
            return None;
        }
        let built_in;
        let table = match table {
            Some(table) => table,
            None => {
                built_in = beam::table(scene);
                &built_in
            }
        };
        Some(Self::of(table, bending, axial, scene.rod.length, *damping_ratio, *geometric_stiffness))
    }

    /// The first `bending` and `axial` modes of a table.
    fn of(table: &ModalTable, bending: usize, axial: usize, length: f64, damping_ratio: f64, shortens: bool) -> Self {
        let all = table.bending.len();
        let mut kept: Vec<usize> = (0..=axial).collect();
        let mut place = 1 + table.axial.len();
        for i in 0..all {
            for j in i..all {
                if shortens && j < bending {
                    kept.push(place);
                }
                place += 1;
            }
        }
        let (bend, stretch) = (&table.bending[..bending], &table.axial[..axial]);
        let mut end = vec![length];
        end.extend(stretch.iter().map(|mode| mode.end));
        end.extend(kept[1 + axial..].iter().map(|&k| table.shortening[k - 1 - table.axial.len()]));
        let of_modes = |of_bending: &dyn Fn(usize) -> f64, of_axial: &dyn Fn(usize) -> f64| {
            (0..bending).map(of_bending).chain((0..axial).map(of_axial)).collect::<Vec<f64>>()
        };
        Self {
            counts: Counts { bending, axial, shortening: if shortens { bending } else { 0 } },
            length,
            mass: table.mass,
            first: kept.iter().map(|&k| table.first[k]).collect(),
            second: kept.iter().flat_map(|&k| kept.iter().map(move |&m| table.second[k][m])).collect(),
            coupling: kept.iter().flat_map(|&k| table.coupling[k][..bending].iter().copied()).collect(),
            moment: bend.iter().map(|mode| mode.moment).collect(),
            middle: bend.iter().map(|mode| mode.middle).collect(),
            slope: [
                bend.iter().map(|mode| mode.slope_start).collect(),
                bend.iter().map(|mode| mode.slope_end).collect(),
            ],
            end,
            modal_mass: of_modes(&|i| bend[i].mass, &|j| stretch[j].mass),
            frequency: of_modes(&|i| bend[i].frequency, &|j| stretch[j].frequency),
            damping_ratio,
        }
    }

    /// The rod as a rigid body.
    pub fn undeformed(&self) -> Body {
        let com = Vec2::new(self.first[0] / self.mass, 0.0);
        let inertia = self.second[0] - self.mass * com.x * com.x;
        Body { mass: self.mass, inertia, com, length: self.length }
    }

    /// Number of modal coordinates.
    pub fn modes(&self) -> usize {
        self.counts.modes()
    }

    /// [kg]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Deflection, stretch and elastic energy.
    pub fn elastic<R: Real, const K: usize, const F: usize>(
        &self,
        shape: &Shape<R, K, F>,
        eta: &[R],
        rate: &[R],
    ) -> Elastic<R> {
        let mut elastic = Elastic { stretch: shape.chord.stretch, ..Elastic::default() };
        elastic.deflection = eta.iter().zip(&self.middle).fold(R::ZERO, |sum, (eta, middle)| sum + *eta * *middle);
        for k in 0..self.modes() {
            let (m, omega) = (self.modal_mass[k], self.frequency[k]);
            elastic.energy += eta[k] * (0.5 * m * omega * omega) * eta[k];
            elastic.modal_loss += rate[k] * (2.0 * self.damping_ratio * m * omega) * rate[k];
        }
        elastic
    }
}
