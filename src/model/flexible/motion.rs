//! The motion of a mechanism with a flexible rod, in any number: loads on its configuration, inertia,
//! accelerations.

use super::alone;
use super::assembly::Assembly;
use super::chain::{Frame, PLACES};
use super::configuration::{Configuration, Geometry};
use super::equations::{Equations, Moving, Places};
use super::written;
use crate::integrator::{EventFunction, EventFunctions};
use crate::math::{Row, each};
use crate::model::drive::{add_viscous, viscous_guide};
use crate::model::loads::Loads;
use crate::model::plane::{Rotation, Vec2};
use crate::model::rod::{Any, Counted, Counts, FEW_MODES, Inertia, Shape};
use crate::model::scalar::{Scalar, Tangent};
use crate::model::state::{Contacts, FlexibleInstant, Instant, Pose};
use crate::model::structure::Structure;
use crate::model::structure::{CRANK, ROD, SLIDER, Topology};
use crate::scene::modal::MOST_MODES;

/// Writes the rates of a state at a time.
pub type Rates<M> = fn(&M, &Contacts, f64, &[f64], &mut [f64]);

/// Writes the rates of four states.
pub type RatesInRow<M> = fn(&M, &Contacts, Row<1>, &[Row<1>], &mut [Row<1>]);

type Ends<M> = fn(&M, &Contacts, f64, &[f64], &mut [f64], &mut EventFunctions);

/// The motion in plain numbers, compiled for its frame.
#[derive(Clone, Copy, Debug)]
pub struct Functions<M> {
    /// Writes the rates of a state.
    pub rates: Rates<M>,
    /// Writes the rates of four states.
    pub row: RatesInRow<M>,
    /// Writes the rates of a state, and its event functions.
    pub ends: Ends<M>,
    /// Tells places and velocities of a state.
    pub pose: fn(&M, f64, &[f64]) -> Pose,
    /// Writes the rates of a state, and tells everything about that instant.
    pub instant: fn(&M, &Contacts, f64, &[f64], &mut [f64]) -> Instant,
}

/// The motion at one instant.
pub(super) struct Motion<R, const P: usize, const K: usize, const F: usize> {
    shape: Shape<R, K, F>,
    configuration: Configuration<R, P>,
    inertia: Inertia<R, K>,
    pose: Pose<R>,
    loads: Loads<R>,
}

/// Chooses among all topologies: hands joints and drive of a [`Topology`] to a macro, as literals.
macro_rules! by_topology {
    ($topology:expr, $compiled:ident) => {
        by_topology!(
            @ $topology, $compiled,
            (true true true true)    (true true true false)    (true true false true)    (true true false false)
            (true false true true)   (true false true false)   (true false false true)   (true false false false)
            (false true true true)   (false true true false)   (false true false true)   (false true false false)
            (false false true true)  (false false true false)  (false false false true)  (false false false false)
        )
    };
    (@ $topology:expr, $compiled:ident, $(($a:literal $b:literal $c:literal $t:literal))*) => {
        match ($topology.a, $topology.b, $topology.c, $topology.t) {
            $(($a, $b, $c, $t) if $topology.speed => $compiled!($a $b $c $t true),
            ($a, $b, $c, $t) => $compiled!($a $b $c $t false),)*
        }
    };
}
pub(super) use by_topology;

