//! Model exchange of mechanisms that the linked library is not packaged with: copies of this test program, each packaged
//! with another one.

use crate::exchanged::BRISTLES;
use crate::scenes::{MECHANISMS, packaged};
use crate::{COPY, brief};
use slidercrank::scene::{Method, slot};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

/// Whether a test is one of model exchange, by its name.
const FILTERS: [&str; 2] = ["_exchange", "model_exchange"];

#[test]
#[cfg(target_os = "linux")]
fn all_mechanisms_are_exchanged_as_safely() {
    let program = std::env::current_exe().expect("a path");
    let mut tests = 0;
    for (place, mechanism) in MECHANISMS.iter().enumerate() {
        let scene = mechanism.scene();
        // Rigid contacts have no equations of motion.
        if place == packaged() || scene.solver.method == Method::Moreau || brief() && place == BRISTLES {
            continue;
        }
        let mut bytes = fs::read(&program).expect("this program");
        slot::write(&mut bytes, &scene).expect("a slot");
        let copy = program.with_file_name(format!("hostile-{}-{place}", std::process::id()));
        fs::write(&copy, bytes).expect("a copy");
        fs::set_permissions(&copy, fs::Permissions::from_mode(0o755)).expect("a program");
        let output = Command::new(&copy)
            .env(COPY, "1")
            .args(FILTERS)
            .args(["--skip", "all_mechanisms"])
            .output()
            .expect("a run");
        fs::remove_file(&copy).expect("a copy");
        let told = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {told}", mechanism.name);
        tests += told.matches("... ok").count();
        println!("{}: {}", mechanism.name, told.lines().find(|line| line.contains("test result")).unwrap_or_default());
    }
    assert!(tests > 40, "{tests}");
}
