//! A mechanism with a rigid rod: its parts, its inputs, and its equations of motion.
//!
//! The equations are written once, for every [`Structure`] and every number: [`Mechanism::rates`]. They are compiled once for
//! each kind of number, with the structure as data, and again for some constant structures
//! ([`compiled`](super::compiled)). What else is asked about an instant is made from the same three steps: the pose,
//! outwards; the loads; the accelerations, by forces inwards.

use super::bodies::{AugmentedBodies, Bodies, bodies};
use super::clearances::Clearances;
use super::contact::Account;
use super::drive::{InputSignal, RotaryDamper, Rotor, add_viscous, rotary_dampers, viscous_guide};
use super::dynamics::{Accelerations, accelerate};
use super::ideal::{IdealMechanism, IdealMotion};
use super::kinematics::{Arms, Centres, Moving, Roots, Turning};
use super::loads::Loads;
use super::plane::Vec2;
use super::scalar::Scalar;
use super::start::StartPose;
use super::state::{Contacts, Instant, Pose, turning, turning_at};
use super::structure::{CRANK, Link, ROD, Structure, Topology};
use crate::integrator::EventFunctions;
use crate::math::{self, each};
use crate::scene::Scene;

/// A mechanism whose rod is rigid. Nothing but its inputs changes while time runs.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// What hangs on what.
    pub structure: Structure,
    pub(super) bodies: Bodies,
    pub(super) augmented: AugmentedBodies,
    pub(super) gravity: f64,
    /// Its lengths, and the height of an ideal guide.
    pub ideal: IdealMechanism,
    /// The prescribed rotation.
    pub rotor: Rotor,
    /// The joints with clearance.
    pub clearances: Clearances,
    rotary_dampers: Vec<RotaryDamper>,
    guide_damping: Option<f64>,
    /// Inputs in time.
    pub signal: InputSignal,
}

/// Where the mechanism is at one instant, as its loads and accelerations need it.
pub(super) struct Stance<R> {
    /// Angles, places and velocities.
    pub pose: Pose<R>,
    /// The bodies' arms.
    pub arms: Arms<Vec2<R>>,
    /// How the rod of a closed loop follows its crank; zero where the loop is open.
    pub closing: IdealMotion<R>,
}

impl Mechanism {
    /// Assembles the mechanism of a scene that starts at `time` [s].
    pub fn assemble(scene: &Scene, time: f64) -> Self {
        let structure = Structure::new(Topology::of(scene));
        let bodies = bodies(scene);
        Self {
            structure,
            bodies,
            augmented: AugmentedBodies::new(&bodies, &structure),
            gravity: scene.gravity,
            ideal: IdealMechanism::new(scene),
            rotor: Rotor::new(scene, time),
            clearances: Clearances::new(scene),
            rotary_dampers: rotary_dampers(scene),
            guide_damping: Some(scene.joint.t.damping).filter(|&damping| damping != 0.0),
            signal: InputSignal::default(),
        }
    }

    /// Writes the rates of the state `y` at `t`: velocities, accelerations, and those of bristles. `of` is the mechanism's
    /// structure, or the same as a constant.
    #[inline(always)]
    pub fn rates<R: Scalar>(&self, of: &Structure, contacts: &Contacts, t: R, y: &[R], rates: &mut [R]) {
        let stance = self.stance(of, t, y);
        let (moving, bristle_rates) = rates.split_at_mut(2 * of.positions);
        let loads = self.loads(of, contacts, t, y, &stance.pose, bristle_rates);
        write(of, &self.accelerations(of, &stance, &loads), y, moving);
    }

    /// The same, and the event functions at this instant.
    #[inline(always)]
    pub fn rates_and_guards(
        &self,
        of: &Structure,
        contacts: &Contacts,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        guards: &mut EventFunctions,
    ) {
        let stance = self.stance(of, t, y);
        let (moving, bristle_rates) = rates.split_at_mut(2 * of.positions);
        let loads = self.loads(of, contacts, t, y, &stance.pose, bristle_rates);
        write(of, &self.accelerations(of, &stance, &loads), y, moving);
        self.guards_at(of, contacts, &stance.pose, guards);
    }

