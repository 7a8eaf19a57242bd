//! The energy audit; and what a motion without losses keeps: energy, and momentum while nothing
//! touches the ground.

use crate::constraints::{DRIVE_ROW, Solution};
use crate::coordinates::{Account, CRANK, Motion, ROD, SLIDER, Vector, cross};
use crate::loads::Loads;
use crate::mechanism::DriveMode;
use crate::signals::{EnergyOutputs, Inputs};
use crate::solver::Reference;

impl Reference {
    /// [J] Kinetic energy, height, elastic rod and elastic contacts.
    pub fn energy(&self) -> f64 {
        self.kinetic(&self.motion) + self.stores(&self.motion).iter().sum::<f64>()
    }

    fn kinetic(&self, motion: &Motion) -> f64 {
        0.5 * motion.v.dot(&(self.bodies.inertia(motion).mass * motion.v))
    }

    /// [J] Of height, rod and contacts.
    fn stores(&self, motion: &Motion) -> [f64; 3] {
        let of_contact = |k: usize| self.contacts[k].as_ref().map_or(0.0, |c| c.energy(motion, &self.phases[k]));
        [
            self.bodies.height_energy(motion),
            self.bodies.beam.as_ref().map_or(0.0, |beam| beam.energy(motion)),
            (0..self.contacts.len()).map(of_contact).sum(),
        ]
    }

    /// [N·m] On the crank: given, or what the speed drive needs.
    pub(crate) fn drive_torque(&self, inputs: Inputs, solution: &Solution) -> f64 {
        match self.mechanism.drive.mode {
            DriveMode::Torque => inputs.crank_torque,
            DriveMode::Speed => solution.multipliers[DRIVE_ROW],
        }
    }

    /// [W] What the account gains.
    pub(crate) fn powers(&self, time: f64, motion: &Motion, loads: &Loads, solution: &Solution) -> Account {
        if !self.mechanism.energy.audit {
            return Account::zeros();
        }
        let inputs = self.inputs_at(time);
        Account::from([
            self.drive_torque(inputs, solution) * motion.spin(CRANK),
            inputs.slider_load * self.bodies.loaded.velocity(motion).x,
            loads.contact_loss,
            loads.friction_loss,
            loads.viscous_loss,
            self.bodies.beam.as_ref().map_or(0.0, |beam| beam.loss(motion)),
        ])
    }

    /// All 0 without an audit.
    pub(crate) fn audit(&self) -> EnergyOutputs {
        if !self.mechanism.energy.audit {
            return EnergyOutputs::default();
        }
        let kinetic = self.kinetic(&self.motion);
        let [gravity, elastic, contact] = self.stores(&self.motion);
        let potential = gravity + elastic + contact;
        let [torque_work, load_work, contact_loss, friction_loss, viscous_loss, modal_loss] =
            self.motion.account.into();
        let input = torque_work + load_work;
        let dissipated = contact_loss + friction_loss + viscous_loss + modal_loss;
        EnergyOutputs {
            kinetic,
            potential,
            input,
            dissipated,
            residual: kinetic + potential - self.energy_start - input + dissipated,
            gravity,
            elastic,
            contact,
            torque_work,
            load_work,
            contact_loss,
            friction_loss,
            viscous_loss,
            modal_loss,
        }
    }

    /// [kg·m/s, kg·m/s, kg·m²/s] Of all bodies; angular about the origin.
    pub fn momentum(&self) -> [f64; 3] {
        let motion = &self.motion;
        let momenta = self.bodies.inertia(motion).mass * motion.v;
        let mut sum = [0.0; 3];
        for body in [CRANK, ROD, SLIDER] {
            let linear = Vector::new(momenta[3 * body], momenta[3 * body + 1]);
            sum[0] += linear.x;
            sum[1] += linear.y;
            sum[2] += cross(motion.origin(body), linear) + momenta[3 * body + 2];
        }
        sum
    }
}
