//! Every variable of the FMU by value reference, made from `modelDescription/variables.toml`.

use crate::model::signals::{Inputs, Outputs};
use crate::scene::parameter::Parameter;

/// One variable; its value reference is its index in `VARIABLES`, unique over all types.
pub struct Variable {
    /// Name in the model description.
    pub name: &'static str,
    /// Type, and the functions that access it.
    pub access: Access,
}

/// Type of a variable, with the functions that access it.
pub enum Access {
    /// A real input.
    Input {
        /// Value before a host sets one.
        start: f64,
        /// Reads the inputs.
        get: fn(&Inputs) -> f64,
        /// Writes the inputs.
        set: fn(&mut Inputs, f64),
    },
    /// A real output.
    RealOutput(fn(&Outputs) -> f64),
    /// An integer output.
    IntegerOutput(fn(&Outputs) -> i32),
    /// A Boolean output.
    BooleanOutput(fn(&Outputs) -> bool),
    /// The continuous state of this number. Not every scene has so many states.
    State(usize),
    /// The derivative of the state of this number.
    Derivative(usize),
    /// A fixed parameter of any type. An enumeration is passed as an integer.
    Parameter(&'static Parameter),
}

/// Declares the categories of log messages.
macro_rules! log_categories {
    ($($(#[$doc:meta])* $item:ident = $name:literal),+ $(,)?) => {
        /// Category of a log message.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum LogCategory {
            $($(#[$doc])* $item),+
        }

        impl LogCategory {
            /// All categories, in the order of the declaration.
            pub const ALL: &[Self] = &[$(Self::$item),+];

            /// The standard's name.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$item => $name),+
                }
            }
        }
    };
}

include!(concat!(env!("OUT_DIR"), "/variables.rs"));
