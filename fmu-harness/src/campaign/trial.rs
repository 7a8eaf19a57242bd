//! The test of one scene.
//!
//! For every legal scene: there is no panic; every output, output derivative and sensitivity is finite while steps
//! succeed, and outputs are finite after a step that failed, too; a state that is saved during the run continues to the
//! same bits; if the energy is audited and the method has a tolerance, the energy balance closes.

use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::model::signals::{CrankOutputs, Inputs, Outputs};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{Method, Scene};
use slidercrank::simulation::{Simulation, SimulationError, Snapshot, System};
use std::f64::consts::TAU;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The ending of a trial.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The scene ran to its end.
    Finished,
    /// It spent its maximum number of evaluations before the end.
    Spent,
    /// It ended early with this error, with `#` in place of numbers.
    Ended(String),
    /// It broke a rule of the test: which one, and when.
    Failed(String),
}

/// Limits of a trial, and the point at which its state is saved and restored.
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    /// Maximum number of evaluations of the equations of motion.
    pub evaluations: i32,
    /// Share of the communication points after which the state is saved.
    pub saved_at: f64,
}

/// Number of communication points at which a restored run is compared with the original run.
const COMPARED: usize = 4;
/// Number of communication points between two evaluations of sensitivities.
const SEEDED: usize = 8;
/// Largest tolerance for which the energy balance is checked.
const TIGHT: f64 = 1e-6;
/// Largest residual of the energy balance, as a share of the converted energy. Works and losses have no weight in the
/// error norm. This value was measured for a body of a milligram, whose velocities are accurate to 1e-5 m/s.
const BALANCE: f64 = 1e-3;
/// Largest residual with implicit steps, which do not resolve stiff transients and the energy lost in them.
const IMPLICIT_BALANCE: f64 = 0.1;

/// Inputs from this size on may make outputs overflow; the FMU does not return such outputs.
const ABSURD: f64 = 1e100;
const FAR_TOO_LARGE: &str = "a much too large input makes outputs overflow";
/// Outputs of a method without error control that has become unstable.
const BLOWN_UP: f64 = 1e15;
const FAR_TOO_LONG: &str = "a much too long fixed step makes outputs overflow";

/// The reason why a trial ended early.
enum Stop {
    Spent,
    Overflow(&'static str),
    Ended(SimulationError),
    Failed(String),
}

/// The cost of a trial.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Evaluations of the equations of motion.
    pub evaluations: i32,
    /// Crank turns in either direction.
    pub turns: f64,
}

/// Runs the scene of a file with its inputs.
pub fn trial(file: &SceneFile, terms: Terms) -> (Verdict, Cost) {
    let mut cost = Cost::default();
    let outcome = catch_unwind(AssertUnwindSafe(|| Trial::run(file, terms, &mut cost)));
    let verdict = match outcome {
        Ok(Ok(())) => Verdict::Finished,
        Ok(Err(Stop::Spent)) => Verdict::Spent,
        Ok(Err(Stop::Overflow(why))) => Verdict::Ended(why.into()),
        Ok(Err(Stop::Ended(error))) => Verdict::Ended(kind(&error)),
        Ok(Err(Stop::Failed(what))) => Verdict::Failed(what),
        Err(payload) => {
            let text = payload.downcast_ref::<String>().map(String::as_str);
            let text = text.or(payload.downcast_ref::<&str>().copied()).unwrap_or_default();
            Verdict::Failed(format!("panic: {text}"))
        }
    };
    (verdict, cost)
}

/// Message of an error with `#` in place of numbers, and without the time.
fn kind(error: &SimulationError) -> String {
    let text = match error {
        SimulationError::Integration { cause, .. } => cause.clone(),
        other => other.to_string(),
    };
    let in_number = |word: &str| word.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    text.split(' ').map(|word| if in_number(word) { "#" } else { word }).collect::<Vec<_>>().join(" ")
}

