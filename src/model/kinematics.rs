//! Poses, velocities and accelerations of the joint centres, outwards from the roots of the chains.
//!
//! ```text
//!                     crank_pin  o--- B ---o big_end
//!                    throw   _-'                 '-_   reach
//!        crank  o--- A ---o-'                       '-o small_end --- C ---o pin
//!               (main journal)
//! ```
//!
//! Position, velocity and acceleration of a point are the same sum over arms that are fixed in bodies. Only the
//! contribution of an arm a differs: rot(θ)·a, ω·perp(rot(θ)·a), α·perp(rot(θ)·a) − ω²·rot(θ)·a. The path through the
//! mechanism is therefore coded once, in [`JointVectors::outwards`].

use super::bodies::AugmentedBodies;
use super::plane::{Rotation, Vec2, perp};
use super::structure::{CRANK, Link, ROD, Roots, SLIDER, Structure};
use crate::math::Real;
use std::ops::{Add, Mul, Sub};

/// A value for every joint centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointPoints<V> {
    /// Main journal of the crank.
    pub crank: V,
    /// Pin journal of the crank.
    pub crank_pin: V,
    /// Big end of the rod.
    pub big_end: V,
    /// Small end of the rod.
    pub small_end: V,
    /// Pin of the slider.
    pub pin: V,
}

/// A vector (position, velocity or acceleration) for every joint centre.
pub type JointVectors<R = f64> = JointPoints<Vec2<R>>;

/// Arms of the bodies in inertial axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arms<V> {
    /// From the crank's main journal to its pin.
    pub throw: V,
    /// From the rod's big end to its small end.
    pub reach: V,
    /// The crank's part of the vector from its chain's centre of mass to the chain's first joint; zero unless the chain
    /// floats.
    pub crank: V,
    /// The rod's part of that vector.
    pub rod: V,
    /// The slider's part of that vector.
    pub slider: V,
}

/// Angles, angular velocities and rotations of crank, rod and slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyRotations<R = f64> {
    /// [rad] Angles.
    pub angle: [R; 3],
    /// [rad/s] Angular velocities.
    pub speed: [R; 3],
    /// Rotations by the angles.
    pub rotation: [Rotation<R>; 3],
}

/// Place and velocity of a point, which are summed together.
#[derive(Clone, Copy, Debug, Default)]
pub struct PointMotion<R> {
    /// [m] Place.
    pub place: Vec2<R>,
    /// [m/s] Velocity.
    pub velocity: Vec2<R>,
}

impl<R: Real> Add for PointMotion<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { place: self.place + other.place, velocity: self.velocity + other.velocity }
    }
}

impl<R: Real> Sub for PointMotion<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { place: self.place - other.place, velocity: self.velocity - other.velocity }
    }
}

impl<R: Copy> JointPoints<PointMotion<R>> {
    /// Places of the joint centres.
    #[inline(always)]
    pub fn places(&self) -> JointVectors<R> {
        JointPoints {
            crank: self.crank.place,
            crank_pin: self.crank_pin.place,
            big_end: self.big_end.place,
            small_end: self.small_end.place,
            pin: self.pin.place,
        }
    }

    /// Velocities of the joint centres.
    #[inline(always)]
    pub fn velocities(&self) -> JointVectors<R> {
        JointPoints {
            crank: self.crank.velocity,
            crank_pin: self.crank_pin.velocity,
            big_end: self.big_end.velocity,
            small_end: self.small_end.velocity,
            pin: self.pin.velocity,
        }
    }
}

