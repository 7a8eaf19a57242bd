//! M(q)·q̈ = Q of a mechanism with a flexible rod, summed body by body through the slopes of its
//! configuration: M = Σ JᵀM_bJ.

#![allow(clippy::needless_range_loop)] // triangles are read by their indices

use super::configuration::{Centre, Configuration, Heading};
use crate::model::dynamics::Loads;
use crate::model::mechanism::{Bodies, Body, CRANK, ROD, SLIDER};
use crate::model::plane::{Vec2, cross, perp};
use crate::model::reactions::Demand;
use crate::model::rod::{Inertia, Rod};
use std::ops::Range;

/// Mass matrix (lower triangle) and right side.
pub struct Equations<const Q: usize> {
    size: usize,
    matrix: [[f64; Q]; Q],
    right: [f64; Q],
}

impl<const Q: usize> Equations<Q> {
    /// Of `size` coordinates, with nothing in them.
    pub fn new(size: usize) -> Self {
        Self { size, matrix: [[0.0; Q]; Q], right: [0.0; Q] }
    }

    /// Adds `force` [N] at a joint centre.
    pub fn push(&mut self, centre: &Centre<Q>, force: Vec2) {
        for k in 0..self.size {
            self.right[k] += centre.slope[0][k] * force.x + centre.slope[1][k] * force.y;
        }
    }

    /// Adds `couple` [N·m] on a body.
    pub fn twist(&mut self, heading: &Heading<Q>, couple: f64) {
        for k in 0..self.size {
            self.right[k] += heading.slope[k] * couple;
        }
    }

    fn add_product(&mut self, factor: f64, row: &[f64; Q]) {
        for i in 0..self.size {
            if row[i] != 0.0 {
                let scaled = factor * row[i];
                for j in 0..=i {
                    self.matrix[i][j] += scaled * row[j];
                }
            }
        }
    }

    /// Adds a rigid body whose reference point is `centre`.
    pub fn add_body(&mut self, body: &Body, heading: &Heading<Q>, centre: &Centre<Q>, gravity: f64) {
        let com = centre.carried(heading, body.com);
        self.add_product(body.mass, &com.slope[0]);
        self.add_product(body.mass, &com.slope[1]);
        self.add_product(body.inertia, &heading.slope);
        self.push(&com, -body.mass * (com.bias + Vec2::new(0.0, gravity)));
        self.twist(heading, -body.inertia * heading.bias);
    }

    /// Adds the rod: its inertia and, at its ends and on its modes, its loads.
    pub fn add_rod<const K: usize, const F: usize>(
        &mut self,
        rod: &Moving<'_, Q, K, F>,
        loads: &Loads,
        gravity: f64,
        modal_force: &[f64; K],
    ) {
        let Moving { rod: shape, inertia, configuration, modes } = rod;
        let Configuration { heading, big_end, small_end, .. } = configuration;
        let heading = &heading[ROD];
        let n = modes.len();
        let rows = [&big_end.slope[0], &big_end.slope[1], &heading.slope];
        let first = heading.rotation.apply(inertia.first);
        let lever = perp(first);
        let m = shape.mass();
        let block = [[m, 0.0, lever.x], [0.0, m, lever.y], [lever.x, lever.y, inertia.about_origin]];
        let mut with_modes = [[0.0; K]; 3];
        for a in 0..n {
            let slope = heading.rotation.apply(inertia.first_slope[a]);
            (with_modes[0][a], with_modes[1][a], with_modes[2][a]) = (slope.x, slope.y, inertia.turning[a]);
        }
        // T = (rows of M_b for the frame)·J.
        let mut t = [[0.0; Q]; 3];
        for r in 0..3 {
            for j in 0..self.size {
                t[r][j] = block[r][0] * rows[0][j] + block[r][1] * rows[1][j] + block[r][2] * rows[2][j];
            }
            for (a, j) in modes.clone().enumerate() {
                t[r][j] += with_modes[r][a];
            }
        }
        for i in 0..self.size {
            for j in 0..=i {
                self.matrix[i][j] += rows[0][i] * t[0][j] + rows[1][i] * t[1][j] + rows[2][i] * t[2][j];
            }
        }
        for (a, i) in modes.clone().enumerate() {
            for j in 0..=i {
                self.matrix[i][j] +=
                    with_modes[0][a] * rows[0][j] + with_modes[1][a] * rows[1][j] + with_modes[2][a] * rows[2][j];
            }
            for b in 0..=a {
                self.matrix[i][modes.start + b] += inertia.modal[a][b];
            }
        }
        // Right side: loads less what the biases ask for.
        let bias = big_end.bias + Vec2::new(0.0, gravity);
        let asked = m * bias + heading.bias * lever + heading.rotation.apply(inertia.force);
        let couple = cross(first, bias) + inertia.about_origin * heading.bias + inertia.couple;
        self.push(big_end, loads.big_end - asked);
        self.push(small_end, loads.small_end);
        self.twist(heading, loads.end_couple[0] + loads.end_couple[1] - couple);
        for (a, i) in modes.clone().enumerate() {
            let asked = with_modes[0][a] * bias.x + with_modes[1][a] * bias.y + with_modes[2][a] * heading.bias;
            self.right[i] += modal_force[a] - asked - inertia.modal_force[a];
        }
    }

