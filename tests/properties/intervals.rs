//! What lies between two communication points: largest forces, approach speeds, sliding and its works.

use super::scenes::{
    all_plays, at, at_tolerance, contacts, crooked, inputs, letters, revolutes, speed_driven, start, with_play,
};
use slidercrank::model::signals::Outputs;
use slidercrank::scene::{DampingLaw, FrictionLaw, JointModel, Joints, Lubrication, Method, Point, Scene, Surface};
use slidercrank::simulation::Simulation;

fn audited(mut scene: Scene) -> Scene {
    let joint = &mut scene.joint;
    for audit in [&mut joint.a.peak, &mut joint.b.peak, &mut joint.c.peak, &mut joint.t.peak] {
        audit.audit = true;
    }
    for audit in [&mut joint.a.wear, &mut joint.b.wear, &mut joint.c.wear, &mut joint.t.wear] {
        audit.audit = true;
    }
    scene
}

fn near(found: f64, wanted: f64, tolerance: f64, what: &str) {
    assert!((found - wanted).abs() <= tolerance * wanted.abs(), "{what}: {found:e}, not {wanted:e}");
}

/// Play in C, 5000 rpm, everything else as declared.
fn first_blow(tolerance: f64) -> Simulation {
    let mut scene = audited(speed_driven(Scene::default()));
    scene.crank.speed_start = 5000.0 * std::f64::consts::TAU / 60.0;
    scene.joint.c.model = JointModel::Clearance;
    start(&at_tolerance(scene, tolerance), inputs(0.0, 0.0))
}

fn peaks(o: &Outputs) -> [f64; 4] {
    [o.joint_a.interval, o.joint_b.interval, o.joint_c.interval, o.joint_t.interval].map(|interval| interval.force_peak)
}

/// Numbers of an independent simulator at a tolerance of 1e-12.
#[test]
fn the_first_blow_has_its_known_peak_and_work() {
    let mut simulation = first_blow(1e-12);
    let begun = at(&mut simulation, 2e-4);
    near(begun.joint_a.interval.force_peak, 5534.517746, 1e-9, "A at the left end");
    near(begun.joint_b.interval.force_peak, 3478.350162, 1e-9, "B at the left end");
    assert_eq!((begun.joint_c.interval.impacts, begun.joint_c.interval.impact_speed), (0, 0.0));
    let struck = at(&mut simulation, 4e-4);
    for (what, found, wanted) in [
        ("A", struck.joint_a.interval.force_peak, 51293.70449),
        ("B", struck.joint_b.interval.force_peak, 49272.43062),
        ("C", struck.joint_c.interval.force_peak, 45872.77569),
        ("T", struck.joint_t.interval.force_peak, 2065.985487),
        ("speed", struck.joint_c.interval.impact_speed, 4.385783145),
        ("sliding", struck.joint_c.interval.sliding, 9.078928700e-5),
        ("wear.work", struck.joint_c.interval.wear_work, 2.259022990),
        ("power", struck.drive_power, 19868.33336),
    ] {
        near(found, wanted, 2e-9, what);
    }
    assert_eq!(struck.joint_c.interval.impacts, 1);
}

/// A journal that starts in the rough zone of its oil film is thrown out of it within microseconds: the contact stays, its
/// force comes to 0 within a step. Numbers of an independent simulator at a tolerance of 1e-13.
#[test]
fn work_in_a_contact_whose_force_ceases_within_a_step_is_exact() {
    let mut scene = audited(speed_driven(Scene::default()));
    (scene.crank.angle_start, scene.crank.speed_start) = (1.450721935564376, 330.30576270036585);
    let joint = &mut scene.joint.c;
    (joint.model, joint.clearance, joint.roughness) =
        (JointModel::Clearance, 0.00012450694170394565, 6.840567619813592e-06);
    joint.eccentricity_start = Point { x: -0.00010480017412949283, y: 5.475371379176455e-05 };
    (joint.contact.law, joint.contact.restitution) = (DampingLaw::HuGuo, 0.3174031369701688);
    (joint.lubrication, joint.viscosity) = (Lubrication::ShortBearing, 0.04000971726885484);
    (joint.contact.friction.law, joint.contact.friction.coefficient) = (FrictionLaw::Tanh, 0.1);
    for (method, tolerance, within) in
        [(Method::Automatic, 1e-6, 5e-6), (Method::Automatic, 1e-10, 3e-8), (Method::Radau13, 1e-10, 3e-8)]
    {
        scene.solver.method = method;
        let mut simulation = start(&at_tolerance(scene.clone(), tolerance), inputs(0.0, 801.8009835012454));
        let there = at(&mut simulation, 4e-3).joint_c.interval;
        near(there.wear_work, 7.467976498647e-6, within, "wear.work");
        near(there.sliding, 1.469065895553e-5, within, "sliding");
    }
}

