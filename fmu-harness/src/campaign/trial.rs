//! One scene put to the test: whatever it is, a run of it ends in order.
//!
//! What must hold of every legal scene: no panic; every output, output derivative and sensitivity is a number as long
//! as steps succeed, and outputs after a step that did not, too; a state saved on the way goes on to the bit; where the
//! energy is audited and the method keeps to a tolerance, its balance closes.

use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{Method, Scene};
use slidercrank::simulation::{Simulation, SimulationError, Snapshot, System};
use std::f64::consts::TAU;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// How a trial ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The scene ran to its end.
    Finished,
    /// All evaluations of the equations of motion were spent before.
    Spent,
    /// It ended before, by an error; numbers in it stand as `#`.
    Ended(String),
    /// Something that must hold does not: what, and when.
    Failed(String),
}

/// How much a trial may cost, and where on its way it is saved and restored.
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    /// Evaluations of the equations of motion in all.
    pub evaluations: i32,
    /// Share of the communication points after which the state is saved.
    pub saved_at: f64,
}

/// Communication points for which a restored run is compared with the one that never stopped.
const COMPARED: usize = 4;
/// Every so many communication points sensitivities are asked for.
const SEEDED: usize = 8;
/// Largest tolerance at which the balance of energy is held to anything.
const TIGHT: f64 = 1e-6;
/// Most share of the energy turned over that its balance may be off by. Works and losses are not weighted by the error
/// norm: of a scene with a body of a milligram, whose velocities are told to 1e-5 m/s, this much was measured.
const BALANCE: f64 = 1e-3;
/// The same for linearly implicit steps, which pass over a stiff transient without taking note of what it loses.
const IMPLICIT_BALANCE: f64 = 0.1;

/// An input from here on may make outputs overflow; the FMU's face refuses to hand them out.
const ABSURD: f64 = 1e100;
const FAR_TOO_LARGE: &str = "an input that is far too large makes outputs overflow";
/// Outputs of a method without error control that has left the motion.
const BLOWN_UP: f64 = 1e15;
const FAR_TOO_LONG: &str = "a fixed step that is far too long makes outputs overflow";

/// Why a trial is over before its end.
enum Stop {
    Spent,
    Overflow(&'static str),
    Ended(SimulationError),
    Failed(String),
}

/// What a trial took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Evaluations of the equations of motion.
    pub evaluations: i32,
    /// Turns of the crank, backwards or forwards.
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

/// The sentence of an error with `#` for its numbers and without its time.
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
    /// [J] Energy turned over.
    turned_over: f64,
}

/// A saved state and what the outputs were at the communication points after it.
struct Saved {
    snapshot: Snapshot,
    point: usize,
    angle: f64,
    after: Vec<String>,
}

impl<'a> Trial<'a> {
    fn run(file: &'a SceneFile, terms: Terms, cost: &mut Cost) -> Result<(), Stop> {
        let inputs = inputs(file, 0.0, file.scene.crank.angle_start);
        let simulation = Simulation::start(&file.scene, inputs).map_err(Stop::Ended)?;
        let mut trial = Self { file, simulation, inputs, outputs: Outputs::default(), residual: 0.0, turned_over: 0.0 };
        trial.look(0)?;
        let points = trial.points();
        let save_at = (terms.saved_at * points as f64) as usize;
        let mut saved: Option<Saved> = None;
        for point in 1..=points {
            if point > save_at && saved.is_none() {
                let (snapshot, angle) = (trial.simulation.snapshot(), trial.outputs.crank.angle);
                saved = Some(Saved { snapshot, point, angle, after: vec![] });
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

    /// [s] A communication point.
    fn time(&self, point: usize, points: usize) -> f64 {
        self.file.run.stop(&self.file.scene) * (point as f64 / points as f64)
    }

    /// Goes on to a communication point and looks at what came of it, even if that was an error.
    fn step(&mut self, point: usize, points: usize) -> Result<(), Stop> {
        self.inputs = inputs(self.file, self.simulation.time(), self.outputs.crank.angle);
        self.simulation.set_inputs(self.inputs, Inputs::default());
        let end = self.simulation.advance_to(self.time(point, points));
        match end {
            Ok(()) => self.look(point),
            Err(error) => {
                // What an error leaves behind can still be asked, saved and restored.
                self.outputs = self.simulation.outputs();
                self.finite("output after an error", &self.outputs)?;
                let snapshot = self.simulation.snapshot();
                let again = Simulation::restore(&self.file.scene, &snapshot);
                let same = again.is_ok_and(|again| again.snapshot() == snapshot);
                let spent = error.to_string().contains("solver.max_evaluations");
                match same {
                    true if spent => Err(Stop::Spent),
                    true => Err(Stop::Ended(error)),
                    false => Err(self.failed("the state after an error is not restored".into())),
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

    /// The saved state gives the same outputs again, to the bit.
    fn again(&self, saved: &Saved, points: usize) -> Result<(), Stop> {
        let scene = &self.file.scene;
        let Ok(mut again) = Simulation::restore(scene, &saved.snapshot) else {
            return Err(self.failed("a saved state is refused".into()));
        };
        let mut angle = saved.angle;
        for (i, wanted) in saved.after.iter().enumerate() {
            again.set_inputs(inputs(self.file, again.time(), angle), Inputs::default());
            if let Err(error) = again.advance_to(self.time(saved.point + i, points)) {
                return Err(self.failed(format!("a restored run ends: {error}")));
            }
            let outputs = again.outputs();
            if format!("{outputs:?}") != *wanted {
                return Err(self.failed("a restored run differs from the one that never stopped".into()));
            }
            angle = outputs.crank.angle;
        }
        Ok(())
    }

    /// The balance of energy, of a run that had an audit and a tolerance.
    fn balance(&self) -> Result<(), Stop> {
        let solver = &self.file.scene.solver;
        let implicit = matches!(solver.method, Method::Rodas4 | Method::Automatic);
        let share = if implicit { IMPLICIT_BALANCE } else { BALANCE };
        let weighted = !solver.method.has("fixed step") && solver.tolerance <= TIGHT;
        if !weighted || self.residual <= share * self.turned_over + noticeable(&self.file.scene) {
            return Ok(());
        }
        let (residual, turned_over) = (self.residual, self.turned_over);
        Err(self.failed(format!("the balance is off by {residual:e} J of {turned_over:e} J")))
    }
}

/// [J] Energy of a motion that the error norm just notices, whatever the tolerance: below it, a balance means nothing.
fn noticeable(scene: &Scene) -> f64 {
    let Ok(system) = System::start(scene, Inputs::default()) else { return 0.0 };
    let positions = system.size().degrees_of_freedom;
    let [mut y, mut scales] = [(); 2].map(|()| vec![0.0; system.size().states]);
    system.write_start(&mut y);
    system.write_scales(&mut scales);
    y[positions..2 * positions].copy_from_slice(&scales[positions..2 * positions]);
    system.outputs(0.0, &y).energy.kinetic
}

/// Every real output with its name.
fn reals(outputs: &Outputs) -> impl Iterator<Item = (&'static str, f64)> {
    VARIABLES.iter().filter_map(|variable| match variable.access {
        Access::RealOutput(get) => Some((variable.name, get(outputs))),
        _ => None,
    })
}

/// The inputs of a communication point, to be held until the next.
pub fn inputs(file: &SceneFile, time: f64, crank_angle: f64) -> Inputs {
    Inputs {
        crank_torque: file.inputs.crank_torque.value(time, crank_angle),
        slider_load: file.inputs.slider_load.value(time, crank_angle),
    }
}
