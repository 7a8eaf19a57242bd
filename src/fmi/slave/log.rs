//! One line to the importer, and only where it asked for the line's category.
//!
//! By the standard the importer hears enabled categories only, errors included: with logging off a
//! slave is silent. Success is not logged, so a run without trouble is silent with logging on, too.

use super::error::Error;
use super::severity::Severity;
use super::variables::LogCategory;
use std::ffi::{CStr, CString};
use std::fmt::{Display, Write as _};

/// Where lines go: the importer, through the callback of its version of FMI.
pub trait Host {
    /// Hands one line to the importer.
    fn log(&self, instance_name: &CStr, severity: Severity, category: &CStr, line: &CStr);
}

/// A host that does not listen.
#[derive(Clone, Copy, Debug)]
pub struct Silent;

impl Host for Silent {
    fn log(&self, _: &CStr, _: Severity, _: &CStr, _: &CStr) {}
}

/// Which categories are enabled: one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Enabled(u8);

impl Enabled {
    const NOTHING: Self = Self(0);
    const ALL: Self = Self(u8::MAX);

    fn with(self, category: LogCategory) -> Self {
        Self(self.0 | 1 << category as u8)
    }

    fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those of these names.
    fn named(categories: &[&CStr]) -> Result<Self, Error> {
        categories.iter().try_fold(Self::NOTHING, |enabled, name| {
            let declared = |category: &&LogCategory| category.name().as_bytes() == name.to_bytes();
            match LogCategory::ALL.iter().find(declared) {
                Some(LogCategory::All) => Ok(Self::ALL),
                Some(category) => Ok(enabled.with(*category)),
                None => Err(Error::Category(name.to_string_lossy().into_owned())),
            }
        })
    }

    fn has(self, category: LogCategory) -> bool {
        self.0 & 1 << category as u8 != 0
    }
}

/// Where messages go and which of them.
pub struct Logger {
    host: Box<dyn Host>,
    instance_name: CString,
    enabled: Enabled,
}

impl Logger {
    /// A logger for the instance of this name, with all categories enabled or without any.
    pub fn new(host: Box<dyn Host>, instance_name: CString, logging_on: bool) -> Self {
        let enabled = if logging_on { Enabled::ALL } else { Enabled::NOTHING };
        Self { host, instance_name, enabled }
    }

    /// Enables the named categories alone, or all if no category is named; or nothing at all.
    pub fn enable(&mut self, logging_on: bool, categories: &[&CStr]) -> Result<(), Error> {
        let named = Enabled::named(categories)?;
        self.enabled = match (logging_on, categories.is_empty()) {
            (false, _) => Enabled::NOTHING,
            (true, true) => Enabled::ALL,
            (true, false) => named,
        };
        Ok(())
    }

    /// Switches the named categories on or off and leaves the others as they are; all of them if no category is named.
    pub fn switch(&mut self, on: bool, categories: &[&CStr]) -> Result<(), Error> {
        let chosen = if categories.is_empty() { Enabled::ALL } else { Enabled::named(categories)? };
        self.enabled = if on { self.enabled.and(chosen) } else { self.enabled.without(chosen) };
        Ok(())
    }

    /// Sends one line about a call to `function`, if the category of its severity is enabled.
    pub fn say(&self, severity: Severity, function: &str, message: &dyn Display) {
        let category = severity.category();
        if self.enabled.has(category) {
            let category = CString::new(category.name()).unwrap_or_default();
            self.host.log(&self.instance_name, severity, &category, &line(function, message));
        }
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