struct Trial<'a> {
    file: &'a SceneFile,
    simulation: Simulation,
    inputs: Inputs,
    outputs: Outputs,
    /// [J] Largest residual of the energy balance.
    residual: f64,
    /// [J] Converted energy.
    turned_over: f64,
}

/// A saved state, and the outputs at the communication points after it.
struct Saved {
    snapshot: Snapshot,
    point: usize,
    crank: CrankOutputs,
    after: Vec<String>,
}

impl<'a> Trial<'a> {
    fn run(file: &'a SceneFile, terms: Terms, cost: &mut Cost) -> Result<(), Stop> {
        let inputs = Inputs::at_start(file);
        let simulation = Simulation::start(&file.scene, inputs).map_err(Stop::Ended)?;
        let mut trial = Self { file, simulation, inputs, outputs: Outputs::default(), residual: 0.0, turned_over: 0.0 };
        trial.look(0)?;
        let points = trial.points();
        let save_at = (terms.saved_at * points as f64) as usize;
        let mut saved: Option<Saved> = None;
        for point in 1..=points {
            if point > save_at && saved.is_none() {
                let (snapshot, crank) = (trial.simulation.snapshot(), trial.outputs.crank);
                saved = Some(Saved { snapshot, point, crank, after: vec![] });
            }
            let stepped = trial.step(point, points);
            cost.evaluations = trial.outputs.solver.evaluations;
            cost.turns = (trial.outputs.crank.angle - file.scene.crank.angle_start).abs() / TAU;
            stepped?;
            if let Some(saved) = saved.as_mut().filter(|saved| saved.after.len() < COMPARED) {
                saved.after.push(format!("{:?}", trial.outputs));
                if saved.after.len() == COMPARED || point == points {
                    trial.again(saved, points)?;
                }
            }
            if trial.outputs.solver.evaluations > terms.evaluations {
                return Err(Stop::Spent);
            }
        }
        trial.balance()
    }

    /// Number of communication intervals.
    fn points(&self) -> usize {
        let run = &self.file.run;
        (run.stop(&self.file.scene) / run.step).round().max(1.0) as usize
    }

    /// [s] Time of a communication point.
    fn time(&self, point: usize, points: usize) -> f64 {
        self.file.run.stop(&self.file.scene) * (point as f64 / points as f64)
    }

    /// Advances to a communication point and checks the results, also after an error.
    fn step(&mut self, point: usize, points: usize) -> Result<(), Stop> {
        let time = self.time(point, points);
        let [inputs, rates] = Inputs::chords(&self.file.inputs, [self.simulation.time(), time], &self.outputs.crank);
        self.simulation.set_inputs(inputs, rates);
        self.inputs = inputs;
        let end = self.simulation.advance_to(time);
        match end {
            Ok(()) => self.look(point),
            Err(error) => {
                // After an error, outputs can still be read, and the state can be saved and restored.
                self.outputs = self.simulation.outputs();
                self.finite("output after an error", &self.outputs)?;
                let snapshot = self.simulation.snapshot();
                let again = Simulation::restore(&self.file.scene, &snapshot);
                let same = again.is_ok_and(|again| again.snapshot() == snapshot);
                let spent = error.to_string().contains("solver.max_evaluations");
                match same {
                    true if spent => Err(Stop::Spent),
                    true => Err(Stop::Ended(error)),
                    false => Err(self.failed("the state after an error cannot be restored".into())),
                }
            }
        }
    }

    fn look(&mut self, point: usize) -> Result<(), Stop> {
        self.outputs = self.simulation.outputs();
        self.finite("output", &self.outputs)?;
        let rates = self.simulation.output_rates();
        self.finite("derivative of output", &rates)?;
        if point.is_multiple_of(SEEDED) {
            for seed in [(1.0, 0.0), (0.0, 1.0)] {
                let (crank_torque, slider_load) = seed;
                let sensitivity = self.simulation.output_sensitivity(Inputs { crank_torque, slider_load });
                self.finite("sensitivity of output", &sensitivity)?;
            }
        }
        let energy = &self.outputs.energy;
        self.residual = self.residual.max(energy.residual.abs());
        let stored = energy.kinetic.abs() + energy.gravity.abs() + energy.elastic.abs() + energy.contact.abs();
        let moved = energy.torque_work.abs() + energy.load_work.abs() + energy.dissipated.abs();
        self.turned_over = self.turned_over.max(stored + moved);
        Ok(())
    }

