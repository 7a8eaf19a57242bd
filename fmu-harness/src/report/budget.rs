//! The longest communication step and the error with `solver.deadline`, and without.

use super::realtime::percent;
use super::table::Table;
use super::units::{grouped, three_digits};
use crate::realtime::budget::{Budgeted, TOLERABLE};
use crate::realtime::deadline::Trial;
use crate::realtime::{STEP, Timing};
use anyhow::Result;
use std::path::Path;

/// A number of a series of steps.
type Measure = fn(&Timing) -> f64;
/// The longest communication step, in CPU time and by the clock.
const TIMES: [Measure; 2] = [Timing::worst, |timing| timing.longest(|step| step.wall).wall];

/// Longest step and error of each scene without a deadline and within it.
pub fn table(scenes: &[Budgeted]) -> Table {
    let mut table = Table::default();
    let head = ["1 ms step at most", "without deadline", "error", "of a core", "deadline [1/s]", "within it"];
    let more = ["by the clock", "most evaluations", "error", "estimate", "loosened steps"];
    table.line(head.into_iter().chain(more).map(String::from).collect());
    for scene in scenes {
        let mut line = vec![scene.scene.clone()];
        line.extend([time(&scene.free, Timing::worst), error(&scene.free), share(scene)]);
        line.push(format!("{:.2e}", scene.deadline));
        line.extend(TIMES.map(|measure| time(&scene.kept, measure)));
        line.push(of_steps(&scene.kept, |timing| grouped(timing.longest(|step| step.evaluations).evaluations)));
        line.push(error(&scene.kept));
        line.push(of_steps(&scene.kept, |timing| format!("{:.0e}", timing.longest(|step| step.error).error)));
        line.push(of_steps(&scene.kept, |_| format!("{} %", three_digits(scene.hits() * 1e2))));
        match scene.kept.failure() {
            Some(why) if scene.kept.timing.is_err() => table.gap(line, why),
            _ => table.line(line),
        }
    }
    table
}

fn share(scene: &Budgeted) -> String {
    format!("{} %", three_digits(scene.share * 1e2))
}

fn error(trial: &Trial) -> String {
    trial.point.error.map_or("–".into(), |error| format!("{error:.0e}"))
}

fn of_steps(trial: &Trial, text: impl Fn(&Timing) -> String) -> String {
    trial.timing.as_ref().map_or("fails".into(), text)
}

fn time(trial: &Trial, measure: fn(&Timing) -> f64) -> String {
    of_steps(trial, |timing| percent(measure(timing)))
}

/// Sentences about one row of the table.
pub fn sentence(scene: &Budgeted) -> String {
    let Budgeted { scene: name, deadline, free, kept, .. } = scene;
    let timing = match &kept.timing {
        Ok(timing) => timing,
        Err(why) => return format!("{name}, deadline: it fails: {why}."),
    };
    let holds = if scene.is_kept() { "" } else { ", which is more than that" };
    let mut text = format!(
        "{name}, deadline: for {} of a core, solver.deadline = {deadline:.2e}. Of {} steps of 1 ms the worst takes {}{holds}; \
         without a deadline {}. {} % of the integrator's steps had larger errors than the tolerance allows.",
        share(scene),
        grouped(timing.steps.len() as f64),
        percent(timing.worst()),
        time(free, Timing::worst),
        three_digits(scene.hits() * 1e2),
    );
    text += &match (&scene.window, kept.point.error) {
        (Ok(window), Some(error)) => {
            let judged = if error <= TOLERABLE { "within" } else { "beyond" };
            let window = three_digits(window * 1e3);
            format!(" The error in the first {window} ms is {error:.0e}, {judged} {TOLERABLE:.0e}.")
        }
        (Err(why), _) => format!(" Errors are not known ({why})."),
        (Ok(_), None) => format!(" Its error is not known ({}).", kept.failure().unwrap_or("it was stopped")),
    };
    text
}

