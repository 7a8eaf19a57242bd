//! Saved states: the run goes on as if never stopped.

use host::Slave;
use slidercrank::fmi::slave::Settings;
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::fmu_state::FmuState;
use slidercrank::fmi::v2::lifecycle::State;
use slidercrank::scene::Scene;
use std::ptr::null_mut;

const H: f64 = 1e-4;

/// Runs `count` steps with inputs that change and slope; where that leads.
fn drive(slave: &Slave, mut point: f64, count: u32) -> f64 {
    for i in 0..count {
        if i % 3 == 0 {
            assert_eq!(slave.set("crank.torque", f64::from(i)), Status::Ok);
            assert_eq!(slave.set_rate("slider.load", 1, -10.0 * f64::from(i)), Status::Ok);
        }
        point = slave.steps(point, H, 1);
    }
    point
}

#[test]
fn a_restored_run_is_the_run_to_the_bit() {
    let slave = Slave::running();
    let point = drive(&slave, 0.0, 40);
    let saved = slave.save();
    drive(&slave, point, 40);
    let first = slave.picture();
    for _ in 0..3 {
        assert_eq!(slave.set_state(saved), Status::Ok);
        drive(&slave, point, 40);
        assert_eq!(slave.picture(), first);
    }
    let reference = Slave::running();
    drive(&reference, drive(&reference, 0.0, 40), 40);
    assert_eq!(reference.picture(), first);
}

#[test]
fn every_step_twice_as_some_hosts_do() {
    let (twice, once) = (Slave::running(), Slave::running());
    let (mut point, mut state) = (0.0, null_mut());
    for _ in 0..50 {
        assert_eq!(twice.save_into(&mut state), Status::Ok);
        twice.steps(point, H, 1);
        assert_eq!(twice.set_state(state), Status::Ok);
        point = twice.steps(point, H, 1);
    }
    once.steps(0.0, H, 50);
    assert_eq!(twice.picture(), once.picture());
    assert_eq!(twice.free(&mut state), Status::Ok);
}

#[test]
fn what_was_set_at_the_saved_point_is_saved_too() {
    let (saving, plain) = (Slave::running(), Slave::running());
    for slave in [&saving, &plain] {
        let point = slave.steps(0.0, H, 3);
        assert_eq!(slave.set_rate("crank.torque", 1, 5.0), Status::Ok);
        if std::ptr::eq(slave, &saving) {
            let state = slave.save();
            assert_eq!(slave.set("crank.torque", 99.0), Status::Ok);
            slave.steps(point, H, 3);
            assert_eq!(slave.set_state(state), Status::Ok);
        }
        assert_eq!(slave.set("crank.torque", 2.0), Status::Ok);
        slave.steps(point, H, 3);
    }
    assert_eq!(saving.picture(), plain.picture());
}

#[test]
fn a_state_keeps_its_place_and_lives_through_a_reset() {
    let slave = Slave::running();
    let point = slave.steps(0.0, H, 10);
    let mut state = slave.save();
    let place = state;
    assert_eq!(slave.save_into(&mut state), Status::Ok);
    assert_eq!(state, place);
    let picture = slave.picture();
    assert_eq!(slave.reset(), Status::Ok);
    assert_eq!(slave.set_state(state), Status::Ok);
    assert_eq!(slave.picture(), picture);
    slave.steps(point, H, 1);
    assert_eq!(slave.free(&mut state), Status::Ok);
    assert_eq!(slave.free(&mut state), Status::Ok);
}

