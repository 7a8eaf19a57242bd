//! The rod's modes in arrays for the inner loop, and functions compiled for how many there are.

use super::inertia::Inertia;
use super::tables::Tables;
use super::{FEW_MODES, Rod, Shape};
use crate::math::Real;
use crate::model::joint::{Kernel, Kernels};
use crate::model::scalar::Scalar;

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

    /// Them, i ≤ j.
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
    /// They themselves, or nothing.
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

/// The modes in arrays with room for `K` modes and `F` functions.
#[derive(Clone, Debug)]
pub struct Modes<const K: usize, const F: usize> {
    /// How many there are.
    pub counts: Counts,
    /// [m] Undeformed length.
    pub(super) length: f64,
    /// B(l), of functions.
    pub(super) end: [f64; F],
    /// [1/m] φ'(0) and φ'(l).
    pub(super) slope: [[f64; K]; 2],
    /// [N/m] Modal mass times ω².
    stiffness: [f64; K],
    /// [N·s/m] 2·ζ·ω times the modal mass.
    damping: [f64; K],
    /// Tables of moments; see [`Tables`].
    pub(super) tables: Tables<K, F>,
    /// [kg] ∫φ dm.
    pub(super) moment: [f64; K],
    /// [kg] ∫φ² dm.
    pub(super) modal_mass: [f64; K],
    kernels: Kernels<Family<K, F>>,
}

impl<const K: usize, const F: usize> Modes<K, F> {
    /// Of a rod that has room here.
    pub fn new(rod: &Rod) -> Self {
        let counts = rod.counts;
        let (n, count) = (counts.bending, counts.functions());
        let mut modes = Self {
            counts,
            length: rod.length,
            end: [0.0; F],
            slope: [[0.0; K]; 2],
            stiffness: [0.0; K],
            damping: [0.0; K],
            tables: Tables::new(rod),
            moment: [0.0; K],
            modal_mass: [0.0; K],
            kernels: Kernels {
                value: by_counts(counts),
                row: Functions::ANY,
                half: Functions::ANY,
                tangent: Functions::ANY,
            },
        };
        modes.end[..count].copy_from_slice(&rod.end);
        modes.moment[..n].copy_from_slice(&rod.moment);
        for (slope, of_rod) in modes.slope.iter_mut().zip(&rod.slope) {
            slope[..n].copy_from_slice(of_rod);
        }
        for k in 0..counts.modes() {
            let (mass, omega) = (rod.modal_mass[k], rod.frequency[k]);
            modes.modal_mass[k] = mass;
            modes.stiffness[k] = mass * omega * omega;
            modes.damping[k] = 2.0 * rod.damping_ratio * mass * omega;
        }
        modes
    }

    /// The shape of the modal coordinates `eta` [m] and their `rate` [m/s]: compiled in place for counts that are known,
    /// the rod's own.
    #[inline(always)]
    pub fn shape_of<R: Scalar, C: Counted>(&self, eta: &[R], rate: &[R]) -> Shape<R, K, F> {
        if const { C::KNOWN } {
            self.shape::<R, C>(eta, rate)
        } else {
            (R::kernel(&self.kernels).shape)(self, eta, rate)
        }
    }

    /// The inertia of a shape, with its modal coordinates and their rates, whose frame turns at `speed` [rad/s]; compiled
    /// as [`Modes::shape_of`].
    #[inline(always)]
    pub fn inertia_of<R: Scalar, C: Counted>(
        &self,
        shape: &Shape<R, K, F>,
        eta: &[R],
        rate: &[R],
        speed: R,
    ) -> Inertia<R, K> {
        if const { C::KNOWN } {
            self.inertia::<R, C>(shape, eta, rate, speed)
        } else {
            (R::kernel(&self.kernels).inertia)(self, shape, eta, rate, speed)
        }
    }

    /// [N] What elasticity, modal damping and the couples [N·m] on the end sections do to η.
    #[inline(always)]
    pub fn forces<R: Real>(&self, eta: &[R], rate: &[R], couple: &[R; 2]) -> [R; K] {
        let mut force = [R::ZERO; K];
        for k in 0..K.min(eta.len()).min(rate.len()) {
            let bent = couple[0] * self.slope[0][k] + couple[1] * self.slope[1][k];
            force[k] = bent - (eta[k] * self.stiffness[k] + rate[k] * self.damping[k]);
        }
        force
    }
}

type ShapeOf<R, const K: usize, const F: usize> = fn(&Modes<K, F>, &[R], &[R]) -> Shape<R, K, F>;
type InertiaOf<R, const K: usize, const F: usize> = fn(&Modes<K, F>, &Shape<R, K, F>, &[R], &[R], R) -> Inertia<R, K>;

/// Shape and inertia of a rod, compiled for its counts or for any.
#[derive(Clone, Copy, Debug)]
struct Functions<R, const K: usize, const F: usize> {
    shape: ShapeOf<R, K, F>,
    inertia: InertiaOf<R, K, F>,
}

impl<R: Real, const K: usize, const F: usize> Functions<R, K, F> {
    const ANY: Self = Self::of::<Any>();

    /// For these counts.
    const fn of<C: Counted>() -> Self {
        Self {
            shape: |modes, eta, rate| modes.shape::<R, C>(eta, rate),
            inertia: |modes, shape, eta, rate, speed| modes.inertia::<R, C>(shape, eta, rate, speed),
        }
    }
}

/// The functions for `counts`: compiled for them where they are small and usual, and so are the arrays.
fn by_counts<const K: usize, const F: usize>(counts: Counts) -> Functions<f64, K, F> {
    const { assert!(K >= FEW_MODES, "room for every counts below") };
    if const { K > FEW_MODES } {
        return Functions::ANY;
    }
    /// Chooses among the listed numbers of bending and axial modes.
    macro_rules! compiled {
        ($(($bending:literal, $axial:literal))*) => {
            match counts {
                $(_ if Exactly::<$bending, $axial>::COUNTS == Some(counts) =>
                    Functions::of::<Exactly<$bending, $axial>>(),)*
                _ => Functions::ANY,
            }
        };
    }
    compiled!((1, 0)(2, 0)(3, 0)(4, 0)(1, 1)(2, 1)(3, 1)(2, 2)(0, 1))
}

/// The functions as a kernel.
#[derive(Clone, Copy, Debug)]
struct Family<const K: usize, const F: usize>;

impl<const K: usize, const F: usize> Kernel for Family<K, F> {
    type Of<R: Real> = Functions<R, K, F>;
}
