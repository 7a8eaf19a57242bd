//! Applied forces: gravity, drive, slider load, viscous friction and contacts.

use super::bodies::{Bodies, CRANK, Motion, Nine, ROD, SLIDER, Vector, cross, push, twist};
use super::contact::Contact;
use super::phase::Phase;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::{DriveMode, Scene};

/// Forces of the joints at one instant, and the generalized forces of everything applied.
pub struct Loads {
    pub generalized: Nine,
    /// Contact force of A, B, C on the journal's body.
    pub on_journal: [Vector; 3],
    /// Viscous and contact force of the guide on the slider.
    pub on_slider: Vector,
    /// Its moment about the pin.
    pub about_pin: f64,
}

pub fn loads(
    scene: &Scene,
    bodies: &Bodies,
    contacts: &[Option<Contact>; 7],
    phases: &[Phase; 7],
    inputs: Inputs,
    motion: &Motion,
) -> Loads {
    let mut sum = Nine::zeros();
    for body in [CRANK, ROD, SLIDER] {
        sum[3 * body + 1] -= bodies.inertia[3 * body] * scene.gravity;
    }
    if scene.drive.mode == DriveMode::Torque {
        sum += twist(CRANK, inputs.crank_torque);
    }
    let pin = bodies.journals[2];
    let along = |force: f64| push(motion, SLIDER, pin.position(motion), force * Vector::x());
    sum += along(inputs.slider_load);

    let joint = &scene.joint;
    for (k, damping) in [joint.a.damping, joint.b.damping, joint.c.damping].into_iter().enumerate() {
        let (bearing, journal) = (bodies.bearings[k].body, bodies.journals[k].body);
        let couple = -damping * (motion.spin(journal) - motion.spin(bearing));
        sum += twist(journal, couple) - twist(bearing, couple);
    }
    let viscous = -joint.t.damping * pin.velocity(motion).x;
    sum += along(viscous);

    let mut loads =
        Loads { generalized: sum, on_journal: [Vector::zeros(); 3], on_slider: viscous * Vector::x(), about_pin: 0.0 };
    for (k, contact) in contacts.iter().enumerate() {
        let Some(contact) = contact else { continue };
        let touch = contact.touch(motion);
        let normal = contact.laws.normal_force(&phases[k], touch.penetration, touch.rate);
        let friction = contact.laws.friction_force(&phases[k], normal, touch.sliding);
        let force = -normal * touch.normal - friction * touch.tangent;
        let (inner, outer) = contact.inner_and_outer();
        loads.generalized += push(motion, inner, touch.point, force);
        if let Some(outer) = outer {
            loads.generalized += push(motion, outer, touch.point, -force);
            loads.on_journal[k] = force;
        } else {
            loads.on_slider += force;
            loads.about_pin += cross(touch.point - pin.position(motion), force);
        }
    }
    loads
}
