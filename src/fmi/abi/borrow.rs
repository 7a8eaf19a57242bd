//! Turns a pointer and a length into a checked borrow. Null pointers, length 0 and hostile arguments are handled only
//! here.

use super::ArgumentError;
use std::ffi::{CStr, c_char, c_void};

/// Types for which every bit pattern is a valid value, so that any memory of the importer may be read and overwritten.
///
/// # Safety
/// No bit pattern may be invalid.
pub unsafe trait AnyBits: Copy {}

// SAFETY: a floating-point number.
unsafe impl AnyBits for f64 {}
// SAFETY: an integer.
unsafe impl AnyBits for u8 {}
// SAFETY: an integer.
unsafe impl AnyBits for i32 {}
// SAFETY: an integer.
unsafe impl AnyBits for i64 {}
// SAFETY: an integer.
unsafe impl AnyBits for u32 {}
// SAFETY: an integer.
unsafe impl AnyBits for usize {}
// SAFETY: a raw pointer; following it is another matter.
unsafe impl AnyBits for *const c_char {}
// SAFETY: a raw pointer; following it is another matter.
unsafe impl AnyBits for *mut c_void {}

/// More elements than any sensible call has. There are some hundred variables, and states have some kilobytes.
const MOST: usize = 1 << 24;

fn check<T>(argument: &'static str, pointer: *const T, length: usize) -> Result<(), ArgumentError> {
    if pointer.is_null() {
        Err(ArgumentError::Null(argument))
    } else if !pointer.is_aligned() {
        Err(ArgumentError::Misaligned(argument))
    } else if length > MOST {
        Err(ArgumentError::TooLong(argument, length))
    } else {
        Ok(())
    }
}

/// Borrows an array for reading. With length 0 the pointer may be anything.
///
/// # Safety
/// A usable pointer points to `length` entries that nobody writes during `'a`.
pub unsafe fn slice<'a, T: AnyBits>(
    argument: &'static str,
    pointer: *const T,
    length: usize,
) -> Result<&'a [T], ArgumentError> {
    if length == 0 {
        return Ok(&[]);
    }
    check(argument, pointer, length)?;
    // SAFETY: non-null, aligned, of sane length; the caller vouches for the entries.
    Ok(unsafe { std::slice::from_raw_parts(pointer, length) })
}

/// Borrows an array for writing. With length 0 the pointer may be anything.
///
/// # Safety
/// A usable pointer points to `length` entries that nobody else uses during `'a`.
pub unsafe fn slice_mut<'a, T: AnyBits>(
    argument: &'static str,
    pointer: *mut T,
    length: usize,
) -> Result<&'a mut [T], ArgumentError> {
    if length == 0 {
        return Ok(&mut []);
    }
    check(argument, pointer, length)?;
    // SAFETY: non-null, aligned, of sane length; the caller vouches for the entries.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, length) })
}

/// Borrows the memory of one result.
///
/// # Safety
/// A usable pointer points to one entry that nobody else uses during `'a`.
pub unsafe fn place<'a, T: AnyBits>(argument: &'static str, pointer: *mut T) -> Result<&'a mut T, ArgumentError> {
    check(argument, pointer, 1)?;
    // SAFETY: non-null and aligned; the caller vouches for the entry.
    Ok(unsafe { &mut *pointer })
}

/// Borrows a structure of the importer.
///
/// # Safety
/// A usable pointer points to a valid `T` that nobody writes during `'a`.
pub unsafe fn structure<'a, T>(argument: &'static str, pointer: *const T) -> Result<&'a T, ArgumentError> {
    check(argument, pointer, 1)?;
    // SAFETY: non-null and aligned; the caller vouches for the rest.
    Ok(unsafe { &*pointer })
}

/// Borrows a string, unless the pointer is NULL.
///
/// # Safety
/// A non-null pointer points to a null-terminated string that nobody writes during `'a`.
pub unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a CStr> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: not null; the caller guarantees the null character at its end.
    Some(unsafe { CStr::from_ptr(pointer) })
}
