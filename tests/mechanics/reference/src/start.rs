//! The start: the crank at θ0 and ω0, every joint with clearance at its start eccentricity, and
//! the loop closed with the slider on the +x side.

use crate::beam::mode_count;
use crate::coordinates::{CRANK, Motion, ROD, SLIDER, Vector, perp};
use crate::mechanism::{JointModel, Mechanism, Point, Revolute};
use nalgebra::Rotation2;

pub fn start(mechanism: &Mechanism) -> Motion {
    let eccentricity = |joint: &Revolute| match joint.model {
        JointModel::Ideal => Vector::zeros(),
        JointModel::Clearance => vector(joint.eccentricity_start),
    };
    let joint = &mechanism.joint;
    let [at_a, at_b, at_c] = [&joint.a, &joint.b, &joint.c].map(eccentricity);
    let offset = if joint.t.model == JointModel::Ideal { 0.0 } else { joint.t.offset_start };

    let (crank_angle, crank_speed) = (mechanism.crank.angle_start, mechanism.crank.speed_start);
    let main_journal = at_a;
    let to_pin = Rotation2::new(crank_angle) * Vector::new(mechanism.crank.length, 0.0);
    let big_end = main_journal + to_pin - at_b;
    let pin_height = mechanism.guide.offset + offset - mechanism.slider.centre.y;
    let sine = (pin_height - at_c.y - big_end.y) / mechanism.rod.length;
    let rod_angle = sine.asin();
    let along_rod = Rotation2::new(rod_angle) * Vector::new(mechanism.rod.length, 0.0);
    let slider_pin = big_end + along_rod + at_c;

    // The pin's height stays: 0 = (ω1·perp(to_pin) + ω2·perp(along_rod))_y.
    let rod_speed = -crank_speed * to_pin.x / along_rod.x;
    let big_end_velocity = crank_speed * perp(to_pin);
    let slider_velocity = Vector::new((big_end_velocity + rod_speed * perp(along_rod)).x, 0.0);

    let mut motion = Motion::at_rest();
    let mut place = |body: usize, com: Point, angle: f64, at: Vector, speed: f64, velocity: Vector| {
        let lever = Rotation2::new(angle) * vector(com);
        let (position, velocity) = (at + lever, velocity + speed * perp(lever));
        motion.q.fixed_rows_mut::<3>(3 * body).copy_from_slice(&[position.x, position.y, angle]);
        motion.v.fixed_rows_mut::<3>(3 * body).copy_from_slice(&[velocity.x, velocity.y, speed]);
    };
    place(CRANK, mechanism.crank.com, crank_angle, main_journal, crank_speed, Vector::zeros());
    // A flexible rod's coordinates are its big end's.
    let rod_com = if mode_count(&mechanism.rod.flexible) > 0 { Point::default() } else { mechanism.rod.com };
    place(ROD, rod_com, rod_angle, big_end, rod_speed, big_end_velocity);
    place(SLIDER, mechanism.slider.com, 0.0, slider_pin, 0.0, slider_velocity);
    motion
}

fn vector(point: Point) -> Vector {
    Vector::new(point.x, point.y)
}
