//! The press with a servo drive and the sheet that it cuts, as an SSP 1.0 package. The same inputs give the same bytes.

mod companions;
mod structure;
pub mod study;

use crate::host::Description;
use crate::package::Stock;
use crate::package::archive::{self, Part};
use crate::scenes::Scenario;
use anyhow::{Context, Result, bail, ensure};
use companions::companions;
use slidercrank::scene::profile::{Profile, ProfileArgument};
use std::io::Write;
use std::path::Path;
use structure::{Component, Structure, Value};

/// Name of the scene, of the package and of its first component.
pub const PRESS: &str = "press";
/// Name of the set of parameter values, which some masters need.
pub const VALUES: &str = "servo";
const CONTROLLER: &str = "controller";
const SHEET: &str = "sheet";
/// [kg·m²] Inertia of crankshaft and motor about their axis. A servo press has no flywheel.
const INERTIA: f64 = 3.0;
/// [s] Time of three strokes.
const STOP: f64 = 0.8;

/// A connection from an output to an input, each with its component.
type Wire = [(&'static str, &'static str); 2];

const WIRES: [Wire; 6] = [
    [(PRESS, "crank.angle"), (CONTROLLER, "angle")],
    [(PRESS, "crank.speed"), (CONTROLLER, "speed")],
    [(PRESS, "crank.angle"), (SHEET, "angle")],
    [(PRESS, "slider.v"), (SHEET, "velocity")],
    [(CONTROLLER, "torque"), (PRESS, "crank.torque")],
    [(SHEET, "force"), (PRESS, "slider.load")],
];

/// Outputs that masters record in addition to connected outputs.
const WATCHED: [(&str, &str); 12] = [
    (PRESS, "slider.x"),
    (PRESS, "accuracy.position"),
    (PRESS, "joint.A.force.x"),
    (PRESS, "joint.A.force.y"),
    (PRESS, "joint.B.force.x"),
    (PRESS, "joint.B.force.y"),
    (PRESS, "joint.C.force.x"),
    (PRESS, "joint.C.force.y"),
    (PRESS, "joint.T.force.x"),
    (PRESS, "joint.T.force.y"),
    (CONTROLLER, "set_speed"),
    (SHEET, "work"),
];

/// A component's FMU, its description, and the parameter values in the package.
struct Unit {
    name: &'static str,
    file: String,
    bytes: Vec<u8>,
    description: Description,
    values: Vec<(String, f64)>,
}

/// The package's bytes. `python` is the interpreter of the environment `hosts`, which has PythonFMU.
pub fn package(stock: &Stock, python: &Path) -> Result<Vec<u8>> {
    let scenario = Scenario::find(PRESS)?;
    let press = stock.package(&scenario)?.bytes;
    let fast = scenario.file.scene.crank.speed_start;
    let mut units = vec![unit(PRESS, format!("{PRESS}.fmu"), press, vec![("crank.inertia".into(), INERTIA)])?];
    for companion in companions(python)? {
        let (name, values) = match companion.file.as_str() {
            "ServoController.fmu" => (CONTROLLER, vec![("fast_speed".into(), fast), ("inertia".into(), INERTIA)]),
            "Sheet.fmu" => (SHEET, profile(&scenario.file.inputs.slider_load)?),
            other => bail!("unexpected FMU {other}"),
        };
        units.push(unit(name, companion.file, companion.bytes, values)?);
    }
    let components = units.iter().map(component).collect::<Result<_>>()?;
    let structure = Structure {
        name: PRESS,
        description: "A blanking press with a servo drive: speed profile over the stroke, PI control, torque limit",
        values: VALUES,
        components,
        wires: &WIRES,
        stop: STOP,
    };
    let mut parts = vec![Part::new("SystemStructure.ssd", structure.xml()?)];
    parts.extend(units.into_iter().map(|unit| Part::new(format!("resources/{}", unit.file), unit.bytes)));
    archive::write(&parts)
}

fn unit(name: &'static str, file: String, bytes: Vec<u8>, values: Vec<(String, f64)>) -> Result<Unit> {
    let mut copy = tempfile::NamedTempFile::new()?;
    copy.write_all(&bytes)?;
    let text = crate::host::Archive::open(copy.path())?.description()?;
    Ok(Unit { name, file, bytes, description: Description::parse(&text)?, values })
}

/// The scene's load as the sheet's parameters.
fn profile(load: &Profile) -> Result<Vec<(String, f64)>> {
    let Profile::Points { against: ProfileArgument::CrankAngle, points } = load else {
        bail!("the scene `{PRESS}` has no load as a function of the crank's angle");
    };
    let rows = points.iter().zip(1..);
    Ok(rows.flat_map(|(point, row)| [(format!("at[{row}]"), point[0]), (format!("load[{row}]"), point[1])]).collect())
}

/// Connectors and parameter values of a unit, with the units of measurement that it declares.
fn component(unit: &Unit) -> Result<Component> {
    let ends = WIRES.iter().flatten().chain(&WATCHED);
    let mut names: Vec<&str> = ends.filter(|(owner, _)| *owner == unit.name).map(|(_, name)| *name).collect();
    names.sort_unstable();
    names.dedup();
    let declared = |name: &str, wanted: &[&str]| -> Result<(String, Option<String>)> {
        let variable = unit.description.variable(name).with_context(|| unit.file.clone())?;
        let causality = variable.causality();
        ensure!(
            wanted.contains(&causality),
            "{}: `{name}` is not an {}, but has the causality {causality}",
            unit.file,
            wanted.join(" or ")
        );
        Ok((causality.into(), unit.description.unit(variable).map(str::to_owned)))
    };
    let connectors = names.into_iter().map(|name| {
        let (kind, unit) = declared(name, &["input", "output"])?;
        Ok(structure::Connector { name: name.into(), kind, unit })
    });
    let values = unit.values.iter().map(|(name, value)| {
        let (_, unit) = declared(name, &["parameter"])?;
        Ok(Value { name: name.clone(), value: *value, unit })
    });
    Ok(Component {
        name: unit.name,
        source: format!("resources/{}", unit.file),
        connectors: connectors.collect::<Result<_>>()?,
        values: values.collect::<Result<_>>()?,
        bases: unit.description.bases.clone(),
    })
}
