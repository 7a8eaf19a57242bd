//! Differences along a line of neighbouring states, on which a parameter may change, too.
//!
//! A derivative is a difference of order 4, (8·(f₁ − f₋₁) − (f₂ − f₋₂))/(12·h). Contact forces are not smooth where a
//! penetration begins and at their corners, so the step h is chosen anew at every state, such that no penetration, and no
//! distance to a corner, changes by more than a share of itself. Where a corner is so near that no step suits, speeds are
//! moved along with the parameter such that the distance to the corner stays as it is. Outputs have corners of their own,
//! where an eccentricity is 0, or the velocity that squeezes an oil film.

use super::levels::{CENTRAL, LEVELS, Levels, Neighbour, TURN, step_at};
use crate::integrator::{Discontinuities, MAX_DISCONTINUITIES, MAX_STATES};
use crate::math::add_multiple;
use crate::model::contact::ContactState;
use crate::model::joint::rectangle::CORNERS as GUIDE_CORNERS;
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::plane::Vec2;
use crate::model::signals::Outputs;
use crate::model::state::{CONTACTS, Conditions, Pose};
use crate::simulation::observation::observe;
use std::array::from_fn;

/// The longest step of states alone, in noticeable differences.
const OF_STATES: f64 = 0.1;
/// The level at which changes of distances are measured: short against clearances, where lengths are centimetres.
const MEASURED: usize = 4;
/// Largest changes within a step: of a penetration, …
const OF_PENETRATION: f64 = 0.01;
/// … of its second order, since a force that the first hardly changes depends on it, …
const OF_BEND: f64 = 1e-5;
/// … of a vector at whose zero outputs are not smooth, …
const OF_VECTOR: f64 = 0.02;
/// … of a distance to a corner, and of a remembered approach speed, all as shares of themselves.
const OF_CORNER: f64 = 0.2;
const OF_APPROACH: f64 = 1e-3;

/// Most corners that a line keeps its distance from, …
const MOST_KEPT: usize = 4;
/// … the change of a speed that tells how the distance depends on it, in its scale, …
const OF_SPEED: f64 = 1e-4;
/// … and the share of a gradient that must be left where those of nearer corners are taken away.
const LEAST_LEFT: f64 = 1e-3;

