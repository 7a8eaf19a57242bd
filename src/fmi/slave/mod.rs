//! A slave, for every version of FMI.
//!
//! A [`Slave`] has the settings of an importer and the simulation that follows from them. It has neither life-cycle
//! states nor C types: a version of FMI passes with each call the variables that the call may use ([`Permission`]),
//! turns an [`Error`] into one of its statuses, and stores the state of its life cycle. Saved states, their bytes and
//! the log are the same for every version.
//!
//! All settings are in the scene. Until the end of initialization, setting a start value edits the scene and drops the
//! simulation, which is made anew when an output is read; so outputs follow start values in initialization mode. After
//! that only inputs change.
//!
//! A refused call changes nothing: values that are set together are all applied, or none of them.

pub mod access;
pub mod course;
pub mod difference;
mod directional;
pub mod engine;
pub mod error;
pub mod estimation;
mod exchange;
pub mod experiment;
pub mod inputs;
pub mod log;
pub mod saved_states;
pub mod sealed;
pub mod settings;
pub mod severity;
pub mod start_sensitivity;
pub mod states;
pub mod steps;
pub mod variables;

pub use access::{Permission, ValueType};
pub use course::Interface;
pub use error::Error;
pub use settings::Settings;
pub use severity::Severity;

use crate::integrator::MAX_STATES;
use crate::model::signals::Outputs;
use crate::scene::Scene;
use crate::simulation::Snapshot;
use access::{RealInput, check_first_order, finite, finite_output, real_input, real_output, typed, variable};
use course::{Course, StateValues};
use engine::{Engine, Own};
use error::VariableError;
use experiment::{Experiment, LeftAside, Limit};
use inputs::are_finite;
use variables::{Access, VARIABLES, Variable};

/// Name of the parameter that takes precedence over the experiment's tolerance if an importer has set it.
const TOLERANCE: &str = "solver.tolerance";

/// One slave.
pub struct Slave {
    /// The packaged scene.
    packaged: Scene,
    /// The engine for newer processors, if there is one. It computes scenes without `solver.portable`.
    newer: Option<&'static dyn Engine>,
    interface: Interface,
    settings: Settings,
    /// Whether initialization is finished: parameters are fixed, and there is a simulation.
    initialized: bool,
    /// Absent until an output is needed.
    course: Option<Course>,
    /// Outputs at this communication point, after they have been read.
    outputs: Option<Outputs>,
}

impl Slave {
    /// A slave with the start values of the packaged scene. The engine `newer`, if there is one, computes its motion
    /// unless `solver.portable` is set.
    pub fn new(packaged: Scene, newer: Option<&'static dyn Engine>) -> Self {
        let settings = Settings::of(packaged.clone());
        let interface = Interface::CoSimulation;
        Self { packaged, newer, interface, settings, initialized: false, course: None, outputs: None }
    }

    /// Returns to the state after [`Slave::new`].
    pub fn reset(&mut self) {
        self.settings = Settings::of(self.packaged.clone());
        self.initialized = false;
        (self.course, self.outputs) = (None, None);
    }

    /// [s] The communication point reached.
    pub fn time(&self) -> f64 {
        self.settings.experiment.start + self.elapsed()
    }

    /// [s] Time since the start: the simulation's time, which does not depend on the start time's rounding.
    fn elapsed(&self) -> f64 {
        self.course.as_ref().map_or(0.0, Course::time)
    }

