//! The description in a package: `modelDescription.xml` and the documentation page.

use crate::fmi::slave::states::exchange;
use crate::model_description::rows::{Experiment, RowError};
use crate::model_description::{self, page, xml};
use crate::scene::check::LEAST_RESTITUTION;
use crate::scene::modal::ModalTable;
use crate::scene::{PARAMETERS, Scene, slot};
use std::{fmt, io};

/// A description cannot be written.
#[derive(Debug)]
pub enum DescriptionError {
    /// The declaration is wrong; build.rs would have reported it.
    Declaration(RowError),
    /// The text cannot be written.
    Writing(io::Error),
}

impl fmt::Display for DescriptionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Declaration(error) => error.fmt(f),
            Self::Writing(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for DescriptionError {}

impl From<RowError> for DescriptionError {
    fn from(error: RowError) -> Self {
        Self::Declaration(error)
    }
}

impl From<io::Error> for DescriptionError {
    fn from(error: io::Error) -> Self {
        Self::Writing(error)
    }
}

/// `modelDescription.xml` of a package with the scene's start values. The default experiment is the declared one unless
/// it is given. `made` is the date in seconds since 1970, if it is not that of the version.
pub fn model_description(
    scene: &Scene,
    experiment: Option<Experiment>,
    made: Option<u64>,
) -> Result<String, DescriptionError> {
    let declaration = model_description::load()?;
    let starts: Vec<f64> = PARAMETERS.iter().map(|parameter| parameter.value(scene)).collect();
    let exchange = exchange(scene);
    let package = xml::Package {
        guid: &slot::guid(scene),
        exchange: exchange.as_ref(),
        clocks: &[],
        starts: &starts,
        experiment: experiment.unwrap_or(declaration.experiment),
        made: Some(&xml::made(&declaration, made)),
    };
    Ok(xml::write(&declaration, &package)?)
}

/// `documentation/index.html` of a package with the scene's start values. `title` is the title of the scene.
pub fn documentation(scene: &Scene, title: &str) -> Result<String, DescriptionError> {
    let starts: Vec<f64> = PARAMETERS.iter().map(|parameter| parameter.value(scene)).collect();
    let modes = scene.rod.flexible.table.as_ref().map(ModalTable::modes);
    let subject = page::Subject { scene: title, starts: &starts, modes, least_restitution: LEAST_RESTITUTION };
    Ok(page::write(&model_description::load()?, &subject))
}

/// The declared experiment.
pub fn declared_experiment() -> Result<Experiment, DescriptionError> {
    Ok(model_description::load()?.experiment)
}
