//! Library + description + documents → a `.fmu` whose bytes depend on nothing else.

pub mod archive;
pub mod build;
pub mod elf;
mod licences;
mod version;

pub use version::Version;

use crate::scenes::Scenario;
use anyhow::{Context, Result};
use archive::Part;
use build::Libraries;
use slidercrank::fmi::v2::abi::dispatch_x86_64_v3;
use slidercrank::fmi::v2::description::documentation;
use slidercrank::model_description::raw::Experiment;
use slidercrank::model_description::rows::Declaration;
use slidercrank::model_description::{self, xml};
use slidercrank::scene::parameter::PARAMETERS;
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::slot;
use slidercrank::scene::write::write_table;
use std::env::consts::DLL_SUFFIX;
use std::fs;
use std::path::Path;

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

    /// Packages the library for FMI 2.0 with the scenario's values as start values.
    pub fn package(&self, scenario: &Scenario) -> Result<Package> {
        self.package_for(Version::Fmi2, scenario)
    }

    /// The same for a version of FMI.
    pub fn package_for(&self, version: Version, scenario: &Scenario) -> Result<Package> {
        let parts = self.parts(version, scenario)?;
        let glibc = parts.iter().find_map(|part| elf::glibc(&part.bytes));
        Ok(Package { bytes: archive::write(&parts)?, glibc })
    }

    /// Everything that goes into the archive, in its order.
    fn parts(&self, version: Version, scenario: &Scenario) -> Result<Vec<Part>> {
        let scene = &scenario.file.scene;
        let declaration = model_description::load().context("the declaration of the variables")?;
        let starts: Vec<f64> = PARAMETERS.iter().map(|parameter| parameter.value(scene)).collect();
        let with_scene = |library: &[u8]| -> Result<Vec<u8>> {
            let mut library = library.to_vec();
            slot::write(&mut library, scene)?;
            Ok(library)
        };
        let identifier = &declaration.model.identifier;
        let binaries = format!("binaries/{}/{identifier}", version.platform()?);
        let mut parts = vec![Part::new("modelDescription.xml", description(version, &declaration, scenario, &starts)?)];
        parts.extend(version.pictures(&declaration)?);
        parts.push(Part::new(format!("{binaries}{DLL_SUFFIX}"), with_scene(&self.library)?));
        if let Some(library) = &self.newer {
            let name = format!("{binaries}.{}{DLL_SUFFIX}", dispatch_x86_64_v3::LEVEL);
            parts.push(Part::new(name, with_scene(library)?));
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
fn description(version: Version, declaration: &Declaration, scenario: &Scenario, starts: &[f64]) -> Result<String> {
    let SceneFile { scene, run, .. } = &scenario.file;
    let (stop, step, tolerance) = (run.stop(scene), run.step, scene.solver.tolerance);
    let experiment = Experiment { start: 0.0, stop, tolerance, step };
    let guid = slot::guid(scene);
    let package = xml::Package { guid: &guid, starts, experiment, written: None };
    version.description(declaration, &package)
}

/// documentation/index.html.
fn page(scenario: &Scenario) -> Result<String> {
    let SceneFile { name, description, scene, .. } = &scenario.file;
    Ok(documentation(scene, &format!("{name}: {description}"))?)
}
