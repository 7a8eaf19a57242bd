//! Data of the animation: parameters and outputs by the names of the FMU's variables.

use crate::report::figure::{first_shown, turns};
use crate::run::Recording;
use anyhow::Result;
use serde::Serialize;
use std::collections::BTreeMap;

/// Maximum number of frames.
const MOST_FRAMES: usize = 6000;
/// Variables of the animation that do not belong to one joint.
const PARAMETERS: [&str; 10] = [
    "crank.length",
    "rod.length",
    "slider.length",
    "slider.height",
    "slider.centre.x",
    "slider.centre.y",
    "guide.offset",
    "joint.T.model",
    "joint.T.clearance",
    "crank.speed_start",
];
const OUTPUTS: [&str; 9] = [
    "crank.angle",
    "rod.angle",
    "rod.deflection",
    "rod.stretch",
    "slider.x",
    "slider.y",
    "slider.angle",
    "joint.T.force.x",
    "joint.T.force.y",
];

/// The last turns of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Film {
    /// Parameters [SI].
    pub parameters: BTreeMap<String, f64>,
    /// [s] Time of every frame.
    pub time: Vec<f64>,
    /// Crank turns since the start at every frame.
    pub turns: Vec<f64>,
    /// Outputs [SI] at every frame, with nine digits, enough for a zoomed drawing.
    pub outputs: BTreeMap<String, Vec<f64>>,
}

impl Film {
    /// The turns of the figures, with evenly omitted points if there are too many.
    ///
    /// # Errors
    /// If the recording is not that of a slider-crank.
    pub fn of(recording: &Recording) -> Result<Self> {
        let names = |what: &str, parts: &[&str]| -> Vec<String> {
            ["A", "B", "C"]
                .iter()
                .flat_map(|joint| parts.iter().map(move |part| format!("{what}.{joint}.{part}")))
                .collect()
        };
        let own = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let parameters = [own(&PARAMETERS), names("joint", &["model", "radius", "clearance"])].concat();
        let outputs =
            [own(&OUTPUTS), names("joint", &["eccentricity.x", "eccentricity.y", "force.x", "force.y"])].concat();
        let turns = turns(recording)?;
        let first = first_shown(recording)?;
        let every = (turns.len() - first).div_ceil(MOST_FRAMES).max(1);
        let frames = |column: &[f64]| column.iter().skip(first).step_by(every).copied().collect::<Vec<f64>>();
        let value = |name: String| Some((name.clone(), recording.parameter(&name)?));
        let column = |name: String| {
            let numbers = frames(recording.column(&name)?).into_iter().map(nine_digits).collect();
            Ok((name, numbers))
        };
        Ok(Self {
            parameters: parameters.into_iter().filter_map(value).collect(),
            time: frames(recording.trajectory.times()),
            turns: frames(&turns),
            outputs: outputs.into_iter().map(column).collect::<Result<_>>()?,
        })
    }
}

fn nine_digits(number: f64) -> f64 {
    format!("{number:.8e}").parse().unwrap_or(number)
}
