//! Packages libraries, model description and documents as a `.fmu` file. Its bytes depend on nothing else.

pub mod archive;
pub mod build;
pub mod elf;
mod licences;
pub mod mach_o;
pub mod platform;
pub mod references;
pub mod tools;
mod version;

pub use version::Version;

use crate::frame::builder;
use crate::python::Missing;
use crate::scenes::Scenario;
use anyhow::{Context, Result};
use archive::Part;
use build::{Levels, Library};
use elf::Glibc;
use platform::Platform;
use slidercrank::fmi::slave::states::{clocks, exchange};
use slidercrank::fmi::v2::description::documentation;
use slidercrank::model_description::raw::Experiment;
use slidercrank::model_description::rows::Declaration;
use slidercrank::model_description::{self, xml};
use slidercrank::scene::Scene;
use slidercrank::scene::parameter::PARAMETERS;
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::slot;
use slidercrank::scene::write::write_table;
use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::io::Write;
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// File name of the rod's table of modes in a package's documentation.
pub const MODES: &str = "modes.toml";

/// A packaged FMU.
pub struct Package {
    /// The `.fmu` file.
    pub bytes: Vec<u8>,
    /// The oldest glibc that all its Linux libraries can run with.
    pub glibc: Option<Glibc>,
    /// The platforms that it has a library for.
    pub platforms: Vec<Platform>,
}

/// The parts that packages of all scenes have in common.
#[derive(Clone)]
pub struct Stock {
    binaries: Vec<Binary>,
    third_party: String,
}

/// A library of the package, for all processors of a platform.
#[derive(Clone)]
struct Binary {
    platform: Platform,
    /// The level of processors that it needs, if it needs one.
    level: Option<&'static str>,
    /// The library of each processor of the platform.
    libraries: Vec<Vec<u8>>,
}

impl Stock {
    /// Builds the libraries for this machine. On Linux zig links them for an old glibc if zig is already installed.
    pub fn build() -> Result<Self> {
        Self::of(build::for_this_machine(Levels::All, Missing::Refuse)?)
    }

    /// Builds the libraries for this machine. On Linux zig links them for an old glibc if zig can be installed.
    pub fn build_for_old_linux(levels: Levels) -> Result<Self> {
        Self::of(build::for_this_machine(levels, Missing::Make)?)
    }

    /// Builds the libraries of these platforms. Returns one stock for each file of this version of FMI, with the ending of the
    /// file's name.
    pub fn build_for(version: Version, platforms: &[Platform], levels: Levels) -> Result<Vec<(&'static str, Self)>> {
        let mut stocks: Vec<(&'static str, Vec<Library>)> = Vec::new();
        for library in build::for_platforms(platforms, levels)? {
            let ending = version.ending(library.platform);
            match stocks.iter_mut().find(|(known, _)| *known == ending) {
                Some((_, libraries)) => libraries.push(library),
                None => stocks.push((ending, vec![library])),
            }
        }
        stocks.into_iter().map(|(ending, libraries)| Ok((ending, Self::of(libraries)?))).collect()
    }

    /// Takes these libraries, which are sorted by platform, into packages.
    pub fn of(libraries: Vec<Library>) -> Result<Self> {
        let triples: BTreeSet<&str> = libraries.iter().map(|library| library.triple).collect();
        let third_party = licences::third_party(&triples)?;
        let mut binaries: Vec<Binary> = Vec::new();
        for Library { platform, level, file, .. } in libraries {
            let bytes = fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
            match binaries.last_mut() {
                Some(last) if (last.platform, last.level) == (platform, level) => last.libraries.push(bytes),
                _ => binaries.push(Binary { platform, level, libraries: vec![bytes] }),
            }
        }
        Ok(Self { binaries, third_party })
    }

    /// Leaves out libraries for newer processors, so that packages compute the same bits on every processor.
    #[must_use]
    pub fn portable(mut self) -> Self {
        self.binaries.retain(|binary| binary.level.is_none());
        self
    }

    /// Packages the library for FMI 2.0 with the scenario's values as start values.
    pub fn package(&self, scenario: &Scenario) -> Result<Package> {
        self.package_for(Version::Fmi2, scenario)
    }

    /// Packages the library for a version of FMI with the scenario's values as start values.
    pub fn package_for(&self, version: Version, scenario: &Scenario) -> Result<Package> {
        let parts = self.parts(version, scenario)?;
        let glibc = parts.iter().filter_map(|part| elf::glibc(&part.bytes)).max();
        let mut platforms: Vec<Platform> = self.binaries.iter().map(|binary| binary.platform).collect();
        platforms.dedup();
        Ok(Package { bytes: archive::write(&parts)?, glibc, platforms })
    }

    /// All files of the archive, in their order.
    fn parts(&self, version: Version, scenario: &Scenario) -> Result<Vec<Part>> {
        let scene = &scenario.file.scene;
        let declaration = model_description::load().context("the declaration of the variables")?;
        let starts: Vec<f64> = PARAMETERS.iter().map(|parameter| parameter.value(scene)).collect();
        let mut parts = vec![Part::new("modelDescription.xml", description(version, &declaration, scenario, &starts)?)];
        parts.extend(version.pictures(&declaration)?);
        for binary in &self.binaries {
            parts.extend(binary.parts(version, &declaration.model.identifier, scene)?);
        }
        parts.extend([
            Part::new("documentation/index.html", page(scenario)?),
            Part::new("documentation/scene.toml", scenario.text.as_str()),
            Part::new("documentation/licenses/license.txt", licences::own()),
            Part::new("documentation/licenses/third-party.txt", self.third_party.as_str()),
        ]);
        if let Some(table) = &scene.rod.flexible.table {
            parts.push(Part::new(format!("documentation/{MODES}"), write_table(table)));
        }
        parts.extend(references::parts(&scenario.file)?);
        Ok(parts)
    }
}

impl Binary {
    /// The archive's files for this library, with the scene written into them.
    fn parts(&self, version: Version, identifier: &str, scene: &Scene) -> Result<Vec<Part>> {
        let mut libraries = self.libraries.clone();
        for library in &mut libraries {
            // A library for newer processors gets its scene from the library for every processor.
            if self.level.is_none() {
                slot::write(library, scene)?;
            }
            if self.platform == Platform::Darwin64 {
                mach_o::sign(library)?;
            }
        }
        let level = self.level.map(|level| format!(".{level}")).unwrap_or_default();
        let file = format!("{identifier}{level}{}", self.platform.affixes().1);
        let folders = version.folders(self.platform);
        let libraries = if folders.len() == 1 { vec![mach_o::universal(libraries)?] } else { libraries };
        let part = |(folder, library)| Part::new(format!("binaries/{folder}/{file}"), library);
        Ok(folders.iter().zip(libraries).map(part).collect())
    }
}

impl Package {
    /// Builds the library and packages it with the scenario's values as start values.
    pub fn make(scenario: &Scenario) -> Result<Self> {
        Stock::build()?.package(scenario)
    }

