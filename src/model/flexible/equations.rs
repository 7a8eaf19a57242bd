//! M(q)·q̈ = Q of a mechanism with a flexible rod: summed body by body over the coordinates of the
//! configuration, M_x = Σ JᵀM_bJ, then spread over the modes.

#![allow(clippy::needless_range_loop)] // triangles are read by their indices

use super::configuration::{Centre, Configuration, Heading};
use super::sparse::Sparse;
use crate::math::{Fused, Real, each};
use crate::model::bodies::{Bodies, Body};
use crate::model::loads::Loads;
use crate::model::plane::{Vec2, cross, perp};
use crate::model::reactions::Demand;
use crate::model::rod::{FEW_MODES, Inertia, Rod, Shape};
use crate::model::structure::{CRANK, ROD, SLIDER, Topology};
use std::ops::Range;

/// Mass matrix (lower triangle) and right side over x, the configuration's coordinates.
pub struct Places<R, const P: usize> {
    matrix: [[Sparse<R>; P]; P],
    right: [Sparse<R>; P],
}

impl<R: Real, const P: usize> Places<R, P> {
    /// With nothing in them.
    pub const NONE: Self = Self { matrix: [[Sparse::Zero; P]; P], right: [Sparse::Zero; P] };

    /// Adds `force` [N] at a joint centre.
    #[inline(always)]
    fn push(&mut self, centre: &Centre<R, P>, force: Vec2<R>) {
        each!(R::PLAIN, k < P => {
            self.right[k] += centre.slope[k].with(force);
        });
    }

    /// Adds `couple` [N·m] on a body.
    #[inline(always)]
    fn twist(&mut self, heading: &Heading<R, P>, couple: R) {
        each!(R::PLAIN, k < P => {
            self.right[k] = heading.slope[k].times_plus(couple, self.right[k]);
        });
    }

    /// Adds what momentum `push` and moment of momentum `twist` of ẋ_i give with every ẋ_j of a point and an angle.
    #[inline(always)]
    fn add_row(
        &mut self,
        i: usize,
        push: Vec2<Sparse<R>>,
        twist: Sparse<R>,
        centre: &Centre<R, P>,
        heading: &Heading<R, P>,
    ) {
        each!(R::PLAIN, j < i + 1, P => {
            self.matrix[i][j] += twist.times_plus(heading.slope[j], push.with(centre.slope[j]));
        });
    }

    /// Adds a rigid body whose reference point is `centre`.
    #[inline(always)]
    fn add_body(&mut self, body: &Body, heading: &Heading<R, P>, centre: &Centre<R, P>, gravity: f64) {
        let com = centre.carried(heading, body.com);
        each!(R::PLAIN, i < P => {
            let (push, twist) = (com.slope[i].scaled(body.mass), heading.slope[i].map(|turn| turn * body.inertia));
            self.add_row(i, push, twist, &com, heading);
        });
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

/// Mass matrix (upper triangle) and right side over the coordinates of the rod's chain and its modes.
pub struct Equations<R, const S: usize> {
    pub(super) size: usize,
    pub(super) matrix: [[R; S]; S],
    pub(super) right: [R; S],
}

impl<R: Real, const S: usize> Equations<R, S> {
    /// Adds the rod to the other bodies' equations: its inertia and, at its ends and on its modes, its loads. So many
    /// coordinates stand before L.
    #[inline(always)]
    pub fn new<const P: usize, const K: usize, const F: usize>(
        mut places: Places<R, P>,
        rigid: usize,
        rod: &Moving<'_, R, P, K, F>,
        loads: &Loads<R>,
        gravity: f64,
        modal_force: &[R; K],
    ) -> Self {
        let Moving { rod: beam, shape, inertia, configuration, modes } = rod;
        let Configuration { heading, big_end, small_end, .. } = configuration;
        let heading = &heading[ROD];
        let n = modes.len().min(K);
        let first = heading.rotation.apply(inertia.first);
        let lever = perp(first);
        let m = beam.mass();
        each!(R::PLAIN, i < P => {
            let (slope, turn) = (big_end.slope[i], heading.slope[i]);
            let twist = turn.times_plus(inertia.about_origin, slope.with(lever));
            places.add_row(i, slope.scaled(m) + turn.times(lever), twist, big_end, heading);
        });
        // Right side: loads less what the biases ask for.
        let bias = big_end.bias + Vec2::new(0.0, gravity);
        let asked = bias * m + heading.bias * lever + heading.rotation.apply(inertia.force);
        let couple = cross(first, bias) + inertia.about_origin * heading.bias + inertia.couple;
        places.push(big_end, loads.big_end - asked);
        places.push(small_end, loads.small_end);
        places.twist(heading, loads.end_couple[0] + loads.end_couple[1] - couple);

        let mut all = Self { size: rigid + n, matrix: [[R::ZERO; S]; S], right: [R::ZERO; S] };
        each!(R::PLAIN, i < rigid, P => {
            each!(R::PLAIN, j < i + 1, P => {
                all.matrix[j][i] = places.matrix[i][j].value();
            });
            all.right[i] = places.right[i].value();
        });
        // A mode turns and shifts the rod's mass in its frame, and moves the frame through the chord.
        let of_chord = &places.matrix[rigid];
        let mut by_chord = [Sparse::Zero; K];
        each!(const { R::PLAIN && K <= FEW_MODES }, a < n, K => {
            let (slope, turning) = (heading.rotation.apply(inertia.first_slope[a]), inertia.turning[a]);
            let with = |i: usize| heading.slope[i].times_plus(turning, big_end.slope[i].with(slope));
            let chord = shape.chord_slope[a];
            each!(R::PLAIN, i < rigid, P => {
                all.matrix[i][rigid + a] = of_chord[i].times_plus(chord, with(i)).value();
            });
            by_chord[a] = with(rigid);
            each!(const { R::PLAIN && K <= FEW_MODES }, b < a + 1, K => {
                let other = shape.chord_slope[b];
                let shifted = of_chord[rigid] * (chord * other);
                let shifted = by_chord[a].times_plus(other, by_chord[b].times_plus(chord, shifted));
                all.matrix[rigid + b][rigid + a] = shifted.added_to(inertia.modal[a][b]);
            });
            let force = (-turning).times_plus(heading.bias, modal_force[a] - slope.dot(bias));
            let force = force - inertia.modal_force[a];
            all.right[rigid + a] = (places.right[rigid] * chord).added_to(force);
        });
        all
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
