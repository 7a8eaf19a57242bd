//! A mechanism with a flexible rod, with any joints and either drive.
//!
//! Coordinates are those of the rigid mechanism, with joint centres as roots, and the rod's modal
//! coordinates after them. Which coordinates move which point is in the slopes of a
//! `configuration`; a mechanism's own modes and joints decide how many there are.

mod configuration;
mod equations;

use super::bristles::bristled_contacts;
use super::clearances::Clearances;
use super::contact::Account;
use super::coordinates::Layout;
use super::drive::{InputSignal, RotaryDamper, Rotor, add_viscous, rotary_dampers, viscous_guide};
use super::dynamics::Loads;
use super::ideal::IdealMechanism;
use super::mechanism::{Bodies, CRANK, ROD, SLIDER, Topology, bodies};
use super::plane::Vec2;
use super::plant::Plant;
use super::rod::{Inertia, Integrals, Rod, most_functions};
use super::scales::Scale;
use super::start::StartPose;
use super::state::{CONTACTS, Contacts, FlexibleInstant, Instant, Pose};
use crate::integrator::{Crossed, Extent, GUARDS, Guard, Problem, ROOM, Reset, Unilateral};
use crate::scene::Scene;
use configuration::{Configuration, Geometry};
use equations::{Equations, Moving, Places};

/// A mechanism with a flexible rod, in arrays with room for `N` states, `Q` = `N`/2 coordinates, `K`
/// modes and `F` functions of the rod.
#[derive(Clone, Debug)]
pub struct Flexible<const N: usize, const Q: usize, const K: usize, const F: usize> {
    geometry: Geometry,
    integrals: Integrals<K, F>,
    bodies: Bodies,
    gravity: f64,
    clear: [bool; 4],
    clearances: Clearances,
    rotary_dampers: Vec<RotaryDamper>,
    guide_damping: Option<f64>,
    signal: InputSignal,
    extent: Extent,
    scales: [f64; N],
    longest_step: f64,
    guard_scale: f64,
}

/// Number of states of the scene's mechanism with its rod.
pub fn state_count(scene: &Scene, rod: &Rod) -> usize {
    let topology = Topology::of(scene);
    let rigid = if topology.is_closed() { usize::from(!topology.speed) } else { topology.freedoms() };
    2 * (rigid + rod.modes()) + bristled_contacts(scene).len()
}

impl<const N: usize, const Q: usize, const K: usize, const F: usize> Flexible<N, Q, K, F> {
    /// Assembles the mechanism of a scene that starts at `time` [s], with its rod.
    pub fn assemble(scene: &Scene, time: f64, rod: Rod) -> Self {
        const { assert!(N >= ROOM && N == 2 * Q && F == most_functions(K)) };
        let topology = Topology::of(scene);
        let geometry = Geometry {
            topology,
            layout: Layout::new(topology),
            ideal: IdealMechanism::new(scene),
            rotor: Rotor::new(scene, time),
            rod,
        };
        let clearances = Clearances::new(scene);
        let (rigid, modes) = (geometry.rigid(), geometry.modes());
        let positions = modes.end;
        let states = 2 * positions + clearances.bristles.len();
        let scale = Scale::of(scene);
        let mut scales = [0.0; N];
        let (of_positions, of_rates) = scales[..2 * positions].split_at_mut(positions);
        of_positions[..rigid].fill(scale.length);
        geometry.layout.set_angles(&scale.angle, of_positions);
        for (rate, position) in of_rates.iter_mut().zip(of_positions.iter()) {
            *rate = position * scale.frequency;
        }
        for (k, &frequency) in modes.zip(&geometry.rod.frequency) {
            of_positions[k] = scale.deflection;
            of_rates[k] = scale.deflection * frequency.max(scale.frequency);
        }
        for (scale, (_, deflection)) in scales[2 * positions..].iter_mut().zip(bristled_contacts(scene)) {
            *scale = deflection;
        }
        let Topology { a, b, c, t, .. } = topology;
        let integrals = Integrals::new(&geometry.rod);
        Self {
            geometry,
            integrals,
            bodies: bodies(scene),
            gravity: scene.gravity,
            clear: [!a, !b, !c, !t],
            clearances,
            rotary_dampers: rotary_dampers(scene),
            guide_damping: Some(scene.joint.t.damping).filter(|&damping| damping != 0.0),
            signal: InputSignal::default(),
            extent: Extent { positions, weighed: states, states },
            scales,
            longest_step: scale.longest_step,
            guard_scale: scale.length,
        }
    }

