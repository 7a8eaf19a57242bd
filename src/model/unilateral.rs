//! Joints with clearance whose contacts are rigid: what time stepping needs of an open mechanism.
//!
//! Contacts are those of the joints A, B and C and of the guide's four corners. Velocities are those of the pose, and
//! the response to an impulse is the acceleration under that force alone, at rest and without weight.

use super::clearances::Clearances;
use super::drive::InputSignal;
use super::dynamics::{Accelerations, accelerate};
use super::ideal::IdealMotion;
use super::joint::rectangle::CORNERS;
use super::joint_set::{JointSet, Pin};
use super::kinematics::BodyRotations;
use super::loads::Loads;
use super::mechanism::{Mechanism, evaluation, write};
use super::state::{CONTACTS, Conditions, Evaluation, Pose};
use super::structure::Structure;
use crate::integrator::Relative;
use crate::integrator::complementarity::{MAX_CONTACTS, Pairs};

const _: () = assert!(CONTACTS == MAX_CONTACTS);

impl Clearances {
    /// [m/s] Rate of the gap and sliding speed of every contact; 0 in a joint without clearance.
    fn contact_velocities(&self, play: JointSet, pose: &Pose) -> Pairs {
        let mut velocities = Pairs::default();
        for pin in play.pins() {
            velocities[pin as usize] = self.revolute[pin as usize].contact_velocity(&pose.journal(pin));
        }
        if play.guide {
            let slider = pose.slider();
            for corner in 0..CORNERS {
                velocities[3 + corner] = self.guide.contact_velocity(corner, &slider);
            }
        }
        velocities
    }

    /// Adds the forces [N] of one contact.
    fn add_rigid(&self, contact: usize, pose: &Pose, forces: [f64; 2], loads: &mut Loads) {
        match Pin::ALL.get(contact) {
            Some(&pin) => loads.add_contact(pin, &self.revolute[contact].rigid_load(&pose.journal(pin), forces)),
            None => loads.add_guide(&self.guide.rigid_load(contact - 3, &pose.slider(), forces)),
        }
    }
}

/// What the contacts do in a step: the forces [N] of those that act, at the pose in its middle.
pub struct StepForces<'a> {
    /// [s] Middle of the step.
    pub t: f64,
    /// State there.
    pub y: &'a [f64],
    /// [N]
    pub forces: &'a Pairs,
    /// Which contacts act.
    pub acts: [bool; CONTACTS],
}

impl Mechanism {
    /// Gaps and relative velocities of the contacts.
    pub fn contacts(&self, t: f64, y: &[f64]) -> Relative {
        let (pose, play) = (self.pose(t, y), self.structure.play);
        Relative {
            gap: self.clearances.depths(play, &pose).map(|depth| -depth),
            velocity: self.clearances.contact_velocities(play, &pose),
        }
    }

    /// Writes what a unit impulse in one `part` of one contact changes the velocities by, among the rates of all states.
    pub fn response(&self, t: f64, y: &[f64], contact: usize, part: usize, rates: &mut [f64]) {
        let configuration = self.place(t, y);
        let mut loads = Loads::default();
        let mut unit = [0.0; 2];
        unit[part] = 1.0;
        self.clearances.add_rigid(contact, &configuration.pose, unit, &mut loads);
        let Structure { positions: p, .. } = self.structure;
        let still = BodyRotations { speed: [0.0; 3], ..configuration.pose.rotations };
        let Accelerations { roots, angle } = accelerate(
            &self.structure,
            &self.augmented,
            0.0,
            &still,
            &configuration.arms,
            &IdealMotion::default(),
            &loads,
        );
        self.structure.set_roots(&roots, &mut rates[p..2 * p]);
        self.structure.set_angles(angle, &mut rates[p..2 * p]);
    }

    /// Everything about an instant of a motion with rigid contacts, and its rates.
    pub fn evaluation_under(
        &self,
        acting: &StepForces<'_>,
        inputs: &InputSignal,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
    ) -> Evaluation {
        let of = &self.structure;
        let configuration = self.place(t, y);
        let (moving, bristle_rates) = rates.split_at_mut(2 * of.positions);
        let open = Conditions::without_contacts(*inputs);
        let mut loads = self.loads(of, &open, t, &y[2 * of.positions..], &configuration.pose, bristle_rates);
        if acting.acts.contains(&true) {
            let there = self.pose(acting.t, acting.y);
            for contact in (0..CONTACTS).filter(|&contact| acting.acts[contact]) {
                self.clearances.add_rigid(contact, &there, acting.forces[contact], &mut loads);
            }
        }
        let accelerations = self.accelerations(of, &configuration, &loads);
        write(of, &accelerations, y, moving);
        evaluation(of, configuration, loads, &accelerations)
    }
}
