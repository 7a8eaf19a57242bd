//! Saving, restoring and serializing the whole instance.

use super::super::error::{Error, FmuStateError};
use super::super::fmu_state::FmuState;
use super::super::lifecycle::Touch;
use super::{Instance, asked_for};
use crate::simulation::Simulation;

impl Instance {
    /// `fmi2GetFMUstate`: saves under `handle`, or under a new one if that is 0.
    pub fn get_fmu_state(&mut self, handle: usize) -> Result<usize, Error> {
        // While parameters can still change, the simulation is no more than a reading of the scene.
        let running = if Touch::SetParameter.allowed(self.state) { None } else { self.simulation.as_ref() };
        let state = FmuState {
            state: self.state,
            scene: self.scene.clone(),
            experiment: self.experiment,
            inputs: self.inputs,
            last_step: self.last_step,
            snapshot: running.map(Simulation::snapshot),
        };
        Ok(self.saved.keep(handle, state)?)
    }

    /// `fmi2SetFMUstate`
    pub fn set_fmu_state(&mut self, handle: usize) -> Result<(), Error> {
        let saved = self.saved.get(handle)?;
        // The only part that can fail comes first.
        self.simulation = match &saved.snapshot {
            None => None,
            Some(snapshot) => {
                let scene = asked_for(&saved.scene, &saved.experiment)?;
                Some(Simulation::restore(&scene, snapshot)?)
            }
        };
        self.outputs = None;
        self.state = saved.state;
        self.scene = saved.scene.clone();
        self.experiment = saved.experiment;
        self.inputs = saved.inputs;
        self.last_step = saved.last_step;
        Ok(())
    }

    /// `fmi2FreeFMUstate`; 0 stands for no state.
    pub fn free_fmu_state(&mut self, handle: usize) -> Result<(), Error> {
        Ok(self.saved.forget(handle)?)
    }

    /// `fmi2SerializedFMUstateSize`
    pub fn serialized_size(&self, handle: usize) -> Result<usize, Error> {
        Ok(self.saved.get(handle)?.to_bytes()?.len())
    }

    /// `fmi2SerializeFMUstate`. The rest of a longer buffer becomes 0.
    pub fn serialize(&self, handle: usize, buffer: &mut [u8]) -> Result<(), Error> {
        let bytes = self.saved.get(handle)?.to_bytes()?;
        let (given, needed) = (buffer.len(), bytes.len());
        let (front, rest) = buffer.split_at_mut_checked(needed).ok_or(FmuStateError::Buffer { given, needed })?;
        front.copy_from_slice(&bytes);
        rest.fill(0);
        Ok(())
    }

    /// `fmi2DeSerializeFMUstate`: keeps under `handle`, or under a new one if that is 0.
    pub fn deserialize(&mut self, bytes: &[u8], handle: usize) -> Result<usize, Error> {
        Ok(self.saved.keep(handle, FmuState::from_bytes(bytes)?)?)
    }
}
