//! A mechanism with a rigid rod, as the integrator and the simulation ask for it.

use super::bristles::bristled_contacts;
use super::compiled::{Compiled, Stages, stages};
use super::contact::Account;
use super::drive::InputSignal;
use super::ideal::IdealMechanism;
use super::jacobian::differentiate;
use super::joint::guide::CORNERS;
use super::mechanism::Mechanism;
use super::plant::Plant;
use super::scalar::Tangent;
use super::scales::Scale;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose};
use super::unilateral::Acting;
use crate::integrator::complementarity::MOST_CONTACTS;
use crate::integrator::{
    ContactLaw, Crossed, Extent, GUARDS, Guard, Impulses, Jacobian, Kinks, Problem, ROOM, Relative, Reset, STAGES,
    Tableau, Unilateral,
};
use crate::math::{Real, Row};
use crate::scene::Scene;

/// A mechanism in arrays of exactly `N` states, or with room for `N`.
#[derive(Clone, Debug)]
pub struct Rigid<const N: usize> {
    /// Without regard to its arrays.
    pub mechanism: Mechanism,
    compiled: Compiled,
    stages: Stages<N>,
    suits_blocks: bool,
    scales: [f64; N],
    longest_step: f64,
    guard_scale: f64,
}

impl<const N: usize> Rigid<N> {
    /// Assembles the mechanism of a scene that starts at `time` [s].
    pub fn assemble(scene: &Scene, time: f64) -> Self {
        let mechanism = Mechanism::assemble(scene, time);
        let (structure, states) = (mechanism.structure, mechanism.states());
        assert!(states == N || (N >= ROOM && states <= N), "room for every state, or exactly as many");
        let scale = Scale::of(scene);
        let p = structure.positions;
        let mut scales = [0.0; N];
        let (positions, rates) = scales[..2 * p].split_at_mut(p);
        positions.fill(scale.length);
        if !structure.closed {
            structure.set_angles(scale.angle, positions);
        }
        for (rate, position) in rates.iter_mut().zip(positions.iter()) {
            *rate = position * scale.frequency;
        }
        for (scale, (_, deflection)) in scales[2 * p..].iter_mut().zip(bristled_contacts(scene)) {
            *scale = deflection;
        }
        Self {
            compiled: Compiled::of(&structure),
            stages: stages(&structure),
            suits_blocks: structure.topology.has_one_play_in_a_pin() && states == 2 * p,
            scales,
            longest_step: scale.longest_step,
            guard_scale: if structure.closed { IdealMechanism::CHANGE_POINT_SCALE } else { scale.length },
            mechanism,
        }
    }
}

impl<const N: usize> Problem<N> for Rigid<N> {
    type Modes = Contacts;

    fn extent(&self) -> Extent {
        let states = self.mechanism.states();
        Extent { positions: self.mechanism.structure.positions, weighed: states, states }
    }

    fn rates(&self, contacts: &Contacts, t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        (self.compiled.rates)(&self.mechanism, contacts, t, y, rates);
    }

    fn rates_in_row(&self, contacts: &Contacts, t: &Row, y: &[Row; N], rates: &mut [Row; N]) {
        (self.compiled.rates_of_eight)(&self.mechanism, contacts, *t, y, rates);
    }

    fn suits_blocks(&self) -> bool {
        self.suits_blocks
    }

    fn stages(&self, tableau: &Tableau, contacts: &Contacts, t: f64, y: &[f64; N], h: f64, k: &mut [[f64; N]; STAGES]) {
        (self.stages)(&self.mechanism, tableau, contacts, t, y, h, k);
    }

    fn jacobian(&self, contacts: &Contacts, t: f64, y: &[f64; N], jacobian: &mut Jacobian<N>) {
        let states = self.mechanism.states();
        differentiate(states, states, t, y, jacobian, &|t, y, rates| self.tangent_rates(contacts, t, y, rates));
    }

