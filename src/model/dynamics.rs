//! M(q)·q̈ = Q(t, q, q̇) of an open mechanism: loads on the bodies in, accelerations out.

use super::bristles::Bristles;
use super::joint::{guide, revolute};
use super::kinematics::{Roots, Turning};
use super::mechanism::{Bodies, CRANK, ChainInertia, ROD, SLIDER, Topology};
use super::plane::{Vec2, cross};
use crate::math::{Real, each};

/// Loads on the bodies but for gravity and the reactions of ideal joints: forces at the joint
/// centres and couples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loads<R = f64> {
    /// [N] On the crank at its main journal.
    pub crank: Vec2<R>,
    /// [N] On the crank at its pin.
    pub crank_pin: Vec2<R>,
    /// [N] On the rod at its big end.
    pub big_end: Vec2<R>,
    /// [N] On the rod at its small end.
    pub small_end: Vec2<R>,
    /// [N] On the slider at its pin.
    pub pin: Vec2<R>,
    /// [N·m] On the crank.
    pub crank_couple: R,
    /// [N·m] On the rod's sections at its big and small end.
    pub end_couple: [R; 2],
    /// [N·m] On the slider, about its pin.
    pub slider_couple: R,
    /// The input's part of the force at the slider's pin [N].
    pub slider_load: R,
    /// The guide's part: contact, or viscous friction of an ideal guide.
    pub guide: guide::Load<R>,
    /// [m/s] Rates of the bristles' deflections in the contacts.
    pub bristle_rate: Bristles<R>,
}

impl<R: Real> Loads<R> {
    /// Adds the contact of joint A, B or C (0, 1, 2).
    #[inline(always)]
    pub fn add_contact(&mut self, joint: usize, load: &revolute::Load<R>) {
        match joint {
            0 => self.crank += load.force,
            1 => {
                self.crank_pin += load.force;
                self.big_end -= load.force;
            }
            _ => {
                self.pin += load.force;
                self.small_end -= load.force;
            }
        }
        self.add_couples(joint, load.journal_couple, load.bearing_couple);
        self.bristle_rate.revolute[joint] = load.bristle_rate;
    }

    /// Adds couples on the journal and the bearing of joint A, B or C (0, 1, 2).
    #[inline(always)]
    pub fn add_couples(&mut self, joint: usize, journal: R, bearing: R) {
        match joint {
            0 => self.crank_couple += journal,
            1 => {
                self.crank_couple += journal;
                self.end_couple[0] += bearing;
            }
            _ => {
                self.slider_couple += journal;
                self.end_couple[1] += bearing;
            }
        }
    }

    /// [N·m] On crank, rod and slider.
    #[inline(always)]
    pub fn couples(&self) -> [R; 3] {
        [self.crank_couple, self.end_couple[0] + self.end_couple[1], self.slider_couple]
    }

    /// Adds forces and moment of the guide.
    #[inline(always)]
    pub fn add_guide(&mut self, load: &guide::Load<R>) {
        self.pin += load.force;
        self.slider_couple += load.couple;
        self.guide.force += load.force;
        self.guide.couple += load.couple;
    }
}

/// Accelerations of the roots and of the three angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accelerations<R = f64> {
    /// [m/s²]
    pub roots: Roots<R>,
    /// [rad/s²] Of crank, rod and slider.
    pub angle: [R; 3],
}

/// Index of a pair of angles in [`ChainInertia`]'s arrays.
const PAIRS: [(usize, usize); 3] = [(CRANK, ROD), (ROD, SLIDER), (CRANK, SLIDER)];

