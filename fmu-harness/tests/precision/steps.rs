//! Communication steps one by one.

use super::open;
use fmu_harness::inputs;
use fmu_harness::precision::ladder::Rung;
use fmu_harness::precision::{Lengths, Subject};
use fmu_harness::realtime::budget::Budgeted;
use fmu_harness::realtime::deadline::{Bench, TRIED, Trial, Trials};
use fmu_harness::realtime::{STEP, Timing};
use fmu_harness::run::{Experiment, Until, run};
use fmu_harness::scenes::Scenario;
use slidercrank::scene::read::read;
use std::time::Duration;

#[test]
fn the_steps_add_up_to_the_run() {
    let scenario = Scenario::find("press").expect("a legal scene");
    let fmu = open(&scenario);
    let count = 30;
    let timing = Timing::of(&scenario.file, &fmu, vec![], count, Duration::MAX, |_| {}).expect("a run without trouble");
    let experiment = Experiment {
        settings: vec![],
        inputs: inputs::of_scene(&scenario.file.inputs),
        start: 0.0,
        until: Until::Time(count as f64 * STEP),
        step: STEP,
        tolerance: None,
    };
    let recording = run(&fmu, &experiment, |_| {}, |_| {}).expect("a run without trouble");
    let counted = |name: &str| {
        let column = recording.column(name).expect("an output");
        column[column.len() - 1] - column[0]
    };
    let sum = |measure: fn(&fmu_harness::realtime::Step) -> f64| timing.steps.iter().map(measure).sum::<f64>();
    assert_eq!((timing.steps.len(), timing.restarts), (count, 0));
    assert_eq!(sum(|step| step.evaluations), counted("solver.evaluations"));
    assert_eq!(sum(|step| step.steps), counted("solver.steps"));
    assert_eq!(sum(|step| step.events), counted("solver.events"));
    assert!(timing.bound() > 0.0 && sum(|step| step.events) > 0.0);
}

#[test]
fn a_mechanism_that_comes_to_rest_begins_anew_and_a_budget_is_kept() {
    let text = "name = \"brake\"\ndescription = \"slows down\"\n[drive]\nmode = \"torque\"\n[crank]\nspeed_start = 100\n\
                inertia = 1e-3\n[joint.A]\ndamping = 1.0\n";
    let file = read(text, "brake.toml").expect("a legal scene");
    let scenario = Scenario { name: "brake".into(), text: text.into(), file };
    let fmu = open(&scenario);
    // A turn at 100 rad/s takes 63 steps; damping and inertia stop the crank within a few.
    let timing = Timing::of(&scenario.file, &fmu, vec![], 200, Duration::MAX, |_| {}).expect("a run without trouble");
    assert_eq!((timing.restarts, timing.steps.len()), (3, 200));
    let none = Timing::of(&scenario.file, &fmu, vec![], 50, Duration::ZERO, |_| {}).expect("nothing to run");
    assert_eq!((none.steps.len(), none.asked), (0, 50));
}

#[test]
fn fixed_steps_cost_the_same_in_every_communication_step() {
    let scenario = Scenario::find("press").expect("a legal scene");
    let fmu = open(&scenario);
    let subject = Subject { file: &scenario.file, fmu: &fmu, lengths: Lengths::OF_SCENE };
    let trials = Trials::of(&Bench::of(&subject), 30, Duration::MAX, |_, _| {}).expect("runs that can be compared");
    assert_eq!(trials.trials.len(), TRIED.len());
    let mut seen = 0;
    for trial in &trials.trials {
        let timing = trial.timing.as_ref().expect("a run without trouble");
        assert_eq!((trial.failure(), timing.steps.len()), (None, 30));
        if let Rung::Step(step) = trial.point.rung {
            seen += 1;
            for own in &timing.steps {
                // Four in each step; landings on contacts that open or close, and what the communication point cuts off, add few.
                let plain = (4.0 * STEP / step).round();
                let more = 16.0 * own.events + 16.0;
                assert!((plain..=plain + more).contains(&own.evaluations), "{own:?}");
            }
        }
    }
    assert_eq!(seen, 3);
    let errors: Vec<f64> = trials.trials.iter().map(|trial| trial.point.error.expect("an error")).collect();
    assert!(errors[0] < errors[2] && errors[3] < errors[5], "{errors:?}");
}

#[test]
fn a_deadline_is_found_and_its_steps_keep_to_it() {
    let scenario = Scenario::find("press").expect("a legal scene");
    let fmu = open(&scenario);
    let subject = Subject { file: &scenario.file, fmu: &fmu, lengths: Lengths::OF_SCENE };
    // So small a share that steps must give up accuracy.
    let found = Budgeted::of(&Bench::of(&subject), &[0.02], 30, Duration::MAX, || ()).expect("runs to compare");
    let [own] = found.as_slice() else { unreachable!("one share, one row") };
    assert_eq!((own.kept.failure(), own.free.failure()), (None, None));
    let most =
        |trial: &Trial| trial.timing.as_ref().map_or(f64::NAN, |t| t.longest(|step| step.evaluations).evaluations);
    assert!(own.deadline > 0.0 && own.hits() > 0.0);
    assert!(most(&own.kept) < most(&own.free), "{} of {}", most(&own.kept), most(&own.free));
}
