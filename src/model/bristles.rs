//! The contacts with bristles: those whose friction law has bristles. Each adds one first-order state.

use super::friction::Friction;
use super::joint::guide::guide_contacts;
use crate::scene::{JointModel, Scene};

/// The contacts with bristles: the index of each among all contacts, and the deflection [m] at which its bristles at
/// rest slip.
pub fn bristled_contacts(scene: &Scene) -> Vec<(usize, f64)> {
    let joint = &scene.joint;
    let mut all = Vec::new();
    let mut add = |model: JointModel, friction: &crate::scene::Friction, contacts: std::ops::Range<usize>| {
        if model == JointModel::Clearance
            && let Some(deflection) = Friction::new(friction).max_deflection()
        {
            all.extend(contacts.map(|contact| (contact, deflection)));
        }
    };
    for (index, revolute) in [&joint.a, &joint.b, &joint.c].into_iter().enumerate() {
        add(revolute.model, &revolute.contact.friction, index..index + 1);
    }
    add(joint.t.model, &joint.t.contact.friction, 3..3 + guide_contacts(joint.t.surface));
    all
}
