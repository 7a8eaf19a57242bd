//! A mechanism with a flexible rod, with any joints and either drive.
//!
//! Coordinates are those of the rigid mechanism, with joint centres as roots, and the rod's modal
//! coordinates after them. Which coordinates move which point is in the slopes of a
//! `configuration`; a mechanism's own modes and joints decide how many there are. Those that the joints make
//! zero are known as such (`sparse`), and with up to eight modes the motion is compiled for each topology:
//! nothing is computed with them. With few modes the loop over a step's stages is compiled for each topology and number
//! of modes, with the whole of the motion in it (`written`).

mod alone;
mod assembly;
mod chain;
mod configuration;
mod equations;
mod motion;
mod solver;
mod sparse;
mod written;

use super::bristles::bristled_contacts;
use super::contact::Account;
use super::drive::InputSignal;
use super::ideal::IdealMechanism;
use super::jacobian::differentiate;
use super::plant::{Plant, ROOM};
use super::rod::{Rod, most_functions};
use super::scalar::Tangent;
use super::scales::Scale;
use super::stages::in_registers;
use super::start::StartPose;
use super::state::{CONTACTS, Contacts, Instant, Pose};
use super::structure::{CRANK, Topology};
use crate::integrator::{
    Discontinuities, EventFunctions, Events, Extent, Jacobian, Linearizable, Ode, Reset, SeveralInstants, Tableau,
    Triggered, Unilateral,
};
use crate::math::{Real, Row};
use crate::scene::Scene;
use assembly::Assembly;
use chain::{Frame, PLACES};
use written::Stages;

/// A mechanism with a flexible rod, in arrays with room for `N` states or of exactly `N`, with room for `S` equations to
/// solve together, `K` modes and `F` functions of the rod.
#[derive(Clone, Debug)]
pub struct Flexible<const N: usize, const S: usize, const K: usize, const F: usize> {
    all: Assembly<S, K, F>,
    stages: Option<Stages<Assembly<S, K, F>>>,
    suits_blocks: bool,
    scales: [f64; N],
    longest_step: f64,
    guard_scale: f64,
}

/// Most equations that have to be solved together with those of `modes` modes.
pub const fn most_equations(modes: usize) -> usize {
    PLACES - 1 + modes
}

/// Number of states of the scene's mechanism with its rod.
pub fn state_count(scene: &Scene, rod: &Rod) -> usize {
    2 * (Frame::new(Topology::of(scene)).structure.positions + rod.modes()) + bristled_contacts(scene).len()
}

impl<const N: usize, const S: usize, const K: usize, const F: usize> Flexible<N, S, K, F> {
    /// There is room for other states beside positions and rates.
    const ROOMY: bool = N >= ROOM;

    /// Assembles the mechanism of a scene that starts at `time` [s], with its rod.
    pub fn assemble(scene: &Scene, time: f64, rod: Rod) -> Self {
        const { assert!(S == most_equations(K) && F == most_functions(K)) };
        let all = Assembly::new(scene, time, rod);
        let extent = all.extent();
        let Extent { positions, states, .. } = extent;
        assert!(states <= N && (Self::ROOMY || states == N), "room for every state, or exactly as many");
        let (frame, rod) = (all.frame(), &all.geometry.rod);
        let (rigid, modal) = (frame.structure.positions, all.geometry.modes(frame));
        let scale = Scale::of(scene);
        let mut scales = [0.0; N];
        let (of_positions, of_rates) = scales[..2 * positions].split_at_mut(positions);
        of_positions[..rigid].fill(scale.length);
        frame.structure.set_angles(scale.angle, of_positions);
        for (rate, position) in of_rates.iter_mut().zip(of_positions.iter()) {
            *rate = position * scale.frequency;
        }
        for (k, &frequency) in modal.zip(&rod.frequency) {
            of_positions[k] = scale.deflection;
            of_rates[k] = scale.deflection * frequency.max(scale.frequency);
        }
        for (scale, (_, deflection)) in scales[2 * positions..].iter_mut().zip(bristled_contacts(scene)) {
            *scale = deflection;
        }
        let topology = frame.structure.topology;
        let stages = written::stages::<N, S, K, F>(topology, all.modes.counts);
        let (_, row) = written::rates::<S, K, F>(topology, all.modes.counts);
        let suits_blocks = topology.has_one_play_in_a_pin() && row.is_some() && extent.is_second_order();
        Self { all, stages, suits_blocks, scales, longest_step: scale.longest_step, guard_scale: scale.length }
    }
}

impl<const N: usize, const S: usize, const K: usize, const F: usize> Ode for Flexible<N, S, K, F> {
    type Discrete = Contacts;

    fn extent(&self) -> Extent {
        self.all.extent()
    }

    fn rates(&self, contacts: &Contacts, t: f64, y: &[f64], rates: &mut [f64]) {
        (self.all.functions.rates)(&self.all, contacts, t, y, rates);
    }

    fn stages(&self, tableau: &Tableau, contacts: &Contacts, t: f64, y: &[f64], h: f64, k: &mut [f64]) -> bool {
        match self.stages {
            Some(stages) => stages(&self.all, tableau, contacts, t, y, h, k),
            None => in_registers::<N>(tableau, t, y, h, k, |t, y, rates| self.rates(contacts, t, y, rates)),
        }
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }
}

impl<const N: usize, const S: usize, const K: usize, const F: usize> SeveralInstants for Flexible<N, S, K, F> {
    fn rates_in_row(&self, contacts: &Contacts, t: &Row, y: &[Row], rates: &mut [Row]) {
        let n = y.len();
        let (mut own, mut found) = ([Row::<1>::ZERO; N], [Row::<1>::ZERO; N]);
        for half in [0, 1] {
            for (own, all) in own.iter_mut().zip(y) {
                *own = all.half(half);
            }
            (self.all.functions.row)(&self.all, contacts, t.half(half), &own[..n], &mut found[..n]);
            for (rate, found) in rates.iter_mut().zip(&found) {
                rate.set_half(half, *found);
            }
        }
    }

