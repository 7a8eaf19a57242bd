//! Mirrored in the x axis, a mechanism does the mirrored motion, to the last bit.

use super::scenes::{
    all_plays, at, at_tolerance, contacts, crooked, inputs, letters, reals, revolutes, speed_driven, start, with_play,
};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{FrictionLaw, Method, Scene};

/// y → −y: what points along y and what turns changes its sign.
pub fn mirrored(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.gravity *= -1.0;
    scene.crank.angle_start *= -1.0;
    scene.crank.speed_start *= -1.0;
    scene.crank.com.y *= -1.0;
    scene.rod.com.y *= -1.0;
    scene.slider.com.y *= -1.0;
    scene.slider.centre.y *= -1.0;
    scene.guide.offset *= -1.0;
    scene.joint.t.offset_start *= -1.0;
    for joint in revolutes(&mut scene) {
        joint.eccentricity_start.y *= -1.0;
    }
    scene
}

/// The outputs of the mirrored motion.
pub fn mirror(o: &Outputs) -> Outputs {
    let mut o = *o;
    for turned in [
        &mut o.slider.y,
        &mut o.slider.angle,
        &mut o.crank.angle,
        &mut o.crank.speed,
        &mut o.crank.acceleration,
        &mut o.rod.angle,
        &mut o.rod.speed,
        &mut o.joint_t.force[1],
        &mut o.joint_t.moment,
        &mut o.drive_torque,
    ] {
        *turned *= -1.0;
    }
    for joint in [&mut o.joint_a, &mut o.joint_b, &mut o.joint_c] {
        joint.force[1] *= -1.0;
        joint.eccentricity[1] *= -1.0;
    }
    o
}

/// Eccentric starts, friction and viscous terms on top of a mechanism without symmetry.
fn scene() -> Scene {
    let mut scene = at_tolerance(crooked(), 1e-7);
    for (i, joint) in revolutes(&mut scene).into_iter().enumerate() {
        let i = i as f64;
        (joint.eccentricity_start.x, joint.eccentricity_start.y) = (1e-4 - 5e-5 * i, 2e-4 - 1e-4 * i);
        joint.damping = 1e-4;
    }
    scene.joint.t.offset_start = 1e-4;
    for contact in contacts(&mut scene) {
        contact.friction.law = FrictionLaw::Ambrosio;
        contact.friction.coefficient = 0.1;
    }
    scene
}

#[test]
fn the_mirrored_mechanism_moves_as_the_mirror_image_to_the_bit() {
    for play in all_plays() {
        for method in [Method::Verner7, Method::Dopri5, Method::Dop853, Method::Rk4] {
            for drive in [|scene: Scene| scene, speed_driven] {
                let mut scene = drive(with_play(scene(), play));
                scene.solver.method = method;
                let mut one = start(&scene, inputs(3.0, -50.0));
                let mut other = start(&mirrored(&scene), inputs(-3.0, -50.0));
                let end = if method == Method::Rk4 { 10 } else { 60 };
                for i in 0..=end {
                    let t = 3e-4 * f64::from(i);
                    let (one, other) = (at(&mut one, t), mirror(&at(&mut other, t)));
                    assert_eq!(one.solver, other.solver, "{} {method:?} at {t}", letters(play));
                    for ((name, one), (_, other)) in reals(&one).into_iter().zip(reals(&other)) {
                        // 0 and −0 are the same place.
                        assert!(one == other, "{} {method:?} {name} at {t}: {one:e} and {other:e}", letters(play));
                    }
                }
            }
        }
    }
}

#[test]
fn a_symmetric_mechanism_that_starts_straight_stays_straight() {
    for play in all_plays() {
        let scene = at_tolerance(with_play(Scene::default(), play), 1e-8);
        let mut simulation = start(&scene, inputs(0.0, 100.0));
        for i in 0..=100 {
            let o = at(&mut simulation, 1e-4 * f64::from(i));
            let across = [o.slider.y, o.slider.angle, o.crank.angle, o.rod.angle, o.joint_t.moment, o.joint_c.force[1]];
            assert_eq!(across, [0.0; 6], "{}", letters(play));
        }
        // The guide's corners are four and no line of symmetry moves them.
        assert_eq!(simulation.outputs().joint_t.contacts, 0);
    }
}

#[test]
fn at_rest_without_inputs_nothing_moves() {
    for play in all_plays() {
        let mut scene = with_play(crooked(), play);
        (scene.crank.speed_start, scene.gravity) = (0.0, 0.0);
        let mut simulation = start(&scene, Inputs::default());
        let first = reals(&simulation.outputs());
        assert_eq!(reals(&at(&mut simulation, 0.5)), first, "{}", letters(play));
    }
}
