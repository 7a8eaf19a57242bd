//! Log lines to the importer: warnings and errors always, remarks on request.
//!
//! `loggingOn` and the selected categories control debug messages, as the standard requires. Warnings, discarded steps,
//! refusals and internal errors are sent to every importer: many importers do not check the status of a call and would
//! continue with unintended values. Success is not logged, so a run without problems is silent.

use super::severity::Severity;
use super::variables::LogCategory;
use std::ffi::{CStr, CString};
use std::fmt::{self, Display, Write as _};

/// Receives lines: the importer, through the callback of its version of FMI.
pub trait Host {
    /// Sends one line to the importer. Without a severity it is a remark about a successful call.
    fn log(&self, instance_name: &CStr, severity: Option<Severity>, category: &CStr, line: &CStr);
}

/// A host without a logger.
#[derive(Clone, Copy, Debug)]
pub struct Silent;

impl Host for Silent {
    fn log(&self, _: &CStr, _: Option<Severity>, _: &CStr, _: &CStr) {}
}

/// Selected category names that are not declared.
#[derive(Clone, Debug, PartialEq)]
pub struct UnknownCategories {
    first: String,
    others: usize,
}

impl UnknownCategories {
    fn among(categories: &[&CStr]) -> Option<Self> {
        let declared = |name: &CStr| LogCategory::ALL.iter().any(|known| known.name().as_bytes() == name.to_bytes());
        let mut unknown = categories.iter().filter(|name| !declared(name));
        let first = unknown.next()?.to_string_lossy().into_owned();
        Some(Self { first, others: unknown.count() })
    }
}

/// Whether the category of remarks is among the names.
fn chooses_remarks(categories: &[&CStr]) -> bool {
    let named = |category: LogCategory| categories.iter().any(|name| name.to_bytes() == category.name().as_bytes());
    categories.is_empty() || named(LogCategory::All) || named(LogCategory::Remark)
}

impl Display for UnknownCategories {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { first, others } = self;
        write!(f, "log category '{first}' is not declared and is ignored")?;
        if *others > 0 { write!(f, ", as are {others} others") } else { Ok(()) }
    }
}

/// The receiver of messages, and whether remarks are sent.
pub struct Logger {
    host: Box<dyn Host>,
    instance_name: CString,
    remarks: bool,
}

impl Logger {
    /// A logger for the instance of this name, with or without remarks.
    pub fn new(host: Box<dyn Host>, instance_name: CString, logging_on: bool) -> Self {
        Self { host, instance_name, remarks: logging_on }
    }

    /// Enables remarks if logging is on and their category, or no category, is named. Returns the names that are not
    /// declared, if there are any; the others count.
    pub fn enable(&mut self, logging_on: bool, categories: &[&CStr]) -> Option<UnknownCategories> {
        self.remarks = logging_on && chooses_remarks(categories);
        UnknownCategories::among(categories)
    }

    /// Switches the named categories on or off, or all of them if no category is named. Returns the names that are not
    /// declared, if there are any; the others count.
    pub fn switch(&mut self, on: bool, categories: &[&CStr]) -> Option<UnknownCategories> {
        if chooses_remarks(categories) {
            self.remarks = on;
        }
        UnknownCategories::among(categories)
    }

    /// Sends one line about a call to `function` with a warning or an error, whatever is enabled.
    pub fn say(&self, severity: Severity, function: &str, message: &dyn Display) {
        self.send(Some(severity), severity.category(), function, message);
    }

    /// Sends one line about a call to `function` that succeeded, if remarks are enabled.
    pub fn remark(&self, function: &str, message: &dyn Display) {
        if self.remarks {
            self.send(None, LogCategory::Remark, function, message);
        }
    }

    fn send(&self, severity: Option<Severity>, category: LogCategory, function: &str, message: &dyn Display) {
        let category = CString::new(category.name()).unwrap_or_default();
        self.host.log(&self.instance_name, severity, &category, &line(function, message));
    }
}

/// One line that `printf` does not change. `%` and `#` have a meaning in the standard, so they are escaped by their
/// codes, like control characters.
fn line(function: &str, message: &dyn Display) -> CString {
    let text = format!("{function}: {message}");
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '%' => safe.push_str("\\x25"),
            '#' => safe.push_str("\\x23"),
            control if control.is_control() => {
                // Writing to a String cannot fail.
                let _ = write!(safe, "{}", control.escape_default());
            }
            plain => safe.push(plain),
        }
    }
    CString::new(safe).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_no_format_and_no_control_characters() {
        let safe = line("step", &"50% of #r1#\nnext\0");
        assert_eq!(safe.as_c_str(), c"step: 50\\x25 of \\x23r1\\x23\\nnext\\u{0}");
    }
}
