//! Sliding work by sectors of equal angle on bearing and journal.

use std::f64::consts::{PI, TAU};

/// A place on the bearing and on the journal, each at an angle [rad] in its own body's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// [rad] On the bearing.
    pub bearing: f64,
    /// [rad] On the journal.
    pub journal: f64,
}

impl Place {
    /// The place at the direction `angle` [rad] of the eccentricity, with both bodies at their angles [rad].
    pub fn of(angle: f64, [bearing, journal]: [f64; 2]) -> Self {
        Self { bearing: angle - bearing, journal: angle - journal }
    }
}

/// Work in each sector of one body; sector k covers 2πk/N to 2π(k + 1)/N.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sectors {
    /// [J]
    pub work: Vec<f64>,
}

impl Sectors {
    /// `number` sectors without work.
    pub fn new(number: usize) -> Self {
        Self { work: vec![0.0; number] }
    }

    /// Spreads `work` evenly over a part of the arc between two angles [rad], taken the short way. The part is given by its
    /// ends as shares of the arc; 0 and 1 are the whole arc.
    pub fn spread(&mut self, work: f64, [from, to]: [f64; 2], part: [f64; 2]) {
        let number = self.work.len();
        // Both ends in sectors from the body's axis.
        let per_turn = number as f64 / TAU;
        let arc = (to - from + PI).rem_euclid(TAU) - PI;
        let ends = part.map(|share| (from + share * arc) * per_turn);
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let place = |sector: f64| sector.rem_euclid(number as f64) as usize % number;
        let (first, last) = (low.floor(), high.floor());
        if first == last {
            self.work[place(first)] += work;
            return;
        }
        for step in 0..=(last - first) as usize {
            let sector = first + step as f64;
            let covered = high.min(sector + 1.0) - low.max(sector);
            self.work[place(sector)] += work * covered / (high - low);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(from: f64, to: f64) -> Vec<f64> {
        let mut sectors = Sectors::new(8);
        sectors.spread(8.0, [from, to].map(|sector| sector * TAU / 8.0), [0.0, 1.0]);
        sectors.work
    }

    fn near(found: &[f64], wanted: [f64; 8]) {
        assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-12), "{found:?}");
    }

    #[test]
    fn work_is_spread_the_short_way_and_all_of_it() {
        near(&spread(0.5, 0.5), [8.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        near(&spread(0.5, 2.5), [2.0, 4.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        near(&spread(2.5, 0.5), [2.0, 4.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        near(&spread(7.5, 0.5), [4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0]);
        near(&spread(0.5, 7.5 + 80.0), [4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0]);
        near(&spread(-17.0, -17.0), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 8.0]);
        let mut part = Sectors::new(8);
        part.spread(8.0, [0.5, 2.5].map(|sector| sector * TAU / 8.0), [0.25, 0.75]);
        near(&part.work, [0.0, 8.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let all: f64 = (0..1000).map(|i| spread(f64::from(i) * 0.37, f64::from(i) * 0.91).iter().sum::<f64>()).sum();
        assert!((all - 8000.0).abs() < 1e-9, "{all}");
    }
}
