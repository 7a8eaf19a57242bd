//! What can be wrong with an FMU, one sentence each.

use std::path::PathBuf;
use thiserror::Error;

/// Why an FMU cannot be opened, loaded, or asked.
#[derive(Debug, Error)]
pub enum HostError {
    /// The file cannot be read, or is no archive.
    #[error("{}: not a whole ZIP archive: {cause}", file.display())]
    Archive {
        /// The FMU.
        file: PathBuf,
        /// The reader's words.
        cause: String,
    },
    /// An entry of the archive breaks FMI's rules for it.
    #[error("{}: entry `{entry}` {fault}", file.display())]
    Entry {
        /// The FMU.
        file: PathBuf,
        /// Name inside the archive.
        entry: String,
        /// What is wrong with it.
        fault: &'static str,
    },
    /// An archive, but of something else.
    #[error("{}: no modelDescription.xml at the top of the archive", file.display())]
    NoDescription {
        /// The FMU.
        file: PathBuf,
    },
    /// The description cannot be understood.
    #[error("modelDescription.xml, byte {position}: {fault}")]
    Description {
        /// Where in the file.
        position: u64,
        /// What is wrong.
        fault: String,
    },
    /// No library for the platform that this program runs on.
    #[error("no `{wanted}` in the FMU; it has binaries for: {offered}")]
    NoBinary {
        /// The entry looked for.
        wanted: String,
        /// The platforms it has, or "none".
        offered: String,
    },
    /// The operating system refuses the library.
    #[error("{} cannot be loaded: {cause}", library.display())]
    Load {
        /// The unpacked library.
        library: PathBuf,
        /// The loader's words.
        cause: String,
    },
    /// A function that FMI 2.0 demands is missing.
    #[error("{} lacks the function {symbol}", library.display())]
    Symbol {
        /// The unpacked library.
        library: PathBuf,
        /// Its name in C.
        symbol: &'static str,
    },
    /// Instantiation returned nothing.
    #[error("the FMU refuses to be instantiated{}", because(log))]
    Refused {
        /// Its last log line.
        log: Option<String>,
    },
    /// A call failed.
    #[error("{call} answers {status}{}", because(log))]
    Call {
        /// The C function, and what it was asked.
        call: String,
        /// Anything but OK or Warning, by its name in C.
        status: String,
        /// Its last log line.
        log: Option<String>,
    },
    /// No variable of this name.
    #[error("the FMU has no variable `{name}`{}", did_you_mean(nearest))]
    Unknown {
        /// As asked for.
        name: String,
        /// The most similar name that exists.
        nearest: Option<String>,
    },
    /// A value that the variable cannot take.
    #[error("`{name}`: `{value}` is not {wanted}")]
    Value {
        /// The variable.
        name: String,
        /// As given.
        value: String,
        /// What it may be.
        wanted: String,
    },
    /// The temporary directory cannot be written.
    #[error("cannot unpack the FMU: {0}")]
    Unpack(#[from] std::io::Error),
}

/// `: <log line>`, where there is one.
fn because(log: &Option<String>) -> String {
    log.as_ref().map(|line| format!(": {line}")).unwrap_or_default()
}

/// `; did you mean …?`, where something is near.
fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}
