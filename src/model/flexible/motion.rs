//! The motion of a mechanism with a flexible rod, in any number: loads on its configuration, inertia,
//! accelerations.

use super::Flexible;
use super::alone;
use super::chain::PLACES;
use super::configuration::{Configuration, Geometry};
use super::equations::{Equations, Moving, Places};
use crate::integrator::Guard;
use crate::model::drive::{add_viscous, viscous_guide};
use crate::model::dynamics::Loads;
use crate::model::mechanism::{CRANK, ROD, SLIDER};
use crate::model::plane::{Rotation, Vec2};
use crate::model::rod::{Inertia, Shape};
use crate::model::scalar::{Scalar, Tangent};
use crate::model::state::{Contacts, FlexibleInstant, Instant, Pose};

/// The motion of `N` states in plain numbers, compiled for the number of places in x.
#[derive(Clone, Copy, Debug)]
pub struct Functions<M, const N: usize> {
    /// Writes the rates of a state.
    pub rates: fn(&M, &Contacts, f64, &[f64; N], &mut [f64; N]),
    /// Writes the rates of a state, and tells everything about that instant.
    pub instant: fn(&M, &Contacts, f64, &[f64; N], &mut [f64; N]) -> Instant,
}

/// The motion at one instant.
pub(super) struct Motion<R, const N: usize, const P: usize, const K: usize, const F: usize> {
    shape: Shape<R, K, F>,
    configuration: Configuration<R, P>,
    inertia: Inertia<R, K>,
    pose: Pose<R>,
    loads: Loads<R>,
    /// Accelerations of the coordinates.
    forced: [R; N],
}

impl<const N: usize, const S: usize, const K: usize, const F: usize> Flexible<N, S, K, F> {
    /// The functions for `size` coordinates in the rod's chain.
    pub(super) fn functions(size: usize) -> Functions<Self, N> {
        /// One for each number of places.
        macro_rules! compiled {
            ($($places:literal)*) => {
                match size + 1 {
                    $($places => Functions {
                        rates: |all, contacts, t, y, rates| {
                            all.motion::<f64, $places>($places - 1, contacts, t, y, rates);
                        },
                        instant: |all, contacts, t, y, rates| {
                            all.instant_of(all.motion::<f64, $places>($places - 1, contacts, t, y, rates), y)
                        },
                    },)*
                    places => unreachable!("{places} places in x"),
                }
            };
        }
        compiled!(1 2 3 4 5 6)
    }

    /// Places and velocities of the state `y` at `t`.
    pub(super) fn pose(&self, t: f64, y: &[f64; N]) -> Pose {
        let (eta, rate) = self.modal(y);
        let shape = (self.modes.functions::<f64>().shape)(&self.modes, eta, rate);
        self.configuration::<f64, PLACES>(self.geometry.chain.size, t, y, &shape).pose(shape.slope_rate)
    }

    /// The event at which the rod, closed in a loop of ideal joints, stands across the guide.
    pub(super) fn change_point(&self, t: f64, y: &[f64; N]) -> Guard {
        let (eta, rate) = self.modal(y);
        let chord = (self.modes.functions::<f64>().shape)(&self.modes, eta, rate).chord;
        let Geometry { layout, rotor, ideal, .. } = &self.geometry;
        let p = self.extent.positions;
        let (angle, speed) = layout.angle(CRANK).map_or((rotor.at(t), rotor.speed), |i| (y[i], y[p + i]));
        ideal.change_point(Rotation::new(angle), speed, chord.length, chord.rate)
    }

