//! What lies between two communication points: the largest joint forces, and integrals over sliding in contact.
//!
//! Every step that the integrator accepts is examined on its interpolated states, whatever the communication points
//! are: the local maxima of the joint forces in it are located, and the integrals over it are those of the polynomial
//! through the samples, or, between the zeros of the sliding velocities, where |v_t| has its kinks, and those instants at which a
//! normal force comes to or leaves 0, sums by Gauss and Legendre's rule. An interval takes those
//! maxima that lie in it, and the forces at its ends. None of this enters the integrator: the motion keeps its bits.
//!
//! Only what is asked for is computed: nothing while all joints in question fly free; the pose and the contact forces where
//! they touch; accelerations for an ideal joint alone.

use crate::integrator::{Integrator, Reader, Snapshot, StepPoint, root};
use crate::model::contact::Rubbing;
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::signals::Outputs;
use crate::model::state::{CONTACTS, Conditions, Contacts};
use crate::model::touches::{JOINTS, Touches};
use crate::scene::{JointModel, Lubrication, Scene};

/// Points at which a step is sampled: Chebyshev's extrema, which include both ends.
const SAMPLES: usize = 9;
/// [share of the step] Their places: sin²(kπ/16).
const PLACES: [f64; SAMPLES] = [
    0.0,
    0.038_060_233_744_356_63,
    0.146_446_609_406_726_24,
    0.308_658_283_817_455_1,
    0.5,
    0.691_341_716_182_544_9,
    0.853_553_390_593_273_8,
    0.961_939_766_255_643_4,
    1.0,
];
/// Weights of the first half of the samples in the integral over the step (C. W. Clenshaw, A. R. Curtis, Numer. Math. 2, 1960,
/// 197), and that of the middle.
const WEIGHTS: [f64; SAMPLES / 2 + 1] = [
    0.007_936_507_936_507_936,
    0.073_109_324_608_009_08,
    0.139_682_539_682_539_7,
    0.180_858_929_360_244_9,
    0.196_825_396_825_396_8,
];
/// Parts of the step at whose ends the polynomial through the samples is searched for maxima.
const SEARCHED: usize = 48;
/// Weights of the samples in the polynomial at each of these ends.
static SEARCH: [[f64; SAMPLES]; SEARCHED + 1] = {
    let mut weights = [[0.0; SAMPLES]; SEARCHED + 1];
    let mut i = 0;
    while i <= SEARCHED {
        weights[i] = weights_at(i as f64 / SEARCHED as f64);
        i += 1;
    }
    weights
};
/// [share of the step] Distances over which the top of a maximum is refined.
const NEAR: [f64; 3] = [1e-2, 2e-3, 2e-4];
/// A top may lie this many grid steps beside the middle of three, where no others are beyond them: at most one, but for the error
/// of the parabola.
const BESIDE: f64 = 1.1;
/// Most maxima of one joint in a step.
const MAX_MAXIMA: usize = 4;
/// Most kinks in a step.
const MAX_KINKS: usize = 16;
/// Share of a bracket within which a zero of a sliding velocity is found: an integral's error is of second order in it.
const RESOLUTION: f64 = 1e-9;
/// Halvings of a bracket in which a normal force comes to or leaves 0: the integrand is continuous there.
const HALVINGS: usize = 20;
/// Gauss and Legendre's rule with six points on [−1, 1]: points and weights of one half.
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_4),
];

/// Integrals of one joint: ∫f_t·v_t dt [J], ∫|v_t| dt [m] over closed contact, ∫f_n·|v_t| dt [J].
type Integrals = [f64; 3];

/// [N] Magnitudes of the joint forces, and sliding in the contacts; zero where it was not asked for.
#[derive(Clone, Copy, Debug, Default)]
struct Forces {
    joints: [f64; JOINTS],
    rubbing: [Rubbing; CONTACTS],
}

/// What joint forces are computed from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Source {
    /// The joint carries nothing.
    Nothing,
    /// The pose: the joint has clearance.
    Contacts,
    /// Accelerations: the joint is ideal.
    Reactions,
}

/// What is asked of an instant.
#[derive(Clone, Copy, Debug)]
struct Asked {
    /// The joint forces that have this source, and those that have one before it.
    forces: Source,
    /// Sliding in the contacts.
    sliding: bool,
}

/// Sliding alone.
const SLIDING: Asked = Asked { forces: Source::Nothing, sliding: true };

