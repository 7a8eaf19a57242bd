//! What commands say.

use std::fmt::Display;
use std::io::{ErrorKind, Write, stderr, stdout};

/// Prints a line. A reader may have gone away, as `head` does: the command goes on without it, and writes its files. Any
/// other error is reported.
pub fn say(text: impl Display) {
    if let Err(error) = writeln!(stdout(), "{text}")
        && error.kind() != ErrorKind::BrokenPipe
    {
        let _ = writeln!(stderr(), "warning: cannot write to the standard output: {error}");
    }
}
