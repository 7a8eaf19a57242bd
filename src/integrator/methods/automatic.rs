//! `automatic`: `verner7` where the motion is not stiff, `radau13` where it is stiff, and `cong8` in non-stiff motion of
//! a system that suits blocks. `StiffnessSwitch` selects the kind.

use super::block::Cong8;
use super::explicit::Explicit;
use super::radau13::Radau13;
use super::stiffness_switch::{StiffnessSwitch, Terms, fastest};
use super::verner7::VERNER7;
use crate::integrator::dense_output::Step;
use crate::integrator::method::{Attempt, Method, MethodKind, Properties, StepAdvice, StepWork};
use crate::integrator::snapshot::{Reader, Snapshot};
use crate::integrator::state::StepPoint;
use crate::integrator::system::System;

/// Product of step and fastest rate above which the explicit method is unstable: in the left half plane, |R(z)| passes
/// 1 between |z| = 4.44 (at 110° from the positive real axis) and 4.75.
const BOUND: f64 = 4.4;

/// The order-7 pair, which switches to the L-stable collocation method in stiff motion and to steps in blocks where they pay.
#[derive(Clone, Debug)]
pub struct Automatic {
    kind: MethodKind,
    switch: StiffnessSwitch,
    block: Cong8,
    /// Method for non-stiff motion; its last two stages are at the step's end.
    explicit: Explicit,
    /// Method for stiff motion.
    implicit: Radau13,
    /// Properties of each kind, in the order of [`MethodKind::ALL`].
    properties: [Properties; 3],
}

impl Automatic {
    /// The method for `states` states.
    pub fn new(states: usize) -> Self {
        let block = Cong8::new(states);
        let (explicit, implicit) = (Explicit::new(&VERNER7, states), Radau13::new(states));
        let with = |properties: &Properties, others: &'static [MethodKind]| Properties {
            name: "automatic",
            others,
            ..*properties
        };
        let properties = [
            with(Method::<()>::properties(&block), &[MethodKind::Explicit, MethodKind::Implicit]),
            with(explicit.properties(), &[MethodKind::Implicit, MethodKind::Block]),
            with(Method::<()>::properties(&implicit), &[MethodKind::Explicit, MethodKind::Block]),
        ];
        let switch = StiffnessSwitch::NON_STIFF;
        Self { kind: switch.kind, switch, block, explicit, implicit, properties }
    }
}

impl<D: Copy> Method<D> for Automatic {
    fn properties(&self) -> &Properties {
        &self.properties[self.kind as usize]
    }

    fn begin(&mut self, system: &dyn System<Discrete = D>) {
        self.switch = if system.suits_blocks() { StiffnessSwitch::BLOCKS } else { StiffnessSwitch::NON_STIFF };
        self.kind = self.switch.kind;
        self.block.begin(system);
        self.implicit.begin(system);
    }

    fn attempt(
        &mut self,
        system: &dyn System<Discrete = D>,
        start: &StepPoint<D>,
        h: f64,
        end: &mut StepPoint<D>,
        attempt: &mut Attempt,
    ) -> u64 {
        match self.kind {
            MethodKind::Block => self.block.attempt(system, start, h, end, attempt),
            MethodKind::Explicit => self.explicit.attempt(system, start, h, end, attempt),
            MethodKind::Implicit => self.implicit.attempt(system, start, h, end, attempt),
        }
    }

    fn remember(&mut self, start: &StepPoint<D>, end: f64) {
        match self.kind {
            MethodKind::Block => self.block.remember(start, end),
            MethodKind::Explicit => {}
            MethodKind::Implicit => self.implicit.remember(start, end),
        }
    }

    fn inside(&self, step: &Step<'_>, t: f64, y: &mut [f64]) -> bool {
        match self.kind {
            MethodKind::Block => Method::<D>::inside(&self.block, step, t, y),
            MethodKind::Explicit => false,
            MethodKind::Implicit => Method::<D>::inside(&self.implicit, step, t, y),
        }
    }

    fn forget(&mut self) {
        Method::<D>::forget(&mut self.block);
        Method::<D>::forget(&mut self.implicit);
    }