/// A run under examination.
pub struct Examined<'a> {
    /// The model.
    pub model: &'a dyn MechanismModel,
    /// Its observer.
    pub observer: &'a Observer,
    /// Its integrator.
    pub integrator: &'a mut Integrator<Conditions>,
}

/// The joints whose intervals are examined, and what was found since the last communication point and since the start.
#[derive(Clone, Debug)]
pub struct IntervalAudit {
    /// Whether the largest force of A, B, C, T is asked for.
    peaks: [bool; JOINTS],
    /// What the forces of A, B, C, T are computed from while no contact is closed: those of an oil film and of viscous
    /// friction are there all the same.
    open: [Source; JOINTS],
    /// Whether the integrals of A, B, C, T are asked for.
    integrals: [bool; JOINTS],
    /// [s] The last communication point.
    begin: f64,
    /// [N] Largest forces since then, up to the start of the last step.
    peak: [f64; JOINTS],
    /// Integrals up to the start of the last step.
    sums: [Integrals; JOINTS],
    last: Examination,
}

/// What was found in the last step.
#[derive(Clone, Copy, Debug)]
struct Examination {
    /// [s] Start and end of the step; NaN before the first one.
    span: [f64; 2],
    /// [s, N] Time and value of local maxima; those not in use are at infinity.
    maxima: [[(f64, f64); MAX_MAXIMA]; JOINTS],
    /// [N] Forces at the end.
    at_end: [f64; JOINTS],
    /// [s] Kinks of the integrands, in order; those not in use are at infinity.
    kinks: [f64; MAX_KINKS],
    /// Integrals over the whole step.
    whole: [Integrals; JOINTS],
}

const NOTHING: Examination = Examination {
    span: [f64::NAN; 2],
    maxima: [[(f64::INFINITY, 0.0); MAX_MAXIMA]; JOINTS],
    at_end: [0.0; JOINTS],
    kinks: [f64::INFINITY; MAX_KINKS],
    whole: [[0.0; 3]; JOINTS],
};

impl Examined<'_> {
    /// What is asked at `t` in the last step; at its end, before the events there.
    #[inline(never)]
    fn at(&mut self, t: f64, asked: Asked) -> Forces {
        let StepPoint { t: end, y, discrete, .. } = self.integrator.state().end();
        if t >= *end {
            return forces(self.model, self.observer, discrete, *end, y, asked);
        }
        let (y, conditions) = self.integrator.state_at(self.model, t);
        forces(self.model, self.observer, &conditions, t, y, asked)
    }

    /// The contacts during the last step.
    fn contacts(&self) -> &Contacts {
        &self.integrator.state().start().discrete.contacts
    }

    fn span(&self) -> [f64; 2] {
        let state = self.integrator.state();
        [state.start().t, state.end().t]
    }
}

#[inline(never)]
fn forces(
    model: &dyn MechanismModel,
    observer: &Observer,
    conditions: &Conditions,
    t: f64,
    y: &[f64],
    asked: Asked,
) -> Forces {
    let (joints, pose) = if asked.forces == Source::Reactions {
        let evaluation = model.evaluation(conditions, t, y);
        (observer.joint_forces(&evaluation), evaluation.pose)
    } else {
        let pose = model.pose(t, y);
        let loads = (asked.forces == Source::Contacts).then(|| model.loads(conditions, t, &pose, y));
        (loads.map_or([0.0; JOINTS], |loads| Observer::clearance_forces(&loads)), pose)
    };
    let rubbing = asked.sliding.then(|| model.rubbing(&conditions.contacts, &pose, y));
    Forces { joints, rubbing: rubbing.unwrap_or_default() }
}

impl IntervalAudit {
    /// The audit that a scene asks for; `None` if it asks for none.
    pub fn new(scene: &Scene) -> Option<Self> {
        let joint = &scene.joint;
        let peaks = [joint.a.peak.audit, joint.b.peak.audit, joint.c.peak.audit, joint.t.peak.audit];
        let integrals = [joint.a.wear.audit, joint.b.wear.audit, joint.c.wear.audit, joint.t.wear.audit];
        let [a, b, c] = [&joint.a, &joint.b, &joint.c].map(|joint| match (joint.model, joint.lubrication) {
            (JointModel::Ideal, _) => Source::Reactions,
            (JointModel::Clearance, Lubrication::None) => Source::Nothing,
            (JointModel::Clearance, _) => Source::Contacts,
        });
        let t = match joint.t.model {
            JointModel::Ideal => Source::Reactions,
            JointModel::Clearance if joint.t.damping == 0.0 => Source::Nothing,
            JointModel::Clearance => Source::Contacts,
        };
        (peaks.contains(&true) || integrals.contains(&true)).then_some(Self {
            peaks,
            open: [a, b, c, t],
            integrals,
            begin: 0.0,
            peak: [0.0; JOINTS],
            sums: [[0.0; 3]; JOINTS],
            last: NOTHING,
        })
    }

