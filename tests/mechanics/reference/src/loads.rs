//! Applied forces: drive, slider load, viscous friction, contacts, and the rod's elasticity.

use crate::bodies::Bodies;
use crate::contact::{Contact, eccentricity};
use crate::coordinates::{Bristles, CONTACTS, Coordinates, Motion, Vector, cross};
use crate::film::Pressed;
use crate::mechanism::{DriveMode, Mechanism};
use crate::phase::Phase;
use crate::signals::Inputs;

/// Forces of the joints at one instant, and the generalized forces of everything applied.
pub struct Loads {
    pub generalized: Coordinates,
    /// Contact force of A, B, C on the journal's body.
    pub on_journal: [Vector; 3],
    /// Viscous and contact force of the guide on the slider.
    pub on_slider: Vector,
    /// Its moment about the pin.
    pub about_pin: f64,
    /// [m/s] ż of each contact.
    pub bristle_rates: Bristles,
    /// [W] What the contacts' hysteresis takes.
    pub contact_loss: f64,
    /// [W]
    pub friction_loss: f64,
    /// [W]
    pub viscous_loss: f64,
    /// [N, N·m] Force and moment of the oil on the journals of A, B, C.
    pub films: [(Vector, f64); 3],
}

pub fn loads(
    mechanism: &Mechanism,
    bodies: &Bodies,
    contacts: &[Option<Contact>; CONTACTS],
    phases: &[Phase; CONTACTS],
    inputs: Inputs,
    motion: &Motion,
) -> Loads {
    let mut sum = bodies.beam.as_ref().map_or(Coordinates::zeros(), |beam| beam.inner_forces(motion));
    if mechanism.drive.mode == DriveMode::Torque {
        sum += bodies.crank.twist(inputs.crank_torque);
    }
    let pin = &bodies.journals[2];
    let along = |force: f64| pin.push(motion, pin.position(motion), force * Vector::x());
    let loaded = &bodies.loaded;
    sum += loaded.push(motion, loaded.position(motion), inputs.slider_load * Vector::x());

    let joint = &mechanism.joint;
    let mut viscous_loss = 0.0;
    for (k, damping) in [joint.a.damping, joint.b.damping, joint.c.damping].into_iter().enumerate() {
        let (bearing, journal) = (&bodies.bearings[k], &bodies.journals[k]);
        let turning = journal.spin(motion) - bearing.spin(motion);
        let couple = -damping * turning;
        sum += journal.twist(couple) - bearing.twist(couple);
        viscous_loss -= couple * turning;
    }
    let along_guide = pin.velocity(motion).x;
    let viscous = -joint.t.damping * along_guide;
    sum += along(viscous);
    viscous_loss -= viscous * along_guide;

    let mut loads = Loads {
        generalized: sum,
        on_journal: [Vector::zeros(); 3],
        on_slider: viscous * Vector::x(),
        about_pin: 0.0,
        bristle_rates: Bristles::zeros(),
        contact_loss: 0.0,
        friction_loss: 0.0,
        viscous_loss,
        films: [(Vector::zeros(), 0.0); 3],
    };
    for (k, film) in bodies.films.iter().enumerate() {
        let (Some(film), Some(_)) = (film, &contacts[k]) else { continue };
        let (bearing, journal) = (&bodies.bearings[k], &bodies.journals[k]);
        let (e, rate) = (eccentricity(bearing, journal, motion), journal.velocity(motion) - bearing.velocity(motion));
        let Pressed { force, couples, loss } = film.pressed(e, rate, [journal.spin(motion), bearing.spin(motion)]);
        loads.generalized += journal.push(motion, journal.position(motion), force) + journal.twist(couples[0]);
        loads.generalized += bearing.push(motion, bearing.position(motion), -force) + bearing.twist(couples[1]);
        loads.on_journal[k] = force;
        loads.films[k] = (force, couples[0]);
        loads.viscous_loss += loss;
    }
    for (k, contact) in contacts.iter().enumerate() {
        let (Some(contact), phase) = (contact, &phases[k]) else { continue };
        if !phase.closed() {
            continue;
        }
        let (touch, bristle) = (contact.touch(motion, phase), motion.bristles[k]);
        let normal = contact.laws.normal_force(phase, touch.elastic, touch.rate);
        let friction = contact.laws.friction_force(phase, normal, touch.sliding, bristle);
        let force = -normal * touch.normal - friction * touch.tangent;
        loads.generalized += contact.push(motion, touch.point, force);
        if k < 3 {
            loads.on_journal[k] += force;
        } else {
            loads.on_slider += force;
            loads.about_pin += cross(touch.point - pin.position(motion), force);
        }
        loads.bristle_rates[k] = contact.laws.bristle_rate(phase, touch.sliding, bristle);
        loads.contact_loss += (normal - touch.elastic) * touch.rate;
        loads.friction_loss += friction * touch.sliding;
    }
    loads
}
