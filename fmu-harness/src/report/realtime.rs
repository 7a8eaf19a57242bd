//! Times of communication steps: their distribution, and the contents of the longest steps.

use super::loglog::{Bound, LogLog, Series};
use super::plot::{Role, Sheet};
use super::table::Table;
use super::units::{grouped, three_digits};
use crate::realtime::{STEP, Step, Timing, quantile};
use anyhow::Result;
use std::path::Path;

/// Quantiles of the times that are given, in addition to the longest time.
const SHARES: [f64; 5] = [0.5, 0.9, 0.99, 0.999, 0.9999];
/// Number of points of a curve per decade.
const DENSITY: f64 = 25.0;
/// A step's time: function that reads it, name on a scale, name of a column.
type Measure = (fn(&Step) -> f64, &'static str, &'static str);
/// The two times of a step.
const MEASURES: [Measure; 2] = [(|step| step.wall, "by the clock", "wall"), (|step| step.cpu, "CPU time", "cpu")];

/// Table of times as shares of the communication step in percent.
pub fn table(timings: &[Timing]) -> Table {
    let mut table = Table::default();
    let head = ["1 ms step", "steps", "median", "99.9 %", "worst", "CPU of it", "worst CPU", "of it: contacts changed"];
    let more = ["solver steps", "evaluations", "most evaluations", "ns/evaluation", "bound"];
    table.line(head.into_iter().chain(more).map(String::from).collect());
    for timing in timings {
        let wall = timing.sorted(|step| step.wall);
        let (worst, dearest) = (timing.longest(|step| step.wall), timing.longest(|step| step.cpu));
        let mut line = vec![timing.scene.clone(), grouped(timing.steps.len() as f64)];
        line.extend([quantile(&wall, 0.5), quantile(&wall, 0.999), worst.wall, worst.cpu, dearest.cpu].map(percent));
        line.extend([dearest.events, dearest.steps, dearest.evaluations].map(grouped));
        line.push(grouped(timing.longest(|step| step.evaluations).evaluations));
        line.push(three_digits(timing.per_evaluation() * 1e9));
        line.push(percent(timing.bound()));
        table.line(line);
    }
    table
}

/// A time as a share of the step.
pub(super) fn percent(seconds: f64) -> String {
    format!("{} %", three_digits(seconds / STEP * 1e2))
}

/// Sentences about one scene of the table.
pub fn sentence(timing: &Timing) -> String {
    let wall = timing.sorted(|step| step.wall);
    let (worst, dearest) = (timing.longest(|step| step.wall), timing.longest(|step| step.cpu));
    let mut text = format!(
        "{}: of {} steps of 1 ms half take at most {} of the step by the clock, 99.9 % at most {}, the longest {}, of \
         which {} is CPU time of its own. The dearest, to t = {} s, takes {} of CPU time: {} contacts opened or closed in \
         it, {} steps of the integrator, {} evaluations. No step has more than {} evaluations; at {} ns each, all in, that is {} of \
         the step.",
        timing.scene,
        grouped(timing.steps.len() as f64),
        percent(quantile(&wall, 0.5)),
        percent(quantile(&wall, 0.999)),
        percent(worst.wall),
        percent(worst.cpu),
        format_args!("{:.3}", dearest.end),
        percent(dearest.cpu),
        grouped(dearest.events),
        grouped(dearest.steps),
        grouped(dearest.evaluations),
        grouped(timing.longest(|step| step.evaluations).evaluations),
        three_digits(timing.per_evaluation() * 1e9),
        percent(timing.bound()),
    );
    if timing.steps.len() < timing.asked {
        text += &format!(" Its time was over before {} steps.", grouped(timing.asked as f64));
    }
    if timing.restarts > 0 {
        text += &format!(" Its crank slows down: it began anew {} times.", grouped(timing.restarts as f64));
    }
    text
}

/// Figure of the distribution: share of the steps that take at least as long as a share of a step.
pub fn sheet(timings: &[Timing]) -> Sheet<LogLog> {
    let panel = |(measure, name, _): Measure| LogLog {
        x_label: format!("time of a step over the step, {name}"),
        y_label: "share of the steps that take at least as long".into(),
        series: timings.iter().enumerate().map(|(number, timing)| curve(number, &timing.sorted(measure))).collect(),
        floor: None,
        level: None,
        deadline: Some(Bound { at: 1.0, label: "real time".into() }),
        strip: None,
        text: String::new(),
    };
    Sheet {
        title: "How long a communication step of 1 ms takes".into(),
        legend: timings.iter().enumerate().map(|(i, timing)| (Role::Member(i), timing.scene.clone())).collect(),
        panels: MEASURES.into_iter().map(panel).collect(),
        columns: 2,
        panel_size: (600, 480),
    }
}

