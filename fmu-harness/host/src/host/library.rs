//! The binary of an FMU of FMI 2.0 or 3.0: its functions and its instances. The harness has `unsafe` code only here.

#![allow(unsafe_code)]

use super::error::HostError;
use super::log::{Log, LogLine};
use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};
use std::fmt;
use std::path::Path;
use std::ptr::NonNull;
use std::sync::Arc;

/// fmi2Status, fmi3Status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Success.
    Ok,
    /// Success, with a warning in the log.
    Warning,
    /// The call did nothing; the instance can go on.
    Discard,
    /// The call failed; this instance must not be used any more.
    Error,
    /// The call failed; no instance must be used any more.
    Fatal,
    /// The step has not finished yet.
    Pending,
    /// A number that the standard does not define.
    Unknown(c_int),
}

impl From<c_int> for Status {
    fn from(value: c_int) -> Self {
        match value {
            0 => Self::Ok,
            1 => Self::Warning,
            2 => Self::Discard,
            3 => Self::Error,
            4 => Self::Fatal,
            5 => Self::Pending,
            other => Self::Unknown(other),
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(value) => write!(f, "the unknown status {value}"),
            known => write!(f, "{known:?}"),
        }
    }
}

/// fmi2Component.
type Component = *mut c_void;
/// fmi2Boolean.
type Boolean = c_int;
/// fmi2CallbackLogger. Its variable arguments are not read.
type Logger = extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char);

/// fmi2CallbackFunctions.
#[repr(C)]
struct Callbacks {
    logger: Logger,
    allocate_memory: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    free_memory: unsafe extern "C" fn(*mut c_void),
    step_finished: Option<extern "C" fn(*mut c_void, c_int)>,
    environment: *mut c_void,
}

/// fmi3LogMessageCallback.
type Logger3 = extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

/// Declares a table of functions, with their names and types in C.
macro_rules! functions {
    ($name:ident; $($field:ident = $symbol:literal: fn($($argument:ty),*) $(-> $result:ty)?;)+) => {
        struct $name { $($field: unsafe extern "C" fn($($argument),*) $(-> $result)?),+ }

        impl $name {
            fn find(library: &libloading::Library, path: &Path) -> Result<Self, HostError> {
                Ok(Self { $($field: {
                    // SAFETY: the standard defines the type of this function; the FMU must conform to it.
                    let symbol = unsafe { library.get($symbol) };
                    *symbol.map_err(|_| HostError::Symbol { library: path.into(), symbol: $symbol })?
                }),+ })
            }
        }
    };
}

functions! { Functions2;
    get_version = "fmi2GetVersion": fn() -> *const c_char;
    get_types_platform = "fmi2GetTypesPlatform": fn() -> *const c_char;
    instantiate = "fmi2Instantiate":
        fn(*const c_char, c_int, *const c_char, *const c_char, *const Callbacks, Boolean, Boolean) -> Component;
    free_instance = "fmi2FreeInstance": fn(Component);
    setup_experiment = "fmi2SetupExperiment": fn(Component, Boolean, f64, f64, Boolean, f64) -> c_int;
    enter_initialization = "fmi2EnterInitializationMode": fn(Component) -> c_int;
    exit_initialization = "fmi2ExitInitializationMode": fn(Component) -> c_int;
    terminate = "fmi2Terminate": fn(Component) -> c_int;
    get_real = "fmi2GetReal": fn(Component, *const c_uint, usize, *mut f64) -> c_int;
    get_integer = "fmi2GetInteger": fn(Component, *const c_uint, usize, *mut c_int) -> c_int;
    get_boolean = "fmi2GetBoolean": fn(Component, *const c_uint, usize, *mut Boolean) -> c_int;
    set_real = "fmi2SetReal": fn(Component, *const c_uint, usize, *const f64) -> c_int;
    set_integer = "fmi2SetInteger": fn(Component, *const c_uint, usize, *const c_int) -> c_int;
    set_boolean = "fmi2SetBoolean": fn(Component, *const c_uint, usize, *const Boolean) -> c_int;
    set_string = "fmi2SetString": fn(Component, *const c_uint, usize, *const *const c_char) -> c_int;
    do_step = "fmi2DoStep": fn(Component, f64, f64, Boolean) -> c_int;
}

