//! M(q)·q̈ = Q of a mechanism with a flexible rod: summed body by body over the coordinates of the
//! configuration, M_x = Σ JᵀM_bJ, then spread over the modes.

#![allow(clippy::needless_range_loop)] // triangles are read by their indices

use super::configuration::{Centre, Configuration, Heading, PLACES};
use crate::math::Real;
use crate::model::dynamics::Loads;
use crate::model::mechanism::{Bodies, Body, CRANK, ROD, SLIDER};
use crate::model::plane::{Vec2, cross, perp};
use crate::model::reactions::Demand;
use crate::model::rod::{Inertia, Rod};
use std::ops::Range;

/// Mass matrix (lower triangle) and right side over x, the configuration's coordinates.
pub struct Places<R> {
    /// How many: the rigid coordinates and the chord's length.
    size: usize,
    matrix: [[R; PLACES]; PLACES],
    right: [R; PLACES],
}

impl<R: Real> Places<R> {
    /// Of `rigid` rigid coordinates, with nothing in them.
    #[inline(always)]
    pub fn new(rigid: usize) -> Self {
        Self { size: rigid + 1, matrix: [[R::ZERO; PLACES]; PLACES], right: [R::ZERO; PLACES] }
    }

    /// Adds `force` [N] at a joint centre.
    #[inline(always)]
    fn push(&mut self, centre: &Centre<R>, force: Vec2<R>) {
        for (right, slope) in self.right[..self.size].iter_mut().zip(&centre.slope) {
            *right += slope.dot(force);
        }
    }

    /// Adds `couple` [N·m] on a body.
    #[inline(always)]
    fn twist(&mut self, heading: &Heading<R>, couple: R) {
        for (right, slope) in self.right[..self.size].iter_mut().zip(&heading.slope) {
            *right += *slope * couple;
        }
    }

    /// Adds a rigid body whose reference point is `centre`.
    #[inline(always)]
    fn add_body(&mut self, body: &Body, heading: &Heading<R>, centre: &Centre<R>, gravity: f64) {
        let com = centre.carried(heading, body.com);
        for i in 0..self.size {
            let (push, twist) = (com.slope[i] * body.mass, heading.slope[i] * body.inertia);
            for j in 0..=i {
                self.matrix[i][j] += push.dot(com.slope[j]) + twist * heading.slope[j];
            }
        }
        self.push(&com, (com.bias + Vec2::new(0.0, gravity)) * -body.mass);
        self.twist(heading, heading.bias * -body.inertia);
    }

    /// Adds forces and couples on crank and slider, with their inertia.
    #[inline(always)]
    pub fn add_rigid_bodies<const K: usize, const F: usize>(
        &mut self,
        bodies: &Bodies,
        configuration: &Configuration<R, K, F>,
        loads: &Loads<R>,
        gravity: f64,
    ) {
        let Configuration { heading, crank, crank_pin, pin, .. } = configuration;
        self.add_body(&bodies[CRANK], &heading[CRANK], crank, gravity);
        self.add_body(&bodies[SLIDER], &heading[SLIDER], pin, gravity);
        self.push(crank, loads.crank);
        self.push(crank_pin, loads.crank_pin);
        self.push(pin, loads.pin);
        self.twist(&heading[CRANK], loads.crank_couple);
        self.twist(&heading[SLIDER], loads.slider_couple);
    }
}

/// Mass matrix (lower triangle) and right side over all coordinates.
pub struct Equations<R, const Q: usize> {
    size: usize,
    matrix: [[R; Q]; Q],
    right: [R; Q],
}

impl<R: Real, const Q: usize> Equations<R, Q> {
    /// Adds the rod to the other bodies' equations: its inertia and, at its ends and on its modes, its
    /// loads.
    #[inline(always)]
    pub fn new<const K: usize, const F: usize>(
        mut places: Places<R>,
        rod: &Moving<'_, R, K, F>,
        loads: &Loads<R>,
        gravity: f64,
        modal_force: &[R; K],
    ) -> Self {
        let Moving { rod: beam, inertia, configuration, modes } = rod;
        let Configuration { heading, big_end, small_end, shape, .. } = configuration;
        let heading = &heading[ROD];
        let (rigid, n) = (modes.start, modes.len());
        let first = heading.rotation.apply(inertia.first);
        let lever = perp(first);
        let m = beam.mass();
        for i in 0..=rigid {
            let (slope, turn) = (big_end.slope[i], heading.slope[i]);
            let push = slope * m + turn * lever;
            let twist = lever.dot(slope) + inertia.about_origin * turn;
            for j in 0..=i {
                places.matrix[i][j] += push.dot(big_end.slope[j]) + twist * heading.slope[j];
            }
        }
        // Right side: loads less what the biases ask for.
        let bias = big_end.bias + Vec2::new(0.0, gravity);
        let asked = bias * m + heading.bias * lever + heading.rotation.apply(inertia.force);
        let couple = cross(first, bias) + inertia.about_origin * heading.bias + inertia.couple;
        places.push(big_end, loads.big_end - asked);
        places.push(small_end, loads.small_end);
        places.twist(heading, loads.end_couple[0] + loads.end_couple[1] - couple);

        let mut all = Self { size: modes.end, matrix: [[R::ZERO; Q]; Q], right: [R::ZERO; Q] };
        for i in 0..rigid {
            all.matrix[i][..=i].copy_from_slice(&places.matrix[i][..=i]);
        }
        all.right[..rigid].copy_from_slice(&places.right[..rigid]);
        // A mode turns and shifts the rod's mass in its frame, and moves the frame through the chord.
        let of_chord = &places.matrix[rigid];
        let mut by_chord = [R::ZERO; K];
        for a in 0..n {
            let (slope, turning) = (heading.rotation.apply(inertia.first_slope[a]), inertia.turning[a]);
            let with = |i: usize| slope.dot(big_end.slope[i]) + turning * heading.slope[i];
            let chord = shape.chord_slope[a];
            let row = &mut all.matrix[rigid + a];
            for i in 0..rigid {
                row[i] = chord * of_chord[i] + with(i);
            }
            by_chord[a] = with(rigid);
            for b in 0..=a {
                let other = shape.chord_slope[b];
                row[rigid + b] =
                    inertia.modal[a][b] + chord * other * of_chord[rigid] + chord * by_chord[b] + other * by_chord[a];
            }
            all.right[rigid + a] = chord * places.right[rigid] + modal_force[a]
                - slope.dot(bias)
                - turning * heading.bias
                - inertia.modal_force[a];
        }
        all
    }

