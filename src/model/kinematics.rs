//! Poses, velocities and accelerations of the joint centres, walked along the chains.
//!
//! Position, velocity and acceleration of a point are the same sum over body-fixed arms; only what a
//! body's turning makes of an arm differs: rot(θ)·a, ω·perp(rot(θ)·a), α·perp(rot(θ)·a) − ω²·rot(θ)·a.

use super::mechanism::{Bodies, CRANK, ChainInertia, ROD, SLIDER, Topology};
use super::plane::{Rotation, Vec2, perp};
use crate::math::Real;

/// One vector (a position, velocity or acceleration) for every joint centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointCentres<R = f64> {
    /// The crank's main journal.
    pub crank: Vec2<R>,
    /// The crank's pin journal.
    pub crank_pin: Vec2<R>,
    /// The rod's big end.
    pub big_end: Vec2<R>,
    /// The rod's small end.
    pub small_end: Vec2<R>,
    /// The slider's pin.
    pub pin: Vec2<R>,
}

/// What the roots of the chains contribute: positions, velocities or accelerations of floating
/// centres of mass and of the pin on an ideal guide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Roots<R = f64> {
    /// Of the chain with the crank, where it floats.
    pub crank: Vec2<R>,
    /// Of the chain that starts with the rod, where it floats.
    pub rod: Vec2<R>,
    /// Of the slider: its pin on an ideal guide, its centre of mass where it floats alone.
    pub slider: Vec2<R>,
}

/// Angles, rates and rotations of crank, rod and slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning<R = f64> {
    /// [rad]
    pub angle: [R; 3],
    /// [rad/s]
    pub speed: [R; 3],
    /// Rotations by the angles.
    pub rotation: [Rotation<R>; 3],
}

/// A linear map of a body's arm, given in body axes.
pub trait Turn<R>: Copy {
    /// What becomes of an arm of body `k`.
    fn arm(&self, k: usize, arm: Vec2) -> Vec2<R>;
    /// What becomes of an arm of `length` along the x axis of body `k`.
    fn axis(&self, k: usize, length: f64) -> Vec2<R>;
}

/// Positions.
#[derive(Clone, Copy)]
pub struct Place<'a, R>(pub &'a Turning<R>);

/// Velocities.
#[derive(Clone, Copy)]
pub struct Velocity<'a, R>(pub &'a Turning<R>);

/// Accelerations, with the angular accelerations.
#[derive(Clone, Copy)]
pub struct Acceleration<'a, R>(pub &'a Turning<R>, pub &'a [R; 3]);

impl<R: Real> Turn<R> for Place<'_, R> {
    #[inline(always)]
    fn arm(&self, k: usize, arm: Vec2) -> Vec2<R> {
        self.0.rotation[k].apply(arm)
    }
    #[inline(always)]
    fn axis(&self, k: usize, length: f64) -> Vec2<R> {
        self.0.rotation[k].axis(length)
    }
}

impl<R: Real> Turn<R> for Velocity<'_, R> {
    #[inline(always)]
    fn arm(&self, k: usize, arm: Vec2) -> Vec2<R> {
        self.0.speed[k] * perp(self.0.rotation[k].apply(arm))
    }
    #[inline(always)]
    fn axis(&self, k: usize, length: f64) -> Vec2<R> {
        perp(self.0.rotation[k].axis(self.0.speed[k] * length))
    }
}

impl<R: Real> Turn<R> for Acceleration<'_, R> {
    #[inline(always)]
    fn arm(&self, k: usize, arm: Vec2) -> Vec2<R> {
        let arm = self.0.rotation[k].apply(arm);
        let speed = self.0.speed[k];
        arm.times_plus(-(speed * speed), self.1[k] * perp(arm))
    }
    #[inline(always)]
    fn axis(&self, k: usize, length: f64) -> Vec2<R> {
        self.arm(k, Vec2::new(length, 0.0))
    }
}

/// Walks the chains of an open mechanism from their roots.
#[inline(always)]
pub fn walk<R: Real, V: Turn<R>>(
    topology: Topology,
    bodies: &Bodies,
    chains: &ChainInertia,
    roots: &Roots<R>,
    turn: V,
) -> JointCentres<R> {
    let mut centres = JointCentres::default();
    let arm = |k: usize| turn.arm(k, chains.anchor[k]);
    let crank_length = turn.axis(CRANK, bodies[CRANK].length);
    let rod_length = turn.axis(ROD, bodies[ROD].length);
    let Topology { a, b, c, t, .. } = topology;
    if t {
        centres.pin = roots.slider;
    }
    if c && t {
        centres.small_end = centres.pin;
        centres.big_end = centres.pin - rod_length;
    }
    if b && c && t {
        centres.crank_pin = centres.big_end;
        centres.crank = centres.crank_pin - crank_length;
        return centres;
    }
    if !a {
        centres.crank = roots.crank + arm(CRANK);
        if b {
            centres.crank += arm(ROD);
        }
        if b && c {
            centres.crank += arm(SLIDER);
        }
    }
    centres.crank_pin = centres.crank + crank_length;
    if c && t {
        return centres;
    }
    if b {
        centres.big_end = centres.crank_pin;
    } else {
        centres.big_end = roots.rod + arm(ROD);
        if c {
            centres.big_end += arm(SLIDER);
        }
    }
    centres.small_end = centres.big_end + rod_length;
    if c {
        centres.pin = centres.small_end;
    } else if !t {
        centres.pin = roots.slider + arm(SLIDER);
    }
    centres
}

/// The roots of an open mechanism whose joint centres are known: the way back from [`walk`].
pub fn roots<R: Real, V: Turn<R>>(
    topology: Topology,
    chains: &ChainInertia,
    centres: &JointCentres<R>,
    turn: V,
) -> Roots<R> {
    let Topology { b, c, t, .. } = topology;
    let arm = |k: usize| turn.arm(k, chains.anchor[k]);
    let mut roots = Roots { crank: centres.crank, rod: centres.big_end, slider: centres.pin };
    roots.crank -= arm(CRANK);
    if b {
        roots.crank -= arm(ROD);
    }
    if b && c {
        roots.crank -= arm(SLIDER);
    }
    roots.rod -= arm(ROD);
    if c {
        roots.rod -= arm(SLIDER);
    }
    if !t {
        roots.slider -= arm(SLIDER);
    }
    roots
}
