//! Inputs of a scene: constant, or piecewise linear over time or over the crank angle. The FMU does not contain them; a
//! harness evaluates them and sets the FMU's inputs.

use std::f64::consts::TAU;

/// The inputs of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profiles {
    /// [N·m] Profile of `crank.torque`.
    pub crank_torque: Profile,
    /// [N] Profile of `slider.load`.
    pub slider_load: Profile,
}

/// One input as a function of time or crank angle.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// A constant.
    Constant(f64),
    /// Piecewise linear between points.
    Points {
        /// The argument of the points.
        against: ProfileArgument,
        /// Argument ([s], or [rad] in 0 ..= 2π) and value, in ascending order of the argument. Over time, the first and
        /// last values hold outside the points; over the crank angle, the profile is periodic.
        points: Vec<[f64; 2]>,
    },
}

/// The argument of a profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProfileArgument {
    /// Time.
    Time,
    /// Crank angle, with the period of one turn.
    CrankAngle,
}

impl ProfileArgument {
    /// Names in scene files, with the arguments.
    pub const ITEMS: [(&str, Self); 2] = [("time", Self::Time), ("crank.angle", Self::CrankAngle)];

    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::CrankAngle => "crank.angle",
        }
    }

    /// SI unit of the argument.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::CrankAngle => "rad",
        }
    }
}

/// A straight line over a communication step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord {
    /// Value at the start of the step.
    pub value: f64,
    /// [1/s] Slope.
    pub slope: f64,
}

impl Default for Profile {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

impl Profile {
    /// Value at a time [s] and a crank angle [rad].
    pub fn value(&self, time: f64, crank_angle: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Points { .. } => {
                let (at, [from, to]) = self.segment(time, crank_angle);
                from[1] + slope(from, to) * (at - from[0])
            }
        }
    }

    /// The chord over a step between two times [s], at whose start the crank has an angle [rad] and a speed [rad/s], at
    /// which it turns on. Between equal values its slope is exactly 0.
    pub fn chord(&self, [from, to]: [f64; 2], crank_angle: f64, crank_speed: f64) -> Chord {
        let (value, step) = (self.value(from, crank_angle), to - from);
        Chord { value, slope: (self.value(to, crank_angle + crank_speed * step) - value) / step }
    }

    /// [1/rad] Slope over the crank angle at an angle [rad]; at a point, that of the segment behind it. 0 over time.
    pub fn slope_over_angle(&self, crank_angle: f64) -> f64 {
        match self {
            Self::Points { against: ProfileArgument::CrankAngle, .. } => {
                let (_, [from, to]) = self.segment(0.0, crank_angle);
                slope(from, to)
            }
            _ => 0.0,
        }
    }

    /// The argument, and the ends of the segment that contains it; a segment of constant value has equal ends.
    fn segment(&self, time: f64, crank_angle: f64) -> (f64, [[f64; 2]; 2]) {
        let Self::Points { against, points } = self else {
            return (0.0, [[0.0; 2]; 2]);
        };
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return (0.0, [[0.0; 2]; 2]);
        };
        let at = match against {
            ProfileArgument::Time => time,
            ProfileArgument::CrankAngle => crank_angle.rem_euclid(TAU),
        };
        let next = points.partition_point(|point| point[0] <= at);
        let ends = match (next, against) {
            (0, ProfileArgument::Time) => [*first, *first],
            (0, ProfileArgument::CrankAngle) => [[last[0] - TAU, last[1]], *first],
            (n, ProfileArgument::Time) if n == points.len() => [*last, *last],
            (n, ProfileArgument::CrankAngle) if n == points.len() => [*last, [first[0] + TAU, first[1]]],
            (n, _) => [points[n - 1], points[n]],
        };
        (at, ends)
    }
}

fn slope(from: [f64; 2], to: [f64; 2]) -> f64 {
    if from[0] < to[0] { (to[1] - from[1]) / (to[0] - from[0]) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(against: ProfileArgument) -> Profile {
        Profile::Points { against, points: vec![[1.0, 10.0], [3.0, 30.0], [4.0, 0.0]] }
    }

    #[test]
    fn over_time_the_ends_hold() {
        let profile = over(ProfileArgument::Time);
        let values = [0.0, 1.0, 2.0, 3.0, 3.5, 4.0, 9.0].map(|time| profile.value(time, 0.0));
        assert_eq!(values, [10.0, 10.0, 20.0, 30.0, 15.0, 0.0, 0.0]);
        assert_eq!(profile.slope_over_angle(2.0), 0.0);
    }

    #[test]
    fn over_the_crank_angle_the_turn_repeats() {
        let profile = over(ProfileArgument::CrankAngle);
        for turns in [-2.0, 0.0, 5.0] {
            let value = |angle: f64| profile.value(0.0, angle + turns * TAU);
            // Rounding of the wrapped angle, at most a few ulp of 2π·5, times the steepest slope.
            let near = |found: f64, wanted: f64| (found - wanted).abs() < 30.0 * 32.0 * f64::EPSILON;
            assert!(near(value(2.0), 20.0));
            assert!(near(value(3.5), 15.0));
            // From 0 at 4 rad to 10 at 2π + 1 rad.
            let middle = (4.0 + TAU + 1.0) / 2.0;
            assert!(near(value(middle), 5.0));
        }
        let slopes = [2.0, 3.0, 2.0 - TAU].map(|angle| profile.slope_over_angle(angle));
        assert_eq!(slopes, [10.0, -30.0, 10.0]);
    }

    #[test]
    fn a_chord_joins_the_values_at_both_ends_of_a_step() {
        let [time, angle] = [ProfileArgument::Time, ProfileArgument::CrankAngle].map(over);
        // Past the corner at 3, where the tangent would end at 35.
        assert_eq!(time.chord([2.5, 3.5], 0.0, 9.0), Chord { value: 25.0, slope: -10.0 });
        assert_eq!(angle.chord([7.0, 7.5], 2.5, 2.0), Chord { value: 25.0, slope: -20.0 });
        // Backwards, and level.
        assert_eq!(angle.chord([7.0, 7.5], 3.5, -2.0), Chord { value: 15.0, slope: 20.0 });
        assert_eq!(time.chord([5.0, 6.0], 0.0, 9.0), Chord { value: 0.0, slope: 0.0 });
        assert_eq!(angle.chord([0.0, 0.3], 2.0, 0.0), Chord { value: 20.0, slope: 0.0 });
        assert_eq!(Profile::Constant(0.1).chord([0.0, 0.3], 2.0, 5.0), Chord { value: 0.1, slope: 0.0 });
    }
}
