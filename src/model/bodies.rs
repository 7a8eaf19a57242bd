//! Crank, rod and slider as rigid bodies, and the constants of augmented bodies.
//!
//! ```text
//!                                       com
//!                                      *
//!                               s _ -'     inertia about the centre of mass
//!       reference point (first joint) o─────────── length ───────────o second joint ──> body x axis
//!
//!
//!    a chain: crank, rod and slider joined by ideal joints A, B, C       a_ik is fixed in body k
//!
//!                 B                       a_11 crank: A to its centre of mass
//!           a_21 _o-._   a_32             a_21 crank: A to B        (the rod hangs on the crank at B)
//!              _-'    `-._                a_22 rod:   B to its centre of mass
//!      crank _-'      rod `-._            a_31 crank: A to B        (the slider hangs on the rod)
//!         _-'                 `-._        a_32 rod:   B to C        (the slider hangs on the rod at C)
//! root A o                        `o C    a_33 slider: C to its centre of mass
//! ```
//!
//! The chains and their roots are those of [`structure`](super::structure). Frames: body axes of body k are turned by
//! the absolute angle θ_k against inertial axes; rot(θ) turns a vector by θ and perp(v) = (−v_y, v_x). Symbols: m_i
//! mass and J_i moment of inertia of body i about its centre of mass, r_i position of its centre of mass.
//!
//! In a chain r_i = root + Σ_k rot(θ_k)·a_ik. The arm a_ik leads, in the axes of body k, from the joint by which k
//! hangs to the joint by which i hangs on k, or to the centre of mass if i = k; it is zero if i does not hang on k.
//! With the angles θ_k as coordinates the kinetic energy is
//!
//! T = ½·Σ_i (m_i·|ṙ_i|² + J_i·θ̇_i²), ṙ_i = root' + Σ_k θ̇_k·perp(rot(θ_k)·a_ik).
//!
//! Since rot(θ_k)·a · rot(θ_l)·b = cos(θ_l − θ_k)·a·b + sin(θ_l − θ_k)·a·perp(b), the mass matrix depends only on
//! constants of the augmented bodies and on differences of angles:
//!
//! - M_kk = J_k + Σ_i m_i·|a_ik|² (`diagonal`),
//! - M_kl = α_kl·cos(θ_l − θ_k) + β_kl·sin(θ_l − θ_k), α_kl = Σ_i m_i·a_ik·a_il (`cos`), β_kl = Σ_i m_i·a_ik·perp(a_il)
//!   (`sin`),
//! - and the coupling with the root's velocity is Σ_i m_i·perp(rot(θ_k)·a_ik) = perp(rot(θ_k)·h_k), h_k = Σ_i m_i·a_ik
//!   (`moment`).
//!
//! The root of a floating chain is its centre of mass. Every arm is then reduced by h_k/m, where m is the chain's mass,
//! and the coupling with the root's velocity vanishes. The vector from the centre of mass to the chain's first joint is
//! Σ_k rot(θ_k)·(−h_k/m) (`anchor`). (J. Wittenburg, Dynamics of Systems of Rigid Bodies, 1977, 5.2.)
//!
//! The length L, the first moment D and the moment of inertia J about the big end of a flexible rod change as it
//! deforms. The augmented bodies of its chain then depend on L, D and J, with few products ([`RodInChain`]). The root
//! of that chain is a joint, and its arms are not reduced.

use super::body::{Bodies, Body};
use super::plane::{Vec2, perp};
use super::rod::Rod;
use super::structure::{CRANK, Link, ROD, SLIDER, Structure, Topology};
use crate::math::Real;
use crate::scene::{Point, Scene};

