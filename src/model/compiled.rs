//! The number types, and the constant structures, that get code of their own.
//!
//! The equations of motion are compiled once a number, for every structure: one state, eight states, a state with
//! derivatives; with a flexible rod, for three sizes of arrays. Where there is little to compute, asking what hangs on what
//! takes as long, and where numbers of modes are not known, arrays stay in memory. So for the structures listed here, those
//! of the usual studies, the same source is compiled again, with nothing left to ask. `cargo bench --bench compiled` shows
//! what that saves in a stage of a step: about a tenth with four plays, half with one, and half with a flexible rod. A
//! structure for which it saves less has no place here. Code for eight states is compiled again where steps in blocks are the usual ones.
//!
//! What a step's stages hand on to one another must not pass through memory in other portions than it is read in; so the
//! loop over them is compiled with the equations in it.

use super::contact::ContactEnergy;
use super::mechanism::{Configuration, FlexibleMotion, FlexibleRod, Mechanism};
use super::rod::{Chord, CompiledCounts, FixedCounts, RodCapacity, RuntimeCounts};
use super::scalar::{Scalar, Tangent};
use super::stages::of_so_many;
use super::state::{Conditions, Evaluation, Pose};
use super::structure::{Structure, Topology};
use crate::integrator::{EventFunctions, Tableau};
use crate::math::F64x8;

/// Writes the rates of a state.
type Rates = fn(&Mechanism, &Conditions, f64, &[f64], &mut [f64]);
/// Writes the rates of eight states at their times.
type RatesOfEight = fn(&Mechanism, &Conditions, F64x8, &[F64x8], &mut [F64x8]);
/// Writes the rates of a state, and the event functions.
type Ends = fn(&Mechanism, &Conditions, f64, &[f64], &mut [f64], &mut EventFunctions);
/// See [`Ode::stages`](crate::integrator::Ode::stages).
type Stages = fn(&Mechanism, &Tableau, &Conditions, f64, &[f64], f64, &mut [f64]) -> bool;

/// The equations of motion, compiled for one structure or for all.
#[derive(Clone, Copy, Debug)]
pub struct Compiled {
    /// Rates of one state.
    pub rates: Rates,
    /// Rates of eight states.
    pub rates_of_eight: RatesOfEight,
    /// Rates and event functions of one.
    pub ends: Ends,
    /// Rates at the stages of a step.
    pub stages: Stages,
}

/// The code of a constant structure with so many states: what these methods of a mechanism do, with a flexible rod for its
/// counts.
macro_rules! code {
    ($structure:ident, $states:expr, $rates:ident, $ends:ident $(, $counts:ty)?) => {
        Compiled {
            rates: |mechanism, conditions, t, y, rates| {
                mechanism.$rates$(::<_, $counts>)?(&$structure, conditions, t, y, rates);
            },
            rates_of_eight: if const { suits_rows(&$structure) } {
                |mechanism, conditions, t, y, rates| {
                    mechanism.$rates$(::<_, $counts>)?(&$structure, conditions, t, y, rates);
                }
            } else {
                Mechanism::rates_of_eight
            },
            ends: |mechanism, conditions, t, y, rates, event_functions| {
                mechanism.$ends$(::<$counts>)?(&$structure, conditions, t, y, rates, event_functions);
            },
            stages: |mechanism, tableau, conditions, t, y, h, k| {
                of_so_many::<{ $states }>(tableau, t, y, h, k, |t, y, rates| {
                    mechanism.$rates$(::<_, $counts>)?(&$structure, conditions, t, y, rates);
                })
            },
        }
    };
}

/// Chooses the code of the structure as a constant, or `$all` where that does not pay. A line has the ideal joints
/// (main bearing, crank pin, slider pin, guide), and whether the crank's angle is prescribed.
macro_rules! by_structure {
    ($structure:expr, $all:expr) => {
        by_structure!(
            @ $structure, $all,
            (true true true true false)  (true true true true true)
            (true true false true false) (true false true true false) (false true true true false)
            (true true false true true)  (true false true true true)  (false true true true true)
            (true true true false false) (true true true false true)
            (false false false true false) (false false false false false) (false false false false true)
        )
    };
    (@ $structure:expr, $all:expr, $(($a:literal $b:literal $c:literal $t:literal $speed:literal))*) => {
        match $structure.topology {
            $(Topology { a: $a, b: $b, c: $c, t: $t, speed: $speed } => {
                const OWN: Structure = Structure::new(Topology { a: $a, b: $b, c: $c, t: $t, speed: $speed });
                code!(OWN, 2 * OWN.positions, rates, rates_and_event_functions)
            })*
            _ => $all,
        }
    };
}