    /// What the force of one joint is computed from; nothing if it is not asked for.
    fn source(&self, joint: usize, contacts: &Contacts) -> Source {
        let closed = (0..CONTACTS).any(|contact| Touches::joint(contact) == joint && contacts[contact].closed);
        match self.peaks[joint] {
            true if closed => self.open[joint].max(Source::Contacts),
            true => self.open[joint],
            false => Source::Nothing,
        }
    }

    /// What is asked of an instant with these contacts.
    fn asked(&self, contacts: &Contacts) -> Asked {
        let forces = (0..JOINTS).map(|joint| self.source(joint, contacts)).max().unwrap_or(Source::Nothing);
        Asked { forces, sliding: self.slides(contacts) }
    }

    /// Whether there may be sliding in a joint whose integrals are asked for.
    fn slides(&self, contacts: &Contacts) -> bool {
        (0..CONTACTS).any(|contact| self.integrals[Touches::joint(contact)] && contacts[contact].closed)
    }

    /// Begins an interval at `t` in the last step. Its left end counts with the inputs that hold from there on.
    pub fn begin(&mut self, run: &mut Examined<'_>, t: f64) {
        self.refresh(run);
        self.begin = t;
        let (y, conditions) = run.integrator.state_at(run.model, t);
        let asked = Asked { sliding: false, ..self.asked(&conditions.contacts) };
        self.peak = forces(run.model, run.observer, &conditions, t, y, asked).joints;
    }

    /// Takes in a step that was accepted after the last one.
    pub fn step(&mut self, run: &mut Examined<'_>) {
        if self.last.span == run.span() {
            return;
        }
        let Examination { span: [_, end], whole, .. } = self.last;
        self.peak = self.peak_until(end);
        self.sums = std::array::from_fn(|joint| sum(self.sums[joint], whole[joint]));
        self.last = self.examined(run);
    }

    /// [N] Largest forces since the last communication point up to `t` in the last step, but for those at `t` itself.
    fn peak_until(&self, t: f64) -> [f64; JOINTS] {
        let Examination { span: [_, end], maxima, at_end, .. } = &self.last;
        std::array::from_fn(|joint| {
            let found = maxima[joint].into_iter().chain([(*end, at_end[joint])]);
            let within = found.filter(|(time, _)| *time > self.begin && *time <= t).map(|(_, force)| force);
            within.fold(self.peak[joint], f64::max)
        })
    }

    /// Examines the last step anew if it is not the one that was examined: it may have been shortened.
    fn refresh(&mut self, run: &mut Examined<'_>) {
        if self.last.span != run.span() {
            self.last = self.examined(run);
        }
    }

    /// Sets the outputs at `t` in the last step.
    pub fn set_outputs(&mut self, run: &mut Examined<'_>, t: f64, outputs: &mut Outputs) {
        self.refresh(run);
        let peak = self.peak_until(t);
        let [start, end] = self.last.span;
        let partial = if t >= end || !self.slides(run.contacts()) {
            self.last.whole
        } else {
            integrated(run, &self.last.kinks, [start, t])
        };
        let at_point = outputs.joint_forces();
        for joint in 0..JOINTS {
            let interval = outputs.interval_mut(joint);
            if self.peaks[joint] {
                interval.force_peak = peak[joint].max(at_point[joint]);
            }
            if self.integrals[joint] {
                let sums = sum(self.sums[joint], partial[joint]);
                [interval.friction_work, interval.sliding, interval.wear_work] = sums;
            }
        }
    }