    /// Modal coordinates and their rates.
    #[inline(always)]
    fn modal<'a, R>(&self, y: &'a [R; N]) -> (&'a [R], &'a [R]) {
        let (modes, p) = (self.geometry.modes(), self.extent.positions);
        (&y[modes.clone()], &y[p + modes.start..p + modes.end])
    }

    #[inline(always)]
    fn configuration<R: Scalar, const P: usize>(
        &self,
        size: usize,
        t: R,
        y: &[R; N],
        shape: &Shape<R, K, F>,
    ) -> Configuration<R, P> {
        let p = self.extent.positions;
        self.geometry.configuration(t, &y[..p], &y[p..2 * p], &shape.chord, size)
    }

    #[inline(always)]
    fn loads<R: Scalar>(&self, contacts: &Contacts, t: R, y: &[R; N], pose: &Pose<R>) -> Loads<R> {
        let inputs = self.signal.at(t);
        let slider_load = inputs.slider_load;
        let mut loads = Loads { pin: Vec2::new(slider_load, R::ZERO), slider_load, ..Loads::default() };
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

    /// The motion through the state `y` at `t`, whose rates it writes; `size` coordinates are in the rod's chain.
    #[inline(always)]
    fn motion<R: Scalar, const P: usize>(
        &self,
        size: usize,
        contacts: &Contacts,
        t: R,
        y: &[R; N],
        rates: &mut [R; N],
    ) -> Motion<R, N, P, K, F> {
        let p = self.extent.positions;
        let (eta, rate) = self.modal(y);
        let rod = self.modes.functions::<R>();
        let shape = (rod.shape)(&self.modes, eta, rate);
        let mut configuration = self.configuration::<R, P>(size, t, y, &shape);
        let pose = configuration.pose(shape.slope_rate);
        let loads = self.loads(contacts, t, y, &pose);
        let Geometry { topology, layout, chain, .. } = &self.geometry;
        alone::accelerate(*topology, &self.bodies, &mut configuration, &loads, self.gravity);
        let inertia = (rod.inertia)(&self.modes, &shape, eta, rate, configuration.heading[ROD].speed);
        let mut places = Places::new(size + 1);
        places.add_rigid_bodies(*topology, &self.bodies, &configuration, &loads, self.gravity);
        let modal_force = self.modes.forces(eta, rate, &loads.end_couple);
        let moving = self.moving(&shape, &configuration, &inertia);
        let found =
            Equations::new(places, &moving, &loads, self.gravity, &modal_force).solve(*R::kernel(&self.solvers));
        let mut forced = [R::ZERO; N];
        chain.scatter(&found[..size], &mut forced);
        forced[moving.modes.clone()].copy_from_slice(&found[size..size + moving.modes.len()]);
        alone::write(*topology, layout, &configuration, &mut forced);
        rates[..p].copy_from_slice(&y[p..2 * p]);
        rates[p..2 * p].copy_from_slice(&forced[..p]);
        self.clearances.write_bristle_rates(&loads.bristle_rate, &mut rates[2 * p..]);
        Motion { shape, configuration, inertia, pose, loads, forced }
    }

    #[inline(always)]
    fn moving<'a, R, const P: usize>(
        &'a self,
        shape: &'a Shape<R, K, F>,
        configuration: &'a Configuration<R, P>,
        inertia: &'a Inertia<R, K>,
    ) -> Moving<'a, R, P, K, F> {
        Moving { rod: &self.geometry.rod, shape, inertia, configuration, modes: self.geometry.modes() }
    }

    /// The motion in numbers with derivatives.
    pub(super) fn tangent_motion(
        &self,
        contacts: &Contacts,
        t: Tangent,
        y: &[Tangent; N],
        rates: &mut [Tangent; N],
    ) -> Motion<Tangent, N, PLACES, K, F> {
        self.motion(self.geometry.chain.size, contacts, t, y, rates)
    }

    /// Everything about the instant of a motion.
    pub(super) fn instant_of<R: Scalar, const P: usize>(
        &self,
        motion: Motion<R, N, P, K, F>,
        y: &[R; N],
    ) -> Instant<R> {
        let Motion { shape, configuration, inertia, pose, loads, forced } = motion;
        let moving = self.moving(&shape, &configuration, &inertia);
        let places = self.geometry.accelerations(&shape, &forced);
        let (eta, rate) = self.modal(y);
        Instant {
            pose,
            acceleration: configuration.each(|centre| centre.acceleration(&places)),
            angle_acceleration: [CRANK, ROD, SLIDER].map(|k| configuration.heading[k].acceleration(&places)),
            loads,
            flexible: Some(FlexibleInstant {
                demand: moving.demand(&places, &forced, self.gravity),
                elastic: moving.rod.elastic(&shape, eta, rate),
                kinetic: moving.kinetic(rate),
                mass_height: moving.mass_height(),
            }),
        }
    }
}
