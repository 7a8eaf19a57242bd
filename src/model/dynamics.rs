//! M(q)·q̈ = Q(t, q, q̇): accelerations from the loads on the bodies.
//!
//! The coordinates of a chain are those of its root and the absolute angles θ of its bodies. Constants of augmented
//! bodies (see [`bodies`](super::bodies)) give the mass matrix of the angles,
//!
//! ```text
//!          | d1   m12  m13 |
//!     M =  | m12  d2   m23 |,   m_kl = α_kl·cos(θ_l − θ_k) + β_kl·sin(θ_l − θ_k), 0 if k and l are in different chains
//!          | m13  m23  d3  |
//! ```
//!
//! and the centrifugal terms θ̇²·∂m/∂θ. Forces are accumulated inwards: a force on a body beyond a joint acts on the
//! body inside that joint, too, with its moment about the joint. Then
//!
//! - a root on the ground does not move;
//! - a floating root is the centre of mass of its chain: m·r̈ = ΣF, without inertial coupling to the angles;
//! - a pin on the rail has m·ẍ − Σ h_k,y·θ̈_k = F, with F the force along the rail and h_k,y the component of
//!   rot(θ_k)·h_k. ẍ is eliminated, which subtracts h_k,y·h_l,y/m from m_kl and adds h_k,y·F/m to Q_k;
//! - in a closed loop the rod follows the crank, θ̈2 = ρ·θ̈1 + σ: the crank's equation plus ρ times the rod's is
//!   solved.

use super::bodies::AugmentedBodies;
use super::ideal::IdealMotion;
use super::kinematics::{Arms, BodyRotations};
use super::loads::Loads;
use super::plane::{Rotation, Vec2, cross};
use super::structure::{CRANK, Link, ROD, Roots, SLIDER, Structure};
use crate::math::{Fused, Real};
use std::ops::Mul;

/// Accelerations of the roots and of the three angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accelerations<R = f64> {
    /// [m/s²] Roots of the chains.
    pub roots: Roots<Vec2<R>>,
    /// [rad/s²] Angles of crank, rod and slider.
    pub angle: [R; 3],
}

/// The mass matrix of the angles.
#[derive(Clone, Copy)]
pub(super) struct MassMatrix<R> {
    /// [kg·m²] Crank angle.
    pub d1: R,
    /// [kg·m²] Rod angle.
    pub d2: R,
    /// [kg·m²] Slider angle.
    pub d3: R,
    /// [kg·m²] Coupling of crank and rod.
    pub m12: R,
    /// [kg·m²] Coupling of rod and slider.
    pub m23: R,
    /// [kg·m²] Coupling of crank and slider.
    pub m13: R,
}

/// M and Q of the angles of crank, rod and slider, each about the root of its chain.
///
/// Each number is a separate field: arrays that are filled only in part stay in memory, which takes 1.4 times as long.
pub(super) struct Equations<R> {
    /// Mass matrix M.
    pub m: MassMatrix<R>,
    /// [N·m] Q of the crank angle.
    pub q1: R,
    /// [N·m] Q of the rod angle.
    pub q2: R,
    /// [N·m] Q of the slider angle.
    pub q3: R,
    /// [kg·m] First moment of the crank's augmented body about the joint by which it hangs, in inertial axes; zero if
    /// its chain floats.
    pub h1: Vec2<R>,
    /// [kg·m] First moment of the rod's augmented body about the joint by which it hangs, in inertial axes; zero if its
    /// chain floats.
    pub h2: Vec2<R>,
}

/// Forces [N], accumulated inwards.
pub(super) struct AccumulatedForces<R> {
    /// Force on the floating chain that contains the crank.
    pub crank: Vec2<R>,
    /// Force on the floating chain that begins with the rod.
    pub rod: Vec2<R>,
    /// Force on the slider if it floats alone.
    pub slider: Vec2<R>,
    /// Force on the pin that an ideal guide holds.
    pub rail: Vec2<R>,
    /// Force on the rod at the end by which it does not hang, including that of the bodies that hang there.
    pub far_end: Vec2<R>,
}