    fn scales(&self) -> &[f64; N] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }

    fn guard_count(&self) -> usize {
        self.mechanism.guard_count()
    }

    fn guards(&self, contacts: &Contacts, t: f64, y: &[f64; N], guards: &mut [Guard; GUARDS]) {
        self.mechanism.guards(contacts, t, y, guards);
    }

    fn rates_and_guards(
        &self,
        contacts: &Contacts,
        t: f64,
        y: &[f64; N],
        rates: &mut [f64; N],
        guards: &mut [Guard; GUARDS],
    ) {
        (self.compiled.ends)(&self.mechanism, contacts, t, y, rates, guards);
    }

    fn kinks(&self, contacts: &Contacts, t: f64, y: &[f64; N], kinks: &mut Kinks) {
        let Mechanism { structure, clearances, .. } = &self.mechanism;
        clearances.kinks(structure.play, contacts, &self.mechanism.pose(t, y), kinks);
    }

    fn is_dead_end(&self, _: usize) -> bool {
        self.mechanism.structure.closed
    }

    fn guard_scale(&self) -> f64 {
        self.guard_scale
    }

    fn cross(&self, contacts: &Contacts, t: f64, y: &mut [f64; N], crossed: &Crossed) -> Reset<Contacts> {
        let Mechanism { structure, clearances, .. } = &self.mechanism;
        if structure.closed {
            return Reset { modes: *contacts, impact: None };
        }
        let pose = self.mechanism.pose(t, y);
        clearances.cross(structure.play, contacts, &pose, crossed, &mut y[2 * structure.positions..])
    }
}

impl<const N: usize> Unilateral<N> for Rigid<N> {
    fn contact_laws(&self) -> [ContactLaw; MOST_CONTACTS] {
        self.mechanism.clearances.laws
    }

    fn contacts(&self, t: f64, y: &[f64; N]) -> Relative {
        self.mechanism.contacts(t, y)
    }

    fn response(&self, t: f64, y: &[f64; N], contact: usize, part: usize) -> [f64; N] {
        let mut rates = [0.0; N];
        self.mechanism.response(t, y, contact, part, &mut rates);
        rates
    }
}

/// What the contacts do in a step.
fn acting<const N: usize>(impulses: &Impulses<N>) -> Acting<'_> {
    let acts = std::array::from_fn(|contact| impulses.acts(contact));
    Acting { t: impulses.t, y: &impulses.y, forces: &impulses.forces, acts }
}

impl<const N: usize> Plant<N> for Rigid<N> {
    fn start(&self, pose: &StartPose) -> [f64; N] {
        let mut y = [0.0; N];
        self.mechanism.start(pose, &mut y);
        y
    }

    fn start_contacts(&self, t: f64, y: &[f64; N]) -> Contacts {
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

    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64; N]) -> Instant {
        self.mechanism.instant(contacts, t, y, &mut [0.0; N])
    }

    fn rates_and_instant(&self, contacts: &Contacts, t: f64, y: &[f64; N], rates: &mut [f64; N]) -> Instant {
        self.mechanism.instant(contacts, t, y, rates)
    }

    fn instant_under(&self, impulses: &Impulses<N>, t: f64, y: &[f64; N]) -> Instant {
        self.mechanism.instant_under(&acting(impulses), t, y, &mut [0.0; N])
    }

    fn rates_under(&self, impulses: &Impulses<N>, t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        self.mechanism.instant_under(&acting(impulses), t, y, rates);
    }

    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS] {
        self.mechanism.clearances.depths(self.mechanism.structure.play, pose)
    }

    fn account(&self, contacts: &Contacts, pose: &Pose, y: &[f64; N]) -> Account {
        self.mechanism.account(contacts, pose, y)
    }

    fn tangent_rates(&self, contacts: &Contacts, t: Tangent, y: &[Tangent; N], rates: &mut [Tangent; N]) {
        self.mechanism.tangent_rates(contacts, t, y, rates);
    }

    fn tangent_instant(
        &self,
        contacts: &Contacts,
        t: Tangent,
        y: &[Tangent; N],
    ) -> (Instant<Tangent>, Account<Tangent>) {
        self.mechanism.tangent_instant(contacts, t, y, &mut [Tangent::ZERO; N])
    }
}
