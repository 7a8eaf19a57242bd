//! Joint forces of an instant: contact forces in joints with clearance, and in ideal joints the forces that the
//! Newton–Euler equations of the bodies require.
//!
//! In an open chain the bodies are visited one by one from the joint with clearance, whose contact force is known. Only
//! the closed loop needs an equation with two unknowns: the moments on the rod about its big end.

use super::body::Bodies;
use super::inertial_load::InertialLoad;
use super::plane::{Vec2, cross};
use super::state::Evaluation;
use super::structure::{CRANK, ROD, SLIDER, Topology};
use crate::math::Real;

/// Forces of the joints, each on the second body of its pair: ground on crank, crank on rod, rod on slider, guide on
/// slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reactions<R = f64> {
    /// [N] Force of the main bearing on the crank.
    pub a: Vec2<R>,
    /// [N] Force of the crank on the rod.
    pub b: Vec2<R>,
    /// [N] Force of the rod on the slider.
    pub c: Vec2<R>,
    /// [N] Force of the guide on the slider.
    pub t: Vec2<R>,
    /// [N·m] Couple of the guide on the slider, about the pin.
    pub moment: R,
    /// [N·m] Torque of a speed drive on the crank.
    pub torque: R,
}

/// The joint forces at `evaluation`.
pub fn reactions<R: Real>(
    topology: Topology,
    bodies: &Bodies,
    gravity: Vec2,
    evaluation: &Evaluation<R>,
) -> Reactions<R> {
    let Evaluation { pose, acceleration, angle_acceleration, loads, flexible } = evaluation;
    let rotations = &pose.rotations;
    let demand = |k: usize, point: Vec2<R>| {
        InertialLoad::new(&bodies[k], rotations.rotation[k], rotations.speed[k], angle_acceleration[k], point, gravity)
    };
    let of_crank = demand(CRANK, acceleration.crank);
    let of_rod = match flexible {
        Some(flexible) => flexible.demand,
        None => demand(ROD, acceleration.big_end),
    };
    let of_slider = demand(SLIDER, acceleration.pin);
    let Topology { a, b, c, t, .. } = topology;
    let load = Vec2::new(loads.slider_load, R::ZERO);
    let guide = loads.guide;
    // Forces of ideal joints are zero until they are computed below.
    let mut r = Reactions {
        a: loads.crank,
        b: loads.big_end,
        c: -loads.small_end,
        t: guide.force,
        moment: guide.couple,
        torque: R::ZERO,
    };

    if !t {
        if c {
            r.c = of_slider.force - r.t - load;
        }
        if b {
            r.b = of_rod.force + r.c;
        }
        if a {
            r.a = of_crank.force + r.b;
        }
    } else {
        if !c {
            if b {
                r.b = of_rod.force + r.c;
            }
            if a {
                r.a = of_crank.force + r.b;
            }
        } else if !b {
            r.c = r.b - of_rod.force;
            if a {
                r.a = of_crank.force + r.b;
            }
        } else if !a {
            r.b = r.a - of_crank.force;
            r.c = r.b - of_rod.force;
        } else {
            let x = of_slider.force.x - guide.force.x - load.x;
            let rod_arm = pose.place.small_end - pose.place.big_end;
            r.c = closed_loop_pin_force(&of_rod, loads.couples()[ROD], x, rod_arm);
            r.b = of_rod.force + r.c;
            r.a = of_crank.force + r.b;
        }
        let rest = of_slider.force - r.c - load;
        r.t = Vec2::new(guide.force.x, rest.y);
        // Moment about the pin, through which all other forces on the slider pass.
        r.moment = of_slider.moment - loads.slider_couple;
    }
    let to_pin = pose.place.crank_pin - pose.place.crank;
    r.torque = of_crank.moment + cross(to_pin, r.b) - loads.crank_couple;
    r
}

/// [N] Force of the rod on the slider if all joints are ideal, given its component `x` along the guide.
fn closed_loop_pin_force<R: Real>(rod: &InertialLoad<R>, couple: R, x: R, arm: Vec2<R>) -> Vec2<R> {
    // Moments about the big end: required moment = couple − arm × F_C.
    let moment = couple - rod.moment;
    Vec2::new(x, (moment + arm.y * x) / arm.x)
}
