//! Rigid contacts of joints with clearance: the interface between time stepping and an open mechanism.
//!
//! The contacts are those of the joints A, B and C and of the guide's four corners. Relative velocities follow from the
//! pose. The response to an impulse is the acceleration under that force alone, with zero velocities and without
//! gravity.

use super::clearances::Clearances;
use super::drive::InputSignal;
use super::dynamics::{Accelerations, accelerate};
use super::ideal::IdealMotion;
use super::joint::rectangle::CORNERS;
use super::joint_set::{JointSet, Pin};
use super::kinematics::BodyRotations;
use super::loads::Loads;
use super::mechanism::{Mechanism, evaluation, write};
use super::plane::Vec2;
use super::state::{CONTACTS, Conditions, Evaluation, Pose};
use super::structure::Structure;
use crate::integrator::Relative;
use crate::integrator::complementarity::{MAX_CONTACTS, Pairs};

const _: () = assert!(CONTACTS == MAX_CONTACTS);

impl Clearances {
    /// [m/s] Rate of the gap and sliding velocity of every contact; 0 in a joint without clearance.
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

    /// Adds the normal and tangential force [N] of one contact.
    fn add_rigid(&self, contact: usize, pose: &Pose, forces: [f64; 2], loads: &mut Loads) {
        match Pin::ALL.get(contact) {
            Some(&pin) => loads.add_contact(pin, &self.revolute[contact].rigid_load(&pose.journal(pin), forces)),
            None => loads.add_guide(&self.guide.rigid_load(contact - 3, &pose.slider(), forces)),
        }
    }
}

/// The contact forces of a step, at the pose in its middle.
pub struct StepForces<'a> {
    /// [s] Midpoint of the step.
    pub t: f64,
    /// State at the midpoint.
    pub y: &'a [f64],
    /// [N] Normal and tangential forces of all contacts.
    pub forces: &'a Pairs,
    /// For each contact, whether it exerts a force.
    pub acts: [bool; CONTACTS],
}

impl Mechanism {
    /// Gaps and relative velocities of all contacts.
    pub fn contacts(&self, t: f64, y: &[f64]) -> Relative {
        let (pose, play) = (self.pose(t, y), self.structure.play);
        Relative {
            gap: self.clearances.depths(play, &pose).map(|depth| -depth),
            velocity: self.clearances.contact_velocities(play, &pose),
        }
    }

    /// Writes the changes of velocities by a unit impulse in one `part` (direction) of one contact, at the places of
    /// accelerations.
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
            Vec2::ZERO,
            &still,
            &configuration.arms,
            &IdealMotion::default(),
            &loads,
        );
        self.structure.set_roots(&roots, &mut rates[p..2 * p]);
        self.structure.set_angles(angle, &mut rates[p..2 * p]);
    }

    /// The evaluation of an instant with rigid contacts; writes the rates.
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
