//! An open mechanism: at least one joint has clearance.
//!
//! Which joints are ideal and which drive there is are constants of the type, so that each of the
//! thirty topologies is compiled on its own and holds no trace of the others.

use super::contact::ContactMode;
use super::coordinates::Layout;
use super::drive::{InputSignal, RotaryDamper, Rotor, rotary_dampers, viscous_couples, viscous_guide};
use super::dynamics::{Accelerations, Loads, accelerate};
use super::joint::guide::{CORNERS, Guide};
use super::joint::revolute::Revolute;
use super::kinematics::{Acceleration, Place, Velocity, roots, walk};
use super::mechanism::{Bodies, CRANK, ChainInertia, ROD, SLIDER, Topology, bodies};
use super::plane::Vec2;
use super::plant::Plant;
use super::scales;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose, turning};
use crate::integrator::{Crossed, GUARDS, Guard, Problem, Reset};
use crate::scene::Scene;

/// Share of a contact's duration for the first step into it.
const FIRST_SHARE: f64 = 0.03;

/// An open mechanism with its constants and its inputs.
#[derive(Clone, Debug)]
pub struct Open<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> {
    bodies: Bodies,
    chains: ChainInertia,
    gravity: f64,
    height: f64,
    rotor: Rotor,
    revolute: [Revolute; 3],
    guide: Guide,
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
    const TOPOLOGY: Topology = Topology { a: A, b: B, c: C, t: T, speed: SPEED };
    const LAYOUT: Layout = Layout::new(Self::TOPOLOGY);
    const CLEAR: [bool; 3] = [!A, !B, !C];

    /// Assembles the mechanism of a scene of this topology that starts at `time` [s].
    pub fn assemble(scene: &Scene, time: f64) -> Self {
        const { assert!(N == 2 * Self::TOPOLOGY.freedoms()) };
        let bodies = bodies(scene);
        let joint = &scene.joint;
        let scale = scales::Scale::of(scene);
        let mut scales = [0.0; N];
        let (positions, rates) = scales.split_at_mut(N / 2);
        positions.fill(scale.length);
        Self::LAYOUT.set_angles(&scale.angle, positions);
        for (rate, position) in rates.iter_mut().zip(positions.iter()) {
            *rate = position * scale.frequency;
        }
        Self {
            bodies,
            chains: ChainInertia::new(&bodies, Self::TOPOLOGY),
            gravity: scene.gravity,
            height: scene.guide.offset - scene.slider.centre.y,
            rotor: Rotor::new(scene, time),
            revolute: [&joint.a, &joint.b, &joint.c].map(Revolute::new),
            guide: Guide::new(scene),
            rotary_dampers: rotary_dampers(scene),
            guide_damping: Some(joint.t.damping).filter(|&damping| damping != 0.0),
            signal: InputSignal::default(),
            scales,
            longest_step: scale.longest_step,
            guard_scale: scale.length,
        }
    }

    #[inline(always)]
    fn pose(&self, t: f64, y: &[f64; N]) -> Pose {
        let (positions, rates) = y.split_at(N / 2);
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
        Pose { turning, place, velocity }
    }

    #[inline(always)]
    fn loads(&self, contacts: &Contacts, t: f64, pose: &Pose) -> Loads {
        let inputs = self.signal.at(t);
        let slider_load = inputs.slider_load;
        let mut loads = Loads { pin: Vec2::new(slider_load, 0.0), slider_load, ..Loads::default() };
        if !SPEED {
            loads.couple[CRANK] = inputs.crank_torque;
        }
        for (joint, revolute) in self.revolute.iter().enumerate() {
            if Self::CLEAR[joint] && contacts[joint].closed {
                loads.add_contact(joint, &revolute.load(&contacts[joint], &pose.play(joint)));
            }
        }
        if !T {
            loads.add_guide(&self.guide.load(&contacts[3..], &pose.slider()));
        }
        if !self.rotary_dampers.is_empty() {
            let couples = viscous_couples(&self.rotary_dampers, &pose.turning.speed);
            for (couple, viscous) in loads.couple.iter_mut().zip(couples) {
                *couple += viscous;
            }
        }
        if let Some(damping) = self.guide_damping {
            loads.add_guide(&viscous_guide(damping, pose.velocity.pin.x));
        }
        loads
    }

    #[inline(always)]
    fn accelerations(&self, pose: &Pose, loads: &Loads) -> Accelerations {
        let Self { bodies, chains, gravity, .. } = self;
        accelerate(Self::TOPOLOGY, bodies, chains, *gravity, &pose.turning, loads)
    }

