//! Impacts along one line through the whole mechanism: crank, rod and slider lie on the x axis, a load
//! pushes what is beyond the joint with clearance up to speed and is taken away before the impact.

use super::restitution_laws::delivered_exactly;
use super::scenes::{at, at_tolerance, inputs, revolutes, speed_driven, start, with_play};
use slidercrank::model::contact::damping::factor;
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{DampingLaw, Elasticity, Scene};
use slidercrank::simulation::Simulation;

/// [m/s] Speed of the impact.
const SPEED: f64 = 1.0;
/// [s] How long the load pushes, over half the clearance of 0.5 mm.
const PUSH: f64 = 5e-4;
/// [s] When the impact begins: the other half of the clearance later.
const IMPACT: f64 = PUSH + 2.5e-4;

/// Joint A, B or C (0, 1, 2) and the mass that it stops: A's journal is held by the ground, B's and C's
/// by a crank that is not let turn.
fn in_line(joint: usize) -> (Scene, f64) {
    let mut play = [false; 4];
    play[joint] = true;
    let scene = at_tolerance(with_play(Scene::default(), play), 1e-11);
    match joint {
        0 => (scene, 0.30 + 0.21 + 0.14),
        1 => (speed_driven(scene), 0.21 + 0.14),
        _ => (speed_driven(scene), 0.14),
    }
}

fn contact(joint: usize, o: &Outputs) -> bool {
    [o.joint_a.contact, o.joint_b.contact, o.joint_c.contact][joint]
}

fn penetration(joint: usize, o: &Outputs) -> f64 {
    [o.joint_a.penetration, o.joint_b.penetration, o.joint_c.penetration][joint]
}

/// Magnitude of the joint's force; along the line, all joints beyond the bodies at rest carry it.
fn force(joint: usize, o: &Outputs) -> f64 {
    let [x, y] = [o.joint_a.force, o.joint_b.force, o.joint_c.force][joint];
    assert_eq!(y, 0.0, "all is along x");
    x.abs()
}

/// Pushes the bodies and takes the load away.
fn pushed(scene: &Scene, mass: f64) -> Simulation {
    let mut simulation = start(scene, inputs(0.0, mass * SPEED / PUSH));
    simulation.advance_to(PUSH).expect("nothing is in the way");
    simulation.set_inputs(Inputs::default(), Inputs::default());
    simulation
}

/// Speed after the impact over speed before it.
fn restitution(scene: &Scene, joint: usize, mass: f64) -> f64 {
    let mut simulation = pushed(scene, mass);
    let before = at(&mut simulation, IMPACT - 1e-5);
    assert!(!contact(joint, &before));
    assert!((before.slider.v - SPEED).abs() < 1e-9, "{}", before.slider.v);
    let mut t = IMPACT;
    loop {
        t += 1e-5;
        let after = at(&mut simulation, t);
        if !contact(joint, &after) {
            return -after.slider.v / before.slider.v;
        }
        assert!(t < IMPACT + 2e-3, "the contact opens again");
    }
}

/// All laws.
fn laws() -> impl Iterator<Item = DampingLaw> {
    DampingLaw::ITEMS.iter().filter_map(|&(_, value)| DampingLaw::from_value(value))
}

#[test]
fn every_law_returns_what_its_damping_factor_says_in_every_revolute_joint() {
    let mut worst = 0.0f64;
    for joint in 0..3 {
        for law in laws() {
            for asked in [0.9, 0.5, 0.1] {
                let (mut scene, mass) = in_line(joint);
                let contact = &mut revolutes(&mut scene)[joint].contact;
                (contact.law, contact.restitution) = (law, asked);
                let wanted = if law == DampingLaw::Hertz { 1.0 } else { delivered_exactly(factor(law, asked)) };
                let found = restitution(&scene, joint, mass);
                worst = worst.max((found - wanted).abs());
                // 1e-11 of 10 µm times 1e5/s is 1e-11 m/s a step, some fifty steps; measured 2e-9.
                assert!((found - wanted).abs() < 2e-8, "{law:?} at {asked}, joint {joint}: {found}, not {wanted}");
            }
        }
    }
    println!("restitution in A, B, C: {worst:.1e}");
}

#[test]
fn restitution_does_not_depend_on_the_elastic_law() {
    let mut worst = 0.0f64;
    for (elasticity, exponent, stiffness) in [
        (Elasticity::Hertz, 1.0, 5e8),
        (Elasticity::Hertz, 2.2, 5e13),
        (Elasticity::Hertz, 1.5, 1e9),
        (Elasticity::Liu, 1.5, 0.0),
        (Elasticity::BaiZhao, 1.5, 0.0),
        (Elasticity::Winkler, 1.5, 0.0),
    ] {
        for law in laws().filter(|&law| law != DampingLaw::Hertz) {
            let (mut scene, mass) = in_line(2);
            scene.joint.c.elasticity = elasticity;
            let contact = &mut scene.joint.c.contact;
            (contact.exponent, contact.stiffness, contact.law, contact.restitution) = (exponent, stiffness, law, 0.7);
            let (found, wanted) = (restitution(&scene, 2, mass), delivered_exactly(factor(law, 0.7)));
            worst = worst.max((found - wanted).abs());
            assert!((found - wanted).abs() < 5e-8, "{law:?}, {elasticity:?}^{exponent}: {found}, not {wanted}");
        }
    }
    println!("restitution under other elastic laws: {worst:.1e}");
}

