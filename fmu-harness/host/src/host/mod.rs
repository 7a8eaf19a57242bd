//! A host of FMUs: `Fmu::open`, then `instantiate`, then a `Slave` whose type is its state in the life cycle of FMI 2.0
//! §4.2.4. FMUs of FMI 3.0 are used in the same way, without event mode.

mod archive;
mod description;
mod error;
mod library;
mod log;
mod parser;
mod selection;
mod value;

pub use archive::{Archive, PLATFORM};
pub use description::{Attributes, Description, Kind, Structure, Unknown, Variable};
pub use error::HostError;
pub use library::{Library, Status, Version};
pub use log::{Log, LogLine};
pub use selection::Selection;
pub use value::{Setting, Value};

use library::Instance;
use std::ffi::CString;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tempfile::TempDir;

/// An unpacked FMU with its binary loaded. Dropping it removes the directory.
pub struct Fmu {
    description: Description,
    library: Arc<Library>,
    resources: String,
    _directory: TempDir,
}

impl Fmu {
    /// Reads the file, unpacks it to a directory of its own and loads the binary of this platform.
    pub fn open(file: &Path) -> Result<Self, HostError> {
        let mut archive = Archive::open(file)?;
        let description = Description::parse(&archive.description()?)?;
        let (binary, version) = binary_of(&description, &archive)?;
        let directory = TempDir::with_prefix("fmu-")?;
        archive.unpack(directory.path())?;
        let library = Arc::new(Library::load(&directory.path().join(binary), version)?);
        let resources = directory.path().join("resources");
        let resources = match version {
            Version::Fmi2 => file_uri(&resources),
            Version::Fmi3 => format!("{}{}", resources.display(), std::path::MAIN_SEPARATOR),
        };
        Ok(Self { description, library, resources, _directory: directory })
    }

    /// Its model description.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Whether inputs can follow straight lines over a communication step.
    pub fn interpolates_inputs(&self) -> bool {
        let promised = self.description.co_simulation.as_ref().is_some_and(|of| of.flag("canInterpolateInputs"));
        promised && self.library.takes_input_derivatives()
    }

    /// Makes an instance whose log lines go to `log`.
    pub fn instantiate(&self, name: &str, log: Arc<Log>, logging: bool) -> Result<Slave<'_, Instantiated>, HostError> {
        let model = &self.description.model;
        let guid = model.get("guid").or_else(|| model.get("instantiationToken")).unwrap_or_default();
        let instance = Instance::new(Arc::clone(&self.library), name, guid, &self.resources, log, logging)?;
        Ok(Slave { instance, description: &self.description, phase: PhantomData })
    }
}

/// Path of this platform's binary inside the archive. An FMU without co-simulation, or without such a binary, is an
/// error.
fn binary_of(description: &Description, archive: &Archive) -> Result<(PathBuf, Version), HostError> {
    let fault = |fault: String| HostError::Description { position: 0, fault };
    let (version, platform) = match description.version() {
        "2.0" => (Version::Fmi2, PLATFORM.to_owned()),
        three if three == "3.0" || three.starts_with("3.0.") => (Version::Fmi3, platform_of_fmi3()),
        version => return Err(fault(format!("the FMI version is {version}; this program reads 2.0 and 3.0"))),
    };
    let identifier = description.co_simulation.as_ref().and_then(|element| element.get("modelIdentifier"));
    let identifier = identifier.ok_or_else(|| fault("the FMU has no co-simulation interface".into()))?;
    let wanted = format!("binaries/{platform}/{identifier}{}", std::env::consts::DLL_SUFFIX);
    if archive.names().contains(&wanted) {
        return Ok((wanted.into(), version));
    }
    let platforms = archive.platforms();
    let offered = if platforms.is_empty() { "none".into() } else { platforms.join(", ") };
    Err(HostError::NoBinary { wanted, offered })
}

/// FMI 3.0's name of the platform that this program runs on.
fn platform_of_fmi3() -> String {
    let system = if cfg!(target_os = "macos") { "darwin" } else { std::env::consts::OS };
    format!("{}-{system}", std::env::consts::ARCH)
}

/// The URI `file:///…` of a directory, percent-encoded after RFC 3986.
fn file_uri(path: &Path) -> String {
    let path = path.to_string_lossy().replace('\\', "/");
    let root = if path.starts_with('/') { "" } else { "/" };
    let mut uri = format!("file://{root}");
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'-' | b'_' | b'.' | b'~' | b':' => uri.push(byte.into()),
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}

/// Instantiated: start values can be set.
pub struct Instantiated;
/// In initialization mode: start values and inputs can be set, outputs can be read.
pub struct Initialising;
/// At a communication point: inputs can be set, outputs can be read, steps can be taken.
pub struct Stepping;

