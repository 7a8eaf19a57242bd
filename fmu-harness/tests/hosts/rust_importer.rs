//! fmi-rs, an importer written in Rust: its validator, and its loops of co-simulation and model exchange.
#![allow(clippy::arc_with_non_send_sync, reason = "fmi-rs takes its recorder as an Arc")]

use super::packages::{self, RUN, STEP, STOP};
use anyhow::{Context, Result, ensure};
use fmi_rs::fmi3::LibraryKind;
use fmi_rs::model_description::{fmi2, fmi3};
use fmi_rs::sim::solver::ForwardEulerFactory;
use fmi_rs::sim::{fmi2 as sim2, fmi3 as sim3};
use fmu_harness::host::Archive;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use tempfile::TempDir;

/// [s] Before the first impact of the worn pin, at 2.27e-4 s. Powers of two divide it without rounding, as fmi-rs requires.
const FREE: f64 = 1.0 / 8192.0;
/// [rad/s] Of its crank.
const SPEED: f64 = 5000.0 * TAU / 60.0;

/// An unpacked FMU.
fn unpacked(name: &str) -> Result<TempDir> {
    let folder = TempDir::new()?;
    Archive::open(&packages::directory().join(format!("{name}.fmu")))?.unpack(folder.path())?;
    Ok(folder)
}

/// How long and how fine fmi-rs simulates, and which interface it uses.
struct Run {
    stop: f64,
    step: f64,
    /// fmi-rs compares times with this relative tolerance, too.
    tolerance: Option<f64>,
    /// Event mode with early return in FMI 3.0.
    events: bool,
    /// Model exchange with explicit Euler steps in FMI 2.0.
    euler: bool,
}

impl Run {
    const PLAIN: Self = Self { stop: STOP, step: STEP, tolerance: None, events: false, euler: false };
}

/// Times, and the values of these outputs at each.
type Samples = Vec<(f64, Vec<f64>)>;

/// Declares a function that simulates with the modules of fmi-rs for one version of FMI. They have the same names, but
/// different types.
macro_rules! simulation {
    ($name:ident, $schema:ident, $sim:ident, { $($field:ident: $value:expr),* }, $simulate:expr, $number:expr) => {
        fn $name(folder: &Path, names: &[&str], run: &Run) -> Result<Samples> {
            let description = Arc::new($schema::ModelDescription::from_path(&folder.join("modelDescription.xml"))?);
            let indices: Result<Vec<_>, _> = names.iter().map(|name| description.variable_index_by_name(name)).collect();
            let trajectories = $sim::Trajectories::new(description.clone(), indices?);
            let recorder = Arc::new($sim::recorder::Recorder::new(trajectories));
            let settings = $sim::SimulationSettings {
                unzipdir: folder.into(),
                model_description: description,
                start_time: 0.0,
                stop_time: run.stop,
                logging_on: false,
                set_stop_time: true,
                output_interval: run.step,
                log_time_scale: false,
                tolerance: run.tolerance.unwrap_or(1e-10),
                set_tolerance: run.tolerance.is_some(),
                start_values: vec![],
                log_fmi_calls: false,
                input_file: None,
                early_return_allowed: run.events,
                event_mode_used: run.events,
                log_file: None,
                initial_fmu_state_file: None,
                final_fmu_state_file: None,
                $($field: $value),*
            };
            $simulate(&settings, recorder.clone(), run)?;
            let found = Arc::into_inner(recorder).context("fmi-rs still records")?.into_trajectories();
            let row = |row: &Vec<$sim::VariableValue>| row.iter().map($number).collect::<Option<Vec<f64>>>();
            let rows: Option<Vec<Vec<f64>>> = found.rows.iter().map(row).collect();
            Ok(found.time.into_iter().zip(rows.context("a value that is no number")?).collect())
        }
    };
}

simulation! {
    with_fmi2, fmi2, sim2, {},
    |settings: &sim2::SimulationSettings, recorder, run: &Run| match run.euler {
        true => sim2::me::simulate(settings, &ForwardEulerFactory { fixed_step_size: run.step }, None, recorder),
        false => sim2::cs::simulate(settings, None, recorder),
    },
    sim2::VariableValue::to_f64
}

simulation! {
    with_fmi3, fmi3, sim3,
    { library_kind: LibraryKind::Native, enable_dae: false, visible: false, intermediate_update: false },
    |settings: &sim3::SimulationSettings, recorder, _: &Run| sim3::cs::simulate(settings, None, recorder),
    |value| value.as_f64().and_then(|values| values.first().copied())
}

/// The harness's own run of the same file: names of the outputs, and samples at the same times.
fn recorded() -> Result<(Vec<String>, Samples)> {
    let mut reader = csv::Reader::from_path(packages::directory().join(format!("{RUN}.csv")))?;
    let names = reader.headers()?.iter().skip(1).map(str::to_owned).collect();
    let mut samples = Samples::new();
    for row in reader.records() {
        let numbers: Result<Vec<f64>, _> = row?.iter().map(str::parse).collect();
        let numbers = numbers?;
        samples.push((numbers[0], numbers[1..].to_vec()));
    }
    ensure!(samples.len() == (STOP / STEP).round() as usize + 1, "{} points are recorded", samples.len());
    Ok((names, samples))
}