    /// The same, and everything else about this instant.
    #[inline(always)]
    pub fn rates_and_instant<R: Scalar>(
        &self,
        of: &Structure,
        contacts: &Contacts,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> Instant<R> {
        let stance = self.stance(of, t, y);
        let (moving, bristle_rates) = rates.split_at_mut(2 * of.positions);
        let loads = self.loads(of, contacts, t, y, &stance.pose, bristle_rates);
        let accelerations = self.accelerations(of, &stance, &loads);
        write(of, &accelerations, y, moving);
        instant(of, stance, loads, &accelerations)
    }

    /// Poses, outwards.
    #[inline(always)]
    pub(super) fn stance<R: Scalar>(&self, of: &Structure, t: R, y: &[R]) -> Stance<R> {
        let (positions, rates) = y[..2 * of.positions].split_at(of.positions);
        let mut turning = turning_at(of, &self.rotor, t, positions, rates);
        let mut closing = IdealMotion::default();
        if of.closed {
            closing = self.ideal.motion(turning.rotation[CRANK], turning.speed[CRANK]);
            turning.rotation[ROD] = closing.rod;
            turning.speed[ROD] = closing.rod_ratio * turning.speed[CRANK];
        }
        let arms = Arms::at(of, &self.bodies, &self.augmented, &turning);
        let (mut roots, root_rates) = (of.roots(positions), of.roots(rates));
        if let Link::Rail(_) = of.slider {
            roots.slider.y = R::constant(self.ideal.height);
        }
        let roots = Roots {
            crank: Moving { place: roots.crank, velocity: root_rates.crank },
            rod: Moving { place: roots.rod, velocity: root_rates.rod },
            slider: Moving { place: roots.slider, velocity: root_rates.slider },
        };
        let mut centres = Centres::outwards(of, &roots, &arms.moving(turning.speed));
        if of.closed {
            let pin = Moving {
                place: Vec2::new(closing.x, R::constant(self.ideal.height)),
                velocity: Vec2::new(closing.x_ratio * turning.speed[CRANK], R::ZERO),
            };
            (centres.small_end, centres.pin) = (pin, pin);
        }
        let section_speed = [turning.speed[ROD]; 2];
        let pose = Pose { turning, place: centres.places(), velocity: centres.velocities(), section_speed };
        Stance { pose, arms, closing }
    }

    /// Loads from inputs, viscous friction and contacts; writes the rates of the contacts' bristles.
    #[inline(always)]
    pub(super) fn loads<R: Scalar>(
        &self,
        of: &Structure,
        contacts: &Contacts,
        t: R,
        y: &[R],
        pose: &Pose<R>,
        bristle_rates: &mut [R],
    ) -> Loads<R> {
        let inputs = self.signal.at(t);
        let slider_load = inputs.slider_load;
        let mut loads = Loads { pin: Vec2::new(slider_load, R::ZERO), slider_load, ..Loads::default() };
        if !of.topology.speed {
            loads.crank_couple = inputs.crank_torque;
        }
        // Contact forces, which are known last, come last.
        add_viscous(&self.rotary_dampers, &pose.turning.speed, &pose.section_speed, &mut loads);
        if let Some(damping) = self.guide_damping {
            loads.add_guide(&viscous_guide(damping, pose.velocity.pin.x));
        }
        let bristles = &y[2 * of.positions..];
        self.clearances.add_loads(of.play, contacts, pose, bristles, bristle_rates, &mut loads);
        loads
    }

    /// Forces, inwards, and what they accelerate.
    #[inline(always)]
    pub(super) fn accelerations<R: Scalar>(
        &self,
        of: &Structure,
        stance: &Stance<R>,
        loads: &Loads<R>,
    ) -> Accelerations<R> {
        let Stance { pose, arms, closing } = stance;
        accelerate(of, &self.augmented, self.gravity, &pose.turning, arms, closing, loads)
    }

    /// Writes the event functions at this pose.
    #[inline(always)]
    fn guards_at(&self, of: &Structure, contacts: &Contacts, pose: &Pose, guards: &mut EventFunctions) {
        if of.closed {
            if self.ideal.has_change_point() {
                let Turning { rotation, speed, .. } = &pose.turning;
                guards[0] = self.ideal.change_point(rotation[CRANK], speed[CRANK], self.ideal.rod, 0.0);
            }
        } else {
            self.clearances.guards(of.play, contacts, pose, guards);
        }
    }
}

/// Writes velocities and accelerations.
#[inline(always)]
pub(super) fn write<R: Scalar>(of: &Structure, accelerations: &Accelerations<R>, y: &[R], rates: &mut [R]) {
    let p = of.positions;
    let (velocities, forced) = rates.split_at_mut(p);
    let speeds = &y[p..2 * p];
    each!(const { R::PLAIN || R::MANY }, k < p, 9 => {
        velocities[k] = speeds[k];
    });
    of.set_roots(&accelerations.roots, forced);
    of.set_angles(accelerations.angle, forced);
}

/// Everything about an instant.
#[inline(always)]
pub(super) fn instant<R: Scalar>(
    of: &Structure,
    stance: Stance<R>,
    loads: Loads<R>,
    accelerations: &Accelerations<R>,
) -> Instant<R> {
    let Stance { mut pose, arms, closing } = stance;
    let Accelerations { roots, angle } = accelerations;
    let mut acceleration = Centres::outwards(of, roots, &arms.accelerated(pose.turning.speed, *angle));
    if of.closed {
        pose.turning.angle[ROD] = math::atan2(closing.rod.sin, closing.rod.cos);
        let pin = Vec2::new(closing.x_ratio.times_plus(angle[CRANK], closing.x_bias), R::ZERO);
        (acceleration.small_end, acceleration.pin) = (pin, pin);
    }
    Instant { pose, acceleration, angle_acceleration: *angle, loads, flexible: None }
}

impl Mechanism {
    /// How many event functions there are.
    pub fn guard_count(&self) -> usize {
        if self.structure.closed {
            usize::from(self.ideal.has_change_point())
        } else {
            self.clearances.guard_count(self.structure.play)
        }
    }

