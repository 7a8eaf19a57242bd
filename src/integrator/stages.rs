//! The stages of one step: k_i = f(t + c_i·h, y + h·Σ a_ij·k_j).

use super::memory::Front;
use super::problem::{Extent, GUARDS, Guard, Problem};
use super::tableau::{Explicit, STAGES, Tableau};
use crate::math::{Fused, Real, Row, each};

/// Up to so many states, what one stage hands on to the next stays in registers, or in places of its own. In an array it
/// would be written in other portions than it is read in, and wait to have left the processor's store buffer.
pub const IN_REGISTERS: usize = 14;

/// An attempted step, and room to make it.
pub struct Attempt<const N: usize> {
    /// Rates at the stages.
    k: [[f64; N]; STAGES],
    /// Rates at the nodes of a step that is made as a block, see [`block`](super::block).
    pub nodes: [Row; N],
    /// The state at the step's end.
    pub y: [f64; N],
    /// Its rates, where the last stage gives them (see [`Tableau::first_same_as_last`]); otherwise once they are taken.
    pub rates: [f64; N],
    /// The guards there, as the rates.
    pub guards: [Guard; GUARDS],
    /// The step's error in every state.
    pub error: [f64; N],
    /// A second estimate, where the method has one.
    pub coarse_error: [f64; N],
    /// What early stages saw that no error estimate weighs: by how much h times their rates leaves
    /// the line between the first stage and the first that is weighed, beyond half of those.
    pub unseen: [f64; N],
}

impl<const N: usize> Attempt<N> {
    /// None made yet.
    pub const NONE: Self = Self {
        k: [[0.0; N]; STAGES],
        nodes: [Row::ZERO; N],
        y: [0.0; N],
        rates: [0.0; N],
        guards: [Guard { value: 0.0, rate: 0.0 }; GUARDS],
        error: [0.0; N],
        coarse_error: [0.0; N],
        unseen: [0.0; N],
    };

    /// Attempts a step of `h` from `start` by an explicit method.
    #[inline(never)] // one copy for steps, landings and rewinds
    pub fn explicitly<E: Explicit, P: Problem<N> + ?Sized>(&mut self, problem: &P, start: &Front<N, P::Modes>, h: f64) {
        self.k[0] = start.rates;
        let mut stages = Stages { problem, start, h, states: Extent::of(problem).states, made: self };
        if N <= IN_REGISTERS {
            problem.stages(const { &E::TABLEAU }, &start.modes, start.t, &start.y, h, &mut stages.made.k);
        } else {
            // A stage beyond the method's own is not compiled.
            stages.evaluate::<E, 1>();
            stages.evaluate::<E, 2>();
            stages.evaluate::<E, 3>();
            stages.evaluate::<E, 4>();
            stages.evaluate::<E, 5>();
            stages.evaluate::<E, 6>();
            stages.evaluate::<E, 7>();
            stages.evaluate::<E, 8>();
            stages.evaluate::<E, 9>();
            stages.evaluate::<E, 10>();
            stages.evaluate::<E, 11>();
        }
        stages.finish::<E>();
    }

    /// The fastest rate that shows in a step made by a method whose last two stages are at the same instant, times the
    /// step: how far their rates are apart over how far their states are (E. Hairer, G. Wanner, Solving Ordinary
    /// Differential Equations II, IV.2, on stiffness detection).
    pub fn stiffness<E: Explicit>(&self, extent: Extent, scales: &[f64; N]) -> f64 {
        let tableau = const { &E::TABLEAU };
        let [before, last] = [tableau.stages - 2, tableau.stages - 1];
        let (mut rates, mut states) = (0.0, 0.0);
        for (i, scale) in scales.iter().enumerate().take(extent.weighed) {
            let weights = tableau.a[last].iter().zip(&tableau.a[before]).map(|(last, before)| last - before);
            let state: f64 = weights.zip(&self.k[..last]).map(|(weight, k)| weight * k[i]).sum();
            rates += ((self.k[last][i] - self.k[before][i]) / scale).powi(2);
            states += (state / scale).powi(2);
        }
        // By h less than the states are apart.
        (rates / states).sqrt()
    }
}

struct Stages<'a, const N: usize, P: Problem<N> + ?Sized> {
    problem: &'a P,
    start: &'a Front<N, P::Modes>,
    h: f64,
    states: usize,
    made: &'a mut Attempt<N>,
}

