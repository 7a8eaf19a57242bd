//! The model of a scene: its mechanism, with the interfaces of the integrator and the simulation.

use super::bristles::bristled_contacts;
use super::clearances::deepest_journals;
use super::compiled::{Compiled, is_quick};
use super::contact::{ContactEnergy, Rubbing};
use super::drive::InputSignal;
use super::ideal::IdealMechanism;
use super::jacobian::differentiate;
use super::joint::rectangle::CORNERS;
use super::loads::Loads;
use super::mechanism::{FlexibleRod, Mechanism};
use super::mechanism_model::MechanismModel;
use super::rod::{Modes, ROWS_WITH_MODES, RodCapacity};
use super::scalar::Tangent;
use super::scales::Scale;
use super::start::StartPose;
use super::state::{CONTACTS, Conditions, Contacts, Evaluation, Pose};
use super::unilateral::StepForces;
use crate::integrator::complementarity::MAX_CONTACTS;
use crate::integrator::{
    ContactLaw, Discontinuities, EventFunctions, Events, Impulses, Jacobian, Linearizable, MAX_EVENTS, MAX_STATES, Ode,
    Relative, Reset, SeveralInstants, StateLayout, Tableau, Triggered, Unilateral,
};
use crate::math::F64x8;
use crate::scene::Scene;
use std::ops::Range;

/// The model of a scene: a mechanism and the functions that are compiled for its structure.
#[derive(Clone, Debug)]
pub struct Model {
    /// The mechanism.
    pub mechanism: Mechanism,
    compiled: Compiled,
    suits_blocks: bool,
    rates_are_cheap: bool,
    scales: Vec<f64>,
    longest_step: f64,
    event_scale: f64,
    highest_events: [f64; MAX_EVENTS],
}

impl Model {
    /// Assembles the model of a scene. It is immutable: time, states, contacts and inputs are arguments.
    pub fn assemble(scene: &Scene) -> Self {
        let mechanism = Mechanism::assemble(scene);
        let (structure, states) = (mechanism.structure, mechanism.states());
        assert!(states <= MAX_STATES, "a model has at most MAX_STATES states");
        let scale = Scale::of(scene);
        let p = mechanism.positions();
        let mut scales = vec![0.0; states];
        let (positions, rates) = scales[..2 * p].split_at_mut(p);
        positions.fill(scale.length);
        if !structure.closed {
            structure.set_angles(scale.angle, positions);
        }
        for (rate, position) in rates.iter_mut().zip(positions.iter()) {
            *rate = position * scale.frequency;
        }
        if let Some(FlexibleRod { rod, .. }) = &mechanism.rod {
            for (k, &frequency) in (structure.positions..).zip(&rod.frequency) {
                positions[k] = scale.deflection;
                rates[k] = scale.deflection * frequency.max(scale.frequency);
            }
        }
        for (scale, (_, deflection)) in scales[2 * p..].iter_mut().zip(bristled_contacts(scene)) {
            *scale = deflection;
        }
        let (compiled, second_order) = (Compiled::of(&mechanism), states == 2 * p);
        Self {
            compiled,
            rates_are_cheap: second_order && is_quick(&mechanism),
            suits_blocks: structure.topology.has_one_pin_clearance()
                && second_order
                && (mechanism.rod.is_none() || ROWS_WITH_MODES),
            scales,
            longest_step: scale.longest_step,
            highest_events: deepest_journals(scene),
            event_scale: if structure.closed { IdealMechanism::CHANGE_POINT_SCALE } else { scale.length },
            mechanism,
        }
    }

    /// This model with the functions for any structure in place of the specialised ones. The motion is the same; it
    /// takes longer.
    pub fn general(mut self) -> Self {
        self.compiled = Compiled::general(&self.mechanism);
        self
    }

    /// This model with a flexible rod's modes in larger arrays. The motion is the same.
    pub fn with_capacity(mut self, room: RodCapacity) -> Self {
        if let Some(FlexibleRod { rod, modes, known, .. }) = &mut self.mechanism.rod {
            (*modes, *known) = (Modes::with_capacity(rod, room), None);
        }
        self.compiled = Compiled::of(&self.mechanism);
        self
    }
}