    /// Accelerations of the coordinates, by L·D·Lᵀ: the matrix is positive definite.
    #[inline(always)]
    pub fn solve(mut self) -> [R; Q] {
        let Self { size, matrix, right: x } = &mut self;
        let mut per = [R::ZERO; Q];
        // Each pivot's column is taken out of the rows below it, and kept.
        for j in 0..*size {
            let (above, below) = matrix[..*size].split_at_mut(j + 1);
            per[j] = above[j][j].recip();
            let mut column = [R::ZERO; Q];
            for (row, kept) in below.iter().zip(&mut column) {
                *kept = row[j];
            }
            for (i, row) in below.iter_mut().enumerate() {
                let l = row[j] * per[j];
                for (element, kept) in row[j + 1..].iter_mut().zip(&column[..=i]) {
                    *element -= l * *kept;
                }
                row[j] = l;
                let taken = l * x[j];
                x[j + 1 + i] -= taken;
            }
        }
        for i in (0..*size).rev() {
            x[i] = x[i] * per[i];
            for k in i + 1..*size {
                let taken = matrix[k][i] * x[k];
                x[i] -= taken;
            }
        }
        *x
    }
}

/// The rod in motion.
pub struct Moving<'a, R, const K: usize, const F: usize> {
    /// Its modes.
    pub rod: &'a Rod,
    /// Its inertia.
    pub inertia: &'a Inertia<R, K>,
    /// Where it is.
    pub configuration: &'a Configuration<R, K, F>,
    /// Where its modal coordinates stand.
    pub modes: Range<usize>,
}

impl<R: Real, const K: usize, const F: usize> Moving<'_, R, K, F> {
    /// [J] Kinetic energy at the modal `rate` [m/s].
    pub fn kinetic(&self, rate: &[R]) -> R {
        let Self { rod, inertia, configuration, .. } = self;
        let heading = &configuration.heading[ROD];
        let (velocity, speed) = (configuration.big_end.velocity, heading.speed);
        let mut opening = Vec2::<R>::ZERO;
        let (mut turning, mut modal) = (R::ZERO, R::ZERO);
        for (a, &rate_a) in rate.iter().enumerate() {
            opening += rate_a * inertia.first_slope[a];
            turning += rate_a * inertia.turning[a];
            let with = inertia.modal[a].iter().zip(rate).take(a);
            let row = with.fold(R::ZERO, |sum, (m, rate)| sum + *m * *rate);
            modal += rate_a * (row * 2.0 + inertia.modal[a][a] * rate_a);
        }
        let first_rate = speed * perp(heading.rotation.apply(inertia.first)) + heading.rotation.apply(opening);
        velocity.norm_squared() * (0.5 * rod.mass())
            + velocity.dot(first_rate)
            + inertia.about_origin * 0.5 * speed * speed
            + speed * turning
            + modal * 0.5
    }

    /// [kg·m] ∫y dm.
    pub fn mass_height(&self) -> R {
        let Self { rod, inertia, configuration, .. } = self;
        configuration.big_end.place.y * rod.mass() + configuration.heading[ROD].rotation.apply(inertia.first).y
    }

    /// What the rod's motion needs of forces and of moments about its big end, gravity subtracted, at the
    /// accelerations `places` of the configuration's coordinates and `forced` of all.
    pub fn demand(&self, places: &[R; PLACES], forced: &[R], gravity: f64) -> Demand<R> {
        let Self { rod, inertia, configuration, modes } = self;
        let heading = &configuration.heading[ROD];
        let origin = configuration.big_end.acceleration(places) + Vec2::new(0.0, gravity);
        let turning = heading.acceleration(places);
        let first = heading.rotation.apply(inertia.first);
        let mut force = origin * rod.mass() + turning * perp(first) + heading.rotation.apply(inertia.force);
        let mut moment = cross(first, origin) + inertia.about_origin * turning + inertia.couple;
        for (a, i) in modes.clone().enumerate() {
            force += forced[i] * heading.rotation.apply(inertia.first_slope[a]);
            moment += forced[i] * inertia.turning[a];
        }
        Demand { force, moment }
    }
}
