//! The macro that declares the functions of a version of FMI.

/// Declares the functions of a version of FMI. An entry is a function's signature in C and its body,
/// which is unsafe code under the argument given below. From the entries the macro makes
/// - `bodies`: each function, for this library's own tests;
/// - `NAMES`: the names of all functions;
/// - the exports: the functions that importers find by these names.
macro_rules! functions {
    ($(
        $(#[$doc:meta])*
        $name:ident($($argument:ident: $type:ty),* $(,)?) -> $result:ty $body:block
    )+) => {
        /// Each function, not exported.
        pub mod bodies {
            use super::*;
            $(
                #[doc = concat!("`", stringify!($name), "`")]
                ///
                $(#[$doc])*
                #[allow(unused_variables, reason = "the signature is the standard's, not every argument is needed")]
                #[allow(unused_unsafe, unused_braces, reason = "not every body needs them")]
                pub unsafe extern "C" fn $name($($argument: $type),*) -> $result {
                    // SAFETY: the standard requires that a component is NULL or a live component of this library,
                    // and that a non-NULL pointer points to a string, a structure, one element, or as many
                    // elements as the length argument says; the body borrows no more than that.
                    unsafe { $body }
                }
            )+
        }

        /// The names of all functions.
        pub const NAMES: &[&str] = &[$(stringify!($name)),+];

        /// The exports of the library: the functions of the standard, and nothing else. The program of the unit tests has
        /// none: they would bring the whole library into it.
        #[cfg(not(test))]
        mod exports {
            use super::*;
            $(
                #[unsafe(no_mangle)]
                unsafe extern "C" fn $name($($argument: $type),*) -> $result {
                    // SAFETY: passed on.
                    unsafe { bodies::$name($($argument),*) }
                }
            )+
        }
    };
}

pub(crate) use functions;