    /// Sets the rates of the integrals where the contacts rub like this.
    pub fn set_rates(&self, rubbing: [Rubbing; CONTACTS], rates: &mut Outputs) {
        let mut powers = [[0.0; 3]; JOINTS];
        add(&mut powers, 1.0, &rubbing);
        for joint in (0..JOINTS).filter(|&joint| self.integrals[joint]) {
            let interval = rates.interval_mut(joint);
            [interval.friction_work, interval.sliding, interval.wear_work] = powers[joint];
        }
    }

    /// Appends the memory of the audit.
    pub fn save(&self, snapshot: &mut Snapshot) {
        snapshot.reals.push(self.begin);
        snapshot.reals.extend(self.peak.iter().chain(self.sums.as_flattened()));
    }

    /// Restores what [`save`](Self::save) appended; `None` if no run can have produced it.
    pub fn load(&mut self, reader: &mut Reader<'_>) -> Option<()> {
        self.begin = reader.real()?;
        self.peak = reader.reals()?;
        for sums in &mut self.sums {
            *sums = reader.reals()?;
        }
        self.last = NOTHING;
        let numbers = self.peak.iter().chain(self.sums.as_flattened());
        (self.begin.is_finite() && numbers.copied().all(f64::is_finite)).then_some(())
    }

    fn examined(&self, run: &mut Examined<'_>) -> Examination {
        let span @ [start, end] = run.span();
        let mut found = Examination { span, ..NOTHING };
        if end <= start {
            return found;
        }
        let contacts = *run.contacts();
        let asked = self.asked(&contacts);
        if asked.forces == Source::Nothing && !asked.sliding {
            return found;
        }
        let time = |sample: usize| place(span, PLACES[sample]);
        let samples: [Forces; SAMPLES] = std::array::from_fn(|sample| run.at(time(sample), asked));
        found.at_end = samples[SAMPLES - 1].joints;
        for joint in 0..JOINTS {
            let forces = self.source(joint, &contacts);
            if forces != Source::Nothing {
                let of = |t| run.at(t, Asked { forces, sliding: false }).joints[joint];
                found.maxima[joint] = maxima(&samples.each_ref().map(|sample| sample.joints[joint]), span, of);
            }
        }
        if asked.sliding {
            let mut count = 0;
            for contact in (0..CONTACTS).filter(|&contact| self.integrals[Touches::joint(contact)]) {
                for (sample, pair) in samples.windows(2).enumerate() {
                    let [before, after] = [0, 1].map(|side| pair[side].rubbing[contact]);
                    let bracket = [time(sample), time(sample + 1)];
                    let mut at = |t| run.at(t, SLIDING).rubbing[contact];
                    let turns = before.speed * after.speed < 0.0;
                    let turning = turns.then(|| zero(bracket, [before.speed, after.speed], |t| at(t).speed));
                    let ceases = before.normal > 0.0 && after.normal == 0.0;
                    // A contact that has closed at the start of the step has no force there.
                    let begins = before.normal == 0.0 && after.normal > 0.0 && sample > 0;
                    let corner = (ceases || begins).then(|| halved(bracket, |t| (at(t).normal > 0.0) == ceases));
                    for kink in [turning, corner].into_iter().flatten().take(MAX_KINKS - count) {
                        found.kinks[count] = kink;
                        count += 1;
                    }
                }
            }
            found.kinks.sort_by(f64::total_cmp);
            found.whole =
                if count > 0 { integrated(run, &found.kinks, span) } else { of_samples(&samples, end - start) };
        }
        found
    }
}

/// The integrals of each joint over a step of a length [s] without kinks.
fn of_samples(samples: &[Forces; SAMPLES], length: f64) -> [Integrals; JOINTS] {
    let mut sums = [[0.0; 3]; JOINTS];
    for (sample, forces) in samples.iter().enumerate() {
        add(&mut sums, length * WEIGHTS[sample.min(SAMPLES - 1 - sample)], &forces.rubbing);
    }
    sums
}

/// Adds the integrands at an instant with a weight [s].
fn add(sums: &mut [Integrals; JOINTS], weight: f64, rubbing: &[Rubbing; CONTACTS]) {
    for (contact, Rubbing { speed, normal, friction }) in rubbing.iter().enumerate() {
        let integrals = &mut sums[Touches::joint(contact)];
        integrals[0] += weight * friction * speed;
        integrals[1] += weight * speed.abs();
        integrals[2] += weight * normal * speed.abs();
    }
}

fn sum(one: Integrals, other: Integrals) -> Integrals {
    std::array::from_fn(|k| one[k] + other[k])
}