/// Points of the curve: every one of the longest steps, the others at equal distances on the scale.
fn curve(number: usize, ascending: &[f64]) -> Series {
    let count = ascending.len() as f64;
    let decades = (0..).map(|place| 10f64.powf(f64::from(place) / DENSITY).round());
    let mut ranks: Vec<usize> = decades.take_while(|rank| *rank < count).map(|rank| rank as usize).collect();
    ranks.push(ascending.len());
    ranks.dedup();
    let point = |rank: usize| Some((ascending.get(ascending.len().checked_sub(rank)?)? / STEP, rank as f64 / count));
    let points = ranks.into_iter().filter(|rank| *rank > 0).filter_map(point).filter(|point| point.0 > 0.0);
    Series { role: Role::Member(number), points: points.collect(), dots: false, odd: vec![] }
}

/// All numbers in SI units.
pub fn write_csv(timings: &[Timing], file: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(file)?;
    let mut head = ["scene", "step_s", "steps", "restarts"].map(String::from).to_vec();
    for (_, _, name) in MEASURES {
        head.extend(SHARES.iter().map(|share| format!("{name}_{share}_s")));
        let worst = ["end_s", "wall_s", "cpu_s", "contacts_changed", "solver_steps", "evaluations"];
        head.extend(worst.iter().map(|what| format!("worst_{name}_{what}")));
    }
    head.extend(["most_evaluations", "evaluation_s", "bound_s"].map(String::from));
    csv.write_record(head)?;
    for timing in timings {
        let mut numbers = vec![STEP, timing.steps.len() as f64, timing.restarts as f64];
        for (measure, ..) in MEASURES {
            let times = timing.sorted(measure);
            numbers.extend(SHARES.iter().map(|share| quantile(&times, *share)));
            let Step { end, wall, cpu, steps, evaluations, events, .. } = timing.longest(measure);
            numbers.extend([end, wall, cpu, events, steps, evaluations]);
        }
        numbers.extend([timing.longest(|step| step.evaluations).evaluations, timing.per_evaluation(), timing.bound()]);
        csv.write_record(std::iter::once(timing.scene.clone()).chain(numbers.iter().map(f64::to_string)))?;
    }
    Ok(csv.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_falls_from_all_steps_to_the_longest_one() {
        let times: Vec<f64> = (1..=1000).map(|n| f64::from(n) * 1e-6).collect();
        let points = curve(0, &times).points;
        assert_eq!((points.first(), points.last()), (Some(&(1.0, 1e-3)), Some(&(1e-3, 1.0))));
        assert!(points.windows(2).all(|pair| pair[0].0 >= pair[1].0 && pair[0].1 < pair[1].1));
        assert!(curve(0, &[]).points.is_empty());
    }

    #[test]
    fn table_sentence_and_csv_tell_the_same() {
        let step = |wall: f64, cpu: f64, evaluations: f64| Step {
            end: 1.25,
            wall,
            cpu,
            steps: 7.0,
            evaluations,
            events: 3.0,
            ..Step::default()
        };
        let steps = vec![step(5e-5, 4e-5, 500.0), step(9e-4, 6e-5, 700.0)];
        let timing = Timing { scene: "own".into(), steps, restarts: 2, asked: 3 };
        let markdown = table(std::slice::from_ref(&timing)).markdown();
        let row = "| own | 2 | 5.00 % | 90.0 % | 90.0 % | 6.00 % | 6.00 % | 3 | 7 | 700 | 700 | 83.3 | 5.83 % |";
        assert!(markdown.contains(row), "{markdown}");
        let text = sentence(&timing);
        for part in [
            "of 2 steps",
            "the longest 90.0 %",
            "6.00 % is CPU time",
            "to t = 1.250 s",
            "83.3 ns",
            "before 3 steps",
            "anew 2 times",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        write_csv(&[timing], file.path()).expect("written");
        let mut csv = csv::Reader::from_path(file.path()).expect("a CSV");
        let head = csv.headers().expect("a head").clone();
        let row = csv.records().next().expect("a row").expect("legal");
        let cell = |name: &str| row[head.iter().position(|own| own == name).expect("a column")].parse::<f64>().ok();
        assert_eq!(["wall_0.5_s", "worst_wall_cpu_s", "most_evaluations"].map(cell), [5e-5, 6e-5, 700.0].map(Some));
    }
}
