//! What comes of a communication step, and of its parts between intermediate updates.

/// What a part of a step has led to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// A step of the method has ended within the communication step: the importer's callback is due.
    Update(IntermediateUpdate),
    /// The step is over.
    Done(Done),
}

/// An intermediate update.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntermediateUpdate {
    /// [s] Where the slave is.
    pub time: f64,
    /// Whether the importer may ask for an early return.
    pub can_return_early: bool,
}

/// The end of a communication step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Done {
    /// A contact has closed or opened here; event mode has to follow.
    pub event: bool,
    /// The step ends before its communication point.
    pub early: bool,
    /// [s] Where the slave is.
    pub time: f64,
}

/// Ends of a step that is under way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ends {
    /// [s] That the importer asked for, counted from the start.
    pub asked: f64,
    /// [s] Where it returns: the same, or earlier if the importer's callback wanted so.
    pub at: f64,
}
