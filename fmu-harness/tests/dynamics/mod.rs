//! Sections, exponents, verdicts and branches, on motions whose answers are known.

use slidercrank::scene::read::{SceneFile, read};

mod ball;
mod linear;
mod lorenz;
mod maps;
mod mechanism;
mod oscillator;
mod response;
mod system;
mod tangent;

/// A light free crank under a constant torque, whose speed varies widely over a turn.
const LIGHT_CRANK: &str = r#"
[drive]
mode = "torque"
[crank]
speed_start = "30 rad/s"
torque = "20 N.m"
inertia = 0.0005
[joint.A]
damping = 0.2
"#;

fn light_crank() -> SceneFile {
    read(LIGHT_CRANK, "light crank").expect("a scene")
}