/// Largest length of a direction.
pub const DIRECTION: usize = MAX_STATES + CONTACTS;

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
    fn write_rates(&self, level: usize, slopes: &mut [f64]) {
        let n = self.y.len();
        let mut rates = [0.0; MAX_STATES];
        slopes.fill(0.0);
        for Point { weight, model, conditions, y, .. } in self.points(level) {
            model.rates(&conditions, self.t, &y[..n], &mut rates[..n]);
            add(slopes, weight, &rates);
        }
    }

    /// Derivatives of the outputs, with the step of a level. `observer` is that of the mechanism.
    fn outputs(&self, level: usize, observer: &Observer) -> Outputs {
        if self.stands() {
            // A difference would be a rounding error.
            return Outputs::default();
        }
        sum(self.points(level).map(|Point { weight, neighbour, model, conditions, y }| {
            let observer = neighbour.map_or(observer, |neighbour| &neighbour.observer);
            (observe(model, observer, &conditions, self.t, &y[..self.y.len()]), weight)
        }))
    }

    /// The level of the longest step, from `level` on, that changes none of the `vectors` of a pose by much.
    #[inline(never)]
    fn passes_no_zero(&self, level: usize, vectors: &dyn Fn(&Pose) -> [Vec2; 3]) -> Option<usize> {
        let here = vectors(&self.model.pose(self.t, self.y));
        let keeps = |level: &usize| {
            self.points(*level).all(|Point { model, y, .. }| {
                let there = vectors(&model.pose(self.t, &y[..self.y.len()]));
                // At a zero itself no step is short enough.
                let mut pairs = here.iter().zip(there).filter(|(own, _)| own.norm() > 0.0);
                pairs.all(|(own, other)| (other - *own).norm() <= 2.0 * OF_VECTOR * own.norm())
            })
        };
        (level..LEVELS).find(keeps)
    }

    /// Whether nothing changes along the line.
    fn stands(&self) -> bool {
        self.levels.is_none() && self.direction.iter().all(|slope| *slope == 0.0)
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
            (None, 0.0) => OF_STATES,
            (None, size) => OF_STATES / size,
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

    /// Of this line, that of the parameter at a constant state and, where no step of these suits the state, that along the
    /// corners the one with the longest step. `changed` holds the direction of the last. What they say about the same state
    /// differs by the derivative along the difference of their directions.
    #[inline(never)]
    pub fn best<'b>(self, changed: &'b mut [f64; DIRECTION]) -> Fitted<'b>
    where
        'a: 'b,
    {
        let alone = Line { direction: &[], ..self }.fitted();
        if alone.fit.suitable == Some(0) {
            return alone;
        }
        let better = self.fitted().or(alone);
        if better.fit.suitable.is_some() {
            return better;
        }
        *changed = self.along_corners();
        Line { direction: &changed[..self.direction.len()], ..self }.fitted().or(better)
    }

    /// With the step that suits the state.
    #[inline(never)]
    pub fn fitted(self) -> Fitted<'a> {
        let any = Fit { longest: f64::INFINITY, suitable: Some(0) };
        Fitted { line: self, fit: if self.stands() { any } else { self.fit(&self.middle()) } }
    }

    /// The direction, changed in the forced states such that the distances to the nearest corners do not change to first
    /// order. Corners count for as long as no other distance asks for a shorter step.
    #[cold]
    #[inline(never)]
    fn along_corners(&self) -> [f64; DIRECTION] {
        let (here, n, mut direction) = (self.middle(), self.direction.len(), [0.0; DIRECTION]);
        direction[..n].copy_from_slice(self.direction);
        let mut kept: Vec<[f64; MAX_STATES]> = Vec::new();
        while kept.len() < MOST_KEPT {
            let line = Line { direction: &direction[..n], ..*self };
            let slopes = line.slopes();
            let (_, nearest) = here.longest(&slopes);
            let Some(corner) = nearest.and_then(|place| place.checked_sub(CORNERS)) else { break };
            let mut gradient = self.gradient(corner);
            let whole = dot(&gradient, &gradient);
            for other in &kept {
                let share = dot(other, &gradient);
                add(&mut gradient, -share, other);
            }
            let left = dot(&gradient, &gradient);
            if left <= LEAST_LEFT * LEAST_LEFT * whole {
                break;
            }
            let share = slopes[CORNERS + corner] / left;
            let scaled = direction.iter_mut().zip(&gradient).zip(self.model.scales());
            scaled.for_each(|((slope, part), scale)| *slope -= share * part * scale);
            kept.push(gradient.map(|part| part / left.sqrt()));
        }
        direction
    }

    /// Derivatives of the distance to a corner by the forced states, in their scales.
    #[cold]
    #[inline(never)]
    fn gradient(&self, corner: usize) -> [f64; MAX_STATES] {
        let (mut gradient, mut y) = ([0.0; MAX_STATES], [0.0; MAX_STATES]);
        let y = &mut y[..self.y.len()];
        y.copy_from_slice(self.y);
        for (state, scale) in self.model.scales().iter().enumerate().skip(self.model.layout().positions) {
            let [above, below] = [OF_SPEED, -OF_SPEED].map(|share| {
                y[state] = self.y[state] + share * scale;
                let mut corners = Discontinuities::NONE;
                self.model.discontinuities(self.conditions, self.t, y, &mut corners);
                corners.values()[corner]
            });
            y[state] = self.y[state];
            gradient[state] = (above - below) / (2.0 * OF_SPEED);
        }
        gradient
    }

    #[inline(never)]
    fn middle(&self) -> Distances {
        Distances::at(self.model, self.conditions, self.t, self.y)
    }

    /// Slopes of the distances.
    #[inline(never)]
    fn slopes(&self) -> [f64; DISTANCES] {
        let mut slopes = [0.0; DISTANCES];
        for i in 0..CENTRAL.len() {
            let (there, weight) = self.beside(MEASURED, i);
            add(&mut slopes, weight, &there.values);
        }
        slopes
    }

    /// The distances at a point, and its weight.
    #[inline(never)]
    fn beside(&self, level: usize, i: usize) -> (Distances, f64) {
        let Point { weight, model, conditions, y, .. } = self.point(level, i);
        (Distances::at(model, &conditions, self.t, &y[..self.y.len()]), weight)
    }

    /// How well the steps suit the state, which has these distances.
    #[inline(never)]
    fn fit(&self, here: &Distances) -> Fit {
        let (longest, first) = (here.longest(&self.slopes()).0, self.first());
        // Across an eccentricity a long step changes it by much, whatever its slope is.
        let keeps = |level: &usize| {
            let there: [Distances; CENTRAL.len()] = from_fn(|i| self.beside(*level, i).0);
            there.iter().all(|there| here.is_near(there)) && here.is_straight([&there[0], &there[1]])
        };
        let by_slope = (0..LEVELS).find(|level| step_at(first, *level) <= longest);
        Fit { longest, suitable: by_slope.and_then(|level| (level..LEVELS).find(keeps)) }
    }
}

