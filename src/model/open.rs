//! An open mechanism: at least one joint has clearance.
//!
//! Which joints are ideal and which drive there is are constants of the type, so that each of the
//! thirty topologies is compiled on its own and holds no trace of the others.

use super::bristles::bristled_contacts;
use super::contact::Account;
use super::drive::InputSignal;
use super::jacobian::differentiate;
use super::joint::guide::CORNERS;
use super::kinematics::{Place, Velocity, roots};
use super::linkage::{Arrangement, Linkage};
use super::mechanism::Topology;
use super::plant::{Plant, ROOM};
use super::scalar::Tangent;
use super::scales;
use super::stages::of_so_many;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose, turning};
use crate::integrator::{
    Discontinuities, EventFunctions, Events, Extent, Impulses, Jacobian, Linearizable, Ode, Reset, SeveralInstants,
    Tableau, Triggered,
};
use crate::math::Row;
use crate::scene::Scene;

/// An open mechanism with its constants and its inputs.
#[derive(Clone, Debug)]
pub struct Open<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> {
    pub(super) linkage: Linkage,
    scales: [f64; N],
    longest_step: f64,
    guard_scale: f64,
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize>
    Open<A, B, C, T, SPEED, N>
{
    pub(super) const ARRANGEMENT: Arrangement = Arrangement::new(Topology { a: A, b: B, c: C, t: T, speed: SPEED });
    /// Number of positions.
    pub(super) const P: usize = Self::ARRANGEMENT.positions;
    /// There are states beside positions and rates.
    const ROOMY: bool = N >= ROOM;

    /// Assembles the mechanism of a scene of this topology that starts at `time` [s].
    pub fn assemble(scene: &Scene, time: f64) -> Self {
        const { assert!(N == 2 * Self::P || Self::ROOMY) };
        let Arrangement { topology, layout, .. } = Self::ARRANGEMENT;
        let scale = scales::Scale::of(scene);
        let mut scales = [0.0; N];
        let (positions, rates) = scales[..2 * Self::P].split_at_mut(Self::P);
        positions.fill(scale.length);
        layout.set_angles(&scale.angle, positions);
        for (rate, position) in rates.iter_mut().zip(positions.iter()) {
            *rate = position * scale.frequency;
        }
        for (scale, (_, deflection)) in scales[2 * Self::P..].iter_mut().zip(bristled_contacts(scene)) {
            *scale = deflection;
        }
        Self {
            linkage: Linkage::new(scene, topology, time),
            scales,
            longest_step: scale.longest_step,
            guard_scale: scale.length,
        }
    }

    #[inline(always)]
    pub(super) fn pose(&self, t: f64, y: &[f64]) -> Pose {
        self.linkage.pose(Self::ARRANGEMENT, t, self.own(y))
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize>
    Open<A, B, C, T, SPEED, N>
{
    /// Of a list of states or rates as many as there are, known to the compiler where that is so.
    #[inline(always)]
    fn own<'y, V>(&self, y: &'y [V]) -> &'y [V] {
        if Self::ROOMY { y } else { &y[..N] }
    }

    #[inline(always)]
    fn own_mut<'y, V>(&self, y: &'y mut [V]) -> &'y mut [V] {
        if Self::ROOMY { y } else { &mut y[..N] }
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Ode
    for Open<A, B, C, T, SPEED, N>
{
    type Discrete = Contacts;

    fn extent(&self) -> Extent {
        let bristles = if Self::ROOMY { self.linkage.clearances.bristles.len() } else { 0 };
        let states = 2 * Self::P + bristles;
        Extent { positions: Self::P, weighed: states, states }
    }

    #[inline(always)] // into the loop over stages
    fn rates(&self, contacts: &Contacts, t: f64, y: &[f64], rates: &mut [f64]) {
        self.linkage.rates(Self::ARRANGEMENT, contacts, t, self.own(y), self.own_mut(rates));
    }

    fn stages(&self, tableau: &Tableau, contacts: &Contacts, t: f64, y: &[f64], h: f64, k: &mut [f64]) -> bool {
        of_so_many::<N>(tableau, t, y, h, k, |t, y, rates| self.rates(contacts, t, y, rates))
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> SeveralInstants
    for Open<A, B, C, T, SPEED, N>
{
    fn rates_in_row(&self, contacts: &Contacts, t: &Row, y: &[Row], rates: &mut [Row]) {
        self.linkage.rates(Self::ARRANGEMENT, contacts, *t, self.own(y), self.own_mut(rates));
    }

    fn suits_blocks(&self) -> bool {
        Self::ARRANGEMENT.topology.has_one_play_in_a_pin() && self.extent().is_second_order()
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Linearizable
    for Open<A, B, C, T, SPEED, N>
{
    fn jacobian(&self, contacts: &Contacts, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        let states = self.extent().states;
        differentiate::<N>(states, states, t, y, jacobian, &|t, y, rates| self.tangent_rates(contacts, t, y, rates));
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Events
    for Open<A, B, C, T, SPEED, N>
{
    fn event_count(&self) -> usize {
        self.linkage.clearances.guard_count(Self::ARRANGEMENT.clear)
    }

    #[inline]
    fn event_functions(&self, contacts: &Contacts, t: f64, y: &[f64], functions: &mut EventFunctions) {
        self.linkage.clearances.guards(Self::ARRANGEMENT.clear, contacts, &self.pose(t, y), functions);
    }

    fn rates_and_event_functions(
        &self,
        contacts: &Contacts,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        functions: &mut EventFunctions,
    ) {
        let (y, rates) = (self.own(y), self.own_mut(rates));
        let pose = self.pose(t, y);
        let loads = self.linkage.loads(Self::ARRANGEMENT, contacts, t, &y[2 * Self::P..], &pose);
        self.linkage.rates_under(Self::ARRANGEMENT, &pose, &loads, y, rates);
        self.linkage.clearances.guards(Self::ARRANGEMENT.clear, contacts, &pose, functions);
    }

    fn discontinuities(&self, contacts: &Contacts, t: f64, y: &[f64], functions: &mut Discontinuities) {
        self.linkage.clearances.kinks(Self::ARRANGEMENT.clear, contacts, &self.pose(t, y), functions);
    }

    fn event_scale(&self) -> f64 {
        self.guard_scale
    }

    fn reset(&self, contacts: &Contacts, t: f64, y: &mut [f64], triggered: &Triggered) -> Reset<Contacts> {
        let pose = self.pose(t, y);
        let bristles = if Self::ROOMY { &mut y[2 * Self::P..] } else { &mut [] };
        self.linkage.clearances.cross(Self::ARRANGEMENT.clear, contacts, &pose, triggered, bristles)
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Plant
    for Open<A, B, C, T, SPEED, N>
{
    fn write_start(&self, pose: &StartPose, y: &mut [f64]) {
        let Arrangement { topology, layout, .. } = Self::ARRANGEMENT;
        let turning = turning(pose.angle, pose.speed, !T);
        let place = roots(topology, &self.linkage.chains, &pose.place, Place(&turning));
        let velocity = roots(topology, &self.linkage.chains, &pose.velocity, Velocity(&turning));
        let (positions, rates) = y[..2 * Self::P].split_at_mut(Self::P);
        layout.set_roots(&place, positions);
        layout.set_angles(&pose.angle, positions);
        layout.set_roots(&velocity, rates);
        layout.set_angles(&pose.speed, rates);
    }

    fn start_contacts(&self, t: f64, y: &[f64]) -> Contacts {
        self.linkage.clearances.start(Self::ARRANGEMENT.clear, &self.pose(t, y))
    }

    fn set_signal(&mut self, signal: InputSignal) {
        self.linkage.signal = signal;
    }

    fn signal(&self) -> &InputSignal {
        &self.linkage.signal
    }

    fn start_time(&self) -> f64 {
        self.linkage.rotor.start_time
    }

    fn set_start_time(&mut self, time: f64) {
        self.linkage.rotor.start_time = time;
    }

    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64]) -> Instant {
        self.linkage.instant(Self::ARRANGEMENT, contacts, t, self.own(y))
    }

    fn rates_and_instant(&self, contacts: &Contacts, t: f64, y: &[f64], rates: &mut [f64]) -> Instant {
        self.linkage.rates_and_instant(Self::ARRANGEMENT, contacts, t, self.own(y), rates)
    }

    fn instant_under(&self, impulses: &Impulses, t: f64, y: &[f64]) -> Instant {
        let pose = self.pose(t, y);
        self.linkage.instant_under(Self::ARRANGEMENT, pose, self.loads_under(impulses, t, y, &pose))
    }

    fn rates_under(&self, impulses: &Impulses, t: f64, y: &[f64], rates: &mut [f64]) {
        let pose = self.pose(t, y);
        let loads = self.loads_under(impulses, t, y, &pose);
        self.linkage.rates_under(Self::ARRANGEMENT, &pose, &loads, y, rates);
    }

    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS] {
        self.linkage.clearances.depths(Self::ARRANGEMENT.clear, pose)
    }

    fn account(&self, contacts: &Contacts, pose: &Pose, y: &[f64]) -> Account {
        self.linkage.account(Self::ARRANGEMENT, contacts, pose, y)
    }

    fn tangent_rates(&self, contacts: &Contacts, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        self.linkage.tangent_rates(Self::ARRANGEMENT, contacts, t, y, rates);
    }

    fn tangent_instant(&self, contacts: &Contacts, t: Tangent, y: &[Tangent]) -> (Instant<Tangent>, Account<Tangent>) {
        let instant = self.linkage.tangent_instant(Self::ARRANGEMENT, contacts, t, y);
        let account = self.linkage.account(Self::ARRANGEMENT, contacts, &instant.pose, y);
        (instant, account)
    }
}
