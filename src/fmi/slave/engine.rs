//! Engines compute motions: this library, or another build of it for newer processors.
//!
//! The slave holds settings, saved states and the log for every engine. An engine gets a whole scene and returns a run
//! of it, and a snapshot of a run has the same numbers for every engine. Therefore an engine is chosen whenever a
//! mechanism is assembled: after start values have changed, and when a state is restored.

use crate::integrator::MAX_STATES;
use crate::model::signals::{Inputs, Outputs};
use crate::scene::Scene;
use crate::simulation::step_map::{StepMap, StepRequest, step_map};
use crate::simulation::{ContactReport, Phase, Side, Simulation, SimulationError, Snapshot};

/// Assembles mechanisms.
pub trait Engine: Sync {
    /// As [`Simulation::start`].
    ///
    /// # Errors
    /// As there.
    fn start(&self, scene: &Scene, inputs: Inputs) -> Result<Box<dyn Run>, SimulationError>;

    /// As [`Simulation::restore`].
    ///
    /// # Errors
    /// As there.
    fn restore(&self, scene: &Scene, snapshot: &Snapshot) -> Result<Box<dyn Run>, SimulationError>;

    /// As [`step_map`].
    ///
    /// # Errors
    /// As there.
    fn step_map(
        &self,
        scene: &Scene,
        snapshot: &Snapshot,
        request: &StepRequest,
        outputs: &mut [Outputs],
    ) -> Result<StepMap, SimulationError>;
}

/// The points at which an advance may stop early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Stops {
    /// Nowhere.
    Nowhere,
    /// Where a contact closes or opens.
    Events,
    /// Where a step of the method ends, also at every event.
    Steps,
}

/// A mechanism at one communication point: the methods of a [`Simulation`] that a slave uses. Only `place` and `snapshot`
/// allocate.
pub trait Run: Send {
    /// [s] The communication point reached.
    fn time(&self) -> f64;
    /// As [`Simulation::set_inputs`].
    fn set_inputs(&mut self, inputs: Inputs, rates: Inputs);
    /// Advances to `time`, not before the time reached, or to the first stop before it. Returns whether a contact has
    /// closed or opened there. The trajectory does not depend on the stops.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`].
    fn advance(&mut self, time: f64, stops: Stops) -> Result<bool, SimulationError>;
    /// As [`Simulation::look`].
    fn look(&mut self, side: Side);
    /// As [`Simulation::outputs`].
    fn outputs(&mut self) -> Outputs;
    /// As [`Simulation::output_rates`].
    fn output_rates(&mut self) -> Outputs;
    /// As [`Simulation::output_sensitivity`].
    fn output_sensitivity(&mut self, seed: Inputs) -> Outputs;
    /// As [`Simulation::contacts`].
    fn contacts(&mut self) -> ContactReport;
    /// As [`Simulation::write_states`].
    fn write_states(&mut self, states: &mut [f64; MAX_STATES], rates: &mut [f64; MAX_STATES]) -> usize;
    /// As [`Simulation::place`].
    fn place(&mut self, phase: &Phase);
    /// As [`Simulation::snapshot`].
    fn snapshot(&self) -> Snapshot;
}

/// This library.
pub struct Own;

impl Engine for Own {
    fn start(&self, scene: &Scene, inputs: Inputs) -> Result<Box<dyn Run>, SimulationError> {
        Ok(Box::new(Simulation::start(scene, inputs)?))
    }

    fn restore(&self, scene: &Scene, snapshot: &Snapshot) -> Result<Box<dyn Run>, SimulationError> {
        Ok(Box::new(Simulation::restore(scene, snapshot)?))
    }

    fn step_map(
        &self,
        scene: &Scene,
        snapshot: &Snapshot,
        request: &StepRequest,
        outputs: &mut [Outputs],
    ) -> Result<StepMap, SimulationError> {
        step_map(scene, snapshot, request, outputs)
    }
}

impl Run for Simulation {
    fn time(&self) -> f64 {
        self.time()
    }

    fn set_inputs(&mut self, inputs: Inputs, rates: Inputs) {
        self.set_inputs(inputs, rates);
    }

    fn advance(&mut self, time: f64, stops: Stops) -> Result<bool, SimulationError> {
        match stops {
            Stops::Nowhere => self.advance_to(time).map(|()| false),
            Stops::Events => self.advance_to_event(time),
            Stops::Steps => self.advance_by_step(time),
        }
    }

    fn look(&mut self, side: Side) {
        self.look(side);
    }

    fn outputs(&mut self) -> Outputs {
        self.outputs()
    }

    fn output_rates(&mut self) -> Outputs {
        self.output_rates()
    }

    fn output_sensitivity(&mut self, seed: Inputs) -> Outputs {
        self.output_sensitivity(seed)
    }

    fn contacts(&mut self) -> ContactReport {
        self.contacts()
    }

    fn write_states(&mut self, states: &mut [f64; MAX_STATES], rates: &mut [f64; MAX_STATES]) -> usize {
        self.write_states(states, rates)
    }

    fn place(&mut self, phase: &Phase) {
        self.place(phase);
    }

    fn snapshot(&self) -> Snapshot {
        self.snapshot()
    }
}