    fn finite(&self, what: &str, outputs: &Outputs) -> Result<(), Stop> {
        let Some((name, value)) = reals(outputs).find(|(_, value)| !value.is_finite()) else {
            return Ok(());
        };
        let Inputs { crank_torque, slider_load } = self.inputs;
        let greatest = reals(&self.outputs).map(|(_, value)| value.abs()).fold(0.0, f64::max);
        if crank_torque.abs().max(slider_load.abs()) > ABSURD {
            Err(Stop::Overflow(FAR_TOO_LARGE))
        } else if self.file.scene.solver.method.has("fixed step") && greatest > BLOWN_UP {
            Err(Stop::Overflow(FAR_TOO_LONG))
        } else {
            Err(self.failed(format!("{what} {name} is {value}")))
        }
    }

    fn failed(&self, what: String) -> Stop {
        Stop::Failed(format!("{what}, at {:e} s", self.simulation.time()))
    }

    /// Checks that the saved state gives the same outputs again, bit for bit.
    fn again(&self, saved: &Saved, points: usize) -> Result<(), Stop> {
        let scene = &self.file.scene;
        let Ok(mut again) = Simulation::restore(scene, &saved.snapshot) else {
            return Err(self.failed("a saved state cannot be restored".into()));
        };
        let mut crank = saved.crank;
        for (i, wanted) in saved.after.iter().enumerate() {
            let time = self.time(saved.point + i, points);
            let [inputs, rates] = Inputs::chords(&self.file.inputs, [again.time(), time], &crank);
            again.set_inputs(inputs, rates);
            if let Err(error) = again.advance_to(time) {
                return Err(self.failed(format!("a restored run fails: {error}")));
            }
            let outputs = again.outputs();
            if format!("{outputs:?}") != *wanted {
                return Err(self.failed("a restored run differs from the original run".into()));
            }
            crank = outputs.crank;
        }
        Ok(())
    }

    /// Checks the energy balance of a run with an audit and a tolerance.
    fn balance(&self) -> Result<(), Stop> {
        let solver = &self.file.scene.solver;
        let implicit = matches!(solver.method, Method::Automatic | Method::Radau13 | Method::Rodas4);
        let share = if implicit { IMPLICIT_BALANCE } else { BALANCE };
        let weighted = !solver.method.has("fixed step") && solver.tolerance <= TIGHT;
        if !weighted || self.residual <= share * self.turned_over + noticeable(&self.file.scene) {
            return Ok(());
        }
        let (residual, turned_over) = (self.residual, self.turned_over);
        Err(self.failed(format!("the energy balance has a residual of {residual:e} J of {turned_over:e} J")))
    }
}

/// [J] Energy of a motion at the limit of what the error norm resolves at any tolerance. A smaller residual means
/// nothing.
fn noticeable(scene: &Scene) -> f64 {
    let Ok(system) = System::start(scene, Inputs::default()) else { return 0.0 };
    let positions = system.size().degrees_of_freedom;
    let [mut y, mut scales] = [(); 2].map(|()| vec![0.0; system.size().states]);
    system.write_start(&mut y);
    system.write_scales(&mut scales);
    y[positions..2 * positions].copy_from_slice(&scales[positions..2 * positions]);
    system.outputs(0.0, &y).energy.kinetic
}

/// All real outputs with their names.
fn reals(outputs: &Outputs) -> impl Iterator<Item = (&'static str, f64)> {
    VARIABLES.iter().filter_map(|variable| match variable.access {
        Access::RealOutput(get) => Some((variable.name, get(outputs))),
        _ => None,
    })
}