/// Whether steps in blocks, which ask for eight states at a time, are the usual ones of a structure.
const fn suits_rows(structure: &Structure) -> bool {
    structure.closed || structure.topology.has_one_play_in_a_pin()
}

impl Compiled {
    /// The code for every structure.
    pub fn general(mechanism: &Mechanism) -> Self {
        Self {
            rates: Mechanism::rates_of_one,
            rates_of_eight: Mechanism::rates_of_eight,
            ends: Mechanism::ends,
            stages: stages_of_all(2 * mechanism.positions()),
        }
    }

    /// The code for a mechanism: that for its structure, if there is such.
    pub fn of(mechanism: &Mechanism) -> Self {
        let all = Self::general(mechanism);
        match &mechanism.rod {
            Some(rod) => flexible(&mechanism.structure, rod, all),
            None => by_structure!(mechanism.structure, all),
        }
    }
}

/// The code for a flexible rod: for some structures and numbers of modes of its own, in which nothing is left to ask and
/// loops over modes are written out. A line has the ideal joints, whether the crank's angle is prescribed, and the numbers of
/// bending and axial modes.
fn flexible(structure: &Structure, rod: &FlexibleRod, all: Compiled) -> Compiled {
    macro_rules! own {
        ($(($a:literal $b:literal $c:literal $t:literal $speed:literal, $bending:literal $axial:literal))*) => {
            $({
                type Own = FixedCounts<$bending, $axial>;
                const TOPOLOGY: Topology = Topology { a: $a, b: $b, c: $c, t: $t, speed: $speed };
                const OWN: Structure = Structure::with_rod(TOPOLOGY, true);
                if structure.topology == TOPOLOGY && Own::COUNTS == Some(rod.modes.counts) {
                    return code!(OWN, 2 * (OWN.positions + Own::MODES), counted_rates, counted_rates_and_guards, Own);
                }
            })*
        };
    }
    if rod.modes.room == RodCapacity::Few {
        own! {
            (true true false true true, 3 1)
            (true false false false true, 3 1)
            (false false false false false, 2 0)
            (false false false false false, 3 1)
        }
    }
    all
}

/// The loop over a step's stages of any structure with so many states, which its sums know.
fn stages_of_all(states: usize) -> Stages {
    macro_rules! of {
        ($($n:literal)*) => {
            match states {
                $($n => |mechanism, tableau, conditions, t, y, h, k| {
                    of_so_many::<$n>(tableau, t, y, h, k, |t, y, rates| mechanism.rates_of_one(conditions, t, y, rates))
                },)*
                _ => |_, _, _, _, _, _, _| false,
            }
        };
    }
    of!(4 6 8 10 12 14 16 18 20 22 24 26)
}

/// `with_capacity!(rod, name(arguments))` calls `name::<K, F>(arguments)` with the arrays that the rod has room in: of `K` modes
/// and `F` functions along the rod.
macro_rules! with_capacity {
    ($rod:expr, $own:ident . $name:ident $(:: <$number:ty>)? ($($argument:expr),*)) => {
        match $rod.modes.room {
            RodCapacity::Few => $own.$name::<$($number,)? 4, 12>($($argument),*),
            RodCapacity::Many => $own.$name::<$($number,)? 8, 40>($($argument),*),
            RodCapacity::All => $own.$name::<$($number,)? 16, 48>($($argument),*),
        }
    };
}

/// What is compiled once a number, for every structure; with a flexible rod, once for each size of arrays.
impl Mechanism {
    /// Rates of a state.
    #[inline(never)]
    pub fn rates_of_one(&self, conditions: &Conditions, t: f64, y: &[f64], rates: &mut [f64]) {
        match &self.rod {
            None => self.rates(&self.structure, conditions, t, y, rates),
            Some(rod) => with_capacity!(rod, self.drop_flexible_motion::<f64>(rod, conditions, t, y, rates)),
        }
    }

    /// Rates of eight states at their times.
    #[inline(never)]
    pub fn rates_of_eight(&self, conditions: &Conditions, t: F64x8, y: &[F64x8], rates: &mut [F64x8]) {
        match &self.rod {
            None => self.rates(&self.structure, conditions, t, y, rates),
            Some(rod) => with_capacity!(rod, self.flexible_rates_of_eight(rod, conditions, t, y, rates)),
        }
    }

