//! One scene through an FMU, communication point by communication point.

use crate::host::{Fmu, HostError, Kind, Log, LogLine, Selection, Setting, Slave, Stepping, Value, Variable};
use crate::inputs::Input;
use crate::trajectory::Trajectory;
use anyhow::{Context, Result, bail, ensure};
use cpu_time::ThreadTime;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The output that counts turns.
pub const ANGLE: &str = "crank.angle";
/// More communication points than this are taken for a mistake.
const MOST_POINTS: usize = 20_000_000;

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// [s]
    Time(f64),
    /// As soon as the crank has turned so often, in either direction; but no later than `latest` [s].
    Turns {
        /// How often.
        turns: f64,
        /// [s]
        latest: f64,
    },
}

/// What to do with an FMU.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Values to set before initialisation.
    pub settings: Vec<Setting>,
    /// Inputs while time runs.
    pub inputs: Vec<Input>,
    /// [s] First communication point.
    pub start: f64,
    /// When to end.
    pub until: Until,
    /// [s] Between communication points.
    pub step: f64,
    /// Handed to fmi2SetupExperiment.
    pub tolerance: Option<f64>,
}

/// What came of it.
pub struct Recording {
    /// All outputs at all communication points.
    pub trajectory: Trajectory,
    /// Names and values of the parameters as they were in the run.
    pub parameters: Vec<(String, f64)>,
    /// What it cost.
    pub cost: Cost,
}

impl Recording {
    /// The output of this name at all communication points.
    pub fn column(&self, name: &str) -> Result<&[f64]> {
        self.trajectory.column(name)
    }

    /// The parameter's value in the run.
    pub fn parameter(&self, name: &str) -> Option<f64> {
        self.parameters.iter().find(|(own, _)| own == name).map(|(_, value)| *value)
    }
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// [s] Time simulated.
    pub simulated: f64,
    /// In fmi2DoStep, by the clock on the wall.
    pub stepping: Duration,
    /// All communication points with inputs and outputs, by the clock on the wall.
    pub wall: Duration,
    /// The same, by this thread's use of the processor.
    pub cpu: Duration,
}

/// Runs the experiment and tells `progress` now and then which share of it is done.
pub fn run(
    fmu: &Fmu,
    experiment: &Experiment,
    log: impl Fn(&LogLine) + Send + Sync + 'static,
    progress: impl Fn(f64),
) -> Result<Recording> {
    ensure!(experiment.step > 0.0, "the communication step is {} s, wanted more than 0", experiment.step);
    let mut runner = Runner::start(fmu, experiment, Arc::new(Log::new(log)))?;
    let (wall, cpu) = (Instant::now(), ThreadTime::now());
    let mut stepping = Duration::ZERO;
    for point in 1..=MOST_POINTS {
        let Some((from, to)) = experiment.interval(point) else { break };
        runner.apply_inputs(from)?;
        let before = Instant::now();
        runner.slave.do_step(from, to - from)?;
        stepping += before.elapsed();
        runner.record(to)?;
        let share = runner.share_done(to)?;
        if point % 256 == 0 {
            progress(share);
        }
        if share >= 1.0 {
            break;
        }
        ensure!(point < MOST_POINTS, "{MOST_POINTS} communication points were not enough");
    }
    let (wall, cpu) = (wall.elapsed(), cpu.elapsed());
    progress(1.0);
    let simulated = runner.trajectory.times().last().unwrap_or(&experiment.start) - experiment.start;
    let parameters = runner.parameters(fmu)?;
    let trajectory = runner.finish()?;
    Ok(Recording { trajectory, parameters, cost: Cost { simulated, stepping, wall, cpu } })
}

/// Runs the experiment, whose inputs must not change, without a look on the way: the processor's time in fmi2DoStep
/// alone, and the outputs at start and end.
pub fn march(fmu: &Fmu, experiment: &Experiment) -> Result<(Duration, Trajectory)> {
    ensure!(experiment.inputs.iter().all(Input::is_constant), "the inputs change while time runs");
    let mut runner = Runner::start(fmu, experiment, Arc::new(Log::new(|_| {})))?;
    let mut reached = experiment.start;
    let start = ThreadTime::now();
    for (from, to) in (1..=MOST_POINTS).map_while(|point| experiment.interval(point)) {
        runner.slave.do_step(from, to - from)?;
        reached = to;
    }
    let spent = start.elapsed();
    runner.record(reached)?;
    Ok((spent, runner.finish()?))
}

