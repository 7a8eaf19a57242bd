//! Selects the kind of steps of the automatic method: a block, an explicit step, or an implicit step in stiff motion.
//!
//! A contact that closes slowly has a damping that grows with the inverse of the approach speed. Under a load the
//! contact stays closed and creeps, and its stability bounds the steps of an explicit method long after its transient
//! has decayed. An implicit method has no such bound, but its steps cost more. It pays only while its steps are longer by
//! the ratio of the costs.
//!
//! Stiffness is suspected where an explicit step is no longer short against the fastest motion, as two stages at the same
//! instant reveal (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, IV.2, on stiffness detection). The
//! implicit method is then tried. A trial that does not pay ends after a few steps, and the next check waits longer. Between two
//! checks, early ones see whether explicit steps are near their stability bound, where an implicit step is longer and events
//! have often changed the motion since the last trial. No early check comes before explicit steps have done several times the
//! work that the last trial wasted.
//!
//! Explicit steps need not be at their stability bound for a trial to pay: at tight tolerances accuracy bounds them first, and
//! steps of a higher order are longer. Where the rates are not cheap, implicit steps are therefore compared with explicit ones
//! as long as those before the trial, in times of the fastest motion. Where they are cheap, a trial costs more than it may
//! gain: the comparison is with steps at the bound.
//!
//! A block is the cheapest kind where the system suits it, and the first to be short in fast motion: its corrector converges
//! slowly there. The implicit method, whose stages are evaluated together like those of a block, is then tried and kept while
//! its steps are longer than blocks by the ratio of the costs, for a series at most. If they are not, the explicit method is
//! tried in the same way.
//!
//! Whether steps pay is kept as a balance: what a step of the series gains over steps of the other kind in the same time, for
//! all the work that its attempts took.

use crate::integrator::method::{MethodKind, StepWork};
use crate::integrator::system::{Jacobian, MAX_STATES, StateLayout};

/// Number of accepted steps between two checks after a change that paid.
const MIN_CHECK_INTERVAL: u32 = 32;
/// Maximum number of accepted steps between two checks, after changes that did not pay.
const MAX_CHECK_INTERVAL: u32 = 256;
/// Number of explicit steps between two looks for steps near the stability bound.
const EARLY_CHECK_INTERVAL: u32 = 16;
/// Explicit steps before the next early look, for each explicit step that the last trial wasted.
const PATIENCE: f64 = 8.0;
/// Share of the stability bound from which on a step is near it: two stages reveal less than the fastest rate.
const NEAR_BOUND: f64 = 0.4;
/// Share of the stability bound at which explicit steps begin after a series of implicit ones.
const STABLE_SHARE: f64 = 0.6;
/// Length of a block times the fastest rate above which the implicit method is tried.
const SUSPECTED_REACH: f64 = 0.3;
/// Length of usual blocks and explicit steps times the fastest rate, at least. Steps that began to grow before a trial are no
/// measure of those that a trial is instead of.
const USUAL_REACH: f64 = 0.8;
/// Weight of the last explicit step in their usual length.
const WEIGHT: f64 = 0.125;
/// Cost of an explicit step in blocks, as measured with one clearance in a pin, rod rigid and flexible.
const EXPLICIT_COST_IN_BLOCKS: f64 = 0.85;
/// In a system that suits blocks, a series of explicit steps ends after this many steps, to check whether it still
/// pays.
const EXPLICIT_SERIES: u32 = 256;
/// A series of implicit steps ends after this many steps, to check whether another kind would do: a flexible rod in fast
/// motion has rates that no step follows, and blocks that could be longer.
const IMPLICIT_SERIES: u32 = 256;
/// A trial, and a series of steps that has paid, ends where its balance falls below this. A step changes the balance by
/// what it gains over a step of the other kind, by 1 at most.
const OVERDRAFT: f64 = -2.0;
/// Largest balance of a series of steps that has paid, and the most that a step makes up of wasted work, in times its own.
const CREDIT: f64 = 6.0;
/// A step of a trial that does not pay yet costs nothing if the next step is longer by this factor.
const GROWING: f64 = 1.5;
/// A series of fewer steps did not pay.
const MIN_PAID_STEPS: u32 = 10;
/// The golden ratio less 1.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// When implicit steps are tried in place of explicit ones, and what they are compared with.
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    /// Stability bound of the explicit method: product of step and fastest rate.
    pub bound: f64,
    /// Product of explicit step and fastest rate above which stiffness is suspected.
    pub suspected: f64,
    /// The explicit steps that implicit ones are instead of have at least this product.
    pub least_reach: f64,
    /// Cost of an evaluation of an implicit step, with its share of the linear algebra, in explicit steps.
    pub cost: f64,
}

