//! What goes into an FMU while time runs: each input as a curve against time or crank angle.

use crate::trajectory::Trajectory;
use anyhow::{Result, ensure};

/// What a curve is drawn against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// [s]
    Time,
    /// [rad] `crank.angle`, whose curve repeats every turn.
    CrankAngle,
}

/// One input: straight lines between points, level before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    name: String,
    against: Against,
    points: Vec<(f64, f64)>,
}

impl Curve {
    /// A curve through `points`, whose abscissas do not fall; two alike make a jump.
    pub fn new(name: impl Into<String>, against: Against, points: Vec<(f64, f64)>) -> Result<Self> {
        let name = name.into();
        ensure!(!points.is_empty(), "input `{name}`: no points");
        ensure!(points.is_sorted_by(|a, b| a.0 <= b.0), "input `{name}`: its points do not go forwards");
        Ok(Self { name, against, points })
    }

    /// The input variable.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether it needs the crank's angle.
    pub fn against(&self) -> Against {
        self.against
    }

    /// Its value at `time` [s] and crank `angle` [rad].
    pub fn value(&self, time: f64, angle: f64) -> f64 {
        match self.against {
            Against::Time => self.interpolate(time),
            Against::CrankAngle => self.interpolate(angle.rem_euclid(std::f64::consts::TAU)),
        }
    }

    /// At a jump, the value after it.
    fn interpolate(&self, x: f64) -> f64 {
        let after = self.points.partition_point(|point| point.0 <= x);
        match (after.checked_sub(1).map(|before| self.points[before]), self.points.get(after)) {
            (Some((x0, y0)), Some((x1, y1))) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
            (Some((_, level)), None) => level,
            (None, Some((_, level))) => *level,
            (None, None) => 0.0,
        }
    }
}

/// The columns of a CSV as curves against time.
pub fn curves(table: &Trajectory) -> Result<Vec<Curve>> {
    let curve = |name: &String| {
        let points = table.times().iter().copied().zip(table.column(name)?.iter().copied()).collect();
        Curve::new(name, Against::Time, points)
    };
    table.names().iter().map(curve).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_straight_between_points_level_outside_and_later_at_a_jump() {
        let points = vec![(0.0, 1.0), (2.0, 5.0), (2.0, 7.0), (3.0, 7.5)];
        let curve = Curve::new("slider.load", Against::Time, points).expect("a curve");
        let values = [-1.0, 0.0, 0.5, 2.0, 2.5, 9.0].map(|time| curve.value(time, f64::NAN));
        assert_eq!(values, [1.0, 1.0, 2.0, 7.0, 7.25, 7.5]);
    }

    #[test]
    fn a_curve_against_the_crank_angle_repeats_every_turn() {
        let curve = Curve::new("slider.load", Against::CrankAngle, vec![(1.0, 0.0), (2.0, 8.0)]).expect("a curve");
        assert_eq!(curve.value(0.0, 1.5), 4.0);
        assert!((curve.value(0.0, 1.5 + 4.0 * std::f64::consts::PI) - 4.0).abs() < 8.0 * 16.0 * f64::EPSILON);
    }
}
