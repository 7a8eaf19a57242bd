//! The saved states of one slave, under the handles that the importer holds.

use super::error::SavedStateError;
use std::collections::BTreeMap;

/// The saved states of one slave. The importer holds their addresses, which are looked up and never
/// followed: a made-up or freed one is refused.
pub struct SavedStates<T> {
    states: BTreeMap<usize, Box<T>>,
}

impl<T> Default for SavedStates<T> {
    fn default() -> Self {
        Self { states: BTreeMap::new() }
    }
}

impl<T> SavedStates<T> {
    /// Keeps a state in the place of `handle`, or in a new place if that is 0; its handle. `T` must
    /// not be of size zero, or addresses would coincide.
    pub fn keep(&mut self, handle: usize, state: T) -> Result<usize, SavedStateError> {
        const { assert!(size_of::<T>() > 0, "a state has an address of its own") };
        if handle != 0 {
            **self.states.get_mut(&handle).ok_or(SavedStateError::Foreign)? = state;
            return Ok(handle);
        }
        let state = Box::new(state);
        let handle = (&raw const *state).addr();
        self.states.insert(handle, state);
        Ok(handle)
    }

    /// The state kept under `handle`.
    pub fn get(&self, handle: usize) -> Result<&T, SavedStateError> {
        match self.states.get(&handle) {
            Some(state) => Ok(state),
            None if handle == 0 => Err(SavedStateError::Null),
            None => Err(SavedStateError::Foreign),
        }
    }

    /// Forgets a state; 0 stands for no state.
    pub fn forget(&mut self, handle: usize) -> Result<(), SavedStateError> {
        match (handle, self.states.remove(&handle)) {
            (0, _) | (_, Some(_)) => Ok(()),
            (_, None) => Err(SavedStateError::Foreign),
        }
    }
}
