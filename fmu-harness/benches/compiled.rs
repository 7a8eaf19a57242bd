//! What code for a constant structure saves over the code for every structure, at states along a run:
//! `cargo bench --bench compiled`. Nanoseconds per evaluation of the rates of one state, and of each of eight.

use cpu_time::ThreadTime;
use fmu_harness::effects::inputs_at_start;
use fmu_harness::scenes::{Scenario, directory, ladder, names};
use slidercrank::integrator::{Ode, SeveralInstants};
use slidercrank::math::{ROW, Real, Row};
use slidercrank::model::Model;
use slidercrank::model::plant::Plant;
use slidercrank::simulation::Simulation;
use std::hint::black_box;

/// [s] Longest run.
const SPAN: f64 = 0.02;
/// States on it.
const STATES: usize = 40;
/// Measurements at a state, of which the fastest counts, and calls in each.
const MEASUREMENTS: usize = 10;
const CALLS: usize = 200;

fn main() -> anyhow::Result<()> {
    println!("                       one state                  each of eight");
    println!("scene                  own [ns]  general  ratio   own [ns]  general  ratio");
    for name in [names(&directory()), ladder()].concat() {
        let mut file = Scenario::find(&name)?.file;
        file.scene.energy.audit = false;
        let mut simulation = Simulation::start(&file.scene, 0.0, inputs_at_start(&file))?;
        let models = [Model::assemble(&file.scene, 0.0), Model::assemble(&file.scene, 0.0).general()];
        let span = file.run.stop(&file.scene).min(SPAN);
        let (mut one, mut eight) = ([0.0; 2], [0.0; 2]);
        for state in 1..=STATES {
            simulation.advance_to(span * state as f64 / STATES as f64)?;
            let (time, states) = simulation.front();
            for (k, model) in models.iter().enumerate() {
                one[k] += of_one(model, time, &states);
                eight[k] += of_eight(model, time, &states) / ROW as f64;
            }
        }
        let per = 1e9 / (STATES * CALLS) as f64;
        let [[a, b], [c, d]] = [one, eight].map(|pair| pair.map(|seconds| seconds * per));
        println!("{name:22} {a:8.1}  {b:7.1}  {:5.2}  {c:9.1}  {d:7.1}  {:5.2}", b / a, d / c);
    }
    Ok(())
}

fn of_one(model: &Model, time: f64, states: &[f64]) -> f64 {
    let contacts = model.start_contacts(time, states);
    let mut rates = vec![0.0; states.len()];
    least(|| model.rates(&contacts, time, black_box(states), &mut rates))
}

fn of_eight(model: &Model, time: f64, states: &[f64]) -> f64 {
    let contacts = model.start_contacts(time, states);
    let time = Row::constant(time);
    let states: Vec<Row> = states.iter().map(|state| Row::constant(*state)).collect();
    let mut rates = vec![Row::ZERO; states.len()];
    least(|| model.rates_in_row(&contacts, &time, black_box(&states), &mut rates))
}

/// [s] The fastest of some runs of `work`.
fn least(mut work: impl FnMut()) -> f64 {
    let measure = |_| {
        let start = ThreadTime::now();
        for _ in 0..CALLS {
            work();
        }
        start.elapsed().as_secs_f64()
    };
    (0..MEASUREMENTS).map(measure).fold(f64::INFINITY, f64::min)
}
