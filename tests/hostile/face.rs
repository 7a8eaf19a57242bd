//! An instance as hosts of each version of FMI and of each kind of interface see it, as far as the campaigns need it.

use crate::estimators::Estimated;
use host::log::Line;
use host::vr;
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::slave::variables::{Access, VARIABLES, Variable};
use slidercrank::fmi::slave::{Interface, ValueType};
use slidercrank::fmi::v2::Status;
use slidercrank::simulation::Snapshot;
use std::ffi::c_void;
use std::fmt::Debug;

/// Handle of a saved state.
pub type Handle = *mut c_void;

/// A number, or why there is none.
pub type Answer = Result<f64, Status>;

/// What a saved state holds, piece by piece.
pub trait Pieces: Saved + Clone + PartialEq + Debug {
    /// Number of pieces.
    const PIECES: usize;

    /// The same with this piece of another.
    fn with(self, piece: usize, other: &Self) -> Self;
    fn snapshot(&self) -> &Option<Snapshot>;
    fn set_snapshot(&mut self, snapshot: Snapshot);
    /// The same in every place in life, with whether an instance like the one that saved it can be there, which handles
    /// events or does not, and whether no step can follow there.
    fn everywhere(&self, events: bool) -> Vec<(Self, bool, bool)>;
}

/// An instance of one version of FMI and of one kind of interface.
pub trait Face: Sized + Send {
    type Content: Pieces;

    const INTERFACE: Interface = Interface::CoSimulation;
    /// The same slave is behind all faces: the others try one in so many of what FMI 2.0 tries where that takes minutes.
    const ONE_IN: usize = 5;
    /// Whether the importer handles events, if a version asks.
    const EVENTS: bool = true;
    /// The function that reads bytes.
    const DESERIALIZE: &str;
    /// What a step answers that cannot be done.
    const FAILED: Status;

    /// An instance with logging on.
    fn new() -> Self;
    /// Enters initialization mode, from `start` [s] on, without stop.
    fn enter_from(&self, start: f64) -> Status;
    /// Leaves initialization mode, up to where a step can follow.
    fn begin(&self) -> Status;
    fn reset(&self) -> Status;
    /// All calls on the way from any place in life to where steps are made.
    fn press_on(&self) -> Vec<Status>;

    /// Sets a variable of this type.
    fn set_one(&self, of: ValueType, reference: u32, value: f64) -> Status;
    /// Reads a variable of this type.
    fn get_one(&self, of: ValueType, reference: u32) -> Answer;
    /// Sets a slope of an input, in versions that have slopes.
    fn set_slope(&self, _name: &str, _slope: f64) -> Option<Status> {
        None
    }
    fn rate(&self, name: &str) -> Answer;
    /// Derivative along knowns with these seeds.
    fn sensitivity(&self, unknown: u32, knowns: &[u32], seeds: &[f64]) -> Answer;
    /// Reads every number that is told besides variables of both versions, and shows each at once.
    fn others(&self, _show: &mut dyn FnMut(&str, Answer)) {}

    /// [s] Where it is, if it tells.
    fn time(&self) -> Answer;
    fn step(&self, point: f64, size: f64) -> Status;
    /// Factor of the steps that a run of the packaged mechanism takes.
    fn pace() -> f64 {
        1.0
    }
    /// Calls of several kinds that are refused between steps.
    fn blunders(&self, point: f64) -> Vec<Status>;

    /// The instance and the functions for estimators.
    fn estimated(&self) -> Estimated;

    fn save_into(&self, state: &mut Handle) -> Status;
    fn restore(&self, state: Handle) -> Status;
    fn forget(&self, state: &mut Handle) -> Status;
    fn bytes(&self, state: Handle) -> Vec<u8>;
    fn deserialize(&self, bytes: &[u8]) -> Result<Handle, Status>;

    /// The lines of the log since the last look.
    fn lines(&self) -> Vec<Line>;

    /// The only line since the last look.
    fn only(&self) -> Line {
        let lines = self.lines();
        assert_eq!(lines.len(), 1, "{lines:?}");
        lines[0].clone()
    }

    fn set(&self, name: &str, value: f64) -> Status {
        self.set_one(ValueType::of(variable(name)), vr(name), value)
    }

    fn try_get(&self, name: &str) -> Answer {
        self.get_one(ValueType::of(variable(name)), vr(name))
    }

    fn get(&self, name: &str) -> f64 {
        self.try_get(name).unwrap_or_else(|status| panic!("{name}: {status:?} {:?}", self.lines()))
    }

    fn save(&self) -> Handle {
        let mut state = std::ptr::null_mut();
        assert_eq!(self.save_into(&mut state), Status::Ok, "{:?}", self.lines());
        state
    }

    /// All that the instance is.
    fn memory(&self) -> Vec<u8> {
        let mut state = self.save();
        let bytes = self.bytes(state);
        assert_eq!(self.forget(&mut state), Status::Ok);
        bytes
    }

    /// `count` steps of `size` from `point`, adding up as importers do; where that leads.
    fn steps(&self, mut point: f64, size: f64, count: usize) -> f64 {
        for _ in 0..count {
            let size = size * Self::pace();
            assert_eq!(self.step(point, size), Status::Ok, "{:?}", self.lines());
            point += size;
        }
        point
    }

    /// Every output and input, as bits.
    fn everything(&self) -> Vec<u64> {
        let told = VARIABLES.iter().filter(|variable| !matches!(variable.access, Access::Parameter(_)));
        told.map(|variable| self.get(variable.name).to_bits()).collect()
    }

    /// Reads every number there is: each is finite or is refused in one line that says so. Whether all are told.
    fn look(&self, what: &str) -> bool {
        let mut all = true;
        let mut judge = |name: &str, answer: Answer| {
            let lines = self.lines();
            match answer {
                Ok(value) => assert!(value.is_finite() && lines.is_empty(), "{what}: {name} = {value}, {lines:?}"),
                Err(status) => {
                    let elsewhere = ["not allowed in state", "the scene has no "];
                    all &= lines.iter().any(|line| elsewhere.iter().any(|words| line.text.contains(words)));
                    assert!(matches!(status, Status::Discard | Status::Error), "{what}: {name}: {status:?} {lines:?}");
                    assert_eq!(lines.len(), 1, "{what}: {name}");
                    let named = lines[0].text.contains(name) && lines[0].text.contains("is not a finite number");
                    assert!(status == Status::Error || named, "{what}: {name}: {lines:?}");
                }
            }
        };
        for variable in VARIABLES {
            if matches!(variable.access, Access::RealOutput(_) | Access::Input { .. }) {
                judge(variable.name, self.try_get(variable.name));
            }
        }
        judge("slider.x", self.rate("slider.x"));
        self.others(&mut judge);
        all
    }
}

/// The variable of this name.
fn variable(name: &str) -> &'static Variable {
    &VARIABLES[vr(name) as usize]
}

/// Makes tests of functions that take a face, one for each way to host the FMU.
macro_rules! on_each_face {
    ($($test:ident)+) => {
        $(mod $test {
            use crate::{three, two};

            #[test]
            fn fmi2() {
                super::$test::<two::Stepping>();
            }

            #[test]
            fn fmi2_exchange() {
                super::$test::<two::Exchange>();
            }

            #[test]
            fn fmi3() {
                super::$test::<three::Stepping>();
            }

            #[test]
            fn fmi3_events() {
                super::$test::<three::Events>();
            }

            #[test]
            fn fmi3_exchange() {
                super::$test::<three::Exchange>();
            }
        })+
    };
}
