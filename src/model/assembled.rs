//! The model of a scene: its mechanism, as the integrator and the simulation ask for it.

use super::bristles::bristled_contacts;
use super::compiled::Compiled;
use super::contact::Account;
use super::drive::InputSignal;
use super::ideal::IdealMechanism;
use super::jacobian::differentiate;
use super::joint::rectangle::CORNERS;
use super::mechanism::{FlexibleRod, Mechanism};
use super::plant::Plant;
use super::rod::{Modes, Room};
use super::scalar::Tangent;
use super::scales::Scale;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose};
use super::unilateral::Acting;
use crate::integrator::complementarity::MOST_CONTACTS;
use crate::integrator::{
    ContactLaw, Discontinuities, EventFunctions, Events, Extent, Impulses, Jacobian, Linearizable, MAX_STATES, Ode,
    Relative, Reset, SeveralInstants, Tableau, Triggered, Unilateral,
};
use crate::math::{Real, Row};
use crate::scene::Scene;

/// The model of a scene: a mechanism, and the code that its steps are made of.
#[derive(Clone, Debug)]
pub struct Model {
    /// The mechanism.
    pub mechanism: Mechanism,
    compiled: Compiled,
    suits_blocks: bool,
    scales: Vec<f64>,
    longest_step: f64,
    event_scale: f64,
}

impl Model {
    /// Assembles the model of a scene that starts at `time` [s].
    pub fn assemble(scene: &Scene, time: f64) -> Self {
        let mechanism = Mechanism::assemble(scene, time);
        let (structure, states) = (mechanism.structure, mechanism.states());
        assert!(states <= MAX_STATES, "room for every state");
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
        Self {
            compiled: Compiled::of(&mechanism),
            suits_blocks: structure.topology.has_one_play_in_a_pin() && states == 2 * p,
            scales,
            longest_step: scale.longest_step,
            event_scale: if structure.closed { IdealMechanism::CHANGE_POINT_SCALE } else { scale.length },
            mechanism,
        }
    }

    /// The same by the code for every structure: it has the same motion, and takes longer.
    pub fn general(mut self) -> Self {
        self.compiled = Compiled::general(&self.mechanism);
        self
    }

    /// The same with a flexible rod's modes in arrays that have room for more of them: it has the same motion.
    pub fn in_room(mut self, room: Room) -> Self {
        if let Some(FlexibleRod { rod, modes, .. }) = &mut self.mechanism.rod {
            *modes = Modes::in_room(rod, room);
        }
        self.compiled = Compiled::of(&self.mechanism);
        self
    }
}

impl Ode for Model {
    type Discrete = Contacts;

    fn extent(&self) -> Extent {
        let states = self.scales.len();
        Extent { positions: self.mechanism.positions(), weighed: states, states }
    }

    fn rates(&self, contacts: &Contacts, t: f64, y: &[f64], rates: &mut [f64]) {
        (self.compiled.rates)(&self.mechanism, contacts, t, y, rates);
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }

    fn stages(&self, tableau: &Tableau, contacts: &Contacts, t: f64, y: &[f64], h: f64, k: &mut [f64]) -> bool {
        // With bristles, there are more states than the compiled loops have places for.
        let second_order = self.scales.len() == 2 * self.mechanism.positions();
        second_order && (self.compiled.stages)(&self.mechanism, tableau, contacts, t, y, h, k)
    }
}

impl SeveralInstants for Model {
    fn rates_in_row(&self, contacts: &Contacts, t: &Row, y: &[Row], rates: &mut [Row]) {
        (self.compiled.rates_of_eight)(&self.mechanism, contacts, *t, y, rates);
    }

    fn suits_blocks(&self) -> bool {
        self.suits_blocks
    }
}

impl Linearizable for Model {
    fn jacobian(&self, contacts: &Contacts, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        let states = self.scales.len();
        differentiate::<MAX_STATES>(states, states, t, y, jacobian, &|t, y, rates| {
            self.tangent_rates(contacts, t, y, rates)
        });
    }
}

