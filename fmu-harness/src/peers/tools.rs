//! Finds or builds the tools that the other programs need.

use super::Task;
use super::programs::{Kind, Program};
use crate::package::build::{cargo, workspace};
use crate::python::{self, Missing};
use anyhow::{Result, bail, ensure};
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Command that installs all tools that are not Python packages.
pub const INSTALL: &str = "apt-get install gcc g++ libsundials-dev libsiconos-kernel-dev python3-venv";

const SUNDIALS: [&str; 6] = [
    "sundials_cvode",
    "sundials_arkode",
    "sundials_nvecserial",
    "sundials_sunmatrixdense",
    "sundials_sunlinsoldense",
    "sundials_sunnonlinsolfixedpoint",
];

/// The tools, or the reasons why they are missing.
pub struct Tools {
    /// Folder of the built programs and of their inputs.
    pub directory: PathBuf,
    equations: Result<PathBuf, String>,
    sundials: Result<PathBuf, String>,
    siconos: Result<PathBuf, String>,
    python: Result<PathBuf, String>,
}

impl Tools {
    /// Builds everything that can be built on this machine.
    pub fn new(progress: &impl Fn(&str)) -> Self {
        let directory = workspace().join("target").join("drivers");
        progress("our equations behind a C interface");
        let equations = told(equations());
        progress("SUNDIALS driver");
        let sundials = equations.clone().and_then(|library| told(sundials(&directory, &library)));
        progress("Siconos driver");
        let siconos = equations.clone().and_then(|library| told(siconos(&directory, &library)));
        progress("Python environment");
        let python = told(python::environment("peers", Missing::Make));
        Self { directory, equations, sundials, siconos, python }
    }

    /// The library of our equations.
    pub fn library_path(&self) -> String {
        self.equations.as_deref().map(|path| path.display().to_string()).unwrap_or_default()
    }

    /// Command that runs a program on the task, or the reason why the program is missing.
    pub fn command(&self, task: &Task, program: &Program, job: &Path) -> Result<Command, String> {
        match program.kind {
            Kind::Sundials | Kind::Siconos => {
                let driver = if program.kind == Kind::Siconos { &self.siconos } else { &self.sundials };
                let mut command = Command::new(driver.as_ref()?);
                command.arg(program.word).arg(&task.file).arg(task.span.to_string()).arg(task.points.to_string());
                command.args(program.ladder.iter().map(f64::to_string));
                Ok(command)
            }
            Kind::Python(script) => {
                let mut command = python::interpreter(self.python.as_ref()?);
                command.args(["-W", "ignore"]).arg(sources().join(script)).arg(job).arg(program.word);
                // One thread for each program, since CPU times are compared.
                command.env("NUMBA_CACHE_DIR", self.directory.join("numba")).env("OMP_NUM_THREADS", "1");
                // Where heyoka keeps what it has compiled.
                command.env("XDG_CACHE_HOME", self.directory.join("cache"));
                command.env("OPENBLAS_NUM_THREADS", "1");
                Ok(command)
            }
        }
    }
}

/// The folder of the other programs' sources.
fn sources() -> PathBuf {
    workspace().join("fmu-harness").join("peers")
}

/// The root cause of an error, in one line.
fn told<T>(result: Result<T>) -> Result<T, String> {
    result.map_err(|error| format!("{error:#}").lines().next().unwrap_or_default().to_owned())
}

/// Builds the library with the C interface to our equations.
fn equations() -> Result<PathBuf> {
    let mut command = cargo();
    command.args(["build", "--release", "--quiet", "--package", "slidercrank-equations"]);
    command.stdin(Stdio::null()).env_remove("CARGO_BUILD_TARGET").env_remove("CARGO_TARGET_DIR");
    ensure!(command.status()?.success(), "cargo could not build fmu-harness/peers");
    Ok(workspace().join("target/release").join(format!("{DLL_PREFIX}slidercrank_equations{DLL_SUFFIX}")))
}

/// Compiles the SUNDIALS driver.
fn sundials(directory: &Path, library: &Path) -> Result<PathBuf> {
    let program = directory.join("sundials");
    let mut command = Command::new("cc");
    command.args(["-O2", "-o"]).arg(&program).arg(sources().join("sundials.c"));
    link(&mut command, library);
    command.args(SUNDIALS.map(|name| format!("-l{name}")));
    compile(command, directory)?;
    Ok(program)
}

/// Compiles the Siconos driver.
fn siconos(directory: &Path, library: &Path) -> Result<PathBuf> {
    let program = directory.join("siconos");
    let mut command = Command::new("c++");
    command.args(["-O2", "-o"]).arg(&program).arg(sources().join("siconos.cpp"));
    command.args(["", "/kernel", "/numerics"].map(|part| format!("-I/usr/include/siconos{part}")));
    command.arg("-I/usr/include/suitesparse");
    link(&mut command, library);
    command.args(["-lsiconos_kernel", "-lsiconos_numerics"]);
    compile(command, directory)?;
    Ok(program)
}

/// Links with the library of our equations.
fn link(command: &mut Command, library: &Path) {
    let place = library.parent().unwrap_or(library).display();
    command.arg(format!("-L{place}")).arg("-lslidercrank_equations").arg(format!("-Wl,-rpath,{place}"));
}

fn compile(mut command: Command, directory: &Path) -> Result<()> {
    std::fs::create_dir_all(directory)?;
    let done = command.stdin(Stdio::null()).output();
    match done {
        Ok(output) if output.status.success() => Ok(()),
        _ => bail!("{INSTALL}"),
    }
}
