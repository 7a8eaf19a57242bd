//! The differences between packages of FMI 2.0 and FMI 3.0.

use super::archive::Part;
use super::platform::Platform;
use anyhow::Result;
use clap::ValueEnum;
use slidercrank::model_description::rows::Declaration;
use slidercrank::model_description::xml::{self, Package};
use slidercrank::model_description::{terminals, xml_v3};

/// Drawing of the mechanism, made from `model.svg` by the test `the_picture_is_the_drawing`.
const PICTURE: &[u8] = include_bytes!("../../assets/model.png");
const DRAWING: &[u8] = include_bytes!("../../assets/model.svg");

/// The version of FMI of a package.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Version {
    /// FMI 2.0.
    #[default]
    #[value(name = "2")]
    Fmi2,
    /// FMI 3.0.
    #[value(name = "3")]
    Fmi3,
    /// FMI 3.0 without the clocks of contacts, for hosts that have no event mode or cannot have clocks
    #[value(name = "3-without-clocks")]
    Fmi3WithoutClocks,
}

impl Version {
    /// Whether contacts have clocks.
    pub fn has_clocks(self) -> bool {
        self == Self::Fmi3
    }

    /// modelDescription.xml.
    pub fn description(self, declaration: &Declaration, package: &Package) -> Result<String> {
        Ok(match self {
            Self::Fmi2 => xml::write(declaration, package)?,
            Self::Fmi3 | Self::Fmi3WithoutClocks => xml_v3::write(declaration, package)?,
        })
    }

    /// The pictures, and in FMI 3.0 the terminals.
    pub fn pictures(self, declaration: &Declaration) -> Result<Vec<Part>> {
        Ok(match self {
            Self::Fmi2 => vec![Part::new("model.png", PICTURE)],
            Self::Fmi3 | Self::Fmi3WithoutClocks => vec![
                Part::new("terminalsAndIcons/terminalsAndIcons.xml", terminals::write(declaration)?),
                Part::new("terminalsAndIcons/icon.png", PICTURE),
                Part::new("terminalsAndIcons/icon.svg", DRAWING),
            ],
        })
    }

    /// The ending of the file name of a package for this platform, if the platform needs a file of its own; or empty.
    pub fn ending(self, platform: Platform) -> &'static str {
        if (self, platform) == (Self::Fmi2, Platform::LinuxAarch64) { "-linux-aarch64" } else { "" }
    }

    /// The folders of a platform's libraries: one for all its processors, or one for each.
    pub fn folders(self, platform: Platform) -> &'static [&'static str] {
        match (self, platform) {
            // FMI 2.0 has no name for Linux on ARM. Importers on such machines, among them FMPy, look in the folder for
            // x86-64.
            (Self::Fmi2, Platform::Linux64 | Platform::LinuxAarch64) => &["linux64"],
            (Self::Fmi2, Platform::Win64) => &["win64"],
            (Self::Fmi2, Platform::Darwin64) => &["darwin64"],
            (Self::Fmi3 | Self::Fmi3WithoutClocks, Platform::Linux64) => &["x86_64-linux"],
            (Self::Fmi3 | Self::Fmi3WithoutClocks, Platform::LinuxAarch64) => &["aarch64-linux"],
            (Self::Fmi3 | Self::Fmi3WithoutClocks, Platform::Win64) => &["x86_64-windows"],
            (Self::Fmi3 | Self::Fmi3WithoutClocks, Platform::Darwin64) => &["x86_64-darwin", "aarch64-darwin"],
        }
    }
}