#[test]
fn the_largest_of_an_interval_is_the_largest_of_its_parts() {
    let whole = peaks(&at(&mut first_blow(1e-8), 1e-3));
    for parts in [2, 7, 100] {
        let mut simulation = first_blow(1e-8);
        let mut largest = [0.0f64; 4];
        for part in 1..=parts {
            let peaks = peaks(&at(&mut simulation, 1e-3 * f64::from(part) / f64::from(parts)));
            largest = std::array::from_fn(|joint| largest[joint].max(peaks[joint]));
        }
        assert_eq!(largest.map(f64::to_bits), whole.map(f64::to_bits), "{parts} parts: {largest:?}, {whole:?}");
    }
}

/// Whatever a force comes from (a contact, an oil film, viscous friction, the reaction of an ideal joint), and whether other
/// joints are watched with it.
#[test]
fn the_largest_force_is_that_of_dense_samples() {
    for (play, oil) in all_plays().flat_map(|play| [(play, false), (play, true)]) {
        let mut scene = at_tolerance(with_play(crooked(), play), 1e-8);
        if oil {
            scene.joint.t.damping = 50.0;
            for (joint, _) in revolutes(&mut scene).into_iter().zip(play).filter(|(_, clear)| *clear) {
                (joint.lubrication, joint.viscosity) = (Lubrication::ShortBearing, 0.05);
            }
        }
        let what = |joint: usize| format!("{}, oil: {oil}, joint {joint}", letters(play));
        let mut dense = start(&scene, inputs(3.0, -50.0));
        let mut largest = dense.outputs().joint_forces();
        let times = (1..=3000).map(|k| 5e-7 * f64::from(k));
        for forces in times.map(|time| at(&mut dense, time).joint_forces()) {
            largest = std::array::from_fn(|joint| largest[joint].max(forces[joint]));
        }
        let all = peaks(&at(&mut start(&audited(scene.clone()), inputs(3.0, -50.0)), 1.5e-3));
        for joint in 0..4 {
            let above = all[joint] / largest[joint].max(1e-9) - 1.0;
            assert!((-1e-12..1e-3).contains(&above) || all[joint] == largest[joint], "{}: {above:e}", what(joint));
            let mut alone = scene.clone();
            let Joints { a, b, c, t } = &mut alone.joint;
            [&mut a.peak, &mut b.peak, &mut c.peak, &mut t.peak][joint].audit = true;
            let found = peaks(&at(&mut start(&alone, inputs(3.0, -50.0)), 1.5e-3))[joint];
            assert!((found - all[joint]).abs() <= 1e-12 * all[joint], "{}: {found:e}", what(joint));
        }
    }
}

#[test]
fn integrals_do_not_depend_on_communication_points() {
    let whole = at(&mut first_blow(1e-8), 1e-3).joint_c.interval;
    let mut simulation = first_blow(1e-8);
    for part in 1..100 {
        at(&mut simulation, 1e-5 * f64::from(part));
    }
    let parts = at(&mut simulation, 1e-3).joint_c.interval;
    assert_eq!(parts.sliding.to_bits(), whole.sliding.to_bits());
    assert_eq!(parts.wear_work.to_bits(), whole.wear_work.to_bits());
}