/// The integrals of each joint from `start` to `end` [s] within the last step, piece by piece between the `kinks`.
fn integrated(run: &mut Examined<'_>, kinks: &[f64; MAX_KINKS], [start, end]: [f64; 2]) -> [Integrals; JOINTS] {
    let mut sums = [[0.0; 3]; JOINTS];
    let mut from = start;
    for to in kinks.iter().copied().filter(|kink| (start..end).contains(kink)).chain([end]) {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        for (point, weight) in GAUSS.iter().flat_map(|&(point, weight)| [(-point, weight), (point, weight)]) {
            add(&mut sums, weight * half, &run.at(middle + half * point, SLIDING).rubbing);
        }
        from = to;
    }
    sums
}

/// [s] The time after a share of a span [s], which ends exactly where it does.
fn place([start, end]: [f64; 2], share: f64) -> f64 {
    if share < 1.0 { start + (end - start) * share } else { end }
}

/// Time [s] and value of the local maxima inside a step, given samples at Chebyshev's extrema of `span` [s] and the
/// function itself.
fn maxima(samples: &[f64; SAMPLES], span: [f64; 2], mut of: impl FnMut(f64) -> f64) -> [(f64, f64); MAX_MAXIMA] {
    let mut found = NOTHING.maxima[0];
    let sum = |weights: &[f64; SAMPLES]| weights.iter().zip(samples).map(|(weight, sample)| weight * sample).sum();
    let polynomial: [f64; SEARCHED + 1] = SEARCH.each_ref().map(sum);
    // Parabolas through three neighbours find tops between the outermost two, too.
    let tops = (1..SEARCHED).filter_map(|i| {
        let [before, here, after] = [i - 1, i, i + 1].map(|i| polynomial[i]);
        let (bend, slope) = (2.0 * here - before - after, 0.5 * (after - before));
        let rises = before < here || i == 1 && slope > -BESIDE * bend;
        let falls = here >= after || i == SEARCHED - 1 && slope < BESIDE * bend;
        (rises && falls).then(|| ((i as f64 + slope / bend) / SEARCHED as f64).clamp(0.0, 1.0))
    });
    for (mut top, found) in tops.zip(&mut found) {
        // From there on the tops of parabolas through the function itself.
        let time = |share: f64| place(span, share);
        let mut best = (time(top), of(time(top)));
        for step in NEAR {
            let middle = top.clamp(step, 1.0 - step);
            let here = if middle == top { best.1 } else { of(time(middle)) };
            let [before, after] = [of(time(middle - step)), of(time(middle + step))];
            let bend = 2.0 * here - before - after;
            let better =
                if bend > 0.0 { middle + (0.5 * step * (after - before) / bend).clamp(-step, step) } else { top };
            let value = of(time(better));
            if value > best.1 {
                (top, best) = (better, (time(better), value));
            }
        }
        *found = best;
    }
    found
}

/// Weights of samples at Chebyshev's extrema of [0, 1] in the polynomial through them, at `s` (barycentric formula, J.-P.
/// Berrut, L. N. Trefethen, SIAM Review 46, 2004, eq. 5.4).
const fn weights_at(s: f64) -> [f64; SAMPLES] {
    let (mut weights, mut sum) = ([0.0; SAMPLES], 0.0);
    let mut k = 0;
    while k < SAMPLES {
        let distance = s - PLACES[k];
        if distance == 0.0 {
            let mut one = [0.0; SAMPLES];
            one[k] = 1.0;
            return one;
        }
        let ends = if k == 0 || k == SAMPLES - 1 { 0.5 } else { 1.0 };
        weights[k] = if k % 2 == 0 { ends } else { -ends } / distance;
        sum += weights[k];
        k += 1;
    }
    k = 0;
    while k < SAMPLES {
        weights[k] /= sum;
        k += 1;
    }
    weights
}

/// The zero of a function in a bracket, with the values `before` and `after` at its ends.
fn zero([low, high]: [f64; 2], [before, after]: [f64; 2], mut of: impl FnMut(f64) -> f64) -> f64 {
    let sign = before.signum();
    root::falling(low, high, sign * before, sign * after, RESOLUTION * (high - low), |t| sign * of(t))
}

