//! What an FMU says.

use super::library::Status;
use std::sync::Mutex;

/// One message.
#[derive(Clone, Debug)]
pub struct LogLine {
    /// How bad it is.
    pub status: Status,
    /// One of the categories that the FMU declares.
    pub category: String,
    /// As sent.
    pub message: String,
}

/// Keeps the last line for error messages and passes every line on.
pub struct Log {
    last: Mutex<Option<String>>,
    forward: Box<dyn Fn(&LogLine) + Send + Sync>,
}

impl Log {
    /// A log that hands every line to `forward`.
    pub fn new(forward: impl Fn(&LogLine) + Send + Sync + 'static) -> Self {
        Self { last: Mutex::new(None), forward: Box::new(forward) }
    }

    /// Takes a line in.
    pub fn receive(&self, line: LogLine) {
        (self.forward)(&line);
        *self.last.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(line.message);
    }

    /// The last line's message.
    pub fn last(&self) -> Option<String> {
        self.last.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
    }
}