    fn suits_blocks(&self) -> bool {
        self.suits_blocks
    }
}

impl<const N: usize, const S: usize, const K: usize, const F: usize> Linearizable for Flexible<N, S, K, F> {
    fn jacobian(&self, contacts: &Contacts, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        let Extent { states, .. } = self.all.extent();
        differentiate::<N>(states, states, t, y, jacobian, &|t, y, rates| self.tangent_rates(contacts, t, y, rates));
    }
}

impl<const N: usize, const S: usize, const K: usize, const F: usize> Events for Flexible<N, S, K, F> {
    fn event_count(&self) -> usize {
        if self.all.frame().structure.topology.is_closed() {
            1
        } else {
            self.all.clearances.guard_count(self.all.frame().structure.play)
        }
    }

    fn event_functions(&self, contacts: &Contacts, t: f64, y: &[f64], functions: &mut EventFunctions) {
        if self.all.frame().structure.topology.is_closed() {
            functions[0] = self.all.change_point(t, y);
        } else {
            self.all.clearances.guards(self.all.frame().structure.play, contacts, &self.all.pose(t, y), functions);
        }
    }

    fn rates_and_event_functions(
        &self,
        contacts: &Contacts,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        functions: &mut EventFunctions,
    ) {
        (self.all.functions.ends)(&self.all, contacts, t, y, rates, functions);
    }

    fn is_dead_end(&self, _: usize) -> bool {
        self.all.frame().structure.topology.is_closed()
    }

    fn discontinuities(&self, contacts: &Contacts, t: f64, y: &[f64], functions: &mut Discontinuities) {
        self.all.clearances.kinks(self.all.frame().structure.play, contacts, &self.all.pose(t, y), functions);
    }

    fn event_scale(&self) -> f64 {
        if self.all.frame().structure.topology.is_closed() {
            IdealMechanism::CHANGE_POINT_SCALE
        } else {
            self.guard_scale
        }
    }

    fn reset(&self, contacts: &Contacts, t: f64, y: &mut [f64], triggered: &Triggered) -> Reset<Contacts> {
        let pose = self.all.pose(t, y);
        let bristles = &mut y[2 * self.all.positions..];
        self.all.clearances.cross(self.all.frame().structure.play, contacts, &pose, triggered, bristles)
    }
}

impl<const N: usize, const S: usize, const K: usize, const F: usize> Unilateral for Flexible<N, S, K, F> {}

impl<const N: usize, const S: usize, const K: usize, const F: usize> Plant for Flexible<N, S, K, F> {
    fn write_start(&self, pose: &StartPose, y: &mut [f64]) {
        let structure = self.all.frame().structure;
        let p = self.all.positions;
        let (positions, rates) = y[..2 * p].split_at_mut(p);
        if self.all.frame().structure.topology.is_closed() {
            if let (Some(angle), Some(speed)) = (structure.angle(CRANK), structure.angle(CRANK)) {
                (positions[angle], rates[speed]) = (pose.angle[CRANK], pose.speed[CRANK]);
            }
            return;
        }
        for (centres, angles, list) in [(&pose.place, &pose.angle, positions), (&pose.velocity, &pose.speed, rates)] {
            let roots = super::kinematics::Roots { crank: centres.crank, rod: centres.big_end, slider: centres.pin };
            structure.set_roots(&roots, list);
            structure.set_angles(*angles, list);
        }
    }

    fn start_contacts(&self, t: f64, y: &[f64]) -> Contacts {
        self.all.clearances.start(self.all.frame().structure.play, &self.all.pose(t, y))
    }

    fn set_signal(&mut self, signal: InputSignal) {
        self.all.signal = signal;
    }

    fn signal(&self) -> &InputSignal {
        &self.all.signal
    }

    fn start_time(&self) -> f64 {
        self.all.geometry.rotor.start_time
    }

    fn set_start_time(&mut self, time: f64) {
        self.all.geometry.rotor.start_time = time;
    }

    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64]) -> Instant {
        self.rates_and_instant(contacts, t, y, &mut [0.0; N][..y.len()])
    }

    fn rates_and_instant(&self, contacts: &Contacts, t: f64, y: &[f64], rates: &mut [f64]) -> Instant {
        (self.all.functions.instant)(&self.all, contacts, t, y, rates)
    }

    fn penetration(&self, pose: &Pose) -> [f64; CONTACTS] {
        self.all.clearances.depths(self.all.frame().structure.play, pose)
    }

    fn account(&self, contacts: &Contacts, pose: &Pose, y: &[f64]) -> Account {
        self.all.clearances.account(self.all.frame().structure.play, contacts, pose, &y[2 * self.all.positions..])
    }

    fn tangent_rates(&self, contacts: &Contacts, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        self.all.tangent_motion(contacts, t, y, rates);
    }

    fn tangent_instant(&self, contacts: &Contacts, t: Tangent, y: &[Tangent]) -> (Instant<Tangent>, Account<Tangent>) {
        let mut rates = [Tangent::ZERO; N];
        let rates = &mut rates[..y.len()];
        let motion = self.all.tangent_motion(contacts, t, y, rates);
        let instant = self.all.instant_of(self.all.frame(), motion, y, rates);
        let bristles = &y[2 * self.all.positions..];
        let account = self.all.clearances.account(self.all.frame().structure.play, contacts, &instant.pose, bristles);
        (instant, account)
    }
}