impl Experiment {
    /// The interval that ends at communication point number `point`, or `None` past the end. Points lie at whole
    /// multiples of the step, so that no error adds up; the last interval is shortened to end in time.
    fn interval(&self, point: usize) -> Option<(f64, f64)> {
        let (Until::Time(end) | Until::Turns { latest: end, .. }) = self.until;
        let at = |point: usize| self.start + point as f64 * self.step;
        let (from, to) = (at(point - 1), at(point));
        // A millionth of a step is what remains of a quotient that was meant to be whole.
        let sliver = 1e-6 * self.step;
        (from < end - sliver).then_some((from, if to > end - sliver { end } else { to }))
    }
}

/// A slave with what is asked of it at every communication point.
struct Runner<'a> {
    experiment: &'a Experiment,
    slave: Slave<'a, Stepping>,
    /// References of the inputs, in the order of the experiment's.
    inputs: Vec<u32>,
    values: Vec<f64>,
    outputs: Selection,
    trajectory: Trajectory,
    /// Column of the crank's angle, and the angle at the start.
    angle: Option<(usize, f64)>,
}

impl<'a> Runner<'a> {
    /// Instantiates, sets, initialises, and records the first row.
    fn start(fmu: &'a Fmu, experiment: &'a Experiment, log: Arc<Log>) -> Result<Self> {
        let description = fmu.description();
        let reference = |input: &Input| input_reference(description.variable(&input.name)?);
        let inputs = experiment.inputs.iter().map(reference).collect::<Result<Vec<u32>>>()?;
        let outputs: Vec<&Variable> =
            description.variables.iter().filter(|variable| variable.causality() == "output").collect();
        let angle = outputs.iter().position(|variable| variable.name == ANGLE);
        let wants_angle = experiment.inputs.iter().any(Input::wants_angle);
        ensure!(angle.is_some() || !wants_angle, "an input depends on `{ANGLE}`, which this FMU does not give");

        let mut slave = fmu.instantiate(description.name(), log, false)?;
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
        let mut runner = Self { experiment, slave, inputs, values, outputs, trajectory, angle: None };
        runner.record(experiment.start)?;
        runner.angle = angle.map(|column| (column, runner.outputs.values()[column]));
        Ok(runner)
    }

    fn record(&mut self, time: f64) -> Result<(), HostError> {
        self.slave.read(&mut self.outputs)?;
        self.trajectory.push(time, self.outputs.values());
        Ok(())
    }

    /// Sets the inputs of the interval that begins at `time`.
    fn apply_inputs(&mut self, time: f64) -> Result<(), HostError> {
        if self.inputs.is_empty() {
            return Ok(());
        }
        let angle = self.angle.map_or(0.0, |(column, _)| self.outputs.values()[column]);
        let inputs = &self.experiment.inputs;
        self.values.iter_mut().zip(inputs).for_each(|(value, input)| *value = input.profile.value(time, angle));
        self.slave.set_reals(&self.inputs, &self.values)
    }

    /// 1 at the end of the experiment.
    fn share_done(&self, time: f64) -> Result<f64> {
        match self.experiment.until {
            Until::Time(end) => Ok((time - self.experiment.start) / (end - self.experiment.start)),
            Until::Turns { turns, latest } => {
                let (column, first) = self.angle.with_context(|| format!("this FMU gives no `{ANGLE}` to count"))?;
                let turned = (self.outputs.values()[column] - first).abs() / std::f64::consts::TAU;
                if time >= latest && turned < turns {
                    bail!("the crank has made {turned:.3} of {turns} turns by t = {time} s; give a stop time instead");
                }
                // A billionth of a turn is what rounding leaves of a whole number of them.
                Ok(turned / (turns - 1e-9))
            }
        }
    }

    fn parameters(&mut self, fmu: &Fmu) -> Result<Vec<(String, f64)>, HostError> {
        let numeric = |variable: &&Variable| variable.causality() == "parameter" && variable.kind != Kind::String;
        let variables: Vec<&Variable> = fmu.description().variables.iter().filter(numeric).collect();
        let mut selection = Selection::new(variables.iter().copied());
        self.slave.read(&mut selection)?;
        let names = variables.iter().map(|variable| variable.name.clone());
        Ok(names.zip(selection.values().iter().copied()).collect())
    }

    fn finish(self) -> Result<Trajectory> {
        self.slave.terminate()?;
        Ok(self.trajectory)
    }
}

/// The reference of a real input.
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