impl<R: Real> Equations<R> {
    /// Equations with inertia, couples, centrifugal terms and weight.
    #[inline(always)]
    pub fn new<C: Copy>(
        of: &Structure,
        bodies: &AugmentedBodies<C>,
        gravity: Vec2,
        rotations: &BodyRotations<R>,
        loads: &Loads<R>,
        number: impl Fn(C) -> R,
    ) -> Self
    where
        R: Mul<C, Output = R> + Fused<C>,
    {
        let [r1, r2, r3] = rotations.rotation;
        let [w1, w2, w3] = rotations.speed;
        let (s1, s2, s3) = (w1 * w1, w2 * w2, w3 * w3);
        let [mut q1, mut q2, mut q3] = loads.couples();

        // M and its centrifugal terms in Q.
        let [d1, d2, d3] = bodies.diagonal.map(number);
        let mut m = MassMatrix { d1, d2, d3, m12: R::ZERO, m23: R::ZERO, m13: R::ZERO };
        if of.coupled[0] {
            m.m12 = couple(bodies, 0, [r1, r2], [s1, s2], &mut q1, &mut q2);
        }
        if of.coupled[1] {
            m.m23 = couple(bodies, 1, [r2, r3], [s2, s3], &mut q2, &mut q3);
        }
        if of.coupled[2] {
            m.m13 = couple(bodies, 2, [r1, r3], [s1, s3], &mut q1, &mut q3);
        }

        // Weight of the chains that do not float. Gravity along x turns nothing in a chain that falls along the rail.
        let (mut h1, mut h2) = (Vec2::<R>::ZERO, Vec2::<R>::ZERO);
        if of.weighs[CRANK] {
            h1 = r1.apply(bodies.moment[CRANK]);
            q1 = h1.x.multiply_add(gravity.y, q1);
            if of.crank != Link::After {
                q1 = h1.y.multiply_add(-gravity.x, q1);
            }
        }
        if of.weighs[ROD] {
            h2 = r2.apply(bodies.moment[ROD]);
            q2 = h2.x.multiply_add(gravity.y, q2);
            if of.rod != Link::After {
                q2 = h2.y.multiply_add(-gravity.x, q2);
            }
        }
        if of.weighs[SLIDER] {
            let h3: Vec2<R> = r3.apply(bodies.moment[SLIDER]);
            q3 = h3.x.multiply_add(gravity.y, q3);
            q3 = h3.y.multiply_add(-gravity.x, q3);
        }
        Self { m, q1, q2, q3, h1, h2 }
    }

    /// Accumulates the forces inwards to the roots and adds their moments to Q.
    #[inline(always)]
    pub fn gather(&mut self, of: &Structure, arms: &Arms<Vec2<R>>, loads: &Loads<R>) -> AccumulatedForces<R> {
        let Self { q1, q2, q3, .. } = self;
        let (b, c) = (!of.play.crank_pin, !of.play.slider_pin);
        let (none, slider) = (Vec2::ZERO, loads.pin);
        let mut all = AccumulatedForces { crank: none, rod: none, slider, rail: loads.pin, far_end: loads.small_end };
        let mut on_crank_pin = loads.crank_pin;
        match of.slider {
            Link::Before => all.far_end = loads.pin,
            Link::Free(_) => *q3 += cross(arms.slider, loads.pin),
            _ => {}
        }
        if of.rod == Link::After {
            all.far_end = loads.big_end;
            if of.crank == Link::After {
                *q1 -= cross(arms.throw, loads.crank);
                all.far_end = loads.crank;
            }
            *q2 -= cross(arms.reach, all.far_end);
            all.rail += all.far_end;
        } else {
            *q2 += cross(arms.reach, all.far_end);
            let total = loads.big_end + all.far_end;
            if let Link::Free(_) = of.rod {
                *q2 += cross(arms.rod, total);
                if c {
                    *q3 += cross(arms.slider, total);
                }
                all.rod = total;
            } else {
                on_crank_pin = total;
            }
        }
        match of.crank {
            Link::After => {}
            Link::Free(_) => {
                let total = on_crank_pin + loads.crank;
                *q1 += cross(arms.throw, on_crank_pin) + cross(arms.crank, total);
                if b {
                    *q2 += cross(arms.rod, total);
                    if c {
                        *q3 += cross(arms.slider, total);
                    }
                }
                all.crank = total;
            }
            _ => *q1 += cross(arms.throw, on_crank_pin),
        }
        all
    }
}

