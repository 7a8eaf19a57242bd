//! What event mode and intermediate updates cost beside plain steps: `cargo bench --bench event_mode`. The same span in the
//! same communication steps by an instance of FMI 3.0 within this process, the slider's position read where the importer
//! gets control. All ways end at the same bits.

use cpu_time::ThreadTime;
use fmu_harness::scenes::Scenario;
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::slave::Severity;
use slidercrank::fmi::slave::log::Host;
use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::fmi::v3::Error;
use slidercrank::fmi::v3::Instance;
use slidercrank::fmi::v3::instance::{Request, StepRequest};
use slidercrank::fmi::v3::step::Stage;
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::{Scene, slot};
use std::ffi::{CStr, CString};

const SCENES: [(&str, f64); 2] = [("wornpin", 0.24), ("allplay", 0.08)];
/// [s] Communication steps.
const STEPS: [f64; 2] = [1e-4, 1e-5];
/// The fastest of so many runs counts.
const REPEATS: usize = 15;

/// What the importer asks for.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Plain,
    Events,
    Updates,
}

/// What a run took and came to.
struct Run {
    seconds: f64,
    stops: usize,
    position: u64,
}

/// Says nothing.
struct Silent;

impl Host for Silent {
    fn log(&self, _: &CStr, _: Option<Severity>, _: &CStr, _: &CStr) {}
}

fn main() -> anyhow::Result<()> {
    println!("scene      communication step [us]  plain [ms]  events  event mode  updates  intermediate update");
    for (name, span) in SCENES {
        let scene = Scenario::find(name)?.file.scene;
        for step in STEPS {
            let best = |way: Way| -> anyhow::Result<Run> {
                let mut best = run(&scene, way, span, step)?;
                for _ in 1..REPEATS {
                    let again = run(&scene, way, span, step)?;
                    best.seconds = best.seconds.min(again.seconds);
                }
                Ok(best)
            };
            let (plain, events, updates) = (best(Way::Plain)?, best(Way::Events)?, best(Way::Updates)?);
            assert!(plain.position == events.position && plain.position == updates.position, "the same motion");
            println!(
                "{name:10} {:24.0}  {:10.2}  {:6}  {:10.3}  {:7}  {:19.3}",
                step * 1e6,
                plain.seconds * 1e3,
                events.stops,
                events.seconds / plain.seconds,
                updates.stops,
                updates.seconds / plain.seconds
            );
        }
    }
    Ok(())
}

/// `span` [s] in communication steps of `step` [s].
fn run(scene: &Scene, way: Way, span: f64, step: f64) -> Result<Run, Error> {
    let (mut instance, position) = (ready(scene, way)?, reference("slider.x"));
    let (mut time, mut stops, mut value) = (0.0, 0, [0.0]);
    let start = ThreadTime::now();
    for point in 1..=(span / step).round() as usize {
        let end = point as f64 * step;
        while time < end {
            instance.begin_step(time, end - time)?;
            let done = loop {
                match instance.go_on()? {
                    Stage::Done(done) => break done,
                    Stage::Update(_) => {
                        instance.get_float64(&[position], &mut value)?;
                        instance.end_update(None);
                        stops += 1;
                    }
                }
            };
            time = if done.early { done.time } else { end };
            instance.get_float64(&[position], &mut value)?;
            if done.event {
                instance.enter_event_mode()?;
                instance.update_discrete_states()?;
                instance.get_float64(&[position], &mut value)?;
                instance.enter_step_mode()?;
                stops += 1;
            }
        }
    }
    Ok(Run { seconds: start.elapsed().as_secs_f64(), stops, position: value[0].to_bits() })
}

/// An instance of the scene, ready for the first step.
fn ready(scene: &Scene, way: Way) -> Result<Instance, Error> {
    let token = slot::read().map(|(_, token)| CString::new(token).unwrap_or_default()).unwrap_or_default();
    let position = [reference("slider.x")];
    let (events, updates) = (way == Way::Events, way == Way::Updates);
    let steps = StepRequest {
        event_mode_used: events,
        early_return_allowed: events,
        intermediate: if updates { &position } else { &[] },
        has_callback: updates,
    };
    let (interface, name) = (Interface::CoSimulation, Some(c"bench"));
    let request = Request { interface, name, token: Some(&token), logging_on: false, steps };
    let mut instance = Instance::instantiate(&request, Box::new(Silent), None)?;
    instance.enter_initialization_mode(None, 0.0, None)?;
    for (place, variable) in VARIABLES.iter().enumerate() {
        if let Access::Parameter(parameter) = variable.access {
            set(&mut instance, place as u32, parameter, parameter.value(scene))?;
        }
    }
    instance.exit_initialization_mode()?;
    if events {
        instance.update_discrete_states()?;
        instance.enter_step_mode()?;
    }
    Ok(instance)
}

fn set(instance: &mut Instance, reference: u32, parameter: &Parameter, value: f64) -> Result<(), Error> {
    match parameter.kind {
        Kind::Real { .. } => instance.set_float64(&[reference], &[value]),
        Kind::Integer { .. } => instance.set_int32(&[reference], &[value as i32]),
        Kind::Enumeration { .. } => instance.set_int64(&[reference], &[value as i64]),
        Kind::Boolean { .. } => instance.set_boolean(&[reference], &[u8::from(value != 0.0)]),
    }
}

fn reference(name: &str) -> u32 {
    VARIABLES.iter().position(|variable| variable.name == name).unwrap_or(usize::MAX) as u32
}