    #[inline(always)]
    fn configuration(&self, t: f64, y: &[f64; N]) -> Configuration<K, F> {
        let p = self.extent.positions;
        self.geometry.configuration(t, &y[..p], &y[p..2 * p])
    }

    #[inline(always)]
    fn loads(&self, contacts: &Contacts, t: f64, y: &[f64; N], pose: &Pose) -> Loads {
        let inputs = self.signal.at(t);
        let slider_load = inputs.slider_load;
        let mut loads = Loads { pin: Vec2::new(slider_load, 0.0), slider_load, ..Loads::default() };
        if !self.geometry.topology.speed {
            loads.crank_couple = inputs.crank_torque;
        }
        self.clearances.add_loads(self.clear, contacts, pose, &y[2 * self.extent.positions..], &mut loads);
        add_viscous(&self.rotary_dampers, &pose.turning.speed, &pose.section_speed, &mut loads);
        if let Some(damping) = self.guide_damping {
            loads.add_guide(&viscous_guide(damping, pose.velocity.pin.x));
        }
        loads
    }

    #[inline(always)]
    fn inertia(&self, configuration: &Configuration<K, F>, y: &[f64; N]) -> Inertia<K> {
        let (modes, p) = (self.geometry.modes(), self.extent.positions);
        let (eta, rate) = (&y[modes.clone()], &y[p + modes.start..p + modes.end]);
        self.integrals.inertia(&configuration.shape, eta, rate, configuration.heading[ROD].speed)
    }

    fn moving<'a>(&'a self, configuration: &'a Configuration<K, F>, inertia: &'a Inertia<K>) -> Moving<'a, K, F> {
        Moving { rod: &self.geometry.rod, inertia, configuration, modes: self.geometry.modes() }
    }

    #[inline(always)]
    fn accelerations(&self, moving: &Moving<'_, K, F>, y: &[f64; N], loads: &Loads) -> [f64; Q] {
        let p = self.extent.positions;
        let modes = moving.modes.clone();
        let mut modal_force = [0.0; K];
        let (eta, rate) = (&y[modes.clone()], &y[p + modes.start..p + modes.end]);
        moving.rod.add_modal_forces(eta, rate, &loads.end_couple, &mut modal_force);
        let mut places = Places::new(modes.start);
        places.add_rigid_bodies(&self.bodies, moving.configuration, loads, self.gravity);
        Equations::new(places, moving, loads, self.gravity, &modal_force).solve()
    }
}

impl<const N: usize, const Q: usize, const K: usize, const F: usize> Problem<N> for Flexible<N, Q, K, F> {
    type Modes = Contacts;

    fn extent(&self) -> Extent {
        self.extent
    }

    fn rates(&self, contacts: &Contacts, t: f64, y: &[f64; N], rates: &mut [f64; N]) {
        let p = self.extent.positions;
        let configuration = self.configuration(t, y);
        let loads = self.loads(contacts, t, y, &configuration.pose());
        let inertia = self.inertia(&configuration, y);
        let forced = self.accelerations(&self.moving(&configuration, &inertia), y, &loads);
        rates[..p].copy_from_slice(&y[p..2 * p]);
        rates[p..2 * p].copy_from_slice(&forced[..p]);
        self.clearances.write_bristle_rates(&loads.bristle_rate, &mut rates[2 * p..]);
    }

    fn scales(&self) -> &[f64; N] {
        &self.scales
    }

