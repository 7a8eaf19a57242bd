//! The oil films of a mechanism.

use super::joint::film::{Film, squeeze_velocity};
use super::joint::revolute::Load;
use super::joint_set::Pin;
use super::loads::Loads;
use super::plane::Vec2;
use super::state::Pose;
use crate::integrator::Discontinuities;
use crate::math::Real;
use crate::scene::{JointModel, Scene};

/// The oil films of the lubricated joints with clearance; dry and ideal joints are not in the list.
#[derive(Clone, Debug)]
pub struct Films(Vec<(Pin, Film)>);

impl Films {
    /// The films of a scene.
    pub fn new(scene: &Scene) -> Self {
        let joints = [&scene.joint.a, &scene.joint.b, &scene.joint.c];
        let with_clearance = Pin::ALL.into_iter().zip(joints).filter(|(_, joint)| joint.model == JointModel::Clearance);
        Self(with_clearance.filter_map(|(pin, joint)| Film::new(joint).map(|film| (pin, film))).collect())
    }

    /// Whether all joints are dry.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds the films' loads.
    #[inline(always)]
    pub fn add_loads<R: Real>(&self, pose: &Pose<R>, loads: &mut Loads<R>) {
        for (pin, film) in &self.0 {
            loads.add_contact(*pin, &film.load(&pose.journal(*pin)));
        }
    }

    /// Adds the functions whose zeros are derivative discontinuities of the films' loads.
    pub fn discontinuities(&self, pose: &Pose, discontinuities: &mut Discontinuities) {
        for (pin, film) in &self.0 {
            discontinuities.push(film.discontinuity(&pose.journal(*pin)));
        }
    }

    /// [W] Power lost in the films.
    pub fn loss<R: Real>(&self, pose: &Pose<R>) -> R {
        self.0.iter().fold(R::ZERO, |loss, (pin, film)| loss + film.loss(&pose.journal(*pin)))
    }

    /// [m/s] Velocities of the journals, by which the films are squeezed. Loads are not smooth where one of them is 0.
    pub fn squeeze_velocities<'a>(&'a self, pose: &'a Pose) -> impl Iterator<Item = Vec2> + 'a {
        self.0.iter().map(|(pin, _)| squeeze_velocity(&pose.journal(*pin)))
    }

    /// The load of the film in one joint; zero in a dry joint.
    pub fn load(&self, pin: Pin, pose: &Pose) -> Load {
        let film = self.0.iter().find(|(lubricated, _)| *lubricated == pin);
        film.map_or(Load::default(), |(_, film)| film.load(&pose.journal(pin)))
    }
}
