//! The same motion told in two ways.

use super::scenes::{
    Play, all_plays, at, at_tolerance, contacts, crooked, elastic, inputs, letters, reals, revolutes, speed_driven,
    start, with_play, worst_difference,
};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{DampingLaw, Elasticity, FrictionLaw, Lubrication, Scene};
use slidercrank::simulation::Simulation;

/// Outputs of both over the first impacts, every 50 µs to 6 ms.
/// Outputs of two mechanisms at the same times.
pub fn side_by_side(one: &mut Simulation, other: &mut Simulation) -> Vec<(Outputs, Outputs)> {
    let times = (0..=120).map(|i| 5e-5 * f64::from(i));
    times.map(|t| (at(one, t), at(other, t))).collect()
}

fn rubbing(play: Play) -> Scene {
    let mut scene = with_play(crooked(), play);
    for contact in contacts(&mut scene) {
        contact.friction.law = FrictionLaw::Tanh;
    }
    at_tolerance(scene, 1e-11)
}

const INPUTS: Inputs = Inputs { crank_torque: 3.0, slider_load: -50.0 };

/// Differences of one rounding, amplified by the impacts of 6 ms.
const AMPLIFIED: f64 = 1e-7;

#[test]
fn with_an_ideal_guide_the_offset_may_be_the_guide_s_or_the_slider_s() {
    for play in all_plays().filter(|play| !play[3]) {
        let one = rubbing(play);
        let mut other = one.clone();
        (other.guide.offset, other.slider.centre.y) = (0.0, one.slider.centre.y - one.guide.offset);
        let pairs = side_by_side(&mut start(&one, INPUTS), &mut start(&other, INPUTS));
        let (error, what) = worst_difference(&pairs);
        println!("{}: {error:.1e} in {what}", letters(play));
        assert!(error < AMPLIFIED, "{}: {error:e} in {what}", letters(play));
    }
}

#[test]
fn with_an_ideal_guide_the_slider_s_centre_of_mass_moves_nothing_but_the_moment() {
    for play in all_plays().filter(|play| !play[3]) {
        let one = rubbing(play);
        let mut other = one.clone();
        (other.slider.com.x, other.slider.com.y, other.slider.inertia) = (-0.02, 0.03, 7.0);
        let pairs = side_by_side(&mut start(&one, INPUTS), &mut start(&other, INPUTS));
        for (mut one, mut other) in pairs {
            // M = com × m·(a + g): the guide holds what the pin does not.
            let moment = |o: &Outputs, x: f64, y: f64| 0.14 * (x * 9.81 - y * o.slider.a);
            let wanted = moment(&one, -0.026, 0.026);
            let found = other.joint_t.moment - one.joint_t.moment;
            assert!((found - wanted).abs() < 1e-12 * (1.0 + wanted.abs()), "{}: {found}, not {wanted}", letters(play));
            (one.joint_t.moment, other.joint_t.moment) = (0.0, 0.0);
            assert_eq!(reals(&one), reals(&other), "{}", letters(play));
        }
    }
}

#[test]
fn the_slider_s_frame_may_be_anywhere_along_the_guide() {
    // A rectangle shifted along the slider with its centre of mass, under a pin with a clearance too wide to
    // be met: the corners are where they were, relative to the centre of mass.
    let mut one = rubbing([false, false, true, true]);
    (one.joint.c.radius, one.joint.c.clearance, one.gravity) = (0.2, 0.1, 300.0);
    one.slider.com.x = 0.0;
    one.slider.centre.x = -0.008;
    let mut other = one.clone();
    other.slider.com.x += 0.004;
    other.slider.centre.x += 0.004;
    let (mut one, mut other) = (start(&one, Inputs::default()), start(&other, Inputs::default()));
    let mut touched = 0;
    for (one, other) in side_by_side(&mut one, &mut other) {
        touched = touched.max(one.joint_t.contacts);
        for (what, one, other, size) in [
            ("angle", one.slider.angle, other.slider.angle, 0.1),
            ("force", one.joint_t.force[1], other.joint_t.force[1], 1e3),
            ("place", one.slider.x, other.slider.x + 0.004 * other.slider.angle.cos(), 0.1),
            ("height", one.slider.y, other.slider.y + 0.004 * other.slider.angle.sin(), 0.1),
        ] {
            // The pin of the first is 4 mm ahead of the same place of the second's.
            let other = if what == "place" { other - 0.004 } else { other };
            assert!((one - other).abs() < AMPLIFIED * size, "{what}: {one} and {other}");
        }
    }
    assert!(touched > 0, "it falls onto the guide");
}

