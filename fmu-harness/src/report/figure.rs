//! Figures of a run of the slider-crank and of the same run with ideal joints, one function for each figure.

use super::plot::{Curve, Mark, Panel, Role, Sheet, square_panel};
use super::units::Shown;
use crate::run::{ANGLE, JOINTS, Recording};
use anyhow::Result;
use std::f64::consts::TAU;

/// Number of turns shown: the last ones, after the transient.
const TURNS_SHOWN: f64 = 2.0;
/// Abscissa of curves over time.
pub const TURNS: &str = "crank turns";
/// Number of turns of the journal paths.
const PATH_TURNS: f64 = 3.0;

/// Value of `joint.J.model` of a joint with clearance.
const CLEARANCE: f64 = 2.0;

/// Value of `joint.J.lubrication` of a joint with an oil film.
const SHORT_BEARING: f64 = 2.0;

/// A run and its ideal counterpart.
pub struct Pair<'a> {
    /// Name of the scene.
    pub title: &'a str,
    /// The mechanism with its own joints.
    pub actual: &'a Recording,
    /// The same FMU with ideal joints.
    pub ideal: &'a Recording,
}

/// Position, velocity and acceleration of the slider.
pub fn slider_motion(pair: &Pair) -> Result<Sheet> {
    let panels = [("slider.x", "m", "position"), ("slider.v", "m/s", "velocity"), ("slider.a", "m/s2", "acceleration")]
        .map(|(variable, unit, name)| {
            pair.panel(variable, unit, name, |recording| Ok(recording.column(variable)?.into()))
        });
    pair.sheet("slider motion", panels.into_iter().collect::<Result<_>>()?, 1, (960, 240))
}

/// Error of the slider's position against the ideal rigid mechanism at the same crank motion.
pub fn slider_error(pair: &Pair) -> Result<Sheet> {
    let error = "accuracy.position";
    let panel = pair.panel(error, "m", "position error", |recording| Ok(recording.column(error)?.into()))?;
    pair.sheet("slider's position error", vec![panel], 1, (960, 240))
}

/// Magnitude of the force in every joint.
pub fn joint_forces(pair: &Pair) -> Result<Sheet> {
    let panels = JOINTS.map(|joint| {
        let name = format!("force in {joint}");
        pair.panel(&name, "N", &name, |recording| force(recording, joint))
    });
    pair.sheet("joint forces", panels.into_iter().collect::<Result<_>>()?, 2, (600, 270))
}

/// Path of every journal with clearance, inside its clearance circle; `None` if no pin has clearance.
pub fn journal_paths(pair: &Pair) -> Result<Option<Sheet>> {
    let joints = ["A", "B", "C"];
    let has_clearance = |joint: &&str| pair.actual.parameter(&format!("joint.{joint}.model")) == Some(CLEARANCE);
    let panels: Vec<Panel> =
        joints.into_iter().filter(has_clearance).map(|joint| path(pair, joint)).collect::<Result<_>>()?;
    if panels.is_empty() {
        return Ok(None);
    }
    let title = format!("{}: journal centre in its bearing, last {PATH_TURNS} turns", pair.title);
    let legend = vec![(Role::Limit, "clearance circle".into()), (Role::Actual, "journal".into())];
    let columns = panels.len();
    Ok(Some(Sheet { title, legend, columns, panels, panel_size: square_panel(540) }))
}

/// Height and tilt of the slider in a guide with clearance; `None` if the guide is ideal.
pub fn guide_play(pair: &Pair) -> Result<Option<Sheet>> {
    if pair.actual.parameter("joint.T.model") != Some(CLEARANCE) {
        return Ok(None);
    }
    let panels =
        [("slider.y", "m", "pin across the guide"), ("slider.angle", "rad", "tilt")].map(|(variable, unit, name)| {
            pair.panel(variable, unit, name, |recording| Ok(recording.column(variable)?.into()))
        });
    Ok(Some(pair.sheet("slider in its guide", panels.into_iter().collect::<Result<_>>()?, 1, (960, 240))?))
}

/// Deflection and stretch of a flexible rod; `None` if the rod is rigid.
pub fn rod_shape(pair: &Pair) -> Result<Option<Sheet>> {
    let modes = ["bending_modes", "axial_modes"].map(|kind| pair.actual.parameter(&format!("rod.flexible.{kind}")));
    if modes.into_iter().flatten().sum::<f64>() == 0.0 {
        return Ok(None);
    }
    let panels = [("rod.deflection", "m", "deflection at mid-span"), ("rod.stretch", "m", "stretch from end to end")]
        .map(|(variable, unit, name)| {
            pair.panel(variable, unit, name, |recording| Ok(recording.column(variable)?.into()))
        });
    Ok(Some(pair.sheet("flexible rod", panels.into_iter().collect::<Result<_>>()?, 1, (960, 240))?))
}

/// Thickness and force of the oil films; `None` if all joints are dry.
pub fn oil_films(pair: &Pair) -> Result<Option<Sheet>> {
    let mut panels = vec![];
    for joint in lubricated(pair.actual) {
        let thinnest = |recording: &Recording| thickness(recording, joint);
        panels.push(pair.panel(&format!("film {joint}"), "m", &format!("film in {joint}, thinnest"), thinnest)?);
        let variable = format!("joint.{joint}.film.force");
        let force = |recording: &Recording| Ok(recording.column(&variable)?.into());
        panels.push(pair.panel(&variable, "N", &format!("force of the film in {joint}"), force)?);
    }
    if panels.is_empty() { Ok(None) } else { Ok(Some(pair.sheet("oil films", panels, 1, (960, 200))?)) }
}

