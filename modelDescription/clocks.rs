//! Clocks of FMI 3.0: one for each contact that may close, active where the contact closes or opens.

use super::element::Attributes;
use super::structure::Numbering;

/// Value reference of the clock of the first contact; the others follow, whether the scene has them or not.
pub const FIRST_CLOCK: u32 = 40_000;

/// The clock of a contact.
pub struct Clock {
    /// The contact's place among all.
    pub contact: usize,
    /// Such as `joint.C.contact_change`.
    pub name: String,
    /// What it is.
    pub description: String,
}

impl Clock {
    /// Its value reference.
    pub fn reference(&self) -> u32 {
        FIRST_CLOCK + self.contact as u32
    }

    /// Its element of ModelVariables.
    pub(super) fn variable(&self) -> Attributes<'static> {
        vec![
            ("name", self.name.clone()),
            ("valueReference", self.reference().to_string()),
            ("description", self.description.clone()),
            ("causality", "output".into()),
            ("variability", "discrete".into()),
            ("intervalVariability", "triggered".into()),
        ]
    }

    /// Its entry among the initial unknowns: inactive, whatever else there is.
    pub(super) fn initial_unknown(&self, numbering: Numbering) -> Attributes<'static> {
        numbering.unknown(self.reference() as usize, Some(vec![]))
    }

    /// Its entry among the outputs, which depends on all states.
    pub(super) fn output(&self, numbering: Numbering) -> Attributes<'static> {
        numbering.unknown(self.reference() as usize, Some(numbering.states().collect()))
    }
}