    /// Rates with derivatives.
    #[inline(never)]
    pub fn tangent_rates(&self, conditions: &Conditions, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        match &self.rod {
            None => self.rates(&self.structure, conditions, t, y, rates),
            Some(rod) => with_capacity!(rod, self.drop_flexible_motion::<Tangent>(rod, conditions, t, y, rates)),
        }
    }

    /// Rates and event functions.
    #[inline(never)]
    pub fn ends(
        &self,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        event_functions: &mut EventFunctions,
    ) {
        match &self.rod {
            None => self.rates_and_event_functions(&self.structure, conditions, t, y, rates, event_functions),
            Some(rod) => with_capacity!(rod, self.flexible_ends(rod, conditions, t, y, rates, event_functions)),
        }
    }

    #[inline(never)]
    pub(super) fn place(&self, t: f64, y: &[f64]) -> Configuration<f64> {
        self.configuration(&self.structure, t, y)
    }

    /// Angles, places and velocities with a flexible rod, and its chord.
    #[inline(never)]
    pub(super) fn bent_pose(&self, rod: &FlexibleRod, t: f64, y: &[f64]) -> (Pose, Chord<f64>) {
        with_capacity!(rod, self.flexible_pose(rod, t, y))
    }

    /// Everything about an instant, and its rates.
    #[inline(never)]
    pub fn evaluation(&self, conditions: &Conditions, t: f64, y: &[f64], rates: &mut [f64]) -> Evaluation {
        match &self.rod {
            None => self.rates_and_evaluation(&self.structure, conditions, t, y, rates),
            Some(rod) => with_capacity!(rod, self.flexible_instant::<f64>(rod, conditions, t, y, rates)),
        }
    }

    /// Everything about an instant with derivatives, and what its contacts hold and take.
    #[inline(never)]
    pub fn tangent_evaluation(
        &self,
        conditions: &Conditions,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) -> (Evaluation<Tangent>, ContactEnergy<Tangent>) {
        let evaluation = match &self.rod {
            None => self.rates_and_evaluation(&self.structure, conditions, t, y, rates),
            Some(rod) => with_capacity!(rod, self.flexible_instant::<Tangent>(rod, conditions, t, y, rates)),
        };
        let contact_energy = self.contact_energy(&conditions.contacts, &evaluation.pose, y);
        (evaluation, contact_energy)
    }

    /// Rates with a flexible rod of known counts.
    #[inline(always)]
    fn counted_rates<R: Scalar, C: CompiledCounts>(
        &self,
        of: &Structure,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) {
        if let Some(rod) = &self.rod {
            self.flexible_rates::<R, C, 4, 12>(of, rod, conditions, t, y, rates);
        }
    }

    /// The same, and the event functions.
    #[inline(always)]
    fn counted_rates_and_guards<C: CompiledCounts>(
        &self,
        of: &Structure,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        event_functions: &mut EventFunctions,
    ) {
        if let Some(rod) = &self.rod {
            let motion = self.flexible_rates::<f64, C, 4, 12>(of, rod, conditions, t, y, rates);
            motion.event_functions(self, of, &conditions.contacts, event_functions);
        }
    }

    #[inline(never)]
    fn flexible_ends<const K: usize, const F: usize>(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        event_functions: &mut EventFunctions,
    ) {
        let motion = self.flexible_motion::<f64, K, F>(rod, conditions, t, y, rates);
        motion.event_functions(self, &self.structure, &conditions.contacts, event_functions);
    }

    #[inline(never)]
    fn flexible_rates_of_eight<const K: usize, const F: usize>(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: F64x8,
        y: &[F64x8],
        rates: &mut [F64x8],
    ) {
        self.flexible_rates::<F64x8, RuntimeCounts, K, F>(&self.structure, rod, conditions, t, y, rates);
    }

    #[inline(never)]
    fn flexible_motion<R: Scalar, const K: usize, const F: usize>(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> FlexibleMotion<R, K> {
        self.flexible_rates::<R, RuntimeCounts, K, F>(&self.structure, rod, conditions, t, y, rates)
    }

    /// Rates alone, by the same code.
    #[inline(never)]
    fn drop_flexible_motion<R: Scalar, const K: usize, const F: usize>(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) {
        self.flexible_motion::<R, K, F>(rod, conditions, t, y, rates);
    }

    #[inline(never)]
    fn flexible_instant<R: Scalar, const K: usize, const F: usize>(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> Evaluation<R> {
        self.flexible_motion::<R, K, F>(rod, conditions, t, y, rates).evaluation(self, rod, y, rates)
    }
}
