//! Methods that take turns: an explicit one, a linearly implicit one where the motion is stiff, and `cong8`, which makes its
//! steps as blocks, where the problem suits it; see [`Regime`].

use super::block::Past;
use super::memory::{Front, Memory};
use super::method::{Character, Method};
use super::methods::Cong8;
use super::problem::{Extent, Problem};
use super::regime::{self, Manner, Regime};
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

/// The method of this pair, and of blocks.
#[derive(Clone, Copy, Debug)]
pub struct Switching<S>(PhantomData<S>);

impl<S: Pair> Method for Switching<S> {
    const NAME: &'static str = S::NAME;
    const ORDER: u32 = <S::Loose as Method>::ORDER;
    const ADAPTIVE: bool = true;
    const COARSE: bool = false;
    const LOCATES: bool = true;
    const CHARACTER: Character = <S::Loose as Method>::CHARACTER;
    type Room<const N: usize> = Workspace<N>;

    fn attempt<const N: usize, P: Problem<N> + ?Sized>(
        made: &mut Attempt<N>,
        room: &mut Workspace<N>,
        problem: &P,
        start: &Front<N, P::Modes>,
        past: &Past<N>,
        h: f64,
        manner: Manner,
    ) -> u64 {
        match manner {
            Manner::Block => Cong8::attempt(made, &mut (), problem, start, past, h, manner),
            Manner::Explicit => S::Loose::attempt(made, &mut (), problem, start, past, h, manner),
            Manner::Implicit => Implicit::<S::Stiff>::attempt(made, room, problem, start, past, h, manner),
        }
    }

    fn choose<const N: usize, P: Problem<N> + ?Sized>(
        made: &Attempt<N>,
        room: &mut Workspace<N>,
        problem: &P,
        memory: &mut Memory<N, P::Modes>,
    ) {
        let Memory { start, end, manner, regime, step, statistics, .. } = memory;
        let (h, extent, scales) = (end.t - start.t, Extent::of(problem), problem.scales());
        match manner {
            Manner::Block => regime.after_block(h, || {
                problem.jacobian(&end.modes, end.t, &end.y, room.jacobian());
                statistics.evaluations += 1;
                regime::fastest(room.jacobian(), extent, scales)
            }),
            Manner::Explicit if problem.suits_blocks() => {
                regime.after_explicit_beside_blocks(h, S::BOUND, || made.stiffness::<S::Loose>(extent, scales));
            }
            Manner::Explicit => regime.after_explicit(S::BOUND, || made.stiffness::<S::Loose>(extent, scales)),
            Manner::Implicit => {
                let fastest = regime::fastest(room.jacobian(), extent, scales);
                if let Some(longest) = regime.after_implicit(h, S::BOUND, fastest, extent.positions) {
                    *step = step.min(longest);
                }
            }
        }
    }

    fn others(manner: Manner) -> &'static [Manner] {
        match manner {
            Manner::Block => &[Manner::Explicit, Manner::Implicit],
            Manner::Explicit => &[Manner::Implicit, Manner::Block],
            Manner::Implicit => &[Manner::Explicit, Manner::Block],
        }
    }

    #[inline(always)]
    fn character(manner: Manner) -> Character {
        match manner {
            Manner::Block => Cong8::CHARACTER,
            Manner::Explicit => Self::CHARACTER,
            Manner::Implicit => <Implicit<S::Stiff> as Method>::CHARACTER,
        }
    }

    fn regime<const N: usize, P: Problem<N> + ?Sized>(problem: &P) -> Regime {
        if problem.suits_blocks() { Regime::IN_BLOCKS } else { Regime::LOOSE }
    }
}
