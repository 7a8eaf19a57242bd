//! A small campaign, and what a campaign promises: the same scenes from the same seed, over all that a scene may be.

use fmu_harness::campaign::trial::Verdict;
use fmu_harness::campaign::{Campaign, Kind};
use fmu_harness::report::campaign::table;
use rayon::prelude::*;
use slidercrank::scene::write::write;
use slidercrank::scene::{JointModel, Method, PARAMETERS};
use std::process::exit;

/// Of the usual evaluations: a scene that is stopped by its budget says little, and takes the time.
const EFFORT: f64 = 0.25;

const SMALL: Campaign = Campaign { kind: Kind::Legal, scenes: 75, seed: 1, turns: 5.0, effort: EFFORT };

#[test]
fn none_of_75_scenes_drawn_by_lot_fails() {
    let outcomes = SMALL.run(
        || {},
        |number, file| {
            eprintln!("scene {number} does not end:\n{}", write(file));
            exit(1);
        },
    );
    println!("{}", table(&outcomes).print());
    let failures: Vec<String> = outcomes
        .iter()
        .filter_map(|outcome| match (&outcome.verdict, &outcome.failure) {
            (Verdict::Failed(what), Some([_, simplest])) => Some(format!("{what}\n{}", write(simplest))),
            _ => None,
        })
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    let finished = outcomes.iter().filter(|outcome| outcome.verdict == Verdict::Finished).count();
    // A campaign whose runs end early has looked at nothing; measured: 29.
    assert!(finished > 20, "{finished} runs finished");
}

/// A mechanism that all but stands turns so little energy over that the balance says nothing: found by the campaign.
#[test]
fn a_balance_below_what_the_error_norm_notices_is_no_failure() {
    let outcome = Campaign { kind: Kind::Legal, scenes: 1, seed: 6, turns: 5.0, effort: 1.0 }.outcome(2635);
    assert!(!matches!(outcome.verdict, Verdict::Failed(_)), "{:?}", outcome.verdict);
}

#[test]
fn a_scene_is_known_by_seed_and_number_and_different_from_the_others() {
    let files = |campaign: &Campaign| (0..40).map(|number| write(&campaign.scene(number))).collect::<Vec<String>>();
    let (once, twice) = (files(&SMALL), files(&Campaign { scenes: 7, ..SMALL }));
    assert_eq!(once, twice);
    let other = files(&Campaign { seed: 2, ..SMALL });
    assert!(once.iter().zip(&other).all(|(one, other)| one != other));
    assert!((1..40).all(|i| !once[..i].contains(&once[i])));
}

#[test]
fn every_parameter_method_and_joint_has_its_turn() {
    let scenes: Vec<_> = (0..400).map(|number| SMALL.scene(number).scene).collect();
    for parameter in PARAMETERS {
        let moved = scenes.iter().filter(|scene| parameter.value(scene) != parameter.start()).count();
        // The bounds on the work of a step are the campaign's own.
        let own = ["solver.max_evaluations", "solver.deadline"].contains(&parameter.name);
        assert!(own || moved > 20, "{} has another value than the declared one in {moved} of 400", parameter.name);
    }
    for method in Method::ALL {
        assert!(scenes.iter().filter(|scene| scene.solver.method == *method).count() > 10, "{method:?}");
    }
    for joints in 0..16 {
        let clear = |scene: &slidercrank::scene::Scene| {
            let joint = &scene.joint;
            let models = [joint.a.model, joint.b.model, joint.c.model, joint.t.model];
            (0..4).all(|i| (models[i] == JointModel::Clearance) == (joints >> i & 1 == 1))
        };
        assert!(scenes.iter().any(clear), "joints {joints:04b}");
    }
}

/// How many turns the shipped scenes are run for here; `campaign --kind shipped` runs them for 60.
const TURNS: f64 = 1.0;
/// Every so many of the variants of the shipped scenes. It has no factor in common with the 96 variants of a scene: all
/// choices of play, drives and tolerances occur together.
const EVERY: usize = 23;

#[test]
fn where_any_adaptive_method_arrives_the_default_does_and_by_the_same_motion() {
    let campaign = Campaign { kind: Kind::Shipped, scenes: 0, seed: 0, turns: TURNS, effort: 1.0 };
    let count = Kind::Shipped.count().expect("they are not drawn");
    let numbers: Vec<u64> = (0..count).step_by(EVERY).collect();
    let failures: Vec<String> = numbers
        .par_iter()
        .filter_map(|number| match campaign.outcome(*number).verdict {
            Verdict::Failed(what) => Some(format!("{}: {what}", campaign.scene(*number).description)),
            _ => None,
        })
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn sixty_turns_of_plausible_machines_arrive() {
    let campaign = Campaign { kind: Kind::Machines, scenes: 24, seed: 3, turns: 60.0, effort: EFFORT };
    let outcomes = campaign.run(
        || {},
        |number, file| {
            eprintln!("machine {number} does not end:\n{}", write(file));
            exit(1);
        },
    );
    println!("{}", table(&outcomes).print());
    for (number, outcome) in outcomes.iter().enumerate() {
        assert!(!matches!(outcome.verdict, Verdict::Failed(_)), "machine {number}: {:?}", outcome.verdict);
    }
    let finished = outcomes.iter().filter(|outcome| outcome.verdict == Verdict::Finished).count();
    assert!(finished > 10, "{finished} machines came to the end");
}
