//! What `precision` tells of FMPy is what this program finds by itself.

use super::{packages, python};
use fmu_harness::host::Fmu;
use fmu_harness::precision::hosts::{METHOD, STEPS, TOLERANCE, measure};
use fmu_harness::precision::ladder::Rung;
use fmu_harness::precision::reference::Reference;
use fmu_harness::precision::ruler::Ruler;
use fmu_harness::precision::{Lengths, Subject};
use fmu_harness::run::{Look, march};
use fmu_harness::scenes::Scenario;
use std::time::Duration;

/// [s] A little longer than the window, and a whole number of the longest communication step.
const SPAN: f64 = 0.012;

#[test]
fn fmpy_finds_the_error_and_the_work_that_this_program_finds() {
    let file = packages::directory().join("wornpin.fmu");
    let (fmu, scenario) = (Fmu::open(&file).expect("an FMU"), Scenario::find("wornpin").expect("a shipped scene"));
    let subject = Subject { file: &scenario.file, fmu: &fmu, lengths: Lengths::OF_SCENE };
    let ruler = Ruler::of(&scenario.file.scene);
    let reference = Reference::of(&subject, &ruler, Duration::from_secs(600)).expect("a reference");
    let found = measure(&Ok(python().into()), &subject, &file, &ruler, &reference, SPAN);
    assert_eq!(found.len(), STEPS.len());
    for (point, step) in found.iter().zip(STEPS) {
        let experiment = subject.experiment(METHOD, Rung::Tolerance(TOLERANCE), reference.window, step);
        let run = march(&fmu, &experiment, Look::Everywhere, Duration::MAX).expect("a run");
        let own = ruler.error(&run.trajectory, &reference.trajectory, reference.window).expect("the same outputs");
        let found = point.outcome.as_ref().expect("a measurement");
        // A host's sums of steps differ from whole multiples in the last digit of a time.
        let error = found.error.expect("communication points in the window");
        assert!(point.step == step && (error / own - 1.0).abs() < 1e-3, "{error:e} and {own:e} at {step} s");
        assert!((found.over - SPAN).abs() < 1e-9 && found.unit <= found.total);
        let experiment = subject.experiment(METHOD, Rung::Tolerance(TOLERANCE), SPAN, step);
        let run = march(&fmu, &experiment, Look::AtEnds, Duration::MAX).expect("a run");
        let work = run.trajectory.column("solver.evaluations").expect("an output")[1] / SPAN;
        assert!((found.evaluations / work - 1.0).abs() < 1e-9, "{} and {work}", found.evaluations);
    }
}

#[test]
fn without_python_every_step_says_why() {
    let file = packages::directory().join("wornpin.fmu");
    let (fmu, scenario) = (Fmu::open(&file).expect("an FMU"), Scenario::find("wornpin").expect("a shipped scene"));
    let subject = Subject { file: &scenario.file, fmu: &fmu, lengths: Lengths::OF_SCENE };
    let ruler = Ruler::of(&scenario.file.scene);
    let reference = Reference::of(&subject, &ruler, Duration::from_secs(600)).expect("a reference");
    let missing = Err(anyhow::anyhow!("there is none"));
    let found = measure(&missing, &subject, &file, &ruler, &reference, SPAN);
    assert!(found.iter().all(|point| point.outcome == Err("there is none".into())) && found.len() == STEPS.len());
}
