//! The start pose: the crank at θ0 and ω0; every joint with clearance at its given eccentricity with rate 0; rod and
//! slider from the closed loop with those eccentricities, the slider on the +x side.

use super::kinematics::JointVectors;
use super::plane::{Rotation, Vec2, perp};
use crate::math;
use crate::scene::closure::rod_sine;
use crate::scene::{Point, Revolute, Scene};

/// Angles and joint centres at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartPose {
    /// [rad] Angles of crank, rod and slider.
    pub angle: [f64; 3],
    /// [rad/s] Angular velocities of crank, rod and slider.
    pub speed: [f64; 3],
    /// [m] Places of the joint centres.
    pub place: JointVectors,
    /// [m/s] Velocities of the joint centres.
    pub velocity: JointVectors,
}

/// [m] Eccentricity of the journal at the start.
fn eccentricity(joint: &Revolute) -> Vec2 {
    let Point { x, y } = joint.eccentricity_at_start();
    Vec2::new(x, y)
}

impl StartPose {
    /// The start pose of a scene; `None` if the loop does not close.
    pub fn of(scene: &Scene) -> Option<Self> {
        let sine = rod_sine(scene);
        let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
        let closes = cosine > 0.0; // false for NaN, too
        if !closes {
            return None;
        }
        let (theta, omega) = (scene.crank.angle_start, scene.crank.speed_start);
        let crank_arm = Rotation::new(theta).axis(scene.crank.length);
        let rod_arm = scene.rod.length * Vec2::new(cosine, sine);
        let crank = eccentricity(&scene.joint.a);
        let crank_pin = crank + crank_arm;
        let big_end = crank_pin - eccentricity(&scene.joint.b);
        let small_end = big_end + rod_arm;
        let pin = small_end + eccentricity(&scene.joint.c);
        // The pin does not move across the guide: ω·r·cos θ + ω_rod·l·cos φ = 0.
        let rod_speed = -omega * crank_arm.x / rod_arm.x;
        let crank_velocity = omega * perp(crank_arm);
        let pin_velocity = Vec2::new((crank_velocity + rod_speed * perp(rod_arm)).x, 0.0);
        Some(Self {
            angle: [theta, math::atan2(sine, cosine), 0.0],
            speed: [omega, rod_speed, 0.0],
            place: JointVectors { crank, crank_pin, big_end, small_end, pin },
            velocity: JointVectors {
                crank: Vec2::ZERO,
                crank_pin: crank_velocity,
                big_end: crank_velocity,
                small_end: pin_velocity,
                pin: pin_velocity,
            },
        })
    }
}
