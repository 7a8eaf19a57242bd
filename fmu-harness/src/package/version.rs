//! What differs between packages of FMI 2.0 and 3.0.

use super::archive::Part;
use anyhow::{Result, bail};
use clap::ValueEnum;
use slidercrank::model_description::rows::Declaration;
use slidercrank::model_description::xml::{self, Package};
use slidercrank::model_description::{terminals, xml_v3};
use std::env::consts::{ARCH, OS};

/// Drawing of the mechanism, made from `model.svg` by the test `the_picture_is_the_drawing`.
const PICTURE: &[u8] = include_bytes!("../../assets/model.png");
const DRAWING: &[u8] = include_bytes!("../../assets/model.svg");

/// A version of FMI that packages are made for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Version {
    /// FMI 2.0.
    #[default]
    #[value(name = "2")]
    Fmi2,
    /// FMI 3.0.
    #[value(name = "3")]
    Fmi3,
}

impl Version {
    /// modelDescription.xml.
    pub fn description(self, declaration: &Declaration, package: &Package) -> Result<String> {
        Ok(match self {
            Self::Fmi2 => xml::write(declaration, package)?,
            Self::Fmi3 => xml_v3::write(declaration, package)?,
        })
    }

    /// The picture, and the terminals where the version has them.
    pub fn pictures(self, declaration: &Declaration) -> Result<Vec<Part>> {
        Ok(match self {
            Self::Fmi2 => vec![Part::new("model.png", PICTURE)],
            Self::Fmi3 => vec![
                Part::new("terminalsAndIcons/terminalsAndIcons.xml", terminals::write(declaration)?),
                Part::new("terminalsAndIcons/icon.png", PICTURE),
                Part::new("terminalsAndIcons/icon.svg", DRAWING),
            ],
        })
    }

    /// Name of this machine's platform.
    pub fn platform(self) -> Result<&'static str> {
        Ok(match (self, OS, ARCH) {
            (Self::Fmi2, "linux", "x86_64") => "linux64",
            (Self::Fmi2, "windows", "x86_64") => "win64",
            (Self::Fmi2, "macos", _) => "darwin64",
            (Self::Fmi3, "linux", "x86_64") => "x86_64-linux",
            (Self::Fmi3, "linux", "aarch64") => "aarch64-linux",
            (Self::Fmi3, "windows", "x86_64") => "x86_64-windows",
            (Self::Fmi3, "macos", "x86_64") => "x86_64-darwin",
            (Self::Fmi3, "macos", "aarch64") => "aarch64-darwin",
            (Self::Fmi2, os, arch) => bail!("FMI 2.0 has no name for the platform {arch} {os}"),
            (Self::Fmi3, os, arch) => bail!("FMI 3.0 has no name for the platform {arch} {os}"),
        })
    }
}