impl<V: Copy + Default + Add<Output = V> + Sub<Output = V>> JointPoints<V> {
    /// Sums arms from the roots outwards. The place of a pin on a rail is that of its root. In a closed loop the pin
    /// and the small end of the rod are left to the caller.
    #[inline(always)]
    pub fn outwards(of: &Structure, roots: &Roots<V>, arms: &Arms<V>) -> Self {
        let (b, c) = (!of.play.crank_pin, !of.play.slider_pin);
        let mut all = Self::default();
        if let Link::Rail(_) = of.slider {
            all.pin = roots.slider;
            if c {
                all.small_end = all.pin;
                all.big_end = all.pin - arms.reach;
            }
        }
        match of.crank {
            Link::After => {
                all.crank_pin = all.big_end;
                all.crank = all.crank_pin - arms.throw;
            }
            Link::Free(_) => {
                all.crank = roots.crank + arms.crank;
                if b {
                    all.crank = all.crank + arms.rod;
                    if c {
                        all.crank = all.crank + arms.slider;
                    }
                }
                all.crank_pin = all.crank + arms.throw;
            }
            _ => all.crank_pin = arms.throw,
        }
        match of.rod {
            Link::After => return all,
            Link::Free(_) => {
                all.big_end = roots.rod + arms.rod;
                if c {
                    all.big_end = all.big_end + arms.slider;
                }
            }
            _ => all.big_end = all.crank_pin,
        }
        all.small_end = all.big_end + arms.reach;
        match of.slider {
            Link::Free(_) => all.pin = roots.slider + arms.slider,
            Link::Before => all.pin = all.small_end,
            _ => {}
        }
        all
    }
}

impl<V: Copy + Add<Output = V> + Sub<Output = V>> Roots<V> {
    /// The roots of a mechanism with given joint centres: the inverse of [`JointPoints::outwards`]. Roots that the
    /// mechanism does not have are meaningless.
    pub fn of(of: &Structure, centres: &JointPoints<V>, arms: &Arms<V>) -> Self {
        let (b, c) = (!of.play.crank_pin, !of.play.slider_pin);
        let mut roots =
            Self { crank: centres.crank - arms.crank, rod: centres.big_end - arms.rod, slider: centres.pin };
        if b {
            roots.crank = roots.crank - arms.rod;
            if c {
                roots.crank = roots.crank - arms.slider;
            }
        }
        if c {
            roots.rod = roots.rod - arms.slider;
        }
        if let Link::Free(_) = of.slider {
            roots.slider = roots.slider - arms.slider;
        }
        roots
    }
}

impl<R: Real> Arms<Vec2<R>> {
    /// The arms at these rotations, with a crank of length `throw` [m] and a rod or chord of length `reach` [m].
    #[inline(always)]
    pub fn at<L: Copy>(
        of: &Structure,
        throw: f64,
        reach: L,
        augmented: &AugmentedBodies,
        rotations: &BodyRotations<R>,
    ) -> Self
    where
        R: Mul<L, Output = R>,
    {
        let [crank, rod, slider] = &rotations.rotation;
        let mut arms = Self { throw: crank.axis(throw), reach: rod.axis(reach), ..Self::default() };
        if of.floats[CRANK] {
            arms.crank = crank.apply(augmented.anchor[CRANK]);
        }
        if of.floats[ROD] {
            arms.rod = rod.apply(augmented.anchor[ROD]);
        }
        if of.floats[SLIDER] {
            arms.slider = slider.apply(augmented.anchor[SLIDER]);
        }
        arms
    }

    /// The arms and their contributions to velocities, at the angular velocities [rad/s] of crank, rod and slider.
    #[inline(always)]
    pub fn moving(self, [crank, rod, slider]: [R; 3]) -> Arms<PointMotion<R>> {
        Arms {
            throw: PointMotion::rotations(self.throw, crank),
            reach: PointMotion::rotations(self.reach, rod),
            crank: PointMotion::rotations(self.crank, crank),
            rod: PointMotion::rotations(self.rod, rod),
            slider: PointMotion::rotations(self.slider, slider),
        }
    }

    /// The arms' contributions to accelerations, at angular velocities w [rad/s] and angular accelerations a [rad/s²].
    #[inline(always)]
    pub fn accelerated(self, [w1, w2, w3]: [R; 3], [a1, a2, a3]: [R; 3]) -> Self {
        Self {
            throw: accelerated(self.throw, w1, a1),
            reach: accelerated(self.reach, w2, a2),
            crank: accelerated(self.crank, w1, a1),
            rod: accelerated(self.rod, w2, a2),
            slider: accelerated(self.slider, w3, a3),
        }
    }
}

impl<R: Real> PointMotion<R> {
    /// An arm that rotates at `speed` [rad/s].
    #[inline(always)]
    fn rotations(arm: Vec2<R>, speed: R) -> Self {
        Self { place: arm, velocity: perp(arm) * speed }
    }
}

#[inline(always)]
fn accelerated<R: Real>(arm: Vec2<R>, speed: R, alpha: R) -> Vec2<R> {
    arm.multiply_add(-(speed * speed), alpha * perp(arm))
}
