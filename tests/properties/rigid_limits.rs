//! Rigid contacts: order of the steps, and what compliant contacts tend to as they stiffen.

use super::rigid_scenes::{guideplay, rigid, rubbing, wide};
use super::scenes::{Play, at, at_tolerance, inputs, speed_driven, start, with_play};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{DampingLaw, Method, Scene};
use std::f64::consts::TAU;

/// Largest difference of positions [m, rad] and of speeds [m/s, rad/s].
fn apart(one: &Outputs, other: &Outputs) -> (f64, f64) {
    let positions = |o: &Outputs| [o.slider.x, o.slider.y, o.slider.angle, o.crank.angle, o.rod.angle];
    let speeds = |o: &Outputs| [o.slider.v, o.crank.speed, o.rod.speed];
    let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    (largest(&positions(one), &positions(other)), largest(&speeds(one), &speeds(other)))
}

fn run(scene: &Scene, inputs: Inputs, end: f64) -> Outputs {
    at(&mut start(scene, inputs), end)
}

/// Order of positions and of speeds in steps of 2^-14 s and an eighth of it, from their errors.
fn order(errors: [(f64, f64); 2]) -> (f64, f64) {
    let [coarse, fine] = errors;
    ((coarse.0 / fine.0).log(8.0), (coarse.1 / fine.1).log(8.0))
}

const STEPS: [f64; 2] = [1.0 / 16_384.0, 1.0 / 131_072.0];

#[test]
fn where_nothing_touches_the_order_is_two() {
    let inputs = inputs(3.0, -50.0);
    let plays: [Play; 5] =
        [[false; 4], [false, false, true, false], [true, true, false, false], [false, true, true, true], [true; 4]];
    for play in plays {
        for scene in [wide(play), speed_driven(wide(play))] {
            let end = 64.0 * STEPS[0];
            let exact = run(&scene, inputs, end);
            assert_eq!(exact.solver.events, 0);
            let errors = STEPS.map(|step| apart(&run(&rigid(scene.clone(), step), inputs, end), &exact));
            if play == [false; 4] && scene.drive.mode == slidercrank::scene::DriveMode::Speed {
                assert!(errors[0].0 < 1e-12 && errors[0].1 < 1e-12, "nothing is left to integrate: {errors:?}");
                continue;
            }
            let (positions, speeds) = order(errors);
            println!("{play:?}, {:?} drive: {positions:.3}, {speeds:.3}", scene.drive.mode);
            assert!((positions - 2.0).abs() < 0.1 && (speeds - 2.0).abs() < 0.1, "{play:?}: {errors:?}");
        }
    }
}

#[test]
fn where_a_contact_lasts_the_order_is_two() {
    // A heavy slider that never leaves the lower line is one on an ideal guide.
    let end = 1600.0 * STEPS[0];
    let mut ideal = at_tolerance(Scene { gravity: 500.0, ..Scene::default() }, 1e-12);
    ideal.crank.speed_start = 40.0;
    ideal.crank.inertia = 0.05;
    ideal.guide.offset = -5e-4;
    let exact = run(&ideal, Inputs::default(), end);
    let mut worn = rubbing(with_play(ideal, [false, false, false, true]), 0.0, 0.0);
    (worn.guide.offset, worn.joint.t.offset_start) = (0.0, -5e-4);
    let errors = STEPS.map(|step| apart(&run(&rigid(worn.clone(), step), Inputs::default(), end), &exact));
    let (positions, speeds) = order(errors);
    println!("lasting contact: {positions:.2}, {speeds:.2}, {errors:?}");
    assert!(positions > 1.9 && speeds > 1.9, "{errors:?}");
}

/// The first instant, of those that are multiples of `grain` [s], at which a corner touches; outputs there.
fn first_touch(scene: &Scene, grain: f64) -> (f64, Outputs) {
    let mut simulation = start(scene, Inputs::default());
    for i in 1..100_000 {
        let t = grain * f64::from(i);
        let o = at(&mut simulation, t);
        if o.joint_t.contacts > 0 {
            return (t, o);
        }
    }
    unreachable!("no touch at all");
}

#[test]
fn the_published_slider_first_touches_with_both_upper_corners() {
    // P. Flores, R. Leine, C. Glocker, Multibody Syst. Dyn. 23 (2010) 165.
    let step = 1.0 / 1_048_576.0;
    let (time, o) = first_touch(&rigid(guideplay(), step), step);
    assert!(o.joint_t.contacts == 2 && o.joint_t.force[1] < 0.0 && o.slider.y > 0.0, "{o:?}");
    assert!(o.joint_t.moment.abs() < 1e-9 * o.joint_t.force[1].abs(), "no tilt: {:?}", o.joint_t);
    let (compliant_time, compliant) = first_touch(&at_tolerance(guideplay(), 1e-10), 1e-7);
    assert_eq!(compliant.joint_t.contacts, 2);
    assert!((time - compliant_time).abs() < 2.0 * step, "{time} s, {compliant_time} s");
    // Until then both are the same free motion.
    let end = 40.0 * STEPS[0];
    let exact = run(&at_tolerance(guideplay(), 1e-12), Inputs::default(), end);
    let errors = STEPS.map(|step| apart(&run(&rigid(guideplay(), step), Inputs::default(), end), &exact));
    let (positions, speeds) = order(errors);
    assert!((positions - 2.0).abs() < 0.1 && (speeds - 2.0).abs() < 0.1, "{positions}, {speeds}");
    // And it leaves at 0.4 of the speed at which it came.
    let mut simulation = start(&rigid(guideplay(), step), Inputs::default());
    let speeds = [time - 2.0 * step, time].map(|t| {
        at(&mut simulation, t);
        simulation.output_rates().slider.y
    });
    assert!((speeds[1] + 0.4 * speeds[0]).abs() < 1e-3 * speeds[0], "{speeds:?}");
}

/// Differences of compliant runs of ever stiffer contacts to a rigid one, at `end` [s].
fn differences(scene: &Scene, end: f64, stiffnesses: [f64; 3]) -> [(f64, f64); 3] {
    let limit = run(&rigid(scene.clone(), 1e-7), Inputs::default(), end);
    stiffnesses.map(|stiffness| {
        let mut scene = at_tolerance(scene.clone(), 1e-9);
        for contact in super::scenes::contacts(&mut scene) {
            (contact.law, contact.stiffness) = (DampingLaw::ZhangSharf, stiffness);
        }
        scene.solver.method = Method::Verner7;
        apart(&run(&scene, Inputs::default(), end), &limit)
    })
}

#[test]
fn compliant_contacts_tend_to_rigid_ones_as_they_stiffen() {
    // Two impacts of the slider's face on its guide, and four of a pin in its bearing.
    let guide = rubbing(guideplay(), 0.4, 0.0);
    let mut pin = rubbing(speed_driven(with_play(Scene::default(), [false, false, true, false])), 0.9, 0.0);
    pin.crank.speed_start = 5000.0 * TAU / 60.0;
    for (name, scene, end, stiffnesses) in
        [("guide", guide, 6.5e-3, [1e9, 1e11, 1e13]), ("pin", pin, 4e-4, [1e11, 1e13, 1e15])]
    {
        let differences = differences(&scene, end, stiffnesses);
        println!("{name}: {differences:?}");
        for pair in differences.windows(2) {
            // An impact lasts as long as K^-0.4, 6.3 times less for a hundred times the stiffness.
            assert!(pair[1].0 < pair[0].0 / 4.0 && pair[1].1 < pair[0].1 / 4.0, "{name}: {differences:?}");
        }
    }
}