/// A journal that hangs at rest in its bearing while it turns, on a linear contact.
#[test]
fn a_resting_journal_slides_its_circumference() {
    let mut scene =
        audited(speed_driven(with_play(Scene { gravity: 9.81, ..Scene::default() }, [true, false, false, false])));
    (scene.crank.mass, scene.crank.com, scene.crank.speed_start) = (2.0, Point::default(), 200.0);
    for mass in [&mut scene.rod.mass, &mut scene.rod.inertia, &mut scene.slider.mass, &mut scene.slider.inertia] {
        *mass = 1e-9;
    }
    let a = &mut scene.joint.a;
    (a.radius, a.clearance, a.contact.stiffness, a.contact.exponent) = (0.01, 1e-4, 1e9, 1.0);
    a.contact.law = slidercrank::scene::DampingLaw::Hertz;
    let depth = 2.0 * 9.81 / 1e9;
    a.eccentricity_start = Point { x: 0.0, y: -(1e-4 + depth) };
    let turn = std::f64::consts::TAU / 200.0;
    let end = at(&mut start(&at_tolerance(scene, 1e-10), inputs(0.0, 0.0)), turn).joint_a.interval;
    near(end.sliding, (0.01 - 1e-4 - depth) * std::f64::consts::TAU, 1e-6, "sliding");
    near(end.wear_work, 1.220430929, 1e-6, "wear.work");
    assert_eq!((end.impacts, end.friction_work), (0, 0.0));
}

/// Without damping and viscous friction all that is lost is lost to friction.
#[test]
fn works_of_friction_add_up_to_the_loss() {
    for play in all_plays().filter(|play| play.contains(&true)) {
        let mut scene = audited(with_play(crooked(), play));
        for contact in contacts(&mut scene) {
            contact.friction.law = FrictionLaw::Tanh;
            contact.law = slidercrank::scene::DampingLaw::Hertz;
        }
        scene.energy.audit = true;
        let outputs = at(&mut start(&at_tolerance(scene.clone(), 1e-10), inputs(3.0, -50.0)), 3e-3);
        let all =
            [outputs.joint_a.interval, outputs.joint_b.interval, outputs.joint_c.interval, outputs.joint_t.interval];
        let works: f64 = all.iter().map(|interval| interval.friction_work).sum();
        let lost = outputs.energy.friction_loss;
        assert!((works - lost).abs() < 1e-7 * lost.abs().max(1e-6), "{}: {works:e}, not {lost:e}", letters(play));
        for interval in all {
            assert!(interval.friction_work <= 0.03 * interval.wear_work * (1.0 + 1e-9), "{}", letters(play));
        }
    }
}

#[test]
fn an_audit_moves_nothing() {
    for play in all_plays() {
        let scene = at_tolerance(with_play(crooked(), play), 1e-8);
        let plain = at(&mut start(&scene, inputs(3.0, -50.0)), 2e-3);
        let mut watched = at(&mut start(&audited(scene), inputs(3.0, -50.0)), 2e-3);
        for joint in 0..4 {
            let interval = watched.interval_mut(joint);
            (interval.force_peak, interval.friction_work, interval.sliding, interval.wear_work) = (0.0, 0.0, 0.0, 0.0);
        }
        assert_eq!(watched, plain, "{}", letters(play));
    }
}

#[test]
fn a_restored_run_goes_on_with_its_intervals() {
    let mut scene = audited(with_play(crooked(), [true; 4]));
    for contact in contacts(&mut scene) {
        contact.friction.law = FrictionLaw::Tanh;
    }
    let scene = at_tolerance(scene, 1e-8);
    let mut run = start(&scene, inputs(3.0, -50.0));
    at(&mut run, 1.3e-3);
    let mut again = Simulation::restore(&scene, &run.snapshot()).expect("its own state");
    assert_eq!(again.outputs(), run.outputs());
    for time in [1.4e-3, 2.5e-3] {
        assert_eq!(at(&mut again, time), at(&mut run, time));
    }
}

