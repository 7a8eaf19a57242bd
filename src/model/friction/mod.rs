//! Friction: f_t = f_n·ratio(v_t), odd in the sliding speed.
//!
//! Lugre alone has a state, the mean deflection of bristles between the surfaces, which a contact
//! starts anew each time that it closes.

use crate::math::{self, Real};
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
    /// [m/s] Sliding speeds at which the law has corners: v0 and v1 of the ramp.
    pub corners: [Option<f64>; 2],
    /// [s/m] 1/(v1 − v0) of the ramp, 1/v1 of the hyperbolic tangent.
    pub per_width: f64,
    /// [s/m] 1/v_s.
    pub per_stribeck: f64,
    /// [1/m] σ0.
    pub sigma0: f64,
    /// [s/m] σ1.
    pub sigma1: f64,
    /// [s/m] σ2.
    pub sigma2: f64,
}

/// What sliding does to a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rubbing<R = f64> {
    /// f_t/f_n.
    pub ratio: R,
    /// [m/s] Rate of the bristles' deflection; 0 of a law without them.
    pub bristle_rate: R,
}

/// A friction law.
pub trait Friction {
    /// There is friction.
    const PRESENT: bool;
    /// It has bristles, which move whatever the normal force.
    const BRISTLES: bool = false;
    /// At the sliding speed `v` [m/s], with the bristles deflected by `z` [m].
    fn rub<R: Real>(parameters: &FrictionParameters, v: R, z: R) -> Rubbing<R>;
}

fn ratio<R: Real>(ratio: R) -> Rubbing<R> {
    Rubbing { ratio, bristle_rate: R::ZERO }
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

/// σ0·z + σ1·exp(−(v/v_s)²)·ż + σ2·v with ż = v − σ0·|v|·z/g(v),
/// g(v) = μ_k + (μ_s − μ_k)·exp(−(v/v_s)²): C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky,
/// IEEE Trans. Autom. Control 40 (1995) 419, with the damping that fades with the sliding speed.
pub struct Lugre;

impl Friction for Frictionless {
    const PRESENT: bool = false;
    #[inline(always)]
    fn rub<R: Real>(_: &FrictionParameters, _: R, _: R) -> Rubbing<R> {
        Rubbing::default()
    }
}

impl Friction for Ambrosio {
    const PRESENT: bool = true;
    #[inline(always)]
    fn rub<R: Real>(p: &FrictionParameters, v: R, _: R) -> Rubbing<R> {
        let ramp = ((v.abs() - p.v0) * p.per_width).clamp(0.0, 1.0);
        ratio((ramp * p.kinetic).copysign(v))
    }
}

impl Friction for Tanh {
    const PRESENT: bool = true;
    #[inline(always)]
    fn rub<R: Real>(p: &FrictionParameters, v: R, _: R) -> Rubbing<R> {
        ratio(math::tanh(v * p.per_width) * p.kinetic)
    }
}

impl Friction for Stribeck {
    const PRESENT: bool = true;
    #[inline(always)]
    fn rub<R: Real>(p: &FrictionParameters, v: R, _: R) -> Rubbing<R> {
        ratio(p.falling(p.fading(v)) * math::tanh(v * p.per_width))
    }
}

impl Friction for Lugre {
    const PRESENT: bool = true;
    const BRISTLES: bool = true;
    #[inline(always)]
    fn rub<R: Real>(p: &FrictionParameters, v: R, z: R) -> Rubbing<R> {
        let fading = p.fading(v);
        let rate = v - v.abs() * p.sigma0 * z / p.falling(fading);
        Rubbing { ratio: z * p.sigma0 + fading * p.sigma1 * rate + v * p.sigma2, bristle_rate: rate }
    }
}

impl FrictionParameters {
    /// From the scene's.
    pub fn new(friction: &scene::Friction) -> Self {
        let (width, corners) = match friction.law {
            scene::FrictionLaw::Ambrosio => {
                (friction.v1 - friction.v0, [Some(friction.v0).filter(|&v0| v0 > 0.0), Some(friction.v1)])
            }
            _ => (friction.v1, [None; 2]),
        };
        Self {
            kinetic: friction.coefficient,
            static_: friction.static_coefficient,
            v0: friction.v0,
            corners,
            per_width: 1.0 / width,
            per_stribeck: 1.0 / friction.v_stribeck,
            sigma0: friction.sigma0,
            sigma1: friction.sigma1,
            sigma2: friction.sigma2,
        }
    }

    /// exp(−(v/v_s)²).
    #[inline(always)]
    fn fading<R: Real>(&self, v: R) -> R {
        let share = v * self.per_stribeck;
        math::exp(-share * share)
    }

    /// μ_k + (μ_s − μ_k)·`fading`.
    #[inline(always)]
    fn falling<R: Real>(&self, fading: R) -> R {
        fading * (self.static_ - self.kinetic) + self.kinetic
    }

    /// [m] The deflection at which bristles at rest let go, μ_s/σ0.
    pub fn greatest_deflection(&self) -> f64 {
        self.static_ / self.sigma0
    }
}
