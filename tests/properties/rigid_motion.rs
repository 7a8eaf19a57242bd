//! Rigid contacts: bounces, sticking and sliding, energy, momentum, penetration.

use super::conservation::{afloat, momentum_change};
use super::motion::motion;
use super::rigid_scenes::{STEP, loose_slider, rigid, rubbing};
use super::scenes::{all_plays, at, crooked, inputs, letters, revolutes, start, with_play};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::Scene;
use slidercrank::simulation::Simulation;

/// [m/s²]
const GRAVITY: f64 = 9.81;
/// [kg]
const SLIDER: f64 = 0.14;

/// Time at the end of a step.
fn after(steps: u32) -> f64 {
    STEP * f64::from(steps)
}

#[test]
fn heights_of_bounces_fall_by_the_square_of_the_restitution() {
    for restitution in [0.9, 0.7, 0.4] {
        let scene = rigid(rubbing(loose_slider(), restitution, 0.0), STEP);
        let mut simulation = start(&scene, Inputs::default());
        let drop = scene.joint.t.clearance;
        let speed = (2.0 * GRAVITY * drop).sqrt();
        // Up to the top of each bounce, a microsecond more or less.
        let mut t = speed / GRAVITY;
        for bounce in 1..=3 {
            let share = restitution.powi(bounce);
            t += share * speed / GRAVITY;
            let o = at(&mut simulation, t);
            let (height, wanted) = (o.slider.y + drop, share * share * drop);
            t += share * speed / GRAVITY;
            // An impact is late by up to a step: so much deeper, faster and higher.
            let bound = f64::from(bounce) * 4.0 * STEP * speed;
            assert!((height - wanted).abs() < bound, "e = {restitution}, bounce {bounce}: {height} m, not {wanted} m");
            assert_eq!(o.solver.events, 4 * bounce, "both lower corners close and open");
            assert!(o.slider.angle.abs() < 1e-15, "a face that lands flat stays flat: {}", o.slider.angle);
        }
    }
}

/// The slider on the lower line, under its weight and a load along the line.
fn resting(friction: f64) -> Scene {
    let mut scene = rubbing(loose_slider(), 0.5, friction);
    scene.joint.t.offset_start = -scene.joint.t.clearance;
    rigid(scene, STEP)
}

#[test]
fn a_slider_sticks_below_the_limit_of_friction_and_slides_above_it() {
    let friction = 0.3;
    let limit = friction * SLIDER * GRAVITY;
    let end = after(20_000);
    for share in [0.0, 0.5, 0.999, -0.999] {
        let load = share * limit;
        let mut simulation = start(&resting(friction), inputs(0.0, load));
        let first = simulation.outputs();
        let o = at(&mut simulation, end);
        // Each of 20 000 steps rounds.
        assert!(o.slider.v.abs() < 1e-14 && (o.slider.x - first.slider.x).abs() < 1e-15, "{share}: {:?}", o.slider);
        assert!((o.joint_t.force[0] + load).abs() < 1e-9 * limit, "{share}: {:?}", o.joint_t);
        assert!((o.joint_t.force[1] - SLIDER * GRAVITY).abs() < 1e-9 && o.joint_t.contacts == 2, "{:?}", o.joint_t);
        // Where it rests, it is no deeper than a step of falling leads.
        assert!((0.0..GRAVITY * STEP * STEP).contains(&o.joint_t.penetration), "{}", o.joint_t.penetration);
    }
    for share in [1.001, 2.0, -1.5] {
        let load = share * limit;
        let mut simulation = start(&resting(friction), inputs(0.0, load));
        let o = at(&mut simulation, end);
        let speed = (load - limit.copysign(load)) / SLIDER * end;
        assert!((o.slider.v - speed).abs() < 1e-9 * speed.abs(), "{share}: {} m/s, not {speed} m/s", o.slider.v);
        assert!((o.joint_t.force[0] + limit.copysign(load)).abs() < 1e-9 * limit, "{share}: {:?}", o.joint_t);
    }
}

#[test]
fn a_sliding_slider_comes_to_rest_and_stays() {
    let friction = 0.3;
    let limit = friction * SLIDER * GRAVITY;
    let mut simulation = start(&resting(friction), inputs(0.0, 3.0 * limit));
    let push = after(10_000);
    let fast = at(&mut simulation, push).slider.v;
    // Without load it brakes at half the rate at which it gained speed.
    simulation.set_inputs(Inputs::default(), Inputs::default());
    let half = at(&mut simulation, push + 0.25 * 2.0 * push).slider.v;
    assert!((half - 0.75 * fast).abs() < 1e-9, "{half} of {fast}");
    for i in 0..10 {
        let o = at(&mut simulation, push * (3.0 + 0.1 * f64::from(i)) + STEP);
        assert!(o.slider.v.abs() < 1e-15 && o.joint_t.force[0].abs() < 1e-9, "{:?}", o.slider);
    }
}

/// Largest gain of energy from one step's end to a later one, J.
fn gain(scene: &Scene) -> (f64, i32) {
    let mut simulation = start(scene, Inputs::default());
    let (mut last, mut gain) = (f64::INFINITY, 0.0f64);
    for i in 0..1500 {
        simulation.advance_to(after(20 * i)).expect("a motion without trouble");
        let m = motion(scene, &mut simulation);
        let energy = m.kinetic() + m.weight(scene.gravity);
        gain = gain.max(energy - last);
        last = energy;
    }
    (gain, simulation.outputs().solver.events)
}

