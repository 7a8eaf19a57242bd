//! The branch that each contact is on. Within a step branches are frozen, so that the equations
//! are smooth; a step that ends where its branch does not hold is cut at the crossing.

use super::contact::Touch;
use super::laws::Laws;
use slidercrank::scene::FrictionLaw;

/// One contact's memory and branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    pub closed: bool,
    /// [m/s] δ̇⁻ of the contact that goes on.
    pub onset_rate: f64,
    /// s is held at s_max.
    pub limited: bool,
    /// The force is held at 0.
    pub clipped: bool,
    /// Ambrosio's friction: 0 below v0, ±1 on the ramp, ±2 above v1.
    pub zone: i8,
}

/// What a branch asks for, as a number that is ≥ 0 while the branch holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Penetration keeps its sign.
    Gap,
    /// s keeps its side of s_max.
    Limit,
    /// 1 + χ·s keeps its sign.
    Clip,
    /// Sliding speed below the upper end of its zone.
    Faster,
    /// Sliding speed above the lower end of its zone.
    Slower,
}

pub const CONDITIONS: [Condition; 5] =
    [Condition::Gap, Condition::Limit, Condition::Clip, Condition::Faster, Condition::Slower];

const OPEN: Phase = Phase { closed: false, onset_rate: 1.0, limited: false, clipped: false, zone: 0 };

impl Phase {
    pub fn open() -> Self {
        OPEN
    }

    /// The branch at the start.
    pub fn at_start(laws: &Laws, touch: &Touch) -> Self {
        if touch.penetration > 0.0 { Self::closing(laws, touch) } else { OPEN }
    }

    /// A contact that begins at `touch`.
    fn closing(laws: &Laws, touch: &Touch) -> Self {
        let mut phase = Self { closed: true, onset_rate: touch.rate.max(laws.speed_floor), ..OPEN };
        phase.limited = laws.ratio_limit > 0.0 && touch.rate > laws.ratio_limit * phase.onset_rate;
        phase.clipped = laws.damping_multiplier(&phase, touch.rate) < 0.0;
        if laws.friction.law == FrictionLaw::Ambrosio {
            let speed = touch.sliding.abs();
            let zone = i8::from(speed > laws.friction.v0) + i8::from(speed > laws.friction.v1);
            phase.zone = if touch.sliding < 0.0 { -zone } else { zone };
        }
        phase
    }

    /// The condition's margin at `touch`; `None` where this branch does not ask for it.
    pub fn margin(&self, condition: Condition, laws: &Laws, touch: &Touch) -> Option<f64> {
        let signed = |holds: bool, value: f64| Some(if holds { value } else { -value });
        match condition {
            Condition::Gap => signed(self.closed, touch.penetration),
            _ if !self.closed => None,
            Condition::Limit => (laws.ratio_limit > 0.0)
                .then_some(laws.ratio_limit * self.onset_rate - touch.rate)
                .and_then(|below| signed(!self.limited, below)),
            Condition::Clip => (!self.limited)
                .then_some(laws.damping_multiplier(self, touch.rate))
                .and_then(|m| signed(!self.clipped, m)),
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

    /// The branch beyond the crossing of `condition` at `touch`.
    pub fn beyond(&self, condition: Condition, laws: &Laws, touch: &Touch) -> Self {
        match condition {
            Condition::Gap if self.closed => OPEN,
            Condition::Gap => Self::closing(laws, touch),
            Condition::Limit => Self { limited: !self.limited, ..*self },
            Condition::Clip => Self { clipped: !self.clipped, ..*self },
            Condition::Faster => Self { zone: self.zone + 1, ..*self },
            Condition::Slower => Self { zone: self.zone - 1, ..*self },
        }
    }
}
