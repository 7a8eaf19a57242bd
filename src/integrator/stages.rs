//! The stages of one step: k_i = f(t + c_i·h, y + h·Σ a_ij·k_j).

use super::problem::{Extent, Problem};
use super::tableau::{Method, STAGES};

/// An attempted step.
pub struct Attempt<const N: usize> {
    /// The state at the step's end.
    pub y: [f64; N],
    /// Its rates, where the last stage gives them.
    pub rates: Option<[f64; N]>,
    /// The step's error in every state.
    pub error: [f64; N],
    /// A second estimate, where the method has one.
    pub coarse_error: Option<[f64; N]>,
    /// What early stages saw that no error estimate weighs: by how much h times their rates leaves
    /// the line between the first stage and the first that is weighed, beyond half of those.
    pub unseen: [f64; N],
}

/// Attempts a step of `h` from `y` at `t`, whose rates are `rates`.
#[inline(never)] // one copy for steps, landings and rewinds
pub fn attempt<const N: usize, M: Method, P: Problem<N> + ?Sized>(
    problem: &P,
    modes: &P::Modes,
    t: f64,
    y: &[f64; N],
    rates: &[f64; N],
    h: f64,
) -> Attempt<N> {
    let mut k = [[0.0; N]; STAGES];
    k[0] = *rates;
    let mut stages = Stages { problem, modes, t, y, h, k, states: Extent::of(problem).states };
    // A stage beyond the method's own is not compiled.
    stages.evaluate::<M, 1>();
    stages.evaluate::<M, 2>();
    stages.evaluate::<M, 3>();
    stages.evaluate::<M, 4>();
    stages.evaluate::<M, 5>();
    stages.evaluate::<M, 6>();
    stages.evaluate::<M, 7>();
    stages.evaluate::<M, 8>();
    stages.evaluate::<M, 9>();
    stages.evaluate::<M, 10>();
    stages.evaluate::<M, 11>();
    stages.finish::<M>()
}

struct Stages<'a, const N: usize, P: Problem<N> + ?Sized> {
    problem: &'a P,
    modes: &'a P::Modes,
    t: f64,
    y: &'a [f64; N],
    h: f64,
    k: [[f64; N]; STAGES],
    states: usize,
}

impl<const N: usize, P: Problem<N> + ?Sized> Stages<'_, N, P> {
    #[inline(always)]
    fn evaluate<M: Method, const I: usize>(&mut self) {
        let tableau = const { &M::TABLEAU };
        if I < tableau.stages {
            let mut y = *self.y;
            self.add(&mut y, &tableau.a[I], I);
            let t = self.t + tableau.c[I] * self.h;
            self.problem.rates(self.modes, t, &y, &mut self.k[I]);
        }
    }

    #[inline(always)]
    fn finish<M: Method>(&self) -> Attempt<N> {
        let tableau = const { &M::TABLEAU };
        let stages = tableau.stages;
        let mut y = *self.y;
        let mut error = [0.0; N];
        self.add(&mut y, &tableau.b, stages);
        self.add(&mut error, &tableau.error, stages);
        let coarse_error = tableau.coarse_error.as_ref().map(|weights| {
            let mut error = [0.0; N];
            self.add(&mut error, weights, stages);
            error
        });
        let rates = tableau.first_same_as_last.then(|| self.k[stages - 1]);
        Attempt { y, rates, error, coarse_error, unseen: self.unseen::<M>() }
    }

    /// A force that sets in early throws the stages after it out of its reach if the step is far too
    /// long; they see nothing, agree with each other, and the estimate is small for a step that missed
    /// everything. The early stages themselves give it away.
    #[inline(always)]
    fn unseen<M: Method>(&self) -> [f64; N] {
        let tableau = const { &M::TABLEAU };
        let weighed = const { M::TABLEAU.first_weighed_stage() };
        let mut unseen = [0.0; N];
        for j in 1..weighed {
            let share = tableau.c[j] / tableau.c[weighed];
            for (i, unseen) in unseen.iter_mut().enumerate().take(self.states) {
                let (first, late) = (self.k[0][i], self.k[weighed][i]);
                let apart = (self.k[j][i] - first - share * (late - first)).abs();
                *unseen = f64::max(*unseen, self.h * (apart - 0.5 * first.abs().max(late.abs())));
            }
        }
        unseen
    }

    /// Adds h·Σ weight_j·k_j; a weight of zero costs nothing.
    #[inline(always)]
    fn add(&self, y: &mut [f64; N], weights: &[f64; STAGES], count: usize) {
        for (i, y) in y.iter_mut().enumerate().take(self.states) {
            let mut sum = 0.0;
            for (weight, k) in weights.iter().zip(&self.k).take(count) {
                if *weight != 0.0 {
                    sum += weight * k[i];
                }
            }
            *y += self.h * sum;
        }
    }
}