/// The three bodies of a scene. The mass properties of a flexible rod are those of its undeformed beam.
pub fn bodies(scene: &Scene) -> Bodies {
    let point = |p: Point| Vec2::new(p.x, p.y);
    let Scene { crank, rod, slider, .. } = scene;
    let of_rod = match Rod::new(scene) {
        Some(flexible) => flexible.undeformed(),
        None => Body { mass: rod.mass, inertia: rod.inertia, com: point(rod.com), length: rod.length },
    };
    [
        Body { mass: crank.mass, inertia: crank.inertia, com: point(crank.com), length: crank.length },
        of_rod,
        Body { mass: slider.mass, inertia: slider.inertia, com: point(slider.com), length: 0.0 },
    ]
}

/// Constants of the augmented bodies, or their values at one instant with a flexible rod. `diagonal`, `moment`,
/// `anchor` and `per_mass` are listed by body; `cos` and `sin` by the pairs crank–rod, rod–slider, crank–slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AugmentedBodies<C = f64> {
    /// [kg·m²] M_kk.
    pub diagonal: [C; 3],
    /// [kg·m²] α of each pair.
    pub cos: [C; 3],
    /// [kg·m²] β of each pair.
    pub sin: [C; 3],
    /// [kg·m] h_k; zero in a floating chain.
    pub moment: [Vec2<C>; 3],
    /// [m] −h_k/m in a floating chain; zero in others.
    pub anchor: [Vec2; 3],
    /// [1/kg] Inverse mass of the chain of each body.
    pub per_mass: [f64; 3],
}

impl AugmentedBodies {
    /// Sums over the chains of a mechanism.
    pub fn new(bodies: &Bodies, structure: &Structure) -> Self {
        let Topology { b, c, .. } = structure.topology;
        let mut sum = Self::default();
        // arms[i][k] is a_ik; first[i] is the first body of the chain of body i.
        let (arms, first) = if structure.rod == Link::After { inwards(bodies, b) } else { outwards(bodies, b, c) };
        let mut arms = arms;
        let mut mass = [0.0; 3];
        for i in 0..3 {
            for j in (0..3).filter(|&j| first[j] == first[i]) {
                mass[i] += bodies[j].mass;
                sum.moment[i] += bodies[j].mass * arms[j][i];
            }
        }
        sum.per_mass = mass.map(f64::recip);
        for k in (0..3).filter(|&k| structure.floats[k]) {
            let centre = sum.moment[k] / mass[k];
            sum.anchor[k] = -centre;
            sum.moment[k] = Vec2::ZERO;
            for i in (0..3).filter(|&i| first[i] == first[k]) {
                arms[i][k] -= centre;
            }
        }
        for k in 0..3 {
            let square = |i: usize| bodies[i].mass * arms[i][k].norm_squared();
            let chain = (0..3).filter(|&i| first[i] == first[k]);
            sum.diagonal[k] = bodies[k].inertia + chain.map(square).sum::<f64>();
        }
        for (pair, (k, l)) in [(CRANK, ROD), (ROD, SLIDER), (CRANK, SLIDER)].into_iter().enumerate() {
            for i in (0..3).filter(|&i| first[i] == first[k] && first[i] == first[l]) {
                sum.cos[pair] += bodies[i].mass * arms[i][k].dot(arms[i][l]);
                sum.sin[pair] += bodies[i].mass * arms[i][k].dot(perp(arms[i][l]));
            }
        }
        sum
    }
}

/// The position of a flexible rod in its chain: it hangs by its big end, or by its small end if the slider is on its
/// rail.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RodInChain {
    /// Position of the joint by which other bodies hang on the rod, in chords along the rod's x axis from the joint by
    /// which the rod hangs: 1 or −1.
    pub far: f64,
    /// Position of the big end in the same measure: 0 or −1.
    pub big_end: f64,
    /// [kg] κ in the first moment about the joint by which the rod hangs, including the bodies that hang on it: h = D +
    /// κ·L along x.
    pub first: f64,
    /// [kg] |κ| in the moment of inertia about that joint: J + 2·big_end·L·D_x + |κ|·L².
    pub second: f64,
    /// [m] Length of the crank.
    throw: f64,
}

