//! Joints with clearance whose contacts are rigid: what time stepping needs of an open mechanism.
//!
//! Contacts are those of the joints A, B and C and of the guide's four corners. Velocities are those of the pose, and
//! the response to an impulse is the acceleration under that force alone, at rest and without weight.

use super::clearances::Clearances;
use super::dynamics::{Loads, accelerate};
use super::joint::guide::CORNERS;
use super::kinematics::Turning;
use super::linkage::{Arrangement, Linkage};
use super::open::Open;
use super::state::{CONTACTS, Contacts, Pose};
use crate::integrator::complementarity::{MOST_CONTACTS, Pairs};
use crate::integrator::{ContactLaw, Impulses, Relative, Unilateral};
use crate::scene::{Contact, FrictionLaw, Scene};

const _: () = assert!(CONTACTS == MOST_CONTACTS);

/// Restitution and friction of every contact of a scene: of a friction law, its (kinetic) coefficient.
pub fn laws(scene: &Scene) -> [ContactLaw; CONTACTS] {
    let law = |contact: &Contact| ContactLaw {
        restitution: contact.restitution,
        friction: if contact.friction.law == FrictionLaw::None { 0.0 } else { contact.friction.coefficient },
    };
    let joint = &scene.joint;
    let mut laws = [law(&joint.t.contact); CONTACTS];
    for (place, joint) in laws.iter_mut().zip([&joint.a, &joint.b, &joint.c]) {
        *place = law(&joint.contact);
    }
    laws
}

impl Clearances {
    /// [m/s] Rate of the gap and sliding speed of every contact; 0 in a joint without clearance.
    fn contact_velocities(&self, clear: [bool; 4], pose: &Pose) -> Pairs {
        let mut velocities = Pairs::default();
        for (joint, revolute) in self.revolute.iter().enumerate().filter(|(joint, _)| clear[*joint]) {
            velocities[joint] = revolute.contact_velocity(&pose.play(joint));
        }
        if clear[3] {
            let slider = pose.slider();
            for corner in 0..CORNERS {
                velocities[3 + corner] = self.guide.contact_velocity(corner, &slider);
            }
        }
        velocities
    }

    /// Adds the forces [N] of one contact.
    fn add_rigid(&self, contact: usize, pose: &Pose, forces: [f64; 2], loads: &mut Loads) {
        match contact {
            0..3 => loads.add_contact(contact, &self.revolute[contact].rigid_load(&pose.play(contact), forces)),
            _ => loads.add_guide(&self.guide.rigid_load(contact - 3, &pose.slider(), forces)),
        }
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize>
    Open<A, B, C, T, SPEED, N>
{
    /// Loads under the forces of `impulses`, which act as they did at the middle of their step.
    pub(super) fn loads_under(&self, impulses: &Impulses, t: f64, y: &[f64], pose: &Pose) -> Loads {
        let bristles = &y[2 * Self::P..];
        let mut loads = self.linkage.loads(Self::ARRANGEMENT, &Contacts::default(), t, bristles, pose);
        let mut acting = (0..CONTACTS).filter(|&contact| impulses.acts(contact)).peekable();
        if acting.peek().is_some() {
            let there = self.pose(impulses.t, &impulses.y[..y.len()]);
            for contact in acting {
                self.linkage.clearances.add_rigid(contact, &there, impulses.forces[contact], &mut loads);
            }
        }
        loads
    }
}

impl<const A: bool, const B: bool, const C: bool, const T: bool, const SPEED: bool, const N: usize> Unilateral
    for Open<A, B, C, T, SPEED, N>
{
    fn contact_laws(&self) -> [ContactLaw; MOST_CONTACTS] {
        self.linkage.clearances.laws
    }

    fn contacts(&self, t: f64, y: &[f64]) -> Relative {
        let pose = self.pose(t, y);
        Relative {
            gap: self.linkage.clearances.depths(Self::ARRANGEMENT.clear, &pose).map(|depth| -depth),
            velocity: self.linkage.clearances.contact_velocities(Self::ARRANGEMENT.clear, &pose),
        }
    }

    fn response(&self, t: f64, y: &[f64], contact: usize, part: usize, response: &mut [f64]) {
        let pose = self.pose(t, y);
        let mut loads = Loads::default();
        let mut unit = [0.0; 2];
        unit[part] = 1.0;
        self.linkage.clearances.add_rigid(contact, &pose, unit, &mut loads);
        let still = Turning { speed: [0.0; 3], ..pose.turning };
        let Arrangement { topology, layout, positions: p, .. } = Self::ARRANGEMENT;
        let Linkage { bodies, chains, .. } = &self.linkage;
        let accelerations = accelerate(topology, bodies, chains, 0.0, &still, &loads);
        response.fill(0.0);
        layout.set_roots(&accelerations.roots, &mut response[p..2 * p]);
        layout.set_angles(&accelerations.angle, &mut response[p..2 * p]);
    }
}
