//! Friction: f_t = f_n·ratio(v_t), odd in the sliding speed.

use crate::math;
use crate::scene;

/// Numbers of a friction law, ready for the inner loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionParameters {
    /// μ or μ_k.
    pub kinetic: f64,
    /// μ_s.
    pub static_: f64,
    /// [m/s] v0.
    pub v0: f64,
    /// [s/m] 1/(v1 − v0) of the ramp, 1/v1 of the hyperbolic tangent.
    pub per_width: f64,
    /// [s/m] 1/v_s.
    pub per_stribeck: f64,
}

/// A friction law without a state of its own.
pub trait Friction {
    /// There is friction.
    const PRESENT: bool;
    /// f_t/f_n at the sliding speed `v` [m/s].
    fn ratio(parameters: &FrictionParameters, v: f64) -> f64;
}

/// No friction, no friction term.
pub struct Frictionless;

/// μ·sign(v)·clamp((|v| − v0)/(v1 − v0), 0, 1): J. A. C. Ambrósio, in Virtual Nonlinear Multibody
/// Systems, Kluwer 2003. No force below v0.
pub struct Ambrosio;

/// μ·tanh(v/v1).
pub struct Tanh;

/// (μ_k + (μ_s − μ_k)·exp(−(v/v_s)²))·tanh(v/v1).
pub struct Stribeck;

impl Friction for Frictionless {
    const PRESENT: bool = false;
    #[inline(always)]
    fn ratio(_: &FrictionParameters, _: f64) -> f64 {
        0.0
    }
}

impl Friction for Ambrosio {
    const PRESENT: bool = true;
    #[inline(always)]
    fn ratio(p: &FrictionParameters, v: f64) -> f64 {
        let ramp = ((v.abs() - p.v0) * p.per_width).clamp(0.0, 1.0);
        (p.kinetic * ramp).copysign(v)
    }
}

impl Friction for Tanh {
    const PRESENT: bool = true;
    #[inline(always)]
    fn ratio(p: &FrictionParameters, v: f64) -> f64 {
        p.kinetic * math::tanh(v * p.per_width)
    }
}

impl Friction for Stribeck {
    const PRESENT: bool = true;
    #[inline(always)]
    fn ratio(p: &FrictionParameters, v: f64) -> f64 {
        let share = v * p.per_stribeck;
        let coefficient = p.kinetic + (p.static_ - p.kinetic) * math::exp(-share * share);
        coefficient * math::tanh(v * p.per_width)
    }
}

impl FrictionParameters {
    /// From the scene's.
    pub fn new(friction: &scene::Friction) -> Self {
        let width = match friction.law {
            scene::FrictionLaw::Ambrosio => friction.v1 - friction.v0,
            _ => friction.v1,
        };
        Self {
            kinetic: friction.coefficient,
            static_: friction.static_coefficient,
            v0: friction.v0,
            per_width: 1.0 / width,
            per_stribeck: 1.0 / friction.v_stribeck,
        }
    }
}
