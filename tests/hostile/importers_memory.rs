//! Memory for a call's arguments, as an importer has it.

use crate::invoke::{NULL, Word};
use std::any::Any;
use std::cell::RefCell;
use std::ffi::CString;

/// Arrays that live until they are forgotten.
#[derive(Default)]
pub struct ImportersMemory(RefCell<Vec<Held>>);

/// An array of the importer's.
struct Held {
    /// Keeps it.
    _entries: Box<dyn Any>,
    start: *const u8,
    length: usize,
}

impl ImportersMemory {
    /// Forgets all arrays.
    pub fn clear(&self) {
        self.0.borrow_mut().clear();
    }

    /// An array.
    pub fn array<T: Copy + 'static>(&self, entries: Vec<T>) -> Word {
        let mut entries = entries.into_boxed_slice();
        let (start, length) = (entries.as_mut_ptr().cast::<u8>(), size_of_val(&*entries));
        self.0.borrow_mut().push(Held { _entries: Box::new(entries), start, length });
        Word::Pointer(start.cast())
    }

    /// Text.
    pub fn text(&self, text: &[u8]) -> Word {
        self.array(CString::new(text).expect("no zero").into_bytes_with_nul())
    }

    /// Numbers from a place on.
    ///
    /// # Panics
    /// If they are not all in one of the arrays.
    pub fn numbers(&self, from: *const f64, count: usize) -> Vec<f64> {
        let (held, first) = (self.0.borrow(), from.addr());
        let within = |held: &&Held| {
            let start = held.start.addr();
            (start..start + held.length).contains(&first) && first + count * size_of::<f64>() <= start + held.length
        };
        assert!(held.iter().any(|held| within(&held)), "numbers that lie elsewhere");
        // SAFETY: within an array that is kept, of which any bytes are numbers.
        (0..count).map(|at| unsafe { from.add(at).read_unaligned() }).collect()
    }

    /// The bytes of all arrays.
    pub fn image(&self) -> Vec<u8> {
        let held = self.0.borrow();
        // SAFETY: the entries are kept, and they are numbers and pointers without padding.
        held.iter().flat_map(|held| unsafe { std::slice::from_raw_parts(held.start, held.length) }).copied().collect()
    }
}

/// Where no datum of more than a byte can lie.
pub fn odd(word: Word) -> Word {
    match word {
        Word::Pointer(pointer) => Word::Pointer(pointer.cast::<u8>().wrapping_add(1).cast()),
        _ => NULL,
    }
}