    fn accepted(
        &mut self,
        system: &dyn System<Discrete = D>,
        start: &StepPoint<D>,
        end: &StepPoint<D>,
        work: StepWork,
    ) -> StepAdvice {
        let Self { kind, switch, explicit, implicit, .. } = self;
        let (h, layout, scales) = (end.t - start.t, system.layout(), system.scales());
        let terms = &Terms::new(BOUND, layout.positions, system.rates_are_cheap());
        let mut advice = StepAdvice::NONE;
        match kind {
            MethodKind::Block => switch.after_block(h, || {
                system.jacobian(&end.discrete, end.t, &end.y, implicit.jacobian());
                advice.evaluations += 1;
                fastest(implicit.jacobian(), layout, scales, &end.rates)
            }),
            MethodKind::Explicit if system.suits_blocks() => {
                switch.after_explicit_beside_blocks(h, terms, || explicit.stiffness(layout, scales));
            }
            MethodKind::Explicit => switch.after_explicit(h, terms, || explicit.stiffness(layout, scales)),
            MethodKind::Implicit => {
                let fastest = fastest(implicit.jacobian(), layout, scales, &end.rates);
                if let Some(longest) = switch.after_implicit(h, work, terms, fastest) {
                    advice.longest_step = longest;
                }
            }
        }
        advice
    }

    fn kind(&self) -> MethodKind {
        self.kind
    }

    fn set_kind(&mut self, kind: MethodKind) {
        self.kind = kind;
    }

    fn next_kind(&self) -> MethodKind {
        self.switch.kind
    }

    fn hand_over(&mut self) {
        self.switch.hand_over(self.kind);
    }

    fn save(&self, snapshot: &mut Snapshot) {
        let StiffnessSwitch { kind, steps, check_interval, balance, block, reach, explicit, waste } = self.switch;
        snapshot.reals.extend([balance, block, reach, explicit, waste]);
        snapshot.integers.extend([self.kind as u64, kind as u64]);
        snapshot.integers.extend([steps, check_interval].map(u64::from));
        Method::<D>::save(&self.block, snapshot);
        Method::<D>::save(&self.implicit, snapshot);
    }

    fn load(&mut self, reader: &mut Reader<'_>) -> Option<()> {
        let [balance, block, reach, explicit, waste] = reader.reals()?;
        self.kind = read_kind(reader)?;
        self.switch = StiffnessSwitch {
            kind: read_kind(reader)?,
            steps: reader.integer()?.try_into().ok()?,
            check_interval: reader.integer()?.try_into().ok()?,
            balance,
            block,
            reach,
            explicit,
            waste,
        };
        Method::<D>::load(&mut self.block, reader)?;
        Method::<D>::load(&mut self.implicit, reader)?;
        self.switch.is_sound().then_some(())
    }
}

fn read_kind(reader: &mut Reader<'_>) -> Option<MethodKind> {
    let place = usize::try_from(reader.integer()?).ok()?;
    MethodKind::ALL.get(place).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// |R(z)|: by how much a step multiplies the solution of ẏ = λ·y, for z = hλ.
    fn growth([re, im]: [f64; 2]) -> f64 {
        let method = &VERNER7;
        let times = |x: [f64; 2]| [re * x[0] - im * x[1], re * x[1] + im * x[0]];
        let mut k = vec![];
        let sum = |weights: &[f64], k: &[[f64; 2]]| {
            let parts = weights.iter().zip(k).fold([0.0; 2], |sum, (w, k)| [sum[0] + w * k[0], sum[1] + w * k[1]]);
            let part = times(parts);
            [1.0 + part[0], part[1]]
        };
        for row in &method.a[..method.stages] {
            k.push(sum(row, &k));
        }
        let [re, im] = sum(&method.b, &k);
        re.hypot(im)
    }

    #[test]
    fn the_explicit_method_is_stable_up_to_its_bound() {
        for degrees in (95..=180).step_by(5) {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let at = |size: f64| growth([size * cos, size * sin]);
            let within = (1..=44).map(|part| at(BOUND * f64::from(part) / 44.0)).fold(0.0, f64::max);
            assert!(within <= 1.0, "{within} at {degrees}°");
            assert!(at(1.09 * BOUND) > 1.0, "at {degrees}°");
        }
    }
}
