//! An instance as the importer holds it: an opaque pointer, lent to one call at a time.

use super::super::instance::Instance;
use super::types::fmi2Component;
use std::cell::UnsafeCell;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a component points to. The flag keeps two calls out of one instance: a second thread, or a
/// logger that calls back, is refused instead of aliasing.
pub struct Component {
    busy: AtomicBool,
    instance: UnsafeCell<Instance>,
}

/// An instance during one call.
pub struct Lent<'a> {
    component: &'a Component,
}

/// Gives an instance to the importer.
pub fn give(instance: Instance) -> fmi2Component {
    let component = Component { busy: AtomicBool::new(false), instance: UnsafeCell::new(instance) };
    Box::into_raw(Box::new(component)).cast()
}

/// Lends the instance of a component to a call, unless it is NULL, no component or busy.
///
/// # Safety
/// A component that is neither null nor misaligned came from [`give`] and was not taken back.
pub unsafe fn lend<'a>(component: fmi2Component) -> Option<Lent<'a>> {
    let pointer = component.cast::<Component>().cast_const();
    if pointer.is_null() || !pointer.is_aligned() {
        return None;
    }
    // SAFETY: non-null and aligned; the importer vouches that it is a live component of ours.
    let component = unsafe { &*pointer };
    let was_busy = component.busy.swap(true, Ordering::Acquire);
    if was_busy { None } else { Some(Lent { component }) }
}

/// Takes an instance back from the importer, unless the component is NULL, none of ours or busy.
///
/// # Safety
/// As [`lend`]; and the importer does not use the component again.
pub unsafe fn take_back(component: fmi2Component) -> Option<Instance> {
    // SAFETY: the same promise. The flag stays up, so no call can get in any more.
    std::mem::forget(unsafe { lend(component) }?);
    // SAFETY: the pointer came from `Box::into_raw` in `give`.
    let component = unsafe { Box::from_raw(component.cast::<Component>()) };
    Some(component.instance.into_inner())
}

impl Lent<'_> {
    /// The instance.
    pub fn instance(&mut self) -> &mut Instance {
        // SAFETY: the flag, raised by `lend`, keeps every other call out while `self` lives.
        unsafe { &mut *self.component.instance.get() }
    }
}

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        self.component.busy.store(false, Ordering::Release);
    }
}
