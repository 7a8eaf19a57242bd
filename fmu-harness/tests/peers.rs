//! The table of what others need: interpolation between runs, ratios, and what is missing.

use fmu_harness::peers::{Contest, Point, Ruler, Series, Task, scenes};
use fmu_harness::report::contest::{Reached, cost_at, sentence, sheet, summary, table};
use slidercrank::scene::Method;

fn points(runs: &[(f64, f64)]) -> Vec<Point> {
    runs.iter().map(|&(error, cost)| Point { tolerance: error, error, cost, evaluations: 1.0 }).collect()
}

fn series(peer: &str, runs: &[(f64, f64)], note: Option<&str>) -> Series {
    let notes = note.into_iter().map(str::to_owned).collect();
    Series { peer: peer.into(), method: "method".into(), rigid: false, points: points(runs), notes }
}

fn contest() -> Contest {
    let series = vec![
        series("ours", &[(1e-1, 0.01), (1e-3, 0.02), (1e-7, 0.08)], None),
        series("slow", &[(1e-1, 1.0), (1e-5, 16.0)], Some("a remark")),
        series("absent", &[], Some("not installed: apt-get install absent")),
    ];
    Contest { scene: "scene".into(), series, span: 0.02, reference_error: 1e-10 }
}

fn cost(runs: &[(f64, f64)], error: f64) -> f64 {
    cost_at(&points(runs), error).cost().expect("an error that was reached")
}

#[test]
fn a_cost_between_two_runs_lies_on_the_line_between_their_logarithms() {
    // A method of order 4: ten thousandth the error at ten times the cost.
    let runs = [(1e-2, 0.1), (1e-6, 1.0), (1e-10, 10.0)];
    for (error, wanted) in [(1e-2, 0.1), (1e-4, 0.1 * 10f64.sqrt()), (1e-6, 1.0), (1e-7, 10f64.powf(0.25))] {
        let found = cost(&runs, error);
        assert!((found / wanted - 1.0).abs() < 1e-12, "{error:e}: {found}, wanted {wanted}");
    }
}

#[test]
fn a_run_that_another_beats_in_error_and_in_cost_does_not_count() {
    let straight = [(1e-2, 0.1), (1e-6, 1.0)];
    for beaten in [(1e-3, 1.5), (0.5, 0.2), (f64::INFINITY, 0.01), (f64::NAN, 0.01)] {
        let noisy = [straight[0], beaten, straight[1]];
        assert_eq!(cost(&noisy, 1e-4), cost(&straight, 1e-4), "{beaten:?}");
    }
    // In whatever order the runs were made.
    assert_eq!(cost(&[straight[1], straight[0]], 1e-4), cost(&straight, 1e-4));
}

#[test]
fn what_was_not_reached_is_said_and_never_extrapolated() {
    let runs = points(&[(1e-3, 0.1), (1e-5, 1.0)]);
    assert_eq!(cost_at(&runs, 1e-2), Reached::AtMost(0.1));
    assert_eq!(cost_at(&runs, 1e-6), Reached::Not(1e-5));
    assert_eq!(cost_at(&[], 1e-2), Reached::Missing);
    assert_eq!(cost_at(&points(&[(f64::INFINITY, 1.0)]), 1e-2), Reached::Missing);
}

#[test]
fn the_table_has_a_row_for_each_method_and_names_what_is_missing() {
    let text = table(&contest()).markdown();
    let rows: Vec<&str> = text.lines().skip(2).collect();
    assert_eq!(rows.len(), 5, "{text}");
    // 1e-2 is halfway between 1e-1 and 1e-3: 0.01·√2; 1e-4 a quarter of the way from 1e-3 to 1e-7: 0.02·√2.
    assert_eq!(rows[0], "| ours method | 0.0141 | 1.00 | 0.0283 | 1.00 | 0.0566 | 1.00 | 1e-7 at best | – |  |");
    // 16 times in four decades: 2 at 1e-2, 8 at 1e-4.
    assert_eq!(rows[1], "| slow method | 2.00 | 141 | 8.00 | 283 | 1e-5 at best | – | 1e-5 at best | – | a remark |");
    assert_eq!(rows[2], "| absent method | – | – | – | – | – | – | – | – | not installed: apt-get install absent |");
    assert_eq!(rows[3..], ["", "absent method has no numbers: not installed: apt-get install absent."]);
}

