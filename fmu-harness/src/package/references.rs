//! Stimuli and reference results inside the package, by the layered standard fmi-ls-ref: a host can run them to see whether
//! it runs the FMU as it should.
//!
//! The reference is what the packaged library computes in co-simulation, on any machine if the host asks for
//! `solver.portable`. It is short, so that hosts of model exchange, whose methods are others, still find the same motion.
//! Inputs are constant but for one jump, at a communication point: so it does not matter how a host interpolates.
//!
//! Texts: <https://github.com/modelica/fmi-ls-ref> (1.0.0-alpha.1) and, for the experiment,
//! <https://github.com/modelica/ma-hs-experiments>.

use super::archive::Part;
use anyhow::{Context, Result};
use slidercrank::fmi::slave::access::{Permission, ValueType};
use slidercrank::fmi::slave::variables::VARIABLES;
use slidercrank::fmi::slave::{Error, Slave};
use slidercrank::scene::Scene;
use slidercrank::scene::read::SceneFile;
use std::fmt::Write;

/// The layered standard's folder.
pub const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";
/// The stimuli.
pub const STIMULI: &str = "stimuli.csv";
/// The reference results.
pub const RESULTS: &str = "reference.csv";

/// Inputs, each with its value before and after the jump. [N.m], [N]
const INPUTS: [(&str, f64, f64); 2] = [("crank.torque", 0.25, -0.25), ("slider.load", -5.0, 10.0)];
/// Outputs that the results tell: what is smooth across an impact, or nearly so.
const OUTPUTS: [&str; 6] = ["slider.x", "slider.v", "slider.y", "crank.angle", "crank.speed", "rod.angle"];
/// Communication steps, of the length of the scene's run.
const STEPS: u32 = 100;
/// The step after which the inputs jump.
const JUMP: u32 = 50;

/// Everything is allowed: the slave is used in the right order here.
const ALL: Permission = Permission { inputs: true, outputs: true, parameters: true, state: "reference" };

/// The folder's files, and the text that says what they are. A scene whose mechanism cannot make so many steps has none.
///
/// # Errors
/// If the results cannot be put into words.
pub fn parts(file: &SceneFile) -> Result<Vec<Part>> {
    let SceneFile { scene, run, .. } = file;
    let Ok(results) = results(scene, run.step) else { return Ok(vec![]) };
    let end = f64::from(STEPS) * run.step;
    let file = |name: &str, text: String| Part::new(format!("{FOLDER}/{name}"), text);
    Ok(vec![
        file("fmi-ls-manifest.xml", MANIFEST.to_owned()),
        file("smoke-test.exp", experiment(end, run.step, scene.solver.tolerance)),
        file(STIMULI, stimuli(run.step)?),
        file(RESULTS, results),
        Part::new("documentation/fmi-ls-ref.txt", DOCUMENTATION),
    ])
}

const MANIFEST: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiReferences xmlns:fmi-ls="http://fmi-standard.org/fmi-ls-manifest" fmi-ls:fmi-ls-name="org.fmi-standard.fmi-ls-ref" fmi-ls:fmi-ls-version="1.0.0-alpha.1" fmi-ls:fmi-ls-description="Layered Standard providing information on related files included in an FMU.">
  <Related type="application/x-ma-hs-experiments" source="smoke-test.exp" role="experiment/smoke-test" description="A short run with a jump of the inputs"/>
  <Related type="text/csv" source="stimuli.csv" role="testcase" description="Inputs of the short run"/>
  <Related type="text/csv" source="reference.csv" role="result" description="Results of the short run in co-simulation"/>
  <Related type="application/toml" source="../../documentation/scene.toml" role="configuration" description="Mechanism and solver that the FMU was packaged with"/>
</fmiReferences>
"#;

const DOCUMENTATION: &str = "extra/org.fmi-standard.fmi-ls-ref holds a short run that shows whether a host runs this FMU as it should.

stimuli.csv    Inputs over time in SI units. They are constant but for one jump: two rows of one time, the values before
               and after it.
reference.csv  Results over time in SI units, from co-simulation with communication steps of the same length and with the
               start values and the tolerance of modelDescription.xml.
smoke-test.exp The experiment that uses both.

With solver.portable = true co-simulation gives these numbers to the bit, without it to rounding errors that contacts
amplify: some 1e-12 of the largest value in a column. Model exchange agrees to what the host's tolerance allows.
";

/// The experiment in the format that the layered standard refers to.
fn experiment(end: f64, step: f64, tolerance: f64) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<Experiments name="Smoke test" description="Shows whether a host runs the FMU as it should">
  <Experiment name="Short run" description="Constant inputs with one jump, from the packaged start values" tolerance="{tolerance:?}">
    <TransientSimulation startTime="0.0" stopTime="{end:?}" stepSize="{step:?}"/>
    <Stimuli type="text/csv" source="{STIMULI}"/>
    <References type="text/csv" source="{RESULTS}"/>
  </Experiment>
</Experiments>
"#
    )
}

/// [s] A communication point.
fn point(step: u32, size: f64) -> f64 {
    f64::from(step) * size
}

fn stimuli(size: f64) -> Result<String> {
    let mut csv = header(INPUTS.map(|(name, ..)| name));
    for (step, jumped) in [(0, false), (JUMP, false), (JUMP, true), (STEPS, true)] {
        let values = INPUTS.map(|(_, before, after)| if jumped { after } else { before });
        row(&mut csv, point(step, size), &values).context("cannot write the stimuli")?;
    }
    Ok(csv)
}

/// What the library computes under the stimuli.
fn results(scene: &Scene, size: f64) -> Result<String, Error> {
    let reference =
        |name: &str| VARIABLES.iter().position(|variable| variable.name == name).unwrap_or(usize::MAX) as u32;
    let (inputs, outputs) = (INPUTS.map(|(name, ..)| reference(name)), OUTPUTS.map(reference));
    let mut slave = Slave::new(scene.clone(), None);
    slave.set_up(None, 0.0, None)?;
    slave.set(ValueType::Real, ALL, &inputs, &INPUTS.map(|(_, before, _)| before), |value| value)?;
    slave.initialize()?;
    let mut csv = header(OUTPUTS);
    for step in 0..=STEPS {
        let time = point(step, size);
        if step > 0 {
            let end = slave.step_end(point(step - 1, size), time - point(step - 1, size))?;
            slave.advance_to(end)?;
        }
        if step == JUMP {
            slave.set(ValueType::Real, ALL, &inputs, &INPUTS.map(|(.., after)| after), |value| value)?;
        }
        let mut values = [0.0; OUTPUTS.len()];
        slave.get(ValueType::Real, ALL, &outputs, &mut values, |value| value)?;
        // Writing to a text cannot fail.
        let _ = row(&mut csv, time, &values);
    }
    Ok(csv)
}

fn header<const COUNT: usize>(names: [&str; COUNT]) -> String {
    let quoted = names.map(|name| format!("\"{name}\""));
    format!("\"time\",{}\n", quoted.join(","))
}

fn row(csv: &mut String, time: f64, values: &[f64]) -> std::fmt::Result {
    write!(csv, "{time:?}")?;
    values.iter().try_for_each(|value| write!(csv, ",{value:?}"))?;
    writeln!(csv)
}
