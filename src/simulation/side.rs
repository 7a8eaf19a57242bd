//! The two sides of an event.

/// On which side of the events at an instant a motion is looked at. Away from events both sides are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub enum Side {
    /// Left limit: the end of the step that led to the events. Rigid contacts, whose events are not located within a
    /// step, have no such side of their own.
    Before,
    /// Right limit: where the next step starts.
    #[default]
    After,
}