    /// Accelerations of the coordinates, by L·D·Lᵀ: the matrix is positive definite.
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
pub struct Moving<'a, const Q: usize, const K: usize, const F: usize> {
    /// Its modes.
    pub rod: &'a Rod,
    /// Its inertia.
    pub inertia: &'a Inertia<K>,
    /// Where it is.
    pub configuration: &'a Configuration<Q, K, F>,
    /// Where its modal coordinates stand.
    pub modes: Range<usize>,
}

impl<const Q: usize, const K: usize, const F: usize> Moving<'_, Q, K, F> {
    /// [J] Kinetic energy at the modal `rate` [m/s].
    pub fn kinetic(&self, rate: &[f64]) -> f64 {
        let Self { rod, inertia, configuration, .. } = self;
        let heading = &configuration.heading[ROD];
        let (velocity, speed) = (configuration.big_end.velocity, heading.speed);
        let mut opening = Vec2::<f64>::ZERO;
        let (mut turning, mut modal) = (0.0, 0.0);
        for (a, rate_a) in rate.iter().enumerate() {
            opening += *rate_a * inertia.first_slope[a];
            turning += rate_a * inertia.turning[a];
            modal += rate_a * inertia.modal[a].iter().zip(rate).map(|(m, rate)| m * rate).sum::<f64>();
        }
        let first_rate = speed * perp(heading.rotation.apply(inertia.first)) + heading.rotation.apply(opening);
        0.5 * rod.mass() * velocity.norm_squared()
            + velocity.dot(first_rate)
            + 0.5 * inertia.about_origin * speed * speed
            + speed * turning
            + 0.5 * modal
    }

    /// [kg·m] ∫y dm.
    pub fn mass_height(&self) -> f64 {
        let Self { rod, inertia, configuration, .. } = self;
        rod.mass() * configuration.big_end.place.y + configuration.heading[ROD].rotation.apply(inertia.first).y
    }

    /// What the rod's motion needs of forces and of moments about its big end, gravity subtracted.
    pub fn demand(&self, forced: &[f64; Q], gravity: f64) -> Demand {
        let Self { rod, inertia, configuration, modes } = self;
        let heading = &configuration.heading[ROD];
        let origin = configuration.big_end.acceleration(forced) + Vec2::new(0.0, gravity);
        let turning = heading.acceleration(forced);
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

/// Forces and couples on crank and slider, with their inertia.
pub fn add_rigid_bodies<const Q: usize, const K: usize, const F: usize>(
    equations: &mut Equations<Q>,
    bodies: &Bodies,
    configuration: &Configuration<Q, K, F>,
    loads: &Loads,
    gravity: f64,
) {
    let Configuration { heading, crank, crank_pin, pin, .. } = configuration;
    equations.add_body(&bodies[CRANK], &heading[CRANK], crank, gravity);
    equations.add_body(&bodies[SLIDER], &heading[SLIDER], pin, gravity);
    equations.push(crank, loads.crank);
    equations.push(crank_pin, loads.crank_pin);
    equations.push(pin, loads.pin);
    equations.twist(&heading[CRANK], loads.crank_couple);
    equations.twist(&heading[SLIDER], loads.slider_couple);
}