impl<const S: usize, const K: usize, const F: usize> Assembly<S, K, F> {
    /// The functions for a topology; with many modes those for any, since it is they that take the time.
    pub(super) fn functions(topology: Topology, counts: Counts) -> Functions<Self> {
        /// Those for a frame, with so many places.
        macro_rules! compiled {
            ($places:expr, $all:ident => $frame:expr) => {
                Functions {
                    rates: |$all, contacts, t, y, rates| {
                        $all.motion::<f64, { $places }>($frame, contacts, t, y, rates);
                    },
                    row: Self::rates_in_row,
                    ends: |$all, contacts, t, y, rates, guards| {
                        let motion = $all.motion::<f64, { $places }>($frame, contacts, t, y, rates);
                        if $frame.structure.topology.is_closed() {
                            guards[0] = $all.change_point(t, y);
                        } else {
                            $all.clearances.guards($frame.structure.play, contacts, &motion.pose, guards);
                        }
                    },
                    pose: |$all, t, y| $all.pose_in::<{ $places }>($frame, t, y),
                    instant: |$all, contacts, t, y, rates| {
                        let motion = $all.motion::<f64, { $places }>($frame, contacts, t, y, rates);
                        $all.instant_of($frame, motion, y, rates)
                    },
                }
            };
        }
        if const { K > MOST_MODES } {
            return compiled!(PLACES, all => all.geometry.frame);
        }
        /// Those for these ideal joints and this drive.
        macro_rules! joined {
            ($a:literal $b:literal $c:literal $t:literal $speed:literal) => {{
                const FRAME: Frame = Frame::new(Topology { a: $a, b: $b, c: $c, t: $t, speed: $speed });
                compiled!(FRAME.places(), all => FRAME)
            }};
        }
        let functions: Functions<Self> = by_topology!(topology, joined);
        let (rates, row) = written::rates(topology, counts);
        Functions { rates: rates.unwrap_or(functions.rates), row: row.unwrap_or(functions.row), ..functions }
    }

    /// Writes the rates of four states; compiled once, for all topologies.
    fn rates_in_row(&self, contacts: &Contacts, t: Row<1>, y: &[Row<1>], rates: &mut [Row<1>]) {
        self.motion::<Row<1>, PLACES>(self.geometry.frame, contacts, t, y, rates);
    }

    /// Places and velocities of the state `y` at `t`.
    pub(super) fn pose(&self, t: f64, y: &[f64]) -> Pose {
        (self.functions.pose)(self, t, y)
    }

    #[inline(always)]
    fn pose_in<const P: usize>(&self, frame: Frame, t: f64, y: &[f64]) -> Pose {
        let (eta, rate) = self.modal(frame, y);
        let shape = self.modes.shape_of::<f64, Any>(eta, rate);
        let (positions, speeds) = y[..2 * self.positions].split_at(self.positions);
        let configuration = self.geometry.configuration::<f64, P>(frame, t, positions, speeds, &shape.chord);
        configuration.pose(shape.slope_rate)
    }

    /// The event at which the rod, closed in a loop of ideal joints, stands across the guide.
    pub(super) fn change_point(&self, t: f64, y: &[f64]) -> EventFunction {
        let Geometry { frame, rotor, ideal, .. } = &self.geometry;
        let (eta, rate) = self.modal(*frame, y);
        let chord = self.modes.shape_of::<f64, Any>(eta, rate).chord;
        let p = self.positions;
        let (angle, speed) = frame.structure.angle(CRANK).map_or((rotor.at(t), rotor.speed), |i| (y[i], y[p + i]));
        ideal.change_point(Rotation::new(angle), speed, chord.length, chord.rate)
    }