#[test]
fn energy_never_grows() {
    // With friction and a restitution near 1, Newton's law itself may add energy.
    for (restitution, friction) in [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.0, 0.1), (0.5, 0.1)] {
        let mut worst = 0.0f64;
        for play in all_plays() {
            let scene = rigid(rubbing(with_play(crooked(), play), restitution, friction), STEP);
            let (gain, events) = gain(&scene);
            worst = worst.max(gain);
            assert!(events > 0 || play == [false; 4], "{}: {events} events", letters(play));
        }
        println!("e = {restitution}, µ = {friction}: {worst:.1e} J");
        // Of 5.6 J; an impact errs by the share of a turn that a step makes, 1e-4, of the 0.1 J that it moves about.
        assert!(worst < 2e-4, "e = {restitution}, µ = {friction}: gains {worst:e} J");
    }
}

#[test]
fn momentum_is_kept_through_rigid_impacts_between_the_bodies() {
    for play in [[true, true, true, true], [true, true, false, true], [true, false, true, true]] {
        let mut scene = rigid(afloat(play), STEP);
        for joint in revolutes(&mut scene).into_iter().skip(1) {
            joint.clearance = 2e-5;
        }
        for joint in ["B", "C"].into_iter().zip(revolutes(&mut scene).into_iter().skip(1)) {
            (joint.1.contact.restitution, joint.1.contact.friction.coefficient) = (0.6, 0.4);
            joint.1.contact.friction.law = slidercrank::scene::FrictionLaw::Ambrosio;
        }
        let (linear, angular, events) = momentum_change(&scene);
        println!("{}: {linear:.1e}, {angular:.1e}, {events} events", letters(play));
        assert!(events > 2, "{}: {events} events", letters(play));
        // Centres of mass are coordinates: linear momentum is kept to rounding. Of angular momentum a step misses the
        // share (ω·h)² and, where an impact moves arms within it, ω·h.
        assert!(linear < 1e-11 && angular < 1e-5, "{}: {linear:e}, {angular:e}", letters(play));
    }
}

/// The slider's momentum gained in every step less the forces' impulses that the outputs tell, over the largest.
fn imbalance(simulation: &mut Simulation, steps: u32) -> f64 {
    let momentum = |o: &Outputs, rates: &Outputs| [SLIDER * o.slider.v, SLIDER * rates.slider.y];
    let mut last = momentum(&simulation.outputs(), &simulation.output_rates());
    let (mut worst, mut largest) = (0.0f64, 0.0f64);
    for i in 1..=steps {
        let o = at(simulation, after(i));
        let now = momentum(&o, &simulation.output_rates());
        let weight = [0.0, -SLIDER * GRAVITY];
        for axis in 0..2 {
            let impulse = STEP * (o.joint_c.force[axis] + o.joint_t.force[axis] + weight[axis]);
            worst = worst.max((now[axis] - last[axis] - impulse).abs());
            largest = largest.max(impulse.abs());
        }
        last = now;
    }
    worst / largest
}

#[test]
fn forces_are_the_impulses_of_their_step() {
    let mut scene = rubbing(with_play(crooked(), [false, false, true, true]), 0.6, 0.2);
    scene.slider.com = slidercrank::scene::Point::default();
    let mut simulation = start(&rigid(scene, STEP), Inputs::default());
    let worst = imbalance(&mut simulation, 20_000);
    assert!(simulation.outputs().solver.events > 20, "impacts in both joints");
    // Velocities of 10 m/s round at 1e-15 m/s, of the 1 m/s that an impact changes.
    assert!(worst < 1e-12, "{worst:e}");
}

/// Deepest penetration in the second half of a run, and in all of it; m.
fn depths(play: [bool; 4], restitution: f64, friction: f64, step: f64) -> (f64, f64) {
    let scene = rigid(rubbing(with_play(crooked(), play), restitution, friction), step);
    let mut simulation = start(&scene, Inputs::default());
    let (mut late, mut all) = (0.0f64, 0.0f64);
    for i in 1..=4000 {
        let o = at(&mut simulation, 1e-5 * f64::from(i));
        let joints = [o.joint_a.penetration, o.joint_b.penetration, o.joint_c.penetration, o.joint_t.penetration];
        let deepest = joints.into_iter().fold(f64::NEG_INFINITY, f64::max);
        all = all.max(deepest);
        if i > 2000 {
            late = late.max(deepest);
        }
    }
    (late, all)
}

#[test]
fn a_lasting_contact_is_as_deep_as_the_square_of_the_step() {
    for play in [[true, false, false, false], [false, true, false, false], [false, false, true, false]] {
        for friction in [0.0, 0.1] {
            let [coarse, fine] = [4e-6, 1e-6].map(|step| depths(play, 0.0, friction, step).0);
            println!("{}, µ = {friction}: {coarse:.1e} then {fine:.1e} m", letters(play));
            // 2000 m/s² for the 1e-6 s of a step.
            assert!(0.0 < fine && fine < 2000.0 * 1e-12, "{}: {fine:e} m", letters(play));
            assert!((12.0..20.0).contains(&(coarse / fine)), "{}: {coarse:e} then {fine:e} m", letters(play));
        }
    }
}

#[test]
fn an_impact_is_as_deep_as_it_moves_in_a_step() {
    for play in all_plays().filter(|play| *play != [false; 4]) {
        for restitution in [0.0, 0.5, 1.0] {
            for step in [4e-6, 1e-6] {
                let (_, deepest) = depths(play, restitution, 0.05, step);
                // Impacts of these runs come at up to 2 m/s.
                assert!(deepest < 2.0 * step, "{}, e = {restitution}: {deepest:e} m in {step} s", letters(play));
            }
        }
    }
}