impl Terms {
    /// The terms of a system with `positions` positions. The costs are as measured with three to twelve positions where rates
    /// are cheap and with 17 to 20 where they are not. With fewer, those of rates that are not cheap are up to a third less
    /// than measured: a trial that pays in evaluations, which the limit of work counts, may take a little more time.
    pub fn new(bound: f64, positions: usize, rates_are_cheap: bool) -> Self {
        let positions = positions as f64;
        if rates_are_cheap {
            // What two stages reveal is less than the bound where the fastest motion is at rest.
            Self { bound, suspected: 0.3 * bound, least_reach: bound, cost: 0.08 + 0.033 * positions }
        } else {
            Self { bound, suspected: 0.1 * bound, least_reach: USUAL_REACH, cost: 0.1 + 0.001 * positions * positions }
        }
    }
}

/// The kind of the next step and the evidence for a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StiffnessSwitch {
    /// The kind of the next step.
    pub kind: MethodKind,
    /// Number of accepted steps since the last check, or since a trial began.
    pub steps: u32,
    /// Number of steps between two checks.
    pub check_interval: u32,
    /// What the last steps have gained over steps of another kind.
    pub balance: f64,
    /// [s] Length of the last block before a series of other steps; 0 if there was none.
    pub block: f64,
    /// Usual length of the steps before a series of implicit steps times the fastest rate there; 0 if it is not known yet.
    pub reach: f64,
    /// [s] Usual length of the last explicit steps; 0 if there were none.
    pub explicit: f64,
    /// Work of the last series of implicit steps less that of explicit steps in the same time, in explicit steps.
    pub waste: f64,
}

impl StiffnessSwitch {
    /// Start of a non-stiff motion.
    pub const NON_STIFF: Self = Self {
        kind: MethodKind::Explicit,
        steps: 0,
        check_interval: MIN_CHECK_INTERVAL,
        balance: 0.0,
        block: 0.0,
        reach: 0.0,
        explicit: 0.0,
        waste: 0.0,
    };
    /// Start of a motion of a system that suits blocks.
    pub const BLOCKS: Self = Self { kind: MethodKind::Block, ..Self::NON_STIFF };

    /// Whether a run can have produced this state.
    pub fn is_sound(&self) -> bool {
        (MIN_CHECK_INTERVAL..=MAX_CHECK_INTERVAL).contains(&self.check_interval)
            && self.balance > OVERDRAFT
            && self.balance <= CREDIT
            && self.block.is_finite()
            && self.explicit.is_finite()
            && self.explicit >= 0.0
            && self.reach >= 0.0
            && self.waste.is_finite()
    }

    /// Records an accepted block of length `h` [s]. `fastest` computes the fastest rate [1/s] at its end and is called
    /// only when a check is due.
    pub fn after_block(&mut self, h: f64, fastest: impl FnOnce() -> f64) {
        if self.check_is_due(self.check_interval) {
            let reach = h * fastest();
            if reach > SUSPECTED_REACH {
                let reach = reach.max(USUAL_REACH);
                *self = Self { kind: MethodKind::Implicit, block: h, reach, waste: 0.0, ..*self };
            }
        }
    }

    /// Records an accepted explicit step of length `h` [s]. `stiffness` computes its length times the fastest rate and is called
    /// only at a check, and at the early ones between two checks.
    pub fn after_explicit(&mut self, h: f64, terms: &Terms, stiffness: impl FnOnce() -> f64) {
        self.note_explicit(h);
        if self.suspicion(self.check_interval, terms, stiffness) == Some(true) {
            *self = Self { kind: MethodKind::Implicit, steps: 0, reach: 0.0, waste: 0.0, ..*self };
        }
    }