impl<const N: usize, P: Problem<N> + ?Sized> Stages<'_, N, P> {
    #[inline(always)]
    fn evaluate<E: Explicit, const I: usize>(&mut self) {
        let tableau = const { &E::TABLEAU };
        if I < tableau.inner_stages() {
            let Self { problem, start, h, states, made } = self;
            let (earlier, later) = made.k.split_at_mut(I);
            combine(&mut made.y, &start.y, *h, &tableau.a[I], earlier, *states);
            problem.rates(&start.modes, start.t + tableau.c[I] * *h, &made.y, &mut later[0]);
        }
    }

    #[inline(always)]
    fn finish<E: Explicit>(&mut self) {
        let tableau = const { &E::TABLEAU };
        let Self { problem, start, h, states, made } = self;
        let Attempt { k, y, rates, guards, .. } = &mut **made;
        combine(y, &start.y, *h, &tableau.b, &k[..tableau.inner_stages()], *states);
        if tableau.first_same_as_last {
            problem.rates_and_guards(&start.modes, start.t + *h, y, rates, guards);
            k[tableau.stages - 1] = *rates;
        }
        let k = &made.k[..tableau.stages];
        combine(&mut made.error, &[0.0; N], *h, &tableau.error, k, *states);
        if let Some(weights) = &tableau.coarse_error {
            combine(&mut made.coarse_error, &[0.0; N], *h, weights, k, *states);
        }
        self.see::<E>();
    }

    /// A force that sets in early throws the stages after it out of its reach if the step is far too
    /// long; they see nothing, agree with each other, and the estimate is small for a step that missed
    /// everything. The early stages themselves give it away.
    #[inline(always)]
    fn see<E: Explicit>(&mut self) {
        let tableau = const { &E::TABLEAU };
        let weighed = const { E::TABLEAU.first_weighed_stage() };
        let Attempt { k, unseen, .. } = &mut *self.made;
        for (i, unseen) in unseen.iter_mut().enumerate().take(self.states) {
            let (first, late) = (k[0][i], k[weighed][i]);
            let usual = 0.5 * first.abs().max(late.abs());
            *unseen = 0.0;
            for (early, node) in k.iter().zip(&tableau.c).take(weighed).skip(1) {
                let share = node / tableau.c[weighed];
                let apart = (early[i] - first - share * (late - first)).abs();
                *unseen = f64::max(*unseen, self.h * (apart - usual));
            }
        }
    }
}

/// `sum` = `y` + h·Σ weight_j·k_j; a weight of zero costs nothing. The last rates are added last: what they wait for is
/// theirs alone.
#[inline(always)]
fn combine<const N: usize>(
    sum: &mut [f64; N],
    y: &[f64; N],
    h: f64,
    weights: &[f64; STAGES],
    k: &[[f64; N]],
    states: usize,
) {
    let last = k.len() - 1;
    let weight_of_last = h * weights[last];
    for i in 0..states {
        let mut slope = 0.0;
        for (weight, k) in weights.iter().zip(&k[..last]) {
            if *weight != 0.0 {
                slope = weight.times_plus(k[i], slope);
            }
        }
        let mut change = h * slope;
        if weights[last] != 0.0 {
            change = weight_of_last.times_plus(k[last][i], change);
        }
        sum[i] = y[i] + change;
    }
}

/// [`Problem::stages`] of a problem with these `rates` of a state at a time, which are compiled into the loop over stages.
#[inline(always)]
pub fn in_registers<const N: usize>(
    tableau: &Tableau,
    t: f64,
    y: &[f64; N],
    h: f64,
    k: &mut [[f64; N]; STAGES],
    rates: impl Fn(f64, &[f64; N], &mut [f64; N]),
) {
    if N > IN_REGISTERS {
        return; // nothing is compiled
    }
    let mut last = k[0];
    for i in 1..tableau.inner_stages().min(STAGES) {
        let weights = &tableau.a[i];
        let mut slope = [0.0; N];
        for (weight, k) in weights.iter().zip(k.iter()).take(i - 1) {
            each!(true, m < N => {
                slope[m] = weight.times_plus(k[m], slope[m]);
            });
        }
        // The last rates are added last, as in `combine`.
        let weight_of_last = h * weights[i - 1];
        let mut at = *y;
        each!(true, m < N => {
            at[m] += weight_of_last.times_plus(last[m], h * slope[m]);
        });
        rates(t + tableau.c[i] * h, &at, &mut last);
        k[i] = last;
    }
}
