//! A small importer of FMI 3.0: one instance with its log and its callback, every call a method.
#![allow(dead_code, reason = "each test binary needs a part of it")]

pub use host::vr;
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::fmi::v3::abi::types::*;
use slidercrank::model_description::arrays::{CONTACTS, PENETRATIONS};
use std::cell::{Cell, RefCell};
use std::ffi::{CStr, c_int, c_void};
use std::ops::Deref;
use std::ptr::{null, null_mut};

/// An instance, as it is handed to a callback.
#[derive(Clone, Copy)]
pub struct Handle(pub fmi3Instance);

/// Called within a step with the time and whether an early return may be asked for; when to return, if early.
pub type Callback = Box<dyn FnMut(&Handle, f64, bool) -> Option<f64>>;

/// What the instance's callbacks find.
#[derive(Default)]
struct Environment {
    lines: RefCell<Vec<Line>>,
    update: RefCell<Option<Callback>>,
    instance: Cell<Option<Handle>>,
}

/// A line of the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub status: i32,
    pub category: String,
    pub text: String,
}

/// What is said at instantiation.
#[derive(Default)]
pub struct Options<'a> {
    pub event_mode: bool,
    pub early_return: bool,
    pub logging: bool,
    pub intermediate: &'a [&'a str],
    pub update: Option<Callback>,
}

impl Options<'_> {
    pub const EVENTS: Self =
        Self { event_mode: true, early_return: true, logging: true, intermediate: &[], update: None };
}

/// An instance that is freed at the end.
pub struct Slave {
    handle: Handle,
    environment: Box<Environment>,
}

impl Deref for Slave {
    type Target = Handle;

    fn deref(&self) -> &Handle {
        &self.handle
    }
}

impl Drop for Slave {
    fn drop(&mut self) {
        // SAFETY: the instance is ours and not used again.
        unsafe { fmi3FreeInstance(self.handle.0) }
    }
}

/// What `fmi3DoStep` tells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Told {
    pub event: bool,
    pub terminate: bool,
    pub early: bool,
    pub time: f64,
}

fn text(pointer: fmi3String) -> String {
    assert!(!pointer.is_null(), "strings of the log are never NULL");
    // SAFETY: not null; the library ends its strings with zero.
    unsafe { CStr::from_ptr(pointer) }.to_str().expect("UTF-8").to_owned()
}

unsafe extern "C" fn log(environment: *mut c_void, status: c_int, category: fmi3String, message: fmi3String) {
    // SAFETY: it is what `Slave::try_new` passed.
    let environment = unsafe { &*environment.cast::<Environment>() };
    environment.lines.borrow_mut().push(Line { status, category: text(category), text: text(message) });
}

#[allow(clippy::too_many_arguments, reason = "the standard's")]
unsafe extern "C" fn update(
    environment: *mut c_void,
    time: f64,
    set: fmi3Boolean,
    get: fmi3Boolean,
    finished: fmi3Boolean,
    can_return_early: fmi3Boolean,
    requested: *mut fmi3Boolean,
    at: *mut f64,
) {
    // SAFETY: it is what `Slave::try_new` passed.
    let environment = unsafe { &*environment.cast::<Environment>() };
    assert_eq!([set, get, finished], [1, 1, 1]);
    let handle = environment.instance.get().expect("an instance");
    let mut update = environment.update.borrow_mut();
    if let Some(time) = update.as_mut().and_then(|update| update(&handle, time, can_return_early != 0)) {
        // SAFETY: the library's places.
        unsafe { (*requested, *at) = (1, time) };
    }
}