/// Solves the equations of motion with a rigid rod. `closing` describes how the rod of a closed loop follows its crank.
#[inline(always)]
pub fn accelerate<R: Real>(
    of: &Structure,
    bodies: &AugmentedBodies,
    gravity: Vec2,
    rotations: &BodyRotations<R>,
    arms: &Arms<Vec2<R>>,
    closing: &IdealMotion<R>,
    loads: &Loads<R>,
) -> Accelerations<R> {
    let mut equations = Equations::new(of, bodies, gravity, rotations, loads, R::constant);
    let forces = equations.gather(of, arms, loads);
    let Equations { mut m, mut q1, mut q2, q3, h1, h2 } = equations;
    let mut roots = forces.fall(of, bodies, gravity);
    if let Link::Rail(_) = of.slider {
        let [w1, w2, _] = rotations.speed;
        let per_mass = bodies.per_mass[SLIDER];
        let mut along = forces.rail.x;
        if of.rod == Link::After {
            along = (w2 * w2).multiply_add(h2.x, along);
            let share2 = h2.y * per_mass;
            if of.crank == Link::After {
                along = (w1 * w1).multiply_add(h1.x, along);
                let share1 = h1.y * per_mass;
                q1 = share1.multiply_add(along, q1);
                m.d1 = (-share1).multiply_add(h1.y, m.d1);
                m.m12 = (-share1).multiply_add(h2.y, m.m12);
            }
            q2 = share2.multiply_add(along, q2);
            m.d2 = (-share2).multiply_add(h2.y, m.d2);
        }
        let angle = m.solve_crank_and_rod(of, [q1, q2]);
        let [a1, a2, _] = angle;
        if of.rod == Link::After {
            along = h2.y.multiply_add(a2, along);
            if of.crank == Link::After {
                along = h1.y.multiply_add(a1, along);
            }
        }
        roots.slider.x = along.multiply_add(per_mass, R::constant(gravity.x));
        Accelerations { roots, angle }
    } else if of.closed {
        Accelerations { roots, angle: m.solve_closed(of, closing, [q1, q2]) }
    } else {
        Accelerations { roots, angle: m.solve(of, [q1, q2, q3]) }
    }
}

impl<R: Real> AccumulatedForces<R> {
    /// Accelerations of the centres of mass of floating chains.
    #[inline(always)]
    pub fn fall(&self, of: &Structure, bodies: &AugmentedBodies, gravity: Vec2) -> Roots<Vec2<R>> {
        let fall = Vec2::constant(gravity);
        let mut roots = Roots::<Vec2<R>>::default();
        if let Link::Free(_) = of.crank {
            roots.crank = self.crank.multiply_add(bodies.per_mass[CRANK], fall);
        }
        if let Link::Free(_) = of.rod {
            roots.rod = self.rod.multiply_add(bodies.per_mass[ROD], fall);
        }
        if let Link::Free(_) = of.slider {
            roots.slider = self.slider.multiply_add(bodies.per_mass[SLIDER], fall);
        }
        roots
    }
}

/// m_kl of the pair `pair` of bodies with rotations `k` and `l` and squared speeds `square_k` and `square_l`; adds its
/// centrifugal terms to Q.
#[inline(always)]
fn couple<R: Real + Mul<C, Output = R> + Fused<C>, C: Copy>(
    bodies: &AugmentedBodies<C>,
    pair: usize,
    [k, l]: [Rotation<R>; 2],
    [square_k, square_l]: [R; 2],
    q_k: &mut R,
    q_l: &mut R,
) -> R {
    let (alpha, beta) = (bodies.cos[pair], bodies.sin[pair]);
    let cos = k.cos.multiply_add(l.cos, k.sin * l.sin);
    let sin = l.sin.multiply_add(k.cos, -(l.cos * k.sin));
    let centrifugal = sin.multiply_add(alpha, -(cos * beta));
    *q_k = centrifugal.multiply_add(square_l, *q_k);
    *q_l = (-centrifugal).multiply_add(square_k, *q_l);
    cos.multiply_add(alpha, sin * beta)
}