/// The joints with clearance that hold oil.
pub fn lubricated(recording: &Recording) -> impl Iterator<Item = &'static str> {
    let is = move |name: String, wanted: f64| recording.parameter(&name) == Some(wanted);
    ["A", "B", "C"].into_iter().filter(move |joint| {
        is(format!("joint.{joint}.model"), CLEARANCE) && is(format!("joint.{joint}.lubrication"), SHORT_BEARING)
    })
}

/// [m] Clearance less eccentricity of a joint at every communication point; 0 for an ideal joint.
pub fn thickness(recording: &Recording, joint: &str) -> Result<Vec<f64>> {
    if recording.parameter(&format!("joint.{joint}.model")) != Some(CLEARANCE) {
        return Ok(vec![0.0; recording.trajectory.len()]);
    }
    let clearance = recording.parameter(&format!("joint.{joint}.clearance")).unwrap_or_default();
    let [x, y] = ["x", "y"].map(|axis| recording.column(&format!("joint.{joint}.eccentricity.{axis}")));
    Ok(x?.iter().zip(y?).map(|(x, y)| clearance - x.hypot(*y)).collect())
}

fn path(pair: &Pair, joint: &str) -> Result<Panel> {
    let clearance = pair.actual.parameter(&format!("joint.{joint}.clearance")).unwrap_or_default();
    let shown = Shown::of("m", clearance);
    let circle = (0..=360).map(|degree| f64::from(degree).to_radians());
    let circle = circle.map(|angle| (clearance * angle.cos() * shown.factor, clearance * angle.sin() * shown.factor));
    let [x, y] = ["x", "y"].map(|axis| pair.actual.column(&format!("joint.{joint}.eccentricity.{axis}")));
    let points = x?.iter().zip(y?).map(|(x, y)| (x * shown.factor, y * shown.factor));
    let first = first_of_last(pair.actual, PATH_TURNS)?;
    Ok(Panel {
        x_label: shown.axis(&format!("eccentricity of {joint} along the guide")),
        y_label: shown.axis("across"),
        curves: vec![
            Curve { role: Role::Limit, points: circle.collect(), mark: Mark::Path },
            Curve { role: Role::Actual, points: points.skip(first).collect(), mark: Mark::Path },
        ],
        square: true,
    })
}

impl Pair<'_> {
    /// Curves of both runs over crank turns. `what` is the name of the quantity in errors.
    fn panel(
        &self,
        what: &str,
        unit: &str,
        name: &str,
        quantity: impl Fn(&Recording) -> Result<Vec<f64>>,
    ) -> Result<Panel> {
        let context = |error: anyhow::Error| error.context(format!("no figure of {what}"));
        let (ideal, actual) = (quantity(self.ideal).map_err(context)?, quantity(self.actual).map_err(context)?);
        let peak = ideal.iter().chain(&actual).fold(0.0, |peak: f64, value| peak.max(value.abs()));
        let shown = Shown::of(unit, peak);
        let curve = |role: Role, recording: &Recording, values: Vec<f64>| -> Result<Curve> {
            let first = first_shown(recording)?;
            let points = turns(recording)?.into_iter().zip(values.iter().map(|value| value * shown.factor));
            Ok(Curve { role, points: points.skip(first).collect(), mark: Mark::Line })
        };
        let curves = vec![curve(Role::Ideal, self.ideal, ideal)?, curve(Role::Actual, self.actual, actual)?];
        Ok(Panel { x_label: TURNS.into(), y_label: shown.axis(name), curves, square: false })
    }

    /// Panels above one another share the abscissa of the lowest panel.
    fn sheet(&self, what: &str, mut panels: Vec<Panel>, columns: usize, panel_size: (u32, u32)) -> Result<Sheet> {
        let upper = panels.len().saturating_sub(columns);
        panels[..upper].iter_mut().for_each(|panel| panel.x_label.clear());
        let legend = vec![(Role::Ideal, "ideal joints".into()), (Role::Actual, "this mechanism".into())];
        Ok(Sheet { title: format!("{}: {what}", self.title), legend, panels, columns, panel_size })
    }
}

/// [N] |F| of a joint at every communication point.
pub fn force(recording: &Recording, joint: &str) -> Result<Vec<f64>> {
    let [x, y] = ["x", "y"].map(|axis| recording.column(&format!("joint.{joint}.force.{axis}")));
    Ok(x?.iter().zip(y?).map(|(x, y)| x.hypot(*y)).collect())
}

/// Crank turns since the start, positive in the direction of rotation.
pub(super) fn turns(recording: &Recording) -> Result<Vec<f64>> {
    let angle = recording.column(ANGLE)?;
    let first = angle.first().copied().unwrap_or_default();
    Ok(angle.iter().map(|angle| (angle - first).abs() / TAU).collect())
}

/// Number of the first row of curves over time.
pub(super) fn first_shown(recording: &Recording) -> Result<usize> {
    first_of_last(recording, TURNS_SHOWN)
}

/// Number of the first row of the last `shown` turns.
fn first_of_last(recording: &Recording, shown: f64) -> Result<usize> {
    let turns = turns(recording)?;
    let last = turns.last().copied().unwrap_or_default();
    // A thousandth of a turn more, so that rounding errors do not remove the first row.
    Ok(turns.partition_point(|turn| *turn < last - shown - 1e-3))
}