impl Slave {
    /// An instance, or the lines that say why there is none.
    pub fn try_new(options: Options, token: &CStr) -> Result<Self, Vec<Line>> {
        let environment = Box::<Environment>::default();
        let callback = options.update.is_some().then_some(update as fmi3IntermediateUpdateCallback);
        let required: Vec<u32> = options.intermediate.iter().map(|name| vr(name)).collect();
        environment.update.replace(options.update);
        // SAFETY: strings, arrays and callbacks are valid; the environment lives as long as the instance.
        let instance = unsafe {
            fmi3InstantiateCoSimulation(
                c"slave".as_ptr(),
                token.as_ptr(),
                null(),
                0,
                options.logging.into(),
                options.event_mode.into(),
                options.early_return.into(),
                required.as_ptr(),
                required.len(),
                (&raw const *environment).cast_mut().cast(),
                Some(log),
                callback,
            )
        };
        if instance.is_null() {
            return Err(environment.lines.take());
        }
        environment.instance.set(Some(Handle(instance)));
        Ok(Self { handle: Handle(instance), environment })
    }

    /// An instance whose importer integrates.
    pub fn exchanging() -> Self {
        let (environment, token) = (Box::<Environment>::default(), host::guid());
        // SAFETY: strings and callback are valid; the environment lives as long as the instance.
        let instance = unsafe {
            let environment = (&raw const *environment).cast_mut().cast();
            fmi3InstantiateModelExchange(c"model".as_ptr(), token.as_ptr(), null(), 0, 1, environment, Some(log))
        };
        assert!(!instance.is_null(), "{:?}", environment.lines.take());
        Self { handle: Handle(instance), environment }
    }

    pub fn new(options: Options) -> Self {
        Self::try_new(options, &host::guid()).unwrap_or_else(|lines| panic!("{lines:?}"))
    }

    /// With a worn slider pin, in initialization mode at time 0.
    pub fn worn_pin(options: Options) -> Self {
        let slave = Self::new(options);
        assert_eq!(slave.enter(), Status::Ok);
        assert_eq!(slave.set_enumeration("joint.C.model", 2), Status::Ok);
        assert_eq!(slave.set("crank.speed_start", 500.0), Status::Ok);
        slave
    }

    /// The same, ready for the first step.
    pub fn running(options: Options) -> Self {
        let event_mode = options.event_mode;
        let slave = Self::worn_pin(options);
        slave.ready(event_mode);
        slave
    }

    /// Ends initialization.
    pub fn ready(&self, event_mode: bool) {
        assert_eq!(self.exit(), Status::Ok, "{:?}", self.lines());
        if event_mode {
            self.handle_event();
        }
    }

    /// The lines since the last look.
    pub fn lines(&self) -> Vec<Line> {
        self.environment.lines.take()
    }

    /// The only line since the last look.
    pub fn line(&self) -> Line {
        let lines = self.lines();
        assert_eq!(lines.len(), 1, "{lines:?}");
        lines.into_iter().next().expect("one line")
    }
}

/// `fmi3$function` on the instance.
macro_rules! calls {
    ($($name:ident = $function:ident($($argument:ident: $type:ty),*);)+) => {
        impl Handle {
            $(pub fn $name(&self $(, $argument: $type)*) -> Status {
                // SAFETY: the instance is live.
                unsafe { $function(self.0 $(, $argument)*) }
            })+
        }
    };
}

calls! {
    exit = fmi3ExitInitializationMode();
    enter_event_mode = fmi3EnterEventMode();
    enter_step_mode = fmi3EnterStepMode();
    enter_continuous_time_mode = fmi3EnterContinuousTimeMode();
    set_time = fmi3SetTime(time: f64);
    terminate = fmi3Terminate();
    reset = fmi3Reset();
    set_state = fmi3SetFMUState(state: fmi3FMUState);
}

impl Handle {
    pub fn enter(&self) -> Status {
        self.enter_with(None, 0.0, None)
    }

