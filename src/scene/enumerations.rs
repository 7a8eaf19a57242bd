//! The scene's enumerations, generated from `modelDescription/variables.toml`.

use serde::{Deserialize, Serialize};

/// Declares an enumeration by its items' values, their names in the FMU's interface, and their properties.
macro_rules! enumeration {
    ($(#[$doc:meta])* $name:ident { $($(#[$item_doc:meta])* $item:ident = $value:literal = $text:literal [$($property:literal),*]),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
        #[repr(i32)]
        pub enum $name {
            $($(#[$item_doc])* $item = $value),+
        }

        impl $name {
            /// Names and values of the items.
            pub const ITEMS: &[(&str, i32)] = &[$(($text, $value)),+];

            /// All items.
            pub const ALL: &[Self] = &[$(Self::$item),+];

            /// The item with this value; `None` if there is none.
            pub fn from_value(value: i32) -> Option<Self> {
                match value {
                    $($value => Some(Self::$item),)+
                    _ => None,
                }
            }

            /// The value in the FMU's interface.
            pub fn value(self) -> i32 {
                self as i32
            }

            /// The name in the FMU's interface.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$item => $text,)+
                }
            }

            /// Whether the item has this property in the declaration.
            pub fn has(self, property: &str) -> bool {
                let properties: &[&str] = match self {
                    $(Self::$item => &[$($property),*],)+
                };
                properties.contains(&property)
            }
        }
    };
}

include!(concat!(env!("OUT_DIR"), "/enumerations.rs"));
