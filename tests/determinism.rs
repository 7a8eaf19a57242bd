//! The same bits twice, after a restore, and for any split of the communication interval; and an input
//! that changes at a communication point changes there and nowhere else.

#[path = "determinism/inputs.rs"]
mod inputs;
#[path = "determinism/mechanisms.rs"]
mod mechanisms;

use mechanisms::{
    Dice, END, INPUTS, METHODS, advance, bits, hurried, mechanisms, memory, outputs_at, reached, split, start, stiff,
};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::{Method, Scene};
use slidercrank::simulation::{Simulation, Snapshot};

/// Every mechanism under every method, in stiff motion, and within a deadline.
fn all() -> impl Iterator<Item = (String, Scene)> {
    METHODS.into_iter().flat_map(mechanisms).chain(stiff()).chain(hurried())
}

#[test]
fn stiff_runs_are_left_to_the_linearly_implicit_method() {
    let spared = stiff().filter(|(_, scene)| {
        let [automatic, explicit] = [Method::Automatic, Method::Verner7].map(|method| {
            let mut scene = scene.clone();
            scene.solver.method = method;
            outputs_at(&mut start(&scene), END).solver.evaluations
        });
        2 * automatic < explicit
    });
    // The others ring all the time.
    let count = spared.count();
    assert!(count >= 8, "{count} of 32");
}

#[test]
fn runs_within_a_deadline_give_up_accuracy() {
    for (name, scene) in hurried().filter(|(name, _)| name.ends_with(|letter: char| "ABCT".contains(letter))) {
        let mut free = scene.clone();
        free.solver.deadline = 0.0;
        let [hurried, free] = [&scene, &free].map(|scene| outputs_at(&mut start(scene), END).solver);
        assert!(hurried.deadline_hits > 0 && free.deadline_hits == 0, "{name}: {hurried:?}");
        assert!(hurried.evaluations < free.evaluations && hurried.error_estimate > free.error_estimate, "{name}");
    }
}

#[test]
fn the_same_bits_twice() {
    for (name, scene) in all() {
        let [one, other] = [(); 2].map(|()| {
            let mut simulation = start(&scene);
            advance(&mut simulation, END);
            (bits(&simulation.outputs()), memory(&simulation))
        });
        assert_eq!(one, other, "{name}");
    }
}

#[test]
fn contacts_and_events_go_on_in_these_runs() {
    for (name, scene) in METHODS.into_iter().flat_map(mechanisms) {
        let events = outputs_at(&mut start(&scene), END).solver.events;
        let clear = name.chars().rev().take_while(|letter| "ABCT".contains(*letter)).count();
        assert!(events >= 2 * clear as i32, "{name}: {events} events");
    }
}

#[test]
fn the_same_bits_for_any_split_of_the_interval() {
    let mut dice = Dice(0x5EED);
    for (name, scene) in all() {
        let mut whole = start(&scene);
        advance(&mut whole, END);
        let wanted = reached(&mut whole);
        for _ in 0..4 {
            let mut simulation = start(&scene);
            for t in split(&mut dice, 0.0) {
                advance(&mut simulation, t);
                // Whether and what is asked on the way makes no difference.
                match dice.throw() {
                    x if x < 0.3 => drop(simulation.outputs()),
                    x if x < 0.4 => drop(simulation.output_rates()),
                    x if x < 0.5 => drop(simulation.output_sensitivity(INPUTS)),
                    x if x < 0.6 => simulation.set_inputs(INPUTS, Inputs::default()),
                    _ => {}
                }
            }
            assert_eq!(reached(&mut simulation), wanted, "{name}");
        }
    }
}

#[test]
fn the_same_bits_on_the_way_whatever_was_asked_before() {
    let mut dice = Dice(0xD1CE);
    for (name, scene) in mechanisms(Method::Verner7) {
        let mut walker = start(&scene);
        for t in split(&mut dice, 0.0) {
            let mut jumper = start(&scene);
            advance(&mut walker, t);
            advance(&mut jumper, t);
            assert_eq!(reached(&mut walker).0, reached(&mut jumper).0, "{name} at {t}");
        }
    }
}

#[test]
fn a_restored_run_is_one_that_never_stopped() {
    let mut dice = Dice(0xCAFE);
    for (name, scene) in all() {
        let mut whole = start(&scene);
        let mut saved = vec![];
        let times = split(&mut dice, 0.0);
        for &t in &times {
            advance(&mut whole, t);
            if dice.throw() < 0.3 {
                saved.push((t, whole.snapshot(), bits(&whole.outputs())));
            }
            if dice.throw() < 0.2 {
                let change = Inputs { crank_torque: 3.0 * dice.throw(), slider_load: 0.0 };
                whole.set_inputs(change, Inputs { crank_torque: 0.0, slider_load: 10.0 });
                saved.clear();
            }
        }
        let wanted = reached(&mut whole);
        for (t, snapshot, outputs) in saved {
            let mut again = Simulation::restore(&scene, &snapshot).expect("its own state");
            assert_eq!((again.time(), bits(&again.outputs())), (t, outputs), "{name} at {t}");
            assert_eq!(again.snapshot(), snapshot, "{name} at {t}");
            for t in split(&mut dice, t) {
                advance(&mut again, t);
            }
            assert_eq!(reached(&mut again), wanted, "{name} from {t}");
        }
    }
}

#[test]
fn a_snapshot_of_another_mechanism_is_refused() {
    let all: Vec<(String, Scene)> = mechanisms(Method::Verner7).collect();
    for (name, scene) in &all {
        let snapshot = start(scene).snapshot();
        for (other_name, other) in &all {
            let same_size =
                Simulation::start(other, INPUTS).expect("a start").snapshot().reals.len() == snapshot.reals.len();
            let restored = Simulation::restore(other, &snapshot);
            assert_eq!(restored.is_ok(), same_size, "{name} as {other_name}");
        }
    }
    let (_, scene) = &all[31];
    let whole = start(scene).snapshot();
    for cut in 0..whole.reals.len() {
        let snapshot = Snapshot { reals: whole.reals[..cut].to_vec(), integers: whole.integers.clone() };
        assert!(Simulation::restore(scene, &snapshot).is_err(), "{cut} reals");
    }
    let mut long = whole;
    long.integers.push(0);
    assert!(Simulation::restore(scene, &long).is_err());
}
