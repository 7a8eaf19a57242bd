//! Mechanisms whose slider has faces: energy, symmetry, determinism, and runs of every kind.

use super::chance::Chance;
use super::motion::{Motion, motion};
use super::scenes::{
    Play, all_plays, at, at_tolerance, contacts, crooked, elastic, inputs, letters, reals, speed_driven, start,
    with_play,
};
use super::symmetry::{mirror, mirrored};
use slidercrank::integrator::methods::named;
use slidercrank::integrator::{Integrator, Ode, Settings, StepPoint, WorkLimit};
use slidercrank::model::Model;
use slidercrank::model::joint::foundation::FacePenetration;
use slidercrank::model::joint::guide::Guide;
use slidercrank::model::mechanism_model::MechanismModel;
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::model::start::StartPose;
use slidercrank::model::state::Conditions;
use slidercrank::scene::{DampingLaw, FrictionLaw, Method, Scene, Surface};
use slidercrank::simulation::Simulation;

/// Of A, B, C, T.
const STIFFNESS: [f64; 4] = [3e10, 5e10, 6e10, 0.0];
/// [N/m²] Soft enough for penetrations of 0.1 mm.
const BED: f64 = 2e9;
const TORQUE: f64 = 2.0;
const LOAD: f64 = -40.0;

/// The eight plays with a clear guide.
fn plays() -> impl Iterator<Item = Play> {
    all_plays().filter(|play| play[3])
}

/// A mechanism without symmetry that rattles in its guide on both faces, turned and flat.
fn faced(play: Play) -> Scene {
    let mut scene = with_play(crooked(), play);
    (scene.joint.t.surface, scene.joint.t.foundation_stiffness) = (Surface::Foundation, BED);
    scene.joint.t.clearance = 1e-4;
    for (contact, stiffness) in contacts(&mut scene).into_iter().zip(STIFFNESS) {
        contact.stiffness = stiffness;
    }
    scene
}

/// [J] Energy of a motion less the inputs' work.
fn energy(scene: &Scene, play: Play, m: &Motion) -> f64 {
    let revolute: [f64; 4] = std::array::from_fn(|i| if play[i] { STIFFNESS[i] } else { 0.0 });
    let half = 0.5 * scene.slider.length;
    let face = |front: usize| {
        let (front, rear) = (m.corners[front].0, m.corners[front + 1].0);
        // ½·k_w·∫max(0, δ)²dx.
        let bed = FacePenetration { half, middle: 0.5 * (front + rear), slope: 0.5 * (front - rear) / half };
        0.5 * BED * (2.0 * half) * bed.mean_square()
    };
    m.kinetic() + m.weight(scene.gravity) + m.elastic(revolute) + face(0) + face(2)
        - TORQUE * m.outputs.crank.angle
        - LOAD * m.outputs.slider.x
}

/// The energies of a run relative to the first kinetic energy, the corners met on it together, and the
/// events.
fn ledger(scene: &Scene, play: Play) -> (Vec<f64>, [bool; 4], i32) {
    let mut simulation = start(scene, inputs(TORQUE, LOAD));
    let first = motion(scene, &mut simulation);
    let (origin, size) = (energy(scene, play, &first), first.kinetic());
    let mut met = [false; 4];
    let mut energies = vec![0.0];
    for i in 1..=1500 {
        simulation.advance_to(2e-5 * f64::from(i)).expect("a motion without trouble");
        let m = motion(scene, &mut simulation);
        energies.push((energy(scene, play, &m) - origin) / size);
        let touching = m.corners.map(|corner| corner.0 > 0.0);
        let count = touching.iter().filter(|touches| **touches).count();
        // A corner, a face, opposite corners.
        let opposite = touching[0] && touching[3] || touching[1] && touching[2];
        met[if opposite { 3 } else { count.min(2) }] = true;
        // The deepest corner, and the corners in contact: at an event itself rounding may decide.
        let o = m.outputs.joint_t;
        let deepest = m.corners.iter().map(|corner| corner.0).fold(f64::NEG_INFINITY, f64::max);
        assert!((o.penetration - deepest).abs() < 1e-16, "{} is not {deepest}", o.penetration);
        assert!(o.contacts == count as i32 || deepest.abs() < 1e-12, "{} is not {count}", o.contacts);
    }
    (energies, met, simulation.outputs().solver.events)
}

