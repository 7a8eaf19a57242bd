//! What the variational equations ask of a system.

use crate::integrator::{Jacobian, System};
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

/// How the states move per unit of a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Companion<'a> {
    /// Their direction.
    pub direction: &'a [f64],
    /// Derivatives of the rates by the states.
    pub jacobian: &'a Jacobian,
}

impl Companion<'_> {
    /// Subtracts the derivatives of the rates along the direction.
    pub fn subtract_from(&self, slopes: &mut [f64]) {
        for (i, slope) in slopes.iter_mut().enumerate() {
            let row = self.jacobian.row(i).iter().zip(self.direction);
            *slope -= row.map(|(slope, moved)| slope * moved).sum::<f64>();
        }
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

    /// Writes the derivatives of the rates by a parameter. A difference may be taken along the parameter and its
    /// `companion` together.
    fn write_rates_by_parameter(
        &self,
        _parameter: usize,
        _discrete: &Self::Discrete,
        _t: f64,
        _y: &[f64],
        _companion: &Companion<'_>,
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