/// Where a condition that holds at the start of a bracket, and not at its end, ceases to hold.
fn halved([mut low, mut high]: [f64; 2], mut holds: impl FnMut(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn samples(of: impl Fn(f64) -> f64) -> [f64; SAMPLES] {
        PLACES.map(|place| of(2.0 + 0.5 * place))
    }

    #[test]
    fn a_polynomial_of_degree_eight_is_searched_exactly() {
        for (k, place) in PLACES.iter().enumerate() {
            let wanted = (k as f64 * PI / 16.0).sin().powi(2);
            assert!((place - wanted).abs() < 1e-15, "{place} is not {wanted}");
        }
        for power in 0..SAMPLES as i32 {
            let samples = PLACES.map(|place| place.powi(power));
            for (i, weights) in SEARCH.iter().enumerate() {
                let found: f64 = weights.iter().zip(samples).map(|(weight, sample)| weight * sample).sum();
                let wanted = (i as f64 / SEARCHED as f64).powi(power);
                assert!((found - wanted).abs() < 1e-14, "{found} is not {wanted}: power {power}, point {i}");
            }
        }
    }

    #[test]
    fn the_samples_integrate_degree_eight() {
        for power in 0..SAMPLES as i32 {
            let weight = |sample: usize| WEIGHTS[sample.min(SAMPLES - 1 - sample)];
            let sum: f64 = (0..SAMPLES).map(|sample| weight(sample) * PLACES[sample].powi(power)).sum();
            assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-15, "{sum}: power {power}");
        }
    }

    #[test]
    fn a_blow_inside_a_step_has_its_largest_force() {
        // Two humps between times 2 and 2.5.
        let force = |t: f64| 3.0 + (25.0 * (t - 2.0)).sin() * (1.0 + t);
        let found = maxima(&samples(force), [2.0, 2.5], force);
        let times: Vec<f64> = found.iter().map(|(t, _)| *t).filter(|t| t.is_finite()).collect();
        assert_eq!(times.len(), 2, "{found:?}");
        for (time, value) in found.into_iter().take(2) {
            assert_eq!(value, force(time));
            let around = [-1e-3, 1e-3].map(|step| force(time + step));
            assert!(around[0] < value && around[1] < value, "{time}");
            let slope = (force(time + 1e-6) - force(time - 1e-6)) / 2e-6;
            // F″ is 2 000: the place is known to 1e-6, the value to 1e-9.
            assert!(slope.abs() < 2e-3, "{time}: {slope}");
        }
    }

    #[test]
    fn a_top_beside_an_end_of_the_step_is_found() {
        // The first grid point inside is 0.0104 from the end.
        for top in [2.0001, 2.002, 2.005, 2.0104, 2.4896, 2.495, 2.498, 2.4999] {
            let force = |t: f64| 5.0 + (8.0 * (t - top)).cos();
            let found = maxima(&samples(force), [2.0, 2.5], force);
            let largest = found.iter().map(|(_, value)| *value).fold(0.0, f64::max);
            assert!((largest - 6.0).abs() < 1e-12, "{top}: {largest}");
            assert!(found.iter().all(|(time, _)| time.is_infinite() || (2.0..=2.5).contains(time)), "{found:?}");
        }
        for outside in [1.999, 2.501] {
            let force = |t: f64| 5.0 + (8.0 * (t - outside)).cos();
            let found = maxima(&samples(force), [2.0, 2.5], force);
            let ends = force(2.0).max(force(2.5));
            assert!(found.iter().all(|(_, value)| *value <= ends), "{found:?}");
        }
    }

    #[test]
    fn what_only_rises_has_no_maximum_inside() {
        let found = maxima(&samples(f64::exp), [2.0, 2.5], f64::exp);
        assert!(found.iter().all(|(t, _)| t.is_infinite()));
    }

    #[test]
    fn six_points_integrate_degree_eleven() {
        let sum: f64 = GAUSS.iter().map(|(x, weight)| 2.0 * weight * x.powi(10)).sum();
        assert!((sum - 2.0 / 11.0).abs() < 1e-15, "{sum}");
    }

    #[test]
    fn a_zero_is_found_to_its_resolution_by_few_evaluations() {
        let mut evaluations = 0;
        let found = zero([0.0, 2.0], [-2.0, 2.0], |x| {
            evaluations += 1;
            x * x - 2.0
        });
        assert!(evaluations <= 8, "{evaluations}");
        assert!((found - 2.0f64.sqrt()).abs() <= 2.0 * RESOLUTION, "{found}");
    }
}
