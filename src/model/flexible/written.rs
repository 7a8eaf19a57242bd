//! The motion of a mechanism with few modes, compiled in one piece for its topology and its numbers of modes.
//!
//! What the parts hand each other then stays in registers, and nothing is left of loops over modes. That is for the loop
//! over a step's stages, where nearly all of the time goes; see [`Ode::stages`](crate::integrator::Ode::stages).
//! Of a mechanism of more states than that loop has registers for, the rates are compiled so, for the usual numbers of
//! modes alone: such a function takes the compiler most of a second.

use super::assembly::Assembly;
use super::chain::Frame;
use super::motion::{Rates, RatesInRow, by_topology};
use crate::integrator::Tableau;
use crate::math::Row;
use crate::model::rod::{Counted, Counts, Exactly, FEW_MODES};
use crate::model::stages::{IN_REGISTERS, in_registers};
use crate::model::state::Contacts;
use crate::model::structure::Topology;

/// See [`Ode::stages`](crate::integrator::Ode::stages).
pub type Stages<M> = fn(&M, &Tableau, &Contacts, f64, &[f64], f64, &mut [f64]) -> bool;

/// `with_counts!(counts in (…)…, Own => work)` does `work` with `Own` the [`Exactly`] of `counts`, of those listed, bending
/// and axial modes, and makes `None` of others.
macro_rules! with_counts {
    ($counts:ident in $(($bending:literal $axial:literal))*, $own:ident => $work:expr) => {
        match $counts {
            $(_ if Exactly::<$bending, $axial>::COUNTS == Some($counts) => {
                type $own = Exactly<$bending, $axial>;
                $work
            })*
            _ => None,
        }
    };
}

/// How many states a mechanism has without bristles.
const fn states<C: Counted>(frame: Frame) -> usize {
    2 * (frame.structure.positions + C::MODES)
}

/// The loop over stages of exactly `N` states, where it is compiled.
pub fn stages<const N: usize, const S: usize, const K: usize, const F: usize>(
    topology: Topology,
    counts: Counts,
) -> Option<Stages<Assembly<S, K, F>>> {
    if const { N > IN_REGISTERS || K > FEW_MODES } {
        return None;
    }
    /// Of these ideal joints and this drive.
    macro_rules! joined {
        ($a:literal $b:literal $c:literal $t:literal $speed:literal) => {{
            const FRAME: Frame = Frame::new(Topology { a: $a, b: $b, c: $c, t: $t, speed: $speed });
            with_counts!(counts in (1 0) (2 0) (3 0) (3 1), Own => {
                if const { N == states::<Own>(FRAME) } {
                    Some(|all, tableau, contacts, t, y, h, k| {
                        in_registers::<N>(tableau, t, y, h, k, #[inline(always)] |t, y, rates| {
                            all.motion_of::<f64, { FRAME.places() }, Own>(FRAME, contacts, t, y, rates);
                        })
                    })
                } else {
                    None
                }
            })
        }};
    }
    by_topology!(topology, joined)
}

/// Rates of a state and of four together, where they are compiled.
pub type Written<M> = (Option<Rates<M>>, Option<RatesInRow<M>>);

/// The rates of more states than that, and of four together, for the usual numbers of modes.
pub fn rates<const S: usize, const K: usize, const F: usize>(
    topology: Topology,
    counts: Counts,
) -> Written<Assembly<S, K, F>> {
    if const { K > FEW_MODES } {
        return (None, None);
    }
    /// Of these ideal joints and this drive.
    macro_rules! joined {
        ($a:literal $b:literal $c:literal $t:literal $speed:literal) => {{
            const FRAME: Frame = Frame::new(Topology { a: $a, b: $b, c: $c, t: $t, speed: $speed });
            let written: Option<Written<Assembly<S, K, F>>> = with_counts!(counts in (3 1), Own => {
                let alone: Option<Rates<Assembly<S, K, F>>> = if const { states::<Own>(FRAME) > IN_REGISTERS } {
                    Some(|all, contacts, t, y, rates| {
                        all.motion_of::<f64, { FRAME.places() }, Own>(FRAME, contacts, t, y, rates);
                    })
                } else {
                    None
                };
                let together: RatesInRow<Assembly<S, K, F>> = |all, contacts, t, y, rates| {
                    all.motion_of::<Row<1>, { FRAME.places() }, Own>(FRAME, contacts, t, y, rates);
                };
                Some((alone, Some(together)))
            });
            written.unwrap_or((None, None))
        }};
    }
    by_topology!(topology, joined)
}
