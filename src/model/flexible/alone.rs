//! A crank or a slider that clearances part from the rod: m·a = ΣF at its centre of mass, I·α = Σ moments.

use super::configuration::{Centre, Configuration, Heading};
use crate::math::Real;
use crate::model::bodies::{Bodies, Body};
use crate::model::loads::Loads;
use crate::model::plane::{Vec2, cross, perp};
use crate::model::structure::Structure;
use crate::model::structure::{CRANK, SLIDER, Topology};

/// Sets the accelerations of the bodies that are not in the rod's chain, as biases: nothing in x moves them.
#[inline(always)]
pub fn accelerate<R: Real, const P: usize>(
    topology: Topology,
    bodies: &Bodies,
    configuration: &mut Configuration<R, P>,
    loads: &Loads<R>,
    gravity: f64,
) {
    let Topology { a, b, c, t, speed } = topology;
    let Configuration { heading, crank, crank_pin, pin, .. } = configuration;
    if !b {
        let (body, heading) = (&bodies[CRANK], &mut heading[CRANK]);
        let throw = heading.rotation.axis(body.length);
        let moment = loads.crank_couple + cross(throw, loads.crank_pin);
        if a {
            if !speed {
                let arm = heading.rotation.apply(body.com);
                let about_axis = body.inertia + body.mass * body.com.norm_squared();
                heading.bias = (moment - arm.x * (body.mass * gravity)) / about_axis;
            }
        } else {
            float(body, heading, crank, loads.crank + loads.crank_pin, moment, gravity, !speed);
        }
        crank_pin.bias = crank.along(heading, 1.0, throw).bias;
    }
    if !c {
        let (body, heading) = (&bodies[SLIDER], &mut heading[SLIDER]);
        if t {
            pin.bias = Vec2::new(loads.pin.x / body.mass, R::ZERO);
        } else {
            float(body, heading, pin, loads.pin, loads.slider_couple, gravity, true);
        }
    }
}

/// Writes their accelerations into a list in the order of the positions.
#[inline(always)]
pub fn write<R: Real, const P: usize>(structure: &Structure, configuration: &Configuration<R, P>, list: &mut [R]) {
    let Configuration { heading, crank, pin, .. } = configuration;
    let mut roots = structure.roots(list);
    let mut turn = |body: usize| {
        if let Some(position) = structure.angle(body) {
            list[position] = heading[body].bias;
        }
    };
    if !structure.topology.b {
        roots.crank = crank.bias;
        turn(CRANK);
    }
    if !structure.topology.c {
        roots.slider = pin.bias;
        turn(SLIDER);
    }
    structure.set_roots(&roots, list);
}

/// Accelerates a floating body under `force` [N] and its `moment` [N·m] about the joint centre `at`, with which it
/// has been summed. It may be one whose angle is prescribed.
#[inline(always)]
fn float<R: Real, const P: usize>(
    body: &Body,
    heading: &mut Heading<R, P>,
    at: &mut Centre<R, P>,
    force: Vec2<R>,
    moment: R,
    gravity: f64,
    turns: bool,
) {
    let arm = heading.rotation.apply(body.com);
    if turns {
        heading.bias = (moment - cross(arm, force)) / body.inertia;
    }
    let of_mass = force / body.mass - Vec2::new(0.0, gravity);
    at.bias = of_mass - heading.bias * perp(arm) + heading.speed * heading.speed * arm;
}
