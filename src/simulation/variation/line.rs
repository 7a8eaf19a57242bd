//! Differences along a line of neighbouring states, on which a parameter may change, too.
//!
//! A derivative is a difference of order 4, (8·(f₁ − f₋₁) − (f₂ − f₋₂))/(12·h). Contact forces are not smooth where a
//! penetration begins and at their corners, so the step h is chosen anew at every state, such that no penetration, and no
//! distance to a corner, changes by more than a share of itself.

use super::levels::{CENTRAL, LEVELS, LONGEST, Levels, Neighbour, TURN, step_at};
use crate::integrator::{Discontinuities, MAX_DISCONTINUITIES, MAX_STATES};
use crate::math::add_multiple;
use crate::model::contact::ContactState;
use crate::model::joint::rectangle::CORNERS as GUIDE_CORNERS;
use crate::model::joint_set::Pin;
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::signals::Outputs;
use crate::model::state::{CONTACTS, Conditions};
use crate::simulation::observation::observe;

/// The level at which changes of distances are measured: short against clearances, where lengths are centimetres.
const MEASURED: usize = 4;
/// Largest changes within a step: of a penetration, …
const OF_PENETRATION: f64 = 0.01;
/// … by the growth of an eccentricity that moves across itself, …
const OF_BEND: f64 = 1e-5;
/// … of a distance to a corner, and of a remembered approach speed, all as shares of themselves.
const OF_CORNER: f64 = 0.2;
const OF_APPROACH: f64 = 1e-3;

/// A line through a state of a mechanism.
#[derive(Clone, Copy)]
pub struct Line<'a> {
    /// The mechanism.
    pub model: &'a dyn MechanismModel,
    /// Its conditions.
    pub conditions: &'a Conditions,
    /// [s] Time.
    pub t: f64,
    /// The state.
    pub y: &'a [f64],
    /// Slopes of the states and, below them, of the approach speeds of closed contacts. Missing ones are 0.
    pub direction: &'a [f64],
    /// Neighbours of the mechanism, if a parameter grows along the line.
    pub levels: Option<&'a Levels>,
}

/// A point beside the middle of a line.
struct Point<'a> {
    /// Its weight in a derivative.
    weight: f64,
    neighbour: Option<&'a Neighbour>,
    model: &'a dyn MechanismModel,
    conditions: Conditions,
    y: [f64; MAX_STATES],
}

impl<'a> Line<'a> {
    /// Derivatives of the rates, with the step of a level.
    pub fn write_rates(&self, level: usize, slopes: &mut [f64]) {
        let n = self.y.len();
        let mut rates = [0.0; MAX_STATES];
        slopes.fill(0.0);
        for Point { weight, model, conditions, y, .. } in self.points(level) {
            model.rates(&conditions, self.t, &y[..n], &mut rates[..n]);
            add_multiple(slopes, weight, &rates);
        }
    }

    /// Derivatives of the outputs, with the step of a level. `observer` is that of the mechanism.
    pub fn outputs(&self, level: usize, observer: &Observer) -> Outputs {
        if self.levels.is_none() && self.direction.iter().all(|slope| *slope == 0.0) {
            // A difference would be a rounding error.
            return Outputs::default();
        }
        sum(self.points(level).map(|Point { weight, neighbour, model, conditions, y }| {
            let observer = neighbour.map_or(observer, |neighbour| &neighbour.observer);
            (observe(model, observer, &conditions, self.t, &y[..self.y.len()]), weight)
        }))
    }

    /// Size of the direction, in noticeable differences.
    fn size(&self) -> f64 {
        let scaled = self.direction.iter().zip(self.model.scales()).filter(|(_, scale)| **scale > 0.0);
        scaled.map(|(slope, scale)| (slope / scale).abs()).fold(0.0, f64::max)
    }

    /// The longest step.
    fn first(&self) -> f64 {
        match (self.levels, self.size()) {
            (Some(levels), _) => levels.longest(),
            (None, 0.0) => LONGEST,
            (None, size) => LONGEST / size,
        }
    }

