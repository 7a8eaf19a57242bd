//! Energy where nothing dissipates, momentum where nothing acts from outside.

use super::motion::{Motion, motion};
use super::scenes::{
    Play, all_plays, at_tolerance, contacts, crooked, elastic, inputs, letters, revolutes, start, with_play,
};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::{FrictionLaw, Scene};

const STIFFNESS: [f64; 4] = [3e10, 5e10, 6e10, 8e9];

/// Gravity, offsets, no dissipation, given stiffnesses.
fn conservative(play: Play) -> Scene {
    let mut scene = elastic(with_play(crooked(), play));
    for (contact, stiffness) in contacts(&mut scene).into_iter().zip(STIFFNESS) {
        contact.stiffness = stiffness;
    }
    scene
}

const TORQUE: f64 = 2.0;
const LOAD: f64 = -40.0;

/// Total energy less the inputs' work.
fn energy(scene: &Scene, play: Play, m: &Motion) -> f64 {
    // An ideal guide's corners and an ideal joint's penetration carry nothing.
    let stiffness: [f64; 4] = std::array::from_fn(|i| if play[i] { STIFFNESS[i] } else { 0.0 });
    m.kinetic() + m.weight(scene.gravity) + m.elastic(stiffness)
        - TORQUE * m.outputs.crank.angle
        - LOAD * m.outputs.slider.x
}

/// Largest change of the energy relative to the kinetic energy, and the events met.
fn drift(play: Play, tolerance: f64) -> (f64, i32) {
    let scene = at_tolerance(conservative(play), tolerance);
    let mut simulation = start(&scene, inputs(TORQUE, LOAD));
    let first = motion(&scene, &mut simulation);
    let (wanted, size) = (energy(&scene, play, &first), first.kinetic());
    let mut worst = 0.0f64;
    for i in 1..=300 {
        simulation.advance_to(1e-4 * f64::from(i)).expect("a motion without trouble");
        let now = energy(&scene, play, &motion(&scene, &mut simulation));
        worst = worst.max((now - wanted).abs() / size);
    }
    (worst, simulation.outputs().solver.events)
}

#[test]
fn energy_is_kept_by_elastic_contacts_and_better_so_at_a_tighter_tolerance() {
    for play in all_plays() {
        let [(rough, events), (fine, _), (finest, _)] = [1e-6, 1e-8, 1e-10].map(|tolerance| drift(play, tolerance));
        println!("{}: {rough:.1e}, {fine:.1e}, {finest:.1e}, {events} events", letters(play));
        assert!(events > 4 || play == [false; 4], "{}: {events} events", letters(play));
        // Measured at 1e-8: 1.2e-8 (the mechanism without play, whose tolerance is one of the crank's angle; 1.5e-9 else),
        // at 1e-10 5e-11 with play. A step errs by tolerance·3 µm·frequency, 3e-9 m/s at 1e-8, of some 10 m/s, in an
        // impact a tenth of that, and some thousand steps add up; at 1e-10 so do their roundings.
        let with_play = play != [false; 4];
        assert!(fine < if with_play { 5e-9 } else { 5e-8 }, "{}: {fine:e} at 1e-8", letters(play));
        assert!(finest < if with_play { 2e-10 } else { 5e-10 }, "{}: {finest:e} at 1e-10", letters(play));
        assert!(fine < 0.1 * rough, "{}: {rough:e} then {fine:e}", letters(play));
    }
}

/// Largest change of both momenta relative to the largest body's, and the contacts met at B and C.
pub fn momentum_change(scene: &Scene) -> (f64, f64, i32) {
    let mut simulation = start(scene, Inputs::default());
    let first = motion(scene, &mut simulation);
    let (momentum, angular) = (first.momentum(), first.angular_momentum());
    let (mut linear_change, mut angular_change, mut size) = (0.0f64, 0.0f64, 0.0f64);
    for i in 1..=300 {
        simulation.advance_to(2e-5 * f64::from(i)).expect("a motion without trouble");
        let m = motion(scene, &mut simulation);
        assert!(!m.outputs.joint_a.contact && m.outputs.joint_t.contacts == 0, "nothing touches the ground");
        linear_change = linear_change.max((m.momentum() - momentum).norm());
        angular_change = angular_change.max((m.angular_momentum() - angular).abs());
        size = m.bodies.iter().map(|b| b.mass * b.velocity.norm()).fold(size, f64::max);
    }
    // The rod's length makes a moment of a momentum.
    (linear_change / size, angular_change / (size * scene.rod.length), simulation.outputs().solver.events)
}

/// No gravity, and ground joints too wide to be met within the run.
pub fn afloat(play: Play) -> Scene {
    let mut scene = with_play(crooked(), play);
    scene.gravity = 0.0;
    scene.crank.speed_start = 40.0;
    (scene.joint.a.radius, scene.joint.a.clearance) = (0.2, 0.1);
    scene.joint.t.clearance = 0.1;
    at_tolerance(scene, 1e-10)
}

#[test]
fn momentum_is_kept_in_free_flight() {
    let mut scene = afloat([true; 4]);
    for joint in revolutes(&mut scene) {
        (joint.radius, joint.clearance) = (0.2, 0.1);
    }
    let (linear, angular, events) = momentum_change(&scene);
    println!("free flight: {linear:.1e}, {angular:.1e}");
    assert_eq!(events, 0);
    // Nothing but rounding.
    assert!(linear < 1e-12 && angular < 1e-12, "{linear:e}, {angular:e}");
}

#[test]
fn momentum_is_kept_through_impacts_with_friction_between_the_bodies() {
    for friction in [FrictionLaw::Ambrosio, FrictionLaw::Tanh, FrictionLaw::Stribeck] {
        for play in
            [[true, true, true, true], [true, true, false, true], [true, false, true, true], [true, false, false, true]]
        {
            let mut scene = afloat(play);
            for joint in revolutes(&mut scene).into_iter().skip(1) {
                joint.clearance = 2e-5;
                (joint.contact.friction.law, joint.contact.friction.coefficient) = (friction, 0.4);
                joint.contact.restitution = 0.6;
                joint.damping = 1e-4;
            }
            let (linear, angular, events) = momentum_change(&scene);
            println!("{}, {friction:?}: {linear:.1e}, {angular:.1e}, {events} events", letters(play));
            assert!(events > 2 || play == [true, false, false, true], "{}: {events} events", letters(play));
            // Contact forces are equal and opposite; what is left is the error of steps.
            assert!(linear < 1e-9 && angular < 2e-10, "{}: {linear:e}, {angular:e}", letters(play));
        }
    }
}