    /// Records an accepted explicit step of length `h` [s] in a system that suits blocks; otherwise as
    /// [`after_explicit`](Self::after_explicit).
    pub fn after_explicit_beside_blocks(&mut self, h: f64, terms: &Terms, stiffness: impl FnOnce() -> f64) {
        self.note_explicit(h);
        self.enter(h / (EXPLICIT_COST_IN_BLOCKS * self.block));
        match self.suspicion(EXPLICIT_SERIES, terms, stiffness) {
            Some(true) => {
                *self = Self { kind: MethodKind::Implicit, explicit: self.explicit, ..Self::NON_STIFF };
            }
            Some(false) => *self = Self::BLOCKS,
            None if self.balance <= OVERDRAFT => self.end_trial(Self::BLOCKS),
            None => {}
        }
    }

    /// Counts an explicit step. Whether stiffness is suspected, if a check is due; between two checks, `Some(true)` if the step
    /// is near the stability bound, and else `None`.
    fn suspicion(&mut self, check_interval: u32, terms: &Terms, stiffness: impl FnOnce() -> f64) -> Option<bool> {
        if self.check_is_due(check_interval) {
            return Some(stiffness() > terms.suspected);
        }
        let is_early =
            self.steps.is_multiple_of(EARLY_CHECK_INTERVAL) && f64::from(self.steps) >= PATIENCE * self.waste;
        let is_near = is_early && stiffness() > NEAR_BOUND * terms.bound;
        is_near.then_some(true)
    }

    /// Enters an explicit step of length `h` [s] into their usual length.
    fn note_explicit(&mut self, h: f64) {
        self.explicit = if self.explicit > 0.0 { self.explicit + WEIGHT * (h - self.explicit) } else { h };
    }

    /// Enters a step that is worth `gain` steps of another kind into the balance.
    fn enter(&mut self, gain: f64) {
        self.balance = (self.balance + (gain - 1.0).min(1.0)).min(CREDIT);
    }

    /// Counts a step and returns whether a check is due.
    fn check_is_due(&mut self, check_interval: u32) -> bool {
        self.steps = self.steps.saturating_add(1);
        let now = self.steps >= check_interval;
        if now {
            self.steps = 0;
        }
        now
    }

    /// Records an accepted implicit step of length `h` [s], which took the `work`; `fastest` is the fastest rate [1/s]. Returns
    /// the upper bound of the next step [s] if that is to be explicit.
    pub fn after_implicit(&mut self, h: f64, work: StepWork, terms: &Terms, fastest: f64) -> Option<f64> {
        let Terms { bound, least_reach, cost, .. } = *terms;
        self.steps = self.steps.saturating_add(1);
        if self.reach == 0.0 {
            let usual = (self.explicit * fastest).clamp(least_reach, bound);
            self.reach = if self.explicit > 0.0 { usual } else { bound };
        }
        let of_other = if self.block > 0.0 { EXPLICIT_COST_IN_BLOCKS } else { 1.0 };
        let work_in_steps = work.evaluations as f64 * cost * of_other;
        let gain = h * fastest / (work_in_steps * self.reach);
        self.waste += work_in_steps * (1.0 - gain).max(-CREDIT);
        let is_growing = self.steps < MIN_PAID_STEPS && work.next > GROWING * h;
        if gain > 1.0 || !is_growing {
            self.enter(gain);
        }
        if self.balance > OVERDRAFT && self.steps < IMPLICIT_SERIES {
            return None;
        }
        self.end_trial(Self { block: self.block, explicit: self.explicit, waste: self.waste, ..Self::NON_STIFF });
        Some(STABLE_SHARE * bound / fastest)
    }

    /// Records a step that was completed in `kind` after the intended kind had failed.
    pub fn hand_over(&mut self, kind: MethodKind) {
        self.steps = 0;
        self.end_trial(Self { kind, ..Self::NON_STIFF });
    }