#[test]
fn no_cost_is_given_below_the_error_of_the_reference() {
    let contest = Contest { reference_error: 1e-5, ..contest() };
    let text = table(&contest).markdown();
    let ours = text.lines().find(|line| line.starts_with("| ours")).expect("a row");
    assert_eq!(ours, "| ours method | 0.0141 | 1.00 | 0.0283 | 1.00 | – | – | – | – |  |");
    assert!(!sentence(&contest).contains("1e-6"));
}

#[test]
fn rigid_contacts_are_compared_with_rigid_contacts() {
    let mut contest = contest();
    let runs = [(1e-1, 0.5), (1e-3, 5.0)];
    contest.series.push(Series { rigid: true, ..series("ours, rigid", &runs, None) });
    contest.series.push(Series { rigid: true, ..series("other, rigid", &runs.map(|(e, cost)| (e, 3.0 * cost)), None) });
    let text = table(&contest).markdown();
    let other = text.lines().find(|line| line.contains("other, rigid")).expect("a row");
    let wanted = "| other, rigid method | 4.74 | 3.00 | 1e-3 at best | – | 1e-3 at best | – | 1e-3 at best | – |  |";
    assert_eq!(other, wanted);
    assert!(!sentence(&contest).contains("rigid"));
}

#[test]
fn the_sentence_and_the_drawing_come_from_the_runs() {
    let contest = contest();
    let text = sentence(&contest);
    assert!(text.contains("slow method 141.4 times at 1e-2, slow method 282.8 times at 1e-4"), "{text}");
    assert!(!text.contains("absent") && !text.contains("1e-6"), "{text}");
    let svg = sheet(std::slice::from_ref(&contest)).svg().expect("a drawing");
    assert!(svg.contains("slow method") && svg.contains("scene") && !svg.contains("absent"), "{svg}");
}

#[test]
fn the_summary_has_the_cheapest_of_the_others() {
    let mut contest = contest();
    contest.series.push(series("cheaper", &[(1e-1, 0.5), (1e-3, 50.0)], None));
    contest.series.push(Series { rigid: true, ..series("rigid", &[(1e-1, 1e-3), (1e-9, 1e-3)], None) });
    let text = summary(&[contest]).markdown();
    // 1e-2: 0.5·√100 against 1·√2; 1e-4: 0.5·100 is not as accurate, 8 is.
    let row = "| scene | 20.0 | 0.0141 | 70.7 | slow method | 141 | 0.0283 | 35.4 | slow method | 283 \
               | 0.0566 | 17.7 | – | – | 1e-7 at best | – | – | – |";
    assert_eq!(text.lines().last(), Some(row), "{text}");
}

#[test]
fn every_scene_of_the_contest_can_be_run() {
    let all = scenes();
    assert_eq!(
        all,
        ["peers/guideplay", "peers/ideal", "peers/wornpin", "press", "allplay", "flexrod", "seed"],
        "those made for it, and what else there is"
    );
    for name in all {
        let task = Task::of(&name).expect("a scene");
        let step = task.span / task.points as f64;
        assert!((step / task.scenario.file.run.step - 1.0).abs() < 1e-9, "{name}: whole steps");
    }
}

#[test]
fn a_run_ends_where_its_motion_is_not_known_any_longer() {
    let mut long = Task::of("wornpin").expect("a scene");
    let (span, step) = (long.span, long.span / long.points as f64);
    let ruler = Ruler::new(&mut long).expect("a reference");
    // Two of its motions part after 18 ms (`fmu-harness/docs/benchmarks.md`, `precision`), of 240.
    assert!(long.span > 0.01 && long.span < 0.5 * span, "{} s", long.span);
    assert!((long.span / long.points as f64 / step - 1.0).abs() < 1e-9, "whole steps");
    assert!(ruler.own_error > 0.0 && ruler.own_error <= 5e-8, "{:e}", ruler.own_error);
    let own = ruler.solve(&long, Method::Verner7, 1e-12).expect("a run");
    assert_eq!((own.len(), ruler.error(&own)), (long.points, ruler.own_error));
    let coarse = ruler.error(&ruler.solve(&long, Method::Verner7, 1e-6).expect("a run"));
    assert!(coarse > 1e-6 && coarse < 1e-2, "{coarse:e}");
}
