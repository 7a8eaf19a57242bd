//! Sections of a motion: at a crank angle once per turn, and at impacts.

use super::{Flow, Machine};
use anyhow::Result;
use slidercrank::model::signals::Outputs;
use slidercrank::scene::DriveMode;
use std::f64::consts::TAU;

/// A point of a section.
#[derive(Clone, Copy, Debug)]
pub struct Visit {
    /// [s]
    pub time: f64,
    /// Outputs at this time.
    pub outputs: Outputs,
}

/// The impact of a journal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// [s]
    pub time: f64,
    /// The joint: A, B, C.
    pub joint: char,
    /// [rad] Crank angle, from 0 to one turn.
    pub crank: f64,
    /// [rad] Position on the bearing.
    pub place: f64,
    /// [m/s] Approach speed.
    pub speed: f64,
}

/// Points at the crank angle `angle` [rad] relative to the start, one in each of the next `count` turns after the last
/// complete turn.
///
/// # Errors
/// If the machine cannot go on.
pub fn stroboscope(machine: &mut Machine, angle: f64, count: usize, mut tick: impl FnMut()) -> Result<Vec<Visit>> {
    // A billionth of a turn is a rounding error.
    let first = ((machine.turned() - angle) / TAU - 1e-9).ceil();
    let mut visits = Vec::with_capacity(count);
    for turn in 0..count {
        machine.advance_turned(angle + TAU * (first + turn as f64))?;
        visits.push(Visit { time: machine.time(), outputs: machine.outputs() });
        tick();
    }
    Ok(visits)
}

/// [s] Mean time of a turn between points of a section; at the prescribed speed, if there is one.
pub fn turn(machine: &Machine, visits: &[Visit]) -> f64 {
    match visits {
        [first, .., last] if machine.scene().drive.mode == DriveMode::Torque => {
            (last.time - first.time) / (visits.len() - 1) as f64
        }
        _ => machine.turn(),
    }
}

/// All impacts in revolute joints during the next `span` [s]; not more than `most`.
///
/// # Errors
/// If the machine cannot go on.
pub fn impacts(machine: &mut Machine, span: f64, most: usize) -> Result<Vec<Impact>> {
    let end = machine.time() + span;
    let contacts = |outputs: &Outputs| revolutes(outputs).map(|(_, joint)| joint.contact);
    let mut closed = contacts(&machine.outputs());
    let mut impacts = Vec::new();
    while impacts.len() < most && machine.advance_to_event(end)? {
        let outputs = machine.outputs();
        let now = contacts(&outputs);
        for (number, (name, joint)) in revolutes(&outputs).into_iter().enumerate() {
            if now[number] && !closed[number] {
                let [x, y] = joint.eccentricity;
                let speed = machine.approach(number).unwrap_or_default();
                let crank = outputs.crank.angle.rem_euclid(TAU);
                impacts.push(Impact { time: machine.time(), joint: name, crank, place: y.atan2(x), speed });
            }
        }
        closed = now;
    }
    Ok(impacts)
}

/// Names of the joints with journals.
fn revolutes(outputs: &Outputs) -> [(char, slidercrank::model::signals::RevoluteOutputs); 3] {
    [('A', outputs.joint_a), ('B', outputs.joint_b), ('C', outputs.joint_c)]
}