#[test]
fn energy_is_kept_by_elastic_faces_and_better_so_at_a_tighter_tolerance() {
    let mut met = [false; 4];
    for play in plays() {
        let scene = elastic(faced(play));
        let drift = |tolerance: f64| ledger(&at_tolerance(scene.clone(), tolerance), play);
        let [(rough, seen, events), (fine, ..)] = [1e-7, 1e-9].map(drift);
        let [rough, fine] = [rough, fine].map(|list| list.into_iter().map(f64::abs).fold(0.0, f64::max));
        met = std::array::from_fn(|i| met[i] || seen[i]);
        println!("{}: {rough:.1e} then {fine:.1e}, {events} events, {seen:?}", letters(play));
        assert!(events > 4 && seen[1] && seen[2], "{}: {events} events", letters(play));
        // Measured: 7e-9 and 1e-10 at most; as in `conservation`.
        assert!(rough < 3e-8, "{}: {rough:e} at 1e-7", letters(play));
        assert!(fine < 5e-10, "{}: {fine:e} at 1e-9", letters(play));
        assert!(fine < 0.1 * rough, "{}: {rough:e} then {fine:e}", letters(play));
    }
    assert!(met.iter().all(|met| *met), "free, a corner, a face, opposite corners: {met:?}");
}

#[test]
fn damping_and_friction_only_take_energy() {
    for play in plays() {
        for (law, friction) in [
            (DampingLaw::LankaraniNikravesh, FrictionLaw::None),
            (DampingLaw::Flores, FrictionLaw::Ambrosio),
            (DampingLaw::Hertz, FrictionLaw::Tanh),
        ] {
            let mut scene = at_tolerance(elastic(faced(play)), 1e-9);
            let contact = &mut scene.joint.t.contact;
            (contact.law, contact.restitution) = (law, 0.5);
            (contact.friction.law, contact.friction.coefficient) = (friction, 0.2);
            let (energies, ..) = ledger(&scene, play);
            let rise = energies.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::NEG_INFINITY, f64::max);
            let lost = -energies[energies.len() - 1];
            println!("{} {law:?} {friction:?}: {lost:.1e} lost, rises by {rise:.1e} at most", letters(play));
            assert!(lost > 1e-4, "{} {law:?}: {lost:e}", letters(play));
            // The integrator's error at this tolerance: measured 4e-10 at most.
            assert!(rise < 3e-9, "{} {law:?}: {rise:e}", letters(play));
        }
    }
}

/// Friction that holds a tilted slider, eccentric starts, damping.
fn jamming(play: Play) -> Scene {
    let mut scene = at_tolerance(faced(play), 1e-7);
    scene.joint.t.offset_start = 5e-5;
    scene.joint.t.foundation_stiffness = 0.0;
    let slider = &mut scene.slider;
    // The pin is far behind a short rectangle: the rod's push turns it against both lines.
    (slider.length, slider.centre.x) = (0.02, 0.02);
    for contact in contacts(&mut scene) {
        contact.friction.law = FrictionLaw::Tanh;
        contact.friction.coefficient = 0.3;
        contact.width = 0.02;
    }
    scene
}

#[test]
fn a_face_keeps_the_approach_speed_of_its_first_touch_until_it_is_open() {
    let scene = at_tolerance(faced([false, false, false, true]), 1e-8);
    let guide = Guide::new(&scene);
    let model = Model::assemble(&scene);
    let mut y = vec![0.0; model.layout().states];
    model.write_start(&StartPose::of(&scene).expect("a loop that closes"), &mut y);
    let conditions = Conditions::without_inputs(model.start_contacts(0.0, &y));
    let settings = Settings { tolerance: 1e-8, fixed_step: 1e-6, effort: WorkLimit::ANY };
    let mut integrator =
        Integrator::start(&model, named("verner7", y.len()).expect("a method"), settings, 0.0, &y, conditions);
    let (mut closings, mut passages) = (0, 0);
    let (mut before, mut before_count) = (conditions, [0; 2]);
    while integrator.state().front().t < 0.03 {
        integrator.advance(&model, integrator.state().front().t.next_up()).expect("a motion without trouble");
        let StepPoint { t, y, discrete: states, .. } = integrator.state().front();
        let pose = model.evaluation(states, *t, y).pose.slider();
        let depths = guide.penetrations(&pose);
        for face in 0..2 {
            let (was, is) = (before.contacts[3 + face], states.contacts[3 + face]);
            let count = depths[2 * face..][..2].iter().filter(|depth| **depth > 0.0).count();
            if is.closed && !was.closed {
                let faster = guide.approaches(&pose)[face].1;
                assert_eq!(is.approach, faster.max(scene.joint.t.contact.speed_floor));
                closings += 1;
            } else if is.closed {
                assert_eq!(is, was);
                passages += usize::from(count != before_count[face]);
            } else {
                assert!(depths[2 * face].max(depths[2 * face + 1]) < 1e-12, "open at {depths:?}");
            }
            before_count[face] = count;
        }
        assert!(!states.contacts[5].closed && !states.contacts[6].closed);
        before = *states;
    }
    println!("{closings} closings, {passages} passages between corner and face");
    assert!(closings > 10 && passages > 5, "{closings} closings, {passages} passages");
}

