//! The branch that each contact is on. Within a step branches are frozen, so that the equations
//! are smooth; a step that ends where its branch does not hold is cut at the crossing.

use crate::contact::{Contact, Touch};
use crate::coordinates::Motion;
use crate::laws::Laws;
use crate::mechanism::FrictionLaw;

/// One contact's memory and branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// The penetrations that are positive: of a face's two corners, else of the contact alone.
    pub inside: [bool; 2],
    /// [m/s] δ̇⁻ of the contact that goes on.
    pub onset_rate: f64,
    /// s is held at s_max.
    pub limited: bool,
    /// The force is held at 0.
    pub clipped: bool,
    /// Ambrosio's friction: 0 below v0, ±1 on the ramp, ±2 above v1. Lugre's: the sign of v_t.
    pub zone: i8,
}

/// What a branch asks for, as a number that is ≥ 0 while the branch holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// The penetration keeps its sign.
    Gap,
    /// That of a face's second corner does.
    OtherGap,
    /// s keeps its side of s_max.
    Limit,
    /// 1 + χ·s keeps its sign.
    Clip,
    /// Sliding speed below the upper end of its zone.
    Faster,
    /// Sliding speed above the lower end of its zone.
    Slower,
}

pub const CONDITIONS: [Condition; 6] =
    [Condition::Gap, Condition::OtherGap, Condition::Limit, Condition::Clip, Condition::Faster, Condition::Slower];

/// [m] Corners this near to their crossing cross with the one that is there: below it the sign of a
/// penetration is round-off.
const TOGETHER: f64 = 1e-15;

const OPEN: Phase = Phase { inside: [false; 2], onset_rate: 1.0, limited: false, clipped: false, zone: 0 };

impl Phase {
    pub fn open() -> Self {
        OPEN
    }

    pub fn closed(&self) -> bool {
        self.inside.contains(&true)
    }

    /// The branch at the start.
    pub fn at_start(contact: &Contact, motion: &Motion) -> Self {
        let inside = contact.touch(motion, &OPEN).depths.map(|depth| depth > 0.0);
        if inside.contains(&true) { Self::closing(inside, contact, motion) } else { OPEN }
    }

    /// A contact that begins at `motion`.
    fn closing(inside: [bool; 2], contact: &Contact, motion: &Motion) -> Self {
        let (laws, begun) = (&contact.laws, Self { inside, ..OPEN });
        let touch = contact.touch(motion, &begun);
        let approach = touch.rates[0].max(touch.rates[1]);
        let mut phase = Self { onset_rate: approach.max(laws.speed_floor), ..begun };
        phase.limited = laws.ratio_limit > 0.0 && touch.rate > laws.ratio_limit * phase.onset_rate;
        phase.clipped = laws.damping_multiplier(&phase, touch.rate) < 0.0;
        let speed = touch.sliding.abs();
        let zone = match laws.friction.law {
            FrictionLaw::Ambrosio => i8::from(speed > laws.friction.v0) + i8::from(speed > laws.friction.v1),
            FrictionLaw::Lugre => 1,
            _ => 0,
        };
        phase.zone = if touch.sliding < 0.0 { -zone } else { zone };
        phase
    }

    /// The condition's margin at `touch`; `None` where this branch does not ask for it.
    pub fn margin(&self, condition: Condition, laws: &Laws, touch: &Touch) -> Option<f64> {
        let signed = |holds: bool, value: f64| Some(if holds { value } else { -value });
        match condition {
            Condition::Gap => signed(self.inside[0], touch.depths[0]),
            Condition::OtherGap => signed(self.inside[1], touch.depths[1]),
            _ if !self.closed() => None,
            Condition::Limit => (laws.ratio_limit > 0.0)
                .then_some(laws.ratio_limit * self.onset_rate - touch.rate)
                .and_then(|below| signed(!self.limited, below)),
            Condition::Clip => (!self.limited)
                .then_some(laws.damping_multiplier(self, touch.rate))
                .and_then(|m| signed(!self.clipped, m)),
            Condition::Faster if laws.friction.law == FrictionLaw::Lugre => Some(f64::from(self.zone) * touch.sliding),
            _ if laws.friction.law != FrictionLaw::Ambrosio => None,
            Condition::Faster => self.zone_end(laws, 1).map(|end| end - touch.sliding),
            Condition::Slower => self.zone_end(laws, -1).map(|end| touch.sliding - end),
        }
    }

    /// [m/s] The end of the friction zone towards `side`.
    fn zone_end(&self, laws: &Laws, side: i8) -> Option<f64> {
        let f = &laws.friction;
        match self.zone * side {
            2 => None,
            1 => Some(f.v1 * f64::from(side)),
            0 => Some(f.v0 * f64::from(side)),
            -1 => Some(-f.v0 * f64::from(side)),
            _ => Some(-f.v1 * f64::from(side)),
        }
    }

    /// The branch beyond the crossing of `condition` at `motion`.
    pub fn beyond(&self, condition: Condition, contact: &Contact, motion: &Motion) -> Self {
        match condition {
            Condition::Gap => self.past_gap(0, contact, motion),
            Condition::OtherGap => self.past_gap(1, contact, motion),
            Condition::Limit => Self { limited: !self.limited, ..*self },
            Condition::Clip => Self { clipped: !self.clipped, ..*self },
            Condition::Faster if contact.laws.friction.law == FrictionLaw::Lugre => Self { zone: -self.zone, ..*self },
            Condition::Faster => Self { zone: self.zone + 1, ..*self },
            Condition::Slower => Self { zone: self.zone - 1, ..*self },
        }
    }

    fn past_gap(&self, corner: usize, contact: &Contact, motion: &Motion) -> Self {
        let mut inside = self.inside;
        inside[corner] = !inside[corner];
        if contact.touch(motion, self).depths[1 - corner].abs() < TOGETHER {
            inside[1 - corner] = inside[corner];
        }
        match (self.closed(), inside.contains(&true)) {
            (_, false) => OPEN,
            (true, true) => Self { inside, ..*self },
            (false, true) => Self::closing(inside, contact, motion),
        }
    }
}
