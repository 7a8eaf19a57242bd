//! What a motion without losses keeps: energy; and momentum, while nothing touches the ground.

use super::bodies::{CRANK, ROD, SLIDER, Vector, cross};
use super::solver::Reference;

impl Reference {
    /// [J] Kinetic energy, height and elastic contacts.
    pub fn energy(&self) -> f64 {
        let (motion, inertia) = (&self.motion, &self.bodies.inertia);
        let kinetic = 0.5 * motion.v.component_mul(inertia).dot(&motion.v);
        let weight = |body: usize| inertia[3 * body] * self.scene.gravity;
        let height: f64 = [CRANK, ROD, SLIDER].map(|body| weight(body) * motion.centre_of_mass(body).y).iter().sum();
        let elastic =
            |contact: &super::contact::Contact| contact.laws.elastic_energy(contact.touch(motion).penetration);
        kinetic + height + self.contacts.iter().flatten().map(elastic).sum::<f64>()
    }

    /// [kg·m/s, kg·m/s, kg·m²/s] Of all bodies; angular about the origin.
    pub fn momentum(&self) -> [f64; 3] {
        let (motion, inertia) = (&self.motion, &self.bodies.inertia);
        let momenta = motion.v.component_mul(inertia);
        let mut sum = [0.0; 3];
        for body in [CRANK, ROD, SLIDER] {
            let linear = Vector::new(momenta[3 * body], momenta[3 * body + 1]);
            sum[0] += linear.x;
            sum[1] += linear.y;
            sum[2] += cross(motion.centre_of_mass(body), linear) + momenta[3 * body + 2];
        }
        sum
    }
}
