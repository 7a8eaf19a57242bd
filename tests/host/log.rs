//! The importer's logger.

use slidercrank::fmi::v2::abi::types::*;
use std::ffi::{CStr, c_int, c_void};
use std::sync::Mutex;

/// A line that the logger got.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub instance: String,
    pub status: c_int,
    pub category: String,
    pub text: String,
}

/// Where the logger writes.
#[derive(Default)]
pub struct Log(Mutex<Vec<Line>>);

impl Log {
    /// All lines so far, which are then forgotten.
    pub fn take(&self) -> Vec<Line> {
        std::mem::take(&mut self.0.lock().expect("no panic in the logger"))
    }

    /// The only line since the last look.
    pub fn only(&self) -> Line {
        let lines = self.take();
        assert_eq!(lines.len(), 1, "{lines:?}");
        lines[0].clone()
    }

    /// Callbacks that write here; there is no memory management and no stepFinished.
    pub fn callbacks(&self) -> fmi2CallbackFunctions {
        fmi2CallbackFunctions {
            logger: Some(variadic(write)),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: (&raw const *self).cast_mut().cast(),
        }
    }
}

/// A logger that takes what is named and none of the variable arguments.
pub type Plain = unsafe extern "C" fn(*mut c_void, fmi2String, c_int, fmi2String, fmi2String);

/// A plain logger as the standard's type.
pub fn variadic(logger: Plain) -> fmi2CallbackLogger {
    // SAFETY: the calling convention passes named arguments alike; hosts with ctypes do the same.
    unsafe { std::mem::transmute::<Plain, fmi2CallbackLogger>(logger) }
}

unsafe extern "C" fn write(
    environment: *mut c_void,
    instance: fmi2String,
    status: c_int,
    category: fmi2String,
    message: fmi2String,
) {
    // SAFETY: the environment is the `Log` that `callbacks` was called on.
    let log = unsafe { &*environment.cast::<Log>() };
    // SAFETY: the slave passes strings.
    let texts = unsafe { [instance, category, message].map(|pointer| CStr::from_ptr(pointer)) };
    // Its name is what the importer made it.
    let instance = texts[0].to_string_lossy().into_owned();
    let [category, text] = [texts[1], texts[2]].map(|text| text.to_str().expect("UTF-8").to_owned());
    assert!(!text.contains(['%', '#', '\n']), "{text}");
    log.0.lock().expect("no panic in the logger").push(Line { instance, status, category, text });
}
