//! Points of phase space: where a motion is, to be compared, perturbed and started from.

use super::{Simulation, SimulationError};

/// All that decides how a motion goes on under given inputs.
///
/// A contact's approach speed belongs to it: two motions through the same states with other approach speeds part, since
/// the damping of a lasting contact remembers how it closed. An audit's sums do not.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// [s]
    pub time: f64,
    /// Positions, their rates, bristles.
    pub states: Vec<f64>,
    /// [m/s] Approach speeds of the closed contacts; `None` of an open one.
    pub approach: Vec<Option<f64>>,
}

/// What size of difference is noticeable in a [`Phase`].
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseScales {
    /// Of the states.
    pub states: Vec<f64>,
    /// [m/s] Of approach speeds.
    pub approach: f64,
}

impl Simulation {
    /// The point of phase space at the communication point. A step that goes beyond is cut there, so that the point is as
    /// accurate as the steps are and not as what is interpolated between them; later steps are others than without a look.
    pub fn phase(&mut self) -> Phase {
        self.motion.phase(self.time)
    }

    /// Goes on from `phase`: one of a simulation with the same joints, drive and method, or near one. Inputs stay.
    pub fn place(&mut self, phase: &Phase) {
        self.motion.place(phase);
        self.time = phase.time;
    }

    /// What size of difference is noticeable.
    pub fn phase_scales(&self) -> PhaseScales {
        self.motion.phase_scales()
    }

    /// Moves to the next closing or opening of a contact, or to `time` (≥ the time reached), and tells whether there
    /// was one.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`].
    pub fn advance_to_event(&mut self, time: f64) -> Result<bool, SimulationError> {
        match self.motion.advance_to_event(self.time, time) {
            Ok(event) => {
                self.time = event.unwrap_or(time);
                Ok(event.is_some())
            }
            Err(error) => Err(self.failed(error)),
        }
    }
}