    /// Writes the event functions.
    pub fn guards(&self, contacts: &Contacts, t: f64, y: &[f64], guards: &mut EventFunctions) {
        self.guards_at(&self.structure, contacts, &self.pose(t, y), guards);
    }

    /// Angles, places and velocities.
    pub fn pose(&self, t: f64, y: &[f64]) -> Pose {
        self.place(t, y).pose
    }

    /// Elastic energy of the closed contacts, and the powers that they take.
    pub fn account<R: Scalar>(&self, contacts: &Contacts, pose: &Pose<R>, y: &[R]) -> Account<R> {
        let Structure { play, positions, .. } = self.structure;
        self.clearances.account(play, contacts, pose, &y[2 * positions..])
    }

    /// Number of states: positions, their rates, bristles.
    pub fn states(&self) -> usize {
        2 * self.structure.positions + self.clearances.bristles.len()
    }

    /// Writes the state of a start pose, whose bristles are straight.
    pub fn start(&self, pose: &StartPose, y: &mut [f64]) {
        let of = &self.structure;
        let turning = turning(pose.angle, pose.speed, of.slider_angle.is_some());
        let arms = Arms::at(of, &self.bodies, &self.augmented, &turning);
        let still = arms.moving(turning.speed);
        let velocities = Arms {
            throw: still.throw.velocity,
            reach: still.reach.velocity,
            crank: still.crank.velocity,
            rod: still.rod.velocity,
            slider: still.slider.velocity,
        };
        let (positions, rates) = y[..2 * of.positions].split_at_mut(of.positions);
        of.set_roots(&Roots::of(of, &pose.place, &arms), positions);
        of.set_angles(pose.angle, positions);
        of.set_roots(&Roots::of(of, &pose.velocity, &velocities), rates);
        of.set_angles(pose.speed, rates);
    }
}
