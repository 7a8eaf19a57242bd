//! Numbers of modes of a rod, and whether they are known at compile time.

use crate::math::{LANES, Real};

/// Numbers of modes, in the order of the modal coordinates, and of those with foreshortening.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Bending modes.
    pub bending: usize,
    /// Axial modes.
    pub axial: usize,
    /// Number of bending modes with foreshortening: all, or 0 without geometric stiffness.
    pub shortening: usize,
}

/// The numbers of modes that have code with loops over modes written out for any structure, fewest first.
pub const KNOWN: [Counts; 2] = [Counts::shortened(2, 0), Counts::shortened(3, 1)];

impl Counts {
    /// `bending` bending modes, all with foreshortening, and `axial` axial modes.
    const fn shortened(bending: usize, axial: usize) -> Self {
        Self { bending, axial, shortening: bending }
    }

    /// The fewest known numbers of modes that are at least these.
    pub(super) fn known(self) -> Option<Self> {
        KNOWN.into_iter().find(|known| self.bending <= known.bending && self.axial <= known.axial)
    }

    /// Number of modal coordinates.
    #[inline(always)]
    pub const fn modes(self) -> usize {
        self.bending + self.axial
    }

    /// Number of functions along x: x itself, axial modes, and foreshortenings of pairs i ≤ j.
    #[inline(always)]
    pub const fn functions(self) -> usize {
        1 + self.axial + self.pairs()
    }

    /// Number of pairs i ≤ j of bending modes with foreshortening.
    #[inline(always)]
    pub const fn pairs(self) -> usize {
        self.shortening * (self.shortening + 1) / 2
    }

    /// The pairs i ≤ j of bending modes with foreshortening.
    pub(super) fn all_pairs(self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.shortening).flat_map(move |i| (i..self.shortening).map(move |j| (i, j)))
    }

    /// Number of pairs j < k of the first `bending` bending modes.
    #[inline(always)]
    pub const fn twists(self, bending: usize) -> usize {
        bending * (bending.saturating_sub(1)) / 2
    }

    /// Index among the functions of the foreshortening of bending modes `i` and `j`.
    #[inline(always)]
    pub const fn pair(self, i: usize, j: usize) -> usize {
        let (i, j) = if i < j { (i, j) } else { (j, i) };
        1 + self.axial + i * (2 * self.shortening - i + 1) / 2 + j - i
    }
}

/// The counts of a rod as far as they are known at compile time.
pub trait CompiledCounts {
    /// The counts; `None` if they are known only at run time.
    const COUNTS: Option<Counts>;
    /// Whether the counts are known: loops over modes and functions are then written out.
    const KNOWN: bool = Self::COUNTS.is_some();
    /// Upper bound of the number of modes.
    const MODES: usize = match Self::COUNTS {
        Some(counts) => counts.modes(),
        None => usize::MAX,
    };
    /// Upper bound of the number of functions along x.
    const FUNCTIONS: usize = match Self::COUNTS {
        Some(counts) => counts.functions(),
        None => usize::MAX,
    };
}

/// How many entries of a list of `modes` numbers, in an array of `most`, are computed. Numbers that stand alone are computed
/// in whole registers unless the loop is written out: a list is zero beyond the modes.
#[inline(always)]
pub fn in_registers<R: Real, C: CompiledCounts>(modes: usize, most: usize) -> usize {
    if const { R::PLAIN && !C::KNOWN } { modes.next_multiple_of(LANES).min(most) } else { modes }
}

/// `BENDING` bending modes and `AXIAL` axial modes, with geometric stiffness.
#[derive(Clone, Copy, Debug)]
pub struct FixedCounts<const BENDING: usize, const AXIAL: usize>;

impl<const BENDING: usize, const AXIAL: usize> CompiledCounts for FixedCounts<BENDING, AXIAL> {
    const COUNTS: Option<Counts> = Some(Counts::shortened(BENDING, AXIAL));
}

/// Counts that are known only at run time.
#[derive(Clone, Copy, Debug)]
pub struct RuntimeCounts;

impl CompiledCounts for RuntimeCounts {
    const COUNTS: Option<Counts> = None;
}

/// Modes of any rod.
pub const ALL_MODES: usize = 16;
/// Functions along x of any rod.
pub const ALL_FUNCTIONS: usize = 48;

/// Whether eight states with a flexible rod are computed together: where registers hold four numbers. In registers of two, that
/// code is longer than a processor's cache of instructions, and eight states take 1.2 times as long as one after the other.
pub const ROWS_WITH_MODES: bool = cfg!(target_feature = "avx2");

/// Array sizes for a rod: maximum numbers of modes and of functions along x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RodCapacity {
    /// 4 modes and 12 functions.
    Few,
    /// 8 modes and 40 functions.
    Many,
    /// [`ALL_MODES`] and [`ALL_FUNCTIONS`], which suffice for any rod.
    All,
}

impl RodCapacity {
    /// Maximum numbers of modes and of functions.
    pub const fn size(self) -> [usize; 2] {
        match self {
            Self::Few => [4, 12],
            Self::Many => [8, 40],
            Self::All => [ALL_MODES, ALL_FUNCTIONS],
        }
    }

    /// From the smallest to the largest.
    pub const EACH: [Self; 3] = [Self::Few, Self::Many, Self::All];

    /// The smallest capacity for these counts.
    pub fn of(counts: Counts) -> Self {
        let suits = |room: &Self| {
            let [modes, functions] = room.size();
            counts.modes() <= modes && counts.functions() <= functions
        };
        Self::EACH.into_iter().find(suits).unwrap_or(Self::All)
    }

    /// The capacity of arrays for `functions` functions.
    pub const fn of_functions(functions: usize) -> Self {
        if functions == Self::Few.size()[1] {
            Self::Few
        } else if functions == Self::Many.size()[1] {
            Self::Many
        } else {
            Self::All
        }
    }

    /// Whether code for unknown numbers of modes reads tables of this size: those for many modes are for eight states at a time.
    pub const fn is_read(self) -> bool {
        match self {
            Self::Few => false,
            Self::Many => ROWS_WITH_MODES,
            Self::All => true,
        }
    }

    /// Whether arrays of the capacity `other` hold what arrays of this one do.
    pub const fn is_within(self, other: Self) -> bool {
        self as usize <= other as usize
    }
}
