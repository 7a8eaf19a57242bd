//! How many modes a rod has, and how much of them is known where code is compiled.

/// So few modes have arrays of their own, and loops over them that are written out.
pub const FEW_MODES: usize = 4;

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
pub trait CompiledCounts {
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
pub struct FixedCounts<const BENDING: usize, const AXIAL: usize>;

impl<const BENDING: usize, const AXIAL: usize> CompiledCounts for FixedCounts<BENDING, AXIAL> {
    const COUNTS: Option<Counts> = Some(Counts { bending: BENDING, axial: AXIAL, shortening: BENDING });
}

/// Any counts.
#[derive(Clone, Copy, Debug)]
pub struct RuntimeCounts;

impl CompiledCounts for RuntimeCounts {
    const COUNTS: Option<Counts> = None;
}

/// How many modes and functions along x the code of a rod has room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RodCapacity {
    /// For up to 4 modes and 12 functions.
    Few,
    /// For up to 8 modes and 40 functions.
    Many,
    /// For all 16 modes and 48 functions.
    All,
}

impl RodCapacity {
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
