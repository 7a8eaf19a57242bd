//! M(q)·q̈ = Q of a mechanism with a flexible rod: summed body by body over the coordinates of the
//! configuration, M_x = Σ JᵀM_bJ, then spread over the modes.

#![allow(clippy::needless_range_loop)] // triangles are read by their indices

use super::configuration::{Centre, Configuration, Heading, PLACES};
use crate::model::dynamics::Loads;
use crate::model::mechanism::{Bodies, Body, CRANK, ROD, SLIDER};
use crate::model::plane::{Vec2, cross, perp};
use crate::model::reactions::Demand;
use crate::model::rod::{Inertia, Rod};
use std::ops::Range;

/// Mass matrix (lower triangle) and right side over x, the configuration's coordinates.
pub struct Places {
    /// How many: the rigid coordinates and the chord's length.
    size: usize,
    matrix: [[f64; PLACES]; PLACES],
    right: [f64; PLACES],
}

impl Places {
    /// Of `rigid` rigid coordinates, with nothing in them.
    #[inline(always)]
    pub fn new(rigid: usize) -> Self {
        Self { size: rigid + 1, matrix: [[0.0; PLACES]; PLACES], right: [0.0; PLACES] }
    }

    /// Adds `force` [N] at a joint centre.
    #[inline(always)]
    fn push(&mut self, centre: &Centre, force: Vec2) {
        for (right, slope) in self.right[..self.size].iter_mut().zip(&centre.slope) {
            *right += slope.dot(&force);
        }
    }

    /// Adds `couple` [N·m] on a body.
    #[inline(always)]
    fn twist(&mut self, heading: &Heading, couple: f64) {
        for (right, slope) in self.right[..self.size].iter_mut().zip(&heading.slope) {
            *right += slope * couple;
        }
    }

    /// Adds a rigid body whose reference point is `centre`.
    #[inline(always)]
    fn add_body(&mut self, body: &Body, heading: &Heading, centre: &Centre, gravity: f64) {
        let com = centre.carried(heading, body.com);
        for i in 0..self.size {
            let (push, twist) = (body.mass * com.slope[i], body.inertia * heading.slope[i]);
            for j in 0..=i {
                self.matrix[i][j] += push.dot(&com.slope[j]) + twist * heading.slope[j];
            }
        }
        self.push(&com, -body.mass * (com.bias + Vec2::new(0.0, gravity)));
        self.twist(heading, -body.inertia * heading.bias);
    }

    /// Adds forces and couples on crank and slider, with their inertia.
    #[inline(always)]
    pub fn add_rigid_bodies<const K: usize, const F: usize>(
        &mut self,
        bodies: &Bodies,
        configuration: &Configuration<K, F>,
        loads: &Loads,
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
pub struct Equations<const Q: usize> {
    size: usize,
    matrix: [[f64; Q]; Q],
    right: [f64; Q],
}

impl<const Q: usize> Equations<Q> {
    /// Adds the rod to the other bodies' equations: its inertia and, at its ends and on its modes, its
    /// loads.
    #[inline(always)]
    pub fn new<const K: usize, const F: usize>(
        mut places: Places,
        rod: &Moving<'_, K, F>,
        loads: &Loads,
        gravity: f64,
        modal_force: &[f64; K],
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
            let push = m * slope + turn * lever;
            let twist = lever.dot(&slope) + inertia.about_origin * turn;
            for j in 0..=i {
                places.matrix[i][j] += push.dot(&big_end.slope[j]) + twist * heading.slope[j];
            }
        }
        // Right side: loads less what the biases ask for.
        let bias = big_end.bias + Vec2::new(0.0, gravity);
        let asked = m * bias + heading.bias * lever + heading.rotation.apply(inertia.force);
        let couple = cross(first, bias) + inertia.about_origin * heading.bias + inertia.couple;
        places.push(big_end, loads.big_end - asked);
        places.push(small_end, loads.small_end);
        places.twist(heading, loads.end_couple[0] + loads.end_couple[1] - couple);

        let mut all = Self { size: modes.end, matrix: [[0.0; Q]; Q], right: [0.0; Q] };
        for i in 0..rigid {
            all.matrix[i][..=i].copy_from_slice(&places.matrix[i][..=i]);
        }
        all.right[..rigid].copy_from_slice(&places.right[..rigid]);
        // A mode turns and shifts the rod's mass in its frame, and moves the frame through the chord.
        let of_chord = &places.matrix[rigid];
        let mut by_chord = [0.0; K];
        for a in 0..n {
            let (slope, turning) = (heading.rotation.apply(inertia.first_slope[a]), inertia.turning[a]);
            let with = |i: usize| slope.dot(&big_end.slope[i]) + turning * heading.slope[i];
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
                - slope.dot(&bias)
                - turning * heading.bias
                - inertia.modal_force[a];
        }
        all
    }

    /// Accelerations of the coordinates, by L·D·Lᵀ: the matrix is positive definite.
    #[inline(always)]
    pub fn solve(&mut self) -> [f64; Q] {
        let n = self.size;
        let mut per = [0.0; Q];
        for j in 0..n {
            // Rows below: l_ij·d_j stays in the matrix until column j is done.
            let mut d = self.matrix[j][j];
            for k in 0..j {
                d -= self.matrix[j][k] * self.matrix[j][k] * per[k];
            }
            per[j] = 1.0 / d;
            for i in j + 1..n {
                let mut element = self.matrix[i][j];
                for k in 0..j {
                    element -= self.matrix[i][k] * self.matrix[j][k] * per[k];
                }
                self.matrix[i][j] = element;
            }
        }
        let mut x = self.right;
        for i in 0..n {
            for k in 0..i {
                x[i] -= self.matrix[i][k] * per[k] * x[k];
            }
        }
        for i in (0..n).rev() {
            x[i] *= per[i];
            for k in i + 1..n {
                x[i] -= self.matrix[k][i] * per[i] * x[k];
            }
        }
        x
    }
}

/// The rod in motion.
pub struct Moving<'a, const K: usize, const F: usize> {
    /// Its modes.
    pub rod: &'a Rod,
    /// Its inertia.
    pub inertia: &'a Inertia<K>,
    /// Where it is.
    pub configuration: &'a Configuration<K, F>,
    /// Where its modal coordinates stand.
    pub modes: Range<usize>,
}

