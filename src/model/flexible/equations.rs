//! M(q)·q̈ = Q of a mechanism with a flexible rod: summed body by body over the coordinates of the
//! configuration, M_x = Σ JᵀM_bJ, then spread over the modes.

#![allow(clippy::needless_range_loop)] // triangles are read by their indices

use super::configuration::{Centre, Configuration, Heading};
use crate::math::Real;
use crate::model::dynamics::Loads;
use crate::model::joint::{Kernel, Kernels};
use crate::model::mechanism::{Bodies, Body, CRANK, ROD, SLIDER, Topology};
use crate::model::plane::{Vec2, cross, perp};
use crate::model::reactions::Demand;
use crate::model::rod::{Inertia, Rod, Shape};
use std::ops::Range;

/// Mass matrix (lower triangle) and right side over x, the configuration's coordinates.
pub struct Places<R, const P: usize> {
    /// How many: the rigid coordinates and the chord's length.
    size: usize,
    matrix: [[R; P]; P],
    right: [R; P],
}

impl<R: Real, const P: usize> Places<R, P> {
    /// Of so many coordinates, with nothing in them.
    #[inline(always)]
    pub fn new(size: usize) -> Self {
        Self { size, matrix: [[R::ZERO; P]; P], right: [R::ZERO; P] }
    }

    /// Adds `force` [N] at a joint centre.
    #[inline(always)]
    fn push(&mut self, centre: &Centre<R, P>, force: Vec2<R>) {
        for (right, slope) in self.right[..self.size].iter_mut().zip(&centre.slope) {
            *right += slope.dot(force);
        }
    }

    /// Adds `couple` [N·m] on a body.
    #[inline(always)]
    fn twist(&mut self, heading: &Heading<R, P>, couple: R) {
        for (right, slope) in self.right[..self.size].iter_mut().zip(&heading.slope) {
            *right += *slope * couple;
        }
    }

    /// Adds a rigid body whose reference point is `centre`.
    #[inline(always)]
    fn add_body(&mut self, body: &Body, heading: &Heading<R, P>, centre: &Centre<R, P>, gravity: f64) {
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

    /// Adds crank and slider as far as they are in the rod's chain: their inertia, forces and couples.
    #[inline(always)]
    pub fn add_rigid_bodies(
        &mut self,
        topology: Topology,
        bodies: &Bodies,
        configuration: &Configuration<R, P>,
        loads: &Loads<R>,
        gravity: f64,
    ) {
        let Configuration { heading, crank, crank_pin, pin, .. } = configuration;
        if topology.b {
            self.add_body(&bodies[CRANK], &heading[CRANK], crank, gravity);
            self.push(crank, loads.crank);
            self.push(crank_pin, loads.crank_pin);
            self.twist(&heading[CRANK], loads.crank_couple);
        }
        if topology.c {
            self.add_body(&bodies[SLIDER], &heading[SLIDER], pin, gravity);
            self.push(pin, loads.pin);
            self.twist(&heading[SLIDER], loads.slider_couple);
        }
    }
}

/// Mass matrix (lower triangle) and right side over the coordinates of the rod's chain and its modes.
pub struct Equations<R, const S: usize> {
    size: usize,
    matrix: [[R; S]; S],
    right: [R; S],
}

impl<R: Real, const S: usize> Equations<R, S> {
    /// Adds the rod to the other bodies' equations: its inertia and, at its ends and on its modes, its
    /// loads.
    #[inline(always)]
    pub fn new<const P: usize, const K: usize, const F: usize>(
        mut places: Places<R, P>,
        rod: &Moving<'_, R, P, K, F>,
        loads: &Loads<R>,
        gravity: f64,
        modal_force: &[R; K],
    ) -> Self {
        let Moving { rod: beam, shape, inertia, configuration, modes } = rod;
        let Configuration { heading, big_end, small_end, .. } = configuration;
        let heading = &heading[ROD];
        let (rigid, n) = (places.size - 1, modes.len());
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

        let mut all = Self { size: rigid + n, matrix: [[R::ZERO; S]; S], right: [R::ZERO; S] };
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
    pub fn solve(mut self, solver: Solver<R, S>) -> [R; S] {
        solver(&mut self);
        self.right
    }

    /// For any number of coordinates.
    fn solve_any(&mut self) {
        self.solve_in_place(self.size);
    }

    /// For `SIZE` of them.
    fn solve_sized<const SIZE: usize>(&mut self) {
        self.solve_in_place(SIZE);
    }

    #[inline(always)]
    fn solve_in_place(&mut self, size: usize) {
        let Self { matrix, right: x, .. } = self;
        let mut per = [R::ZERO; S];
        for j in 0..size {
            let (above, below) = matrix.split_at_mut(j);
            let row = &mut below[0];
            // Row j of L·D, in place.
            for k in 1..j {
                let mut element = row[k];
                for m in 0..k {
                    element -= row[m] * above[k][m];
                }
                row[k] = element;
            }
            let (mut pivot, mut right) = (row[j], x[j]);
            for k in 0..j {
                let l = row[k] * per[k];
                pivot -= l * row[k];
                right -= l * x[k];
                row[k] = l;
            }
            (per[j], x[j]) = (pivot.recip(), right);
        }
        for i in (0..size).rev() {
            let mut solved = x[i] * per[i];
            for k in i + 1..size {
                solved -= matrix[k][i] * x[k];
            }
            x[i] = solved;
        }
    }
}

/// Puts the solution in place of the right side.
pub type Solver<R, const S: usize> = fn(&mut Equations<R, S>);

/// Solvers as a kernel.
#[derive(Clone, Copy, Debug)]
pub struct Solvers<const S: usize>;

impl<const S: usize> Kernel for Solvers<S> {
    type Of<R: Real> = Solver<R, S>;
}

impl<const S: usize> Solvers<S> {
    /// Those for `size` coordinates, compiled for that many where they are few.
    pub fn of(size: usize) -> Kernels<Self> {
        /// Chooses among the listed sizes.
        macro_rules! compiled {
            ($($size:literal)*) => {
                match size {
                    $($size if $size <= S => Equations::solve_sized::<$size>,)*
                    _ => Equations::solve_any,
                }
            };
        }
        Kernels { value: compiled!(1 2 3 4 5 6 7 8 9 10), tangent: Equations::solve_any }
    }
}

/// The rod in motion.
pub struct Moving<'a, R, const P: usize, const K: usize, const F: usize> {
    /// Its modes.
    pub rod: &'a Rod,
    /// How it is deformed.
    pub shape: &'a Shape<R, K, F>,
    /// Its inertia.
    pub inertia: &'a Inertia<R, K>,
    /// Where it is.
    pub configuration: &'a Configuration<R, P>,
    /// Where its modal coordinates stand.
    pub modes: Range<usize>,
}

impl<R: Real, const P: usize, const K: usize, const F: usize> Moving<'_, R, P, K, F> {
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
    pub fn demand(&self, places: &[R; P], forced: &[R], gravity: f64) -> Demand<R> {
        let Self { rod, inertia, configuration, modes, .. } = self;
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
