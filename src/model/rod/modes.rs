//! The rod's modes as the inner loop reads them.

use super::Rod;
use super::tables::{Tables, Viewed};
use crate::math::Real;

/// How many modes there are, in the order of the modal coordinates, and which of them foreshorten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Bending modes.
    pub bending: usize,
    /// Axial modes.
    pub axial: usize,
    /// Bending modes that foreshorten: all, or none without geometric stiffness.
    pub shortening: usize,
}

impl Counts {
    /// Number of modal coordinates.
    #[inline(always)]
    pub const fn modes(self) -> usize {
        self.bending + self.axial
    }

    /// Number of functions along x: the rod itself, axial modes, foreshortenings of pairs i ≤ j.
    #[inline(always)]
    pub const fn functions(self) -> usize {
        1 + self.axial + self.pairs()
    }

    /// Number of pairs of bending modes that foreshorten.
    #[inline(always)]
    pub const fn pairs(self) -> usize {
        self.shortening * (self.shortening + 1) / 2
    }

    /// These pairs, i ≤ j.
    pub(super) fn all_pairs(self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.shortening).flat_map(move |i| (i..self.shortening).map(move |j| (i, j)))
    }

    /// Number of pairs j < k of the first `bending` bending modes.
    #[inline(always)]
    pub const fn twists(self, bending: usize) -> usize {
        bending * (bending.saturating_sub(1)) / 2
    }

    /// Place among the functions of the foreshortening of the bending modes `i` and `j`.
    #[inline(always)]
    pub const fn pair(self, i: usize, j: usize) -> usize {
        let (i, j) = if i < j { (i, j) } else { (j, i) };
        1 + self.axial + i * (2 * self.shortening - i + 1) / 2 + j - i
    }
}

/// What is known of a rod's counts where code is compiled.
pub trait Counted {
    /// The counts, where they are known.
    const COUNTS: Option<Counts>;
    /// They are known: loops over modes and functions are written out.
    const KNOWN: bool = Self::COUNTS.is_some();
    /// Most modes.
    const MODES: usize = match Self::COUNTS {
        Some(counts) => counts.modes(),
        None => usize::MAX,
    };
    /// Most functions along x.
    const FUNCTIONS: usize = match Self::COUNTS {
        Some(counts) => counts.functions(),
        None => usize::MAX,
    };
}

/// So many modes, with geometric stiffness.
#[derive(Clone, Copy, Debug)]
pub struct Exactly<const BENDING: usize, const AXIAL: usize>;

impl<const BENDING: usize, const AXIAL: usize> Counted for Exactly<BENDING, AXIAL> {
    const COUNTS: Option<Counts> = Some(Counts { bending: BENDING, axial: AXIAL, shortening: BENDING });
}

/// Any counts.
#[derive(Clone, Copy, Debug)]
pub struct Any;

impl Counted for Any {
    const COUNTS: Option<Counts> = None;
}

/// A rod's modes in lists with [`Room`] for more of them.
#[derive(Clone, Debug)]
pub struct Modes {
    /// How many there are.
    pub counts: Counts,
    /// What the lists have room for.
    pub room: Room,
    /// [m] Undeformed length.
    length: f64,
    /// B(l), of functions.
    end: Vec<f64>,
    /// [1/m] φ'(0) and φ'(l).
    slope: [Vec<f64>; 2],
    /// [N/m] Modal mass times ω².
    stiffness: Vec<f64>,
    /// [N·s/m] 2·ζ·ω times the modal mass.
    damping: Vec<f64>,
    tables: Tables,
    /// [kg] ∫φ dm.
    moment: Vec<f64>,
    /// [kg] ∫φ² dm.
    modal_mass: Vec<f64>,
}

/// How many modes and functions along x the code of a rod has room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Room {
    /// For up to 4 modes and 12 functions.
    Few,
    /// For up to 8 modes and 40 functions.
    Many,
    /// For all 16 modes and 48 functions.
    All,
}

