//! Mechanisms that differ in one parameter by some steps.

use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::state::{CONTACTS, Pose};
use crate::scene::Scene;
use crate::scene::parameter::{Kind, Parameter};
use crate::simulation::assemble;
use crate::simulation::error::SimulationError;
use crate::simulation::start::pose;
use std::cell::OnceCell;

/// Steps of a difference, in steps h, with their weights. Opposite ones follow each other, so that the sum is exactly 0
/// where nothing changes.
pub const CENTRAL: [(f64, f64); 4] = [(-1.0, -8.0 / 12.0), (1.0, 8.0 / 12.0), (-2.0, 1.0 / 12.0), (2.0, -1.0 / 12.0)];
/// The longest step as a share of a parameter.
const LONGEST: f64 = 1e-3;
/// Number of steps, each a tenth of the one before.
pub const LEVELS: usize = 7;
/// [rad] Largest change of an angle within a step.
pub const TURN: f64 = 2e-3;

/// The longest step of a parameter that is 0, as a share of its range …
const OF_RANGE: f64 = 1e-4;
/// … and at most this.
const MOST: f64 = 1e-4;

/// The step of a level if that of the first is `first`.
pub fn step_at(first: f64, level: usize) -> f64 {
    first * 0.1_f64.powi(level as i32)
}

/// A mechanism with one parameter changed.
pub struct Neighbour {
    /// The mechanism.
    pub model: Box<dyn MechanismModel>,
    /// Its observer.
    pub observer: Observer,
    /// The state in which it starts, and the approach speeds of the contacts that are closed there.
    pub start: (Vec<f64>, [f64; CONTACTS]),
}

/// Neighbours at one step.
pub struct Level {
    /// Unit of the parameter.
    pub step: f64,
    /// At the places of [`CENTRAL`].
    pub neighbours: [Neighbour; CENTRAL.len()],
}

/// Neighbours at all steps. A level is assembled when it is first used: few steps of a motion need short ones.
pub struct Levels {
    scene: Scene,
    /// The parameter.
    pub parameter: &'static Parameter,
    widest: Level,
    shorter: [OnceCell<Level>; LEVELS - 1],
}

impl Neighbour {
    /// The neighbour of a scene's mechanism with another value of the parameter, by `change`.
    #[inline(never)]
    fn at(scene: &Scene, parameter: &Parameter, change: f64) -> Result<Self, SimulationError> {
        let (value, mut changed) = (parameter.value(scene), scene.clone());
        let refused = |reason: String| {
            let name = parameter.name;
            SimulationError::Scene(format!("{name} = {value} has no neighbours to differentiate by: {reason}"))
        };
        parameter.write(&mut changed, value + change).map_err(|error| refused(error.to_string()))?;
        changed.check().map_err(|error| refused(error.to_string()))?;
        let (scene, model) = (&changed, assemble::model(&changed));
        let mut states = vec![0.0; model.layout().states];
        model.write_start(&pose(scene)?, &mut states);
        let approach = model.start_contacts(0.0, &states).map(|contact| contact.approach);
        Ok(Self { model, observer: Observer::new(scene), start: (states, approach) })
    }
}

impl Levels {
    /// Neighbours along a real parameter of `scene`.
    ///
    /// # Errors
    /// `Scene` if a neighbour cannot be assembled: the parameter is at an end of its range.
    pub fn new(scene: &Scene, parameter: &'static Parameter) -> Result<Self, SimulationError> {
        let widest = Level::new(scene, parameter, longest(parameter, scene))?;
        Ok(Self { scene: scene.clone(), parameter, widest, shorter: Default::default() })
    }

    /// The neighbours at a step, assembled once.
    pub fn at(&self, place: usize) -> &Level {
        let Some(cell) = place.checked_sub(1).and_then(|place| self.shorter.get(place)) else { return &self.widest };
        match cell.get() {
            Some(level) => level,
            None => match Level::new(&self.scene, self.parameter, step_at(self.widest.step, place)) {
                Ok(level) => cell.get_or_init(|| level),
                // They lie between those at the longest step, which are legal.
                Err(_) => &self.widest,
            },
        }
    }

    /// The longest step.
    pub fn longest(&self) -> f64 {
        self.widest.step
    }

    /// The neighbours at the longest step that turns no body by much from its pose `here`, and their poses.
    pub fn poses(&self, here: &Pose, t: f64, y: &[f64]) -> (&Level, [Pose; CENTRAL.len()]) {
        let at = |place: usize| {
            let level = self.at(place);
            (level, level.neighbours.each_ref().map(|neighbour| neighbour.model.pose(t, y)))
        };
        let turns = |there: &Pose| {
            let mut angles = here.rotations.angle.iter().zip(there.rotations.angle);
            angles.any(|(own, other)| (other - own).abs() > 4.0 * TURN)
        };
        (0..LEVELS - 1).map(at).find(|(_, poses)| !poses.iter().any(turns)).unwrap_or_else(|| at(LEVELS - 1))
    }
}

impl Level {
    fn new(scene: &Scene, parameter: &'static Parameter, step: f64) -> Result<Self, SimulationError> {
        let [a, b, c, d] = CENTRAL.map(|(place, _)| Neighbour::at(scene, parameter, place * step));
        Ok(Self { step, neighbours: [a?, b?, c?, d?] })
    }
}

/// Size of a parameter; 0 if it may be negative and is closer to 0 than the longest step there, as an offset that is 0 but for
/// rounding.
pub fn size(parameter: &Parameter, scene: &Scene) -> f64 {
    let size = parameter.value(scene).abs();
    let is_near_zero = size < MOST && matches!(parameter.kind, Kind::Real { min, .. } if min < 0.0);
    if is_near_zero { 0.0 } else { size }
}

/// The longest step of a parameter.
fn longest(parameter: &Parameter, scene: &Scene) -> f64 {
    match (size(parameter, scene), &parameter.kind) {
        (0.0, Kind::Real { max, .. }) => (OF_RANGE * max).min(MOST),
        (size, Kind::Real { unit: "rad", .. }) => LONGEST * size.min(1.0),
        (size, _) => LONGEST * size,
    }
}
