//! The importer's callback for intermediate updates.

use super::super::step::IntermediateUpdate;
use super::types::{fmi3InstanceEnvironment, fmi3IntermediateUpdateCallback};

/// The importer's callback.
#[derive(Clone, Copy)]
pub struct HostUpdate {
    callback: fmi3IntermediateUpdateCallback,
    environment: fmi3InstanceEnvironment,
}

impl HostUpdate {
    /// The importer's callback.
    ///
    /// # Safety
    /// The callback must be a function of the standard's signature that may be called with this environment for as long
    /// as this value is used.
    pub unsafe fn new(callback: fmi3IntermediateUpdateCallback, environment: fmi3InstanceEnvironment) -> Self {
        Self { callback, environment }
    }

    /// Calls back, while no borrow of the instance is alive: the importer reads and sets variables from there. [s] When
    /// the step is to return, if the importer wants that before its end.
    pub fn call(&self, update: &IntermediateUpdate) -> Option<f64> {
        let (mut requested, mut at) = (0, update.time);
        // Values of accepted steps, which may be read; continuous inputs may be set.
        let (set, get, finished) = (1, 1, 1);
        // SAFETY: `new` was promised that the function may be called; both places are ours and outlive the call.
        unsafe {
            (self.callback)(
                self.environment,
                update.time,
                set,
                get,
                finished,
                update.can_return_early.into(),
                &raw mut requested,
                &raw mut at,
            );
        }
        (requested != 0).then_some(at)
    }
}
