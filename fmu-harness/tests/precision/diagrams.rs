//! Measured diagrams: references, ladders, failures.

use super::{AMPLE, diagram, point, with_subject};
use fmu_harness::precision::choice::Price;
use fmu_harness::precision::diagram::{Budget, Diagram, Verdict};
use fmu_harness::precision::ladder::{FIXED_STEP, Rung, methods, rungs};
use fmu_harness::precision::reference::Reference;
use fmu_harness::precision::ruler::Ruler;
use fmu_harness::precision::{Lengths, Subject};
use fmu_harness::run::{Ending, Look, march};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::Method;
use slidercrank::simulation::Simulation;
use std::time::Duration;

/// [s] In which coarse runs keep to the motion.
const SHORT: f64 = 2e-3;

fn reference(subject: &Subject) -> (Ruler, Reference) {
    let ruler = Ruler::of(&subject.file.scene);
    let reference = Reference::of(subject, &ruler, AMPLE.reference).expect("two methods that agree");
    (ruler, reference)
}

/// In the window, or the part of it before `end` [s].
fn error(subject: &Subject, ruler: &Ruler, reference: &Reference, method: Method, rung: Rung, end: f64) -> f64 {
    let experiment = subject.experiment(method, rung, reference.window, reference.grid);
    let run = march(subject.fmu, &experiment, Look::Everywhere, Duration::MAX).expect("a run");
    assert_eq!(run.ending, Ending::Reached, "{} at {rung:?}", method.name());
    ruler.error(&run.trajectory, &reference.trajectory, reference.window.min(end)).expect("the same outputs")
}

/// Over four decades of tolerance an error that followed it in proportion would fall ten thousandfold; impacts scatter
/// single errors by a factor of ten either way.
#[test]
fn errors_fall_with_the_tolerance_of_every_adaptive_method_and_with_the_step_of_the_others() {
    with_subject("wornpin", |subject| {
        let (ruler, reference) = reference(subject);
        for method in methods().0 {
            let error = |rung: Rung| error(subject, &ruler, &reference, method, rung, SHORT);
            let (coarse, fine, factor) = if method.has(FIXED_STEP) {
                // At first order, in proportion: 25.
                (Rung::Step(5e-6), Rung::Step(2e-7), 5.0)
            } else {
                (Rung::Tolerance(1e-4), Rung::Tolerance(1e-8), 100.0)
            };
            let (coarse, fine) = (error(coarse), error(fine));
            assert!(fine * factor < coarse, "{}: {coarse:e} falls to {fine:e}", method.name());
        }
    });
}

#[test]
fn the_reference_is_better_than_what_it_judges_and_its_window_holds_impacts() {
    with_subject("wornpin", |subject| {
        let (ruler, reference) = reference(subject);
        // The first impact comes at 6.8186° of a turn, after 0.227 ms.
        assert!(reference.window > 5e-3, "{}", reference.window);
        assert!(reference.error > 0.0 && reference.error <= 5e-8, "{}", reference.error);
        let found = error(subject, &ruler, &reference, Method::Dopri5, Rung::Tolerance(1e-10), f64::INFINITY);
        assert!(found < 1e-5, "a third method comes near it too: {found:e}");
    });
}

/// `fixed step` says what a method goes by: its runs at two tolerances are the same, to the bit, and others are not.
#[test]
fn a_method_keeps_the_properties_that_it_declares() {
    with_subject("wornpin", |subject| {
        for method in Method::ALL {
            let run = |tolerance: f64, step: f64| {
                let mut scene = subject.file.scene.clone();
                (scene.solver.method, scene.solver.tolerance, scene.solver.step) = (*method, tolerance, step);
                let mut simulation = Simulation::start(&scene, Inputs::default()).expect("a closed loop");
                simulation.advance_to(1e-3).expect("a motion without trouble");
                let outputs = simulation.outputs();
                (outputs.slider.x.to_bits(), outputs.solver.evaluations)
            };
            let own = run(1e-6, 1e-6);
            let by_step = method.has(FIXED_STEP);
            assert_eq!(run(1e-6, 5e-7) == own, !by_step, "{}: solver.step", method.name());
            if by_step {
                // What a landing on an event asks of its event function goes by the tolerance all the same.
                let steps = f64::from(run(1e-3, 1e-6).1) / f64::from(own.1);
                assert!((0.9..1.1).contains(&steps), "{}: solver.tolerance", method.name());
            } else {
                assert!(run(1e-3, 1e-6) != own, "{}: solver.tolerance", method.name());
            }
        }
    });
}

#[test]
fn a_small_mechanism_gives_a_whole_diagram() {
    with_subject("effects/01-ideal", |subject| {
        let (ruler, reference) = reference(subject);
        let diagram = Diagram::of(subject, &ruler, &reference, &AMPLE, |_, _| {}).expect("a diagram");
        let (methods, _) = methods();
        assert_eq!(diagram.methods(), methods);
        for method in methods {
            let points: Vec<_> = diagram.of_method(method).collect();
            let tried: Vec<Rung> = points.iter().map(|point| point.rung).collect();
            assert_eq!(tried, rungs(method, true), "{}", method.name());
            for point in points {
                let wanted = (Verdict::Reached, true, true);
                let found = (point.verdict.clone(), point.error.is_some(), point.cost.is_some_and(|cost| cost > 0.0));
                assert_eq!(found, wanted, "{} at {:?}", method.name(), point.rung);
                assert!((point.over - diagram.span).abs() < 1e-9);
            }
        }
        let best = diagram.cheapest(1e-6).expect("no contact, no trouble");
        assert!(best.error.expect("an error") <= 1e-6);
    });
}

