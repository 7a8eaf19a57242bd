//! What the step-size control and the marching need to know of a method.

use super::block::Past;
use super::memory::{Front, Memory};
use super::problem::Problem;
use super::regime::{Manner, Regime};
use super::stages::Attempt;

/// What the control of a step needs to know of the method that makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Character {
    /// The power of the step with which the error estimate falls.
    pub error_power: f64,
    /// States within a step are interpolated; otherwise a shorter step is made to each: an interpolant
    /// leaves the slow motion of a stiff system.
    pub interpolates: bool,
    /// An attempt gives rates and guards at its end.
    pub gives_end: bool,
    /// A step is predicted from the one before it.
    pub predicts: bool,
}

/// A one-step method, or some that take turns as the motion is stiff or not.
pub trait Method: Send + Sync + 'static {
    /// Name in the `solver.method` enumeration.
    const NAME: &'static str;
    /// Order of the solution that is carried on.
    const ORDER: u32;
    /// There is an error estimate, to which the step is fitted; otherwise the step is fixed.
    const ADAPTIVE: bool;
    /// There is a second, lower-order estimate.
    const COARSE: bool;
    /// Events are located and landed on; otherwise they are noticed at the end of a step.
    const LOCATES: bool;
    /// What is particular to its steps.
    const CHARACTER: Character;
    /// What an attempt works with besides [`Attempt`].
    type Room<const N: usize>: Room;

    /// Attempts a step of `h` from `start` after what is `past`, in this `manner` if there is a choice, and tells how many
    /// evaluations of the rates it took.
    fn attempt<const N: usize, P: Problem<N> + ?Sized>(
        made: &mut Attempt<N>,
        room: &mut Self::Room<N>,
        problem: &P,
        start: &Front<N, P::Modes>,
        past: &Past<N>,
        h: f64,
        manner: Manner,
    ) -> u64;

    /// To be called after the last attempt has become the last step: which method makes the next one, and of what
    /// length at most.
    fn choose<const N: usize, P: Problem<N> + ?Sized>(
        _made: &Attempt<N>,
        _room: &mut Self::Room<N>,
        _problem: &P,
        _memory: &mut Memory<N, P::Modes>,
    ) {
    }

    /// The manners that attempt a step which time and again cannot be made in this one, in their order.
    fn others(_manner: Manner) -> &'static [Manner] {
        &[]
    }

    /// What is particular to its steps of this manner.
    #[inline(always)]
    fn character(_manner: Manner) -> Character {
        Self::CHARACTER
    }

    /// How its first step is made.
    fn regime<const N: usize, P: Problem<N> + ?Sized>(_problem: &P) -> Regime {
        Regime::LOOSE
    }
}

/// Room in memory, empty at first.
pub trait Room: Send {
    /// Nothing in it.
    const NEW: Self;
}

impl Room for () {
    const NEW: Self = ();
}
