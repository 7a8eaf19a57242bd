//! Archard's law for one joint: the worn volume is k·∫f_n ds, with one coefficient k for the bearing and one for the
//! journal (J. Appl. Phys. 24 (1953) 981). Only the mean depth changes the joint.

use super::sectors::{Place, Sectors};
use crate::sweep::quantity::Reduction;
use crate::trajectory::Trajectory;
use anyhow::{Context, Result, bail, ensure};
use slidercrank::scene::{JointModel, Revolute, Scene};
use std::f64::consts::TAU;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// [m²/N] Coefficients from a well oiled to a dry joint of soft metal. Others are accepted, with a warning.
pub const PLAUSIBLE: RangeInclusive<f64> = 1e-19..=1e-11;

/// Largest clearance that is followed, relative to the bearing's radius before wear.
const LOOSEST: f64 = 0.1;

/// Coefficients of a joint, as the command line gives them: `B=1e-16`, or `B=1e-16,3e-16` for bearing and journal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Letter of the joint.
    pub joint: char,
    /// [m²/N] Of the bearing and of the journal.
    pub values: [f64; 2],
}

impl FromStr for Coefficients {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || format!("expected JOINT=BEARING,JOURNAL or JOINT=BOTH with joint A, B or C, not `{text}`");
        let (joint, values) = text.split_once('=').ok_or_else(wanted)?;
        let joint = ["A", "B", "C"].iter().position(|known| *known == joint.trim()).ok_or_else(wanted)?;
        let number = |text: &str| text.trim().parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
        let numbers: Option<Vec<f64>> = values.split(',').map(number).collect();
        let values = match numbers.as_deref() {
            Some(&[both]) => [both, both],
            Some(&[bearing, journal]) => [bearing, journal],
            _ => return Err(format!("expected one or two numbers above 0 in m²/N after the joint, not `{values}`")),
        };
        Ok(Self { joint: char::from(b'A' + joint as u8), values })
    }
}

/// A joint that wears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wearing {
    /// Letter of the joint.
    pub letter: char,
    /// [m²/N] Coefficients of the bearing and of the journal.
    pub coefficients: [f64; 2],
    /// [m] Radius of the bearing before wear.
    radius: f64,
    /// [m] Clearance before wear.
    pub clearance: f64,
    /// [m] Width.
    width: f64,
}

/// Sliding work of a joint in a run, without its first strokes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Work {
    /// [J] Work of each stroke.
    pub strokes: Vec<f64>,
    /// Work of all these strokes by sectors of the bearing and of the journal.
    pub bodies: [Sectors; 2],
}

impl Wearing {
    /// The joint of a scene with these coefficients.
    ///
    /// # Errors
    /// If the joint is ideal.
    pub fn of(scene: &Scene, Coefficients { joint, values }: Coefficients) -> Result<Self> {
        let Revolute { model, radius, clearance, contact, .. } = match joint {
            'A' => &scene.joint.a,
            'B' => &scene.joint.b,
            'C' => &scene.joint.c,
            _ => bail!("joint {joint} is not a journal in a bearing"),
        };
        ensure!(*model == JointModel::Clearance, "joint {joint} is ideal; only a joint with clearance wears");
        ensure!(contact.width > 0.0, "joint {joint} has the width 0 m; without a width its depth of wear is unknown");
        Ok(Self { letter: joint, coefficients: values, radius: *radius, clearance: *clearance, width: contact.width })
    }

    /// Name of one of its variables.
    pub fn variable(&self, name: &str) -> String {
        format!("joint.{}.{name}", self.letter)
    }

    /// Checks that the joint is still a bearing with this clearance.
    ///
    /// # Errors
    /// If the clearance is a large part of the radius.
    pub fn admit(&self, clearance: f64) -> Result<()> {
        let limit = LOOSEST * self.radius;
        ensure!(
            clearance <= limit,
            "a clearance of {clearance:.3e} m in joint {} is above a tenth of the radius, {limit:.3e} m",
            self.letter
        );
        Ok(())
    }

    /// [m] Radii of bearing and journal when the clearance has grown to `clearance`.
    ///
    /// Equal work w wears both: R_b² = R_b0² + k_b·w/(πL), R_j² = R_j0² − k_j·w/(πL). So k_j·R_b² + k_b·R_j² stays what it
    /// was, which with R_j = R_b − c is a quadratic equation for the growth of R_b.
    pub fn radii(&self, clearance: f64) -> [f64; 2] {
        let [bearing, journal] = self.coefficients;
        let grown = clearance - self.clearance;
        // With x = growth of R_b and y = growth − x: k_j·(2R_b·x + x²) = k_b·(2R_j·y − y²).
        let (square, half) =
            (bearing + journal, journal * self.radius + bearing * (self.radius - self.clearance) - bearing * grown);
        let constant = bearing * grown * (2.0 * (self.radius - self.clearance) - grown);
        let radius = self.radius + constant / (half + (half * half + square * constant).sqrt());
        [radius, radius - clearance]
    }

    /// [m/J] Mean depth of bearing and journal for each joule of sliding work.
    fn depth_per_work(&self, clearance: f64) -> [f64; 2] {
        let radii = self.radii(clearance);
        [0, 1].map(|body| self.coefficients[body] / (TAU * radii[body] * self.width))
    }

