//! What the integrator asks of a hybrid system.

/// Most event functions that a problem may have.
pub const GUARDS: usize = 8;

/// An event function at one instant. The event happens when `value` falls through zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Guard {
    /// Distance to the event, positive before it.
    pub value: f64,
    /// Its time derivative.
    pub rate: f64,
}

/// Which guards fell through zero at the same instant.
pub type Crossed = [bool; GUARDS];

/// What holds after an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reset<D> {
    /// The modes from now on.
    pub modes: D,
    /// [s] The longest sensible first step from here, where the event knows one.
    pub step: Option<f64>,
}

/// A second-order hybrid system of `N` states: `N/2` positions, then their rates in the same order.
pub trait Problem<const N: usize> {
    /// The discrete state. It is constant within a step.
    type Modes: Copy;

    /// Writes the rates of the state `y` at time `t`: the velocities, then the accelerations.
    fn rates(&self, modes: &Self::Modes, t: f64, y: &[f64; N], rates: &mut [f64; N]);

    /// [unit of each state] An error of `tolerance` times this is just tolerable in one step.
    fn scales(&self) -> &[f64; N];

    /// [s] No step is longer.
    fn longest_step(&self) -> f64;

    /// How many guards there are, at most [`GUARDS`].
    fn guard_count(&self) -> usize;

    /// Writes all guards. Only positions and modes decide `value`.
    fn guards(&self, modes: &Self::Modes, t: f64, y: &[f64; N], guards: &mut [Guard; GUARDS]);

    /// [unit of the guards] An error of `tolerance` times this in a guard is just tolerable.
    fn guard_scale(&self) -> f64;

    /// The modes after the guards in `crossed` fell through zero at `t`.
    fn cross(&self, modes: &Self::Modes, t: f64, y: &[f64; N], crossed: &Crossed) -> Reset<Self::Modes>;
}
