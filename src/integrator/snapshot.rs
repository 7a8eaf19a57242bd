//! A saved state as a list of numbers.

use serde::{Deserialize, Serialize};

/// All numbers that a simulation needs to continue as if it had never stopped. Two snapshots are equal if all bits are
/// equal: rates under an excessive load may be NaN, and they are the same NaN after a restart.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Snapshot {
    /// Real numbers of the memory.
    pub reals: Vec<f64>,
    /// Counters and flags of the memory.
    pub integers: Vec<u64>,
}

impl Snapshot {
    fn bits(&self) -> impl Iterator<Item = u64> {
        self.reals.iter().map(|real| real.to_bits())
    }
}

impl PartialEq for Snapshot {
    fn eq(&self, other: &Self) -> bool {
        self.integers == other.integers && self.bits().eq(other.bits())
    }
}

/// Reads a snapshot in the order in which it was written. The numbers may come from anywhere: a missing number and one
/// that no run can produce are reported as `None`.
pub struct Reader<'a> {
    reals: std::slice::Iter<'a, f64>,
    integers: std::slice::Iter<'a, u64>,
}

impl<'a> Reader<'a> {
    /// Reads from the start.
    pub fn new(snapshot: &'a Snapshot) -> Self {
        Self { reals: snapshot.reals.iter(), integers: snapshot.integers.iter() }
    }

    /// The next real number; `None` if it is missing or not finite.
    pub fn real(&mut self) -> Option<f64> {
        self.any_real().filter(|real| real.is_finite())
    }

    /// The next `COUNT` real numbers; `None` if one is missing or not finite.
    pub fn reals<const COUNT: usize>(&mut self) -> Option<[f64; COUNT]> {
        let mut list = [0.0; COUNT];
        self.fill(&mut list)?;
        Some(list)
    }

    /// Fills a list with the next real numbers; `None` if one is missing or not finite.
    pub fn fill(&mut self, list: &mut [f64]) -> Option<()> {
        self.fill_any(list)?;
        list.iter().all(|real| real.is_finite()).then_some(())
    }

    /// Fills a list with the next real numbers, which need not be finite, as rates under an excessive load; `None` if
    /// one is missing.
    pub fn fill_any(&mut self, list: &mut [f64]) -> Option<()> {
        for place in list {
            *place = self.any_real()?;
        }
        Some(())
    }

    fn any_real(&mut self) -> Option<f64> {
        self.reals.next().copied()
    }

    /// The next integer; `None` if it is missing.
    pub fn integer(&mut self) -> Option<u64> {
        self.integers.next().copied()
    }

    /// Whether all numbers have been read.
    pub fn is_at_end(&self) -> bool {
        self.reals.len() == 0 && self.integers.len() == 0
    }
}

#[cfg(test)]
mod tests {
    use super::Snapshot;

    #[test]
    fn snapshots_are_equal_to_the_bit() {
        let of = |real: f64| Snapshot { reals: vec![1.0, real], integers: vec![7] };
        assert_eq!(of(f64::NAN), of(f64::NAN));
        assert_ne!(of(0.0), of(-0.0));
        assert_ne!(of(1.0), Snapshot { reals: vec![1.0, 1.0, 0.0], integers: vec![7] });
        assert_ne!(of(1.0), Snapshot { reals: vec![1.0, 1.0], integers: vec![8] });
    }
}
