//! Rigid bodies: energy and momentum, the worn pin of the literature, and what each damping law returns.

use crate::mechanisms::{ALL, brisk, each_contact, worn_pin};
use reference_mechanism::mechanism::{DampingLaw, DriveMode, Elasticity, FrictionLaw, JointModel, Point};
use reference_mechanism::{Crossing, Inputs, Mechanism, Outputs, Reference};

const TOLERANCE: f64 = 1e-12;

fn started(mechanism: &Mechanism) -> Reference {
    Reference::start(mechanism, 0.0, Inputs::default(), TOLERANCE)
}

/// Advances in steps of `step` until something touches or parts for the `count`th time.
fn until_crossing(reference: &mut Reference, step: f64, count: usize) -> Crossing {
    for k in 1..100_000 {
        reference.advance_to(step * f64::from(k));
        if let Some(crossing) = reference.crossings().get(count - 1) {
            return *crossing;
        }
    }
    unreachable!("nothing touches within {step} s times 100000")
}

#[test]
fn energy_stays_where_nothing_dissipates() {
    for elasticity in [Elasticity::Hertz, Elasticity::Liu, Elasticity::BaiZhao, Elasticity::Winkler] {
        let mut mechanism = brisk(DriveMode::Torque, ALL);
        mechanism.gravity = 9.81;
        mechanism.guide.offset = 0.01;
        (mechanism.joint.a.elasticity, mechanism.joint.b.elasticity) = (elasticity, elasticity);
        each_contact(&mut mechanism, |contact| contact.law = DampingLaw::Hertz);
        let mut reference = started(&mechanism);
        let start = reference.energy();
        reference.advance_to(1e-3);
        assert!(reference.crossings().len() > 10, "there are impacts to lose energy in");
        // Some 1e3 steps, each within 1e-12 of a velocity of a metre per second.
        let lost = reference.energy() / start - 1.0;
        assert!(lost.abs() < 1e-9, "{lost:e} of the energy is lost");
    }
}

#[test]
fn momentum_stays_through_an_impact_of_the_crank_pin() {
    let mut mechanism = brisk(DriveMode::Torque, ALL);
    mechanism.joint.b.eccentricity_start = Point { x: -9e-5, y: 2e-5 };
    each_contact(&mut mechanism, |contact| contact.friction.law = FrictionLaw::Ambrosio);
    let mut reference = started(&mechanism);
    let start = reference.momentum();
    let opening = until_crossing(&mut reference, 1e-7, 2);
    assert!(reference.crossings().iter().all(|crossing| crossing.contact == 1) && !opening.closed);
    for (now, before) in reference.momentum().into_iter().zip(start) {
        // Round-off in momenta of up to 10 kg·m/s, in some 100 steps.
        assert!((now - before).abs() < 1e-12, "{now} was {before}");
    }
}

#[test]
fn crossings_are_located_to_round_off() {
    let mut reference = started(&brisk(DriveMode::Torque, ALL));
    reference.advance_to(1e-3);
    for crossing in reference.crossings() {
        // Positions of 0.2 m resolve 3e-17 m, and a gap is a difference of sums of some of them.
        assert!(crossing.gap.abs() < 1e-15, "{crossing:?}");
    }
}

/// Literature §10, B1: 6.8186° and 4.38578 m/s, as printed.
#[test]
fn the_worn_pin_first_strikes_where_the_literature_says() {
    let mechanism = worn_pin();
    let first = until_crossing(&mut started(&mechanism), 1e-5, 1);
    let angle = (mechanism.crank.speed_start * first.time).to_degrees();
    assert!((angle - 6.8186).abs() < 0.5e-4, "{angle}°");
    assert!((first.rate - 4.38578).abs() < 0.5e-5, "{} m/s", first.rate);
}