impl Room {
    /// Numbers of modes and functions.
    pub const fn size(self) -> [usize; 2] {
        match self {
            Self::Few => [4, 12],
            Self::Many => [8, 40],
            Self::All => [16, 48],
        }
    }

    /// The smallest one for such counts.
    pub fn of(counts: Counts) -> Self {
        let suits = |room: &Self| {
            let [modes, functions] = room.size();
            counts.modes() <= modes && counts.functions() <= functions
        };
        [Self::Few, Self::Many].into_iter().find(suits).unwrap_or(Self::All)
    }
}

/// The same modes in arrays of `K` modes and `F` functions.
#[derive(Clone, Copy, Debug)]
pub(in crate::model) struct Arrays<'a, const K: usize, const F: usize> {
    /// How many there are.
    pub counts: Counts,
    pub(super) length: f64,
    pub(super) end: &'a [f64; F],
    pub(super) slope: [&'a [f64; K]; 2],
    stiffness: &'a [f64; K],
    damping: &'a [f64; K],
    pub(super) tables: Viewed<'a, K, F>,
    pub(super) moment: &'a [f64; K],
    pub(super) modal_mass: &'a [f64; K],
}

impl Modes {
    /// Of a rod.
    pub fn new(rod: &Rod) -> Self {
        Self::in_room(rod, Room::of(rod.counts))
    }

    /// The same in a room that is given.
    pub fn in_room(rod: &Rod, room: Room) -> Self {
        let counts = rod.counts;
        let [modes, functions] = room.size();
        let padded = |numbers: &[f64], width: usize| {
            let mut list = vec![0.0; width];
            list[..numbers.len()].copy_from_slice(numbers);
            list
        };
        let of_modes = |of: &dyn Fn(f64, f64) -> f64| {
            let found: Vec<f64> = rod.modal_mass.iter().zip(&rod.frequency).map(|(m, omega)| of(*m, *omega)).collect();
            padded(&found, modes)
        };
        Self {
            counts,
            room,
            length: rod.length,
            end: padded(&rod.end, functions),
            slope: [padded(&rod.slope[0], modes), padded(&rod.slope[1], modes)],
            stiffness: of_modes(&|mass, omega| mass * omega * omega),
            damping: of_modes(&|mass, omega| 2.0 * rod.damping_ratio * mass * omega),
            tables: Tables::new(rod, room),
            moment: padded(&rod.moment, modes),
            modal_mass: padded(&rod.modal_mass, modes),
        }
    }

    /// In the arrays of its room.
    #[inline(always)]
    pub(in crate::model) fn arrays<const K: usize, const F: usize>(&self) -> Arrays<'_, K, F> {
        Arrays {
            counts: self.counts,
            length: self.length,
            end: array(&self.end),
            slope: [array(&self.slope[0]), array(&self.slope[1])],
            stiffness: array(&self.stiffness),
            damping: array(&self.damping),
            tables: self.tables.viewed(),
            moment: array(&self.moment),
            modal_mass: array(&self.modal_mass),
        }
    }
}

/// A list as an array of its own length.
#[inline(always)]
fn array<const N: usize>(list: &[f64]) -> &[f64; N] {
    match list.first_chunk() {
        Some(array) => array,
        None => unreachable!("a rod's lists are read in the arrays of their room"),
    }
}

impl<const K: usize, const F: usize> Arrays<'_, K, F> {
    /// [N] What elasticity, modal damping and the couples [N·m] on the end sections do to the modal coordinate `k`.
    #[inline(always)]
    pub fn force<R: Real>(&self, k: usize, eta: R, rate: R, couple: &[R; 2]) -> R {
        let bent = couple[0] * self.slope[0][k] + couple[1] * self.slope[1][k];
        bent - (eta * self.stiffness[k] + rate * self.damping[k])
    }
}
