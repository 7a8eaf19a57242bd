//! The saved states of one slave, with the handles of the importer.

use super::error::SavedStateError;
use super::sealed;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

/// The saved state of an instance, in a version of FMI.
pub trait Saved: Serialize + DeserializeOwned {
    /// Version of the bytes' format. It must be increased with every change of the type or of its contents.
    const FORMAT: u32;

    /// Whether an instance could be in this state. Its snapshot is checked when it is restored.
    fn makes_sense(&self) -> bool;

    /// The bytes.
    fn to_bytes(&self) -> Result<Vec<u8>, SavedStateError> {
        sealed::seal(Self::FORMAT, self)
    }

    /// The state in these bytes.
    fn from_bytes(bytes: &[u8]) -> Result<Self, SavedStateError> {
        let state: Self = sealed::open(Self::FORMAT, bytes)?;
        if state.makes_sense() { Ok(state) } else { Err(SavedStateError::Content) }
    }
}

/// The saved states of one slave. The importer has their addresses as handles. A handle is searched in a list and never
/// dereferenced, so an invented or freed handle is refused.
pub struct SavedStates<T> {
    states: BTreeMap<usize, Box<T>>,
}

impl<T> Default for SavedStates<T> {
    fn default() -> Self {
        Self { states: BTreeMap::new() }
    }
}

impl<T> SavedStates<T> {
    /// Stores a state under `handle`, or under a new handle if that is 0, and returns the handle. The size of `T` must
    /// not be 0, or addresses would coincide.
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

    /// The state with this handle.
    pub fn get(&self, handle: usize) -> Result<&T, SavedStateError> {
        match self.states.get(&handle) {
            Some(state) => Ok(state),
            None if handle == 0 => Err(SavedStateError::Null),
            None => Err(SavedStateError::Foreign),
        }
    }

    /// Removes a state; handle 0 means no state.
    pub fn forget(&mut self, handle: usize) -> Result<(), SavedStateError> {
        match (handle, self.states.remove(&handle)) {
            (0, _) | (_, Some(_)) => Ok(()),
            (_, None) => Err(SavedStateError::Foreign),
        }
    }
}

impl<T: Saved> SavedStates<T> {
    /// Number of bytes of the state with this handle.
    pub fn serialized_size(&self, handle: usize) -> Result<usize, SavedStateError> {
        Ok(self.get(handle)?.to_bytes()?.len())
    }

    /// Writes the bytes of the state with this handle. The rest of a longer buffer is filled with 0.
    pub fn serialize(&self, handle: usize, buffer: &mut [u8]) -> Result<(), SavedStateError> {
        let bytes = self.get(handle)?.to_bytes()?;
        let (given, needed) = (buffer.len(), bytes.len());
        let (front, rest) = buffer.split_at_mut_checked(needed).ok_or(SavedStateError::Buffer { given, needed })?;
        front.copy_from_slice(&bytes);
        rest.fill(0);
        Ok(())
    }
}
