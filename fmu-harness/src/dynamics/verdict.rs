//! Classifies a motion as periodic, chaotic or irregular, from the points of the section and the exponent.

use super::lyapunov::Exponent;
use std::fmt;

/// [turns] Longest period that is searched.
pub const LONGEST: usize = 32;
/// Points that differ by less than this share of a clearance count as the same.
pub const SAME: f64 = 1e-3;
/// Number of standard errors from which the sign of the exponent is certain.
pub const CERTAIN: f64 = 3.0;

/// The class of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It repeats after this number of turns.
    Periodic(usize),
    /// Neighbouring motions diverge exponentially, and the motion does not repeat.
    Chaotic,
    /// The motion does not repeat, and the sign of the exponent is not certain, or it is still in its transient: it is
    /// quasi-periodic, has a longer period, or one of its numbers only rises or only falls.
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
    /// Number of turns of the best repetition.
    pub repeats_after: usize,
    /// Largest difference of the best repetition.
    pub misses_by: f64,
    /// [1/s] The exponent.
    pub exponent: f64,
    /// [1/s] Standard error of the exponent.
    pub error: f64,
}

/// Classifies a motion from the points of a section. A difference of 1 between two numbers of points is large.
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
        _ if drifts(visits) => Verdict::Irregular,
        Some(place) => Verdict::Periodic(place + 1),
        None if exponent.value > CERTAIN * exponent.error => Verdict::Chaotic,
        None => Verdict::Irregular,
    };
    let misses_by = best.map_or(f64::INFINITY, |place| misses[place]);
    let repeats_after = best.map_or(0, |place| place + 1);
    Evidence { verdict, repeats_after, misses_by, exponent: exponent.value, error: exponent.error }
}

/// Whether a number rises or falls from each point to the next one, on the whole noticeably: the motion has not settled.
fn drifts(visits: &[Vec<f64>]) -> bool {
    let [first, .., last] = visits else { return false };
    (0..first.len()).any(|place| {
        let rises = last[place] - first[place];
        rises.abs() > SAME && visits.windows(2).all(|pair| (pair[1][place] - pair[0][place]) * rises > 0.0)
    })
}

/// Largest difference between two points.
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
    fn what_only_rises_has_not_settled() {
        let rising: Vec<Vec<f64>> = (0..60).map(|n| vec![1e-4 * f64::from(n), f64::from(n % 2)]).collect();
        assert_eq!(judge(&rising, &exponent(1.0)).verdict, Verdict::Irregular);
        let rounding: Vec<Vec<f64>> = (0..60).map(|n| vec![1e-6 * f64::from(n), f64::from(n % 2)]).collect();
        assert_eq!(judge(&rounding, &exponent(1.0)).verdict, Verdict::Periodic(2));
    }

    #[test]
    fn too_few_visits_show_no_period() {
        let visits = vec![vec![1.0], vec![1.0]];
        let evidence = judge(&visits, &exponent(0.0));
        assert_eq!((evidence.verdict, evidence.repeats_after), (Verdict::Irregular, 0));
    }
}
