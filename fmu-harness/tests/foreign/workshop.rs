//! Where the foreign FMU is made, whole or broken.

use fmu_harness::package::archive::{Part, write};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// The foreign FMU's description.
pub const XML: &str = include_str!("modelDescription.xml");

/// The parts of the FMU, in a directory that the test fills with what it changes.
pub struct Workshop {
    pub directory: TempDir,
    library: Vec<u8>,
}

impl Workshop {
    pub fn open() -> Self {
        let directory = TempDir::new().expect("a directory");
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/foreign/decay.c");
        let target = directory.path().join("decay.so");
        let compiled =
            Command::new("cc").args(["-shared", "-fPIC", "-O1", "-o"]).arg(&target).arg(source).arg("-lm").status();
        assert!(compiled.expect("a C compiler").success());
        Self { library: fs::read(target).expect("the library"), directory }
    }

    pub fn fmu(&self, xml: &str, binary: &str) -> PathBuf {
        self.archive(&[Part::new("modelDescription.xml", xml), Part::new(binary, self.library.clone())])
    }

    pub fn archive(&self, parts: &[Part]) -> PathBuf {
        let file = self.directory.path().join("decay.fmu");
        fs::write(&file, write(parts).expect("an archive")).expect("written");
        file
    }

    pub fn good(&self) -> PathBuf {
        self.fmu(XML, "binaries/linux64/decay.so")
    }
}
