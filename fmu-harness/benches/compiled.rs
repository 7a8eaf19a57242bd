//! What code for a constant structure saves over the code for every structure, at states along a run:
//! `cargo bench --bench compiled`. Nanoseconds per stage of a step by `verner7`, and per state of the rates of eight.

use fmu_harness::effects::fastest;
use fmu_harness::scenes::{Scenario, directory, ladder, names};
use slidercrank::integrator::method::Attempt;
use slidercrank::integrator::methods::VERNER7;
use slidercrank::integrator::methods::explicit::Explicit;
use slidercrank::integrator::{Method, Ode, SeveralInstants, StepPoint};
use slidercrank::math::{F64x8, ROW, Real};
use slidercrank::model::Model;
use slidercrank::model::mechanism_model::MechanismModel;
use slidercrank::model::signals::Inputs;
use slidercrank::model::state::Conditions;
use slidercrank::simulation::Simulation;
use std::hint::black_box;

/// [s] Longest run.
const SPAN: f64 = 0.02;
/// States on it.
const STATES: usize = 40;
/// [s] Of a step, so short that its end does not matter.
const STEP: f64 = 1e-9;
/// Measurements at a state, of which the fastest counts, and calls in each.
const MEASUREMENTS: usize = 10;
const CALLS: usize = 200;

fn main() -> anyhow::Result<()> {
    println!("                       a stage                    each of eight");
    println!("scene                  own [ns]  general  ratio   own [ns]  general  ratio");
    for name in [names(&directory()), ladder()].concat() {
        let mut file = Scenario::find(&name)?.file;
        file.scene.energy.audit = false;
        let mut simulation = Simulation::start(&file.scene, Inputs::at_start(&file))?;
        let models = [Model::assemble(&file.scene), Model::assemble(&file.scene).general()];
        let span = file.run.stop(&file.scene).min(SPAN);
        let (mut stage, mut eight) = ([0.0; 2], [0.0; 2]);
        for state in 1..=STATES {
            simulation.advance_to(span * state as f64 / STATES as f64)?;
            let (time, states) = simulation.front();
            for (k, model) in models.iter().enumerate() {
                stage[k] += of_stage(model, time, &states);
                eight[k] += of_eight(model, time, &states) / ROW as f64;
            }
        }
        let per = 1e9 / (STATES * CALLS) as f64;
        let [[a, b], [c, d]] = [stage, eight].map(|pair| pair.map(|seconds| seconds * per));
        println!("{name:22} {a:8.1}  {b:7.1}  {:5.2}  {c:9.1}  {d:7.1}  {:5.2}", b / a, d / c);
    }
    Ok(())
}

fn of_stage(model: &Model, time: f64, states: &[f64]) -> f64 {
    let mut start = StepPoint::new(time, states, Conditions::without_inputs(model.start_contacts(time, states)));
    model.rates(&start.discrete, time, states, &mut start.rates);
    let (mut end, mut attempt) = (start.clone(), Attempt::new(states.len(), 1e-6));
    let mut method = Explicit::new(&VERNER7, states.len());
    repeated(|| {
        method.attempt(model, black_box(&start), STEP, &mut end, &mut attempt);
    }) / VERNER7.stages as f64
}

fn of_eight(model: &Model, time: f64, states: &[f64]) -> f64 {
    let conditions = Conditions::without_inputs(model.start_contacts(time, states));
    let time = F64x8::constant(time);
    let states: Vec<F64x8> = states.iter().map(|state| F64x8::constant(*state)).collect();
    let mut rates = vec![F64x8::ZERO; states.len()];
    repeated(|| model.rates_in_row(&conditions, &time, black_box(&states), &mut rates))
}

/// [s] The fastest of some runs of so many calls.
fn repeated(mut call: impl FnMut()) -> f64 {
    fastest(MEASUREMENTS, || (0..CALLS).for_each(|_| call()))
}
