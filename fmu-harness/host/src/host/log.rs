//! Log messages of an FMU.

use super::library::Status;
use std::sync::Mutex;

/// One message.
#[derive(Clone, Debug)]
pub struct LogLine {
    /// Its severity.
    pub status: Status,
    /// One of the categories that the FMU declares.
    pub category: String,
    /// The text, as the FMU sent it.
    pub message: String,
}

/// Forwards every line, and keeps the last one for error messages.
pub struct Log {
    last: Mutex<Option<String>>,
    forward: Box<dyn Fn(&LogLine) + Send + Sync>,
}

impl Log {
    /// A log that passes every line to `forward`.
    pub fn new(forward: impl Fn(&LogLine) + Send + Sync + 'static) -> Self {
        Self { last: Mutex::new(None), forward: Box::new(forward) }
    }

    /// Receives a line.
    pub fn receive(&self, line: LogLine) {
        (self.forward)(&line);
        *self.last.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(line.message);
    }

    /// Message of the last line.
    pub fn last(&self) -> Option<String> {
        self.last.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
    }
}
