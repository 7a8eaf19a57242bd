//! Rigid contacts: rates of gaps, sliding velocities, and the loads of contact forces.
//!
//! A normal force pushes the journal or the corner away from the surface that it touches; a tangential force acts on it
//! in the direction of the sliding velocity. Force times velocity is power, as in compliant contacts, so that the
//! directions of the forces are the transposed velocity Jacobians.

use super::guide::{Guide, Load};
use super::rectangle::SliderPose;
use super::revolute::{self, JournalMotion, Revolute};
use crate::model::plane::{Vec2, cross, perp};

impl Revolute {
    /// [m/s] Rate of the gap, and v_t; 0 if the journal is centred, where n is undefined.
    pub fn contact_velocity(&self, play: &JournalMotion) -> [f64; 2] {
        let Some((epsilon, n)) = play.distance_and_normal() else {
            return [0.0; 2];
        };
        [-play.rate.dot(n), self.sliding(play, epsilon, perp(n))]
    }

    /// The load of the forces `normal` and `tangential` [N] on the journal at the contact point.
    pub fn rigid_load(&self, play: &JournalMotion, [normal, tangential]: [f64; 2]) -> revolute::Load {
        let Some((epsilon, n)) = play.distance_and_normal() else {
            return revolute::Load::default();
        };
        revolute::Load {
            force: tangential * perp(n) - normal * n,
            journal_couple: (self.radius - epsilon) * tangential,
            bearing_couple: -self.radius * tangential,
            bristle_rate: 0.0,
        }
    }
}

impl Guide {
    /// [m/s] Rate of the gap of a corner, and its sliding velocity.
    pub fn contact_velocity(&self, corner: usize, pose: &SliderPose) -> [f64; 2] {
        let touch = self.rectangle.corners[corner].touch(pose);
        [-touch.rate, touch.sliding]
    }

    /// The load of the forces `normal` and `tangential` [N] on a corner.
    pub fn rigid_load(&self, corner: usize, pose: &SliderPose, [normal, tangential]: [f64; 2]) -> Load {
        let touch = self.rectangle.corners[corner].touch(pose);
        let force = Vec2::new(tangential, touch.normal * normal);
        Load { force, couple: cross(touch.arm, force) }
    }
}
