//! The motion of a mechanism with a flexible rod, in any number: loads on its configuration, inertia,
//! accelerations.

use super::Flexible;
use super::configuration::Configuration;
use super::equations::{Equations, Moving, Places};
use crate::math::Real;
use crate::model::drive::{add_viscous, viscous_guide};
use crate::model::dynamics::Loads;
use crate::model::mechanism::{CRANK, ROD, SLIDER};
use crate::model::plane::Vec2;
use crate::model::rod::Inertia;
use crate::model::scalar::Scalar;
use crate::model::state::{Contacts, FlexibleInstant, Instant, Pose};

impl<const N: usize, const Q: usize, const K: usize, const F: usize> Flexible<N, Q, K, F> {
    #[inline(always)]
    pub(super) fn configuration<R: Real>(&self, t: R, y: &[R; N]) -> Configuration<R, K, F> {
        let p = self.extent.positions;
        self.geometry.configuration(t, &y[..p], &y[p..2 * p])
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

    #[inline(always)]
    fn inertia<R: Real>(&self, configuration: &Configuration<R, K, F>, y: &[R; N]) -> Inertia<R, K> {
        let (modes, p) = (self.geometry.modes(), self.extent.positions);
        let (eta, rate) = (&y[modes.clone()], &y[p + modes.start..p + modes.end]);
        self.integrals.inertia(&configuration.shape, eta, rate, configuration.heading[ROD].speed)
    }

    fn moving<'a, R: Real>(
        &'a self,
        configuration: &'a Configuration<R, K, F>,
        inertia: &'a Inertia<R, K>,
    ) -> Moving<'a, R, K, F> {
        Moving { rod: &self.geometry.rod, inertia, configuration, modes: self.geometry.modes() }
    }

    #[inline(always)]
    fn accelerations<R: Real>(&self, moving: &Moving<'_, R, K, F>, y: &[R; N], loads: &Loads<R>) -> [R; Q] {
        let p = self.extent.positions;
        let modes = moving.modes.clone();
        let mut modal_force = [R::ZERO; K];
        let (eta, rate) = (&y[modes.clone()], &y[p + modes.start..p + modes.end]);
        moving.rod.add_modal_forces(eta, rate, &loads.end_couple, &mut modal_force);
        let mut places = Places::new(modes.start);
        places.add_rigid_bodies(&self.bodies, moving.configuration, loads, self.gravity);
        Equations::new(places, moving, loads, self.gravity, &modal_force).solve()
    }

    /// Writes the rates of the state `y`.
    #[inline(always)]
    pub(super) fn write_rates<R: Scalar>(&self, contacts: &Contacts, t: R, y: &[R; N], rates: &mut [R; N]) {
        let p = self.extent.positions;
        let configuration = self.configuration(t, y);
        let loads = self.loads(contacts, t, y, &configuration.pose());
        let inertia = self.inertia(&configuration, y);
        let forced = self.accelerations(&self.moving(&configuration, &inertia), y, &loads);
        rates[..p].copy_from_slice(&y[p..2 * p]);
        rates[p..2 * p].copy_from_slice(&forced[..p]);
        self.clearances.write_bristle_rates(&loads.bristle_rate, &mut rates[2 * p..]);
    }

    /// Everything about one instant.
    pub(super) fn everything<R: Scalar>(&self, contacts: &Contacts, t: R, y: &[R; N]) -> Instant<R> {
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
}