    /// The points of a level, at the places of [`CENTRAL`].
    fn points(self, level: usize) -> impl Iterator<Item = Point<'a>> {
        (0..CENTRAL.len()).map(move |i| self.point(level, i))
    }

    /// One of them. Compiled once: it is long.
    #[inline(never)]
    fn point(&self, level: usize, i: usize) -> Point<'a> {
        let Self { conditions, y, direction, levels, .. } = *self;
        let neighbours = levels.map(|levels| levels.at(level));
        let step = neighbours.map_or_else(|| step_at(self.first(), level), |neighbours| neighbours.step);
        let neighbour = neighbours.map(|level| &level.neighbours[i]);
        let ((place, weight), mut conditions, mut moved) = (CENTRAL[i], *conditions, [0.0; MAX_STATES]);
        moved[..y.len()].copy_from_slice(y);
        moved[..y.len()].iter_mut().zip(direction).for_each(|(y, slope)| *y += place * step * slope);
        let slopes = direction.get(y.len()..).unwrap_or_default();
        for (contact, slope) in conditions.contacts.iter_mut().zip(slopes).filter(|(contact, _)| contact.closed) {
            let approach = contact.approach + place * step * slope;
            *contact = ContactState { closed: true, approach, per_approach: 1.0 / approach };
        }
        let model = neighbour.map_or(self.model, |neighbour| neighbour.model.as_ref());
        Point { weight: weight / step, neighbour, model, conditions, y: moved }
    }

    /// The level of the longest step that suits the state; the last one if none does.
    pub fn level(&self) -> usize {
        self.suitable(&self.middle()).unwrap_or(LEVELS - 1)
    }

    /// Of this line and that of the parameter at a constant state the one with the longer step that suits the state, and
    /// the level of that step. What both say about the same state differs by the derivative along the direction.
    pub fn or_alone(self) -> (Self, usize) {
        let (alone, here) = (Self { direction: &[], ..self }, self.middle());
        let level = alone.suitable(&here);
        let own = if level == Some(0) { None } else { self.suitable(&here) };
        match own {
            Some(own) if level.is_none_or(|level| own <= level) => (self, own),
            _ => (alone, level.unwrap_or(LEVELS - 1)),
        }
    }

    fn middle(&self) -> Distances {
        Distances::at(self.model, self.conditions, self.t, self.y)
    }

    /// The distances at a point, and its weight.
    #[inline(never)]
    fn beside(&self, level: usize, i: usize) -> (Distances, f64) {
        let Point { weight, model, conditions, y, .. } = self.point(level, i);
        (Distances::at(model, &conditions, self.t, &y[..self.y.len()]), weight)
    }

    /// The level of the longest step that suits the state, which has these distances.
    #[inline(never)]
    fn suitable(&self, here: &Distances) -> Option<usize> {
        let mut slopes = [0.0; DISTANCES];
        for i in 0..CENTRAL.len() {
            let (there, weight) = self.beside(MEASURED, i);
            add_multiple(&mut slopes, weight, &there.values);
        }
        let first = self.first();
        let by_slope = (0..LEVELS).find(|level| here.allows(&slopes, step_at(first, *level)))?;
        // Across an eccentricity a long step changes it by much, whatever its slope is.
        let keeps = |level: &usize| (0..CENTRAL.len()).all(|i| here.is_near(&self.beside(*level, i).0));
        (by_slope..LEVELS).find(keeps)
    }
}

/// The places of [`Distances`]: penetrations, then approach speeds, angles, eccentricities, and corners.
const APPROACHES: usize = 3 + GUIDE_CORNERS;
const ANGLES: usize = APPROACHES + CONTACTS;
const ECCENTRICITIES: usize = ANGLES + 3;
const CORNERS: usize = ECCENTRICITIES + 6;
const DISTANCES: usize = CORNERS + MAX_DISCONTINUITIES;

/// Distances of a state from where the rates are not smooth, and what they are smooth in.
struct Distances {
    values: [f64; DISTANCES],
    /// Largest change of each within a step.
    most: [f64; DISTANCES],
}

impl Distances {
    #[inline(never)]
    fn at(model: &dyn MechanismModel, conditions: &Conditions, t: f64, y: &[f64]) -> Self {
        let mut corners = Discontinuities::NONE;
        model.discontinuities(conditions, t, y, &mut corners);
        let pose = model.pose(t, y);
        // Of a face, those of both corners: it may touch in part.
        let depths = model.penetration(&pose);
        let mut all = Self { values: [0.0; DISTANCES], most: [f64::INFINITY; DISTANCES] };
        let mut write = |place: usize, value: f64, most: f64| (all.values[place], all.most[place]) = (value, most);
        for (place, depth) in depths.into_iter().enumerate().filter(|(_, depth)| depth.is_finite()) {
            write(place, depth, OF_PENETRATION * depth.abs());
        }
        for (contact, state) in conditions.contacts.iter().enumerate().filter(|(_, state)| state.closed) {
            write(APPROACHES + contact, state.approach, OF_APPROACH * state.approach);
        }
        for (body, angle) in pose.rotations.angle.into_iter().enumerate() {
            write(ANGLES + body, angle, TURN);
        }
        for (place, pin) in Pin::ALL.into_iter().enumerate().filter(|(place, _)| conditions.contacts[*place].closed) {
            let eccentricity = pose.journal(pin).eccentricity;
            // One that moves across itself by s grows by s²/(2·ε).
            let most = (2.0 * OF_BEND * (depths[place] * eccentricity.norm()).abs()).sqrt();
            write(ECCENTRICITIES + 2 * place, eccentricity.x, most);
            write(ECCENTRICITIES + 2 * place + 1, eccentricity.y, most);
        }
        for (corner, distance) in corners.values().iter().enumerate() {
            write(CORNERS + corner, *distance, OF_CORNER * distance.abs());
        }
        all
    }

    /// Whether a `step` changes none of these by too much, which have these slopes.
    #[inline(never)]
    fn allows(&self, slopes: &[f64; DISTANCES], step: f64) -> bool {
        slopes.iter().zip(&self.most).all(|(slope, most)| *slope == 0.0 || (step * slope).abs() <= *most)
    }

    /// Whether none of these differs from that of a neighbour, which is up to two steps away, by much more than it may.
    #[inline(never)]
    fn is_near(&self, other: &Self) -> bool {
        let changes = self.values.iter().zip(&other.values).zip(&self.most);
        changes.into_iter().all(|((own, other), most)| (other - own).abs() <= 4.0 * most)
    }
}

/// Σ weight·outputs.
pub fn sum(terms: impl IntoIterator<Item = (Outputs, f64)>) -> Outputs {
    terms.into_iter().fold(Outputs::default(), |sum, (outputs, weight)| plus(&sum, &outputs, weight))
}

/// sum + weight·outputs.
#[inline(never)]
pub fn plus(sum: &Outputs, outputs: &Outputs, weight: f64) -> Outputs {
    sum.combined(outputs, |sum, value| if weight == 0.0 { sum } else { sum + weight * value })
}
