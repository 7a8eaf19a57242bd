//! A saved state: plain numbers, and their versioned bytes.
//!
//! Layout of the bytes, little-endian: magic (8), format version (4), digest of the declaration of
//! variables (32), length of the content (4), content, CRC-32 of everything before it (4). Nothing in
//! them points anywhere, so another process can restore them, and every value is kept to the bit.

use super::error::FmuStateError;
use super::experiment::Experiment;
use super::inputs::InputLines;
use super::lifecycle::{Call, State};
use super::status::Status;
use crate::scene::Scene;
use crate::scene::parameter::{DECLARATION, PARAMETERS, Parameter};
use crate::simulation::Snapshot;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

const MAGIC: &[u8; 8] = b"SLCRANK\x1a";
/// To be raised with every change of [`FmuState`] or of what it holds.
const VERSION: u32 = 4;

/// Everything that an instance is, its name and its logging aside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FmuState {
    /// Where it is in its life.
    pub state: State,
    /// The scene as edited by the importer.
    pub scene: Scene,
    /// Times and tolerance.
    pub experiment: Experiment,
    /// Inputs.
    pub inputs: InputLines,
    /// Answer of the last step.
    pub last_step: Status,
    /// The simulation, once initialization is over.
    pub snapshot: Option<Snapshot>,
}

impl FmuState {
    /// The bytes.
    pub fn to_bytes(&self) -> Result<Vec<u8>, FmuStateError> {
        let content = postcard::to_allocvec(self).map_err(|_| FmuStateError::Content)?;
        let length = u32::try_from(content.len()).map_err(|_| FmuStateError::Content)?;
        let sealed = [&MAGIC[..], &VERSION.to_le_bytes(), &DECLARATION, &length.to_le_bytes(), &content].concat();
        let checksum = crc32fast::hash(&sealed).to_le_bytes();
        Ok([&sealed[..], &checksum].concat())
    }

    /// The state that these bytes tell of. Zeros after the end are tolerated: an importer's buffer
    /// may be longer than the state.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, FmuStateError> {
        let mut reader = Reader { rest: bytes };
        if reader.take(MAGIC.len()) != Ok(MAGIC) {
            return Err(FmuStateError::NotOurs);
        }
        let found = reader.number()?;
        if found != VERSION {
            return Err(FmuStateError::Version { found, known: VERSION });
        }
        let declaration = reader.take(DECLARATION.len())?;
        let length = reader.number()?;
        let content = reader.take(length as usize)?;
        let sealed = bytes.len() - reader.rest.len();
        let checksum = reader.number()?;
        if reader.rest.iter().any(|&byte| byte != 0) {
            return Err(FmuStateError::Length { expected: sealed + 4, given: bytes.len() });
        }
        if crc32fast::hash(&bytes[..sealed]) != checksum {
            return Err(FmuStateError::Checksum);
        }
        if declaration != DECLARATION {
            return Err(FmuStateError::Declaration);
        }
        let (state, rest) = postcard::take_from_bytes::<Self>(content).map_err(|_| FmuStateError::Content)?;
        if rest.is_empty() && state.makes_sense() { Ok(state) } else { Err(FmuStateError::Content) }
    }

    /// Whether an instance can be in this state: a snapshot belongs to it once initialization is over, and nothing in
    /// it is what an importer cannot set. The snapshot is looked at when it is restored.
    fn makes_sense(&self) -> bool {
        let before = matches!(self.state, State::Instantiated | State::InitializationMode);
        let in_range = |parameter: &Parameter| parameter.admit(parameter.value(&self.scene)).is_ok();
        Call::GetFMUstate.allowed(self.state)
            && before == self.snapshot.is_none()
            && PARAMETERS.iter().all(in_range)
            && self.experiment.is_sound()
            && self.inputs.are_finite()
    }
}

/// Takes bytes from the front.
struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8], FmuStateError> {
        let cut = FmuStateError::Length { expected: length, given: self.rest.len() };
        let (taken, rest) = self.rest.split_at_checked(length).ok_or(cut)?;
        self.rest = rest;
        Ok(taken)
    }

    fn number(&mut self) -> Result<u32, FmuStateError> {
        let mut bytes = [0; 4];
        bytes.copy_from_slice(self.take(4)?);
        Ok(u32::from_le_bytes(bytes))
    }
}

/// The saved states of one instance. The importer holds their addresses, which are looked up and
/// never followed: a made-up or freed one is refused.
#[derive(Default)]
pub struct SavedStates {
    states: BTreeMap<usize, Box<FmuState>>,
}

impl SavedStates {
    /// Keeps a state in the place of `handle`, or in a new place if that is 0.
    pub fn keep(&mut self, handle: usize, state: FmuState) -> Result<usize, FmuStateError> {
        if handle != 0 {
            **self.states.get_mut(&handle).ok_or(FmuStateError::Foreign)? = state;
            return Ok(handle);
        }
        let state = Box::new(state);
        let handle = (&raw const *state).addr();
        self.states.insert(handle, state);
        Ok(handle)
    }

    /// The state kept under `handle`.
    pub fn get(&self, handle: usize) -> Result<&FmuState, FmuStateError> {
        match self.states.get(&handle) {
            Some(state) => Ok(state),
            None if handle == 0 => Err(FmuStateError::Null),
            None => Err(FmuStateError::Foreign),
        }
    }

    /// Forgets a state; 0 stands for none.
    pub fn forget(&mut self, handle: usize) -> Result<(), FmuStateError> {
        match (handle, self.states.remove(&handle)) {
            (0, _) | (_, Some(_)) => Ok(()),
            (_, None) => Err(FmuStateError::Foreign),
        }
    }
}