/// The right-hand sides are available last; reciprocals of the matrix are computed before them.
impl<R: Real> MassMatrix<R> {
    /// Accelerations of the angles of crank and rod; the slider does not turn.
    #[inline(always)]
    pub fn solve_crank_and_rod(&self, of: &Structure, [q1, q2]: [R; 2]) -> [R; 3] {
        let Self { d1, d2, m12, .. } = *self;
        if of.topology.speed {
            [R::ZERO, q2 * d2.recip(), R::ZERO]
        } else if of.coupled[0] {
            let [a1, a2] = solve_two([d1, d2], m12, [q1, q2]);
            [a1, a2, R::ZERO]
        } else {
            [q1 * d1.recip(), q2 * d2.recip(), R::ZERO]
        }
    }

    /// Accelerations of the three angles by cofactors: one division, and only the last products wait for the right-hand
    /// side. A matrix without couplings is solved angle by angle.
    #[inline(always)]
    pub fn solve(&self, of: &Structure, [q1, q2, q3]: [R; 3]) -> [R; 3] {
        let Self { d1, d2, d3, m12, m23, m13 } = *self;
        if !(of.coupled[1] || (of.coupled[0] && !of.topology.speed)) {
            let a1 = if of.topology.speed { R::ZERO } else { q1 * d1.recip() };
            [a1, q2 * d2.recip(), q3 * d3.recip()]
        } else if of.topology.speed {
            let [a2, a3] = solve_two([d2, d3], m23, [q2, q3]);
            [R::ZERO, a2, a3]
        } else {
            let c11 = d2.multiply_add(d3, -(m23 * m23));
            let c22 = d1.multiply_add(d3, -(m13 * m13));
            let c33 = d1.multiply_add(d2, -(m12 * m12));
            let c12 = m13.multiply_add(m23, -(m12 * d3));
            let c13 = m12.multiply_add(m23, -(m13 * d2));
            let c23 = m12.multiply_add(m13, -(m23 * d1));
            let per_determinant = d1.multiply_add(c11, m12.multiply_add(c12, m13 * c13)).recip();
            [
                c11.multiply_add(q1, c12.multiply_add(q2, c13 * q3)) * per_determinant,
                c12.multiply_add(q1, c22.multiply_add(q2, c23 * q3)) * per_determinant,
                c13.multiply_add(q1, c23.multiply_add(q2, c33 * q3)) * per_determinant,
            ]
        }
    }

    /// Accelerations in a closed loop: (M11 + 2·ρ·M12 + ρ²·M22)·θ̈1 = Q1 + ρ·Q2 − (M12 + ρ·M22)·σ.
    #[inline(always)]
    fn solve_closed(&self, of: &Structure, closing: &IdealMotion<R>, [q1, q2]: [R; 2]) -> [R; 3] {
        let Self { d1, d2, m12, .. } = *self;
        let (ratio, bias) = (closing.rod_ratio, closing.rod_bias);
        let with_rod = ratio.multiply_add(d2, m12);
        let inertia = ratio.multiply_add(with_rod + m12, d1);
        let power = (-with_rod).multiply_add(bias, ratio.multiply_add(q2, q1));
        let a1 = if of.topology.speed { R::ZERO } else { power / inertia };
        [a1, ratio.multiply_add(a1, bias), R::ZERO]
    }
}

#[inline(always)]
fn solve_two<R: Real>(d: [R; 2], m: R, q: [R; 2]) -> [R; 2] {
    let per_determinant = d[0].multiply_add(d[1], -(m * m)).recip();
    [q[0].multiply_add(d[1], -(m * q[1])) * per_determinant, q[1].multiply_add(d[0], -(m * q[0])) * per_determinant]
}
