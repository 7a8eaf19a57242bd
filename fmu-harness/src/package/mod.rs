//! Library + description + documents → a `.fmu` whose bytes depend on nothing else.

pub mod archive;
pub mod build;
pub mod elf;
mod licences;

use crate::scenes::Scenario;
use anyhow::{Context, Result, bail};
use archive::Part;
use build::Libraries;
use slidercrank::fmi::slave::states::exchange;
use slidercrank::fmi::v2::abi::dispatch_x86_64_v3;
use slidercrank::fmi::v2::description::documentation;
use slidercrank::model_description::raw::Experiment;
use slidercrank::model_description::rows::Declaration;
use slidercrank::model_description::{self, xml};
use slidercrank::scene::parameter::PARAMETERS;
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::slot;
use slidercrank::scene::write::write_table;
use std::env;
use std::env::consts::DLL_SUFFIX;
use std::fs;
use std::path::Path;

/// Drawing of the mechanism, made from `model.svg` by the test `the_picture_is_the_drawing`.
const PICTURE: &[u8] = include_bytes!("../../assets/model.png");

/// Name of the rod's modes in a package's documentation, if its scene has such.
pub const MODES: &str = "modes.toml";

/// A packaged FMU.
pub struct Package {
    /// The `.fmu` file.
    pub bytes: Vec<u8>,
    /// Newest glibc that the Linux binary asks for.
    pub glibc: Option<String>,
}

/// What packages of all scenes have in common.
#[derive(Clone)]
pub struct Stock {
    library: Vec<u8>,
    newer: Option<Vec<u8>>,
    third_party: String,
}

impl Stock {
    /// Builds the library, and that for newer processors.
    pub fn build() -> Result<Self> {
        let Libraries { every, newer } = build::libraries()?;
        let read = |path: &Path| fs::read(path).with_context(|| format!("cannot read {}", path.display()));
        let newer = newer.as_deref().map(read).transpose()?;
        Ok(Self { library: read(&every)?, newer, third_party: licences::third_party()? })
    }

    /// The same for packages that compute the same bits on every processor.
    #[must_use]
    pub fn portable(self) -> Self {
        Self { newer: None, ..self }
    }

    /// Packages the library with the scenario's values as start values.
    pub fn package(&self, scenario: &Scenario) -> Result<Package> {
        let parts = self.parts(scenario)?;
        let glibc = parts.iter().find_map(|part| elf::glibc(&part.bytes));
        Ok(Package { bytes: archive::write(&parts)?, glibc })
    }

    /// Everything that goes into the archive, in its order.
    fn parts(&self, scenario: &Scenario) -> Result<Vec<Part>> {
        let scene = &scenario.file.scene;
        let declaration = model_description::load().context("the declaration of the variables")?;
        let starts: Vec<f64> = PARAMETERS.iter().map(|parameter| parameter.value(scene)).collect();
        let with_scene = |library: &[u8]| -> Result<Vec<u8>> {
            let mut library = library.to_vec();
            slot::write(&mut library, scene)?;
            Ok(library)
        };
        let identifier = &declaration.model.identifier;
        let mut parts = vec![
            Part::new("modelDescription.xml", description(&declaration, scenario, &starts)?),
            Part::new("model.png", PICTURE),
            Part::new(format!("binaries/{}/{identifier}{DLL_SUFFIX}", platform()?), with_scene(&self.library)?),
            Part::new("documentation/index.html", page(scenario)?),
            Part::new("documentation/scene.toml", scenario.text.as_str()),
            Part::new("documentation/licenses/license.txt", licences::own()),
            Part::new("documentation/licenses/third-party.txt", self.third_party.as_str()),
        ];
        if let Some(library) = &self.newer {
            // It computes scenes that the other library hands it, so it needs none of its own.
            let name = format!("binaries/{}/{identifier}.{}{DLL_SUFFIX}", platform()?, dispatch_x86_64_v3::LEVEL);
            parts.insert(3, Part::new(name, library.as_slice()));
        }
        if let Some(table) = &scene.rod.flexible.table {
            parts.push(Part::new(format!("documentation/{MODES}"), write_table(table)));
        }
        Ok(parts)
    }
}

impl Package {
    /// Builds the library and packages it with the scenario's values as start values.
    pub fn make(scenario: &Scenario) -> Result<Self> {
        Stock::build()?.package(scenario)
    }

    /// Writes the file, making its directory if need be.
    pub fn save(&self, file: &Path) -> Result<()> {
        let context = || format!("cannot write {}", file.display());
        fs::create_dir_all(file.parent().unwrap_or(Path::new("."))).with_context(context)?;
        fs::write(file, &self.bytes).with_context(context)
    }
}

/// modelDescription.xml: the scene's values are the start values, its run the default experiment.
fn description(declaration: &Declaration, scenario: &Scenario, starts: &[f64]) -> Result<String> {
    let SceneFile { scene, run, .. } = &scenario.file;
    let (stop, step, tolerance) = (run.stop(scene), run.step, scene.solver.tolerance);
    let experiment = Experiment { start: 0.0, stop, tolerance, step };
    let guid = slot::guid(scene);
    let exchange = exchange(scene);
    let made = xml::made(declaration, epoch()?);
    let package = xml::Package { guid: &guid, starts, exchange: exchange.as_ref(), experiment, made: Some(&made) };
    Ok(xml::write(declaration, &package)?)
}

/// The variable by which builds that can be repeated are told when they are made, in seconds since 1970.
const EPOCH: &str = "SOURCE_DATE_EPOCH";
/// [s] The last second of the year 9999.
const LAST: u64 = 253_402_300_799;

/// [s] What that variable says, if it is set.
fn epoch() -> Result<Option<u64>> {
    let Some(text) = env::var_os(EPOCH) else { return Ok(None) };
    let seconds = text.to_str().and_then(|text| text.parse().ok()).filter(|seconds| *seconds <= LAST);
    let context = || format!("{EPOCH} = {} is no number of seconds since 1970", text.display());
    seconds.map(Some).with_context(context)
}

/// documentation/index.html.
fn page(scenario: &Scenario) -> Result<String> {
    let SceneFile { name, description, scene, .. } = &scenario.file;
    Ok(documentation(scene, &format!("{name}: {description}"))?)
}

/// FMI 2.0 names three platforms that there are machines of.
fn platform() -> Result<&'static str> {
    match (env::consts::OS, env::consts::ARCH) {
        ("linux", "x86_64") => Ok("linux64"),
        ("windows", "x86_64") => Ok("win64"),
        ("macos", _) => Ok("darwin64"),
        (os, arch) => bail!("FMI 2.0 has no name for the platform {arch} {os}"),
    }
}
