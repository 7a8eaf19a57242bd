//! Drive and load of the mechanism: input signals, the prescribed crank angle, viscous friction.

use super::joint::guide;
use super::joint_set::Pin;
use super::loads::Loads;
use super::plane::Vec2;
use super::signals::Inputs;
use super::structure::{CRANK, SLIDER};
use crate::math::Real;
use crate::scene::Scene;

/// Inputs after a communication point: u(t) = value + rate·(t − at).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InputSignal {
    /// [s] Time of the communication point.
    pub at: f64,
    /// Inputs at the communication point.
    pub value: Inputs,
    /// [1/s] Rates of the inputs.
    pub rate: Inputs,
}

impl InputSignal {
    /// Inputs at the time `t` [s].
    #[inline(always)]
    pub fn at<R: Real>(&self, t: R) -> Inputs<R> {
        let passed = t - self.at;
        Inputs {
            crank_torque: passed.multiply_add(self.rate.crank_torque, R::constant(self.value.crank_torque)),
            slider_load: passed.multiply_add(self.rate.slider_load, R::constant(self.value.slider_load)),
        }
    }

    /// Whether this signal equals `other` from its own communication point on, bit for bit.
    pub fn continues(&self, other: &Self) -> bool {
        let bits = |value: &Inputs, rate: &Inputs| {
            [value.crank_torque, value.slider_load, rate.crank_torque, rate.slider_load].map(f64::to_bits)
        };
        bits(&self.value, &self.rate) == bits(&other.at(self.at), &other.rate)
    }
}

/// The prescribed rotation θ1 = θ0 + ω0·t, where t is 0 at the start of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    /// [rad] θ0, angle at the start.
    pub angle: f64,
    /// [rad/s] ω0, speed.
    pub speed: f64,
}

impl Rotor {
    /// The rotation of a scene's crank.
    pub fn new(scene: &Scene) -> Self {
        Self { angle: scene.crank.angle_start, speed: scene.crank.speed_start }
    }

    /// [rad] The crank angle at `t` [s].
    #[inline(always)]
    pub fn at<R: Real>(&self, t: R) -> R {
        t.multiply_add(self.speed, R::constant(self.angle))
    }
}

/// Viscous friction of the relative rotation in one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotaryDamper {
    /// The joint.
    pub pin: Pin,
    /// [N·m·s/rad] Damping coefficient.
    pub coefficient: f64,
}

/// Adds the couples of viscous friction at the speeds [rad/s] of crank, rod and slider (`speed`) and of the rod's
/// sections at its ends (`ends`).
#[inline(always)]
pub fn add_viscous<R: Real>(dampers: &[RotaryDamper], speed: &[R; 3], ends: &[R; 2], loads: &mut Loads<R>) {
    for damper in dampers {
        let relative = match damper.pin {
            Pin::MainBearing => speed[CRANK],
            Pin::CrankPin => speed[CRANK] - ends[0],
            Pin::SliderPin => speed[SLIDER] - ends[1],
        };
        let couple = relative * damper.coefficient;
        loads.add_couples(damper.pin, -couple, couple);
    }
}

/// The viscous friction of the revolute joints that have any.
pub fn rotary_dampers(scene: &Scene) -> Vec<RotaryDamper> {
    let joint = &scene.joint;
    Pin::ALL
        .into_iter()
        .zip([&joint.a, &joint.b, &joint.c])
        .filter(|(_, joint)| joint.damping != 0.0)
        .map(|(pin, joint)| RotaryDamper { pin, coefficient: joint.damping })
        .collect()
}

/// The guide's viscous friction on a slider whose pin moves along the guide at `speed` [m/s].
#[inline(always)]
pub fn viscous_guide<R: Real>(damping: f64, speed: R) -> guide::Load<R> {
    guide::Load { force: Vec2::new(speed * -damping, R::ZERO), couple: R::ZERO }
}
