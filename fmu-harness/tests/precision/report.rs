//! Figure, tables, sentence and CSV tell the same of a diagram.

use super::{diagram, point};
use fmu_harness::precision::diagram::{Diagram, Point, Verdict};
use fmu_harness::precision::exchange::{self, ExchangePoint};
use fmu_harness::precision::hosts::{Found, HostPoint};
use fmu_harness::report::loglog::Mark;
use fmu_harness::report::precision::{
    cheapest, exchange as exchange_table, hosts, sentence, sheet, sheet_with, tolerances, write_csv,
};
use slidercrank::scene::Method;

/// Runs that ended well, one that failed with its cost, one that was stopped at once.
fn mixed() -> Diagram {
    let own = Method::default();
    let failed = Verdict::Failed("the floor, \"so to say\", fell out".into());
    let stopped = Point { error: None, cost: None, evaluations: None, ..point(Method::Rk4, 1e-5, 0.0, 0.0) };
    let points = vec![
        point(own, 1e-4, 3e-3, 0.0125),
        point(own, 1e-6, 2e-5, 0.025),
        point(own, 1e-8, 1e-7, 0.05),
        Point { verdict: failed, error: None, ..point(Method::Rk4, 1e-4, 0.0, 0.03) },
        Point { verdict: Verdict::Stopped("too dear".into()), ..stopped },
    ];
    diagram(points)
}

fn host_points() -> Vec<HostPoint> {
    let found = Found { error: Some(2e-5), total: 0.08, unit: 0.03, evaluations: 4e5, over: 0.012, window: 0.011 };
    let missing = Err("there is no Python".to_owned());
    vec![
        HostPoint { scene: "own".into(), step: 1e-4, outcome: Ok(found) },
        HostPoint { scene: "own".into(), step: 1e-3, outcome: missing },
    ]
}

#[test]
fn a_failing_run_is_drawn() {
    let sheet = sheet(&mixed());
    let series = &sheet.panels[0].series;
    assert_eq!(series.iter().map(|own| own.points.len()).collect::<Vec<_>>(), [3, 0]);
    assert_eq!(series[1].odd, [(Mark::Failed, Some(0.03)), (Mark::Stopped, None)]);
    let svg = sheet.svg().expect("a drawing");
    assert_eq!(svg.matches("<circle").count(), 3, "a dot for each run that reached its end");
    // Within the same scales a mark more is a cross of two strokes, or a triangle of one.
    let without = |lost: fn(&Point) -> bool| {
        let mut less = mixed();
        less.points.retain(|point| !lost(point));
        super::report::sheet(&less).svg().expect("a drawing").matches("<polyline").count()
    };
    let lines = svg.matches("<polyline").count();
    assert_eq!([lines - without(Point::has_failed), lines - without(Point::is_stopped)], [2, 1]);
}

#[test]
fn tables_and_sentence_tell_the_runs_of_the_diagram() {
    let diagram = mixed();
    let table = cheapest(std::slice::from_ref(&diagram)).markdown();
    let row = "| own | 11.0 | 1e-9 | 0.0125 | 80.0 | automatic at tolerance 1e-4 | 0.0250 | 40.0 \
               | automatic at tolerance 1e-6 | 0.0500 | 20.0 | automatic at tolerance 1e-8 | × 1.36 |";
    assert!(table.contains(row), "{table}");
    let text = sentence(&diagram);
    for part in
        ["known to 1e-9", "automatic at tolerance 1e-6: 0.0250 s", "40.0 times", "1.36 times", "5 runs 1 failed and 1"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    let table = tolerances(&[diagram]).markdown();
    assert!(table.contains("| own | 3e-3 | 80.0 | 2e-5 | 40.0 | 1e-7 | 20.0 | – | – |"), "{table}");
}

#[test]
fn what_is_left_out_is_said() {
    let mut diagram = mixed();
    diagram.points.truncate(1);
    diagram.others = vec![Method::Rk4];
    let text = sentence(&diagram);
    assert!(text.contains("No run keeps an error of 1e-4.") && text.contains("rk4 solves another model"), "{text}");
    let table = hosts(&host_points()).markdown();
    assert!(table.contains("| own | 100 µs | 2e-5 | 0.0800 | 0.0300 | 12.5 |"), "{table}");
    assert!(table.contains("| own | not measured: there is no Python |"), "{table}");
}

#[test]
fn the_csv_holds_every_run_in_full() {
    let (diagram, file) = (mixed(), tempfile::NamedTempFile::new().expect("a temporary file"));
    write_csv(std::slice::from_ref(&diagram), &host_points(), file.path()).expect("written");
    let mut csv = csv::Reader::from_path(file.path()).expect("a CSV");
    let head = csv.headers().expect("a head").clone();
    let rows: Vec<csv::StringRecord> = csv.records().collect::<Result<_, _>>().expect("legal rows");
    assert_eq!(rows.len(), diagram.points.len() + 2);
    let place = |name: &str| head.iter().position(|own| own == name).expect("a column");
    let cell = |row: usize, name: &str| rows[row][place(name)].to_owned();
    for (row, point) in diagram.points.iter().enumerate() {
        assert_eq!(cell(row, "method"), point.method.name());
        assert_eq!(cell(row, "error").parse().ok(), point.error);
        assert_eq!(cell(row, "cpu_s_per_s").parse().ok(), point.cost);
        assert_eq!(cell(row, "value").parse().ok(), Some(point.rung.number()));
    }
    let verdicts: Vec<String> = (0..rows.len()).map(|row| cell(row, "verdict")).collect();
    assert_eq!(verdicts, ["reached", "reached", "reached", "failed", "stopped", "reached", "not measured"]);
    assert_eq!(cell(3, "reason"), "the floor, \"so to say\", fell out");
    assert_eq!(
        (cell(5, "host"), cell(5, "communication_step_s"), cell(6, "error")),
        ("FMPy".into(), "1e-4".into(), "".into())
    );
}

#[test]
fn a_hosts_own_integrator_is_drawn_beside_the_methods() {
    let of = |tolerance: f64, outcome: Result<exchange::Found, String>| ExchangePoint {
        scene: "own".into(),
        tolerance,
        outcome,
    };
    let found = exchange::Found { error: 2e-4, cost: 0.5 };
    let points = [of(1e-7, Ok(found)), of(1e-9, Err("it gave up".into()))];
    let (alone, with) = (sheet(&mixed()), sheet_with(&mixed(), &points));
    assert_eq!(with.panels[0].series.len(), alone.panels[0].series.len() + 1);
    assert_eq!(with.panels[0].series.last().expect("a series").points, [(2e-4, 0.5)]);
    assert_eq!(with.legend.len(), alone.legend.len() + 1);
    let table = exchange_table(&points).markdown();
    assert!(table.contains("| own | 1e-7 | 2e-4 | 0.500 | 2.00 |"), "{table}");
    assert!(table.contains("it gave up"), "{table}");
}
