//! Crank, rod, slider: lengths, masses, and the inertia of what ideal joints leave connected.
//!
//! Any clearance joint cuts the loop. Bodies that ideal joints still connect form open chains, each
//! with an anchor point: the ground at A, the slider's pin on an ideal guide, or, for a chain that
//! floats, its own centre of mass. Within a chain every centre of mass is the anchor plus body-fixed
//! vectors: r_i = anchor + Σ_k rot(θ_k)·c_ik. Hence, with absolute angles as coordinates, the mass
//! matrix has the elements M_kl = α_kl·cos(θ_l − θ_k) + β_kl·sin(θ_l − θ_k) and nothing but constants
//! otherwise (augmented bodies; J. Wittenburg, Dynamics of Systems of Rigid Bodies, 1977, 5.2).

use super::plane::{Vec2, perp};
use super::rod::Rod;
use crate::scene::{JointModel, Point, Scene};

/// Index of the crank, the rod and the slider.
pub const CRANK: usize = 0;
/// The rod.
pub const ROD: usize = 1;
/// The slider.
pub const SLIDER: usize = 2;

/// Which joints are ideal and whether the crank's angle is prescribed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Topology {
    /// Main bearing is ideal.
    pub a: bool,
    /// Crank pin is ideal.
    pub b: bool,
    /// Slider pin is ideal.
    pub c: bool,
    /// Guide is ideal.
    pub t: bool,
    /// The crank's angle is prescribed.
    pub speed: bool,
}

impl Topology {
    /// Whether its one play is that of a pin or of the main bearing: with more contacts, or with those of the slider's corners,
    /// steps in blocks take as long as others.
    pub const fn has_one_play_in_a_pin(self) -> bool {
        self.a as u8 + self.b as u8 + self.c as u8 == 2 && self.t
    }
}

impl Topology {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        let ideal = |model| model == JointModel::Ideal;
        Self {
            a: ideal(scene.joint.a.model),
            b: ideal(scene.joint.b.model),
            c: ideal(scene.joint.c.model),
            t: ideal(scene.joint.t.model),
            speed: scene.drive.mode == crate::scene::DriveMode::Speed,
        }
    }

    /// All joints are ideal: a closed loop.
    pub const fn is_closed(self) -> bool {
        self.a && self.b && self.c && self.t
    }

    /// The chain with the crank floats.
    pub const fn crank_floats(self) -> bool {
        let on_rail = self.b && self.c && self.t;
        !(self.a || on_rail)
    }

    /// The rod floats, alone or with the slider.
    pub const fn rod_floats(self) -> bool {
        let on_rail = self.c && self.t;
        !(self.b || on_rail)
    }

    /// The slider floats alone.
    pub const fn slider_floats(self) -> bool {
        !self.t && !self.c
    }

    /// Number of degrees of freedom.
    pub const fn freedoms(self) -> usize {
        let cuts = !self.a as usize + !self.b as usize + !self.c as usize + !self.t as usize;
        1 + 2 * cuts - self.speed as usize
    }
}

/// A rigid body: its mass properties and its joint on the x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// [kg]
    pub mass: f64,
    /// [kg·m²] About the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass from the reference point, in body axes.
    pub com: Vec2,
    /// [m] Distance of the second joint from the reference point, along the body's x axis.
    pub length: f64,
}

/// Inertia of the chains, as constants.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChainInertia {
    /// [kg·m²] M_kk.
    pub diagonal: [f64; 3],
    /// [kg·m²] α of the pairs crank-rod, rod-slider, crank-slider.
    pub cos: [f64; 3],
    /// [kg·m²] β of the same pairs.
    pub sin: [f64; 3],
    /// [kg·m] Σ m_i·c_ik of each body's angle; zero in a floating chain.
    pub moment: [Vec2; 3],
    /// [m] From the chain's centre of mass to its first joint centre, per angle: where a floating
    /// chain is to be found from its coordinates. Zero in the others.
    pub anchor: [Vec2; 3],
    /// [1/kg] Inverse mass of the chain that holds each body.
    pub per_mass: [f64; 3],
}

/// The three bodies.
pub type Bodies = [Body; 3];

/// The three bodies of a scene; a flexible rod's mass properties are its beam's.
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

impl ChainInertia {
    /// Sums the chains of an open mechanism.
    pub fn new(bodies: &Bodies, topology: Topology) -> Self {
        let Topology { a, b, c, t, .. } = topology;
        let mut sum = Self::default();
        let along = |length: f64| Vec2::new(length, 0.0);
        let zero = Vec2::ZERO;
        // Forward from the crank's or the rod's first joint; backward from the pin on a rail.
        let rail_rod = c && t;
        let rail_crank = b && c && t;
        let mut arms = [[zero; 3]; 3];
        let mut first = [0, 1, 2];
        if rail_rod {
            arms[SLIDER][SLIDER] = bodies[SLIDER].com;
            arms[ROD][ROD] = bodies[ROD].com - along(bodies[ROD].length);
            first = [if rail_crank { SLIDER } else { CRANK }, SLIDER, SLIDER];
            arms[CRANK][CRANK] = bodies[CRANK].com;
            if rail_crank {
                arms[CRANK][CRANK] -= along(bodies[CRANK].length);
                arms[CRANK][ROD] = -along(bodies[ROD].length);
            }
        } else {
            for i in 0..3 {
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
        }
        let mut mass = [0.0; 3];
        for i in 0..3 {
            for j in (0..3).filter(|&j| first[j] == first[i]) {
                mass[i] += bodies[j].mass;
                sum.moment[i] += bodies[j].mass * arms[j][i];
            }
        }
        sum.per_mass = mass.map(f64::recip);
        let floats = |k: usize| match first[k] {
            CRANK => !a,
            ROD => true,
            _ => !t,
        };
        for k in (0..3).filter(|&k| floats(k)) {
            let centre = sum.moment[k] / mass[k];
            sum.anchor[k] = -centre;
            sum.moment[k] = zero;
            for i in (0..3).filter(|&i| first[i] == first[k]) {
                arms[i][k] -= centre;
            }
        }
        for k in 0..3 {
            let square = |i: usize| bodies[i].mass * arms[i][k].norm_squared();
            let chain = (0..3).filter(|&i| first[i] == first[k]);
            sum.diagonal[k] = bodies[k].inertia + chain.map(square).sum::<f64>();
        }
        for (pair, (k, l)) in [(0, 1), (1, 2), (0, 2)].into_iter().enumerate() {
            for i in (0..3).filter(|&i| first[i] == first[k] && first[i] == first[l]) {
                sum.cos[pair] += bodies[i].mass * arms[i][k].dot(arms[i][l]);
                sum.sin[pair] += bodies[i].mass * arms[i][k].dot(perp(arms[i][l]));
            }
        }
        sum
    }
}
