//! Handles of saved states, and their bytes.

use super::{Argument, HUGE, array, bad, good};
use crate::importers_memory::{ImportersMemory, odd};
use crate::invoke::{NULL, Word};
use std::ffi::c_void;
use std::ptr::{null_mut, without_provenance_mut};

/// Bytes beyond the state in a buffer.
const SPARE: usize = 16;

/// Handles that an importer may pass.
pub struct Handles {
    /// What the version calls a handle.
    pub name: &'static str,
    /// A saved state of the instance, …
    pub saved: *mut c_void,
    /// … its bytes, …
    pub bytes: Vec<u8>,
    /// … one that was freed, …
    pub stale: *mut c_void,
    /// … and one of another instance.
    pub theirs: *mut c_void,
    pub instance: *mut c_void,
}

impl Handles {
    fn unknown(&self) -> [*mut c_void; 4] {
        [self.theirs, without_provenance_mut(0x1234), self.instance, self.stale]
    }

    /// A saved state by value.
    pub fn state(&self) -> Argument {
        let unknown = self.unknown().into_iter().chain([null_mut()]).map(|state| bad(Word::Pointer(state), "FMUstate"));
        std::iter::once(good(Word::Pointer(self.saved))).chain(unknown).collect::<Vec<_>>().into()
    }

    /// A place that holds a saved state or, mostly, NULL.
    pub fn place(&self, memory: &ImportersMemory, or_none: bool) -> Argument {
        let (name, place) = (self.name, |state| memory.array(vec![state]));
        let no_place = if or_none { good(NULL) } else { bad(NULL, format!("'{name}' is NULL")) };
        let mut values = vec![good(place(null_mut())), good(place(self.saved)), no_place];
        values.push(bad(odd(place(null_mut())), format!("'{name}' is not aligned")));
        values.extend(self.unknown().map(|state| bad(place(state), "FMUstate")));
        values.into()
    }

    pub fn serialize(&self, memory: &ImportersMemory) -> Vec<Argument> {
        let length = self.bytes.len();
        let needed = format!("needs {length}");
        let mut sizes = vec![good(Word::Size(length)), good(Word::Size(length + SPARE))];
        sizes.extend([0, 1, length - 1].map(|size| bad(Word::Size(size), needed.clone())));
        sizes.extend(HUGE.map(|size| bad(Word::Size(size), "elements")));
        let bytes = array(memory, "serializedState", vec![0_u8; length + SPARE], vec![]);
        vec![self.state(), bytes.counted_by(3), sizes.into()]
    }

    pub fn deserialize(&self, memory: &ImportersMemory) -> Vec<Argument> {
        let with = |change: fn(&mut Vec<u8>)| {
            let mut bytes = [&self.bytes[..], &[0; SPARE]].concat();
            change(&mut bytes);
            bytes
        };
        let damaged = vec![
            (with(|bytes| bytes[0] ^= 1), "not a state of this FMU"),
            (with(|bytes| bytes[8] ^= 1), "format version"),
            (with(|bytes| bytes[100] ^= 1), "checksum"),
        ];
        let length = self.bytes.len();
        let mut sizes = vec![good(Word::Size(length)), good(Word::Size(length + SPARE))];
        sizes.extend([10, 50, length - 1].map(|size| bad(Word::Size(size), "instead of")));
        sizes.extend([0, 7].map(|size| bad(Word::Size(size), "not a state of this FMU")));
        sizes.extend(HUGE.map(|size| bad(Word::Size(size), "elements")));
        let bytes = array(memory, "serializedState", with(|_| ()), damaged);
        vec![bytes.counted_by(2), sizes.into(), self.place(memory, false)]
    }
}