/// The contact of C is closed at the start under a strong damper, so that its force only falls.
#[test]
fn a_force_that_only_falls_is_largest_at_the_start() {
    for floor in [1e-9, 1e-6] {
        for method in [Method::Automatic, Method::Verner7, Method::Dop853, Method::Radau13] {
            let mut scene = at_tolerance(audited(speed_driven(Scene::default())), 1e-10);
            (scene.crank.speed_start, scene.crank.angle_start, scene.solver.method) = (10.0, 1.0, method);
            let pin = &mut scene.joint.c;
            (pin.model, pin.clearance, pin.eccentricity_start.x) = (JointModel::Clearance, 1e-4, -1.02e-4);
            let contact = &mut pin.contact;
            (contact.law, contact.restitution, contact.ratio_limit) = (DampingLaw::Flores, 0.3, 0.0);
            contact.speed_floor = floor;
            let peak = at(&mut start(&scene, inputs(0.0, 0.0)), 1e-4).joint_c.interval.force_peak;
            // The force at the start, of an independent simulator.
            near(peak, 426.776291, 2e-9, &format!("{method:?}, {floor:e}"));
        }
    }
}

/// A load turns the slider until an edge of its face touches. Numbers of an independent simulator, whose kinks of sliding
/// velocities cost it the last digits.
#[test]
fn a_face_slides_at_its_edge_when_it_lands() {
    for (method, tolerance) in [(Method::Automatic, 1e-6), (Method::Automatic, 1e-10), (Method::Radau13, 1e-10)] {
        let mut scene = at_tolerance(audited(speed_driven(Scene::default())), tolerance);
        (scene.crank.speed_start, scene.crank.angle_start, scene.solver.method) = (0.0, 0.5, method);
        let slider = &mut scene.slider;
        (slider.length, slider.inertia, slider.centre.x, slider.load_offset) = (0.04, 2e-5, 0.02, -0.01);
        let guide = &mut scene.joint.t;
        (guide.model, guide.surface, guide.foundation_stiffness) = (JointModel::Clearance, Surface::Foundation, 4e8);
        (guide.clearance, guide.offset_start) = (1e-3, 9.9e-4);
        (guide.contact.law, guide.contact.friction.law) = (DampingLaw::Hertz, FrictionLaw::Ambrosio);
        let mut simulation = start(&scene, inputs(0.0, -2000.0));
        let what = format!("{method:?} at {tolerance:e}");
        let bound = if tolerance > 1e-8 { 1e-5 } else { 1e-7 };
        near(at(&mut simulation, 0.5e-3).joint_t.interval.sliding, 5.142291078e-4, bound, &what);
        near(at(&mut simulation, 3e-3).joint_t.interval.sliding, 5.951074e-3, bound, &what);
    }
}

#[test]
fn integrals_have_their_rates() {
    let (t, half) = (2.5e-4, 1e-8);
    let mut scene = audited(speed_driven(Scene::default()));
    scene.crank.speed_start = 5000.0 * std::f64::consts::TAU / 60.0;
    scene.joint.c.model = JointModel::Clearance;
    scene.joint.c.contact.friction.law = FrictionLaw::Ambrosio;
    let mut simulation = start(&at_tolerance(scene, 1e-10), inputs(0.0, 0.0));
    let before = at(&mut simulation, t - half).joint_c.interval;
    simulation.advance_to(t).expect("a motion without trouble");
    let rates = simulation.output_rates().joint_c.interval;
    let after = at(&mut simulation, t + half).joint_c.interval;
    assert!(rates.friction_work > 0.0 && rates.wear_work > rates.friction_work && rates.sliding > 0.0, "{rates:?}");
    for (what, found, [before, after]) in [
        ("friction.work", rates.friction_work, [before.friction_work, after.friction_work]),
        ("sliding", rates.sliding, [before.sliding, after.sliding]),
        ("wear.work", rates.wear_work, [before.wear_work, after.wear_work]),
    ] {
        near(found, (after - before) / (2.0 * half), 1e-5, what);
    }
}
