//! Periodic, chaotic, or not to be told: from the section's visits and the exponent.

use super::lyapunov::Exponent;
use std::fmt;

/// Longest period that is looked for [turns].
pub const LONGEST: usize = 32;
/// Visits that repeat within this share of a clearance are the same.
pub const SAME: f64 = 1e-3;
/// Standard errors beyond which a sign is certain.
pub const CERTAIN: f64 = 3.0;

/// What a motion is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It repeats after so many turns.
    Periodic(usize),
    /// Neighbours part exponentially, and it does not repeat.
    Chaotic,
    /// It does not repeat, and neighbours neither part nor meet for certain: quasi-periodic, of a longer period, or not
    /// settled yet.
    Irregular,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Periodic(turns) => write!(f, "period {turns}"),
            Self::Chaotic => write!(f, "chaotic"),
            Self::Irregular => write!(f, "irregular"),
        }
    }
}

/// The evidence for a verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// The verdict.
    pub verdict: Verdict,
    /// Over how many turns the best repetition is.
    pub repeats_after: usize,
    /// By how much it fails, at worst.
    pub misses_by: f64,
    /// [1/s] The exponent.
    pub exponent: f64,
    /// [1/s] Its standard error.
    pub error: f64,
}

/// Judges visits to a section, each a list of numbers in which a difference of 1 is a large one.
pub fn judge(visits: &[Vec<f64>], exponent: &Exponent) -> Evidence {
    let miss = |period: usize| {
        let pairs = visits.iter().zip(visits.iter().skip(period));
        pairs.map(|(a, b)| apart(a, b)).fold(if visits.len() > period { 0.0 } else { f64::INFINITY }, f64::max)
    };
    let longest = LONGEST.min(visits.len() / 3);
    let misses: Vec<f64> = (1..=longest).map(miss).collect();
    let first = misses.iter().position(|miss| *miss <= SAME);
    let best = first.or_else(|| (0..misses.len()).min_by(|i, j| misses[*i].total_cmp(&misses[*j])));
    let verdict = match first {
        Some(place) => Verdict::Periodic(place + 1),
        None if exponent.value > CERTAIN * exponent.error => Verdict::Chaotic,
        None => Verdict::Irregular,
    };
    let misses_by = best.map_or(f64::INFINITY, |place| misses[place]);
    let repeats_after = best.map_or(0, |place| place + 1);
    Evidence { verdict, repeats_after, misses_by, exponent: exponent.value, error: exponent.error }
}

/// The largest difference.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exponent(value: f64) -> Exponent {
        Exponent { value, error: 0.1, history: vec![] }
    }

    #[test]
    fn the_shortest_period_counts() {
        let visits: Vec<Vec<f64>> = (0..60).map(|n| vec![f64::from(n % 3), 1.0]).collect();
        let evidence = judge(&visits, &exponent(-1.0));
        assert_eq!((evidence.verdict, evidence.misses_by), (Verdict::Periodic(3), 0.0));
        assert_eq!(judge(&visits, &exponent(1.0)).verdict, Verdict::Periodic(3));
    }

    #[test]
    fn what_does_not_repeat_is_chaotic_only_with_a_certain_exponent() {
        // The golden rotation never repeats.
        let visits: Vec<Vec<f64>> = (0..200).map(|n| vec![(f64::from(n) * 0.618_033_988_75).fract()]).collect();
        assert_eq!(judge(&visits, &exponent(0.0)).verdict, Verdict::Irregular);
        assert_eq!(judge(&visits, &exponent(0.31)).verdict, Verdict::Chaotic);
        assert_eq!(judge(&visits, &exponent(0.29)).verdict, Verdict::Irregular);
    }

    #[test]
    fn too_few_visits_show_no_period() {
        let visits = vec![vec![1.0], vec![1.0]];
        let evidence = judge(&visits, &exponent(0.0));
        assert_eq!((evidence.verdict, evidence.repeats_after), (Verdict::Irregular, 0));
    }
}