    /// Penetration and approach speed of every contact; far open for a joint without clearance.
    #[inline(always)]
    fn penetrations(&self, pose: &Pose) -> [(f64, f64); 3 + CORNERS] {
        let mut all = [(f64::NEG_INFINITY, 0.0); 3 + CORNERS];
        for (joint, revolute) in self.revolute.iter().enumerate() {
            if Self::CLEAR[joint] {
                let play = pose.play(joint);
                all[joint] = (revolute.penetration(&play), revolute.penetration_rate(&play));
            }
        }
        if !T {
            all[3..].copy_from_slice(&self.guide.approaches(&pose.slider()));
        }
        all
    }

    fn contact(&self, index: usize) -> &super::contact::ContactParameters {
        if index < 3 { &self.revolute[index].contact } else { &self.guide.contact }
    }

    /// [kg] The lighter of the bodies that meet in a contact.
    fn lighter_mass(&self, index: usize) -> f64 {
        let mass = self.bodies.map(|body| body.mass);
        match index {
            0 => mass[CRANK],
            1 => mass[CRANK].min(mass[ROD]),
            2 => mass[ROD].min(mass[SLIDER]),
            _ => mass[SLIDER],
        }
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Problem<N>
    for Open<A, B, C, T, SPEED, N>
{
    type Modes = Contacts;

    fn rates(&self, contacts: &Contacts, t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        let pose = self.pose(t, y);
        let loads = self.loads(contacts, t, &pose);
        let accelerations = self.accelerations(&pose, &loads);
        let (velocities, forced) = rates.split_at_mut(N / 2);
        velocities.copy_from_slice(&y[N / 2..]);
        Self::LAYOUT.set_roots(&accelerations.roots, forced);
        Self::LAYOUT.set_angles(&accelerations.angle, forced);
    }

    fn scales(&self) -> &[f64; N] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }

    fn guard_count(&self) -> usize {
        if T { 3 } else { 3 + CORNERS }
    }

    #[inline]
    fn guards(&self, contacts: &Contacts, t: f64, y: &[f64; N], guards: &mut [Guard; GUARDS]) {
        let pose = self.pose(t, y);
        for joint in 0..3 {
            guards[joint] = if Self::CLEAR[joint] {
                self.revolute[joint].guard(&contacts[joint], &pose.play(joint))
            } else {
                Guard { value: 1.0, rate: 0.0 }
            };
        }
        if !T {
            guards[3..3 + CORNERS].copy_from_slice(&self.guide.guards(&contacts[3..], &pose.slider()));
        }
    }

    fn guard_scale(&self) -> f64 {
        self.guard_scale
    }

    fn cross(&self, contacts: &Contacts, t: f64, y: &[f64; N], crossed: &Crossed) -> Reset<Contacts> {
        let penetrations = self.penetrations(&self.pose(t, y));
        let mut reset = Reset { modes: *contacts, step: None };
        let crossed = self.guide.contacts_of(crossed);
        for (index, mode) in reset.modes.iter_mut().enumerate().filter(|(i, _)| crossed[*i]) {
            if mode.closed {
                *mode = ContactMode::default();
                continue;
            }
            let contact = self.contact(index);
            *mode = ContactMode::closing(penetrations[index].1, contact.speed_floor);
            let time = contact.contact_time(self.lighter_mass(index), mode.approach);
            let step = FIRST_SHARE * time;
            reset.step = Some(reset.step.map_or(step, |shorter: f64| shorter.min(step)));
        }
        reset
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
        let (positions, rates) = y.split_at_mut(N / 2);
        Self::LAYOUT.set_roots(&place, positions);
        Self::LAYOUT.set_angles(&pose.angle, positions);
        Self::LAYOUT.set_roots(&velocity, rates);
        Self::LAYOUT.set_angles(&pose.speed, rates);
        y
    }

    fn start_contacts(&self, t: f64, y: &[f64; N]) -> Contacts {
        let penetrations = self.penetrations(&self.pose(t, y));
        let mut contacts = Contacts::default();
        for (index, (mode, (depth, rate))) in contacts.iter_mut().zip(penetrations).enumerate() {
            if depth > 0.0 {
                *mode = ContactMode::closing(rate, self.contact(index).speed_floor);
            }
        }
        contacts
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
        let loads = self.loads(contacts, t, &pose);
        let Accelerations { roots, angle } = self.accelerations(&pose, &loads);
        let forced = Acceleration(&pose.turning, &angle);
        let acceleration = walk(Self::TOPOLOGY, &self.bodies, &self.chains, &roots, forced);
        Instant { pose, acceleration, angle_acceleration: angle, loads }
    }

    fn penetration(&self, pose: &Pose) -> [f64; 3 + CORNERS] {
        let mut depths = self.penetrations(pose).map(|(depth, _)| depth);
        if !T {
            depths[3..].copy_from_slice(&self.guide.penetrations(&pose.slider()));
        }
        depths
    }
}