functions! { InputDerivatives2;
    set = "fmi2SetRealInputDerivatives": fn(Component, *const c_uint, usize, *const c_int, *const f64) -> c_int;
}

functions! { Functions3;
    get_version = "fmi3GetVersion": fn() -> *const c_char;
    instantiate = "fmi3InstantiateCoSimulation": fn(
        *const c_char, *const c_char, *const c_char, bool, bool, bool, bool, *const c_uint, usize, *mut c_void, Logger3,
        *const c_void
    ) -> Component;
    free_instance = "fmi3FreeInstance": fn(Component);
    enter_initialization = "fmi3EnterInitializationMode": fn(Component, bool, f64, f64, bool, f64) -> c_int;
    exit_initialization = "fmi3ExitInitializationMode": fn(Component) -> c_int;
    terminate = "fmi3Terminate": fn(Component) -> c_int;
    get_real = "fmi3GetFloat64": fn(Component, *const c_uint, usize, *mut f64, usize) -> c_int;
    get_integer = "fmi3GetInt32": fn(Component, *const c_uint, usize, *mut i32, usize) -> c_int;
    get_enumeration = "fmi3GetInt64": fn(Component, *const c_uint, usize, *mut i64, usize) -> c_int;
    get_boolean = "fmi3GetBoolean": fn(Component, *const c_uint, usize, *mut u8, usize) -> c_int;
    set_real = "fmi3SetFloat64": fn(Component, *const c_uint, usize, *const f64, usize) -> c_int;
    set_integer = "fmi3SetInt32": fn(Component, *const c_uint, usize, *const i32, usize) -> c_int;
    set_enumeration = "fmi3SetInt64": fn(Component, *const c_uint, usize, *const i64, usize) -> c_int;
    set_boolean = "fmi3SetBoolean": fn(Component, *const c_uint, usize, *const u8, usize) -> c_int;
    set_string = "fmi3SetString": fn(Component, *const c_uint, usize, *const *const c_char, usize) -> c_int;
    do_step = "fmi3DoStep": fn(Component, f64, f64, bool, *mut u8, *mut u8, *mut u8, *mut f64) -> c_int;
}

/// The functions of the binary's version of FMI.
enum Functions {
    Fmi2(Functions2),
    Fmi3(Functions3),
}

/// The version of FMI of a binary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Fmi2,
    /// FMI 3.0.
    Fmi3,
}

impl Version {
    /// Prefix of its functions' names.
    pub fn prefix(self) -> &'static str {
        match self {
            Self::Fmi2 => "fmi2",
            Self::Fmi3 => "fmi3",
        }
    }
}

/// A loaded binary.
pub struct Library {
    functions: Functions,
    /// Only FMI 2.0 has such a function, and not all its binaries do.
    input_derivatives: Option<InputDerivatives2>,
    /// Every instance holds the library, so it is unloaded after the last one.
    _library: libloading::Library,
}

impl Library {
    /// Loads the shared library at `path` and finds every function that a host needs.
    pub fn load(path: &Path, version: Version) -> Result<Self, HostError> {
        // SAFETY: loading runs the FMU's initialisers, as the caller intends.
        let library = unsafe { libloading::Library::new(path) }
            .map_err(|error| HostError::Load { library: path.into(), cause: cause(&error) })?;
        let (functions, input_derivatives) = match version {
            Version::Fmi2 => {
                (Functions::Fmi2(Functions2::find(&library, path)?), InputDerivatives2::find(&library, path).ok())
            }
            Version::Fmi3 => (Functions::Fmi3(Functions3::find(&library, path)?), None),
        };
        Ok(Self { functions, input_derivatives, _library: library })
    }

    /// Whether it has fmi2SetRealInputDerivatives.
    pub fn takes_input_derivatives(&self) -> bool {
        self.input_derivatives.is_some()
    }

    /// The version of FMI, as the binary returns it.
    pub fn version(&self) -> String {
        // SAFETY: no arguments; the function returns a static string.
        text(unsafe {
            match &self.functions {
                Functions::Fmi2(functions) => (functions.get_version)(),
                Functions::Fmi3(functions) => (functions.get_version)(),
            }
        })
    }