impl<const K: usize, const F: usize> Moving<'_, K, F> {
    /// [J] Kinetic energy at the modal `rate` [m/s].
    pub fn kinetic(&self, rate: &[f64]) -> f64 {
        let Self { rod, inertia, configuration, .. } = self;
        let heading = &configuration.heading[ROD];
        let (velocity, speed) = (configuration.big_end.velocity, heading.speed);
        let mut opening = Vec2::zeros();
        let (mut turning, mut modal) = (0.0, 0.0);
        for (a, rate_a) in rate.iter().enumerate() {
            opening += *rate_a * inertia.first_slope[a];
            turning += rate_a * inertia.turning[a];
            let row = inertia.modal[a].iter().zip(rate).take(a).map(|(m, rate)| m * rate).sum::<f64>();
            modal += rate_a * (2.0 * row + inertia.modal[a][a] * rate_a);
        }
        let first_rate = speed * perp(heading.rotation.apply(inertia.first)) + heading.rotation.apply(opening);
        0.5 * rod.mass() * velocity.norm_squared()
            + velocity.dot(&first_rate)
            + 0.5 * inertia.about_origin * speed * speed
            + speed * turning
            + 0.5 * modal
    }

    /// [kg·m] ∫y dm.
    pub fn mass_height(&self) -> f64 {
        let Self { rod, inertia, configuration, .. } = self;
        rod.mass() * configuration.big_end.place.y + configuration.heading[ROD].rotation.apply(inertia.first).y
    }

    /// What the rod's motion needs of forces and of moments about its big end, gravity subtracted, at the
    /// accelerations `places` of the configuration's coordinates and `forced` of all.
    pub fn demand(&self, places: &[f64; PLACES], forced: &[f64], gravity: f64) -> Demand {
        let Self { rod, inertia, configuration, modes } = self;
        let heading = &configuration.heading[ROD];
        let origin = configuration.big_end.acceleration(places) + Vec2::new(0.0, gravity);
        let turning = heading.acceleration(places);
        let first = heading.rotation.apply(inertia.first);
        let mut force = rod.mass() * origin + turning * perp(first) + heading.rotation.apply(inertia.force);
        let mut moment = cross(first, origin) + inertia.about_origin * turning + inertia.couple;
        for (a, i) in modes.clone().enumerate() {
            force += forced[i] * heading.rotation.apply(inertia.first_slope[a]);
            moment += forced[i] * inertia.turning[a];
        }
        Demand { force, moment }
    }
}