#[test]
fn a_face_closed_at_the_start_has_the_least_approach_speed() {
    for (offset, upper) in [(1.2e-4, true), (-1.2e-4, false)] {
        let mut scene = faced([false, false, false, true]);
        scene.joint.t.offset_start = offset;
        let model = Model::assemble(&scene);
        let mut y = vec![0.0; model.layout().states];
        model.write_start(&StartPose::of(&scene).expect("a loop that closes"), &mut y);
        let conditions = Conditions::without_inputs(model.start_contacts(0.0, &y));
        assert_eq!((conditions.contacts[3].closed, conditions.contacts[4].closed), (upper, !upper));
        assert_eq!(
            conditions.contacts[3].approach.max(conditions.contacts[4].approach),
            scene.joint.t.contact.speed_floor
        );
        assert!(!conditions.contacts[5].closed && !conditions.contacts[6].closed);
    }
}

#[test]
fn every_mechanism_runs_through_tilt_and_jamming_under_both_drives() {
    for play in plays() {
        for (drive, scene) in [("torque", jamming(play)), ("speed", speed_driven(jamming(play)))] {
            let mut simulation = start(&scene, inputs(10.0, 0.0));
            let mut jammed = 0;
            for i in 0..=400 {
                let o = at(&mut simulation, 1e-4 * f64::from(i));
                for (name, value) in reals(&o) {
                    let open = name.ends_with("penetration") && value == f64::NEG_INFINITY;
                    assert!(value.is_finite() || open, "{} {drive}: {name} = {value}", letters(play));
                }
                let m = motion(&scene, &mut simulation);
                let [upper_front, upper_rear, lower_front, lower_rear] = m.corners.map(|corner| corner.0 > 0.0);
                jammed += usize::from(upper_front && lower_rear || upper_rear && lower_front);
            }
            println!("{} {drive}: {jammed} instants in a jam, {:?}", letters(play), simulation.outputs().solver);
            assert!(jammed > 3, "{} {drive}: {jammed} instants in a jam", letters(play));
        }
    }
}

#[test]
fn the_mirrored_faces_move_as_the_mirror_image_to_the_bit() {
    for play in plays() {
        for method in [Method::Verner7, Method::Dopri5, Method::Dop853] {
            for drive in [|scene: Scene| scene, speed_driven] {
                let mut scene = drive(jamming(play));
                scene.solver.method = method;
                let mut one = start(&scene, inputs(3.0, -50.0));
                let mut other = start(&mirrored(&scene), inputs(-3.0, -50.0));
                for i in 0..=40 {
                    let t = 3e-4 * f64::from(i);
                    let (one, other) = (at(&mut one, t), mirror(&at(&mut other, t)));
                    assert_eq!((one.solver, one.joint_t.contacts), (other.solver, other.joint_t.contacts));
                    for ((name, one), (_, other)) in reals(&one).into_iter().zip(reals(&other)) {
                        assert!(one == other, "{} {method:?} {name} at {t}: {one:e} and {other:e}", letters(play));
                    }
                }
            }
        }
    }
}

#[test]
fn a_slider_that_falls_flat_stays_flat() {
    for clear_pin in [false, true] {
        let mut scene = at_tolerance(with_play(Scene::default(), [false, clear_pin, false, true]), 1e-8);
        (scene.gravity, scene.crank.speed_start) = (9.81, 100.0);
        (scene.joint.t.surface, scene.joint.t.clearance) = (Surface::Foundation, 1e-4);
        let mut simulation = start(&scene, Inputs::default());
        let mut touched = 0;
        for i in 0..=600 {
            let o = at(&mut simulation, 5e-5 * f64::from(i));
            assert_eq!((o.slider.angle, o.joint_t.moment), (0.0, 0.0));
            touched += o.joint_t.contacts;
        }
        // Both corners at once.
        assert!(touched > 0 && touched % 2 == 0, "{touched}");
    }
}

#[test]
fn the_same_bits_for_any_split_and_after_any_restore() {
    let mut chance = Chance(23);
    let scene = jamming([true, false, true, true]);
    let end = 0.012;
    let bits = |o: &Outputs| format!("{o:?}");
    let mut whole = start(&scene, inputs(3.0, -50.0));
    at(&mut whole, end);
    // What counts from the last communication point is left out.
    whole.begin_interval();
    let wanted = bits(&whole.outputs());
    assert!(whole.outputs().solver.events > 10);
    for _ in 0..20 {
        let mut simulation = start(&scene, inputs(3.0, -50.0));
        let mut t = 0.0f64;
        while t < end {
            let step = end * 10f64.powf(chance.between(-12.0, 0.0));
            t = (t + step.max(end * chance.between(0.0, 0.02))).min(end);
            simulation.advance_to(t).expect("a motion without trouble");
            if chance.between(0.0, 1.0) < 0.3 {
                let snapshot = simulation.snapshot();
                simulation = Simulation::restore(&scene, &snapshot).expect("its own state");
            }
            if chance.between(0.0, 1.0) < 0.3 {
                simulation.output_rates();
            }
        }
        simulation.begin_interval();
        assert_eq!(bits(&simulation.outputs()), wanted);
    }
}
