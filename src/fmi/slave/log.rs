//! One line to the importer: always where a call did not simply succeed, on request otherwise.
//!
//! `loggingOn` and the choice of categories rule what helps in debugging, as the standard has it. A warning, a discarded
//! step, a refusal or a fault is told to every importer: many do not look at the status of a call, and would go on with
//! values that nobody asked for. Success as such is not logged, so a run without trouble is silent.

use super::severity::Severity;
use super::variables::LogCategory;
use std::ffi::{CStr, CString};
use std::fmt::{self, Display, Write as _};

/// Where lines go: the importer, through the callback of its version of FMI.
pub trait Host {
    /// Hands one line to the importer; without a severity it is about a call that simply succeeded.
    fn log(&self, instance_name: &CStr, severity: Option<Severity>, category: &CStr, line: &CStr);
}

/// A host that does not listen.
#[derive(Clone, Copy, Debug)]
pub struct Silent;

impl Host for Silent {
    fn log(&self, _: &CStr, _: Option<Severity>, _: &CStr, _: &CStr) {}
}

/// Names in a choice of categories that are not declared.
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

/// Whether a choice of categories has that of remarks in it.
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

/// Where messages go, and whether remarks do.
pub struct Logger {
    host: Box<dyn Host>,
    instance_name: CString,
    remarks: bool,
}

impl Logger {
    /// A logger for the instance of this name, with remarks or without.
    pub fn new(host: Box<dyn Host>, instance_name: CString, logging_on: bool) -> Self {
        Self { host, instance_name, remarks: logging_on }
    }

    /// Chooses whether remarks are sent: if logging is on, and their category is named or none is. The names that are not
    /// declared, if there are such; the others count.
    pub fn enable(&mut self, logging_on: bool, categories: &[&CStr]) -> Option<UnknownCategories> {
        self.remarks = logging_on && chooses_remarks(categories);
        UnknownCategories::among(categories)
    }

    /// Switches the named categories on or off and leaves the others as they are; all of them if no category is named. The
    /// names that are not declared, if there are such; the others count.
    pub fn switch(&mut self, on: bool, categories: &[&CStr]) -> Option<UnknownCategories> {
        if chooses_remarks(categories) {
            self.remarks = on;
        }
        UnknownCategories::among(categories)
    }

    /// Sends one line about a call to `function` that did not simply succeed, whatever is enabled.
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

/// One line that no `printf` changes: the standard gives meaning to `%` and `#`, so they are written
/// by number, as control characters are.
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
