//! Gravity in any direction, and a load beside the slider's pin.

use super::metamorphic::side_by_side;
use super::scenes::{
    all_plays, at_tolerance, crooked, inputs, letters, speed_driven, start, with_play, worst_difference,
};
use slidercrank::model::signals::Outputs;
use slidercrank::scene::Scene;

/// At rest with the crank at 1 rad and speed 0, all joints ideal.
fn at_rest(scene: Scene) -> Outputs {
    let mut scene = speed_driven(Scene { gravity: 9.81, ..scene });
    (scene.crank.angle_start, scene.crank.speed_start, scene.energy.audit) = (1.0, 0.0, true);
    start(&scene, inputs(0.0, 0.0)).outputs()
}

/// The torque that holds the crank is dV/dθ; the numbers follow from the heights of the centres of mass by hand.
#[test]
fn a_mechanism_at_rest_carries_its_weight_in_any_direction() {
    for (angle, torque, guide, bearing, potential) in [
        (0.0, 0.230678944828, -0.899799447085, -6.3765, -0.402614754791),
        (0.7, 0.132896975382, -2.236549577617, -4.877016207220, -0.375740073164),
    ] {
        let found = at_rest(Scene { gravity_angle: angle, ..Scene::default() });
        for (what, found, wanted) in [
            ("drive.torque", found.drive_torque, torque),
            ("joint.T.force.y", found.joint_t.force[1], guide),
            ("joint.A.force.x", found.joint_a.force[0], bearing),
            ("energy.potential", found.energy.potential, potential),
        ] {
            assert!((found - wanted).abs() < 2e-12 * wanted.abs().max(1.0), "{angle}: {what} = {found}, not {wanted}");
        }
    }
}

#[test]
fn at_the_default_nothing_falls_along_the_guide() {
    // The cosine of the default is not exactly 0: it would push an ideal slider by 6e-16 m/s².
    let mut scene = Scene { gravity: 9.81, ..Scene::default() };
    scene.crank.com.x = 0.0;
    assert_eq!(start(&scene, inputs(0.0, 0.0)).outputs().slider.a, 0.0);
}

/// Everything falls with the bodies: in parts that touch nothing, only places change.
#[test]
fn free_bodies_fall_with_gravity() {
    let mut scene = with_play(Scene { gravity: 9.81, gravity_angle: 0.7, ..Scene::default() }, [true; 4]);
    scene.crank.speed_start = 0.0;
    let outputs = start(&scene, inputs(0.0, 0.0)).outputs();
    assert!((outputs.slider.a - 9.81 * 0.7f64.cos()).abs() < 1e-14, "{}", outputs.slider.a);
    assert_eq!([outputs.crank.acceleration, outputs.joint_a.force[0], outputs.joint_b.force[1]], [0.0; 3]);
}

/// y → −y turns gravity to the other side of the guide.
#[test]
fn gravity_may_be_mirrored_in_the_guide() {
    for play in all_plays() {
        let mut one = at_tolerance(with_play(crooked(), play), 1e-11);
        (one.gravity, one.gravity_angle) = (300.0, 0.7);
        let mut other = super::symmetry::mirrored(&one);
        (other.gravity, other.gravity_angle) = (300.0, -0.7);
        let load = inputs(3.0, -50.0);
        let turned = inputs(-3.0, -50.0);
        let mut pairs = side_by_side(&mut start(&one, load), &mut start(&other, turned));
        pairs.iter_mut().for_each(|(_, other)| *other = super::symmetry::mirror(other));
        let (error, what) = worst_difference(&pairs);
        assert!(error < 1e-7, "{}: {error:e} in {what}", letters(play));
    }
}

#[test]
fn a_load_beside_the_pin_is_a_couple_that_an_ideal_guide_holds() {
    let load = inputs(3.0, -500.0);
    let centred = start(&Scene::default(), load).outputs();
    let mut scene = Scene::default();
    scene.slider.load_offset = 0.01;
    let mut beside = start(&scene, load).outputs();
    assert!((beside.joint_t.moment - centred.joint_t.moment + 5.0).abs() < 1e-13, "{}", beside.joint_t.moment);
    beside.joint_t.moment = centred.joint_t.moment;
    assert_eq!(beside, centred);
    scene.slider.load_offset = 0.021;
    let refused = scene.check().expect_err("more than its height").to_string();
    assert!(refused.contains("slider.load.offset = 0.021") && refused.contains("slider.height = 0.02"), "{refused}");
}