    /// The types' platform: `default` in all known FMUs of FMI 2.0; FMI 3.0 has no such function.
    pub fn types_platform(&self) -> String {
        match &self.functions {
            // SAFETY: no arguments; the function returns a static string.
            Functions::Fmi2(functions) => text(unsafe { (functions.get_types_platform)() }),
            Functions::Fmi3(_) => "default".into(),
        }
    }
}

/// The loader's message with its cause, which libloading reports separately.
fn cause(error: &libloading::Error) -> String {
    std::error::Error::source(error).map_or_else(|| error.to_string(), ToString::to_string)
}

/// A C string; a null pointer gives an empty string.
fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: not null, see above; the FMU must terminate the string with a null character.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

/// Receives the FMU's log lines. `message` may be a format whose arguments cannot be read here.
extern "C" fn receive(
    environment: *mut c_void,
    _instance: *const c_char,
    status: c_int,
    category: *const c_char,
    message: *const c_char,
) {
    if environment.is_null() {
        return;
    }
    // SAFETY: not null, see above; it is the `Log` that `Instance::new` passed, which outlives the instance.
    let log = unsafe { &*environment.cast::<Log>() };
    log.receive(LogLine { status: status.into(), category: text(category), message: text(message) });
}

/// Receives the log lines of an FMU of FMI 3.0.
extern "C" fn receive3(environment: *mut c_void, status: c_int, category: *const c_char, message: *const c_char) {
    receive(environment, std::ptr::null(), status, category, message);
}

/// Times and tolerance, which FMI 3.0 takes when initialization mode is entered.
#[derive(Clone, Copy, Default)]
struct Setup {
    tolerance: Option<f64>,
    start: f64,
    stop: Option<f64>,
}

/// An instance. Each function of the standard is a safe method that returns the status.
pub struct Instance {
    component: NonNull<c_void>,
    library: Arc<Library>,
    /// The FMU holds pointers to both until it is freed.
    _callbacks: Box<Callbacks>,
    log: Arc<Log>,
    setup: Setup,
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: `component` came from instantiation and is freed here, once.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(functions) => (functions.free_instance)(self.component.as_ptr()),
                Functions::Fmi3(functions) => (functions.free_instance)(self.component.as_ptr()),
            }
        }
    }
}

