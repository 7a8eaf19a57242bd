//! Errors of FMUs, each in one sentence.

use std::path::PathBuf;
use thiserror::Error;

/// An FMU cannot be opened or loaded, or a call failed.
#[derive(Debug, Error)]
pub enum HostError {
    /// The file cannot be opened.
    #[error("{}: {cause}", file.display())]
    File {
        /// The FMU.
        file: PathBuf,
        /// Message of the operating system.
        cause: std::io::Error,
    },
    /// The file cannot be read to its end or is not an archive.
    #[error("{}: not a complete ZIP archive: {cause}", file.display())]
    Archive {
        /// The FMU.
        file: PathBuf,
        /// Message of the ZIP reader.
        cause: String,
    },
    /// An entry of the archive breaks FMI's rules.
    #[error("{}: entry `{entry}` {fault}", file.display())]
    Entry {
        /// The FMU.
        file: PathBuf,
        /// Name inside the archive.
        entry: String,
        /// The broken rule, as the end of a sentence.
        fault: &'static str,
    },
    /// The archive is not an FMU.
    #[error("{}: no modelDescription.xml at the top of the archive", file.display())]
    NoDescription {
        /// The FMU.
        file: PathBuf,
    },
    /// The model description cannot be read.
    #[error("modelDescription.xml, byte {position}: {fault}")]
    Description {
        /// Position in the file, in bytes.
        position: u64,
        /// The fault.
        fault: String,
    },
    /// The FMU has no library for this program's platform.
    #[error("the FMU does not contain `{wanted}`; it has binaries for: {offered}")]
    NoBinary {
        /// The missing entry.
        wanted: String,
        /// Platforms of the binaries that it has, or "none".
        offered: String,
    },
    /// The operating system cannot load the library.
    #[error("{} cannot be loaded: {cause}", library.display())]
    Load {
        /// The unpacked library.
        library: PathBuf,
        /// Message of the loader.
        cause: String,
    },
    /// A function that the standard requires is missing.
    #[error("{} lacks the function {symbol}", library.display())]
    Symbol {
        /// The unpacked library.
        library: PathBuf,
        /// Its name in C.
        symbol: &'static str,
    },
    /// Instantiation returned a null pointer.
    #[error("the FMU could not be instantiated{}", because(log))]
    Refused {
        /// Its last log line.
        log: Option<String>,
    },
    /// A call failed.
    #[error("{call} returned {status}{}", because(log))]
    Call {
        /// The C function and its arguments.
        call: String,
        /// A status other than OK and Warning, by its name in C.
        status: String,
        /// Its last log line.
        log: Option<String>,
    },
    /// No variable of this name.
    #[error("the FMU has no variable `{name}`{}", did_you_mean(nearest))]
    Unknown {
        /// The name that was given.
        name: String,
        /// The most similar name of a variable.
        nearest: Option<String>,
    },
    /// A value that the variable cannot take.
    #[error("`{name}`: `{value}` is not {wanted}")]
    Value {
        /// The variable.
        name: String,
        /// The value that was given.
        value: String,
        /// The values that it can take.
        wanted: String,
    },
    /// The temporary directory cannot be written.
    #[error("cannot unpack the FMU: {0}")]
    Unpack(#[from] std::io::Error),
}

/// `: <log line>`, if there is a log line.
fn because(log: &Option<String>) -> String {
    log.as_ref().map(|line| format!(": {line}")).unwrap_or_default()
}

/// `; did you mean …?`, if there is a similar name.
fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}