#[test]
fn a_speed_drive_is_a_torque_drive_with_an_endless_flywheel() {
    let scene = rubbing([false, false, true, false]);
    let mut last = f64::INFINITY;
    for inertia in [1e2, 1e4, 1e6] {
        let mut heavy = scene.clone();
        heavy.crank.inertia = inertia;
        let mut worst = 0.0f64;
        let mut driven = start(&speed_driven(scene.clone()), INPUTS);
        for (one, other) in side_by_side(&mut driven, &mut start(&heavy, INPUTS)) {
            worst = worst.max((one.slider.x - other.slider.x).abs());
        }
        println!("inertia {inertia:e}: {worst:.1e} m");
        assert!(worst < 0.02 * last && worst < 1e-4 / inertia, "inertia {inertia:e}: {worst:e} m");
        last = worst;
    }
}

#[test]
fn a_crank_too_heavy_to_be_moved_is_held_like_an_ideal_main_bearing() {
    // The main bearing's clearance is not closed within the run: the crank turns about its centre of mass.
    let mut scene = speed_driven(rubbing([false, false, true, false]));
    (scene.crank.com.x, scene.crank.com.y, scene.gravity) = (0.0, 0.0, 0.0);
    let held = |scene: &Scene| start(scene, INPUTS);
    let mut last = f64::INFINITY;
    for mass in [1e3, 1e5, 1e7] {
        let mut heavy = with_play(scene.clone(), [true, false, true, false]);
        heavy.crank.mass = mass;
        let mut worst = 0.0f64;
        for (one, other) in side_by_side(&mut held(&scene), &mut held(&heavy)) {
            assert!(!other.joint_a.contact);
            worst = worst.max((one.slider.x - other.slider.x).abs());
        }
        println!("mass {mass:e}: {worst:.1e} m");
        assert!(worst < 0.02 * last, "mass {mass:e}: {worst:e} m after {last:e} m");
        last = worst;
    }
}

/// The scene in which every length is `length` times, every mass `mass` times and every time `time` times as
/// large.
fn scaled(scene: &Scene, length: f64, mass: f64, time: f64) -> Scene {
    let mut s = scene.clone();
    let inertia = mass * length * length;
    let force = mass * length / (time * time);
    let speed = length / time;
    s.gravity *= length / (time * time);
    s.crank.speed_start /= time;
    s.crank.length *= length;
    s.rod.length *= length;
    for (m, j, com) in [
        (&mut s.crank.mass, &mut s.crank.inertia, &mut s.crank.com),
        (&mut s.rod.mass, &mut s.rod.inertia, &mut s.rod.com),
        (&mut s.slider.mass, &mut s.slider.inertia, &mut s.slider.com),
    ] {
        *m *= mass;
        *j *= inertia;
        com.x *= length;
        com.y *= length;
    }
    s.slider.length *= length;
    s.slider.height *= length;
    s.slider.centre.x *= length;
    s.slider.centre.y *= length;
    s.slider.load_offset *= length;
    s.guide.offset *= length;
    s.joint.t.clearance *= length;
    s.joint.t.corner_radius *= length;
    s.joint.t.offset_start *= length;
    s.joint.t.damping *= mass / time;
    for joint in revolutes(&mut s) {
        joint.radius *= length;
        joint.clearance *= length;
        joint.layer.thickness *= length;
        joint.viscosity *= mass / (length * time);
        joint.roughness *= length;
        joint.layer.stiffness *= force / length.powi(3);
        joint.damping *= inertia / time;
        joint.eccentricity_start.x *= length;
        joint.eccentricity_start.y *= length;
    }
    for contact in contacts(&mut s) {
        contact.young.bearing *= force / (length * length);
        contact.young.journal *= force / (length * length);
        contact.stiffness *= force / length.powf(contact.exponent);
        contact.width *= length;
        contact.speed_floor *= speed;
        contact.friction.v0 *= speed;
        contact.friction.v1 *= speed;
        contact.friction.v_stribeck *= speed;
    }
    s
}

