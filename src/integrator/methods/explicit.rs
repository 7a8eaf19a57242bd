//! Explicit Runge–Kutta methods: the stages k_i = f(t + c_i·h, y + h·Σ a_ij·k_j) of one step.
//!
//! One loop serves all tableaux and any number of states. The sums are computed for four or eight states together.

use crate::integrator::method::{Attempt, ERROR_SHARE, Method, Properties};
use crate::integrator::state::StepPoint;
use crate::integrator::system::{MAX_STATES, StateLayout, System};
use crate::integrator::tableau::{MAX_STAGES, Tableau};
use crate::math::{Fused, larger};
use wide::f64x4;

/// Smallest number of states that are summed together.
const FOUR: usize = 4;
/// Number of states that are summed together where possible: it halves the overhead of the loop over the stages.
const EIGHT: usize = 2 * FOUR;
/// Initial value of the error sums.
static ZEROS: [f64; MAX_STATES] = [0.0; MAX_STATES];

/// An explicit Runge-Kutta method.
#[derive(Clone, Debug)]
pub struct Explicit {
    tableau: &'static Tableau,
    properties: Properties,
    /// Rates at the stages, one stage after the other, and padding for reads of several numbers at a time.
    k: Vec<f64>,
    /// The first stage after stage 0 that an error estimate weighs; 0 without an estimate.
    weighted: usize,
    /// Nodes of the stages over the node of stage `weighted`.
    shares: [f64; MAX_STAGES],
}

impl Explicit {
    /// The method of `tableau` for `states` states.
    pub fn new(tableau: &'static Tableau, states: usize) -> Self {
        let weighted = tableau.first_weighted_stage();
        let properties = Properties {
            name: tableau.name,
            order: tableau.order,
            adaptive: weighted != 0,
            coarse: tableau.coarse_error.is_some(),
            locates: tableau.locates,
            error_power: tableau.error_power,
            interpolates: true,
            gives_end: tableau.first_same_as_last,
            predicts: false,
            keeps_length: false,
            error_share: ERROR_SHARE,
            others: &[],
        };
        let k = vec![0.0; tableau.stages * states + EIGHT];
        Self { tableau, properties, k, weighted, shares: tableau.c.map(|node| node / tableau.c[weighted]) }
    }

    /// See [`Method::properties`].
    pub fn properties(&self) -> &Properties {
        &self.properties
    }

    /// Step times the fastest rate that the last step reveals, for a method whose last two stages are at the same
    /// instant: the difference of their rates over the difference of their states (E. Hairer, G. Wanner, Solving
    /// Ordinary Differential Equations II, IV.2, on stiffness detection).
    pub fn stiffness(&self, layout: StateLayout, scales: &[f64]) -> f64 {
        let Self { tableau, k, .. } = self;
        let n = layout.states;
        let [before, last] = [tableau.stages - 2, tableau.stages - 1];
        let (mut rates, mut states) = (0.0, 0.0);
        for (i, scale) in scales.iter().enumerate().take(layout.weighted) {
            let weights = tableau.a[last].iter().zip(&tableau.a[before]).map(|(last, before)| last - before);
            let state: f64 = weights.take(last).enumerate().map(|(j, weight)| weight * k[j * n + i]).sum();
            rates += ((k[last * n + i] - k[before * n + i]) / scale).powi(2);
            states += (state / scale).powi(2);
        }
        // The sums of states lack the factor h.
        (rates / states).sqrt()
    }
}

impl<D: Copy> Method<D> for Explicit {
    fn properties(&self) -> &Properties {
        &self.properties
    }

    fn attempt(
        &mut self,
        system: &dyn System<Discrete = D>,
        start: &StepPoint<D>,
        h: f64,
        end: &mut StepPoint<D>,
        attempt: &mut Attempt,
    ) -> u64 {
        let Self { tableau, properties, k, weighted, shares } = self;
        let n = start.y.len();
        let inner = tableau.inner_stages();
        k[..n].copy_from_slice(&start.rates);
        // Without states there is nothing to integrate; event functions remain.
        if n > 0 && !system.stages(tableau, &start.discrete, start.t, &start.y, h, &mut k[..tableau.stages * n]) {
            for i in 1..inner {
                write_sums(&mut end.y, &start.y, h, &tableau.a[i][..i], k);
                system.rates(&start.discrete, start.t + tableau.c[i] * h, &end.y, &mut k[i * n..][..n]);
            }
        }
        write_sums(&mut end.y, &start.y, h, &tableau.b[..inner], k);
        if tableau.first_same_as_last {
            let StepPoint { y, rates, .. } = end;
            system.rates_and_event_functions(&start.discrete, start.t + h, y, rates, &mut attempt.events);
            k[inner * n..][..n].copy_from_slice(rates);
        }
        if properties.adaptive {
            write_sums(&mut attempt.error, &ZEROS, h, &tableau.error[..tableau.stages], k);
            if let Some(weights) = &tableau.coarse_error {
                write_sums(&mut attempt.coarse_error, &ZEROS, h, &weights[..tableau.stages], k);
            }
            write_unseen(&mut attempt.unseen, h, &shares[..*weighted], k);
        }
        if n > 0 { tableau.stages as u64 - 1 } else { u64::from(tableau.first_same_as_last) }
    }
}