    /// [m] Growth of the clearance in one stroke, with its standard error.
    pub fn growth(&self, clearance: f64, work: &Work) -> [f64; 2] {
        let [bearing, journal] = self.depth_per_work(clearance);
        let error = Reduction::Deviation.of(&work.strokes) / (work.strokes.len() as f64).sqrt();
        [Reduction::Mean.of(&work.strokes), error].map(|work| (bearing + journal) * work)
    }

    /// [m] Depth that one stroke wears off each sector of bearing and journal.
    pub fn depths(&self, clearance: f64, work: &Work) -> [Vec<f64>; 2] {
        let per_work = self.depth_per_work(clearance);
        [0, 1].map(|body| {
            let sectors = &work.bodies[body].work;
            let factor = per_work[body] * sectors.len() as f64 / work.strokes.len() as f64;
            sectors.iter().map(|work| factor * work).collect()
        })
    }

    /// Sliding work in a run, by strokes and sectors, of `turns` strokes after the first `transient` strokes.
    ///
    /// # Errors
    /// If the run is shorter, or has fewer than 100 communication points in a stroke.
    pub fn work(&self, trajectory: &Trajectory, transient: usize, turns: usize, sectors: usize) -> Result<Work> {
        let column = |name: &str| trajectory.column(&self.variable(name));
        let (x, y, contact, sum) =
            (column("eccentricity.x")?, column("eccentricity.y")?, column("contact")?, column("wear.work")?);
        let crank = trajectory.column("crank.angle")?;
        let still = vec![0.0; crank.len()];
        let [bearing, journal] = match self.letter {
            'A' => [&still, crank],
            'B' => [trajectory.column("rod.angle")?, crank],
            _ => [trajectory.column("rod.angle")?, trajectory.column("slider.angle")?],
        };
        let start = *crank.first().context("the run has no rows")?;
        let stroke = |row: usize| (crank[row] - start).abs() / TAU - transient as f64;
        let mut work = Work { strokes: vec![0.0; turns], bodies: [0, 1].map(|_| Sectors::new(sectors)) };
        let mut points = vec![0; turns];
        for row in 1..trajectory.len() {
            let (before, after) = (stroke(row - 1), stroke(row));
            let total = sum[row] - sum[row - 1];
            let angle = |row: usize| y[row].atan2(x[row]);
            let [first, last] = match [contact[row - 1], contact[row]].map(|closed| closed > 0.5) {
                [true, false] => [row - 1, row - 1],
                [false, true] => [row, row],
                _ => [row - 1, row],
            };
            let from = Place::of(angle(first), [bearing[row - 1], journal[row - 1]]);
            let to = Place::of(angle(last), [bearing[row], journal[row]]);
            // A step that ends in the next stroke is divided in proportion to the angle, its arc with it.
            let strokes = work.strokes.iter_mut().zip(&mut points).enumerate();
            for (number, (own_work, points)) in strokes.skip(before.max(0.0).floor() as usize) {
                let (low, high) = (before.max(number as f64), after.min(number as f64 + 1.0));
                if high <= low {
                    break;
                }
                let part = [low, high].map(|stroke| (stroke - before) / (after - before));
                let own = total * (part[1] - part[0]);
                *points += 1;
                *own_work += own;
                if own > 0.0 {
                    work.bodies[0].spread(own, [from.bearing, to.bearing], part);
                    work.bodies[1].spread(own, [from.journal, to.journal], part);
                }
            }
        }
        let least = points.iter().min().copied().unwrap_or_default();
        ensure!(least >= LEAST_POINTS, "a stroke has {least} communication points; it needs {LEAST_POINTS}");
        Ok(work)
    }
}

/// Least number of communication points in a stroke.
const LEAST_POINTS: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_are_one_or_two_positive_numbers() {
        let of = |text: &str| text.parse::<Coefficients>();
        assert_eq!(of("B=1e-16"), Ok(Coefficients { joint: 'B', values: [1e-16; 2] }));
        assert_eq!(of(" C = 1e-16, 3e-16"), Ok(Coefficients { joint: 'C', values: [1e-16, 3e-16] }));
        for wrong in ["B", "T=1e-16", "B=", "B=0", "B=-1e-16", "B=1,2,3", "B=inf", "AB=1"] {
            assert!(of(wrong).is_err(), "{wrong}");
        }
    }

    /// The derivative of the bearing's radius is its share of the growth, and both bodies wear with the same work.
    #[test]
    fn the_bearing_takes_its_share_of_the_growth() {
        for coefficients in [[1e-15, 3e-15], [2e-14, 1e-19], [1e-19, 2e-14]] {
            let joint = Wearing { letter: 'A', coefficients, radius: 0.01, clearance: 1e-4, width: 0.02 };
            assert_eq!(joint.radii(joint.clearance), [0.01, 0.01 - 1e-4]);
            let clearance = 1.5e-3;
            let [bearing, journal] = joint.radii(clearance);
            let [wide, narrow] = [1e-6, -1e-6].map(|change| joint.radii(clearance + change)[0]);
            let rates = [coefficients[0] / bearing, coefficients[1] / journal];
            let share = rates[0] / (rates[0] + rates[1]);
            assert!(((wide - narrow) / 2e-6 - share).abs() < 1e-7, "{coefficients:?}");
            let works = [
                (bearing * bearing - 1e-4) / coefficients[0],
                ((0.01f64 - 1e-4).powi(2) - journal * journal) / coefficients[1],
            ];
            // The smaller of the two radii hardly changes where its coefficient is five decades below the other.
            assert!((works[0] / works[1] - 1.0).abs() < 1e-6, "{coefficients:?}: {works:?}");
        }
    }
}