fn assert_same_bits(found: &Samples, wanted: &Samples) {
    assert_eq!(found.len(), wanted.len());
    let bits = |(time, values): &(f64, Vec<f64>)| -> Vec<u64> {
        std::iter::once(time).chain(values).map(|number| number.to_bits()).collect()
    };
    for (found, wanted) in found.iter().zip(wanted) {
        assert!(bits(found) == bits(wanted), "{found:?} is not {wanted:?}");
    }
}

#[test]
fn fmi_rs_finds_no_fault_in_either_description() {
    for name in [RUN, "press", "flexrod"] {
        let folder = unpacked(name).expect("an FMU");
        let text = fs::read_to_string(folder.path().join("modelDescription.xml")).expect("a text");
        let description = fmi2::ModelDescription::from_string(&text).expect("a description");
        let found: Vec<String> = description.validate().into_iter().map(|problem| problem.message).collect();
        assert!(found.is_empty(), "{name}: {found:#?}");
        // The validator finds a fault where there is one.
        let wrong = text.replacen("name=\"slider.v\"", "name=\"slider.x\"", 1);
        let description = fmi2::ModelDescription::from_string(&wrong).expect("a description");
        assert!(description.validate().iter().any(|problem| problem.message.contains("Duplicate")), "{name}");
    }
    let problems = |name: &str| -> Vec<String> {
        let folder = unpacked(&format!("{RUN}{name}")).expect("an FMU");
        let file = folder.path().join("modelDescription.xml");
        let description = fmi3::ModelDescription::from_path(&file).expect("a description");
        description.validate().into_iter().map(|problem| problem.message).collect()
    };
    assert_eq!(problems("3-without-clocks"), [""; 0]);
    // Its rule and that of FMPy's validator contradict each other: FMPy counts output clocks among the initial unknowns.
    let found = problems("3");
    assert!(found.len() == 1 && found[0].starts_with("The initial unknowns do not match"), "{found:#?}");
}

#[test]
fn fmi_rs_computes_the_bits_of_the_harness_with_fmi_2_and_fmi_3() {
    let (names, wanted) = recorded().expect("a recorded run");
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    assert!(names.len() > 20);
    let folder = unpacked(RUN).expect("an FMU");
    assert_same_bits(&with_fmi2(folder.path(), &names, &Run::PLAIN).expect("a run"), &wanted);
    let folder = unpacked(&format!("{RUN}3")).expect("an FMU");
    assert_same_bits(&with_fmi3(folder.path(), &names, &Run::PLAIN).expect("a run"), &wanted);
}

/// The published first impact of the worn pin is at a crank angle of 6.8186 degrees.
#[test]
fn fmi_rs_samples_both_sides_of_every_event_in_event_mode() {
    let folder = unpacked(&format!("{RUN}3")).expect("an FMU");
    let names = ["joint.C.contact", "solver.events"];
    let run = Run { tolerance: Some(1e-10), events: true, ..Run::PLAIN };
    let samples = with_fmi3(folder.path(), &names, &run).expect("a run");
    let events: Vec<_> = samples.windows(2).filter(|pair| pair[0].0 == pair[1].0).collect();
    assert!(events.len() >= 6, "{} events", events.len());
    let degrees = (SPEED * events[0][0].0).to_degrees();
    assert!((degrees - 6.8186).abs() < 5e-5, "{degrees}");
    for pair in samples.windows(2) {
        let changes = pair[0].1[0] != pair[1].1[0];
        assert_eq!(changes, pair[0].0 == pair[1].0, "contacts change at events and nowhere else: {pair:?}");
    }
    assert_eq!(samples.last().map(|(_, values)| values[1]), Some(events.len() as f64));
}

/// The rod swings, while the slider flies at a constant speed. Explicit Euler steps have order 1: an eighth of the step has an eighth of the error.
#[test]
fn fmi_rs_integrates_the_equations_by_eulers_method() {
    let folder = unpacked(RUN).expect("an FMU");
    let end = |steps: f64, euler: bool| {
        let run = Run { stop: FREE, step: FREE / steps, euler, ..Run::PLAIN };
        let samples = with_fmi2(folder.path(), &["rod.angle"], &run).expect("a run");
        let (time, values) = samples.last().expect("samples").clone();
        assert!((time - FREE).abs() < 1e-12 && samples.len() as f64 >= steps);
        values[0]
    };
    let exact = end(1.0, false);
    let [coarse, fine] = [128.0, 1024.0].map(|steps| (end(steps, true) - exact).abs());
    assert!(coarse < 1e-3 && (coarse / fine - 8.0).abs() < 0.2, "{coarse:e} and {fine:e} rad");
}
