//! The penetration that a joint's contact law needs for a force, from the published formulas.

use slidercrank::model::signals::Outputs;
use slidercrank::scene::{Contact, JointModel, Scene};

/// A joint with clearance, at work.
pub struct Play {
    /// A, B, C or T.
    pub letter: char,
    stiffness: f64,
    exponent: f64,
    /// [m] Arm of the couple with which two opposite corners bear a moment; only of the guide.
    arm: f64,
}

/// σ_b + σ_j.
fn compliance(contact: &Contact) -> f64 {
    let sigma = |young: f64, poisson: f64| (1.0 - poisson * poisson) / young;
    sigma(contact.young.bearing, contact.poisson.bearing) + sigma(contact.young.journal, contact.poisson.journal)
}

impl Play {
    /// Those of a scene whose contacts are Hertzian, or of a given stiffness.
    pub fn of(scene: &Scene) -> Vec<Self> {
        let joint = &scene.joint;
        let mut all = vec![];
        for (letter, joint) in [('A', &joint.a), ('B', &joint.b), ('C', &joint.c)] {
            if joint.model == JointModel::Clearance {
                let curvature = (joint.radius * (joint.radius - joint.clearance) / joint.clearance).sqrt();
                let hertz = 4.0 / (3.0 * compliance(&joint.contact)) * curvature;
                all.push(Self::new(letter, &joint.contact, hertz, f64::INFINITY));
            }
        }
        if joint.t.model == JointModel::Clearance {
            let hertz = 4.0 / (3.0 * compliance(&joint.t.contact)) * joint.t.corner_radius.sqrt();
            all.push(Self::new('T', &joint.t.contact, hertz, scene.slider.length));
        }
        all
    }

    fn new(letter: char, contact: &Contact, hertz: f64, arm: f64) -> Self {
        let stiffness = if contact.stiffness > 0.0 { contact.stiffness } else { hertz };
        Self { letter, stiffness, exponent: contact.exponent, arm }
    }

    /// [N] What one contact of the joint may have to bear.
    pub fn force(&self, outputs: &Outputs) -> f64 {
        let [x, y] = match self.letter {
            'A' => outputs.joint_a.force,
            'B' => outputs.joint_b.force,
            'C' => outputs.joint_c.force,
            _ => outputs.joint_t.force,
        };
        x.hypot(y) + outputs.joint_t.moment.abs() / self.arm
    }

    /// [m] How deep the joint is pressed in.
    pub fn depth(&self, outputs: &Outputs) -> f64 {
        match self.letter {
            'A' => outputs.joint_a.penetration,
            'B' => outputs.joint_b.penetration,
            'C' => outputs.joint_c.penetration,
            _ => outputs.joint_t.penetration,
        }
    }

    /// [m] (F/K)^(1/p)
    pub fn depth_of(&self, force: f64) -> f64 {
        (force / self.stiffness).powf(1.0 / self.exponent)
    }
}
