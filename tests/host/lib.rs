//! A small importer: one slave with its log, every call a method.
#![allow(missing_docs, reason = "methods bear the names of the standard's functions")]
#![allow(unsafe_code, reason = "the tests call the C functions")]
#![allow(clippy::panic, reason = "a test that cannot go on")]
#![allow(clippy::not_unsafe_ptr_arg_deref, reason = "the tests hand over handles as a host does")]
#![allow(clippy::new_without_default, reason = "a slave of the linked library")]

pub mod api;
pub mod exchange;
pub mod log;

use api::Api;
use log::Log;
use slidercrank::fmi::slave::variables::VARIABLES;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::abi::types::*;
use slidercrank::scene::slot;
use std::collections::HashMap;
use std::ffi::{CString, c_char};
use std::path::PathBuf;
use std::ptr::{null, null_mut};
use std::sync::LazyLock;

/// Value reference of a variable.
pub fn vr(name: &str) -> u32 {
    static REFERENCES: LazyLock<HashMap<&str, u32>> =
        LazyLock::new(|| VARIABLES.iter().map(|variable| variable.name).zip(0..).collect());
    *REFERENCES.get(name).unwrap_or_else(|| panic!("{name}"))
}

/// The library's guid.
pub fn guid() -> CString {
    CString::new(slot::read().expect("a readable slot").1).expect("no zero")
}

/// The library as a host loads it. `cargo test` builds it, as an example; with `--test` alone it must be there.
pub fn library() -> PathBuf {
    let test = std::env::current_exe().expect("a path");
    let name = libloading::library_filename("shared_library");
    let file = test.ancestors().nth(2).expect("a folder").join("examples").join(name);
    assert!(file.exists(), "`cargo build --example shared_library` makes {}", file.display());
    file
}

/// One instance.
pub struct Slave {
    pub api: Api,
    pub c: fmi2Component,
    pub log: Box<Log>,
}

// SAFETY: an instance may be used from any thread, one at a time.
unsafe impl Send for Slave {}

impl Drop for Slave {
    fn drop(&mut self) {
        // SAFETY: the component is ours and not used again.
        unsafe { (self.api.FreeInstance)(self.c) }
    }
}