#[test]
fn a_run_that_is_too_dear_is_stopped_and_finer_ones_are_not_begun() {
    with_subject("wornpin", |subject| {
        let (ruler, reference) = reference(subject);
        let budget = Budget { run: Duration::ZERO, ..AMPLE };
        let diagram = Diagram::of(subject, &ruler, &reference, &budget, |_, _| {}).expect("a diagram");
        assert!(diagram.points.iter().all(|point| point.is_stopped() && point.error.is_none()));
        for method in diagram.methods() {
            let begun: Vec<bool> = diagram.of_method(method).map(|point| point.cost.is_some()).collect();
            assert!(begun[0] && begun[1..].iter().all(|begun| !begun), "{}", method.name());
        }
    });
}

#[test]
fn a_run_that_gives_up_is_a_failure_with_the_words_of_the_fmu() {
    with_subject("guideplay", |subject| {
        let experiment = subject.experiment(Method::Rk4, Rung::Step(5e-5), 0.02, 1e-5);
        let run = march(subject.fmu, &experiment, Look::Everywhere, Duration::MAX).expect("a start");
        let Ending::Failed(why) = run.ending else { unreachable!("contacts of 10 µs at steps of 50 µs") };
        assert!(why.contains("fmi2Discard") && why.contains("at t = "), "{why}");
        assert!(run.simulated > 0.0 && run.trajectory.len() > 1);
    });
}

#[test]
fn a_choice_is_not_left_to_chance() {
    let own = Method::default();
    let runs = [(1e-3, 5e-2, 1.0), (1e-4, 5e-5, 2.0), (1e-5, 5e-4, 3.0), (1e-6, 5e-5, 4.0), (1e-7, 5e-6, 8.0)];
    let mut points: Vec<_> = runs.map(|(tolerance, error, cost)| point(own, tolerance, error, cost)).into();
    points.push(point(Method::Dopri5, 1e-3, 5e-4, 2.5));
    let diagram = diagram(points);
    let cost = |method: Method, error: f64| diagram.keeping(method, error).and_then(|point| point.cost);
    // At 1e-4 the second run was lucky, as the third one shows.
    assert_eq!([1e-1, 1e-3, 1e-4, 1e-5, 1e-6].map(|error| cost(own, error)), [1.0, 2.0, 4.0, 8.0, 0.0].map(some));
    assert_eq!(diagram.cheapest(1e-3).and_then(|point| point.cost), Some(2.0));
    assert_eq!(diagram.cheapest(1e-7), None);
    // From 5e-2 at 1 to 5e-6 at 8 in four digits.
    let factor = diagram.digit(own).expect("several digits");
    assert!((factor - 8f64.powf(0.25)).abs() < 1e-12, "{factor}");
    assert_eq!(diagram.digit(Method::Dopri5), None);
}

#[test]
fn costs_between_the_rungs_are_on_a_line_of_their_logarithms() {
    let own = Method::default();
    // A digit costs twice as much, and neighbours scatter about that by as much up as down.
    let scatter = [1.0, 1.1, 1.0 / 1.1, 1.0 / 1.1, 1.1, 1.0];
    let run = |(i, scatter)| point(own, 10f64.powi(-3 - i), 3.0 * 10f64.powi(-2 - i), scatter * 2f64.powi(i));
    let mut points: Vec<_> = (0..).zip(scatter).map(run).collect();
    points.push(point(Method::Dopri5, 1e-3, 1e-2, 1.0));
    points.push(point(Method::Dopri5, 1e-4, 1e-4, 2.0));
    let diagram = diagram(points);
    // In the middle of the four from 3e-3 to 3e-6, at 2^2.5.
    let found = diagram.between(own, 3.0 * 10f64.powf(-4.5)).expect("between its runs");
    assert!((found.cost - 2f64.powf(2.5)).abs() < 1e-12 && !found.is_bound, "{found:?}");
    assert_eq!(diagram.cheapest_between(3.0 * 10f64.powf(-4.5)), Some((own, found)));
    assert_eq!(diagram.between(own, 0.05), Some(Price { cost: 1.0, is_bound: true }), "all its runs keep to that");
    assert_eq!(diagram.between(own, 1e-9), None, "no run of it keeps to that");
    assert_eq!(diagram.between(Method::Dopri5, 1e-3), None, "two runs are too few");
}

#[test]
fn a_scene_is_looked_at_for_as_long_as_is_asked_for() {
    with_subject("wornpin", |subject| {
        let lengths = Lengths { window: Some(SHORT), span: Some(0.1) };
        let asked = Subject { lengths, ..*subject };
        let (_, reference) = reference(&asked);
        assert_eq!(reference.window, SHORT);
        assert_eq!(asked.span(reference.window), 0.1);
        assert_eq!(asked.span(0.2), 0.2, "the window in any case");
        assert!((subject.span(SHORT) - 0.012).abs() < 1e-12, "a turn");
    });
}

fn some(cost: f64) -> Option<f64> {
    (cost > 0.0).then_some(cost)
}