/// All numbers in SI units.
pub fn write_csv(scenes: &[Budgeted], file: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(file)?;
    let measures: [(&str, Measure); 4] = [
        ("worst_cpu_s", Timing::worst),
        ("worst_wall_s", |timing| timing.longest(|step| step.wall).wall),
        ("most_evaluations", |timing| timing.longest(|step| step.evaluations).evaluations),
        ("steps", |timing| timing.steps.len() as f64),
    ];
    let mut head = ["scene", "step_s", "share", "deadline", "window_s", "loosened"].map(String::from).to_vec();
    for kind in ["free", "kept"] {
        head.push(format!("{kind}_error"));
        head.extend(measures.map(|(name, _)| format!("{kind}_{name}")));
    }
    csv.write_record(head)?;
    let text = |number: Option<f64>| number.map_or(String::new(), |number| number.to_string());
    for scene in scenes {
        let window = scene.window.as_ref().ok().copied();
        let mut numbers = vec![Some(STEP), Some(scene.share), Some(scene.deadline), window, Some(scene.hits())];
        for trial in [&scene.free, &scene.kept] {
            numbers.push(trial.point.error);
            numbers.extend(measures.map(|(_, measure)| trial.timing.as_ref().ok().map(measure)));
        }
        csv.write_record(std::iter::once(scene.scene.clone()).chain(numbers.into_iter().map(text)))?;
    }
    Ok(csv.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::precision::diagram::{Point, Verdict};
    use crate::precision::ladder::Rung;
    use crate::realtime::Step;
    use crate::realtime::scheduler::Scheduler;
    use slidercrank::scene::Method;

    /// Steps in which an evaluation takes 1 µs, the largest of `most` evaluations.
    fn trial(rung: Rung, error: f64, most: f64, hits: f64) -> Trial {
        let step = |evaluations: f64| {
            let cpu = evaluations * 1e-6;
            Step { cpu, wall: 2.0 * cpu, evaluations, steps: 10.0, hits, error: 3e-3, ..Step::default() }
        };
        let timing = Ok(Timing { scene: "own".into(), steps: vec![step(10.0), step(most)], restarts: 0, asked: 2 });
        let point =
            Point { error: Some(error), verdict: Verdict::Reached, ..Point::stopped(Method::Automatic, rung, "") };
        Trial { point, timing }
    }

    fn budgeted() -> Budgeted {
        Budgeted {
            scene: "own".into(),
            share: 0.5,
            window: Ok(0.017),
            free: trial(Rung::Tolerance(1e-6), 1e-5, 1500.0, 0.0),
            deadline: 4.5e5,
            kept: trial(Rung::Deadline(4.5e5), 3e-3, 450.0, 1.0),
            scheduler: Scheduler::RealTime,
        }
    }

    #[test]
    fn table_sentence_and_csv_tell_the_same() {
        let scene = budgeted();
        let markdown = table(std::slice::from_ref(&scene)).markdown();
        let row = "| own | 150 % | 1e-5 | 50.0 % | 4.50e5 | 45.0 % | 90.0 % | 450 | 3e-3 | 3e-3 | 10.0 % |";
        assert!(markdown.contains(row), "{markdown}");
        let text = sentence(&scene);
        for part in
            ["solver.deadline = 4.50e5", "the worst takes 45.0 %; without a deadline 150 %", "is 3e-3, within 1e-2"]
        {
            assert!(text.contains(part), "{part}: {text}");
        }
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        write_csv(&[scene], file.path()).expect("written");
        let mut csv = csv::Reader::from_path(file.path()).expect("a CSV");
        let head = csv.headers().expect("a head").clone();
        let row = csv.records().next().expect("a row").expect("legal");
        let cell = |name: &str| row[head.iter().position(|own| own == name).expect("a column")].parse::<f64>().ok();
        let names = ["deadline", "free_most_evaluations", "kept_most_evaluations", "kept_error", "loosened"];
        assert_eq!(names.map(cell), [4.5e5, 1500.0, 450.0, 3e-3, 0.1].map(Some));
    }

    #[test]
    fn what_is_not_kept_and_what_fails_is_told() {
        let mut scene = budgeted();
        scene.kept = trial(Rung::Deadline(4.5e5), 0.3, 600.0, 1.0);
        let text = sentence(&scene);
        assert!(text.contains("60.0 %, which is more than that") && text.contains("3e-1, beyond 1e-2"), "{text}");
        scene.kept.timing = Err("refused".into());
        assert_eq!(sentence(&scene), "own, deadline: it fails: refused.");
        assert!(table(&[scene]).markdown().contains("refused"));
    }
}
