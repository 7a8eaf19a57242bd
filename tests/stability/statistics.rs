//! Chaotic motions agree in their statistics: batch means (A. M. Law, Simulation Modeling and Analysis, 9.5.3).
//!
//! A run is cut into batches of turns, each with the mean, the effective value and the mean of its turns' peaks of a
//! signal. Batches of different runs are as good as independent, so that the difference of two runs' averages has a
//! standard error known from the scatter of their batches.

use crate::run::{Trace, run, with};
use slidercrank::model::signals::Outputs;
use slidercrank::scene::Method;
use slidercrank::scene::read::SceneFile;

/// Turns of a run that it takes to forget its start.
const FORGOTTEN: usize = 10;
/// Turns of a batch.
const BATCH: usize = 10;
/// Most standard errors between two averages. By chance, one of a hundred million differs by more.
const MOST: f64 = 6.0;
/// Most share of a statistic, or of the signal's effective value, that a standard error may be: a comparison that is
/// more blurred would tell nothing.
const SHARP: f64 = 0.05;

/// An output's name, and how it is read.
type Signal = (&'static str, fn(&Outputs) -> f64);

/// Signals that are compared.
const SIGNALS: [Signal; 3] = [
    ("force in C", |o| o.joint_c.force[0].hypot(o.joint_c.force[1])),
    ("force in A", |o| o.joint_a.force[0].hypot(o.joint_a.force[1])),
    ("deviation of the slider", |o| o.accuracy.position),
];

/// An average over batches, and its standard error.
#[derive(Clone, Copy)]
struct Average {
    value: f64,
    error: f64,
}

impl Average {
    fn of(batches: &[f64]) -> Self {
        let n = batches.len() as f64;
        let value = batches.iter().sum::<f64>() / n;
        let variance = batches.iter().map(|batch| (batch - value).powi(2)).sum::<f64>() / (n - 1.0);
        Self { value, error: (variance / n).sqrt() }
    }
}

/// Mean, effective value, peak of a signal in a run.
fn averages(trace: &Trace, turns: usize, signal: fn(&Outputs) -> f64) -> [Average; 3] {
    let points = (trace.outputs.len() - 1) / turns;
    let values: Vec<f64> = trace.outputs[1..].iter().map(signal).collect();
    let turns: Vec<&[f64]> = values.chunks_exact(points).skip(FORGOTTEN).collect();
    let each = |of: &dyn Fn(&[f64]) -> f64| {
        let batch = |batch: &[&[f64]]| batch.iter().map(|turn| of(turn)).sum::<f64>() / batch.len() as f64;
        turns.chunks_exact(BATCH).map(batch).collect::<Vec<f64>>()
    };
    let count = points as f64;
    let square = each(&|turn| turn.iter().map(|value| value * value).sum::<f64>() / count);
    [
        Average::of(&each(&|turn| turn.iter().sum::<f64>() / count)),
        Average::of(&square.into_iter().map(f64::sqrt).collect::<Vec<f64>>()),
        Average::of(&each(&|turn| turn.iter().fold(0.0, |peak: f64, value| peak.max(value.abs())))),
    ]
}

/// Two methods at two tolerances each.
pub fn agree(name: &str, file: &SceneFile) {
    let turns = (file.run.stop(&file.scene) * file.scene.crank.speed_start / std::f64::consts::TAU).round() as usize;
    let of = |method: Method, tolerance: f64| {
        let trace = run(&with(file, |scene| {
            scene.energy.audit = false;
            (scene.solver.method, scene.solver.tolerance) = (method, tolerance);
        }));
        assert_eq!(trace.failure, None, "{name}: {method:?} at {tolerance:e}");
        SIGNALS.map(|(_, signal)| averages(&trace, turns, signal))
    };
    let settings = [Method::Verner7, Method::Dop853].map(|method| [1e-5, 1e-7].map(|tolerance| (method, tolerance)));
    let runs = settings.as_flattened().iter().map(|&(method, tolerance)| of(method, tolerance)).collect::<Vec<_>>();
    for (k, (signal, _)) in SIGNALS.iter().enumerate() {
        for (j, what) in ["mean", "effective value", "peak"].into_iter().enumerate() {
            let found: Vec<Average> = runs.iter().map(|run| run[k][j]).collect();
            let effective = runs[0][k][1].value;
            let shown: Vec<String> =
                found.iter().map(|average| format!("{:.4e} ± {:.1e}", average.value, average.error)).collect();
            println!("{name}: {what} of the {signal}: {}", shown.join(", "));
            for (i, one) in found.iter().enumerate() {
                let size = one.value.abs().max(effective);
                assert!(one.error <= SHARP * size, "{name}: {what} of the {signal} is too blurred to compare");
                for other in &found[..i] {
                    let apart = (one.value - other.value).abs() / one.error.hypot(other.error);
                    assert!(apart <= MOST, "{name}: {what} of the {signal}, {apart} standard errors apart");
                }
            }
        }
    }
}