impl Ode for Model {
    type Discrete = Conditions;

    fn layout(&self) -> StateLayout {
        let states = self.scales.len();
        let Mechanism { structure, .. } = &self.mechanism;
        StateLayout { positions: self.mechanism.positions(), places: structure.positions, weighted: states, states }
    }

    fn rates(&self, conditions: &Conditions, t: f64, y: &[f64], rates: &mut [f64]) {
        (self.compiled.rates)(&self.mechanism, conditions, t, y, rates);
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }

    fn stages(&self, tableau: &Tableau, conditions: &Conditions, t: f64, y: &[f64], h: f64, k: &mut [f64]) -> bool {
        // The compiled loops have no room for the first-order states of bristles.
        let second_order = self.scales.len() == 2 * self.mechanism.positions();
        second_order && (self.compiled.stages)(&self.mechanism, tableau, conditions, t, y, h, k)
    }
}

impl SeveralInstants for Model {
    fn rates_in_row(&self, conditions: &Conditions, t: &F64x8, y: &[F64x8], rates: &mut [F64x8]) {
        (self.compiled.rates_of_eight)(&self.mechanism, conditions, *t, y, rates);
    }

    fn suits_blocks(&self) -> bool {
        self.suits_blocks
    }
}

impl Linearizable for Model {
    fn rates_are_cheap(&self) -> bool {
        self.rates_are_cheap
    }

    fn jacobian(&self, conditions: &Conditions, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        let states = self.scales.len();
        differentiate::<MAX_STATES>(states, states, t, y, jacobian, &|t, y, rates| {
            self.tangent_rates(conditions, t, y, rates)
        });
    }
}

impl Events for Model {
    fn event_count(&self) -> usize {
        self.mechanism.event_count()
    }

    fn event_functions(&self, conditions: &Conditions, t: f64, y: &[f64], functions: &mut EventFunctions) {
        self.mechanism.event_functions(&conditions.contacts, t, y, functions);
    }

    fn rates_and_event_functions(
        &self,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        functions: &mut EventFunctions,
    ) {
        (self.compiled.ends)(&self.mechanism, conditions, t, y, rates, functions);
    }

    fn discontinuities(&self, conditions: &Conditions, t: f64, y: &[f64], functions: &mut Discontinuities) {
        let Mechanism { structure, clearances, .. } = &self.mechanism;
        clearances.discontinuities(structure.play, &conditions.contacts, &self.mechanism.pose(t, y), functions);
    }

    fn is_dead_end(&self, _: usize) -> bool {
        self.mechanism.structure.closed
    }

    fn highest_events(&self) -> &[f64; MAX_EVENTS] {
        &self.highest_events
    }

    fn event_scale(&self) -> f64 {
        self.event_scale
    }

    fn reset(&self, conditions: &Conditions, t: f64, y: &mut [f64], triggered: &Triggered) -> Reset<Conditions> {
        let Mechanism { structure, clearances, .. } = &self.mechanism;
        if structure.closed {
            return Reset { discrete: *conditions, impact: None };
        }
        let pose = self.mechanism.pose(t, y);
        let bristles = &mut y[2 * self.mechanism.positions()..];
        clearances.cross(structure.play, conditions, t, &pose, triggered, bristles)
    }
}

impl Unilateral for Model {
    fn contact_laws(&self) -> [ContactLaw; MAX_CONTACTS] {
        self.mechanism.clearances.laws
    }

    fn contacts(&self, t: f64, y: &[f64]) -> Relative {
        self.mechanism.contacts(t, y)
    }

    fn response(&self, t: f64, y: &[f64], contact: usize, part: usize, response: &mut [f64]) {
        response.fill(0.0);
        self.mechanism.response(t, y, contact, part, response);
    }
}