#[test]
fn below_the_speed_floor_the_damping_is_the_slower_one() {
    // s = δ̇/v_floor: χ shrinks to χ·v/v_floor.
    for floor in [2.0, 10.0] {
        let (mut scene, mass) = in_line(2);
        let contact = &mut scene.joint.c.contact;
        (contact.law, contact.restitution, contact.speed_floor) = (DampingLaw::Flores, 0.3, floor);
        let wanted = delivered_exactly(factor(DampingLaw::Flores, 0.3) * SPEED / floor);
        let found = restitution(&scene, 2, mass);
        assert!((found - wanted).abs() < 2e-8, "floor {floor} m/s: {found}, not {wanted}");
    }
}

#[test]
fn the_deepest_penetration_is_the_energy_s() {
    // δ_max^(p + 1) = (p + 1)·m·v²/K·(1/χ − ln(1 + χ)/χ²), and half of that without the damping.
    for joint in 0..3 {
        for (law, asked) in
            [(DampingLaw::Hertz, 1.0), (DampingLaw::ZhangSharf, 0.6), (DampingLaw::LankaraniNikravesh, 0.9)]
        {
            let (mut scene, mass) = in_line(joint);
            let contact = &mut revolutes(&mut scene)[joint].contact;
            (contact.law, contact.restitution) = (law, asked);
            // 4/(3·2σ)·√(R_b·R_j/c), R_b = 10 mm, c = 0.5 mm.
            let sigma = (1.0 - 0.3f64.powi(2)) / 207e9;
            let stiffness = 4.0 / (6.0 * sigma) * (0.01f64 * 0.0095 / 5e-4).sqrt();
            let chi = factor(law, asked);
            let bracket = if chi == 0.0 { 0.5 } else { 1.0 / chi - chi.ln_1p() / (chi * chi) };
            let wanted = (2.5 * mass * SPEED * SPEED / stiffness * bracket).powf(0.4);
            let mut simulation = pushed(&scene, mass);
            let mut deepest = 0.0f64;
            let steps = 4000;
            for i in 0..steps {
                let o = at(&mut simulation, IMPACT + 2.0 * wanted / SPEED * f64::from(i) / f64::from(steps));
                deepest = deepest.max(penetration(joint, &o));
            }
            // Sampled at 1/4000 of twice the time: the parabola's top is missed by 3e-7 of it at most.
            assert!((deepest / wanted - 1.0).abs() < 5e-7, "{law:?}, joint {joint}: {deepest:e}, not {wanted:e}");
        }
    }
}

/// What pushes while the contact lasts, and which limits hold.
struct Push {
    load: f64,
    ratio_limit: f64,
    speed_floor: f64,
    law: DampingLaw,
    restitution: f64,
}

/// Largest relative difference of the force from max(0, K·δ^1.5·(1 + χ·min(δ̇/δ̇⁻, s_max))) over the
/// contact, and the range of s met.
fn force_difference(push: &Push) -> (f64, f64, f64) {
    let (mut scene, mass) = in_line(2);
    let Push { load, ratio_limit, speed_floor, law, restitution } = *push;
    let c = &mut scene.joint.c.contact;
    (c.ratio_limit, c.speed_floor, c.law, c.restitution) = (ratio_limit, speed_floor, law, restitution);
    c.stiffness = 6e10;
    let chi = factor(law, restitution);
    let mut simulation = pushed(&scene, mass);
    // The approach speed is that of the event, before the new load has done any work.
    let mut t = IMPACT + 1e-9;
    simulation.advance_to(t).expect("a free impact");
    simulation.set_inputs(inputs(0.0, load), Inputs::default());
    let approach = SPEED.max(speed_floor);
    let limit = if ratio_limit > 0.0 { ratio_limit } else { f64::INFINITY };
    let (mut worst, mut least, mut most, mut largest) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    for _ in 0..400 {
        t += 2.5e-7;
        let o = at(&mut simulation, t);
        if !contact(2, &o) {
            assert_eq!(force(2, &o), 0.0, "no force across an open gap");
            break;
        }
        let (depth, rate) = (penetration(2, &o), o.slider.v);
        let s = rate / approach;
        (least, most) = (least.min(s), most.max(s));
        let wanted = (6e10 * depth.powf(1.5) * (1.0 + chi * s.min(limit))).max(0.0);
        let found = force(2, &o);
        assert!(o.joint_c.force[0] <= 0.0, "no adhesion");
        assert!(wanted > 0.0 || found == 0.0, "clipped");
        largest = largest.max(wanted);
        worst = worst.max((found - wanted).abs());
    }
    (worst / largest, least, most)
}

