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
use super::plant::Plant;
use super::scalar::Tangent;
use super::scales;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose, turning};
use crate::integrator::{Crossed, Extent, GUARDS, Guard, Impulses, Jacobian, Kinks, Problem, ROOM, Reset};
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
    pub(super) fn pose(&self, t: f64, y: &[f64; N]) -> Pose {
        self.linkage.pose(Self::ARRANGEMENT, t, y)
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Problem<N>
    for Open<A, B, C, T, SPEED, N>
{
    type Modes = Contacts;

    #[inline(always)] // into the loop over stages
    fn rates(&self, contacts: &Contacts, t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        self.linkage.rates(Self::ARRANGEMENT, contacts, t, y, rates);
    }

    fn rates_in_row(&self, contacts: &Contacts, t: &Row, y: &[Row; N], rates: &mut [Row; N]) {
        self.linkage.rates(Self::ARRANGEMENT, contacts, *t, y, rates);
    }

    fn suits_blocks(&self) -> bool {
        Self::ARRANGEMENT.topology.has_one_play_in_a_pin() && Extent::of(self).is_second_order()
    }

    fn jacobian(&self, contacts: &Contacts, t: f64, y: &[f64; N], jacobian: &mut Jacobian<N>) {
        let states = Extent::of(self).states;
        differentiate(states, states, t, y, jacobian, &|t, y, rates| self.tangent_rates(contacts, t, y, rates));
    }

    fn extent(&self) -> Extent {
        let states = 2 * Self::P + self.linkage.clearances.bristles.len();
        Extent { positions: Self::P, weighed: states, states }
    }

    fn scales(&self) -> &[f64; N] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }

    fn guard_count(&self) -> usize {
        self.linkage.clearances.guard_count(Self::ARRANGEMENT.clear)
    }

    #[inline]
    fn guards(&self, contacts: &Contacts, t: f64, y: &[f64; N], guards: &mut [Guard; GUARDS]) {
        self.linkage.clearances.guards(Self::ARRANGEMENT.clear, contacts, &self.pose(t, y), guards);
    }

    fn rates_and_guards(
        &self,
        contacts: &Contacts,
        t: f64,
        y: &[f64; N],
        rates: &mut [f64; N],
        guards: &mut [Guard; GUARDS],
    ) {
        let pose = self.pose(t, y);
        let loads = self.linkage.loads(Self::ARRANGEMENT, contacts, t, &y[2 * Self::P..], &pose);
        self.linkage.rates_under(Self::ARRANGEMENT, &pose, &loads, y, rates);
        self.linkage.clearances.guards(Self::ARRANGEMENT.clear, contacts, &pose, guards);
    }

    fn kinks(&self, contacts: &Contacts, t: f64, y: &[f64; N], kinks: &mut Kinks) {
        self.linkage.clearances.kinks(Self::ARRANGEMENT.clear, contacts, &self.pose(t, y), kinks);
    }

    fn guard_scale(&self) -> f64 {
        self.guard_scale
    }

    fn cross(&self, contacts: &Contacts, t: f64, y: &mut [f64; N], crossed: &Crossed) -> Reset<Contacts> {
        let pose = self.pose(t, y);
        let bristles = if Self::ROOMY { &mut y[2 * Self::P..] } else { &mut [] };
        self.linkage.clearances.cross(Self::ARRANGEMENT.clear, contacts, &pose, crossed, bristles)
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Plant<N>
    for Open<A, B, C, T, SPEED, N>
{
    fn start(&self, pose: &StartPose) -> [f64; N] {
        let Arrangement { topology, layout, .. } = Self::ARRANGEMENT;
        let turning = turning(pose.angle, pose.speed, !T);
        let place = roots(topology, &self.linkage.chains, &pose.place, Place(&turning));
        let velocity = roots(topology, &self.linkage.chains, &pose.velocity, Velocity(&turning));
        let mut y = [0.0; N];
        let (positions, rates) = y[..2 * Self::P].split_at_mut(Self::P);
        layout.set_roots(&place, positions);
        layout.set_angles(&pose.angle, positions);
        layout.set_roots(&velocity, rates);
        layout.set_angles(&pose.speed, rates);
        y
    }

    fn start_contacts(&self, t: f64, y: &[f64; N]) -> Contacts {
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

    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64; N]) -> Instant {
        self.linkage.instant(Self::ARRANGEMENT, contacts, t, y)
    }

    fn rates_and_instant(&self, contacts: &Contacts, t: f64, y: &[f64; N], rates: &mut [f64; N]) -> Instant {
        self.linkage.rates_and_instant(Self::ARRANGEMENT, contacts, t, y, rates)
    }

    fn instant_under(&self, impulses: &Impulses<N>, t: f64, y: &[f64; N]) -> Instant {
        let pose = self.pose(t, y);
        self.linkage.instant_under(Self::ARRANGEMENT, pose, self.loads_under(impulses, t, y, &pose))
    }

    fn rates_under(&self, impulses: &Impulses<N>, t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        let pose = self.pose(t, y);
        let loads = self.loads_under(impulses, t, y, &pose);
        self.linkage.rates_under(Self::ARRANGEMENT, &pose, &loads, y, rates);
    }

    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS] {
        self.linkage.clearances.depths(Self::ARRANGEMENT.clear, pose)
    }

    fn account(&self, contacts: &Contacts, pose: &Pose, y: &[f64; N]) -> Account {
        self.linkage.account(Self::ARRANGEMENT, contacts, pose, y)
    }

    fn tangent_rates(&self, contacts: &Contacts, t: Tangent, y: &[Tangent; N], rates: &mut [Tangent; N]) {
        self.linkage.tangent_rates(Self::ARRANGEMENT, contacts, t, y, rates);
    }

    fn tangent_instant(
        &self,
        contacts: &Contacts,
        t: Tangent,
        y: &[Tangent; N],
    ) -> (Instant<Tangent>, Account<Tangent>) {
        let instant = self.linkage.tangent_instant(Self::ARRANGEMENT, contacts, t, y);
        let account = self.linkage.account(Self::ARRANGEMENT, contacts, &instant.pose, y);
        (instant, account)
    }
}
