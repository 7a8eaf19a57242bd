//! Tables of calls and states, as each version of FMI has one: a row a call, a column a state.

/// A row of the table: one bit a state.
#[derive(Clone, Copy)]
pub struct Row(u16);

impl Row {
    /// Reads `x` (allowed) and `.` (refused), one for each of so many states, spaces aside.
    pub const fn read(text: &str, states: usize) -> Self {
        let bytes = text.as_bytes();
        let (mut mask, mut column, mut at) = (0, 0_usize, 0);
        while at < bytes.len() {
            match bytes[at] {
                b'x' => mask |= 1 << column,
                b' ' => column -= 1,
                other => assert!(other == b'.', "a row holds x, . and spaces only"),
            }
            column += 1;
            at += 1;
        }
        assert!(column == states, "a row has one entry for each state");
        Self(mask)
    }

    /// Whether the state of this column is allowed.
    pub fn holds(self, column: usize) -> bool {
        self.0 & (1 << column) != 0
    }
}

/// Declares an enumeration whose items each have a row over the states of `State`, an enumeration of the calling module
/// that lists them in its `ALL`.
macro_rules! table {
    ($(#[$doc:meta])* $name:ident, $prefix:literal; $($item:ident $row:literal)+) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs, reason = "the names are the standard's")]
        pub enum $name { $($item),+ }

        impl $name {
            /// All rows, from top to bottom.
            pub const ALL: &[Self] = &[$(Self::$item),+];
            const ROWS: &[$crate::fmi::call_table::Row] =
                &[$($crate::fmi::call_table::Row::read($row, State::ALL.len())),+];

            /// The name that the importer knows it by.
            pub fn name(self) -> &'static str {
                match self { $(Self::$item => concat!($prefix, stringify!($item))),+ }
            }

            /// Whether it is allowed in this state.
            pub fn allowed(self, state: State) -> bool {
                Self::ROWS[self as usize].holds(state as usize)
            }
        }
    };
}

/// Says what calls may read and write in each `State` of the calling module, by the rows of its table `Touch`, and gives
/// states their names in messages.
macro_rules! permissions {
    () => {
        impl State {
            /// What a call may read in this state.
            pub fn reading(self) -> Permission {
                self.permission([Touch::GetInput, Touch::GetOutput, Touch::GetParameter])
            }

            /// What a call may write in this state.
            pub fn writing(self) -> Permission {
                self.permission([Touch::SetInput, Touch::SetOutput, Touch::SetParameter])
            }

            fn permission(self, touches: [Touch; 3]) -> Permission {
                let [inputs, outputs, parameters] = touches.map(|touch| touch.allowed(self));
                Permission { inputs, outputs, parameters, state: self.name() }
            }
        }

        impl fmt::Display for State {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

pub(crate) use {permissions, table};
