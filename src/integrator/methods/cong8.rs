//! A predictor-corrector method of eight nodes at a time; see [`block`](crate::integrator::block).

use crate::integrator::Past;
use crate::integrator::memory::Front;
use crate::integrator::method::{Character, Method};
use crate::integrator::problem::Problem;
use crate::integrator::regime::Manner;
use crate::integrator::stages::Attempt;

/// The method of eight nodes at a time.
#[derive(Clone, Copy, Debug)]
pub struct Cong8;

impl Method for Cong8 {
    const NAME: &'static str = "cong8";
    const ORDER: u32 = 9;
    const ADAPTIVE: bool = true;
    const COARSE: bool = false;
    const LOCATES: bool = true;
    const CHARACTER: Character = Character { error_power: 12.0, interpolates: true, gives_end: true, predicts: true };
    type Room<const N: usize> = ();

    fn attempt<const N: usize, P: Problem<N> + ?Sized>(
        made: &mut Attempt<N>,
        (): &mut (),
        problem: &P,
        start: &Front<N, P::Modes>,
        past: &Past<N>,
        h: f64,
        _manner: Manner,
    ) -> u64 {
        made.in_block(problem, start, past, h)
    }
}
