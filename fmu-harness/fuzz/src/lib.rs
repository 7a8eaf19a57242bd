//! What a fuzzer calls, and the tests with the seeds: bytes from anywhere lead to a refusal or to a run, never to a panic,
//! to a hang or to a number that is none.
//!
//! `cargo fuzz` wants a nightly compiler, or one that lets itself be taken for one:
//! `cd fmu-harness && RUSTC_BOOTSTRAP=1 cargo fuzz run scene fuzz/seeds/scene -- -max_total_time=120`.

use slidercrank::fmi::slave::log::Silent;
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::fmi::v2::fmu_state::FmuState;
use slidercrank::fmi::v2::instance::{Instance, Request};
use slidercrank::fmi::v2::lifecycle::Call;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::read::{SceneFile, read_with};
use slidercrank::scene::slot;
use slidercrank::scene::write::write;
use slidercrank::simulation::Simulation;
use std::ffi::CString;
use std::io;

/// Evaluations of the equations of motion that one step may take.
const EVALUATIONS: i32 = 2_000;
/// [s] Length of a step.
const STEP: f64 = 1e-4;

/// A scene file: it is refused with its faults, or it is a scene that its own text tells again.
pub fn scene(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let none = |_: &str| Err(io::Error::other("no files here"));
    match read_with(text, "scene.toml", &none) {
        Ok(file) => {
            let again = read_with(&write(&file), "again.toml", &none);
            assert_eq!(again.as_ref(), Ok(&file), "what is written reads back");
            run(file);
        }
        Err(error) => assert!(!error.problems.is_empty() && !error.to_string().is_empty()),
    }
}

/// A table of modes, in a file that a scene names.
pub fn modes(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let scene = "drive.mode = \"speed\"\ncrank.speed_start = 300\njoint.C.model = \"clearance\"\n\
                 [rod.flexible]\nbending_modes = 2\naxial_modes = 1\ntable = \"modes.toml\"";
    match read_with(scene, "scene.toml", &|_| Ok(text.to_owned())) {
        Ok(file) => run(file),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Starts a legal scene and takes a step.
fn run(mut file: SceneFile) {
    file.scene.solver.max_evaluations = EVALUATIONS;
    let mut simulation = Simulation::start(&file.scene, Inputs::default()).expect("a legal scene starts");
    let stepped = simulation.advance_to(STEP);
    let outputs = simulation.outputs();
    assert!(stepped.is_err() || outputs.is_finite(), "{outputs:?}");
}

/// The bytes of a saved state. The first byte chooses: the content of a state as it stands, under a seal that fits, or
/// a state of our own in which numbers are changed.
pub fn state(data: &[u8]) {
    let Some((&kind, rest)) = data.split_first() else { return };
    let mut instance = instance();
    let own = saved(&mut instance, kind >> 1);
    let bytes = if kind & 1 == 0 { sealed(&own, rest) } else { edited(&own, rest) };
    let Ok(mut state) = FmuState::from_bytes(&bytes) else { return };
    state.settings.scene.solver.max_evaluations = EVALUATIONS;
    let bytes = state.to_bytes().expect("what was read can be written");
    let handle = instance.deserialize(&bytes, 0).expect("its own bytes");
    if instance.set_fmu_state(handle).is_err() {
        return;
    }
    look(&mut instance);
    if instance.admit(Call::DoStep).is_ok() {
        let time = instance.time();
        let _ = instance.do_step(time, STEP);
        look(&mut instance);
    }
    let again = instance.get_fmu_state(0).expect("a state can be saved");
    assert!(instance.serialized_size(again).is_ok());
}

/// Asks for everything that there is to ask for: a number or a refusal.
fn look(instance: &mut Instance) {
    for (reference, variable) in (0..).zip(VARIABLES) {
        if instance.admit(Call::GetReal).is_err() || !matches!(variable.access, Access::RealOutput(_)) {
            continue;
        }
        let mut value = [f64::NAN];
        let told = instance.get_real(&[reference], &mut value);
        assert!(told.is_err() || value[0].is_finite(), "{} = {}", variable.name, value[0]);
        if instance.admit(Call::GetRealOutputDerivatives).is_ok() {
            let told = instance.get_output_derivatives(&[reference], &[1], &mut value);
            assert!(told.is_err() || value[0].is_finite(), "derivative of {} = {}", variable.name, value[0]);
        }
    }
}

fn instance() -> Instance {
    let (_, guid) = slot::read().expect("a packaged scene");
    let (name, guid) = (CString::new("fuzz").expect("no zero"), CString::new(guid).expect("no zero"));
    let request =
        Request { name: Some(&name), fmu_type: 1, guid: Some(&guid), resource_location: None, logging_on: false };
    Instance::instantiate(&request, Box::new(Silent), None).expect("an instance")
}

/// The bytes of an instance with joints, drive, method and rod by the bits of `kind`, after some steps.
fn saved(instance: &mut Instance, kind: u8) -> Vec<u8> {
    let set = |instance: &mut Instance, name: &str, value: i32| {
        let reference = VARIABLES.iter().position(|variable| variable.name == name).expect("a variable");
        let reference = u32::try_from(reference).expect("few variables");
        instance.set_integer(&[reference], &[value]).expect("a legal value");
    };
    for (bit, joint) in ["A", "B", "C", "T"].into_iter().enumerate() {
        set(instance, &format!("joint.{joint}.model"), 1 + i32::from(kind >> bit & 1));
    }
    set(instance, "drive.mode", 1 + i32::from(kind >> 4 & 1));
    set(instance, "rod.flexible.bending_modes", i32::from(kind >> 5 & 1));
    set(instance, "solver.method", if kind >> 6 & 1 == 1 { 7 } else { 2 });
    instance.setup_experiment(None, 0.0, None).expect("an experiment");
    instance.enter_initialization_mode().expect("a mode");
    instance.exit_initialization_mode().expect("a legal scene");
    for step in 0..3 {
        instance.do_step(f64::from(step) * STEP, STEP).expect("a step");
    }
    let handle = instance.get_fmu_state(0).expect("a state");
    let mut bytes = vec![0; instance.serialized_size(handle).expect("a size")];
    instance.serialize(handle, &mut bytes).expect("room");
    bytes
}

/// Bytes of a header: magic, version, declaration.
const HEADER: usize = 8 + 4 + 32;

/// `content` under the header of `own` and a checksum that fits.
fn sealed(own: &[u8], content: &[u8]) -> Vec<u8> {
    let length = u32::try_from(content.len()).unwrap_or(u32::MAX);
    let mut bytes = [&own[..HEADER], &length.to_le_bytes(), content].concat();
    let checksum = crc32fast::hash(&bytes);
    bytes.extend(checksum.to_le_bytes());
    bytes
}

/// The state `own` with numbers of its snapshot changed, each by ten bytes: a place and a value.
fn edited(own: &[u8], edits: &[u8]) -> Vec<u8> {
    let mut state = FmuState::from_bytes(own).expect("our own bytes");
    let snapshot = state.snapshot.as_mut().expect("a run");
    for edit in edits.chunks_exact(10) {
        let (place, value) = edit.split_at(2);
        let place = usize::from(u16::from_le_bytes([place[0], place[1]]));
        let bits = u64::from_le_bytes(value.try_into().expect("eight bytes"));
        let reals = snapshot.reals.len();
        let place = place % (reals + snapshot.integers.len());
        match snapshot.reals.get_mut(place) {
            Some(real) => *real = f64::from_bits(bits),
            None => snapshot.integers[place - reals] = bits,
        }
    }
    state.to_bytes().expect("bytes of a state")
}
