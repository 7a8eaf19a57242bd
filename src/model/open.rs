//! An open mechanism: at least one joint has clearance.
//!
//! Which joints are ideal and which drive there is are constants of the type, so that each of the
//! thirty topologies is compiled on its own and holds no trace of the others.

use super::bristles::bristled_contacts;
use super::clearances::Clearances;
use super::contact::Account;
use super::coordinates::Layout;
use super::drive::{InputSignal, RotaryDamper, Rotor, add_viscous, rotary_dampers, viscous_guide};
use super::dynamics::{Accelerations, Loads, accelerate};
use super::joint::guide::CORNERS;
use super::kinematics::{Acceleration, Place, Velocity, roots, walk};
use super::mechanism::{Bodies, CRANK, ChainInertia, ROD, SLIDER, Topology, bodies};
use super::plane::Vec2;
use super::plant::Plant;
use super::scales;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose, turning};
use crate::integrator::{Crossed, Extent, GUARDS, Guard, Impulses, Problem, ROOM, Reset};
use crate::scene::Scene;

/// An open mechanism with its constants and its inputs.
#[derive(Clone, Debug)]
pub struct Open<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> {
    pub(super) bodies: Bodies,
    pub(super) chains: ChainInertia,
    gravity: f64,
    height: f64,
    rotor: Rotor,
    pub(super) clearances: Clearances,
    rotary_dampers: Vec<RotaryDamper>,
    guide_damping: Option<f64>,
    signal: InputSignal,
    scales: [f64; N],
    longest_step: f64,
    guard_scale: f64,
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize>
    Open<A, B, C, T, SPEED, N>
{
    pub(super) const TOPOLOGY: Topology = Topology { a: A, b: B, c: C, t: T, speed: SPEED };
    pub(super) const LAYOUT: Layout = Layout::new(Self::TOPOLOGY);
    pub(super) const CLEAR: [bool; 4] = [!A, !B, !C, !T];
    /// Number of positions.
    pub(super) const P: usize = Self::TOPOLOGY.freedoms();
    /// There are states beside positions and rates.
    const ROOMY: bool = N >= ROOM;

    /// Assembles the mechanism of a scene of this topology that starts at `time` [s].
    pub fn assemble(scene: &Scene, time: f64) -> Self {
        const { assert!(N == 2 * Self::P || Self::ROOMY) };
        let bodies = bodies(scene);
        let joint = &scene.joint;
        let scale = scales::Scale::of(scene);
        let mut scales = [0.0; N];
        let (positions, rates) = scales[..2 * Self::P].split_at_mut(Self::P);
        positions.fill(scale.length);
        Self::LAYOUT.set_angles(&scale.angle, positions);
        for (rate, position) in rates.iter_mut().zip(positions.iter()) {
            *rate = position * scale.frequency;
        }
        for (scale, (_, deflection)) in scales[2 * Self::P..].iter_mut().zip(bristled_contacts(scene)) {
            *scale = deflection;
        }
        Self {
            bodies,
            chains: ChainInertia::new(&bodies, Self::TOPOLOGY),
            gravity: scene.gravity,
            height: scene.guide.offset - scene.slider.centre.y,
            rotor: Rotor::new(scene, time),
            clearances: Clearances::new(scene),
            rotary_dampers: rotary_dampers(scene),
            guide_damping: Some(joint.t.damping).filter(|&damping| damping != 0.0),
            signal: InputSignal::default(),
            scales,
            longest_step: scale.longest_step,
            guard_scale: scale.length,
        }
    }

    #[inline(always)]
    pub(super) fn pose(&self, t: f64, y: &[f64; N]) -> Pose {
        let (positions, rates) = y[..2 * Self::P].split_at(Self::P);
        let mut angle = [0.0; 3];
        let mut speed = [0.0; 3];
        for k in [CRANK, ROD, SLIDER] {
            if let Some(place) = Self::LAYOUT.angle(k) {
                angle[k] = positions[place];
                speed[k] = rates[place];
            }
        }
        if SPEED {
            (angle[CRANK], speed[CRANK]) = (self.rotor.at(t), self.rotor.speed);
        }
        let turning = turning(angle, speed, !T);
        let mut start = Self::LAYOUT.roots(positions);
        if T {
            start.slider.y = self.height;
        }
        let place = walk(Self::TOPOLOGY, &self.bodies, &self.chains, &start, Place(&turning));
        let moving = Self::LAYOUT.roots(rates);
        let velocity = walk(Self::TOPOLOGY, &self.bodies, &self.chains, &moving, Velocity(&turning));
        let section_speed = [turning.speed[ROD]; 2];
        Pose { turning, place, velocity, section_speed }
    }

    #[inline(always)]
    pub(super) fn loads(&self, contacts: &Contacts, t: f64, y: &[f64; N], pose: &Pose) -> Loads {
        let inputs = self.signal.at(t);
        let slider_load = inputs.slider_load;
        let mut loads = Loads { pin: Vec2::new(slider_load, 0.0), slider_load, ..Loads::default() };
        if !SPEED {
            loads.crank_couple = inputs.crank_torque;
        }
        self.clearances.add_loads(Self::CLEAR, contacts, pose, self.extra(y), &mut loads);
        add_viscous(&self.rotary_dampers, &pose.turning.speed, &pose.section_speed, &mut loads);
        if let Some(damping) = self.guide_damping {
            loads.add_guide(&viscous_guide(damping, pose.velocity.pin.x));
        }
        loads
    }

    /// The states beside positions and rates.
    #[inline(always)]
    fn extra<'a>(&self, y: &'a [f64; N]) -> &'a [f64] {
        if Self::ROOMY { &y[2 * Self::P..] } else { &[] }
    }

    /// Writes velocities and accelerations.
    #[inline(always)]
    pub(super) fn write_rates(&self, y: &[f64; N], accelerations: &Accelerations, rates: &mut [f64; N]) {
        let (velocities, forced) = rates[..2 * Self::P].split_at_mut(Self::P);
        velocities.copy_from_slice(&y[Self::P..2 * Self::P]);
        Self::LAYOUT.set_roots(&accelerations.roots, forced);
        Self::LAYOUT.set_angles(&accelerations.angle, forced);
    }

    #[inline(always)]
    pub(super) fn accelerations(&self, pose: &Pose, loads: &Loads) -> Accelerations {
        let Self { bodies, chains, gravity, .. } = self;
        accelerate(Self::TOPOLOGY, bodies, chains, *gravity, &pose.turning, loads)
    }

    fn instant_of(&self, pose: Pose, loads: Loads) -> Instant {
        let Accelerations { roots, angle } = self.accelerations(&pose, &loads);
        let forced = Acceleration(&pose.turning, &angle);
        let acceleration = walk(Self::TOPOLOGY, &self.bodies, &self.chains, &roots, forced);
        Instant { pose, acceleration, angle_acceleration: angle, loads, flexible: None }
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Problem<N>
    for Open<A, B, C, T, SPEED, N>
{
    type Modes = Contacts;

    fn rates(&self, contacts: &Contacts, t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        let pose = self.pose(t, y);
        let loads = self.loads(contacts, t, y, &pose);
        self.write_rates(y, &self.accelerations(&pose, &loads), rates);
        if Self::ROOMY {
            self.clearances.write_bristle_rates(&loads.bristle_rate, &mut rates[2 * Self::P..]);
        }
    }

    fn extent(&self) -> Extent {
        let states = 2 * Self::P + self.clearances.bristles.len();
        Extent { positions: Self::P, weighed: states, states }
    }

    fn scales(&self) -> &[f64; N] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }

    fn guard_count(&self) -> usize {
        self.clearances.guard_count(Self::CLEAR)
    }

    #[inline]
    fn guards(&self, contacts: &Contacts, t: f64, y: &[f64; N], guards: &mut [Guard; GUARDS]) {
        self.clearances.guards(Self::CLEAR, contacts, &self.pose(t, y), guards);
    }

    fn guard_scale(&self) -> f64 {
        self.guard_scale
    }

    fn cross(&self, contacts: &Contacts, t: f64, y: &mut [f64; N], crossed: &Crossed) -> Reset<Contacts> {
        let pose = self.pose(t, y);
        let bristles = if Self::ROOMY { &mut y[2 * Self::P..] } else { &mut [] };
        self.clearances.cross(Self::CLEAR, contacts, &pose, crossed, bristles)
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Plant<N>
    for Open<A, B, C, T, SPEED, N>
{
    fn start(&self, pose: &StartPose) -> [f64; N] {
        let turning = turning(pose.angle, pose.speed, !T);
        let place = roots(Self::TOPOLOGY, &self.chains, &pose.place, Place(&turning));
        let velocity = roots(Self::TOPOLOGY, &self.chains, &pose.velocity, Velocity(&turning));
        let mut y = [0.0; N];
        let (positions, rates) = y[..2 * Self::P].split_at_mut(Self::P);
        Self::LAYOUT.set_roots(&place, positions);
        Self::LAYOUT.set_angles(&pose.angle, positions);
        Self::LAYOUT.set_roots(&velocity, rates);
        Self::LAYOUT.set_angles(&pose.speed, rates);
        y
    }

    fn start_contacts(&self, t: f64, y: &[f64; N]) -> Contacts {
        self.clearances.start(Self::CLEAR, &self.pose(t, y))
    }

    fn set_signal(&mut self, signal: InputSignal) {
        self.signal = signal;
    }

    fn signal(&self) -> &InputSignal {
        &self.signal
    }

    fn start_time(&self) -> f64 {
        self.rotor.start_time
    }

    fn set_start_time(&mut self, time: f64) {
        self.rotor.start_time = time;
    }

    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64; N]) -> Instant {
        let pose = self.pose(t, y);
        self.instant_of(pose, self.loads(contacts, t, y, &pose))
    }

    fn instant_under(&self, impulses: &Impulses<N>, t: f64, y: &[f64; N]) -> Instant {
        let pose = self.pose(t, y);
        self.instant_of(pose, self.loads_under(impulses, t, y, &pose))
    }

    fn rates_under(&self, impulses: &Impulses<N>, t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        let pose = self.pose(t, y);
        let loads = self.loads_under(impulses, t, y, &pose);
        self.write_rates(y, &self.accelerations(&pose, &loads), rates);
    }

    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS] {
        self.clearances.depths(Self::CLEAR, pose)
    }

    fn account(&self, contacts: &Contacts, pose: &Pose, y: &[f64; N]) -> Account {
        self.clearances.account(Self::CLEAR, contacts, pose, self.extra(y))
    }
}