    /// Ends a trial and continues as `next`. After a trial that did not pay, the next check comes later.
    fn end_trial(&mut self, next: Self) {
        let paid = self.steps >= MIN_PAID_STEPS;
        *self = Self {
            check_interval: if paid { MIN_CHECK_INTERVAL } else { (2 * self.check_interval).min(MAX_CHECK_INTERVAL) },
            ..next
        };
    }
}

/// [1/s] Estimate of the fastest rate of the motion near a state, from its Jacobian by power iteration on a vector
/// without pattern, whose signs are those of the `rates` there: a mirrored motion has the same rate. After an even number of
/// iterations an oscillation has returned to its phase.
pub fn fastest(jacobian: &Jacobian, layout: StateLayout, scales: &[f64], rates: &[f64]) -> f64 {
    let StateLayout { positions, weighted, .. } = layout;
    let next = |y: &mut [f64; MAX_STATES]| {
        let before = *y;
        for (i, y) in y.iter_mut().enumerate().take(weighted) {
            *y = if i < positions {
                before[positions + i]
            } else {
                jacobian.row(i)[..weighted].iter().zip(&before).map(|(slope, y)| slope * y).sum()
            };
        }
    };
    let square =
        |y: &[f64; MAX_STATES]| y.iter().zip(scales).take(weighted).map(|(y, scale)| (y / scale).powi(2)).sum::<f64>();
    let mut y = [0.0; MAX_STATES];
    for (i, ((y, scale), rate)) in y.iter_mut().zip(scales).zip(rates).enumerate() {
        *y = (scale * (0.5 + (GOLDEN * i as f64).fract())).copysign(*rate);
    }
    for _ in 0..2 {
        next(&mut y);
    }
    let before = square(&y);
    for _ in 0..4 {
        next(&mut y);
    }
    // 0 for a Jacobian of zeros.
    (square(&y) / before).sqrt().sqrt().sqrt().max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXTENT: StateLayout = StateLayout::second_order(4);

    const COSTLY: Terms = Terms { bound: 4.6, suspected: 0.46, least_reach: USUAL_REACH, cost: 0.146 };
    const CHEAP: Terms = Terms { suspected: 1.38, least_reach: 4.6, ..COSTLY };

    fn of(elastic: [[f64; 2]; 2], damped: [[f64; 2]; 2], scales: [f64; 4]) -> f64 {
        let mut jacobian = Jacobian::new(4);
        for i in 0..2 {
            jacobian.row_mut(i)[2 + i] = 1.0;
            for j in 0..2 {
                jacobian.row_mut(2 + i)[j] = -elastic[i][j];
                jacobian.row_mut(2 + i)[2 + j] = -damped[i][j];
            }
        }
        fastest(&jacobian, EXTENT, &scales, &[1.0; 4])
    }

    #[test]
    fn the_fastest_rate_is_that_of_the_fastest_motion_in_any_units() {
        let none = [[0.0; 2]; 2];
        for scales in [[1.0; 4], [1e-6, 1.0, 1e-3, 1e2], [1.0, 1e-6, 1e-4, 1e-4]] {
            let near = |found: f64, wanted: f64| {
                assert!(found > 0.5 * wanted && found < 2.0 * wanted, "{found:e}, not {wanted:e}");
            };
            near(of([[1e10, 0.0], [0.0, 1.0]], none, scales), 1e5);
            near(of([[1.0, 0.0], [0.0, 1e10]], [[1.0, 0.0], [0.0, 1e3]], scales), 1e5);
            near(of([[1e8, 0.0], [0.0, 1.0]], [[1e6, 0.0], [0.0, 1.0]], scales), 1e6);
            assert_eq!(of(none, none, scales), 0.0);
        }
    }

    /// The work of an implicit step that converges well and lets the next be as long.
    fn work(h: f64) -> StepWork {
        StepWork { evaluations: 15, next: h }
    }

    #[test]
    fn a_trial_that_does_not_pay_makes_the_next_wait_longer() {
        let mut switch = StiffnessSwitch::NON_STIFF;
        let trial = |switch: &mut StiffnessSwitch| {
            let steps = (1..2000).find(|_| {
                switch.after_explicit(9e-7, &COSTLY, || 1.0);
                switch.kind == MethodKind::Implicit
            });
            let ends = (1..2000).find(|_| switch.after_implicit(1e-7, work(1e-7), &COSTLY, 4e6).is_some());
            (steps, ends)
        };
        for check_interval in [32, 64, 128, 256, 256] {
            assert_eq!(trial(&mut switch), (Some(check_interval), Some(3)));
            assert!(switch.is_sound());
        }
        // One that paid for a while, and then no more.
        switch.kind = MethodKind::Implicit;
        let ends = (0..50).find(|step| {
            let h = if *step < 20 { 1e-3 } else { 1e-7 };
            switch.after_implicit(h, work(h), &COSTLY, 4e6).is_some()
        });
        assert_eq!(
            (ends, switch),
            (Some(28), StiffnessSwitch { explicit: 9e-7, waste: switch.waste, ..StiffnessSwitch::NON_STIFF })
        );
    }

    #[test]
    fn a_trial_goes_on_while_its_steps_grow_and_ends_sooner_where_attempts_fail() {
        let steps_of_trial = |work: StepWork| {
            let mut switch = StiffnessSwitch { kind: MethodKind::Implicit, ..StiffnessSwitch::NON_STIFF };
            (1..100).find(|_| switch.after_implicit(9e-6, work, &COSTLY, 1e6).is_some())
        };
        assert_eq!(steps_of_trial(StepWork { evaluations: 15, next: 9e-6 }), Some(19));
        assert_eq!(steps_of_trial(StepWork { evaluations: 60, next: 9e-6 }), Some(3));
        assert_eq!(steps_of_trial(StepWork { evaluations: 60, next: 18e-6 }), Some(12));
        assert_eq!(steps_of_trial(StepWork { evaluations: 12, next: 9e-6 }), None);
    }

    #[test]
    fn implicit_steps_are_compared_with_explicit_steps_as_long_as_those_before_them() {
        // A step of 4/ω costs 15·0.146 explicit steps: it pays if these are shorter than 1.83/ω.
        let last = |explicit: f64| {
            let mut switch = StiffnessSwitch::NON_STIFF;
            (0..32).for_each(|_| switch.after_explicit(explicit, &COSTLY, || 1.0));
            assert_eq!(switch.kind, MethodKind::Implicit);
            (1..100).find(|_| switch.after_implicit(4e-6, work(4e-6), &COSTLY, 1e6).is_some())
        };
        assert_eq!(last(1e-6), None);
        assert_eq!(last(2e-6), Some(24)); // 2/(1 − 1.83/2) steps
        assert_eq!(last(4e-6), Some(4)); // 2/(1 − 1.83/4) steps
        // Short steps are no measure.
        assert_eq!(last(1e-9), None);
        // Cheap rates: steps of 1/ω are not suspected, and those of 2/ω are taken for steps at the bound.
        let mut switch = StiffnessSwitch::NON_STIFF;
        (0..256).for_each(|_| switch.after_explicit(1e-6, &CHEAP, || 1.0));
        assert_eq!(switch, StiffnessSwitch { explicit: 1e-6, ..StiffnessSwitch::NON_STIFF });
        (0..32).for_each(|_| switch.after_explicit(2e-6, &CHEAP, || 1.5));
        assert_eq!(switch.kind, MethodKind::Implicit);
        assert_eq!((1..100).find(|_| switch.after_implicit(4e-6, work(4e-6), &CHEAP, 1e6).is_some()), Some(4));
    }

    #[test]
    fn steps_near_the_stability_bound_do_not_wait_for_the_next_check() {
        for check_interval in [32, 256] {
            let mut switch = StiffnessSwitch { check_interval, ..StiffnessSwitch::NON_STIFF };
            (0..15).for_each(|_| switch.after_explicit(1e-6, &CHEAP, || 2.0));
            assert_eq!(switch.kind, MethodKind::Explicit);
            switch.after_explicit(1e-6, &CHEAP, || 2.0);
            assert_eq!((switch.kind, switch.steps), (MethodKind::Implicit, 0));
        }
    }

    #[test]
    fn explicit_steps_near_the_bound_outweigh_what_a_trial_wasted_before_the_next() {
        // A step of 0.1/ω does what 0.1/4.6 explicit steps do and takes the work of 15·0.146.
        let mut switch = StiffnessSwitch { kind: MethodKind::Implicit, explicit: 1e-6, ..StiffnessSwitch::NON_STIFF };
        let after = |switch: &mut StiffnessSwitch, h: f64, next: f64| {
            switch.after_implicit(h, StepWork { evaluations: 15, next }, &CHEAP, 1e6);
        };
        (0..3).for_each(|_| after(&mut switch, 1e-7, 1e-7));
        assert!((switch.waste - 3.0 * (15.0 * 0.146 - 0.1 / 4.6)).abs() < 1e-12, "{}", switch.waste);
        let next = (1..).find(|_| {
            switch.after_explicit(1e-6, &CHEAP, || 2.0);
            switch.kind == MethodKind::Implicit
        });
        assert_eq!(next, Some(64)); // Eight times 6.5 steps are 52, and every sixteenth is looked at.
        // One that has paid wastes nothing.
        (0..12).for_each(|_| after(&mut switch, 3e-5, 3e-5));
        assert!(switch.waste < 0.0 && switch.is_sound());
        (0..12).for_each(|_| after(&mut switch, f64::INFINITY, 1e-7));
        assert!(switch.is_sound());
    }

    #[test]
    fn steps_far_within_stability_are_never_tried() {
        for (terms, stiffness) in [(CHEAP, 1.0), (COSTLY, 0.4)] {
            let mut switch = StiffnessSwitch::NON_STIFF;
            for _ in 0..1000 {
                switch.after_explicit(1e-6, &terms, || stiffness);
            }
            assert_eq!(switch.kind, MethodKind::Explicit);
        }
    }

    #[test]
    fn other_steps_beside_blocks_are_tried_in_turn_and_kept_while_they_pay() {
        let mut switch = StiffnessSwitch::BLOCKS;
        // The numbers of blocks, implicit and explicit steps until blocks are made again.
        let trial = |switch: &mut StiffnessSwitch, implicit: f64, explicit: f64| {
            let mut steps = [0; 3];
            for _ in 0..2000 {
                steps[switch.kind as usize] += 1;
                match switch.kind {
                    MethodKind::Block => switch.after_block(1e-6, || 1e6),
                    MethodKind::Explicit => switch.after_explicit_beside_blocks(explicit, &CHEAP, || 1.0),
                    MethodKind::Implicit => {
                        switch.after_implicit(implicit, work(implicit), &CHEAP, 1e6);
                    }
                }
                assert!(switch.is_sound());
                if switch.kind == MethodKind::Block && steps[MethodKind::Explicit as usize] > 0 {
                    break;
                }
            }
            steps
        };
        for check_interval in [32, 128, 256, 256] {
            assert_eq!(trial(&mut switch, 0.4e-6, 0.2e-6), [check_interval, 3, 3]);
        }
        assert_eq!(trial(&mut switch, 0.4e-6, 2e-6), [256, 256, 3]);
        assert_eq!(trial(&mut switch, 3e-6, 0.2e-6), [32, 3, 256]);
        let mut switch = StiffnessSwitch { kind: MethodKind::Explicit, block: 1e-6, ..StiffnessSwitch::BLOCKS };
        while switch.kind == MethodKind::Explicit {
            switch.after_explicit_beside_blocks(2e-6, &COSTLY, || 4.0);
        }
        assert_eq!(
            switch,
            StiffnessSwitch { kind: MethodKind::Implicit, explicit: 2e-6, ..StiffnessSwitch::NON_STIFF }
        );
    }

    #[test]
    fn blocks_far_within_stability_are_kept() {
        let mut switch = StiffnessSwitch::BLOCKS;
        for _ in 0..1000 {
            switch.after_block(1e-6, || 2e5);
        }
        assert_eq!(switch.kind, MethodKind::Block);
    }
}
