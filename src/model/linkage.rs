//! The equations of motion of an open mechanism with a rigid rod, for plain numbers and for numbers
//! with derivatives.
//!
//! What joints it has is told by an [`Arrangement`]. For plain numbers that is a constant wherever the
//! equations are called from, and what it leaves out is not compiled; with derivatives they are
//! compiled once, for all arrangements.

use super::clearances::Clearances;
use super::contact::Account;
use super::coordinates::Layout;
use super::drive::{InputSignal, RotaryDamper, Rotor, add_viscous, rotary_dampers, viscous_guide};
use super::dynamics::{Accelerations, Loads, accelerate};
use super::kinematics::{Acceleration, Place, Velocity, walk};
use super::mechanism::{Bodies, ChainInertia, ROD, Topology, bodies};
use super::plane::Vec2;
use super::scalar::{Scalar, Tangent};
use super::state::{Contacts, Instant, Pose, turning_at};
use crate::scene::Scene;

/// What joints a mechanism has, and where its coordinates stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrangement {
    /// Which joints are ideal and whether the crank's angle is prescribed.
    pub topology: Topology,
    /// Places of the coordinates.
    pub layout: Layout,
    /// Which of A, B, C and T have clearance.
    pub clear: [bool; 4],
    /// Number of positions.
    pub positions: usize,
}

impl Arrangement {
    /// Of a topology.
    pub const fn new(topology: Topology) -> Self {
        let Topology { a, b, c, t, .. } = topology;
        let (layout, positions) = (Layout::new(topology), topology.freedoms());
        Self { topology, layout, clear: [!a, !b, !c, !t], positions }
    }
}

/// The parts of an open mechanism, with its inputs.
#[derive(Clone, Debug)]
pub struct Linkage {
    /// Crank, rod and slider.
    pub bodies: Bodies,
    /// Inertia of what ideal joints leave connected.
    pub chains: ChainInertia,
    gravity: f64,
    height: f64,
    /// The prescribed rotation.
    pub rotor: Rotor,
    /// The joints with clearance.
    pub clearances: Clearances,
    rotary_dampers: Vec<RotaryDamper>,
    guide_damping: Option<f64>,
    /// Inputs in time.
    pub signal: InputSignal,
}

impl Linkage {
    /// Of a scene of this topology that starts at `time` [s].
    pub fn new(scene: &Scene, topology: Topology, time: f64) -> Self {
        let bodies = bodies(scene);
        Self {
            bodies,
            chains: ChainInertia::new(&bodies, topology),
            gravity: scene.gravity,
            height: scene.guide.offset - scene.slider.centre.y,
            rotor: Rotor::new(scene, time),
            clearances: Clearances::new(scene),
            rotary_dampers: rotary_dampers(scene),
            guide_damping: Some(scene.joint.t.damping).filter(|&damping| damping != 0.0),
            signal: InputSignal::default(),
        }
    }

    /// Angles, places and velocities of the state `y` at `t`.
    #[inline(always)]
    pub fn pose<R: Scalar>(&self, arrangement: Arrangement, t: R, y: &[R]) -> Pose<R> {
        let Arrangement { topology, layout, positions: p, .. } = arrangement;
        let (positions, rates) = y[..2 * p].split_at(p);
        let turning = turning_at(&layout, &self.rotor, t, positions, rates);
        let mut start = layout.roots(positions);
        if topology.t {
            start.slider.y = R::constant(self.height);
        }
        let place = walk(topology, &self.bodies, &self.chains, &start, Place(&turning));
        let moving = layout.roots(rates);
        let velocity = walk(topology, &self.bodies, &self.chains, &moving, Velocity(&turning));
        let section_speed = [turning.speed[ROD]; 2];
        Pose { turning, place, velocity, section_speed }
    }

    #[inline(always)]
    pub(super) fn loads<R: Scalar>(
        &self,
        arrangement: Arrangement,
        contacts: &Contacts,
        t: R,
        bristles: &[R],
        pose: &Pose<R>,
    ) -> Loads<R> {
        let inputs = self.signal.at(t);
        let slider_load = inputs.slider_load;
        let mut loads = Loads { pin: Vec2::new(slider_load, R::ZERO), slider_load, ..Loads::default() };
        if !arrangement.topology.speed {
            loads.crank_couple = inputs.crank_torque;
        }
        // Contact forces, which are known last, come last.
        add_viscous(&self.rotary_dampers, &pose.turning.speed, &pose.section_speed, &mut loads);
        if let Some(damping) = self.guide_damping {
            loads.add_guide(&viscous_guide(damping, pose.velocity.pin.x));
        }
        self.clearances.add_loads(arrangement.clear, contacts, pose, bristles, &mut loads);
        loads
    }

    #[inline(always)]
    fn accelerations<R: Scalar>(&self, topology: Topology, pose: &Pose<R>, loads: &Loads<R>) -> Accelerations<R> {
        let Self { bodies, chains, gravity, .. } = self;
        accelerate(topology, bodies, chains, *gravity, &pose.turning, loads)
    }