    fn longest_step(&self) -> f64 {
        self.longest_step
    }

    fn guard_count(&self) -> usize {
        self.clearances.guard_count(self.clear)
    }

    fn guards(&self, contacts: &Contacts, t: f64, y: &[f64; N], guards: &mut [Guard; GUARDS]) {
        self.clearances.guards(self.clear, contacts, &self.configuration(t, y).pose(), guards);
    }

    fn guard_scale(&self) -> f64 {
        self.guard_scale
    }

    fn cross(&self, contacts: &Contacts, t: f64, y: &mut [f64; N], crossed: &Crossed) -> Reset<Contacts> {
        let pose = self.configuration(t, y).pose();
        let bristles = &mut y[2 * self.extent.positions..];
        self.clearances.cross(self.clear, contacts, &pose, crossed, bristles)
    }
}

impl<const N: usize, const Q: usize, const K: usize, const F: usize> Unilateral<N> for Flexible<N, Q, K, F> {}

impl<const N: usize, const Q: usize, const K: usize, const F: usize> Plant<N> for Flexible<N, Q, K, F> {
    fn start(&self, pose: &StartPose) -> [f64; N] {
        let layout = &self.geometry.layout;
        let p = self.extent.positions;
        let mut y = [0.0; N];
        let (positions, rates) = y[..2 * p].split_at_mut(p);
        if self.geometry.topology.is_closed() {
            if let (Some(angle), Some(speed)) = (layout.angle(CRANK), layout.angle(CRANK)) {
                (positions[angle], rates[speed]) = (pose.angle[CRANK], pose.speed[CRANK]);
            }
            return y;
        }
        for (centres, angles, list) in [(&pose.place, &pose.angle, positions), (&pose.velocity, &pose.speed, rates)] {
            let roots = super::kinematics::Roots { crank: centres.crank, rod: centres.big_end, slider: centres.pin };
            layout.set_roots(&roots, list);
            layout.set_angles(angles, list);
        }
        y
    }

    fn start_contacts(&self, t: f64, y: &[f64; N]) -> Contacts {
        self.clearances.start(self.clear, &self.configuration(t, y).pose())
    }

    fn set_signal(&mut self, signal: InputSignal) {
        self.signal = signal;
    }

    fn signal(&self) -> &InputSignal {
        &self.signal
    }

    fn start_time(&self) -> f64 {
        self.geometry.rotor.start_time
    }

    fn set_start_time(&mut self, time: f64) {
        self.geometry.rotor.start_time = time;
    }

    fn instant(&self, contacts: &Contacts, t: f64, y: &[f64; N]) -> Instant {
        let configuration = self.configuration(t, y);
        let pose = configuration.pose();
        let loads = self.loads(contacts, t, y, &pose);
        let inertia = self.inertia(&configuration, y);
        let moving = self.moving(&configuration, &inertia);
        let forced = self.accelerations(&moving, y, &loads);
        let places = self.geometry.accelerations(&configuration.shape, &forced);
        let p = self.extent.positions;
        let modes = moving.modes.clone();
        let (eta, rate) = (&y[modes.clone()], &y[p + modes.start..p + modes.end]);
        Instant {
            pose,
            acceleration: configuration.each(|centre| centre.acceleration(&places)),
            angle_acceleration: [CRANK, ROD, SLIDER].map(|k| configuration.heading[k].acceleration(&places)),
            loads,
            flexible: Some(FlexibleInstant {
                demand: moving.demand(&places, &forced, self.gravity),
                elastic: moving.rod.elastic(&configuration.shape, eta, rate),
                kinetic: moving.kinetic(rate),
                mass_height: moving.mass_height(),
            }),
        }
    }

    fn penetration(&self, pose: &Pose) -> [f64; CONTACTS] {
        self.clearances.depths(self.clear, pose)
    }

    fn account(&self, contacts: &Contacts, pose: &Pose, y: &[f64; N]) -> Account {
        self.clearances.account(self.clear, contacts, pose, &y[2 * self.extent.positions..])
    }
}