impl Events for Model {
    fn event_count(&self) -> usize {
        self.mechanism.guard_count()
    }

    fn event_functions(&self, contacts: &Contacts, t: f64, y: &[f64], functions: &mut EventFunctions) {
        self.mechanism.guards(contacts, t, y, functions);
    }

    fn rates_and_event_functions(
        &self,
        contacts: &Contacts,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        functions: &mut EventFunctions,
    ) {
        (self.compiled.ends)(&self.mechanism, contacts, t, y, rates, functions);
    }

    fn discontinuities(&self, contacts: &Contacts, t: f64, y: &[f64], functions: &mut Discontinuities) {
        let Mechanism { structure, clearances, .. } = &self.mechanism;
        clearances.kinks(structure.play, contacts, &self.mechanism.pose(t, y), functions);
    }

    fn is_dead_end(&self, _: usize) -> bool {
        self.mechanism.structure.closed
    }

    fn event_scale(&self) -> f64 {
        self.event_scale
    }

    fn reset(&self, contacts: &Contacts, t: f64, y: &mut [f64], triggered: &Triggered) -> Reset<Contacts> {
        let Mechanism { structure, clearances, .. } = &self.mechanism;
        if structure.closed {
            return Reset { discrete: *contacts, impact: None };
        }
        let pose = self.mechanism.pose(t, y);
        clearances.cross(structure.play, contacts, &pose, triggered, &mut y[2 * self.mechanism.positions()..])
    }
}

impl Unilateral for Model {
    fn contact_laws(&self) -> [ContactLaw; MOST_CONTACTS] {
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

/// What the contacts do in a step.
fn acting(impulses: &Impulses, states: usize) -> Acting<'_> {
    let acts = std::array::from_fn(|contact| impulses.acts(contact));
    Acting { t: impulses.t, y: &impulses.y[..states], forces: &impulses.forces, acts }
}

impl Plant for Model {
    fn write_start(&self, pose: &StartPose, y: &mut [f64]) {
        self.mechanism.start(pose, y);
    }

    fn start_contacts(&self, t: f64, y: &[f64]) -> Contacts {
        self.mechanism.clearances.start(self.mechanism.structure.play, &self.mechanism.pose(t, y))
    }

    fn set_signal(&mut self, signal: InputSignal) {
        self.mechanism.signal = signal;
    }

    fn signal(&self) -> &InputSignal {
        &self.mechanism.signal
    }

    fn start_time(&self) -> f64 {
        self.mechanism.rotor.start_time
    }

    fn set_start_time(&mut self, time: f64) {
        self.mechanism.rotor.start_time = time;
    }

    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64]) -> Instant {
        self.mechanism.instant(contacts, t, y, &mut [0.0; MAX_STATES][..y.len()])
    }

    fn rates_and_instant(&self, contacts: &Contacts, t: f64, y: &[f64], rates: &mut [f64]) -> Instant {
        self.mechanism.instant(contacts, t, y, rates)
    }

    fn instant_under(&self, impulses: &Impulses, t: f64, y: &[f64]) -> Instant {
        self.mechanism.instant_under(&acting(impulses, y.len()), t, y, &mut [0.0; MAX_STATES][..y.len()])
    }

    fn rates_under(&self, impulses: &Impulses, t: f64, y: &[f64], rates: &mut [f64]) {
        self.mechanism.instant_under(&acting(impulses, y.len()), t, y, rates);
    }

    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS] {
        self.mechanism.clearances.depths(self.mechanism.structure.play, pose)
    }

    fn account(&self, contacts: &Contacts, pose: &Pose, y: &[f64]) -> Account {
        self.mechanism.account(contacts, pose, y)
    }

    fn tangent_rates(&self, contacts: &Contacts, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        self.mechanism.tangent_rates(contacts, t, y, rates);
    }

    fn tangent_instant(&self, contacts: &Contacts, t: Tangent, y: &[Tangent]) -> (Instant<Tangent>, Account<Tangent>) {
        self.mechanism.tangent_instant(contacts, t, y, &mut [Tangent::ZERO; MAX_STATES][..y.len()])
    }
}
