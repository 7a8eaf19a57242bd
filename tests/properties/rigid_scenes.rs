//! Mechanisms with rigid contacts that more than one property is asserted of.

use super::scenes::{Play, at_tolerance, contacts, crooked, speed_driven, with_play};
use slidercrank::scene::read::read;
use slidercrank::scene::{FrictionLaw, Method, Scene};

/// [s] About a microsecond, and of a binary fraction: multiples of it are exact, so that outputs are of steps' ends.
pub const STEP: f64 = 1.0 / 1_048_576.0;

/// With rigid contacts, in steps of `step` [s].
pub fn rigid(mut scene: Scene, step: f64) -> Scene {
    scene.solver.method = Method::Moreau;
    scene.solver.step = step;
    scene
}

/// With this restitution and coefficient of friction everywhere.
pub fn rubbing(mut scene: Scene, restitution: f64, friction: f64) -> Scene {
    for contact in contacts(&mut scene) {
        contact.restitution = restitution;
        contact.friction.law = if friction > 0.0 { FrictionLaw::Ambrosio } else { FrictionLaw::None };
        contact.friction.coefficient = friction;
    }
    scene
}

/// A slider alone between two lines 10 mm above and below it, the rod's end in a hole that it does not meet.
pub fn loose_slider() -> Scene {
    let mut scene = speed_driven(with_play(Scene::default(), [false, false, true, true]));
    (scene.joint.c.radius, scene.joint.c.clearance) = (0.2, 0.1);
    scene.joint.t.clearance = 0.01;
    // A rod too sluggish to swing.
    scene.rod.inertia = 1e6;
    scene.gravity = 9.81;
    scene
}

/// The shipped scene after Flores, Leine and Glocker 2010.
pub fn guideplay() -> Scene {
    let text = include_str!("../../fmu-harness/scenes/guideplay.toml");
    read(text, "guideplay.toml").expect("a shipped scene").scene
}

/// Plays that nothing meets in a few hundredths of a second.
pub fn wide(play: Play) -> Scene {
    let mut scene = at_tolerance(with_play(crooked(), play), 1e-12);
    let joint = &mut scene.joint;
    for revolute in [&mut joint.a, &mut joint.b, &mut joint.c] {
        (revolute.radius, revolute.clearance) = (0.9, 0.1);
    }
    joint.t.clearance = 0.1;
    scene
}
