//! An FMU's binary: its functions, and one instance of it. The harness's only `unsafe`.

#![allow(unsafe_code)]

use super::error::HostError;
use super::log::{Log, LogLine};
use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};
use std::fmt;
use std::path::Path;
use std::ptr::NonNull;
use std::sync::Arc;

/// fmi2Status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Done.
    Ok,
    /// Done, with something to say.
    Warning,
    /// Not done, but the instance is as before.
    Discard,
    /// Not done, and this instance is lost.
    Error,
    /// Not done, and all instances are lost.
    Fatal,
    /// Under way.
    Pending,
    /// A number that the standard does not know.
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
            known => write!(f, "fmi2{known:?}"),
        }
    }
}

/// fmi2Component.
type Component = *mut c_void;
/// fmi2Boolean.
type Boolean = c_int;
/// fmi2CallbackLogger, whose variable arguments nobody reads here.
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

/// Declares the functions that are looked up, with their types in C.
macro_rules! functions {
    ($($field:ident = $symbol:literal: fn($($argument:ty),*) $(-> $result:ty)?;)+) => {
        struct Functions { $($field: unsafe extern "C" fn($($argument),*) $(-> $result)?),+ }

        impl Functions {
            fn find(library: &libloading::Library, path: &Path) -> Result<Self, HostError> {
                Ok(Self { $($field: {
                    // SAFETY: the standard fixes this name's type; the FMU vouches for keeping to it.
                    let symbol = unsafe { library.get($symbol) };
                    *symbol.map_err(|_| HostError::Symbol { library: path.into(), symbol: $symbol })?
                }),+ })
            }
        }
    };
}

functions! {
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

/// A loaded binary.
pub struct Library {
    functions: Functions,
    /// Unloaded after the last instance, since every instance holds the library.
    _library: libloading::Library,
}

impl Library {
    /// Loads the shared library at `path` and looks up every function that a host needs.
    pub fn load(path: &Path) -> Result<Self, HostError> {
        // SAFETY: loading runs the FMU's initialisers, which is what the caller asks for.
        let library = unsafe { libloading::Library::new(path) }
            .map_err(|error| HostError::Load { library: path.into(), cause: cause(&error) })?;
        Ok(Self { functions: Functions::find(&library, path)?, _library: library })
    }

    /// The version of FMI that the binary was made for.
    pub fn version(&self) -> String {
        // SAFETY: no arguments; the answer is a static string.
        text(unsafe { (self.functions.get_version)() })
    }

    /// The platform of its types, `default` in practice.
    pub fn types_platform(&self) -> String {
        // SAFETY: no arguments; the answer is a static string.
        text(unsafe { (self.functions.get_types_platform)() })
    }
}

/// The loader's words with their cause, which libloading keeps apart.
fn cause(error: &libloading::Error) -> String {
    std::error::Error::source(error).map_or_else(|| error.to_string(), ToString::to_string)
}

/// A C string, or nothing.
fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: non-null above; the FMU vouches for the terminating zero.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

/// Receives the FMU's log lines. `message` may hold a format whose arguments are out of reach from here.
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
    // SAFETY: non-null above, and the `Log` that `Instance::new` passed, which outlives the instance.
    let log = unsafe { &*environment.cast::<Log>() };
    log.receive(LogLine { status: status.into(), category: text(category), message: text(message) });
}

/// One instance: each function of the standard as a safe call that hands back its status.
pub struct Instance {
    component: NonNull<c_void>,
    library: Arc<Library>,
    /// The FMU keeps pointers to both until it is freed.
    _callbacks: Box<Callbacks>,
    log: Arc<Log>,
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: `component` came from fmi2Instantiate and is freed here, once.
        unsafe { (self.library.functions.free_instance)(self.component.as_ptr()) }
    }
}

/// Declares get and set functions, whose lists of references and values have one length.
macro_rules! transfer {
    ($($(#[$doc:meta])* $name:ident($values:ty) = $pointer:ident;)+) => {$(
        $(#[$doc])*
        pub fn $name(&mut self, references: &[u32], values: $values) -> Status {
            assert_eq!(references.len(), values.len(), "one value for each reference");
            // SAFETY: a live component, and two lists of the length passed.
            unsafe {
                (self.library.functions.$name)(
                    self.component.as_ptr(), references.as_ptr(), references.len(), values.$pointer(),
                )
            }.into()
        }
    )+};
}

impl Instance {
    /// fmi2Instantiate, for co-simulation, invisible. A name or GUID with a zero byte is no C string and refused.
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
        // SAFETY: zero-terminated strings that live through the call, and callbacks that outlive the instance.
        let component = unsafe {
            (library.functions.instantiate)(
                name.as_ptr(),
                CO_SIMULATION,
                guid.as_ptr(),
                resources.as_ptr(),
                &*callbacks,
                0,
                logging.into(),
            )
        };
        match NonNull::new(component) {
            Some(component) => Ok(Self { component, library, _callbacks: callbacks, log }),
            None => Err(refused(log.last())),
        }
    }

    /// What it said last.
    pub fn last_log(&self) -> Option<String> {
        self.log.last()
    }

    /// fmi2SetupExperiment.
    pub fn setup_experiment(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Status {
        let (has_tolerance, has_stop) = (tolerance.is_some().into(), stop.is_some().into());
        let (tolerance, stop) = (tolerance.unwrap_or(0.0), stop.unwrap_or(0.0));
        let setup = self.library.functions.setup_experiment;
        // SAFETY: a live component.
        unsafe { setup(self.component.as_ptr(), has_tolerance, tolerance, start, has_stop, stop) }.into()
    }

    /// fmi2EnterInitializationMode.
    pub fn enter_initialization(&mut self) -> Status {
        // SAFETY: a live component.
        unsafe { (self.library.functions.enter_initialization)(self.component.as_ptr()) }.into()
    }

    /// fmi2ExitInitializationMode.
    pub fn exit_initialization(&mut self) -> Status {
        // SAFETY: a live component.
        unsafe { (self.library.functions.exit_initialization)(self.component.as_ptr()) }.into()
    }

    /// fmi2Terminate.
    pub fn terminate(&mut self) -> Status {
        // SAFETY: a live component.
        unsafe { (self.library.functions.terminate)(self.component.as_ptr()) }.into()
    }

    /// fmi2DoStep, never to be taken back.
    pub fn do_step(&mut self, time: f64, step: f64) -> Status {
        // SAFETY: a live component.
        unsafe { (self.library.functions.do_step)(self.component.as_ptr(), time, step, 1) }.into()
    }

    transfer! {
        /// fmi2GetReal.
        get_real(&mut [f64]) = as_mut_ptr;
        /// fmi2GetInteger, also of enumerations.
        get_integer(&mut [i32]) = as_mut_ptr;
        /// fmi2GetBoolean; 0 is false.
        get_boolean(&mut [i32]) = as_mut_ptr;
        /// fmi2SetReal.
        set_real(&[f64]) = as_ptr;
        /// fmi2SetInteger, also of enumerations.
        set_integer(&[i32]) = as_ptr;
        /// fmi2SetBoolean; 0 is false.
        set_boolean(&[i32]) = as_ptr;
    }

    /// fmi2SetString.
    pub fn set_string(&mut self, reference: u32, value: &CStr) -> Status {
        let set = self.library.functions.set_string;
        // SAFETY: a live component, one reference, and one string that lives through the call.
        unsafe { set(self.component.as_ptr(), &reference, 1, &value.as_ptr()) }.into()
    }
}
