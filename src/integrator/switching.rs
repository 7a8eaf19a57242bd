//! Two methods that take turns: an explicit one, and a linearly implicit one where the motion is stiff; see
//! [`Regime`](super::regime::Regime).

use super::block::Past;
use super::memory::{Front, Memory};
use super::method::{Character, Method};
use super::problem::{Extent, Problem};
use super::regime;
use super::rosenbrock::{Implicit, Rosenbrock, Workspace};
use super::stages::Attempt;
use super::tableau::Explicit;
use std::marker::PhantomData;

/// Two methods that can take turns.
pub trait Pair: Send + Sync + 'static {
    /// Name in the `solver.method` enumeration.
    const NAME: &'static str;
    /// Where the motion is not stiff; its last two stages are at the step's end.
    type Loose: Explicit;
    /// Where it is.
    type Stiff: Rosenbrock;
    /// The product of step and rate from which on the explicit method is unstable.
    const BOUND: f64;
}

/// The method of this pair.
#[derive(Clone, Copy, Debug)]
pub struct Switching<S>(PhantomData<S>);

impl<S: Pair> Method for Switching<S> {
    const NAME: &'static str = S::NAME;
    const ORDER: u32 = <S::Loose as Method>::ORDER;
    const ADAPTIVE: bool = true;
    const COARSE: bool = false;
    const LOCATES: bool = true;
    const CHARACTER: Character = <S::Loose as Method>::CHARACTER;
    const IN_STIFF: Option<Character> = Some(<Implicit<S::Stiff> as Method>::CHARACTER);
    type Room<const N: usize> = Workspace<N>;

    fn attempt<const N: usize, P: Problem<N> + ?Sized>(
        made: &mut Attempt<N>,
        room: &mut Workspace<N>,
        problem: &P,
        start: &Front<N, P::Modes>,
        past: &Past<N>,
        h: f64,
        stiff: bool,
    ) -> u64 {
        if stiff {
            Implicit::<S::Stiff>::attempt(made, room, problem, start, past, h, stiff)
        } else {
            S::Loose::attempt(made, &mut (), problem, start, past, h, stiff)
        }
    }

    fn choose<const N: usize, P: Problem<N> + ?Sized>(
        made: &Attempt<N>,
        room: &Workspace<N>,
        problem: &P,
        memory: &mut Memory<N, P::Modes>,
    ) {
        let Memory { start, end, stiff, regime, step, .. } = memory;
        let (h, extent, scales) = (end.t - start.t, Extent::of(problem), problem.scales());
        if *stiff {
            let fastest = regime::fastest(room.jacobian(), extent, scales);
            if let Some(longest) = regime.after_implicit(h, S::BOUND, fastest, extent.positions) {
                *step = step.min(longest);
            }
        } else {
            regime.after_explicit(S::BOUND, || made.stiffness::<S::Loose>(extent, scales));
        }
    }
}