    /// Sets times and tolerance. A tolerance outside the solver's range is limited; then the limit is returned.
    pub fn set_up(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Result<Option<Limit>, Error> {
        let asked = Experiment::new(tolerance, start, stop)?;
        let granted = asked.limited();
        self.settings.experiment = granted;
        Ok(Limit::between(&asked, &granted))
    }

    /// The experiment's tolerance, if it is valid but another one is used.
    pub fn tolerance_left_aside(&self) -> Option<LeftAside> {
        LeftAside::between(&self.settings.experiment, self.settings.tolerance())
    }

    /// Fixes the parameters; the first step can follow. If the scene contradicts itself, the slave
    /// stays as it was, so that the importer may correct it.
    pub fn initialize(&mut self) -> Result<(), Error> {
        self.live()?;
        self.initialized = true;
        Ok(())
    }

    /// Reads variables of one type, none if one of them is refused. Every value fits an `f64`: reals, 32-bit integers,
    /// Booleans.
    pub fn get<T>(
        &mut self,
        asked: ValueType,
        permission: Permission,
        references: &[u32],
        values: &mut [T],
        convert: fn(f64) -> T,
    ) -> Result<(), Error> {
        let (mut outputs, mut places) = (false, None);
        for &reference in references {
            let variable = typed(reference, asked)?;
            permission.check_read(variable)?;
            match variable.access {
                Access::Input { .. } | Access::Parameter(_) => {}
                Access::State(place) | Access::Derivative(place) => {
                    places.get_or_insert_with(|| self.state_places()).of(place, variable)?;
                }
                Access::RealOutput(_) | Access::IntegerOutput(_) | Access::BooleanOutput(_) => outputs = true,
            }
        }
        if outputs {
            self.outputs()?;
        }
        let states = places.map(|places| Ok::<_, Error>((places, self.live()?.state_values()))).transpose()?;
        let of_state = |place: usize, variable: &Variable, of: fn(&StateValues, usize) -> Option<f64>| {
            let absent = VariableError::Absent(variable.name);
            let Some((places, states)) = &states else { return Err(absent) };
            of(states, places.of(place, variable)?).ok_or(absent)
        };
        for (&reference, value) in references.iter().zip(values) {
            let variable = variable(reference)?;
            *value = convert(match &variable.access {
                Access::Input { get, .. } => {
                    finite_output(variable, get(&self.settings.inputs.values(self.elapsed())))?
                }
                Access::RealOutput(get) => finite_output(variable, get(self.outputs()?))?,
                Access::IntegerOutput(get) => f64::from(get(self.outputs()?)),
                Access::BooleanOutput(get) => f64::from(u8::from(get(self.outputs()?))),
                Access::State(place) => finite_output(variable, of_state(*place, variable, StateValues::state)?)?,
                Access::Derivative(place) => finite_output(variable, of_state(*place, variable, StateValues::rate)?)?,
                Access::Parameter(parameter) => parameter.value(&self.settings.scene),
            });
        }
        Ok(())
    }

    /// Writes variables of one type: first into copies, which replace the originals if every value is legal.
    pub fn set<T: Copy>(
        &mut self,
        asked: ValueType,
        permission: Permission,
        references: &[u32],
        values: &[T],
        convert: fn(T) -> f64,
    ) -> Result<(), Error> {
        // Inputs are set in every step, so the scene is copied only if a parameter is set.
        let (mut scene, mut inputs, time) = (None, self.settings.inputs, self.elapsed());
        let mut tolerance_set = self.settings.tolerance_set;
        let mut states: Option<[Option<f64>; MAX_STATES]> = None;
        for (&reference, &value) in references.iter().zip(values) {
            let variable = typed(reference, asked)?;
            if let Some(place) = self.settable_state(variable, permission) {
                states.get_or_insert([None; MAX_STATES])[place] = Some(finite(variable, convert(value))?);
                continue;
            }
            permission.check_write(variable)?;
            let value = finite(variable, convert(value))?;
            match &variable.access {
                Access::Input { get, set, .. } => inputs.set_value(*set, *get, time, value),
                Access::Parameter(parameter) => {
                    let scene = scene.get_or_insert_with(|| self.settings.scene.clone());
                    parameter.write(scene, value)?;
                    self.check_structure(scene, variable.name)?;
                    tolerance_set |= parameter.name == TOLERANCE;
                }
                // `check_write` refuses to write outputs and states.
                Access::RealOutput(_) | Access::IntegerOutput(_) | Access::BooleanOutput(_) => {}
                Access::State(_) | Access::Derivative(_) => {}
            }
        }
        self.settings.inputs = inputs;
        if let Some(scene) = scene {
            self.settings.scene = scene;
        }
        self.settings.tolerance_set = tolerance_set;
        if let Some(states) = states {
            self.take_states(&states);
        }
        self.drop_what_followed_from_settings();
        Ok(())
    }

    /// Strings. No variable is a string, so only an empty list is allowed.
    pub fn check_strings(&self, references: &[u32]) -> Result<(), Error> {
        match references {
            [] => Ok(()),
            [first, ..] => {
                let variable = variable(*first)?;
                let is = ValueType::of(variable).name();
                Err(VariableError::Type { name: variable.name, is, asked: "String" }.into())
            }
        }
    }

    /// Sets first time derivatives of real inputs.
    pub fn set_input_derivatives(&mut self, references: &[u32], orders: &[i32], values: &[f64]) -> Result<(), Error> {
        let (mut inputs, time) = (self.settings.inputs, self.elapsed());
        for ((&reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let variable = variable(reference)?;
            let RealInput { set, .. } = real_input(variable)?;
            check_first_order(variable, order)?;
            inputs.set_rate(set, time, finite(variable, value)?);
        }
        self.settings.inputs = inputs;
        self.drop_what_followed_from_settings();
        Ok(())
    }

    /// Reads first time derivatives of real outputs.
    pub fn get_output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [f64],
    ) -> Result<(), Error> {
        for (&reference, &order) in references.iter().zip(orders) {
            let variable = variable(reference)?;
            real_output(variable)?;
            check_first_order(variable, order)?;
        }
        let rates = self.live()?.output_rates();
        fill(references, &rates, values)
    }

    /// [s] Where a step of `size` from the importer's `point` ends, counted from the start. A refusal changes nothing.
    pub fn step_end(&self, point: f64, size: f64) -> Result<f64, Error> {
        let end = self.settings.experiment.step_end(self.elapsed(), point, size)?;
        let inputs = self.settings.inputs.values_until(self.elapsed(), end);
        if !are_finite(&inputs) {
            // The error names the first input that overflows.
            VARIABLES.iter().try_for_each(|variable| match variable.access {
                Access::Input { get, .. } => finite(variable, get(&inputs)).map(drop),
                _ => Ok(()),
            })?;
        }
        Ok(end)
    }

    /// The state of the slave: its settings and, after initialization, the simulation.
    pub fn save(&self) -> (Settings, Option<Snapshot>) {
        // While parameters can still change, the simulation follows from the scene.
        let running = if self.initialized { self.course.as_ref() } else { None };
        (self.settings.clone(), running.map(Course::snapshot))
    }

    /// Restores a saved state.
    pub fn restore(&mut self, settings: &Settings, snapshot: Option<&Snapshot>) -> Result<(), Error> {
        // The parts that can fail come first.
        self.check_structure(&settings.scene, "a parameter of the saved state")?;
        self.course = match snapshot {
            None => None,
            Some(snapshot) => {
                let scene = settings.simulated_scene()?;
                Some(Course::restore(self.interface, engine_of(self.newer, &scene), &scene, snapshot)?)
            }
        };
        self.initialized = snapshot.is_some();
        self.outputs = None;
        self.settings = settings.clone();
        Ok(())
    }

    /// The simulation with the inputs of this communication point. It is started if there is none yet.
    fn live(&mut self) -> Result<&mut Course, Error> {
        let (interface, newer) = (self.interface, self.newer);
        match &mut self.course {
            Some(course) => {
                course.take(&mut self.settings.inputs);
                Ok(course)
            }
            absent => Ok(absent.insert(started(interface, newer, &mut self.settings)?)),
        }
    }

    fn outputs(&mut self) -> Result<&Outputs, Error> {
        if self.outputs.is_none() {
            self.outputs = Some(self.live()?.outputs());
        }
        // The outputs exist now. Copying them for each variable would cost more than computing them.
        Ok(self.outputs.get_or_insert_default())
    }

    fn drop_what_followed_from_settings(&mut self) {
        self.outputs = None;
        match &mut self.course {
            _ if !self.initialized => self.course = None,
            // A mechanism that the importer moves has its inputs at once, so that looking at it leaves no trace.
            Some(course @ Course::Hosted(_)) => course.take(&mut self.settings.inputs),
            _ => {}
        }
    }
}

/// The mechanism of these settings at its start, with its inputs at the start.
fn started(interface: Interface, newer: Option<&'static dyn Engine>, settings: &mut Settings) -> Result<Course, Error> {
    let scene = settings.simulated_scene()?;
    Course::start(interface, engine_of(newer, &scene), &scene, &mut settings.inputs)
}

/// The engine for `scene`.
fn engine_of(newer: Option<&'static dyn Engine>, scene: &Scene) -> &'static dyn Engine {
    match newer {
        Some(newer) if !scene.solver.portable => newer,
        _ => &Own,
    }
}

/// Returns the values of these outputs in `source`, up to the first that is not finite.
fn fill(references: &[u32], source: &Outputs, values: &mut [f64]) -> Result<(), Error> {
    for (&reference, value) in references.iter().zip(values) {
        let variable = variable(reference)?;
        *value = finite_output(variable, real_output(variable)?(source))?;
    }
    Ok(())
}
