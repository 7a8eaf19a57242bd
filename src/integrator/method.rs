//! What the step-size control and the marching need to know of a method.

use super::memory::Front;
use super::problem::Problem;
use super::stages::Attempt;

/// A one-step method.
pub trait Method: Send + Sync + 'static {
    /// Name in the `solver.method` enumeration.
    const NAME: &'static str;
    /// Order of the solution that is carried on.
    const ORDER: u32;
    /// There is an error estimate, to which the step is fitted; otherwise the step is fixed.
    const ADAPTIVE: bool;
    /// The power of the step with which the error estimate falls.
    const ERROR_POWER: f64;
    /// There is a second, lower-order estimate.
    const COARSE: bool;
    /// An attempt gives the rates at its end.
    const GIVES_RATES: bool;
    /// Events are located and landed on; otherwise they are noticed at the end of a step.
    const LOCATES: bool;
    /// States within a step are interpolated; otherwise a shorter step is made to each: an interpolant
    /// leaves the slow motion of a stiff system.
    const INTERPOLATES: bool;
    /// Evaluations of the rates in an attempt.
    const EVALUATIONS: u64;
    /// What an attempt works with besides [`Attempt`].
    type Room<const N: usize>: Room;

    /// Attempts a step of `h` from `start`.
    fn attempt<const N: usize, P: Problem<N> + ?Sized>(
        made: &mut Attempt<N>,
        room: &mut Self::Room<N>,
        problem: &P,
        start: &Front<N, P::Modes>,
        h: f64,
    );
}

/// Room in memory, empty at first.
pub trait Room: Send {
    /// Nothing in it.
    const NEW: Self;
}

impl Room for () {
    const NEW: Self = ();
}