    /// Modal coordinates and their rates.
    #[inline(always)]
    fn modal<'a, R>(&self, frame: Frame, y: &'a [R]) -> (&'a [R], &'a [R]) {
        let (modes, p) = (self.geometry.modes(frame), self.positions);
        (&y[modes.clone()], &y[p + modes.start..p + modes.end])
    }

    #[inline(always)]
    fn loads<R: Scalar>(
        &self,
        frame: Frame,
        contacts: &Contacts,
        t: R,
        bristles: &[R],
        bristle_rates: &mut [R],
        pose: &Pose<R>,
    ) -> Loads<R> {
        let inputs = self.signal.at(t);
        let slider_load = inputs.slider_load;
        let mut loads = Loads { pin: Vec2::new(slider_load, R::ZERO), slider_load, ..Loads::default() };
        if !frame.structure.topology.speed {
            loads.crank_couple = inputs.crank_torque;
        }
        self.clearances.add_loads(frame.structure.play, contacts, pose, bristles, bristle_rates, &mut loads);
        add_viscous(&self.rotary_dampers, &pose.turning.speed, &pose.section_speed, &mut loads);
        if let Some(damping) = self.guide_damping {
            loads.add_guide(&viscous_guide(damping, pose.velocity.pin.x));
        }
        loads
    }

    /// The motion through the state `y` at `t`, whose rates it writes.
    #[inline(always)]
    fn motion<R: Scalar, const P: usize>(
        &self,
        frame: Frame,
        contacts: &Contacts,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> Motion<R, P, K, F> {
        self.motion_of::<R, P, Any>(frame, contacts, t, y, rates)
    }

    /// The same; compiled in one piece for counts of the rod that are known.
    #[inline(always)]
    pub(super) fn motion_of<R: Scalar, const P: usize, C: Counted>(
        &self,
        frame: Frame,
        contacts: &Contacts,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> Motion<R, P, K, F> {
        let Frame { structure, chain } = frame;
        let Structure { topology, positions: rigid, .. } = structure;
        let counts = C::COUNTS.unwrap_or(self.modes.counts);
        let p = rigid + counts.modes();
        let (positions, speeds) = (&y[..p], &y[p..2 * p]);
        let (eta, rate) = (&positions[rigid..], &speeds[rigid..]);
        let shape = self.modes.shape_of::<R, C>(eta, rate);
        let mut configuration = self.geometry.configuration::<R, P>(frame, t, positions, speeds, &shape.chord);
        let pose = configuration.pose(shape.slope_rate);
        let (velocities, others) = rates.split_at_mut(p);
        let (accelerations, bristle_rates) = others.split_at_mut(p);
        let loads = self.loads(frame, contacts, t, &y[2 * p..], bristle_rates, &pose);
        alone::accelerate(topology, &self.bodies, &mut configuration, &loads, self.gravity);
        let turning = configuration.heading[ROD].speed;
        let inertia = self.modes.inertia_of::<R, C>(&shape, eta, rate, turning);
        let mut places = Places::NONE;
        places.add_rigid_bodies(topology, &self.bodies, &configuration, &loads, self.gravity);
        let modal_force = self.modes.forces(eta, rate, &loads.end_couple);
        let (rod, modes) = (&self.geometry.rod, rigid..p);
        let moving = Moving { rod, shape: &shape, inertia: &inertia, configuration: &configuration, modes };
        let equations = Equations::new(places, chain.size, &moving, &loads, self.gravity, &modal_force);
        let found = equations.solve::<C, P>(*R::kernel(&self.solvers));
        each!(R::PLAIN, k < rigid, 9 => {
            velocities[k] = speeds[k];
        });
        chain.scatter(&found[..chain.size], accelerations);
        each!(const { R::PLAIN && K <= FEW_MODES }, mode < counts.modes().min(K), K => {
            velocities[rigid + mode] = rate[mode];
            accelerations[rigid + mode] = found[chain.size + mode];
        });
        alone::write(&structure, &configuration, accelerations);
        Motion { shape, configuration, inertia, pose, loads }
    }

    #[inline(always)]
    fn moving<'a, R, const P: usize>(
        &'a self,
        frame: Frame,
        shape: &'a Shape<R, K, F>,
        configuration: &'a Configuration<R, P>,
        inertia: &'a Inertia<R, K>,
    ) -> Moving<'a, R, P, K, F> {
        Moving { rod: &self.geometry.rod, shape, inertia, configuration, modes: self.geometry.modes(frame) }
    }

    /// The motion in numbers with derivatives.
    pub(super) fn tangent_motion(
        &self,
        contacts: &Contacts,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) -> Motion<Tangent, PLACES, K, F> {
        self.motion(self.geometry.frame, contacts, t, y, rates)
    }

    /// Everything about the instant of a motion through `y` that gave these rates.
    pub(super) fn instant_of<R: Scalar, const P: usize>(
        &self,
        frame: Frame,
        motion: Motion<R, P, K, F>,
        y: &[R],
        rates: &[R],
    ) -> Instant<R> {
        let Motion { shape, configuration, inertia, pose, loads } = motion;
        let forced = &rates[self.positions..2 * self.positions];
        let moving = self.moving(frame, &shape, &configuration, &inertia);
        let places = self.geometry.accelerations(frame, &shape, forced);
        let (eta, rate) = self.modal(frame, y);
        Instant {
            pose,
            acceleration: configuration.each(|centre| centre.acceleration(&places)),
            angle_acceleration: [CRANK, ROD, SLIDER].map(|k| configuration.heading[k].acceleration(&places)),
            loads,
            flexible: Some(FlexibleInstant {
                demand: moving.demand(&places, forced, self.gravity),
                elastic: moving.rod.elastic(&shape, eta, rate),
                kinetic: moving.kinetic(rate),
                mass_height: moving.mass_height(),
            }),
        }
    }
}
