//! What one entry of a list of functions stands for.

/// Declares the functions of a version of FMI. An entry is a function's signature in C and its body,
/// which is unsafe code under the argument given below. From the entries the macro makes
/// - `function_types`: the C type of each function, under the function's name;
/// - `bodies`: each function as this library has it;
/// - `Functions`: a table of all of them, and their `NAMES`;
/// - the exports: what an importer finds under each name, which calls the function that
///   `in_use()`, a function of the list's file, has in its table.
macro_rules! functions {
    ($(
        $(#[$doc:meta])*
        $name:ident($($argument:ident: $type:ty),* $(,)?) -> $result:ty $body:block
    )+) => {
        /// The C type of each function.
        pub mod function_types {
            use super::*;
            $(
                #[doc = concat!("The type of `", stringify!($name), "`.")]
                pub type $name = unsafe extern "C" fn($($type),*) -> $result;
            )+
        }

        /// Each function as this library has it.
        pub mod bodies {
            use super::*;
            $(
                #[doc = concat!("`", stringify!($name), "`")]
                ///
                $(#[$doc])*
                #[allow(unused_variables, reason = "the signature is the standard's, not every argument is needed")]
                #[allow(unused_unsafe, unused_braces, reason = "not every body needs them")]
                pub unsafe extern "C" fn $name($($argument: $type),*) -> $result {
                    // SAFETY: by the standard the importer vouches that a component is NULL or a live one of
                    // ours and that a non-NULL pointer has behind it a string, a structure, one entry or as
                    // many as the length beside it says; the body borrows no more than that.
                    unsafe { $body }
                }
            )+
        }

        /// All functions by their names.
        pub struct Functions {
            $(#[doc = concat!("`", stringify!($name), "`")] pub $name: function_types::$name,)+
        }

        impl Functions {
            /// The names of all functions.
            pub const NAMES: &[&str] = &[$(stringify!($name)),+];

            /// Those of this library.
            pub const OWN: Self = Self { $($name: bodies::$name,)+ };

            /// Those of another build of this library, if it has them all.
            fn of(library: &Library) -> Option<Self> {
                Some(Self {
                    $($name: {
                        let found = library.find(stringify!($name))?;
                        // SAFETY: built from the same sources, it has a function of this type under this name.
                        unsafe { transmute::<*const (), function_types::$name>(found) }
                    },)+
                })
            }
        }

        /// What the library exports: the functions of the standard, and nothing else.
        mod exports {
            use super::*;
            $(
                #[unsafe(no_mangle)]
                unsafe extern "C" fn $name($($argument: $type),*) -> $result {
                    // SAFETY: passed on; every component was made by the same table of functions.
                    unsafe { (in_use().$name)($($argument),*) }
                }
            )+
        }
    };
}

pub(crate) use functions;
