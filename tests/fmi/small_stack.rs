//! Threads of a host may have little stack: every shipped scene lives its whole life in 64 kB of it.

use host::Slave;
use slidercrank::fmi::slave::Settings;
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::fmu_state::FmuState;
use slidercrank::fmi::v2::lifecycle::State;
use slidercrank::scene::parameter::{Kind, PARAMETERS};
use slidercrank::scene::read::{SceneFile, read};
use slidercrank::scene::{Method, Scene};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

/// [bytes] A POSIX system or real-time host rarely gives a thread less; musl gives 128 kB by default.
const STACK: usize = 64 * 1024;
const STEPS: usize = 20;
/// Where a process finds the scene that it runs.
const SCENE: &str = "SLIDERCRANK_TEST_SCENE";
/// And whether another method is to integrate it than its own.
const METHOD: &str = "SLIDERCRANK_TEST_METHOD";
/// And whether its rod is to have as many modes as a rod may have.
const ALL_MODES: &str = "SLIDERCRANK_TEST_ALL_MODES";
/// Folder of tables of modes, which the rod of the scene `flexrod` takes in turn.
const MODES: &str = "modes";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fmu-harness/scenes")
}

/// Every shipped scene, and every table of modes.
fn shipped() -> Vec<PathBuf> {
    let (mut files, mut folders) = (vec![], vec![folder()]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder of scenes") {
            let path = entry.expect("an entry").path();
            let list = if path.is_dir() { &mut folders } else { &mut files };
            list.push(path);
        }
    }
    files.retain(|file| file.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    files
}

fn file(path: &Path) -> SceneFile {
    let read_from = |path: &Path| -> SceneFile {
        let text = std::fs::read_to_string(path).expect("a shipped scene");
        read(&text, &path.display().to_string()).expect("a legal scene")
    };
    if !path.parent().is_some_and(|folder| folder.ends_with(MODES)) {
        return read_from(path);
    }
    let table = path.strip_prefix(folder()).expect("a shipped table").display();
    let mut flexrod = read_from(&folder().join("flexrod.toml"));
    let told = format!("rod.flexible.table = \"{table}\"");
    let table = read(&told, &folder().join("flexrod.toml").display().to_string()).expect("a table").scene;
    flexrod.scene.rod.flexible.table = table.rod.flexible.table;
    assert!(flexrod.scene.rod.flexible.table.is_some());
    flexrod
}

/// A run with inputs that change and slope, saved, told as bytes and gone on from.
fn live(file: &SceneFile, with_table: Option<&[u8]>) {
    let slave = Slave::new();
    let fine = |status: Status| assert_eq!(status, Status::Ok, "{:?}", slave.log.take());
    fine(slave.setup_raw(0, 0.0, 0.0, 0, 0.0));
    match with_table {
        Some(bytes) => fine(slave.set_state(slave.deserialize(bytes).expect("sound bytes"))),
        None => set(&slave, &file.scene),
    }
    fine(slave.enter());
    let angle = file.scene.crank.angle_start;
    fine(slave.set("crank.torque", file.inputs.crank_torque.value(0.0, angle)));
    fine(slave.set("slider.load", file.inputs.slider_load.value(0.0, angle)));
    slave.picture();
    fine(slave.exit());
    let mut point = slave.steps(0.0, file.run.step, STEPS / 2);
    let mut state = slave.save();
    let bytes = slave.bytes_of(state);
    for from_bytes in [false, true] {
        if from_bytes {
            let mut told = slave.deserialize(&bytes).expect("its own state");
            fine(slave.set_state(told));
            fine(slave.free(&mut told));
            point = slave.last_time();
        }
        fine(slave.set_rate("slider.load", 1, 1.0));
        slave.steps(point, file.run.step, STEPS / 2);
        slave.picture();
        assert!(slave.sensitivity("slider.a", "slider.load", 1.0).is_ok(), "{:?}", slave.log.take());
    }
    fine(slave.set_state(state));
    fine(slave.free(&mut state));
    assert!(slave.get_integer("solver.steps") > 0);
    fine(slave.terminate());
    slave.picture();
    fine(slave.reset());
}

fn set(slave: &Slave, scene: &Scene) {
    for parameter in PARAMETERS {
        let status = match parameter.kind {
            Kind::Real { get, .. } => slave.set(parameter.name, get(scene)),
            Kind::Integer { get, .. } | Kind::Enumeration { get, .. } => slave.set_integer(parameter.name, get(scene)),
            Kind::Boolean { get, .. } => slave.set_boolean(parameter.name, i32::from(get(scene))),
        };
        assert_eq!(status, Status::Ok, "{}: {:?}", parameter.name, slave.log.take());
    }
}

/// What the process for one scene does.
fn live_in_a_small_stack(path: &Path) {
    let mut file = file(path);
    if std::env::var_os(METHOD).is_some() {
        file.scene.solver.method = Method::Radau13;
        // With many modes its steps take long, and what they need of the stack shows in the first ones.
        file.run.step /= 10.0;
    }
    if std::env::var_os(ALL_MODES).is_some() {
        (file.scene.rod.flexible.bending_modes, file.scene.rod.flexible.axial_modes) = (8, 8);
    }
    let table = file.scene.rod.flexible.table.is_some().then(|| {
        let settings = Settings::of(file.scene.clone());
        let state =
            FmuState { state: State::Instantiated, settings, last_step: Status::Ok, dead_end: false, snapshot: None };
        state.to_bytes().expect("bytes")
    });
    let small = thread::Builder::new().name("small".into()).stack_size(STACK);
    // On the stack are the library's frames, not what the host reads a scene into.
    let file = Box::new(file);
    let thread = small.spawn(move || live(&file, table.as_deref())).expect("a thread");
    thread.join().expect("a whole life");
}

/// A stack that overflows ends the process: each scene has one of its own, by its own method, and by that with exact
/// Jacobians, which the automatic one goes over to.
#[test]
fn every_shipped_scene_lives_in_a_thread_of_little_stack() {
    if let Some(path) = std::env::var_os(SCENE) {
        return live_in_a_small_stack(Path::new(&path));
    }
    let scenes = shipped();
    assert!(scenes.len() > 20, "{scenes:?}");
    let mut failures = vec![];
    let flexrod = folder().join("flexrod.toml");
    let of_scenes = scenes.iter().flat_map(|scene| [(scene, None, false), (scene, Some("radau13"), false)]);
    for (scene, method, all_modes) in of_scenes.chain([(&flexrod, Some("radau13"), true)]) {
        let mut command = Command::new(std::env::current_exe().expect("a path"));
        command.args(["--exact", "small_stack::every_shipped_scene_lives_in_a_thread_of_little_stack", "--nocapture"]);
        command.env(SCENE, scene);
        if let Some(method) = method {
            command.env(METHOD, method);
        }
        if all_modes {
            command.env(ALL_MODES, "");
        }
        let output = command.output().expect("another process");
        let told = String::from_utf8_lossy(&output.stdout);
        if output.status.success() {
            assert!(told.contains("1 passed"), "{told}");
            continue;
        }
        let scene = scene.strip_prefix(folder()).unwrap_or(scene).display();
        let complaint = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        failures.push(format!("{scene} by {}: {}: {complaint}", method.unwrap_or("its own method"), output.status));
    }
    assert!(failures.is_empty(), "{} lives end early:\n{}", failures.len(), failures.join("\n"));
}