/// Literature §10, B1: the ideal mechanism's peaks, as printed.
#[test]
fn the_ideal_mechanism_peaks_as_the_literature_says() {
    let mut mechanism = worn_pin();
    mechanism.joint.c.model = JointModel::Ideal;
    let mut reference = started(&mechanism);
    let turn = std::f64::consts::TAU / mechanism.crank.speed_start;
    let outputs: Vec<Outputs> = (0..=3600)
        .map(|tenth| {
            reference.advance_to(turn * f64::from(tenth) / 3600.0);
            reference.outputs()
        })
        .collect();
    let greatest = |what: fn(&Outputs) -> f64| outputs.iter().map(what).fold(f64::NEG_INFINITY, f64::max);
    let checks = [
        ("acceleration", greatest(|o| o.slider.a), 9695.9, 0.05),
        ("deceleration", greatest(|o| -o.slider.a), 19419.4, 0.05),
        ("speed", greatest(|o| o.slider.v), 28.411, 0.5e-3),
        ("pin force", greatest(|o| o.joint_c.force[0].hypot(o.joint_c.force[1])), 2718.7, 0.05),
        ("crank-pin force", greatest(|o| o.joint_b.force[0].hypot(o.joint_b.force[1])), 6197.1, 0.05),
        ("torque", greatest(|o| o.drive_torque), 138.52, 0.5e-2),
        ("torque back", greatest(|o| -o.drive_torque), 138.52, 0.5e-2),
    ];
    for (what, found, printed, half_digit) in checks {
        assert!((found - printed).abs() <= half_digit, "{what}: {found}, printed {printed}");
    }
    // The other half turn mirrors the first.
    let first_half = &outputs[..=1800];
    let peak = first_half.iter().max_by(|a, b| a.slider.a.total_cmp(&b.slider.a)).map(|o| o.crank.angle.to_degrees());
    assert!(peak.is_some_and(|angle| (angle - 122.0).abs() < 0.1), "{peak:?}°");
}

/// Rebound over approach speed of the slider dropped on the guide with both lower corners.
fn rebound(law: DampingLaw, restitution: f64, exponent: f64) -> f64 {
    let mut mechanism = Mechanism::default();
    mechanism.drive.mode = DriveMode::Speed;
    mechanism.gravity = 1e3;
    mechanism.joint.c.model = JointModel::Clearance;
    (mechanism.joint.c.radius, mechanism.joint.c.clearance) = (3.0, 2.0);
    let guide = &mut mechanism.joint.t;
    (guide.model, guide.clearance) = (JointModel::Clearance, 0.05);
    // So stiff that weight is 1e-5 of the contact force.
    guide.contact.stiffness = 2e7 / 1e-6_f64.powf(exponent);
    (guide.contact.law, guide.contact.restitution, guide.contact.exponent) = (law, restitution, exponent);
    let mut reference = started(&mechanism);
    // It closes with two corners, then opens with two.
    let opening = until_crossing(&mut reference, 1e-4, 3);
    -opening.rate / reference.crossings()[0].rate
}

/// Literature §3.2, to its ±1e-4.
#[test]
fn each_law_returns_what_the_literature_tabulates() {
    const ASKED: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
    let table = [
        (DampingLaw::Hertz, [1.0; 5]),
        (DampingLaw::HuntCrossley, [0.5158, 0.5813, 0.6630, 0.7680, 0.9090]),
        (DampingLaw::HerbertMcwhannell, [0.4907, 0.5200, 0.5936, 0.7227, 0.9009]),
        (DampingLaw::LeeWang, [0.6867, 0.7390, 0.7992, 0.8693, 0.9524]),
        (DampingLaw::LankaraniNikravesh, [0.6653, 0.6842, 0.7252, 0.7960, 0.9132]),
        (DampingLaw::Gonthier, [0.1010, 0.3042, 0.4877, 0.6696, 0.8764]),
        (DampingLaw::ZhangSharf, ASKED),
        (DampingLaw::ZhiyingQishao, [0.2175, 0.3267, 0.4826, 0.6796, 0.8959]),
        (DampingLaw::Flores, [0.0694, 0.2562, 0.4704, 0.6832, 0.8939]),
        (DampingLaw::HuGuo, [0.0741, 0.2707, 0.4877, 0.6973, 0.8999]),
        (DampingLaw::CarvalhoMartins, [0.1289, 0.3040, 0.5002, 0.7000, 0.9000]),
    ];
    for (law, row) in table {
        for (asked, printed) in ASKED.into_iter().zip(row) {
            let returned = rebound(law, asked, 1.5);
            assert!((returned - printed).abs() < 1e-4, "{law:?} at {asked}: {returned}, printed {printed}");
        }
    }
}

#[test]
fn the_exact_law_returns_what_was_asked_for_whatever_the_exponent() {
    for exponent in [1.0, 1.2, 2.2] {
        let returned = rebound(DampingLaw::ZhangSharf, 0.4, exponent);
        // Weight is 1e-5 of the contact force.
        assert!((returned - 0.4).abs() < 1e-4, "{returned} at exponent {exponent}");
    }
}