#[test]
fn other_units_of_length_mass_and_time_tell_the_same_motion() {
    let (length, mass, time) = (1.7, 30.0, 2.5);
    let force = mass * length / (time * time);
    for (what, elasticity, exponent) in [
        ("hertz", Elasticity::Hertz, 1.5),
        ("power", Elasticity::Hertz, 1.8),
        ("liu", Elasticity::Liu, 1.5),
        ("bai-zhao", Elasticity::BaiZhao, 1.5),
        ("winkler", Elasticity::Winkler, 1.5),
        ("oil", Elasticity::Hertz, 1.5),
    ] {
        for play in [[true, true, true, true], [false, false, true, false], [false, false, false, true]] {
            let mut scene = rubbing(play);
            for joint in revolutes(&mut scene) {
                joint.elasticity = elasticity;
                joint.damping = 1e-3;
                if what == "oil" {
                    joint.lubrication = Lubrication::ShortBearing;
                    (joint.viscosity, joint.roughness) = (2e-3, 0.05 * joint.clearance);
                }
                joint.contact.friction.law = FrictionLaw::Stribeck;
                if exponent != 1.5 {
                    (joint.contact.exponent, joint.contact.stiffness) = (exponent, 1e12);
                }
            }
            scene.joint.t.damping = 3.0;
            let mut one = start(&scene, INPUTS);
            let loads = inputs(INPUTS.crank_torque * force * length, INPUTS.slider_load * force);
            let mut other = start(&scaled(&scene, length, mass, time), loads);
            let mut worst = 0.0f64;
            for i in 0..=80 {
                let t = 5e-5 * f64::from(i);
                let (one, other) = (at(&mut one, t), at(&mut other, t * time));
                for (what, one, other, size) in [
                    ("slider.x", one.slider.x, other.slider.x / length, 0.1),
                    ("slider.v", one.slider.v, other.slider.v / length * time, 10.0),
                    ("rod.angle", one.rod.angle, other.rod.angle, 1.0),
                    ("slider.angle", one.slider.angle, other.slider.angle, 0.1),
                    ("joint.C.force", one.joint_c.force[0], other.joint_c.force[0] / force, 1e4),
                    ("joint.T.moment", one.joint_t.moment, other.joint_t.moment / force / length, 1e2),
                ] {
                    worst = worst.max((one - other).abs() / size);
                    // Steps differ, so that errors of the tolerance 1e-11 differ, and impacts amplify them.
                    assert!((one - other).abs() < 1e-5 * size, "{} {what} at {t}: {one} and {other}", letters(play));
                }
            }
            println!("{what} {}: {worst:.1e}", letters(play));
        }
    }
}

#[test]
fn what_an_ideal_joint_does_not_use_changes_nothing() {
    for play in all_plays() {
        let one = rubbing(play);
        let mut other = one.clone();
        for (joint, clear) in revolutes(&mut other).into_iter().zip(play) {
            if !clear {
                (joint.radius, joint.clearance, joint.elasticity) = (0.03, 1e-5, Elasticity::Liu);
                (joint.eccentricity_start.x, joint.eccentricity_start.y) = (1e-3, -1e-3);
                (joint.contact.stiffness, joint.contact.law) = (1e5, DampingLaw::Flores);
            }
        }
        if !play[3] {
            (other.joint.t.clearance, other.joint.t.offset_start, other.joint.t.corner_radius) = (1e-6, 1e-3, 1.0);
            (other.slider.length, other.slider.height, other.slider.centre.x) = (1.0, 2.0, 3.0);
        }
        for (one, other) in side_by_side(&mut start(&one, INPUTS), &mut start(&other, INPUTS)) {
            assert_eq!(one, other, "{}", letters(play));
        }
    }
}

#[test]
fn hertz_is_hunt_and_crossley_at_full_restitution() {
    for play in [[true; 4], [false, true, false, false]] {
        let one = elastic(rubbing(play));
        let mut other = one.clone();
        for contact in contacts(&mut other) {
            (contact.law, contact.restitution) = (DampingLaw::HuntCrossley, 1.0);
        }
        for (one, other) in side_by_side(&mut start(&one, INPUTS), &mut start(&other, INPUTS)) {
            assert_eq!(one, other, "{}", letters(play));
        }
    }
}
