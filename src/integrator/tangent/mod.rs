//! The tangent of a motion: what a small change of its start or of a parameter does to it later.
//!
//! Between events a direction v of neighbouring motions follows the variational equation
//!
//! v̇ = J(t)·v + F, J = ∂ẏ/∂y, F = Σ_m ∂ẏ/∂m·v_m + Σ_p ∂ẏ/∂p·π_p,
//!
//! where m are numbers that the discrete state remembers, such as the approach speed of a closed contact, and π is the
//! direction's share of the parameters. [`flow`] integrates it along the dense output of each accepted step.
//!
//! At an event the neighbour comes at another time. With the event function g, the rates f⁻ before and f⁺ after it,
//!
//! τ = −(g_y·v⁻ + g_p·π)/(g_t + g_y·f⁻), v⁺ = R·(v⁻ + f⁻·τ) − f⁺·τ, v_m⁺ = m_y·(v⁻ + f⁻·τ) + m_t·τ + m_p·π,
//!
//! where R drops the states that are reset and m(t, y, p) is what the event leaves in memory: the saltation matrix (M. A.
//! Aizerman, F. R. Gantmakher, Quart. J. Mech. Appl. Math. 11 (1958) 407; P. C. Müller, Chaos, Solitons & Fractals 5
//! (1995) 1671; N. Kong et al., arXiv 2306.06862, eq. 9). Where only the slope of a rate jumps, as at the corner of a
//! friction law, f⁺ = f⁻ and nothing is remembered: the saltation matrix is the identity, and the step's end there is
//! enough. That fails where a motion slides along such a corner, since no step can end where it is left; an error of the
//! first order then remains, as large as the smoothing of the law.
//!
//! Near grazing τ grows like one over the approach speed, and the first order ends: [`Grazing`].

mod flow;
mod legendre;
mod saltation;
mod tangents;

pub use saltation::Grazing;
pub use tangents::Tangents;

use super::system::System;
use std::ops::Range;

/// Derivatives of one number of a system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gradient {
    /// By each state.
    pub by_state: Vec<f64>,
    /// [1/s] By time.
    pub by_time: f64,
    /// By each parameter.
    pub by_parameter: Vec<f64>,
}

impl Gradient {
    /// Rate of the number along a motion whose states have these rates.
    pub fn rate(&self, rates: &[f64]) -> f64 {
        self.by_time + self.by_state.iter().zip(rates).map(|(slope, rate)| slope * rate).sum::<f64>()
    }
}

/// An event as a change of the discrete state.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing<D> {
    /// Which contact or switch, for messages.
    pub contact: usize,
    /// The discrete state after the event.
    pub after: D,
    /// Distance to the event; its sign does not matter.
    pub distance: Gradient,
    /// Rate of the distance.
    pub rate: Gradient,
    /// The place in memory that the event writes, and the number's derivatives; all 0 for a constant.
    pub memory: Option<(usize, Gradient)>,
    /// States that the event sets to a constant.
    pub reset: Range<usize>,
}

/// What the variational equations ask of a system.
pub trait Variational {
    /// The discrete state of the system.
    type Discrete: Copy;

    /// The system itself.
    fn system(&self) -> &dyn System<Discrete = Self::Discrete>;

    /// Number of numbers that the discrete state can remember.
    fn memories(&self) -> usize {
        0
    }

    /// Writes the derivatives of the rates by what stands in one place of memory. Returns `false` if all are 0.
    fn write_rates_by_memory(
        &self,
        _memory: usize,
        _discrete: &Self::Discrete,
        _t: f64,
        _y: &[f64],
        _slopes: &mut [f64],
    ) -> bool {
        false
    }

    /// Number of parameters.
    fn parameters(&self) -> usize {
        0
    }

    /// Writes the derivatives of the rates by a parameter.
    fn write_rates_by_parameter(
        &self,
        _parameter: usize,
        _discrete: &Self::Discrete,
        _t: f64,
        _y: &[f64],
        slopes: &mut [f64],
    ) {
        slopes.fill(0.0);
    }

    /// The events that lead from the discrete state `before` to `after` at the state `y`, in an order in which they can
    /// happen; none if the two differ in nothing that events change.
    fn crossings(
        &self,
        before: &Self::Discrete,
        after: &Self::Discrete,
        t: f64,
        y: &[f64],
    ) -> Vec<Crossing<Self::Discrete>>;

    /// Whether `crossings` would find an event.
    fn differ(&self, before: &Self::Discrete, after: &Self::Discrete) -> bool;
}
