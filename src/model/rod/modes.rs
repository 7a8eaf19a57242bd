//! The rod's modes in the arrays that the equations read.

use super::counts::{ALL_FUNCTIONS, ALL_MODES, Counts, RodCapacity};
use super::flexible::Rod;
use super::tables::{TableView, Tables};
use crate::math::Real;

/// The modes of a rod in lists of the largest size, and its tables in the size of every [`RodCapacity`] that code reads
/// for it.
#[derive(Clone, Debug)]
pub struct Modes {
    /// Numbers of modes.
    pub counts: Counts,
    /// The smallest sizes of the tables.
    pub room: RodCapacity,
    /// [m] Undeformed length.
    length: f64,
    /// B(l): values of the functions at the small end.
    end: Vec<f64>,
    /// [1/m] φ'(0) and φ'(l).
    slope: [Vec<f64>; 2],
    /// [N/m] Modal stiffness: modal mass times ω².
    stiffness: Vec<f64>,
    /// [N·s/m] Modal damping: 2·ζ·ω times the modal mass.
    damping: Vec<f64>,
    /// The tables for few modes, for many and for all.
    tables: [Option<Tables>; 3],
    /// [kg] ∫φ dm.
    moment: Vec<f64>,
    /// [kg] ∫φ² dm.
    modal_mass: Vec<f64>,
}

/// The modes in arrays for `K` modes and `F` functions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrays<'a, const K: usize, const F: usize> {
    /// Numbers of modes.
    pub counts: Counts,
    pub(super) length: f64,
    pub(super) end: &'a [f64; F],
    pub(super) slope: [&'a [f64; K]; 2],
    stiffness: &'a [f64; K],
    damping: &'a [f64; K],
    pub(super) tables: TableView<'a, K, F>,
    pub(super) moment: &'a [f64; K],
    pub(super) modal_mass: &'a [f64; K],
}

impl Modes {
    /// The modes of a rod, with the smallest capacity.
    pub fn new(rod: &Rod) -> Self {
        Self::with_capacity(rod, RodCapacity::of(rod.counts))
    }

    /// The modes of a rod, with the capacity `room`.
    pub fn with_capacity(rod: &Rod, room: RodCapacity) -> Self {
        Self::with_tables(rod, room, |size| room.is_within(size) && size.is_read())
    }

    /// The modes of a rod and as many more, which stand still, as code for known numbers of modes has; `None` if there is no
    /// such code.
    pub fn known(rod: &Rod) -> Option<Self> {
        let padded = rod.padded(rod.counts.known()?);
        Some(Self::with_tables(&padded, RodCapacity::Few, |size| size == RodCapacity::Few))
    }

    fn with_tables(rod: &Rod, room: RodCapacity, is_read: impl Fn(RodCapacity) -> bool) -> Self {
        let counts = rod.counts;
        let padded = |numbers: &[f64], width: usize| {
            let mut list = vec![0.0; width];
            list[..numbers.len()].copy_from_slice(numbers);
            list
        };
        let of_modes = |of: &dyn Fn(f64, f64) -> f64| {
            let found: Vec<f64> = rod.modal_mass.iter().zip(&rod.frequency).map(|(m, omega)| of(*m, *omega)).collect();
            padded(&found, ALL_MODES)
        };
        Self {
            counts,
            room,
            length: rod.length,
            end: padded(&rod.end, ALL_FUNCTIONS),
            slope: [padded(&rod.slope[0], ALL_MODES), padded(&rod.slope[1], ALL_MODES)],
            stiffness: of_modes(&|mass, omega| mass * omega * omega),
            damping: of_modes(&|mass, omega| 2.0 * rod.damping_ratio * mass * omega),
            tables: RodCapacity::EACH.map(|size| is_read(size).then(|| Tables::new(rod, size))),
            moment: padded(&rod.moment, ALL_MODES),
            modal_mass: padded(&rod.modal_mass, ALL_MODES),
        }
    }

    /// Views the lists as arrays of the sizes of a capacity, at least the modes' own.
    #[inline(always)]
    pub(crate) fn arrays<const K: usize, const F: usize>(&self) -> Arrays<'_, K, F> {
        let Some(tables) = &self.tables[const { RodCapacity::of_functions(F) as usize }] else {
            unreachable!("a rod is computed in arrays of its own capacity or a larger one")
        };
        Arrays {
            counts: self.counts,
            length: self.length,
            end: array(&self.end),
            slope: [array(&self.slope[0]), array(&self.slope[1])],
            stiffness: array(&self.stiffness),
            damping: array(&self.damping),
            tables: tables.viewed(),
            moment: array(&self.moment),
            modal_mass: array(&self.modal_mass),
        }
    }
}

/// Views the first numbers of a list as an array.
#[inline(always)]
fn array<const N: usize>(list: &[f64]) -> &[f64; N] {
    match list.first_chunk() {
        Some(array) => array,
        None => unreachable!("a rod's lists have the largest size"),
    }
}

impl<const K: usize, const F: usize> Arrays<'_, K, F> {
    /// [N] Generalised force on modal coordinate `k`: elasticity, modal damping, and the couples [N·m] on the end
    /// sections.
    #[inline(always)]
    pub fn force<R: Real>(&self, k: usize, eta: R, rate: R, couple: &[R; 2]) -> R {
        let bent = couple[0] * self.slope[0][k] + couple[1] * self.slope[1][k];
        bent - (eta * self.stiffness[k] + rate * self.damping[k])
    }
}
