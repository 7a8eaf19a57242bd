//! Any function of the standard with any arguments: the words of a call, made into its types.

use host::api::Api;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::lifecycle::Call;
use std::ffi::c_void;

/// One argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Word {
    Pointer(*mut c_void),
    Size(usize),
    Integer(i32),
    Reference(u32),
    Byte(u8),
    Real(f64),
}

/// NULL.
pub const NULL: Word = Word::Pointer(std::ptr::null_mut());

/// A type that arguments have.
pub trait Argument {
    fn of(word: Word) -> Self;
}

impl<T> Argument for *const T {
    fn of(word: Word) -> Self {
        <*mut T>::of(word)
    }
}

impl<T> Argument for *mut T {
    fn of(word: Word) -> Self {
        if let Word::Pointer(pointer) = word { pointer.cast() } else { panic!("{word:?} for a pointer") }
    }
}

macro_rules! arguments {
    ($($word:ident($type:ty)),+) => {
        $(impl Argument for $type {
            fn of(word: Word) -> Self {
                if let Word::$word(value) = word { value } else { panic!("{word:?} for {}", stringify!($type)) }
            }
        })+
    };
}

arguments!(Size(usize), Integer(i32), Reference(u32), Byte(u8), Real(f64));

/// A type that answers have.
pub trait Answer {
    fn status(self) -> Option<Status>;
}

impl Answer for Status {
    fn status(self) -> Option<Status> {
        Some(self)
    }
}

impl Answer for () {
    fn status(self) -> Option<Status> {
        None
    }
}

impl<T> Answer for *const T {
    fn status(self) -> Option<Status> {
        None
    }
}

impl<T> Answer for *mut T {
    fn status(self) -> Option<Status> {
        None
    }
}

/// A function of C.
pub trait Function {
    /// Calls it with these words; its status, if it has one.
    ///
    /// # Safety
    /// As the function's.
    unsafe fn call(self, words: &[Word]) -> Option<Status>;
}

macro_rules! function {
    ($(($($argument:ident)*))+) => {
        $(impl<R: Answer $(, $argument: Argument)*> Function for unsafe extern "C" fn($($argument),*) -> R {
            #[allow(unused_mut, unused_variables, reason = "some functions have no arguments")]
            unsafe fn call(self, words: &[Word]) -> Option<Status> {
                let mut words = words.iter().copied();
                // SAFETY: the caller's.
                unsafe { self($($argument::of(words.next().expect("an argument"))),*) }.status()
            }
        })+
    };
}

function! {
    () (A) (A B) (A B D) (A B D E) (A B D E F) (A B D E F G) (A B D E F G H) (A B D E F G H I) (A B D E F G H I J)
    (A B D E F G H I J K L M N O)
}

macro_rules! invoke {
    ($($name:ident = $place:path: $type:ty;)+) => {
        /// Calls a function with these words; its status, if it has one.
        ///
        /// # Safety
        /// As the function's.
        pub unsafe fn invoke(api: &Api, call: Call, words: &[Word]) -> Option<Status> {
            match call {
                // SAFETY: the caller's.
                $(Call::$name => unsafe { Function::call(api.$name, words) },)+
            }
        }
    };
}

host::functions!(invoke);
