//! Settings of the solver that keep a loop's deadline, and their accuracy.

use super::loglog::{Bound, LogLog, Mark, Series};
use super::plot::{Role, Sheet};
use super::realtime::percent;
use super::table::Table;
use super::units::{grouped, three_digits};
use crate::precision::ladder::told;
use crate::realtime::deadline::{SHARE, TRIED, Trial, Trials};
use crate::realtime::{STEP, Timing};
use anyhow::Result;
use slidercrank::scene::Method;
use std::path::Path;

/// Longest time of a step of 1 ms and error with every setting, and the best setting.
pub fn table(scenes: &[Trials]) -> Table {
    let mut table = Table::default();
    let mut head = vec!["1 ms step at most, error".to_owned()];
    head.extend(TRIED.map(|(method, rung)| told(method, rung)));
    head.push(format!("within {} %", SHARE * 1e2));
    table.line(head);
    for scene in scenes {
        let mut line = vec![scene.scene.clone()];
        line.extend(scene.trials.iter().map(cell));
        line.push(scene.choice().map_or("none".into(), name));
        let failures: Vec<&str> = scene.trials.iter().filter_map(|trial| trial.failure()).collect();
        match failures.first() {
            Some(why) if failures.len() == scene.trials.len() => table.gap(line, why),
            _ => table.line(line),
        }
    }
    table
}

fn name(trial: &Trial) -> String {
    told(trial.point.method, trial.point.rung)
}

fn error(trial: &Trial) -> String {
    trial.point.error.map_or("–".into(), |error| format!("{error:.0e}"))
}

/// Longest time and error.
fn cell(trial: &Trial) -> String {
    match (trial.failure(), &trial.timing) {
        (None, Ok(timing)) => format!("{}, {}", percent(timing.bound()), error(trial)),
        _ => "fails".into(),
    }
}

/// Sentences about one scene of the table.
pub fn sentence(scene: &Trials) -> String {
    let window = match &scene.window {
        Ok(window) => format!("errors within the first {} ms", three_digits(window * 1e3)),
        Err(why) => format!("errors are not known ({why})"),
    };
    let mut text = format!("{}, settings: {window}.", scene.scene);
    text += &match scene.choice().and_then(|trial| Some((trial, trial.timing.as_ref().ok()?))) {
        Some((trial, timing)) => format!(
            " A loop that has {} % of each step for the mechanism is served most accurately by {}: no step of {} has \
             more than {} evaluations, {} of it; the error is {}.",
            SHARE * 1e2,
            name(trial),
            grouped(timing.steps.len() as f64),
            grouped(timing.longest(|step| step.evaluations).evaluations),
            percent(timing.bound()),
            error(trial),
        ),
        None => format!(
            " No setting that was tried leaves a loop {} % of each step without losing the motion.",
            (1.0 - SHARE) * 1e2
        ),
    };
    for trial in &scene.trials {
        if let Some(why) = trial.failure() {
            text += &format!(" {} fails: {why}.", name(trial));
        }
    }
    text
}

/// Figure of the longest time of a step against the error.
pub fn sheet(scenes: &[Trials]) -> Sheet<LogLog> {
    // The error 0 cannot be drawn on a logarithmic scale.
    let place = |trial: &&Trial| Some((trial.point.error.filter(|error| *error > 0.0)?, trial.share()?));
    let fails = |trial: &&Trial| trial.failure().is_some();
    // Methods with error control and methods with fixed steps are separate curves.
    let curve = |number: usize, scene: &Trials, method: Method| {
        let (odd, even): (Vec<&Trial>, Vec<&Trial>) =
            scene.trials.iter().filter(|trial| trial.point.method == method).partition(fails);
        Series {
            role: Role::Member(number),
            points: even.iter().filter_map(place).collect(),
            dots: true,
            odd: odd.iter().map(|trial| (Mark::Failed, trial.share())).collect(),
        }
    };
    let mut methods = TRIED.map(|(method, _)| method).to_vec();
    methods.dedup();
    let curves = |(number, scene): (usize, &Trials)| -> Vec<Series> {
        methods.iter().map(|method| curve(number, scene, *method)).collect()
    };
    let series = scenes.iter().enumerate().flat_map(curves);
    let choices: Vec<String> =
        scenes.iter().map(|scene| format!("{} {}", scene.scene, scene.choice().map_or("none".into(), name))).collect();
    let panel = LogLog {
        x_label: "largest position error over the clearance".into(),
        y_label: "most that a step of 1 ms takes, over the step".into(),
        series: series.collect(),
        floor: None,
        level: Some(Bound { at: 1.0, label: "real time".into() }),
        deadline: None,
        strip: Some("× failed".into()),
        text: format!("Most accurate within {} % of a step: {}.", SHARE * 1e2, choices.join("; ")),
    };
    Sheet {
        title: "What a communication step of 1 ms takes at most, by setting".into(),
        legend: scenes.iter().enumerate().map(|(i, scene)| (Role::Member(i), scene.scene.clone())).collect(),
        panels: vec![panel],
        columns: 1,
        panel_size: (920, 600),
    }
}

