//! Joint forces of one instant: contact forces where there is clearance, and where a joint is ideal
//! what Newton's and Euler's equations of the bodies leave for it.
//!
//! An open chain is walked from the cut, where the contact force is known, body by body. Only the
//! closed loop needs an equation with two unknowns: the moments on the rod about its big end.

use super::mechanism::{Bodies, Body, CRANK, ROD, SLIDER, Topology};
use super::plane::{Rotation, Vec2, cross, perp};
use super::state::Instant;

/// Forces of the joints, each on the body that interface and model name first: ground on crank, crank
/// on rod, rod on slider, guide on slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reactions {
    /// [N] Main bearing on crank.
    pub a: Vec2,
    /// [N] Crank on rod.
    pub b: Vec2,
    /// [N] Rod on slider.
    pub c: Vec2,
    /// [N] Guide on slider.
    pub t: Vec2,
    /// [N·m] Guide on slider, about the pin.
    pub moment: f64,
    /// [N·m] What a speed drive adds to the couples on the crank.
    pub torque: f64,
}

/// What a body's motion needs of forces and of moments about its reference point, gravity subtracted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demand {
    /// [N]
    pub force: Vec2,
    /// [N·m] About the body's reference point.
    pub moment: f64,
}

impl Demand {
    fn new(body: &Body, rotation: Rotation, speed: f64, alpha: f64, point: Vec2, gravity: f64) -> Self {
        let com = rotation.apply(body.com);
        let acceleration = point + alpha * perp(com) - speed * speed * com;
        let force = body.mass * (acceleration + Vec2::new(0.0, gravity));
        Self { force, moment: body.inertia * alpha + cross(com, force) }
    }
}

/// The joint forces at `instant`.
pub fn reactions(topology: Topology, bodies: &Bodies, gravity: f64, instant: &Instant) -> Reactions {
    let Instant { pose, acceleration, angle_acceleration, loads, flexible } = instant;
    let turning = &pose.turning;
    let demand = |k: usize, point: Vec2| {
        Demand::new(&bodies[k], turning.rotation[k], turning.speed[k], angle_acceleration[k], point, gravity)
    };
    let of_crank = demand(CRANK, acceleration.crank);
    let of_rod = match flexible {
        Some(flexible) => flexible.demand,
        None => demand(ROD, acceleration.big_end),
    };
    let of_slider = demand(SLIDER, acceleration.pin);
    let Topology { a, b, c, t, .. } = topology;
    let load = Vec2::new(loads.slider_load, 0.0);
    let guide = loads.guide;
    // Zero where a joint is ideal, until it is its turn.
    let mut r = Reactions {
        a: loads.crank,
        b: loads.big_end,
        c: -loads.small_end,
        t: guide.force,
        moment: guide.couple,
        torque: 0.0,
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
        // About the pin, where all other forces act.
        r.moment = of_slider.moment - loads.slider_couple;
    }
    let to_pin = pose.place.crank_pin - pose.place.crank;
    r.torque = of_crank.moment + cross(to_pin, r.b) - loads.crank_couple;
    r
}

/// [N] Rod on slider where all joints are ideal, from its component `x` along the guide.
fn closed_loop_pin_force(rod: &Demand, couple: f64, x: f64, arm: Vec2) -> Vec2 {
    // About the big end: what is needed = couple − arm × F_C.
    let moment = couple - rod.moment;
    Vec2::new(x, (moment + arm.y * x) / arm.x)
}