    pub fn enter_with(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Status {
        let (with_tolerance, with_stop) = (tolerance.is_some().into(), stop.is_some().into());
        let (tolerance, stop) = (tolerance.unwrap_or(f64::NAN), stop.unwrap_or(f64::NAN));
        // SAFETY: the instance is live.
        unsafe { fmi3EnterInitializationMode(self.0, with_tolerance, tolerance, start, with_stop, stop) }
    }

    pub fn set(&self, name: &str, value: f64) -> Status {
        // SAFETY: live instance, arrays of one entry.
        unsafe { fmi3SetFloat64(self.0, &vr(name), 1, &value, 1) }
    }

    pub fn try_get(&self, name: &str) -> Result<f64, Status> {
        self.try_get_reference(vr(name))
    }

    pub fn try_get_reference(&self, reference: u32) -> Result<f64, Status> {
        let mut value = f64::NAN;
        // SAFETY: live instance, arrays of one entry.
        let status = unsafe { fmi3GetFloat64(self.0, &reference, 1, &mut value, 1) };
        if status == Status::Ok { Ok(value) } else { Err(status) }
    }

    pub fn get(&self, name: &str) -> f64 {
        self.try_get(name).unwrap_or_else(|status| panic!("{name}: {status:?}"))
    }

    pub fn integer(&self, name: &str) -> i32 {
        let mut value = i32::MIN;
        // SAFETY: live instance, arrays of one entry.
        assert_eq!(unsafe { fmi3GetInt32(self.0, &vr(name), 1, &mut value, 1) }, Status::Ok);
        value
    }

    pub fn boolean(&self, name: &str) -> bool {
        let mut value = 7;
        // SAFETY: live instance, arrays of one entry.
        assert_eq!(unsafe { fmi3GetBoolean(self.0, &vr(name), 1, &mut value, 1) }, Status::Ok);
        assert!(value < 2);
        value == 1
    }

    pub fn enumeration(&self, name: &str) -> i64 {
        let mut value = i64::MIN;
        // SAFETY: live instance, arrays of one entry.
        assert_eq!(unsafe { fmi3GetInt64(self.0, &vr(name), 1, &mut value, 1) }, Status::Ok);
        value
    }

    pub fn set_enumeration(&self, name: &str, value: i64) -> Status {
        // SAFETY: live instance, arrays of one entry.
        unsafe { fmi3SetInt64(self.0, &vr(name), 1, &value, 1) }
    }

    pub fn set_integer(&self, name: &str, value: i32) -> Status {
        // SAFETY: live instance, arrays of one entry.
        unsafe { fmi3SetInt32(self.0, &vr(name), 1, &value, 1) }
    }

    pub fn try_step(&self, point: f64, size: f64) -> Result<Told, Status> {
        let (mut event, mut terminate, mut early, mut time) = (7, 7, 7, f64::NAN);
        // SAFETY: live instance, four places.
        let status = unsafe { fmi3DoStep(self.0, point, size, 1, &mut event, &mut terminate, &mut early, &mut time) };
        if status != Status::Ok {
            assert!([event, terminate, early] == [7; 3] && time.is_nan(), "answers of a step that is refused");
            return Err(status);
        }
        assert!(event < 2 && terminate < 2 && early < 2);
        Ok(Told { event: event == 1, terminate: terminate == 1, early: early == 1, time })
    }

    pub fn step(&self, point: f64, size: f64) -> Told {
        self.try_step(point, size).unwrap_or_else(|status| panic!("{status:?} at {point}"))
    }

    /// First time derivative of an output.
    pub fn rate(&self, name: &str) -> Result<f64, Status> {
        let mut rate = f64::NAN;
        // SAFETY: live instance, arrays of one entry.
        let status = unsafe { fmi3GetOutputDerivatives(self.0, &vr(name), 1, &1, &mut rate, 1) };
        if status == Status::Ok { Ok(rate) } else { Err(status) }
    }

    /// Penetration of each corner of the slider, and whether the corner touches.
    pub fn corners(&self) -> ([f64; 4], [bool; 4]) {
        let (mut depths, mut touching) = ([f64::NAN; 4], [7; 4]);
        // SAFETY: live instance, arrays of the lengths said.
        unsafe {
            assert_eq!(fmi3GetFloat64(self.0, &PENETRATIONS, 1, depths.as_mut_ptr(), 4), Status::Ok);
            assert_eq!(fmi3GetBoolean(self.0, &CONTACTS, 1, touching.as_mut_ptr(), 4), Status::Ok);
        }
        assert!(touching.iter().all(|value| *value < 2));
        (depths, touching.map(|value| value == 1))
    }

    /// Whether clocks are active.
    pub fn try_clocks(&self, references: &[u32]) -> Result<Vec<bool>, Status> {
        let mut values = vec![7; references.len()];
        // SAFETY: live instance, arrays of the length said.
        let status = unsafe { fmi3GetClock(self.0, references.as_ptr(), references.len(), values.as_mut_ptr()) };
        assert!(values.iter().all(|value| if status == Status::Ok { *value < 2 } else { *value == 7 }));
        if status == Status::Ok { Ok(values.iter().map(|value| *value == 1).collect()) } else { Err(status) }
    }

    pub fn update_discrete_states(&self) -> Status {
        let (mut flags, mut time) = ([7; 5], f64::NAN);
        let [need, terminate, nominals, values, defined] = &mut flags;
        // SAFETY: live instance, six places.
        let status =
            unsafe { fmi3UpdateDiscreteStates(self.0, need, terminate, nominals, values, defined, &raw mut time) };
        assert_eq!(flags, if status == Status::Ok { [0; 5] } else { [7; 5] });
        status
    }

    /// Handles an event, from event mode on.
    pub fn handle_event(&self) {
        assert_eq!(self.update_discrete_states(), Status::Ok);
        assert_eq!(self.enter_step_mode(), Status::Ok);
    }

    /// Goes to `end` by steps of `size`, through events; the instants of all events.
    pub fn run(&self, mut time: f64, size: f64, end: f64) -> Vec<f64> {
        let (mut events, mut point) = (vec![], 1);
        let from = time;
        while time < end {
            let next = from + f64::from(point) * size;
            let told = self.step(time, next - time);
            time = if told.early { told.time } else { next };
            if told.event {
                events.push(told.time);
                assert_eq!(self.enter_event_mode(), Status::Ok);
                self.handle_event();
            }
            point += i32::from(time == next);
        }
        events
    }

    pub fn try_save(&self) -> Result<fmi3FMUState, Status> {
        let mut state = null_mut();
        // SAFETY: live instance, one place.
        let status = unsafe { fmi3GetFMUState(self.0, &mut state) };
        if status == Status::Ok { Ok(state) } else { Err(status) }
    }

    pub fn save(&self) -> fmi3FMUState {
        self.try_save().expect("a state")
    }

    pub fn bytes_of(&self, state: fmi3FMUState) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: live instance, one place; then a buffer of the length said.
        unsafe {
            assert_eq!(fmi3SerializedFMUStateSize(self.0, state, &mut size), Status::Ok);
            let mut bytes = vec![0; size];
            assert_eq!(fmi3SerializeFMUState(self.0, state, bytes.as_mut_ptr(), size), Status::Ok);
            bytes
        }
    }

    pub fn deserialize(&self, bytes: &[u8]) -> Result<fmi3FMUState, Status> {
        let mut state = null_mut();
        // SAFETY: live instance, a buffer of the length said, one place.
        let status = unsafe { fmi3DeserializeFMUState(self.0, bytes.as_ptr(), bytes.len(), &mut state) };
        if status == Status::Ok { Ok(state) } else { Err(status) }
    }

    /// Every real output and input, as bits.
    pub fn picture(&self) -> Vec<u64> {
        use slidercrank::fmi::slave::variables::{Access, VARIABLES};
        let real = VARIABLES.iter().filter(|v| matches!(v.access, Access::RealOutput(_) | Access::Input { .. }));
        real.map(|variable| self.get(variable.name).to_bits()).collect()
    }
}