/// All numbers in SI units.
pub fn write_csv(scenes: &[Trials], file: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(file)?;
    csv.write_record([
        "scene",
        "method",
        "setting",
        "value",
        "error",
        "window_s",
        "step_s",
        "steps",
        "most_evaluations",
        "evaluation_s",
        "bound_s",
        "worst_cpu_s",
        "failure",
    ])?;
    let text = |number: Option<f64>| number.map_or(String::new(), |number| number.to_string());
    for scene in scenes {
        for trial in &scene.trials {
            let (point, timing) = (&trial.point, trial.timing.as_ref().ok());
            let of_steps = |measure: fn(&Timing) -> f64| timing.map(measure);
            let names = [&scene.scene, point.method.name(), point.rung.parameter()].map(String::from);
            let numbers = [
                Some(point.rung.number()),
                point.error,
                scene.window.as_ref().ok().copied(),
                Some(STEP),
                of_steps(|timing| timing.steps.len() as f64),
                of_steps(|timing| timing.longest(|step| step.evaluations).evaluations),
                of_steps(Timing::per_evaluation),
                of_steps(Timing::bound),
                of_steps(|timing| timing.longest(|step| step.cpu).cpu),
            ];
            let failure = trial.failure().unwrap_or_default().to_owned();
            csv.write_record(names.into_iter().chain(numbers.map(text)).chain([failure]))?;
        }
    }
    Ok(csv.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::precision::diagram::{Point, Verdict};
    use crate::precision::ladder::Rung;
    use crate::realtime::Step;

    /// Two steps in which an evaluation takes 1 µs, the second with `most` evaluations.
    fn trial(method: Method, rung: Rung, error: f64, most: f64) -> Trial {
        let step = |evaluations: f64| Step { cpu: evaluations * 1e-6, evaluations, ..Step::default() };
        let steps = vec![step(10.0), step(most)];
        let timing = Ok(Timing { scene: "own".into(), steps, restarts: 0, asked: 2 });
        let point = Point { error: Some(error), verdict: Verdict::Reached, ..Point::stopped(method, rung, "") };
        Trial { point, timing }
    }

    fn trials() -> Trials {
        let mut trials = vec![
            trial(Method::Automatic, Rung::Tolerance(1e-6), 1e-5, 1500.0),
            trial(Method::Automatic, Rung::Tolerance(1e-4), 3e-3, 400.0),
            trial(Method::Rk4, Rung::Step(1e-6), 1e-3, 450.0),
            trial(Method::Rk4, Rung::Step(2e-6), 1e-4, 300.0),
        ];
        trials[3].timing = Err("too coarse".into());
        Trials { scene: "own".into(), window: Ok(0.017), trials }
    }

    #[test]
    fn the_choice_is_the_most_accurate_that_keeps_its_time_and_does_not_fail() {
        let mut scene = trials();
        let choice = |scene: &Trials| scene.choice().map(|trial| trial.point.method);
        assert_eq!(choice(&scene), Some(Method::Rk4));
        // The other setting that keeps the deadline.
        scene.trials[2].point.verdict = Verdict::Failed("jumps".into());
        assert_eq!(choice(&scene), Some(Method::Automatic));
        for lost in [None, Some(0.2)] {
            scene.trials[1].point.error = lost;
            assert_eq!(choice(&scene), None);
        }
    }

    #[test]
    fn table_sentence_and_csv_tell_the_same() {
        let scene = trials();
        let markdown = table(std::slice::from_ref(&scene)).markdown();
        let row = "| own | 150 %, 1e-5 | 40.0 %, 3e-3 | 45.0 %, 1e-3 | fails | rk4 at steps of 1 µs |";
        assert!(markdown.contains(row), "{markdown}");
        let text = sentence(&scene);
        for part in [
            "first 17.0 ms",
            "rk4 at steps of 1 µs: no step of 2 has more than 450 evaluations, 45.0 %",
            "2 µs fails: too coarse",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let unknown = Trials { window: Err("it parts".into()), trials: vec![], ..scene.clone() };
        assert!(sentence(&unknown).contains("(it parts). No setting"), "{}", sentence(&unknown));
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        write_csv(&[scene], file.path()).expect("written");
        let mut csv = csv::Reader::from_path(file.path()).expect("a CSV");
        let head = csv.headers().expect("a head").clone();
        let rows: Vec<_> = csv.records().map(|row| row.expect("a row")).collect();
        let cell =
            |row: usize, name: &str| rows[row][head.iter().position(|own| own == name).expect("a column")].to_owned();
        assert_eq!(["most_evaluations", "value", "failure"].map(|name| cell(2, name)), ["450", "0.000001", ""]);
        assert_eq!(["bound_s", "error", "failure"].map(|name| cell(3, name)), ["", "0.0001", "too coarse"]);
    }
}
