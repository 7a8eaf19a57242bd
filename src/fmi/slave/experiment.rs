//! Times and tolerance of the importer's experiment, and the end of a step.

use super::error::TimeError;
use crate::scene::parameter::{Kind, Parameter};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Times and tolerance that the importer defined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Experiment {
    /// [s] Start time.
    pub start: f64,
    /// [s] No step may end later, if defined.
    pub stop: Option<f64>,
    /// Relative tolerance, if defined; it takes precedence over the scene's, unless the importer has set that, too.
    pub tolerance: Option<f64>,
}

/// Two times are the same communication point if they differ by less than this share of the step …
const PART_OF_STEP: f64 = 1e-9;
/// … or of the time since the start. The times of importers that add steps, multiply them, or read them from text
/// differ by about 1e-13 (measured: `fmuCheck` sends h = 0.0099999999999993).
const PART_OF_TIME: f64 = 1e-12;

impl Experiment {
    /// An experiment from an importer's arguments.
    pub fn new(tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Result<Self, TimeError> {
        finite("startTime", start)?;
        if let Some(stop) = stop {
            finite("stopTime", stop)?;
            if stop < start {
                return Err(TimeError::StopBeforeStart { start, stop });
            }
        }
        if let Some(tolerance) = tolerance {
            positive("tolerance", tolerance)?;
        }
        Ok(Self { start, stop, tolerance })
    }

    /// The experiment with the nearest tolerance that the solver accepts.
    pub fn limited(self) -> Self {
        let nearest = |tolerance: f64| match Parameter::named("solver.tolerance").map(|parameter| &parameter.kind) {
            Some(Kind::Real { min, max, .. }) => tolerance.clamp(*min, *max),
            _ => tolerance,
        };
        Self { tolerance: self.tolerance.map(nearest), ..self }
    }

    /// Whether an importer could have set it.
    pub fn is_sound(&self) -> bool {
        Self::new(self.tolerance, self.start, self.stop).map(Self::limited) == Ok(*self)
    }

    /// [s] Where a step of `size` from the importer's `point` ends, for an instance at `reached`; `reached` and the end
    /// are counted from the start.
    ///
    /// The standard's step hc_s = (tc_i − tc_s) + hc_i from tc_s ends at the importer's next point, so that rounding
    /// errors do not add up. The difference of the importer's point and start time is exact if they are near each
    /// other; so a run has the same bits from any start time, except for rounding in the importer's own sums.
    pub fn step_end(&self, reached: f64, point: f64, size: f64) -> Result<f64, TimeError> {
        finite("currentCommunicationPoint", point)?;
        positive("communicationStepSize", size)?;
        let elapsed = point - self.start;
        if (elapsed - reached).abs() > slack(size, elapsed, reached) + self.rounding(point) {
            return Err(TimeError::Elsewhere { given: point, reached: self.start + reached });
        }
        let end = point + size;
        finite("the end of the step", end)?;
        match self.stop {
            Some(stop) if end - stop > slack(size, elapsed + size, stop - self.start) + self.rounding(end) => {
                Err(TimeError::PastStop { end, stop })
            }
            // A step smaller than the rounding error of time must not end before its start.
            _ => Ok((elapsed + size).max(reached)),
        }
    }

    /// [s] Largest rounding error of an importer's sums up to the time `t`.
    fn rounding(&self, t: f64) -> f64 {
        4.0 * f64::EPSILON * t.abs().max(self.start.abs())
    }
}

/// A tolerance outside the solver's range, and the tolerance that is used instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    asked: f64,
    granted: f64,
}

impl Limit {
    /// The limited tolerance, if it was limited.
    pub fn between(asked: &Experiment, granted: &Experiment) -> Option<Self> {
        let (asked, granted) = (asked.tolerance?, granted.tolerance?);
        (asked != granted).then_some(Self { asked, granted })
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { asked, granted } = self;
        write!(f, "tolerance {asked:?} is beyond the solver's range; {granted:?} is used")
    }
}

/// A tolerance of the experiment that is not used, and the tolerance that the importer has set as a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftAside {
    experiment: f64,
    used: f64,
}

impl LeftAside {
    /// The experiment's tolerance, if there is one and another one is used.
    pub fn between(experiment: &Experiment, used: f64) -> Option<Self> {
        let experiment = experiment.tolerance?;
        (experiment != used).then_some(Self { experiment, used })
    }
}

impl fmt::Display for LeftAside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { experiment, used } = self;
        write!(f, "the experiment's tolerance {experiment:?} is left aside, since solver.tolerance = {used:?} was set")
    }
}

/// [s] Difference up to which two times `a` and `b` are the same, seen from a step of `size`.
fn slack(size: f64, a: f64, b: f64) -> f64 {
    (PART_OF_STEP * size).max(PART_OF_TIME * a.abs().max(b.abs()))
}

fn finite(name: &'static str, value: f64) -> Result<(), TimeError> {
    if value.is_finite() { Ok(()) } else { Err(TimeError::NotFinite(name, value)) }
}

fn positive(name: &'static str, value: f64) -> Result<(), TimeError> {
    finite(name, value)?;
    if value > 0.0 { Ok(()) } else { Err(TimeError::NotPositive(name, value)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FROM_TWO_TO_THREE: Experiment = Experiment { start: 2.0, stop: Some(3.0), tolerance: None };

    #[test]
    fn a_step_ends_at_the_importers_next_point() {
        let end = FROM_TWO_TO_THREE.step_end(2.1 - 2.0, 2.1_f64.next_up(), 0.1);
        assert_eq!(end, Ok(2.1_f64.next_up() - 2.0 + 0.1));
    }

    #[test]
    fn the_last_step_may_overshoot_by_rounding_only() {
        assert!(FROM_TWO_TO_THREE.step_end(2.9 - 2.0, 2.9, 3.0_f64.next_up() - 2.9).is_ok());
        assert_eq!(
            FROM_TWO_TO_THREE.step_end(2.9 - 2.0, 2.9, 0.2),
            Err(TimeError::PastStop { end: 2.9 + 0.2, stop: 3.0 })
        );
    }

    #[test]
    fn a_step_below_rounding_does_not_move_time() {
        assert_eq!(FROM_TWO_TO_THREE.step_end(0.5, 2.5, 1e-30), Ok(0.5));
        assert_eq!(FROM_TWO_TO_THREE.step_end(0.5, 2.5_f64.next_down(), 1e-30), Ok(0.5));
    }

    #[test]
    fn a_run_may_start_at_an_epoch() {
        let start = 1.7e9;
        let experiment = Experiment { start, stop: None, tolerance: None };
        let (mut point, mut reached) = (start, 0.0);
        for step in 1..=1000 {
            reached = experiment.step_end(reached, point, 1e-5).expect("a step");
            point += 1e-5;
            assert!((reached - f64::from(step) * 1e-5).abs() < f64::from(step) * 2e-8, "{reached}");
        }
        assert!(experiment.step_end(reached, point + 1e-5, 1e-5).is_err(), "a step that skips another");
    }
}