#[test]
fn a_state_brings_its_place_in_life_back() {
    let slave = Slave::new();
    let young = slave.save();
    assert_eq!(slave.enter(), Status::Ok);
    assert_eq!(slave.set("crank.angle_start", 0.5), Status::Ok);
    assert_eq!(slave.get("crank.angle"), 0.5);
    let initializing = slave.save();
    assert_eq!((slave.exit(), slave.terminate()), (Status::Ok, Status::Ok));
    assert_eq!(slave.set_state(initializing), Status::Ok);
    assert_eq!(slave.get("crank.angle"), 0.5);
    assert_eq!(slave.set("crank.angle_start", 0.7), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    assert_eq!(slave.get("crank.angle"), 0.7);
    assert_eq!(slave.set_state(young), Status::Ok);
    assert_eq!(slave.enter(), Status::Ok);
    assert_eq!(slave.get("crank.angle"), 0.0);
}

#[test]
fn bytes_are_restored_in_another_instance_to_the_bit() {
    let slave = Slave::running();
    let point = drive(&slave, 0.0, 40);
    let bytes = slave.bytes_of(slave.save());
    drive(&slave, point, 40);
    let other = Slave::new();
    let state = other.deserialize(&bytes).expect("sound bytes");
    assert_eq!(other.bytes_of(state), bytes);
    assert_eq!(other.set_state(state), Status::Ok);
    drive(&other, point, 40);
    assert_eq!(other.picture(), slave.picture());
    assert!(bytes.len() < 16_384, "{} bytes", bytes.len());
}

#[test]
fn a_short_buffer_is_refused_and_a_long_one_is_filled_up() {
    let slave = Slave::running();
    let state = slave.save();
    let bytes = slave.bytes_of(state);
    let mut short = vec![7; bytes.len() - 1];
    assert_eq!(slave.serialize(state, &mut short), Status::Error);
    assert!(slave.log.only().text.contains(&bytes.len().to_string()));
    assert!(short.iter().all(|&byte| byte == 7));
    let mut long = vec![7; bytes.len() + 9];
    assert_eq!(slave.serialize(state, &mut long), Status::Ok);
    assert!(slave.deserialize(&long).is_ok());
}

#[test]
fn a_scene_s_modes_are_part_of_its_states() {
    let mut scene = Scene::default();
    (scene.rod.flexible.bending_modes, scene.rod.flexible.axial_modes) = (8, 8);
    scene.rod.flexible.table = Some(slidercrank::model::rod::beam::table(&scene));
    scene.energy.audit = true;
    let state = FmuState {
        state: State::InitializationMode,
        settings: Settings::of(scene),
        last_step: Status::Ok,
        dead_end: false,
        snapshot: None,
    };
    let bytes = state.to_bytes().expect("bytes");
    // A master that saves each step and frees none pays this for each.
    assert!(bytes.len() < 1 << 15, "{} bytes", bytes.len());
    assert_eq!(FmuState::from_bytes(&bytes), Ok(state));
    let mut torn = bytes.clone();
    torn[bytes.len() / 2] ^= 1;
    assert!(FmuState::from_bytes(&torn).is_err());
}

#[test]
fn an_old_place_is_kept_when_bytes_are_refused() {
    let slave = Slave::running();
    let mut state = slave.save();
    let before = state;
    // SAFETY: live component, buffer of the length said, one place.
    let status = unsafe { (slave.api.DeSerializeFMUstate)(slave.c, [0; 4].as_ptr(), 4, &mut state) };
    assert_eq!((status, state), (Status::Error, before));
    assert_eq!(slave.set_state(state), Status::Ok);
}

/// Where the other process finds the bytes.
const BYTES: &str = "SLIDERCRANK_TEST_STATE";

#[test]
fn bytes_are_restored_in_another_process_to_the_bit() {
    let slave = Slave::running();
    let point = drive(&slave, 0.0, 40);
    let file = std::env::temp_dir().join(format!("slidercrank-state-{}", std::process::id()));
    std::fs::write(&file, slave.bytes_of(slave.save())).expect("a writable temporary folder");
    drive(&slave, point, 40);
    let output = std::process::Command::new(std::env::current_exe().expect("a path"))
        .args(["--exact", "states::the_other_process", "--ignored", "--nocapture"])
        .env(BYTES, &file)
        .output()
        .expect("another process");
    std::fs::remove_file(&file).expect("the file just written");
    let told = String::from_utf8(output.stdout).expect("text");
    assert!(told.contains(&format!("{:?}", slave.picture())), "{told}");
}

#[test]
#[ignore = "run by the test above, in a process of its own"]
fn the_other_process() {
    let Some(file) = std::env::var_os(BYTES) else { return };
    let bytes = std::fs::read(file).expect("bytes");
    let slave = Slave::new();
    let state = slave.deserialize(&bytes).expect("sound bytes");
    assert_eq!(slave.set_state(state), Status::Ok);
    drive(&slave, slave.last_time(), 40);
    println!("{:?}", slave.picture());
}