/// A line, and how well its steps suit the state.
pub struct Fitted<'a> {
    /// The line.
    pub line: Line<'a>,
    fit: Fit,
}

impl Fitted<'_> {
    /// Derivatives of the rates.
    pub fn write_rates(&self, slopes: &mut [f64]) {
        self.line.write_rates(self.fit.level(), slopes);
    }

    /// Derivatives of the outputs. `observer` is that of the mechanism.
    pub fn outputs(&self, observer: &Observer) -> Outputs {
        let (line, level) = (&self.line, self.fit.level());
        let level = line.passes_no_zero(level, &|pose| observer.squeeze_velocities(pose)).unwrap_or(level);
        let mut found = line.outputs(level, observer);
        let shorter = line.passes_no_zero(level, &|pose| observer.eccentricities(pose)).unwrap_or(LEVELS - 1);
        if shorter > level {
            // Penetrations alone: the shorter the step, the more it rounds.
            let theirs = line.outputs(shorter, observer);
            found.joint_a.penetration = theirs.joint_a.penetration;
            found.joint_b.penetration = theirs.joint_b.penetration;
            found.joint_c.penetration = theirs.joint_c.penetration;
        }
        found
    }

    /// This one, or the other if its step is longer. Near a corner none suits, and the one errs less that crosses the corner
    /// more slowly.
    fn or(self, other: Self) -> Self {
        let order = self.fit.level().cmp(&other.fit.level()).then(other.fit.longest.total_cmp(&self.fit.longest));
        if order.is_le() { self } else { other }
    }
}

/// How well the steps of a line suit a state.
struct Fit {
    /// The longest step by the slopes of the distances.
    longest: f64,
    /// The level of the longest step that suits the state.
    suitable: Option<usize>,
}

impl Fit {
    /// The level of that step; the last one if none suits.
    fn level(&self) -> usize {
        self.suitable.unwrap_or(LEVELS - 1)
    }
}

/// The places of [`Distances`]: penetrations, then approach speeds, angles, and corners.
const APPROACHES: usize = 3 + GUIDE_CORNERS;
const ANGLES: usize = APPROACHES + CONTACTS;
const CORNERS: usize = ANGLES + 3;
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
        for (corner, distance) in corners.values().iter().enumerate() {
            write(CORNERS + corner, *distance, OF_CORNER * distance.abs());
        }
        all
    }

    /// The longest step that changes none of these by too much, which have these slopes, and the place of the one that bounds
    /// it; 0 if one of them is not a number.
    #[inline(never)]
    fn longest(&self, slopes: &[f64; DISTANCES]) -> (f64, Option<usize>) {
        let mut longest = (f64::INFINITY, None);
        for (place, (slope, most)) in slopes.iter().zip(&self.most).enumerate().filter(|(_, (slope, _))| **slope != 0.0)
        {
            let step = most / slope.abs();
            let step = if step.is_nan() { 0.0 } else { step };
            if step < longest.0 {
                longest = (step, Some(place));
            }
        }
        longest
    }

    /// Whether the penetrations change by little of the second order from one neighbour to the opposite one.
    #[inline(never)]
    fn is_straight(&self, [before, after]: [&Self; 2]) -> bool {
        (0..APPROACHES).all(|i| {
            let own = self.values[i];
            (before.values[i] + after.values[i] - 2.0 * own).abs() <= 2.0 * OF_BEND * own.abs()
        })
    }

    /// Whether none of these differs from that of a neighbour, which is up to two steps away, by much more than it may.
    #[inline(never)]
    fn is_near(&self, other: &Self) -> bool {
        let changes = self.values.iter().zip(&other.values).zip(&self.most);
        changes.into_iter().all(|((own, other), most)| (other - own).abs() <= 4.0 * most)
    }
}

/// Adds a multiple of some numbers to others. Compiled once: arrays of this length are long loops written out.
#[inline(never)]
fn add(sum: &mut [f64], share: f64, values: &[f64]) {
    add_multiple(sum, share, values);
}

#[inline(never)]
fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
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
