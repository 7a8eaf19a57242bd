//! Components: instances as opaque pointers of the importer. An instance is lent to one call at a time.

use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::sync::atomic::{AtomicBool, Ordering};

/// The memory that a component points to. The flag prevents two calls at the same time: calls from a second thread, or
/// from the logger, are refused, so that there are never two references.
pub struct Component<T> {
    busy: AtomicBool,
    instance: UnsafeCell<T>,
}

/// An instance during one call.
pub struct Lent<'a, T> {
    component: &'a Component<T>,
}

/// Gives an instance to the importer.
pub fn give<T>(instance: T) -> *mut c_void {
    let component = Component { busy: AtomicBool::new(false), instance: UnsafeCell::new(instance) };
    Box::into_raw(Box::new(component)).cast()
}

/// Lends the instance of a component to a call, unless the component is NULL, misaligned or busy.
///
/// # Safety
/// A component that is neither null nor misaligned came from [`give`] of a `T` and was not taken back.
pub unsafe fn lend<'a, T>(component: *mut c_void) -> Option<Lent<'a, T>> {
    let pointer = component.cast::<Component<T>>().cast_const();
    if pointer.is_null() || !pointer.is_aligned() {
        return None;
    }
    // SAFETY: non-null and aligned; the importer vouches that it is a live component of ours.
    let component = unsafe { &*pointer };
    let was_busy = component.busy.swap(true, Ordering::Acquire);
    if was_busy { None } else { Some(Lent { component }) }
}

/// Takes an instance back from the importer, unless the component is NULL, misaligned or busy.
///
/// # Safety
/// As [`lend`]; and the importer does not use the component again.
pub unsafe fn take_back<T>(component: *mut c_void) -> Option<T> {
    // SAFETY: guaranteed by the caller. The flag stays set, so there are no further calls.
    std::mem::forget(unsafe { lend::<T>(component) }?);
    // SAFETY: the pointer came from `Box::into_raw` in `give`.
    let component = unsafe { Box::from_raw(component.cast::<Component<T>>()) };
    Some(component.instance.into_inner())
}

impl<T> Lent<'_, T> {
    /// The instance.
    pub fn instance(&mut self) -> &mut T {
        // SAFETY: the flag, set by `lend`, prevents other calls while `self` lives.
        unsafe { &mut *self.component.instance.get() }
    }
}

impl<T> Drop for Lent<'_, T> {
    fn drop(&mut self) {
        self.component.busy.store(false, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_busy_instance_is_neither_lent_nor_taken_back() {
        let c = give(7);
        // SAFETY: the component is live; it is not taken back while lent.
        unsafe {
            let lent = lend::<i32>(c);
            assert!(lent.is_some() && lend::<i32>(c).is_none() && take_back::<i32>(c).is_none());
            drop(lent);
            assert_eq!(take_back(c), Some(7));
        }
    }
}