impl RodInChain {
    /// The rod's position in the chain of a mechanism.
    pub fn new(bodies: &Bodies, structure: &Structure) -> Self {
        let (Topology { b, c, .. }, throw) = (structure.topology, bodies[CRANK].length);
        if structure.rod == Link::After {
            let second = bodies[ROD].mass + if b { bodies[CRANK].mass } else { 0.0 };
            Self { far: -1.0, big_end: -1.0, first: -second, second, throw }
        } else {
            let second = if c { bodies[SLIDER].mass } else { 0.0 };
            Self { far: 1.0, big_end: 0.0, first: second, second, throw }
        }
    }

    /// The augmented bodies for a chord of `length` [m], a first moment `first` [kg·m] about the big end in rod axes
    /// and a moment of inertia `inertia` [kg·m²] about the big end. `constant` are those of the undeformed rod.
    #[inline(always)]
    pub fn augmented<R: Real>(
        &self,
        of: &Structure,
        constant: &AugmentedBodies,
        length: R,
        first: Vec2<R>,
        inertia: R,
    ) -> AugmentedBodies<R> {
        let mut all = AugmentedBodies {
            diagonal: constant.diagonal.map(R::constant),
            cos: constant.cos.map(R::constant),
            sin: constant.sin.map(R::constant),
            moment: constant.moment.map(Vec2::constant),
            anchor: constant.anchor,
            per_mass: constant.per_mass,
        };
        let own = Vec2::new(length.multiply_add(self.first, first.x), first.y);
        all.moment[ROD] = own;
        let by_length = (length * self.second).multiply_add(length, inertia);
        all.diagonal[ROD] = (first.x * (2.0 * self.big_end)).multiply_add(length, by_length);
        if of.rod == Link::After {
            let crank = constant.moment[CRANK];
            (all.cos[0], all.sin[0]) = (length * -crank.x, length * -crank.y);
        } else {
            let slider = constant.moment[SLIDER];
            (all.cos[0], all.sin[0]) = (own.x * self.throw, own.y * -self.throw);
            (all.cos[1], all.sin[1]) = (length * slider.x, length * -slider.y);
        }
        all
    }
}

/// Arms a_ik of each centre of mass, and the first body of each chain.
type Arms = ([[Vec2; 3]; 3], [usize; 3]);

/// The vector from a body's reference point to a point on its x axis.
const fn along(length: f64) -> Vec2 {
    Vec2::new(length, 0.0)
}

/// Arms if every body hangs by its first joint, on the body before it where that joint is ideal.
fn outwards(bodies: &Bodies, b: bool, c: bool) -> Arms {
    let (mut arms, mut first) = ([[Vec2::ZERO; 3]; 3], [CRANK, ROD, SLIDER]);
    for i in [CRANK, ROD, SLIDER] {
        arms[i][i] = bodies[i].com;
    }
    if b {
        first[ROD] = CRANK;
        arms[ROD][CRANK] = along(bodies[CRANK].length);
    }
    if c {
        first[SLIDER] = first[ROD];
        arms[SLIDER][ROD] = along(bodies[ROD].length);
        arms[SLIDER][CRANK] = arms[ROD][CRANK];
    }
    (arms, first)
}

/// Arms if the slider is on its rail, the rod hangs on the slider by its last joint, and the crank hangs on the rod if
/// joint B is ideal.
fn inwards(bodies: &Bodies, b: bool) -> Arms {
    let mut arms = [[Vec2::ZERO; 3]; 3];
    arms[SLIDER][SLIDER] = bodies[SLIDER].com;
    arms[ROD][ROD] = bodies[ROD].com - along(bodies[ROD].length);
    arms[CRANK][CRANK] = bodies[CRANK].com;
    if !b {
        return (arms, [CRANK, SLIDER, SLIDER]);
    }
    arms[CRANK][CRANK] -= along(bodies[CRANK].length);
    arms[CRANK][ROD] = -along(bodies[ROD].length);
    (arms, [SLIDER; 3])
}
