//! One instance, with the variables to set and read at every communication point.

use super::{ANGLE, Experiment, SPEED, Until};
use crate::host::{Fmu, HostError, Kind, Log, Selection, Setting, Slave, Stepping, Value, Variable};
use crate::inputs::Input;
use crate::trajectory::Trajectory;
use anyhow::{Context, Result, bail, ensure};
use slidercrank::scene::profile::Chord;
use std::sync::Arc;

/// A slave, with the variables to set and read at every communication point.
pub struct Runner<'a> {
    experiment: &'a Experiment,
    slave: Slave<'a, Stepping>,
    /// Value references of the inputs, in the order of the experiment's inputs.
    inputs: Vec<u32>,
    /// The lines of the inputs as they were set last.
    values: Vec<f64>,
    slopes: Vec<f64>,
    /// Whether inputs follow straight lines over a step; otherwise they are held.
    interpolates: bool,
    outputs: Selection,
    trajectory: Trajectory,
    /// Column of the crank's angle, and its value at the start.
    angle: Option<(usize, f64)>,
    /// Selection of the crank's angle, if an input depends on it, and of its speed, if inputs follow lines.
    crank: Option<Selection>,
}

impl<'a> Runner<'a> {
    /// Instantiates, sets, initializes and records the first row. With `logging` the FMU logs why it refuses a call.
    pub fn start(fmu: &'a Fmu, experiment: &'a Experiment, log: Arc<Log>, logging: bool) -> Result<Self> {
        let description = fmu.description();
        let reference = |input: &Input| input_reference(description.variable(&input.name)?);
        let inputs = experiment.inputs.iter().map(reference).collect::<Result<Vec<u32>>>()?;
        let outputs: Vec<&Variable> = description.variables.iter().filter(is_recorded).collect();
        let angle = outputs.iter().position(|variable| variable.name == ANGLE);
        let wants_angle = experiment.inputs.iter().any(Input::wants_angle);
        ensure!(angle.is_some() || !wants_angle, "an input depends on `{ANGLE}`, which is not an output of this FMU");

        let mut slave = fmu.instantiate(description.name(), log, logging)?;
        for Setting { name, value } in &experiment.settings {
            let variable = description.variable(name)?;
            slave.set(variable, &Value::parse(description, variable, value)?)?;
        }
        let mut slave = slave.enter_initialization(experiment.tolerance, experiment.start, None)?;
        let first_angle = if wants_angle { slave.read_one(ANGLE)? } else { 0.0 };
        let value = |input: &Input| input.profile.value(experiment.start, first_angle);
        let values: Vec<f64> = experiment.inputs.iter().map(value).collect();
        if !values.is_empty() {
            slave.set_reals(&inputs, &values)?;
        }
        let slave = slave.exit_initialization()?;
        let trajectory = Trajectory::new(outputs.iter().map(|variable| variable.name.clone()));
        let outputs = Selection::new(outputs);
        let speed = description.variables.iter().filter(is_recorded).find(|variable| variable.name == SPEED);
        let interpolates = fmu.interpolates_inputs() && (speed.is_some() || !wants_angle);
        let crank = match wants_angle {
            true => Some(Selection::new([description.variable(ANGLE)?].into_iter().chain(speed))),
            false => None,
        };
        let slopes = vec![0.0; values.len()];
        let mut runner =
            Self { experiment, slave, inputs, values, slopes, interpolates, outputs, trajectory, angle: None, crank };
        runner.record(experiment.start)?;
        runner.angle = angle.map(|column| (column, runner.outputs.values()[column]));
        Ok(runner)
    }

    /// Records the communication point at `time`.
    pub fn record(&mut self, time: f64) -> Result<(), HostError> {
        self.slave.read(&mut self.outputs)?;
        self.trajectory.push(time, self.outputs.values());
        Ok(())
    }

    /// Reads the variables of a selection.
    pub fn ask(&mut self, selection: &mut Selection) -> Result<(), HostError> {
        self.slave.read(selection)
    }

    /// fmi2DoStep from one communication point to another.
    pub fn step(&mut self, from: f64, to: f64) -> Result<(), HostError> {
        self.slave.do_step(from, to - from)
    }

    /// Sets the inputs of the interval between two times [s]: straight lines, where the FMU takes them, and otherwise their
    /// values at its start. Inputs that have not changed are not set again.
    pub fn apply_inputs(&mut self, from: f64, to: f64) -> Result<(), HostError> {
        if self.inputs.is_empty() {
            return Ok(());
        }
        let (mut angle, mut speed) = (0.0, 0.0);
        if let Some(selection) = &mut self.crank {
            self.slave.read(selection)?;
            angle = selection.values()[0];
            speed = selection.values().get(1).copied().unwrap_or_default();
        }
        let mut changed = false;
        for ((value, slope), input) in self.values.iter_mut().zip(&mut self.slopes).zip(&self.experiment.inputs) {
            let before = Chord { value: *value, slope: *slope };
            let line = input.profile.chord([from, to], angle, speed);
            (*value, *slope) = (line.value, if self.interpolates { line.slope } else { 0.0 });
            // On a slope the value has moved on.
            changed |= before.slope != 0.0 || before.value.to_bits() != value.to_bits() || *slope != 0.0;
        }
        match changed {
            true if self.interpolates => self.slave.set_lines(&self.inputs, &self.values, &self.slopes),
            true => self.slave.set_reals(&self.inputs, &self.values),
            false => Ok(()),
        }
    }

    /// Finished share of the experiment: 1 at its end.
    pub fn share_done(&self, time: f64) -> Result<f64> {
        match self.experiment.until {
            Until::Time(end) => Ok((time - self.experiment.start) / (end - self.experiment.start)),
            Until::Turns { turns, latest } => {
                let (column, first) = self
                    .angle
                    .with_context(|| format!("turns cannot be counted: `{ANGLE}` is not an output of this FMU"))?;
                let turned = (self.outputs.values()[column] - first).abs() / std::f64::consts::TAU;
                if time >= latest && turned < turns {
                    bail!("the crank has made {turned:.3} of {turns} turns by t = {time} s; give a stop time instead");
                }
                // A remainder of a billionth of a turn is a rounding error.
                Ok(turned / (turns - 1e-9))
            }
        }
    }

    /// Names and values of the parameters.
    pub fn parameters(&mut self, fmu: &Fmu) -> Result<Vec<(String, f64)>, HostError> {
        let numeric = |variable: &&Variable| variable.causality() == "parameter" && variable.kind != Kind::String;
        let variables: Vec<&Variable> = fmu.description().variables.iter().filter(numeric).collect();
        let mut selection = Selection::new(variables.iter().copied());
        self.slave.read(&mut selection)?;
        let names = variables.iter().map(|variable| variable.name.clone());
        Ok(names.zip(selection.values().iter().copied()).collect())
    }

    /// The recorded outputs.
    pub fn into_trajectory(self) -> Trajectory {
        self.trajectory
    }

    /// Terminates and frees the instance.
    pub fn finish(self) -> Result<Trajectory> {
        self.slave.terminate()?;
        Ok(self.trajectory)
    }
}

/// Value reference of a real input.
fn input_reference(variable: &Variable) -> Result<u32> {
    let legal = variable.causality() == "input" && variable.kind == Kind::Real;
    ensure!(
        legal,
        "`{}` is not a real input: causality {}, type {:?}",
        variable.name,
        variable.causality(),
        variable.kind
    );
    Ok(variable.reference)
}

/// Outputs whose values this program reads: clocks and arrays are left out.
fn is_recorded(variable: &&Variable) -> bool {
    variable.causality() == "output" && variable.kind != Kind::Other
}