    /// Writes the rates of the state `y`: velocities, accelerations, and after them those of the
    /// bristles as far as `rates` has room.
    #[inline(always)]
    pub fn rates<R: Scalar>(&self, arrangement: Arrangement, contacts: &Contacts, t: R, y: &[R], rates: &mut [R]) {
        let (pose, loads) = self.pose_and_loads(arrangement, contacts, t, y);
        let accelerations = self.accelerations(arrangement.topology, &pose, &loads);
        self.write_rates(arrangement, &accelerations, &loads, y, rates);
    }

    /// Everything about one instant.
    #[inline(always)]
    pub fn instant<R: Scalar>(&self, arrangement: Arrangement, contacts: &Contacts, t: R, y: &[R]) -> Instant<R> {
        let (pose, loads) = self.pose_and_loads(arrangement, contacts, t, y);
        let accelerations = self.accelerations(arrangement.topology, &pose, &loads);
        self.instant_of(arrangement, &accelerations, pose, loads)
    }

    /// Both at once.
    #[inline(always)]
    pub fn rates_and_instant<R: Scalar>(
        &self,
        arrangement: Arrangement,
        contacts: &Contacts,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> Instant<R> {
        let (pose, loads) = self.pose_and_loads(arrangement, contacts, t, y);
        let accelerations = self.accelerations(arrangement.topology, &pose, &loads);
        self.write_rates(arrangement, &accelerations, &loads, y, rates);
        self.instant_of(arrangement, &accelerations, pose, loads)
    }

    /// Everything about an instant with this pose and these loads.
    #[inline(always)]
    pub fn instant_under(&self, arrangement: Arrangement, pose: Pose, loads: Loads) -> Instant {
        let accelerations = self.accelerations(arrangement.topology, &pose, &loads);
        self.instant_of(arrangement, &accelerations, pose, loads)
    }

    /// Writes the rates of the state `y` at this pose under these loads.
    #[inline(always)]
    pub fn rates_under(&self, arrangement: Arrangement, pose: &Pose, loads: &Loads, y: &[f64], rates: &mut [f64]) {
        let accelerations = self.accelerations(arrangement.topology, pose, loads);
        self.write_rates(arrangement, &accelerations, loads, y, rates);
    }

    #[inline(always)]
    fn pose_and_loads<R: Scalar>(
        &self,
        arrangement: Arrangement,
        contacts: &Contacts,
        t: R,
        y: &[R],
    ) -> (Pose<R>, Loads<R>) {
        let pose = self.pose(arrangement, t, y);
        let loads = self.loads(arrangement, contacts, t, &y[2 * arrangement.positions..], &pose);
        (pose, loads)
    }

    #[inline(always)]
    fn write_rates<R: Scalar>(
        &self,
        arrangement: Arrangement,
        accelerations: &Accelerations<R>,
        loads: &Loads<R>,
        y: &[R],
        rates: &mut [R],
    ) {
        let Arrangement { layout, positions: p, .. } = arrangement;
        let (velocities, rest) = rates.split_at_mut(p);
        let (forced, bristles) = rest.split_at_mut(p);
        velocities.copy_from_slice(&y[p..2 * p]);
        layout.set_roots(&accelerations.roots, forced);
        layout.set_angles(&accelerations.angle, forced);
        self.clearances.write_bristle_rates(&loads.bristle_rate, bristles);
    }

    #[inline(always)]
    fn instant_of<R: Scalar>(
        &self,
        arrangement: Arrangement,
        accelerations: &Accelerations<R>,
        pose: Pose<R>,
        loads: Loads<R>,
    ) -> Instant<R> {
        let Accelerations { roots, angle } = accelerations;
        let forced = Acceleration(&pose.turning, angle);
        let acceleration = walk(arrangement.topology, &self.bodies, &self.chains, roots, forced);
        Instant { pose, acceleration, angle_acceleration: *angle, loads, flexible: None }
    }

    /// Elastic energy of the closed contacts, and the powers that they take.
    pub fn account<R: Scalar>(
        &self,
        arrangement: Arrangement,
        contacts: &Contacts,
        pose: &Pose<R>,
        y: &[R],
    ) -> Account<R> {
        self.clearances.account(arrangement.clear, contacts, pose, &y[2 * arrangement.positions..])
    }

    /// [`Linkage::rates`] with derivatives, compiled once.
    #[inline(never)]
    pub fn tangent_rates(
        &self,
        arrangement: Arrangement,
        contacts: &Contacts,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) {
        self.rates(arrangement, contacts, t, y, rates);
    }

    /// [`Linkage::instant`] with derivatives, compiled once.
    #[inline(never)]
    pub fn tangent_instant(
        &self,
        arrangement: Arrangement,
        contacts: &Contacts,
        t: Tangent,
        y: &[Tangent],
    ) -> Instant<Tangent> {
        self.instant(arrangement, contacts, t, y)
    }
}