    /// Writes the file, making its directory if need be. Who reads the file meanwhile finds the whole of an older one.
    pub fn save(&self, file: &Path) -> Result<()> {
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let write = || {
            fs::create_dir_all(folder)?;
            let mut beside = builder().tempfile_in(folder)?;
            beside.write_all(&self.bytes)?;
            beside.persist(file).map_err(|error| error.error)
        };
        write().map(drop).with_context(|| format!("cannot write {}", file.display()))
    }

    /// The package in a file of its own, which no other command replaces while a study opens it again and again.
    pub fn copy(&self) -> Result<NamedTempFile> {
        let mut copy = Builder::new().suffix(".fmu").tempfile()?;
        copy.write_all(&self.bytes)?;
        Ok(copy)
    }
}

/// modelDescription.xml: the scene's values are the start values, its run the default experiment.
fn description(version: Version, declaration: &Declaration, scenario: &Scenario, starts: &[f64]) -> Result<String> {
    let SceneFile { scene, run, .. } = &scenario.file;
    let (stop, step, tolerance) = (run.stop(scene), run.step, scene.solver.tolerance);
    let experiment = Experiment { start: 0.0, stop, tolerance, step };
    let guid = slot::guid(scene);
    let exchange = exchange(scene);
    let made = xml::made(declaration, epoch()?);
    let clocks = if version.has_clocks() { clocks(scene) } else { vec![] };
    let package = xml::Package {
        guid: &guid,
        starts,
        exchange: exchange.as_ref(),
        clocks: &clocks,
        experiment,
        made: Some(&made),
    };
    version.description(declaration, &package)
}

/// Environment variable that gives reproducible builds their date, in seconds since 1970.
const EPOCH: &str = "SOURCE_DATE_EPOCH";
/// [s] The last second of the year 9999.
const LAST: u64 = 253_402_300_799;

/// [s] The date that the variable gives, if it is set.
fn epoch() -> Result<Option<u64>> {
    let Some(text) = env::var_os(EPOCH) else { return Ok(None) };
    let seconds = text.to_str().and_then(|text| text.parse().ok()).filter(|seconds| *seconds <= LAST);
    let context = || format!("{EPOCH} = {} is not a number of seconds between 1970 and the year 9999", text.display());
    seconds.map(Some).with_context(context)
}

/// documentation/index.html.
fn page(scenario: &Scenario) -> Result<String> {
    let SceneFile { name, description, scene, .. } = &scenario.file;
    Ok(documentation(scene, &format!("{name}: {description}"))?)
}