/// The first four numbers of a list; zeros if the list is shorter.
#[inline(always)]
fn four(list: &[f64]) -> f64x4 {
    list.first_chunk().map_or(f64x4::ZERO, |four| f64x4::new(*four))
}

/// a·b + c.
#[inline(always)]
fn multiply_add(a: f64x4, b: f64x4, c: f64x4) -> f64x4 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

/// Writes y + h·Σ weight_j·k_j of every state; zero weights are skipped. The rates of the last stage are added last and
/// one by one, as they were written: only they have to be waited for, and they can be read from the processor's store
/// buffer.
#[inline(always)]
fn write_sums(sums: &mut [f64], y: &[f64], h: f64, weights: &[f64], k: &[f64]) {
    let (n, last) = (sums.len(), weights.len() - 1);
    let (weights, weight_of_last) = (&weights[..last], h * weights[last]);
    let (y, last) = (&y[..n], &k[last * n..][..n]);
    let mut at = 0;
    while at + FOUR < n {
        let slopes = slopes::<2>(weights, &k[at..], n).map(|slope| (f64x4::splat(h) * slope).to_array());
        add(&mut sums[at..], &y[at..], slopes.as_flattened(), weight_of_last, &last[at..]);
        at += EIGHT;
    }
    if at < n {
        let [slope] = slopes::<1>(weights, &k[at..], n);
        let changes = (f64x4::splat(h) * slope).to_array();
        add(&mut sums[at..], &y[at..], &changes, weight_of_last, &last[at..]);
    }
}

/// Writes y + change + weight·rate of each state.
#[inline(always)]
fn add(sums: &mut [f64], y: &[f64], changes: &[f64], weight: f64, rates: &[f64]) {
    let all = sums.iter_mut().zip(y).zip(changes).zip(rates);
    if weight == 0.0 {
        all.for_each(|(((sum, y), change), _)| *sum = y + change);
    } else {
        all.for_each(|(((sum, y), change), rate)| *sum = y + weight.multiply_add(*rate, *change));
    }
}

/// Σ weight_j·k_j for `FOURS` groups of four states; the rates of successive stages are `n` places apart.
#[inline(always)]
fn slopes<const FOURS: usize>(weights: &[f64], k: &[f64], n: usize) -> [f64x4; FOURS] {
    let mut slopes = [f64x4::ZERO; FOURS];
    for (j, weight) in weights.iter().enumerate() {
        if *weight != 0.0 {
            let (rates, _) = k[j * n..][..FOUR * FOURS].as_chunks::<FOUR>();
            for (slope, rates) in slopes.iter_mut().zip(rates) {
                *slope = multiply_add(f64x4::splat(*weight), f64x4::new(*rates), *slope);
            }
        }
    }
    slopes
}

/// Writes the deviation of the early stages, which no error estimate sees (see [`Attempt::unseen`]). If a step is far
/// too long, a force that sets in early can throw all later stages out of its reach. They agree with each other, and
/// the estimate is small although the step missed the force. Only the early stages reveal it. `shares` are the nodes of
/// the stages before the first weighted stage over its node.
fn write_unseen(unseen: &mut [f64], h: f64, shares: &[f64], k: &[f64]) {
    let weighted = shares.len();
    let n = unseen.len();
    if weighted <= 1 {
        unseen.fill(0.0);
        return;
    }
    for (at, unseen) in unseen.chunks_mut(FOUR).enumerate() {
        let stage = |j: usize| four(&k[j * n + FOUR * at..]);
        let (first, late) = (stage(0), stage(weighted));
        let usual = f64x4::splat(0.5) * larger(first.abs(), late.abs());
        let mut most = f64x4::ZERO;
        for (j, share) in shares.iter().enumerate().skip(1) {
            let apart = (stage(j) - first - f64x4::splat(*share) * (late - first)).abs();
            most = larger(most, f64x4::splat(h) * (apart - usual));
        }
        for (unseen, most) in unseen.iter_mut().zip(most.to_array()) {
            *unseen = most;
        }
    }
}