/// `self.api.$function` on the component.
macro_rules! calls {
    ($($(#[$doc:meta])* $name:ident = $function:ident($($argument:ident: $type:ty),*);)+) => {
        impl Slave {
            $($(#[$doc])* pub fn $name(&self $(, $argument: $type)*) -> Status {
                // SAFETY: the component is live, pointers come from borrows of the right length.
                unsafe { (self.api.$function)(self.c $(, $argument)*) }
            })+
        }
    };
}

calls! {
    enter = EnterInitializationMode();
    exit = ExitInitializationMode();
    terminate = Terminate();
    reset = Reset();
    set_state = SetFMUstate(state: fmi2FMUstate);
    setup_raw = SetupExperiment(tolerance_defined: i32, tolerance: f64, start: f64, stop_defined: i32, stop: f64);
    step_raw = DoStep(point: f64, size: f64, no_set: i32);
}

impl Slave {
    /// An instance of the linked library, with logging on.
    pub fn new() -> Self {
        Self::of(Api::linked(), "slave", true)
    }

    /// An instance for co-simulation.
    pub fn of(api: Api, name: &str, logging_on: bool) -> Self {
        Self::of_type(api, name, FMI2_CO_SIMULATION, logging_on)
    }

    /// An instance of this type.
    pub fn of_type(api: Api, name: &str, fmu_type: fmi2Type, logging_on: bool) -> Self {
        let (log, name) = (Box::<Log>::default(), CString::new(name).expect("no zero"));
        let callbacks = log.callbacks();
        // SAFETY: all strings and the callbacks are valid; the log lives as long as the slave.
        let c = unsafe {
            (api.Instantiate)(
                name.as_ptr(),
                fmu_type,
                guid().as_ptr(),
                null(),
                &raw const callbacks,
                FMI2_FALSE,
                i32::from(logging_on),
            )
        };
        assert!(!c.is_null(), "{:?}", log.take());
        Self { api, c, log }
    }

    /// In initialization mode, from time 0, without stop.
    pub fn initializing() -> Self {
        let slave = Self::new();
        assert_eq!(slave.setup_raw(0, 0.0, 0.0, 0, 0.0), Status::Ok);
        assert_eq!(slave.enter(), Status::Ok);
        slave
    }

    /// With a worn slider pin at `speed` [rad/s], initialized at time 0.
    pub fn running() -> Self {
        let slave = Self::initializing();
        slave.wear();
        assert_eq!(slave.exit(), Status::Ok, "{:?}", slave.log.take());
        slave
    }

    /// Sets the start values of a run with impacts.
    pub fn wear(&self) {
        assert_eq!(self.set_integer("joint.C.model", 2), Status::Ok);
        assert_eq!(self.set("crank.speed_start", 500.0), Status::Ok);
    }

    pub fn set(&self, name: &str, value: f64) -> Status {
        self.set_all(&[vr(name)], &[value])
    }

    pub fn set_all(&self, references: &[u32], values: &[f64]) -> Status {
        assert_eq!(references.len(), values.len());
        // SAFETY: live component, arrays of equal length.
        unsafe { (self.api.SetReal)(self.c, references.as_ptr(), references.len(), values.as_ptr()) }
    }

    pub fn set_integer(&self, name: &str, value: i32) -> Status {
        // SAFETY: live component, arrays of one entry.
        unsafe { (self.api.SetInteger)(self.c, &vr(name), 1, &value) }
    }

    pub fn try_get(&self, name: &str) -> Result<f64, Status> {
        let mut value = f64::NAN;
        // SAFETY: live component, arrays of one entry.
        let status = unsafe { (self.api.GetReal)(self.c, &vr(name), 1, &mut value) };
        if status == Status::Ok { Ok(value) } else { Err(status) }
    }

    pub fn get(&self, name: &str) -> f64 {
        self.try_get(name).unwrap_or_else(|status| panic!("{status:?} {:?}", self.log.take()))
    }

    pub fn get_integer(&self, name: &str) -> i32 {
        let mut value = i32::MIN;
        // SAFETY: live component, arrays of one entry.
        let status = unsafe { (self.api.GetInteger)(self.c, &vr(name), 1, &mut value) };
        assert_eq!(status, Status::Ok);
        value
    }

    pub fn set_boolean(&self, name: &str, value: i32) -> Status {
        // SAFETY: live component, arrays of one entry.
        unsafe { (self.api.SetBoolean)(self.c, &vr(name), 1, &value) }
    }

    pub fn get_boolean(&self, name: &str) -> i32 {
        let mut value = i32::MIN;
        // SAFETY: live component, arrays of one entry.
        let status = unsafe { (self.api.GetBoolean)(self.c, &vr(name), 1, &mut value) };
        assert_eq!(status, Status::Ok);
        value
    }

    pub fn set_rate(&self, name: &str, order: i32, rate: f64) -> Status {
        // SAFETY: live component, arrays of one entry.
        unsafe { (self.api.SetRealInputDerivatives)(self.c, &vr(name), 1, &order, &rate) }
    }

    pub fn rate(&self, name: &str, order: i32) -> Result<f64, Status> {
        let mut rate = f64::NAN;
        // SAFETY: live component, arrays of one entry.
        let status = unsafe { (self.api.GetRealOutputDerivatives)(self.c, &vr(name), 1, &order, &mut rate) };
        if status == Status::Ok { Ok(rate) } else { Err(status) }
    }

    pub fn sensitivity(&self, unknown: &str, known: &str, seed: f64) -> Result<f64, Status> {
        let mut answer = f64::NAN;
        // SAFETY: live component, arrays of one entry.
        let status =
            unsafe { (self.api.GetDirectionalDerivative)(self.c, &vr(unknown), 1, &vr(known), 1, &seed, &mut answer) };
        if status == Status::Ok { Ok(answer) } else { Err(status) }
    }

    pub fn step(&self, point: f64, size: f64) -> Status {
        self.step_raw(point, size, FMI2_TRUE)
    }

    /// `count` steps of `size` from `point`, adding up as importers do; where that leads.
    pub fn steps(&self, mut point: f64, size: f64, count: usize) -> f64 {
        for _ in 0..count {
            assert_eq!(self.step(point, size), Status::Ok, "{:?}", self.log.take());
            point += size;
        }
        point
    }

    pub fn last_time(&self) -> f64 {
        let mut time = f64::NAN;
        // SAFETY: live component, one place.
        let status = unsafe { (self.api.GetRealStatus)(self.c, 2, &mut time) };
        assert_eq!(status, Status::Ok);
        time
    }

    /// Saves into `state`.
    pub fn save_into(&self, state: &mut fmi2FMUstate) -> Status {
        // SAFETY: live component, one place.
        unsafe { (self.api.GetFMUstate)(self.c, state) }
    }

    pub fn save(&self) -> fmi2FMUstate {
        let mut state = null_mut();
        assert_eq!(self.save_into(&mut state), Status::Ok);
        state
    }

    pub fn free(&self, state: &mut fmi2FMUstate) -> Status {
        // SAFETY: live component, one place.
        unsafe { (self.api.FreeFMUstate)(self.c, state) }
    }

    pub fn bytes_of(&self, state: fmi2FMUstate) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: live component, one place.
        let status = unsafe { (self.api.SerializedFMUstateSize)(self.c, state, &mut size) };
        assert_eq!(status, Status::Ok);
        let mut bytes = vec![0; size];
        assert_eq!(self.serialize(state, &mut bytes), Status::Ok);
        bytes
    }

    pub fn serialize(&self, state: fmi2FMUstate, bytes: &mut [u8]) -> Status {
        // SAFETY: live component, buffer of the length said.
        unsafe { (self.api.SerializeFMUstate)(self.c, state, bytes.as_mut_ptr().cast::<c_char>(), bytes.len()) }
    }

    pub fn deserialize(&self, bytes: &[u8]) -> Result<fmi2FMUstate, Status> {
        let mut state = null_mut();
        // SAFETY: live component, buffer of the length said, one place.
        let status = unsafe { (self.api.DeSerializeFMUstate)(self.c, bytes.as_ptr().cast(), bytes.len(), &mut state) };
        if status == Status::Ok { Ok(state) } else { Err(status) }
    }

    /// Every real output and input, as bits.
    pub fn picture(&self) -> Vec<u64> {
        use slidercrank::fmi::slave::variables::Access;
        let real = VARIABLES.iter().filter(|v| matches!(v.access, Access::RealOutput(_) | Access::Input { .. }));
        real.map(|variable| self.get(variable.name).to_bits()).collect()
    }
}