/// Declares get and set functions. They take as many values as value references.
macro_rules! transfer {
    ($($(#[$doc:meta])* $name:ident($values:ty) = $pointer:ident;)+) => {$(
        $(#[$doc])*
        pub fn $name(&mut self, references: &[u32], values: $values) -> Status {
            assert_eq!(references.len(), values.len(), "one value for each reference");
            let (component, n) = (self.component.as_ptr(), references.len());
            // SAFETY: a live component, and two lists of the length passed.
            unsafe {
                match &self.library.functions {
                    Functions::Fmi2(of) => (of.$name)(component, references.as_ptr(), n, values.$pointer()),
                    Functions::Fmi3(of) => (of.$name)(component, references.as_ptr(), n, values.$pointer(), n),
                }
            }.into()
        }
    )+};
}

impl Instance {
    /// Instantiates for co-simulation, invisible, without event mode. A name or GUID with a null character is refused.
    pub fn new(
        library: Arc<Library>,
        name: &str,
        guid: &str,
        resources: &str,
        log: Arc<Log>,
        logging: bool,
    ) -> Result<Self, HostError> {
        let refused = |log: Option<String>| HostError::Refused { log };
        let c_string = |text: &str| CString::new(text).map_err(|error| refused(Some(error.to_string())));
        let (name, guid, resources) = (c_string(name)?, c_string(guid)?, c_string(resources)?);
        let callbacks = Box::new(Callbacks {
            logger: receive,
            allocate_memory: libc::calloc,
            free_memory: libc::free,
            step_finished: None,
            environment: Arc::as_ptr(&log).cast_mut().cast(),
        });
        const CO_SIMULATION: c_int = 1;
        let (name, guid, resources) = (name.as_ptr(), guid.as_ptr(), resources.as_ptr());
        // SAFETY: zero-terminated strings that live through the call, and callbacks that outlive the instance.
        let component = unsafe {
            match &library.functions {
                Functions::Fmi2(functions) => {
                    (functions.instantiate)(name, CO_SIMULATION, guid, resources, &*callbacks, 0, logging.into())
                }
                Functions::Fmi3(functions) => {
                    let (environment, none) = (callbacks.environment, std::ptr::null());
                    (functions.instantiate)(
                        name,
                        guid,
                        resources,
                        false,
                        logging,
                        false,
                        false,
                        none,
                        0,
                        environment,
                        receive3,
                        none.cast(),
                    )
                }
            }
        };
        match NonNull::new(component) {
            Some(component) => Ok(Self { component, library, _callbacks: callbacks, log, setup: Setup::default() }),
            None => Err(refused(log.last())),
        }
    }

    /// Message of its last log line.
    pub fn last_log(&self) -> Option<String> {
        self.log.last()
    }

    /// fmi2SetupExperiment; with FMI 3.0 the values are passed by [`Instance::enter_initialization`].
    pub fn setup_experiment(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Status {
        self.setup = Setup { tolerance, start, stop };
        let (has_tolerance, has_stop) = (tolerance.is_some().into(), stop.is_some().into());
        let (tolerance, stop) = (tolerance.unwrap_or(0.0), stop.unwrap_or(0.0));
        match &self.library.functions {
            // SAFETY: a live component.
            Functions::Fmi2(functions) => unsafe {
                (functions.setup_experiment)(self.component.as_ptr(), has_tolerance, tolerance, start, has_stop, stop)
            }
            .into(),
            Functions::Fmi3(_) => Status::Ok,
        }
    }

    /// EnterInitializationMode.
    pub fn enter_initialization(&mut self) -> Status {
        let Setup { tolerance, start, stop } = self.setup;
        let component = self.component.as_ptr();
        // SAFETY: a live component.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(functions) => (functions.enter_initialization)(component),
                Functions::Fmi3(functions) => {
                    let (has_tolerance, has_stop) = (tolerance.is_some(), stop.is_some());
                    let (tolerance, stop) = (tolerance.unwrap_or(0.0), stop.unwrap_or(0.0));
                    (functions.enter_initialization)(component, has_tolerance, tolerance, start, has_stop, stop)
                }
            }
        }
        .into()
    }

    /// ExitInitializationMode.
    pub fn exit_initialization(&mut self) -> Status {
        // SAFETY: a live component.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(functions) => (functions.exit_initialization)(self.component.as_ptr()),
                Functions::Fmi3(functions) => (functions.exit_initialization)(self.component.as_ptr()),
            }
        }
        .into()
    }

    /// Terminate.
    pub fn terminate(&mut self) -> Status {
        // SAFETY: a live component.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(functions) => (functions.terminate)(self.component.as_ptr()),
                Functions::Fmi3(functions) => (functions.terminate)(self.component.as_ptr()),
            }
        }
        .into()
    }

    /// DoStep. The host will not return to a time before the step.
    pub fn do_step(&mut self, time: f64, step: f64) -> Status {
        let component = self.component.as_ptr();
        match &self.library.functions {
            // SAFETY: a live component.
            Functions::Fmi2(functions) => unsafe { (functions.do_step)(component, time, step, 1) },
            Functions::Fmi3(functions) => {
                let ([mut event, mut terminate, mut early], mut reached) = ([0; 3], 0.0);
                // SAFETY: a live component, and four places that live through the call.
                unsafe {
                    (functions.do_step)(
                        component,
                        time,
                        step,
                        true,
                        &mut event,
                        &mut terminate,
                        &mut early,
                        &mut reached,
                    )
                }
            }
        }
        .into()
    }

    /// The binary's version of FMI.
    pub fn version(&self) -> Version {
        match &self.library.functions {
            Functions::Fmi2(_) => Version::Fmi2,
            Functions::Fmi3(_) => Version::Fmi3,
        }
    }

    transfer! {
        /// fmi2GetReal, fmi3GetFloat64.
        get_real(&mut [f64]) = as_mut_ptr;
        /// fmi2GetInteger, fmi3GetInt32.
        get_integer(&mut [i32]) = as_mut_ptr;
        /// fmi2SetReal, fmi3SetFloat64.
        set_real(&[f64]) = as_ptr;
        /// fmi2SetInteger, fmi3SetInt32.
        set_integer(&[i32]) = as_ptr;
    }

    /// fmi2SetRealInputDerivatives of the first order.
    ///
    /// # Panics
    /// If the library has no such function.
    pub fn set_input_derivatives(&mut self, references: &[u32], slopes: &[f64]) -> Status {
        assert_eq!(references.len(), slopes.len(), "one slope for each reference");
        let (n, orders) = (references.len(), vec![1; references.len()]);
        let set = self.library.input_derivatives.as_ref().expect("the library takes slopes of inputs").set;
        // SAFETY: a live component, and three lists of the length passed.
        unsafe { set(self.component.as_ptr(), references.as_ptr(), n, orders.as_ptr(), slopes.as_ptr()) }.into()
    }

    /// fmi2GetInteger, fmi3GetInt64.
    pub fn get_enumeration(&mut self, references: &[u32], values: &mut [i32]) -> Status {
        let Functions::Fmi3(functions) = &self.library.functions else {
            return self.get_integer(references, values);
        };
        let (n, mut wide) = (references.len(), vec![0; values.len()]);
        assert_eq!(n, wide.len(), "one value for each reference");
        let get = functions.get_enumeration;
        // SAFETY: a live component, and two lists of the length passed.
        let status = unsafe { get(self.component.as_ptr(), references.as_ptr(), n, wide.as_mut_ptr(), n) };
        values.iter_mut().zip(wide).for_each(|(value, wide)| *value = wide as i32);
        status.into()
    }

    /// fmi2GetBoolean, fmi3GetBoolean; 0 is false.
    pub fn get_boolean(&mut self, references: &[u32], values: &mut [i32]) -> Status {
        let n = references.len();
        assert_eq!(n, values.len(), "one value for each reference");
        let (component, list) = (self.component.as_ptr(), references.as_ptr());
        match &self.library.functions {
            // SAFETY: a live component, and two lists of the length passed.
            Functions::Fmi2(functions) => unsafe { (functions.get_boolean)(component, list, n, values.as_mut_ptr()) },
            Functions::Fmi3(functions) => {
                let mut bytes = vec![0; n];
                // SAFETY: as above.
                let status = unsafe { (functions.get_boolean)(component, list, n, bytes.as_mut_ptr(), n) };
                values.iter_mut().zip(bytes).for_each(|(value, byte)| *value = byte.into());
                status
            }
        }
        .into()
    }

    /// fmi2SetInteger, fmi3SetInt64, of one enumeration.
    pub fn set_enumeration(&mut self, reference: u32, value: i32) -> Status {
        let Functions::Fmi3(functions) = &self.library.functions else {
            return self.set_integer(&[reference], &[value]);
        };
        // SAFETY: a live component, one reference and one value.
        unsafe { (functions.set_enumeration)(self.component.as_ptr(), &reference, 1, &value.into(), 1) }.into()
    }

    /// fmi2SetBoolean, fmi3SetBoolean, of one variable.
    pub fn set_boolean(&mut self, reference: u32, value: bool) -> Status {
        let component = self.component.as_ptr();
        // SAFETY: a live component, one reference and one value.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(functions) => (functions.set_boolean)(component, &reference, 1, &value.into()),
                Functions::Fmi3(functions) => (functions.set_boolean)(component, &reference, 1, &value.into(), 1),
            }
        }
        .into()
    }

    /// fmi2SetString, fmi3SetString.
    pub fn set_string(&mut self, reference: u32, value: &CStr) -> Status {
        let component = self.component.as_ptr();
        // SAFETY: a live component, one reference, and one string that lives through the call.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(functions) => (functions.set_string)(component, &reference, 1, &value.as_ptr()),
                Functions::Fmi3(functions) => (functions.set_string)(component, &reference, 1, &value.as_ptr(), 1),
            }
        }
        .into()
    }
}
