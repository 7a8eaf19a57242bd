//! A mechanism: its parts and its equations of motion.
//!
//! The equations are coded once, for any [`Structure`] and any number type: [`Mechanism::rates`] with a rigid rod and
//! `flexible_rates` with a flexible one, which differ in the rod's inertia and in the solution. They are compiled once
//! for each number type, with the structure as data, and again for some constant structures
//! ([`compiled`](super::compiled)). All evaluations of an instant consist of three steps: the pose, outwards; the
//! loads; the accelerations, with forces accumulated inwards.

use super::bodies::{AugmentedBodies, RodInChain, bodies};
use super::clearances::Clearances;
use super::contact::ContactEnergy;
use super::drive::{RotaryDamper, Rotor, add_viscous, rotary_dampers, viscous_guide};
use super::dynamics::{Accelerations, accelerate};
use super::gravity::free_fall;
use super::ideal::{IdealMechanism, IdealMotion};
use super::inertial_load::InertialLoad;
use super::kinematics::{Arms, BodyRotations, JointPoints, PointMotion};
use super::loads::Loads;
use super::modal::BentRod;
use super::part::part;
use super::plane::{Vec2, cross, perp};
use super::rod::{Arrays, Chord, CompiledCounts, Inertia, Modes, Rod, Shape};
use super::scalar::Scalar;
use super::start::StartPose;
use super::state::{CONTACTS, Conditions, Contacts, Evaluation, FlexibleEvaluation, Pose, rotations, rotations_at};
use super::structure::{CRANK, Link, ROD, Roots, SLIDER, Structure, Topology};
use crate::integrator::EventFunctions;
use crate::math::{self, unroll};
use crate::scene::Scene;

/// A mechanism. It is immutable while time advances.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// Topology and coordinates.
    pub structure: Structure,
    pub(super) augmented: AugmentedBodies,
    pub(super) gravity: Vec2,
    /// Lengths, and the height of an ideal guide.
    pub ideal: IdealMechanism,
    /// The prescribed crank rotation.
    pub rotor: Rotor,
    /// The flexible rod; `None` if the rod is rigid.
    pub rod: Option<FlexibleRod>,
    /// The joints with clearance.
    pub clearances: Clearances,
    rotary_dampers: Vec<RotaryDamper>,
    guide_damping: Option<f64>,
    /// [m] Distance of the slider load from the pin, across the guide.
    load_offset: f64,
}

/// A flexible rod in its mechanism.
#[derive(Clone, Debug)]
pub struct FlexibleRod {
    /// Modes of the rod as the scene gives them.
    pub rod: Rod,
    /// The same modes in the arrays that the equations read.
    pub modes: Modes,
    /// These modes and as many more, which stand still, as code for known numbers of modes has; `None` if there is no such
    /// code.
    pub known: Option<Modes>,
    /// Position of the rod in its chain.
    pub chain: RodInChain,
}

/// The kinematic configuration at one instant, from which loads and accelerations are computed.
pub(super) struct Configuration<R> {
    /// Angles, places and velocities.
    pub pose: Pose<R>,
    /// Arms of the bodies in inertial axes.
    pub arms: Arms<Vec2<R>>,
    /// Motion of the rod with the crank in a closed loop; zero in an open chain.
    pub closing: IdealMotion<R>,
}

/// A mechanism with a flexible rod at one instant, in arrays of `K` modes; the rod's [`Inertia`] is separate.
pub(super) struct FlexibleMotion<R, const K: usize> {
    configuration: Configuration<R>,
    chord: Chord<R>,
    /// ∂L/∂η.
    chord_slope: [R; K],
    loads: Loads<R>,
    accelerations: Accelerations<R>,
}

impl Mechanism {
    /// Assembles the mechanism of a scene.
    pub fn assemble(scene: &Scene) -> Self {
        let (topology, rod) = (Topology::of(scene), Rod::new(scene));
        let (clearances, gravity) = (Clearances::new(scene), free_fall(scene));
        let load_offset = scene.slider.load_offset;
        let rare_loads = !clearances.films.is_empty() || load_offset != 0.0;
        let structure = Structure { rare_loads, ..Structure::with_rod(topology, rod.is_some()) };
        let bodies = bodies(scene);
        Self {
            structure,
            augmented: AugmentedBodies::new(&bodies, &structure),
            gravity,
            ideal: IdealMechanism::new(scene),
            rotor: Rotor::new(scene),
            rod: rod.map(|rod| FlexibleRod {
                modes: Modes::new(&rod),
                known: Modes::known(&rod),
                chain: RodInChain::new(&bodies, &structure),
                rod,
            }),
            clearances,
            rotary_dampers: rotary_dampers(scene),
            guide_damping: Some(scene.joint.t.damping).filter(|&damping| damping != 0.0),
            load_offset,
        }
    }