#[test]
fn the_normal_force_is_the_law_s_within_its_limits() {
    let base = || Push { load: 0.0, ratio_limit: 1.0, speed_floor: 1e-3, law: DampingLaw::Flores, restitution: 0.5 };
    // (what, push, does s exceed 1, does it fall below −1/χ)
    let cases = [
        ("free", base(), false, false),
        ("pushed on", Push { load: 2e5, ..base() }, true, false),
        ("pushed on without limit", Push { load: 2e5, ratio_limit: 0.0, ..base() }, true, false),
        ("pushed on with a limit of 3", Push { load: 2e5, ratio_limit: 3.0, ..base() }, true, false),
        ("limited to a half", Push { ratio_limit: 0.5, ..base() }, false, false),
        ("torn away", Push { load: -2e4, ..base() }, false, true),
        ("floored", Push { speed_floor: 4.0, ..base() }, false, false),
        ("elastic and pushed on", Push { load: 2e5, law: DampingLaw::Hertz, ..base() }, true, false),
    ];
    for (what, push, exceeds, clips) in cases {
        let (error, least, most) = force_difference(&push);
        let chi = factor(push.law, push.restitution);
        println!("{what}: {error:.1e}, s from {least:.2} to {most:.2}");
        assert_eq!(most > 1.0 + 1e-6, exceeds, "{what}: s up to {most}");
        assert_eq!(1.0 + chi * least < 0.0, clips, "{what}: s down to {least}");
        // Penetration is known to a rounding of 0.17 m, 3e-17 of 1e-5 m.
        assert!(error < 1e-10, "{what}: {error:e}");
    }
}

#[test]
fn a_contact_that_is_closed_at_the_start_takes_the_speed_floor() {
    for (ratio_limit, limit) in [(1.0, 1.0), (0.0, f64::INFINITY)] {
        let (mut scene, _) = in_line(2);
        scene.joint.c.eccentricity_start.x = 5e-4 + 2e-5;
        let c = &mut scene.joint.c.contact;
        (c.stiffness, c.ratio_limit, c.law, c.restitution) = (6e10, ratio_limit, DampingLaw::LankaraniNikravesh, 0.8);
        c.speed_floor = 0.25;
        let mut simulation = start(&scene, inputs(0.0, 1.5e5));
        let chi = factor(DampingLaw::LankaraniNikravesh, 0.8);
        let mut fastest = 0.0f64;
        for i in 0..200 {
            let o = at(&mut simulation, 1e-7 * f64::from(i));
            assert!(o.joint_c.contact);
            let s = (o.slider.v / 0.25).min(limit);
            fastest = fastest.max(o.slider.v);
            let wanted = 6e10 * o.joint_c.penetration.powf(1.5) * (1.0 + chi * s).max(0.0);
            assert!((force(2, &o) - wanted).abs() < 1e-9 * 6e10 * 2e-5f64.powf(1.5), "at step {i}");
        }
        assert!(fastest > 0.5, "the limit matters: {fastest} m/s");
    }
}

#[test]
fn an_open_contact_carries_nothing_however_close() {
    let (mut scene, _) = in_line(2);
    scene.joint.c.eccentricity_start.x = 5e-4 * (1.0 - 1e-12);
    let o = at(&mut start(&scene, Inputs::default()), 0.0);
    assert!(!o.joint_c.contact && o.joint_c.penetration < 0.0);
    assert_eq!(o.joint_c.force, [0.0, 0.0]);
}

#[test]
fn both_corners_of_a_face_return_what_their_law_says() {
    // The slider alone: its pin's clearance is too large to be met. Gravity lets it fall onto the lower
    // line, where it goes on: its work over the penetration of 2 µm is 1e-5 of the impact's energy.
    let mut worst = 0.0f64;
    for law in laws().filter(|&law| law != DampingLaw::Hertz) {
        let mut scene = at_tolerance(with_play(Scene::default(), [false, false, true, true]), 1e-11);
        scene = speed_driven(scene);
        scene.gravity = 0.05;
        (scene.joint.c.radius, scene.joint.c.clearance) = (0.2, 0.1);
        scene.joint.t.clearance = 0.04;
        (scene.joint.t.contact.law, scene.joint.t.contact.restitution) = (law, 0.7);
        let mut simulation = start(&scene, Inputs::default());
        let touch = (2.0f64 * 0.04 / 0.05).sqrt();
        let speed = 0.05 * touch;
        assert_eq!(at(&mut simulation, touch - 1e-6).joint_t.contacts, 0);
        let mut t = touch;
        loop {
            t += 2e-5;
            let o = at(&mut simulation, t);
            if o.joint_t.contacts == 0 {
                break;
            }
            assert_eq!(o.joint_t.contacts, 2, "both corners or none");
            assert_eq!((o.joint_t.moment, o.slider.angle), (0.0, 0.0), "it stays level");
            assert!(t < touch + 0.01, "the contact opens again");
        }
        let found = simulation.output_rates().slider.y / speed;
        let wanted = delivered_exactly(factor(law, 0.7));
        worst = worst.max((found - wanted).abs());
        assert!((found - wanted).abs() < 2e-4, "{law:?}: {found}, not {wanted}");
    }
    println!("restitution of a face: {worst:.1e}");
}