/// Solves the equations of motion of an open mechanism.
#[inline(always)]
pub fn accelerate<R: Real>(
    topology: Topology,
    bodies: &Bodies,
    chains: &ChainInertia,
    gravity: f64,
    turning: &Turning<R>,
    loads: &Loads<R>,
) -> Accelerations<R> {
    let Topology { a, b, c, t, speed } = topology;
    let rotation = &turning.rotation;
    let crank_length = rotation[CRANK].axis(bodies[CRANK].length);
    let rod_length = rotation[ROD].axis(bodies[ROD].length);
    let square = turning.speed.map(|speed| speed * speed);
    let mut q = loads.couples();
    let mut result = Accelerations::default();
    let fall = Vec2::constant(Vec2::new(0.0, -gravity));

    // Generalized forces: each chain handed down from its end to its root.
    let rail_rod = c && t;
    let rail_crank = b && c && t;
    let mut on_rail = loads.pin;
    if rail_rod {
        let mut on_big_end = loads.big_end;
        if rail_crank {
            q[CRANK] -= cross(crank_length, loads.crank);
            on_big_end = loads.crank;
        }
        q[ROD] -= cross(rod_length, on_big_end);
        on_rail += on_big_end;
    } else {
        let on_small_end = if c { loads.pin } else { loads.small_end };
        q[ROD] += cross(rod_length, on_small_end);
        let mut on_rod = on_small_end;
        if !b {
            on_rod += loads.big_end;
            let total = on_rod;
            q[ROD] += cross(rotation[ROD].apply(chains.anchor[ROD]), total);
            if c {
                q[SLIDER] += cross(rotation[SLIDER].apply(chains.anchor[SLIDER]), total);
            }
            result.roots.rod = total.times_plus(chains.per_mass[ROD], fall);
        }
        if !c && !t {
            q[SLIDER] += cross(rotation[SLIDER].apply(chains.anchor[SLIDER]), loads.pin);
            result.roots.slider = loads.pin.times_plus(chains.per_mass[SLIDER], fall);
        }
        let on_crank_pin = if b { on_rod } else { loads.crank_pin };
        if !a || !speed {
            q[CRANK] += cross(crank_length, on_crank_pin);
        }
        if !a {
            let total = on_crank_pin + loads.crank;
            q[CRANK] += cross(rotation[CRANK].apply(chains.anchor[CRANK]), total);
            if b {
                q[ROD] += cross(rotation[ROD].apply(chains.anchor[ROD]), total);
            }
            if b && c {
                q[SLIDER] += cross(rotation[SLIDER].apply(chains.anchor[SLIDER]), total);
            }
            result.roots.crank = total.times_plus(chains.per_mass[CRANK], fall);
        }
    }
    if rail_rod && !b {
        // The crank alone.
        q[CRANK] += cross(crank_length, loads.crank_pin);
        if !a {
            let total = loads.crank_pin + loads.crank;
            q[CRANK] += cross(rotation[CRANK].apply(chains.anchor[CRANK]), total);
            result.roots.crank = total.times_plus(chains.per_mass[CRANK], fall);
        }
    }

    // Elements of the mass matrix and the centrifugal terms, which are known before the forces are.
    let linked = [b, c && !t, b && c && !t];
    let mut m = [R::ZERO; 3];
    let mut early = [R::ZERO; 3];
    each!(true, pair < 3 => {
        if linked[pair] {
            let (k, l) = PAIRS[pair];
            let cos = rotation[k].cos.times_plus(rotation[l].cos, rotation[k].sin * rotation[l].sin);
            let sin = rotation[l].sin.times_plus(rotation[k].cos, -(rotation[l].cos * rotation[k].sin));
            m[pair] = cos.times_plus(chains.cos[pair], sin * chains.sin[pair]);
            let centrifugal = sin.times_plus(chains.cos[pair], -(cos * chains.sin[pair]));
            early[k] = centrifugal.times_plus(square[l], early[k]);
            early[l] = (-centrifugal).times_plus(square[k], early[l]);
        }
    });
    let mut d = chains.diagonal.map(R::constant);

    // Gravity on the chains that do not float, and the coupling with the pin on an ideal guide.
    let rooted = [a || rail_crank, (b && a) || rail_rod, b && c && a && !t];
    let mut first_moment = [Vec2::<R>::ZERO; 3];
    each!(true, k < 3 => {
        if rooted[k] {
            first_moment[k] = rotation[k].apply(chains.moment[k]);
            early[k] = first_moment[k].x.times_plus(-gravity, early[k]);
        }
        q[k] += early[k];
    });
    let per_mass = chains.per_mass[SLIDER];
    let mut along = on_rail.x;
    if t {
        for (k, on) in [(CRANK, rail_crank), (ROD, rail_rod)] {
            if on {
                along = square[k].times_plus(first_moment[k].x, along);
            }
        }
    }
    if rail_rod {
        q[ROD] += first_moment[ROD].y * along * per_mass;
        d[ROD] -= first_moment[ROD].y * first_moment[ROD].y * per_mass;
    }
    if rail_crank {
        q[CRANK] += first_moment[CRANK].y * along * per_mass;
        d[CRANK] -= first_moment[CRANK].y * first_moment[CRANK].y * per_mass;
        m[0] -= first_moment[CRANK].y * first_moment[ROD].y * per_mass;
    }

    result.angle = solve(topology, &d, &m, &q);
    if t {
        for (k, on) in [(CRANK, rail_crank), (ROD, rail_rod)] {
            if on {
                along += first_moment[k].y * result.angle[k];
            }
        }
        result.roots.slider = Vec2::new(along * per_mass, R::ZERO);
    }
    result
}