    /// Writes the rates of the state `y` at `t` for a rigid rod: velocities, accelerations and bristle rates. `of` is
    /// the mechanism's structure, or an equal constant.
    #[inline(always)]
    pub fn rates<R: Scalar>(&self, of: &Structure, conditions: &Conditions, t: R, y: &[R], rates: &mut [R]) {
        self.motion(of, conditions, t, y, rates);
    }

    /// As [`rates`](Self::rates), and writes the event functions.
    #[inline(always)]
    pub fn rates_and_event_functions(
        &self,
        of: &Structure,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        event_functions: &mut EventFunctions,
    ) {
        let (configuration, ..) = self.motion(of, conditions, t, y, rates);
        self.event_functions_at(of, &conditions.contacts, &configuration.pose, [self.ideal.rod, 0.0], event_functions);
    }

    /// As [`rates`](Self::rates), and returns the evaluation of the instant.
    #[inline(always)]
    pub fn rates_and_evaluation<R: Scalar>(
        &self,
        of: &Structure,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> Evaluation<R> {
        let (configuration, loads, accelerations) = self.motion(of, conditions, t, y, rates);
        evaluation(of, configuration, loads, &accelerations)
    }

    /// Writes the rates and returns the configuration, loads and accelerations.
    #[inline(always)]
    pub(super) fn motion<R: Scalar>(
        &self,
        of: &Structure,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> (Configuration<R>, Loads<R>, Accelerations<R>) {
        let configuration = self.configuration(of, t, y);
        let (moving, bristle_rates) = rates.split_at_mut(2 * of.positions);
        let loads = self.loads(of, conditions, t, &y[2 * of.positions..], &configuration.pose, bristle_rates);
        let accelerations = self.accelerations(of, &configuration, &loads);
        write(of, &accelerations, y, moving);
        (configuration, loads, accelerations)
    }

    /// Writes the rates of the state `y` at `t` for a flexible rod, in arrays of `K` modes and `F` functions along the
    /// rod, with counts `C` that may be known at compile time. Writes the rod's inertia into `inertia`, which must be
    /// zero, and the kinetic energy of its modes [J] into `modal_energy`, and returns the motion.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "inlined")]
    pub(super) fn flexible_rates<R: Scalar, C: CompiledCounts, const K: usize, const F: usize>(
        &self,
        of: &Structure,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
        inertia: &mut Inertia<R, K>,
        modal_energy: Option<&mut R>,
    ) -> FlexibleMotion<R, K> {
        let known = if const { C::KNOWN } { rod.known.as_ref() } else { None };
        let modes: Arrays<'_, K, F> = known.unwrap_or(&rod.modes).arrays();
        let rigid = of.positions;
        let p = rigid + C::COUNTS.unwrap_or(modes.counts).modes();
        let (positions, speeds) = (&y[..p], &y[p..2 * p]);
        let (eta, rate) = (&positions[rigid..], &speeds[rigid..]);
        let shape = part!(R, C, modes.shape::<R, C>(eta, rate));
        let Shape { chord, chord_slope, slope_rate, .. } = shape;
        let shared = const { !(R::PLAIN || C::KNOWN) };
        let configuration = if shared {
            self.flexible_configuration_apart(of, t, positions, speeds, &chord, slope_rate)
        } else {
            self.flexible_configuration(of, t, positions, speeds, &chord, slope_rate)
        };
        let (moving, bristle_rates) = rates.split_at_mut(2 * p);
        let (velocities, forced) = moving.split_at_mut(p);
        let Configuration { pose, arms, closing } = &configuration;
        let bristles = &y[2 * p..];
        let loads = if shared {
            self.loads_apart(of, conditions, t, bristles, pose, bristle_rates)
        } else {
            self.loads(of, conditions, t, bristles, pose, bristle_rates)
        };
        let speed = pose.rotations.speed[ROD];
        part!(R, C, modes.inertia::<R, C>(&shape, eta, rate, speed, inertia));
        if let Some(energy) = modal_energy {
            *energy = inertia.modal_energy(rate);
        }
        let mut bent = BentRod { modes, chain: rod.chain, shape: &shape, inertia, eta, rate };
        let (bodies, gravity, modal) = (&self.augmented, self.gravity, &mut forced[rigid..]);
        let accelerations =
            part!(R, C, bent.accelerate::<C>(of, bodies, gravity, &pose.rotations, arms, closing, &loads, modal));
        velocities.copy_from_slice(speeds);
        of.set_roots(&accelerations.roots, forced);
        of.set_angles(accelerations.angle, forced);
        FlexibleMotion { configuration, chord, chord_slope, loads, accelerations }
    }

    /// The configuration with a rigid rod, computed outwards.
    #[inline(always)]
    pub(super) fn configuration<R: Scalar>(&self, of: &Structure, t: R, y: &[R]) -> Configuration<R> {
        let (positions, rates) = y[..2 * of.positions].split_at(of.positions);
        let mut rotations = rotations_at(of, &self.rotor, t, positions, rates);
        let mut closing = IdealMotion::default();
        if of.closed {
            closing = self.ideal.motion(rotations.rotation[CRANK], rotations.speed[CRANK]);
            rotations.rotation[ROD] = closing.rod;
            rotations.speed[ROD] = closing.rod_ratio * rotations.speed[CRANK];
        }
        let arms = Arms::at(of, self.ideal.crank, self.ideal.rod, &self.augmented, &rotations);
        let mut centres = self.centres(of, positions, rates, &arms.moving(rotations.speed));
        if of.closed {
            let pin = PointMotion {
                place: Vec2::new(closing.x, R::constant(self.ideal.height)),
                velocity: Vec2::new(closing.x_ratio * rotations.speed[CRANK], R::ZERO),
            };
            (centres.small_end, centres.pin) = (pin, pin);
        }
        let section_speed = [rotations.speed[ROD]; 2];
        let pose = Pose { rotations, place: centres.places(), velocity: centres.velocities(), section_speed };
        Configuration { pose, arms, closing }
    }

    /// The configuration with a flexible rod, at `positions` and their `rates`: with its chord and the rates of the slopes
    /// at both ends.
    #[inline(always)]
    fn flexible_configuration<R: Scalar>(
        &self,
        of: &Structure,
        t: R,
        positions: &[R],
        rates: &[R],
        chord: &Chord<R>,
        [big_end, small_end]: [R; 2],
    ) -> Configuration<R> {
        let mut rotations = rotations_at(of, &self.rotor, t, positions, rates);
        let mut closing = IdealMotion::default();
        if of.closed {
            closing = self.ideal.flexible_motion(rotations.rotation[CRANK], rotations.speed[CRANK], chord);
            rotations.rotation[ROD] = closing.rod;
            rotations.speed[ROD] = closing.rod_ratio * rotations.speed[CRANK] + closing.rod_per_length * chord.rate;
        }
        let arms = Arms::at(of, self.ideal.crank, chord.length, &self.augmented, &rotations);
        let mut moving = arms.moving(rotations.speed);
        moving.reach.velocity += rotations.rotation[ROD].axis(chord.rate);
        let centres = self.centres(of, positions, rates, &moving);
        let speed = rotations.speed[ROD];
        let section_speed = [speed + big_end, speed + small_end];
        let pose = Pose { rotations, place: centres.places(), velocity: centres.velocities(), section_speed };
        Configuration { pose, arms, closing }
    }

    /// As [`flexible_configuration`](Self::flexible_configuration), compiled once for all array sizes of a rod.
    #[inline(never)]
    fn flexible_configuration_apart<R: Scalar>(
        &self,
        of: &Structure,
        t: R,
        positions: &[R],
        rates: &[R],
        chord: &Chord<R>,
        slope_rate: [R; 2],
    ) -> Configuration<R> {
        self.flexible_configuration(of, t, positions, rates, chord, slope_rate)
    }

    /// Places and velocities of the joint centres.
    #[inline(always)]
    fn centres<R: Scalar>(
        &self,
        of: &Structure,
        positions: &[R],
        rates: &[R],
        arms: &Arms<PointMotion<R>>,
    ) -> JointPoints<PointMotion<R>> {
        let (mut roots, root_rates) = (of.roots(positions), of.roots(rates));
        if let Link::Rail(_) = of.slider {
            roots.slider.y = R::constant(self.ideal.height);
        }
        let roots = Roots {
            crank: PointMotion { place: roots.crank, velocity: root_rates.crank },
            rod: PointMotion { place: roots.rod, velocity: root_rates.rod },
            slider: PointMotion { place: roots.slider, velocity: root_rates.slider },
        };
        JointPoints::outwards(of, &roots, arms)
    }

    /// Loads from inputs, viscous friction and contacts; writes the rates of the contacts' `bristles`.
    #[inline(always)]
    pub(super) fn loads<R: Scalar>(
        &self,
        of: &Structure,
        conditions: &Conditions,
        t: R,
        bristles: &[R],
        pose: &Pose<R>,
        bristle_rates: &mut [R],
    ) -> Loads<R> {
        let inputs = conditions.inputs.at(t);
        let slider_load = inputs.slider_load;
        let mut loads = Loads { pin: Vec2::new(slider_load, R::ZERO), slider_load, ..Loads::default() };
        if !of.topology.speed {
            loads.crank_couple = inputs.crank_torque;
        }
        if of.rare_loads {
            // The arm turns with the slider, the force does not.
            loads.slider_couple = slider_load * -self.load_offset * pose.rotations.rotation[SLIDER].cos;
        }
        // Contact forces are available last and are added last.
        add_viscous(&self.rotary_dampers, &pose.rotations.speed, &pose.section_speed, &mut loads);
        if let Some(damping) = self.guide_damping {
            loads.add_guide(&viscous_guide(damping, pose.velocity.pin.x));
        }
        self.clearances.add_loads(of.play, &conditions.contacts, pose, bristles, bristle_rates, &mut loads);
        if of.rare_loads {
            self.clearances.films.add_loads(pose, &mut loads);
        }
        loads
    }

    /// As [`loads`](Self::loads), compiled once for all array sizes of a rod.
    #[inline(never)]
    fn loads_apart<R: Scalar>(
        &self,
        of: &Structure,
        conditions: &Conditions,
        t: R,
        bristles: &[R],
        pose: &Pose<R>,
        bristle_rates: &mut [R],
    ) -> Loads<R> {
        self.loads(of, conditions, t, bristles, pose, bristle_rates)
    }

    /// Accelerations from the loads, accumulated inwards.
    #[inline(always)]
    pub(super) fn accelerations<R: Scalar>(
        &self,
        of: &Structure,
        configuration: &Configuration<R>,
        loads: &Loads<R>,
    ) -> Accelerations<R> {
        let Configuration { pose, arms, closing } = configuration;
        accelerate(of, &self.augmented, self.gravity, &pose.rotations, arms, closing, loads)
    }

    /// Writes the event functions at a pose, with a rod or chord of `length` [m] that grows at `rate` [m/s].
    #[inline(always)]
    fn event_functions_at(
        &self,
        of: &Structure,
        contacts: &Contacts,
        pose: &Pose,
        [length, rate]: [f64; 2],
        event_functions: &mut EventFunctions,
    ) {
        if !of.closed {
            self.clearances.event_functions(of.play, contacts, pose, event_functions);
        } else if self.has_change_point(of) {
            let BodyRotations { rotation, speed, .. } = &pose.rotations;
            event_functions[0] = self.ideal.change_point(rotation[CRANK], speed[CRANK], length, rate);
        }
    }

    /// Whether a closed loop can reach its change point. A flexible rod may shorten until it does.
    #[inline(always)]
    fn has_change_point(&self, of: &Structure) -> bool {
        of.flexible || self.ideal.has_change_point()
    }

    /// The pose with a flexible rod, and its chord.
    #[inline(always)]
    pub(super) fn flexible_pose<R: Scalar, const K: usize, const F: usize>(
        &self,
        rod: &FlexibleRod,
        t: R,
        y: &[R],
    ) -> (Pose<R>, Chord<R>) {
        let (of, p) = (&self.structure, self.positions());
        let (positions, rates) = y[..2 * p].split_at(p);
        let modes: Arrays<'_, K, F> = rod.modes.arrays();
        let shape = modes.shape::<R, super::rod::RuntimeCounts>(&positions[of.positions..], &rates[of.positions..]);
        let configuration = self.flexible_configuration(of, t, positions, rates, &shape.chord, shape.slope_rate);
        (configuration.pose, shape.chord)
    }
}

impl<R: Scalar, const K: usize> FlexibleMotion<R, K> {
    /// The evaluation of the instant of the state `y` whose rates are `rates`.
    #[inline(never)]
    pub fn evaluation(
        &self,
        inertia: &Inertia<R, K>,
        modal_energy: R,
        mechanism: &Mechanism,
        rod: &FlexibleRod,
        y: &[R],
        rates: &[R],
    ) -> Evaluation<R> {
        let Self { configuration: Configuration { pose, arms, .. }, chord, loads, accelerations, .. } = self;
        let (of, p) = (&mechanism.structure, mechanism.positions());
        let modal = of.positions..p;
        let (eta, rate) = (&y[modal.clone()], &y[p + modal.start..2 * p]);
        let forced = &rates[p + modal.start..2 * p];
        let Accelerations { roots, angle } = accelerations;
        let rotations = &pose.rotations;
        let (rotation, speed) = (rotations.rotation[ROD], rotations.speed[ROD]);
        let mut arms = arms.accelerated(rotations.speed, *angle);
        let mut stretching = chord.bias;
        for (slope, forced) in self.chord_slope.iter().zip(forced) {
            stretching += *slope * *forced;
        }
        let axis = rotation.axis(R::ONE);
        arms.reach += stretching * axis + chord.rate * 2.0 * speed * perp(axis);
        let acceleration = JointPoints::outwards(of, roots, &arms);

        // Force, and moment about the big end, that the rod's motion requires.
        let (mass, turn) = (rod.rod.mass(), angle[ROD]);
        let origin = acceleration.big_end - mechanism.gravity;
        let first = rotation.apply(inertia.first);
        let mut force = origin * mass + turn * perp(first) + rotation.apply(inertia.force);
        let mut moment = cross(first, origin) + inertia.about_origin * turn + inertia.couple;
        let mut opening = Vec2::<R>::ZERO;
        let mut with_turning = R::ZERO;
        for (a, (&forced, &rate_a)) in forced.iter().zip(rate).enumerate() {
            let first_slope = Vec2::new(inertia.first_slope.x[a], inertia.first_slope.y[a]);
            force += forced * rotation.apply(first_slope);
            moment += forced * inertia.with_angle[a];
            opening += rate_a * first_slope;
            with_turning += rate_a * inertia.with_angle[a];
        }
        let velocity = pose.velocity.big_end;
        let first_rate = speed * perp(first) + rotation.apply(opening);
        let kinetic = velocity.norm_squared() * (0.5 * mass)
            + velocity.dot(first_rate)
            + inertia.about_origin * 0.5 * speed * speed
            + speed * with_turning
            + modal_energy;
        let flexible = FlexibleEvaluation {
            demand: InertialLoad { force, moment },
            elastic: rod.rod.elastic(chord.stretch, eta, rate),
            kinetic,
            mass_moment: pose.place.big_end * mass + first,
        };
        let mut pose = *pose;
        if of.closed {
            pose.rotations.angle[ROD] = math::atan2(rotation.sin, rotation.cos);
        }
        Evaluation { pose, acceleration, angle_acceleration: *angle, loads: *loads, flexible: Some(flexible) }
    }
}

impl<const K: usize> FlexibleMotion<f64, K> {
    /// Writes the event functions.
    #[inline(always)]
    pub fn event_functions(
        &self,
        mechanism: &Mechanism,
        of: &Structure,
        contacts: &Contacts,
        event_functions: &mut EventFunctions,
    ) {
        let Chord { length, rate, .. } = self.chord;
        mechanism.event_functions_at(of, contacts, &self.configuration.pose, [length, rate], event_functions);
    }
}

/// Writes velocities and accelerations into `rates`.
#[inline(always)]
pub(super) fn write<R: Scalar>(of: &Structure, accelerations: &Accelerations<R>, y: &[R], rates: &mut [R]) {
    let p = of.positions;
    let (velocities, forced) = rates.split_at_mut(p);
    let speeds = &y[p..2 * p];
    unroll!(const { R::PLAIN || R::MANY }, k < p, 9 => {
        velocities[k] = speeds[k];
    });
    of.set_roots(&accelerations.roots, forced);
    of.set_angles(accelerations.angle, forced);
}

/// The evaluation of an instant with a rigid rod.
#[inline(always)]
pub(super) fn evaluation<R: Scalar>(
    of: &Structure,
    configuration: Configuration<R>,
    loads: Loads<R>,
    accelerations: &Accelerations<R>,
) -> Evaluation<R> {
    let Configuration { mut pose, arms, closing } = configuration;
    let Accelerations { roots, angle } = accelerations;
    let mut acceleration = JointPoints::outwards(of, roots, &arms.accelerated(pose.rotations.speed, *angle));
    if of.closed {
        pose.rotations.angle[ROD] = math::atan2(closing.rod.sin, closing.rod.cos);
        let pin = Vec2::new(closing.x_ratio.multiply_add(angle[CRANK], closing.x_bias), R::ZERO);
        (acceleration.small_end, acceleration.pin) = (pin, pin);
    }
    Evaluation { pose, acceleration, angle_acceleration: *angle, loads, flexible: None }
}

impl Mechanism {
    /// Number of event functions.
    pub fn event_count(&self) -> usize {
        if self.structure.closed {
            usize::from(self.has_change_point(&self.structure))
        } else {
            self.clearances.event_count(self.structure.play)
        }
    }

    /// Writes the event functions.
    pub fn event_functions(&self, contacts: &Contacts, t: f64, y: &[f64], event_functions: &mut EventFunctions) {
        let (pose, chord) = match &self.rod {
            Some(rod) => {
                let (pose, chord) = self.pose_and_chord(rod, t, y);
                (pose, [chord.length, chord.rate])
            }
            None => (self.place(t, y).pose, [self.ideal.rod, 0.0]),
        };
        self.event_functions_at(&self.structure, contacts, &pose, chord, event_functions);
    }

    /// The pose at the state `y`: angles, places and velocities.
    pub fn pose(&self, t: f64, y: &[f64]) -> Pose {
        match &self.rod {
            Some(rod) => self.pose_and_chord(rod, t, y).0,
            None => self.place(t, y).pose,
        }
    }

    /// Loads from inputs, viscous friction and contacts at a pose and the state `y`.
    pub fn loads_at(&self, conditions: &Conditions, t: f64, pose: &Pose, y: &[f64]) -> Loads {
        let bristles = &y[2 * self.positions()..];
        self.loads_apart(&self.structure, conditions, t, bristles, pose, &mut [0.0; CONTACTS])
    }

    /// Elastic energy of the closed contacts and the powers that they absorb.
    pub fn contact_energy<R: Scalar>(&self, contacts: &Contacts, pose: &Pose<R>, y: &[R]) -> ContactEnergy<R> {
        self.clearances.contact_energy(self.structure.play, contacts, pose, &y[2 * self.positions()..])
    }

    /// Number of positions, including modal coordinates: the number of degrees of freedom.
    pub fn positions(&self) -> usize {
        self.structure.positions + self.rod.as_ref().map_or(0, |rod| rod.modes.counts.modes())
    }

    /// Number of states: positions, their rates and bristle deflections.
    pub fn states(&self) -> usize {
        2 * self.positions() + self.clearances.bristles.len()
    }

    /// Writes the state of a start pose with undeformed rod and bristles.
    pub fn start(&self, pose: &StartPose, y: &mut [f64]) {
        let of = &self.structure;
        let rotations = rotations(pose.angle, pose.speed, of.slider_angle.is_some());
        let arms = Arms::at(of, self.ideal.crank, self.ideal.rod, &self.augmented, &rotations);
        let still = arms.moving(rotations.speed);
        let velocities = Arms {
            throw: still.throw.velocity,
            reach: still.reach.velocity,
            crank: still.crank.velocity,
            rod: still.rod.velocity,
            slider: still.slider.velocity,
        };
        let p = self.positions();
        let (positions, rates) = y[..2 * p].split_at_mut(p);
        of.set_roots(&Roots::of(of, &pose.place, &arms), positions);
        of.set_angles(pose.angle, positions);
        of.set_roots(&Roots::of(of, &pose.velocity, &velocities), rates);
        of.set_angles(pose.speed, rates);
    }
}