/// Impulses of a step as forces, for a mechanism with `states` states.
fn acting(impulses: &Impulses, states: usize) -> StepForces<'_> {
    let acts = std::array::from_fn(|contact| impulses.acts(contact));
    StepForces { t: impulses.t, y: &impulses.y[..states], forces: &impulses.forces, acts }
}

impl MechanismModel for Model {
    fn write_start(&self, pose: &StartPose, y: &mut [f64]) {
        self.mechanism.start(pose, y);
    }

    fn start_contacts(&self, t: f64, y: &[f64]) -> Contacts {
        self.mechanism.clearances.start(self.mechanism.structure.play, &self.mechanism.pose(t, y))
    }

    fn evaluation(&self, conditions: &Conditions, t: f64, y: &[f64]) -> Evaluation {
        self.mechanism.evaluation(conditions, t, y, &mut [0.0; MAX_STATES][..y.len()])
    }

    fn rates_and_evaluation(&self, conditions: &Conditions, t: f64, y: &[f64], rates: &mut [f64]) -> Evaluation {
        self.mechanism.evaluation(conditions, t, y, rates)
    }

    fn evaluation_under(&self, impulses: &Impulses, inputs: &InputSignal, t: f64, y: &[f64]) -> Evaluation {
        self.mechanism.evaluation_under(&acting(impulses, y.len()), inputs, t, y, &mut [0.0; MAX_STATES][..y.len()])
    }

    fn rates_under(&self, impulses: &Impulses, inputs: &InputSignal, t: f64, y: &[f64], rates: &mut [f64]) {
        self.mechanism.evaluation_under(&acting(impulses, y.len()), inputs, t, y, rates);
    }

    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS] {
        self.mechanism.clearances.depths(self.mechanism.structure.play, pose)
    }

    fn contact_energy(&self, contacts: &Contacts, pose: &Pose, y: &[f64]) -> ContactEnergy {
        self.mechanism.contact_energy(contacts, pose, y)
    }

    fn rubbing(&self, contacts: &Contacts, pose: &Pose, y: &[f64]) -> [Rubbing; CONTACTS] {
        let Mechanism { clearances, structure, .. } = &self.mechanism;
        clearances.rubbing(structure.play, contacts, pose, &y[2 * self.mechanism.positions()..])
    }

    fn loads(&self, conditions: &Conditions, t: f64, pose: &Pose, y: &[f64]) -> Loads {
        self.mechanism.loads_at(conditions, t, pose, y)
    }

    fn pose(&self, t: f64, y: &[f64]) -> Pose {
        self.mechanism.pose(t, y)
    }

    fn approaches(&self, pose: &Pose) -> [(f64, f64); CONTACTS] {
        let Mechanism { clearances, structure, .. } = &self.mechanism;
        clearances.penetrations(structure.play, pose)
    }

    fn tangent_approaches(&self, pose: &Pose<Tangent>) -> [(Tangent, Tangent); CONTACTS] {
        let Mechanism { clearances, structure, .. } = &self.mechanism;
        clearances.penetrations(structure.play, pose)
    }

    fn bristles_of(&self, contact: usize) -> Range<usize> {
        let first = 2 * self.mechanism.positions();
        let of_contact = self.mechanism.clearances.bristles.iter().position(|&bristled| bristled == contact);
        of_contact.map_or(first..first, |place| first + place..first + place + 1)
    }

    fn speed_floor(&self, contact: usize) -> f64 {
        self.mechanism.clearances.speed_floor(contact)
    }

    fn tangent_rates(&self, conditions: &Conditions, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        self.mechanism.tangent_rates(conditions, t, y, rates);
    }

    fn tangent_evaluation(
        &self,
        conditions: &Conditions,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) -> Evaluation<Tangent> {
        self.mechanism.tangent_evaluation(conditions, t, y, rates)
    }

    fn tangent_contact_energy(
        &self,
        contacts: &Contacts,
        pose: &Pose<Tangent>,
        y: &[Tangent],
    ) -> ContactEnergy<Tangent> {
        self.mechanism.contact_energy(contacts, pose, y)
    }
}