/// Angular accelerations from the diagonal `d`, the pairs' elements `m` and the right sides `q`, which are known last:
/// what is divided by is inverted while forces are computed.
#[inline(always)]
fn solve<R: Real>(topology: Topology, d: &[R; 3], m: &[R; 3], q: &[R; 3]) -> [R; 3] {
    let Topology { b, c, t, speed, .. } = topology;
    let with_crank = b && !speed;
    let with_slider = c && !t;
    let mut angle = [R::ZERO; 3];
    match (with_crank, with_slider) {
        (true, true) => angle = solve_three(d, m, q),
        (true, false) => {
            [angle[CRANK], angle[ROD]] = solve_two([d[CRANK], d[ROD]], m[0], [q[CRANK], q[ROD]]);
        }
        (false, true) => {
            [angle[ROD], angle[SLIDER]] = solve_two([d[ROD], d[SLIDER]], m[1], [q[ROD], q[SLIDER]]);
        }
        (false, false) => angle[ROD] = q[ROD] * d[ROD].recip(),
    }
    if !b && !speed {
        angle[CRANK] = q[CRANK] * d[CRANK].recip();
    }
    if !c && !t {
        angle[SLIDER] = q[SLIDER] * d[SLIDER].recip();
    }
    angle
}

#[inline(always)]
fn solve_two<R: Real>(d: [R; 2], m: R, q: [R; 2]) -> [R; 2] {
    let per_determinant = d[0].times_plus(d[1], -(m * m)).recip();
    [q[0].times_plus(d[1], -(m * q[1])) * per_determinant, q[1].times_plus(d[0], -(m * q[0])) * per_determinant]
}

/// By L·D·Lᵀ without pivoting: a mass matrix is positive definite.
#[inline(always)]
fn solve_three<R: Real>(d: &[R; 3], m: &[R; 3], q: &[R; 3]) -> [R; 3] {
    let [crank_rod, rod_slider, crank_slider] = *m;
    let per_first = d[0].recip();
    let (l1, l2) = (crank_rod * per_first, crank_slider * per_first);
    let (per_rod, per_slider) = (-l1, -l2);
    let d1 = per_rod.times_plus(crank_rod, d[1]);
    let off = per_rod.times_plus(crank_slider, rod_slider);
    let q1 = per_rod.times_plus(q[0], q[1]);
    let d2 = per_slider.times_plus(crank_slider, d[2]);
    let [rod, slider] = solve_two([d1, d2], off, [q1, per_slider.times_plus(q[0], q[2])]);
    let first = (-crank_rod).times_plus(rod, q[0]);
    [(-crank_slider).times_plus(slider, first) * per_first, rod, slider]
}