/// One instance of an FMU.
pub struct Slave<'a, Phase> {
    instance: Instance,
    description: &'a Description,
    phase: PhantomData<Phase>,
}

impl<'a, Phase> Slave<'a, Phase> {
    /// Sets one variable.
    pub fn set(&mut self, variable: &Variable, value: &Value) -> Result<(), HostError> {
        let reference = [variable.reference];
        let status = match value {
            Value::Real(number) => self.instance.set_real(&reference, &[*number]),
            Value::Integer(number) if variable.kind == Kind::Enumeration => {
                self.instance.set_enumeration(variable.reference, *number)
            }
            Value::Integer(number) => self.instance.set_integer(&reference, &[*number]),
            Value::Boolean(flag) => self.instance.set_boolean(variable.reference, *flag),
            Value::String(text) => {
                let text = CString::new(text.as_str()).map_err(|_| HostError::Value {
                    name: variable.name.clone(),
                    value: text.clone(),
                    wanted: "a string without null characters".into(),
                })?;
                self.instance.set_string(variable.reference, &text)
            }
        };
        self.check(status, || format!("setting `{}`", variable.name))
    }

    /// Sets real variables by reference.
    pub fn set_reals(&mut self, references: &[u32], values: &[f64]) -> Result<(), HostError> {
        let status = self.instance.set_real(references, values);
        self.check(status, || format!("setting the reals {references:?}"))
    }

    /// Returns an error with the FMU's last log line unless the status is OK or Warning.
    fn check(&self, status: Status, call: impl FnOnce() -> String) -> Result<(), HostError> {
        match status {
            Status::Ok | Status::Warning => Ok(()),
            status => Err(HostError::Call { call: call(), status: self.named(status), log: self.instance.last_log() }),
        }
    }

    /// Name of a function in the FMU's version of FMI.
    fn function(&self, name: &str) -> String {
        format!("{}{name}", self.instance.version().prefix())
    }

    /// Name of a status in the FMU's version of FMI.
    fn named(&self, status: Status) -> String {
        match status {
            Status::Unknown(_) => status.to_string(),
            known => self.function(&known.to_string()),
        }
    }

    fn into_phase<Next>(self) -> Slave<'a, Next> {
        Slave { instance: self.instance, description: self.description, phase: PhantomData }
    }
}

impl<'a> Slave<'a, Instantiated> {
    /// Sets the experiment up and enters initialization mode.
    pub fn enter_initialization(
        mut self,
        tolerance: Option<f64>,
        start: f64,
        stop: Option<f64>,
    ) -> Result<Slave<'a, Initialising>, HostError> {
        let status = self.instance.setup_experiment(tolerance, start, stop);
        self.check(status, || self.function("SetupExperiment"))?;
        let status = self.instance.enter_initialization();
        self.check(status, || self.function("EnterInitializationMode"))?;
        Ok(self.into_phase())
    }
}

impl<'a> Slave<'a, Initialising> {
    /// Leaves initialization mode.
    pub fn exit_initialization(mut self) -> Result<Slave<'a, Stepping>, HostError> {
        let status = self.instance.exit_initialization();
        self.check(status, || self.function("ExitInitializationMode"))?;
        Ok(self.into_phase())
    }
}

impl Slave<'_, Stepping> {
    /// Takes the communication step from `time` to `time + step`.
    pub fn do_step(&mut self, time: f64, step: f64) -> Result<(), HostError> {
        let status = self.instance.do_step(time, step);
        self.check(status, || format!("{} from {time} s by {step} s", self.function("DoStep")))
    }

    /// Sets real inputs by reference, with their slopes [1/s] from the communication point on. The FMU must
    /// [interpolate inputs](Fmu::interpolates_inputs).
    pub fn set_lines(&mut self, references: &[u32], values: &[f64], slopes: &[f64]) -> Result<(), HostError> {
        self.set_reals(references, values)?;
        let status = self.instance.set_input_derivatives(references, slopes);
        self.check(status, || format!("setting slopes of the reals {references:?}"))
    }

    /// Ends the run.
    pub fn terminate(mut self) -> Result<(), HostError> {
        let status = self.instance.terminate();
        self.check(status, || self.function("Terminate"))
    }
}

/// States in which variables can be read.
pub trait Readable {}
impl Readable for Initialising {}
impl Readable for Stepping {}

impl<Phase: Readable> Slave<'_, Phase> {
    /// Reads the variables of a selection.
    pub fn read(&mut self, selection: &mut Selection) -> Result<(), HostError> {
        let status = selection.read_from(&mut self.instance);
        self.check(status, || "reading outputs".into())
    }

    /// Reads one variable as a number.
    pub fn read_one(&mut self, name: &str) -> Result<f64, HostError> {
        let mut selection = Selection::new([self.description.variable(name)?]);
        self.read(&mut selection)?;
        Ok(selection.values()[0])
    }
}
