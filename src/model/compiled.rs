//! The equations of motion compiled for several number types and for constant structures.
//!
//! The generic equations are compiled once per number type for any structure: for one state, for eight states and for a
//! state with derivatives. A flexible rod with few modes has code in which loops over modes are written out ([`KNOWN`]); modes
//! that are missing to its numbers are added and stand still. Other rods are computed in the arrays for any rod. If there
//! is little to compute, the branches on the structure take about as long as the computation, and if the number of modes is
//! unknown, arrays stay in memory. For the structures listed here, those of the usual studies, the same source is therefore
//! compiled again with the structure as a constant. `cargo bench --bench compiled` measures the saving in a stage of a step:
//! about a tenth with four clearances, a third to a half with one, and a quarter with a flexible rod of known numbers of modes.
//! Copies that saved a sixth with play in all joints of a flexible rod were removed.
//! What is specialised are the stages of a step, where the time goes; code for eight states and the end of a step only where
//! steps in blocks are usual, whose stages are short.
//!
//! The loop over the stages of a step is compiled together with the equations, so that the results of a stage do not
//! pass through memory in other portions than they are read in.

use super::dynamics::Accelerations;
use super::loads::Loads;
use super::mechanism::{Configuration, FlexibleMotion, FlexibleRod, Mechanism, evaluation};
use super::rod::{
    ALL_FUNCTIONS, ALL_MODES, Chord, CompiledCounts, Counts, FixedCounts, Inertia, KNOWN, ROWS_WITH_MODES, RodCapacity,
    RuntimeCounts,
};
use super::scalar::{Scalar, Tangent};
use super::stages::run_stages;
use super::state::{Conditions, Evaluation, Pose};
use super::structure::{Structure, Topology};
use crate::integrator::system::one_by_one;
use crate::integrator::{EventFunctions, MAX_STATES, Tableau};
use crate::math::F64x8;

/// Writes the rates of a state.
type Rates = fn(&Mechanism, &Conditions, f64, &[f64], &mut [f64]);
/// Writes the rates of eight states, each at its own time.
type RatesOfEight = fn(&Mechanism, &Conditions, F64x8, &[F64x8], &mut [F64x8]);
/// Writes the rates of a state and the event functions.
type Ends = fn(&Mechanism, &Conditions, f64, &[f64], &mut [f64], &mut EventFunctions);
/// Writes the rates of a state with a flexible rod and, where they are asked for, the event functions.
type FlexibleEnds = fn(&Mechanism, &Conditions, f64, &[f64], &mut [f64], Option<&mut EventFunctions>);
/// See [`Ode::stages`](crate::integrator::Ode::stages).
type Stages = fn(&Mechanism, &Tableau, &Conditions, f64, &[f64], f64, &mut [f64]) -> bool;

/// The equations of motion, compiled for one structure or for any.
#[derive(Clone, Copy, Debug)]
pub struct Compiled {
    /// Rates of one state.
    pub rates: Rates,
    /// Rates of eight states.
    pub rates_of_eight: RatesOfEight,
    /// Rates and event functions of one state.
    pub ends: Ends,
    /// Rates at the stages of a step.
    pub stages: Stages,
}

/// The code of a constant structure. A closed loop is evaluated between its few steps, too, at communication points; the
/// others evaluate mostly stages.
macro_rules! code {
    ($structure:ident) => {
        Compiled {
            rates: if const { $structure.closed } {
                |mechanism, conditions, t, y, rates| mechanism.rates(&$structure, conditions, t, y, rates)
            } else {
                Mechanism::rates_of_one
            },
            rates_of_eight: if const { suits_blocks(&$structure) } {
                |mechanism, conditions, t, y, rates| mechanism.rates(&$structure, conditions, t, y, rates)
            } else {
                Mechanism::rates_of_eight
            },
            ends: if const { suits_blocks(&$structure) } {
                |mechanism, conditions, t, y, rates, event_functions| {
                    mechanism.rates_and_event_functions(&$structure, conditions, t, y, rates, event_functions);
                }
            } else {
                Mechanism::ends
            },
            stages: |mechanism, tableau, conditions, t, y, h, k| {
                run_stages::<{ 2 * $structure.positions }>(tableau, t, y, h, k, |t, y, rates| {
                    mechanism.rates(&$structure, conditions, t, y, rates);
                })
            },
        }
    };
}

/// The code of a constant structure with a flexible rod of the counts `$counts`. One copy for one state serves rates,
/// ends and stages: it is long, and a call of it costs little.
macro_rules! flexible_code {
    ($structure:ident, $counts:ty) => {{
        #[inline(never)]
        fn motion(
            mechanism: &Mechanism,
            conditions: &Conditions,
            t: f64,
            y: &[f64],
            rates: &mut [f64],
            event_functions: Option<&mut EventFunctions>,
        ) {
            mechanism.counted_ends::<$counts>(&$structure, conditions, t, y, rates, event_functions);
        }
        Compiled {
            rates: |mechanism, conditions, t, y, rates| motion(mechanism, conditions, t, y, rates, None),
            rates_of_eight: if const { suits_blocks(&$structure) && ROWS_WITH_MODES } {
                |mechanism, conditions, t, y, rates| {
                    mechanism.counted_motion::<_, $counts>(&$structure, conditions, t, y, rates);
                }
            } else {
                |mechanism, conditions, t, y, rates| {
                    one_by_one(&|t, y, rates| motion(mechanism, conditions, t, y, rates, None), &t, y, rates);
                }
            },
            ends: |mechanism, conditions, t, y, rates, event_functions| {
                motion(mechanism, conditions, t, y, rates, Some(event_functions));
            },
            stages: |mechanism, tableau, conditions, t, y, h, k| {
                run_stages::<{ 2 * ($structure.positions + <$counts>::MODES) }>(tableau, t, y, h, k, |t, y, rates| {
                    motion(mechanism, conditions, t, y, rates, None);
                })
            },
        }
    }};
}

/// Selects the code of the structure as a constant, or `$all` if the structure is not in the list. Each entry of the
/// list says whether the main bearing, the crank pin, the slider pin and the guide are ideal, and whether the crank
/// angle is prescribed.
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
                code!(OWN)
            })*
            _ => $all,
        }
    };
}

/// Whether steps in blocks, which evaluate eight states at a time, are usual for a structure.
const fn suits_blocks(structure: &Structure) -> bool {
    structure.closed || structure.topology.has_one_pin_clearance()
}

impl Compiled {
    /// The code for any structure.
    pub fn general(mechanism: &Mechanism) -> Self {
        Self {
            rates: Mechanism::rates_of_one,
            rates_of_eight: Mechanism::rates_of_eight,
            ends: Mechanism::ends,
            stages: stages_of_all(2 * mechanism.positions()),
        }
    }

    /// The code for a mechanism: specialised for its structure if that is in the list.
    pub fn of(mechanism: &Mechanism) -> Self {
        let all = Self::general(mechanism);
        match &mechanism.rod {
            Some(rod) => flexible(&mechanism.structure, rod, all),
            // A constant structure has no rare loads.
            None if mechanism.structure.rare_loads => all,
            None => by_structure!(mechanism.structure, all),
        }
    }
}

/// The code for a flexible rod: specialised for some structures and numbers of modes, with loops over modes written
/// out. Each entry says which joints are ideal, whether the crank angle is prescribed, and the numbers of bending and
/// axial modes.
fn flexible(structure: &Structure, rod: &FlexibleRod, all: Compiled) -> Compiled {
    macro_rules! own {
        ($(($a:literal $b:literal $c:literal $t:literal $speed:literal, $bending:literal $axial:literal))*) => {
            $({
                type Own = FixedCounts<$bending, $axial>;
                const TOPOLOGY: Topology = Topology { a: $a, b: $b, c: $c, t: $t, speed: $speed };
                const OWN: Structure = Structure::with_rod(TOPOLOGY, true);
                if structure.topology == TOPOLOGY && Own::COUNTS == Some(rod.modes.counts) {
                    return flexible_code!(OWN, Own);
                }
            })*
        };
    }
    if rod.modes.room == RodCapacity::Few && !structure.rare_loads {
        own! {
            (true true false true true, 3 1)
            (true false false false true, 3 1)
        }
    }
    all
}

/// Whether no loop over modes of unknown number is left in the code of a mechanism for one state.
pub fn is_quick(mechanism: &Mechanism) -> bool {
    mechanism.rod.as_ref().is_none_or(|rod| rod.known.is_some())
}

/// The code for any structure with a rod of [`KNOWN`] numbers of modes: loops over modes are written out.
const OF_KNOWN: [FlexibleEnds; KNOWN.len()] = [
    Mechanism::ends_of_any::<FixedCounts<{ KNOWN[0].bending }, { KNOWN[0].axial }>>,
    Mechanism::ends_of_any::<FixedCounts<{ KNOWN[1].bending }, { KNOWN[1].axial }>>,
];

/// The loop over the stages of a step for any structure with `states` states; the number of states is a constant in its
/// sums.
fn stages_of_all(states: usize) -> Stages {
    macro_rules! of {
        ($($n:literal)*) => {
            match states {
                $($n => |mechanism, tableau, conditions, t, y, h, k| {
                    run_stages::<$n>(tableau, t, y, h, k, |t, y, rates| mechanism.rates_of_one(conditions, t, y, rates))
                },)*
                _ => |_, _, _, _, _, _, _| false,
            }
        };
    }
    of!(4 6 8 10 12 14 16 18 20 22 24 26)
}

/// Code compiled once per number type for any structure; with a flexible rod, in the arrays for any rod, but for known numbers of
/// modes, and for eight states, whose arrays would not fit into a host's stack.
impl Mechanism {
    /// Writes the rates of a state.
    #[inline(never)]
    pub fn rates_of_one(&self, conditions: &Conditions, t: f64, y: &[f64], rates: &mut [f64]) {
        match &self.rod {
            None => self.rates(&self.structure, conditions, t, y, rates),
            Some(rod) => self.flexible_ends(rod, conditions, t, y, rates, None),
        }
    }

    /// Writes the rates of eight states, each at its own time. A rod with more modes than [`RodCapacity::Many`] has no
    /// code for eight states, nor has any rod without [`ROWS_WITH_MODES`]: its states go one after the other.
    #[inline(never)]
    pub fn rates_of_eight(&self, conditions: &Conditions, t: F64x8, y: &[F64x8], rates: &mut [F64x8]) {
        match &self.rod {
            None => self.rates(&self.structure, conditions, t, y, rates),
            Some(rod) if rod.modes.room == RodCapacity::All || !ROWS_WITH_MODES => {
                one_by_one(&|t, y, rates| self.rates_of_one(conditions, t, y, rates), &t, y, rates);
            }
            Some(rod) => self.flexible_rates_of_eight(rod, conditions, t, y, rates),
        }
    }

    /// Writes the rates with derivatives.
    #[inline(never)]
    pub fn tangent_rates(&self, conditions: &Conditions, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        match &self.rod {
            None => self.drop_rigid_motion(conditions, t, y, rates),
            Some(rod) => self.drop_flexible_motion(rod, conditions, t, y, rates),
        }
    }

    /// Writes the rates and event functions.
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
            Some(rod) => self.flexible_ends(rod, conditions, t, y, rates, Some(event_functions)),
        }
    }

    #[inline(never)]
    pub(super) fn place(&self, t: f64, y: &[f64]) -> Configuration<f64> {
        self.configuration(&self.structure, t, y)
    }

    /// Angles, places and velocities with a flexible rod, and its chord.
    #[inline(never)]
    pub(super) fn pose_and_chord(&self, rod: &FlexibleRod, t: f64, y: &[f64]) -> (Pose, Chord<f64>) {
        self.flexible_pose::<f64, ALL_MODES, ALL_FUNCTIONS>(rod, t, y)
    }

    /// The evaluation of an instant; writes the rates.
    #[inline(never)]
    pub fn evaluation(&self, conditions: &Conditions, t: f64, y: &[f64], rates: &mut [f64]) -> Evaluation {
        match &self.rod {
            None => self.rates_and_evaluation(&self.structure, conditions, t, y, rates),
            Some(rod) => self.flexible_instant::<f64>(rod, conditions, t, y, rates),
        }
    }

    /// The evaluation of an instant with derivatives; writes the rates.
    #[inline(never)]
    pub fn tangent_evaluation(
        &self,
        conditions: &Conditions,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) -> Evaluation<Tangent> {
        match &self.rod {
            None => self.rigid_tangent_evaluation(conditions, t, y, rates),
            Some(rod) => self.flexible_instant::<Tangent>(rod, conditions, t, y, rates),
        }
    }

    /// The evaluation with a rigid rod. It is not compiled into the function that calls those with a flexible rod, too: its
    /// stack frame would be there for both.
    #[inline(never)]
    fn rigid_tangent_evaluation(
        &self,
        conditions: &Conditions,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) -> Evaluation<Tangent> {
        let (configuration, loads, accelerations) = self.rigid_tangent_motion(conditions, t, y, rates);
        evaluation(&self.structure, configuration, loads, &accelerations)
    }

    /// The motion with a rigid rod and derivatives, compiled once for evaluations and for rates alone.
    #[inline(never)]
    fn rigid_tangent_motion(
        &self,
        conditions: &Conditions,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) -> (Configuration<Tangent>, Loads<Tangent>, Accelerations<Tangent>) {
        self.motion(&self.structure, conditions, t, y, rates)
    }

    /// Writes the rates and discards the motion, which leaves the stack.
    #[inline(never)]
    fn drop_rigid_motion(&self, conditions: &Conditions, t: Tangent, y: &[Tangent], rates: &mut [Tangent]) {
        self.rigid_tangent_motion(conditions, t, y, rates);
    }

    /// The motion with a flexible rod whose counts are known at compile time; writes the rates. `None` if the rod is rigid.
    #[inline(always)]
    fn counted_motion<R: Scalar, C: CompiledCounts>(
        &self,
        of: &Structure,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> Option<FlexibleMotion<R, 4>> {
        let rod = self.rod.as_ref()?;
        Some(self.flexible_rates::<R, C, 4, 12>(of, rod, conditions, t, y, rates, &mut Inertia::default(), None))
    }

    /// Writes the rates and, where they are asked for, the event functions, with a rod whose counts are known at compile time.
    #[inline(always)]
    fn counted_ends<C: CompiledCounts>(
        &self,
        of: &Structure,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        event_functions: Option<&mut EventFunctions>,
    ) {
        let motion = self.counted_motion::<_, C>(of, conditions, t, y, rates);
        if let (Some(motion), Some(event_functions)) = (motion, event_functions) {
            motion.event_functions(self, of, &conditions.contacts, event_functions);
        }
    }

    /// As [`Self::counted_ends`], for any structure.
    #[inline(never)]
    fn ends_of_any<C: CompiledCounts>(
        &self,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        event_functions: Option<&mut EventFunctions>,
    ) {
        self.counted_ends::<C>(&self.structure, conditions, t, y, rates, event_functions);
    }

    /// Writes the rates and, where they are asked for, the event functions.
    #[inline(never)]
    fn flexible_ends(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        event_functions: Option<&mut EventFunctions>,
    ) {
        let known = rod.known.as_ref().and_then(|known| KNOWN.iter().position(|counts| *counts == known.counts));
        if let Some(place) = known {
            let (counts, ends) = (KNOWN[place], OF_KNOWN[place]);
            if counts.modes() == rod.modes.counts.modes() {
                return ends(self, conditions, t, y, rates, event_functions);
            }
            return self.with_more_modes(rod.modes.counts, counts, y, rates, |y, rates| {
                ends(self, conditions, t, y, rates, event_functions);
            });
        }
        let motion = self.flexible_motion::<f64>(rod, conditions, t, y, rates, &mut Inertia::default(), None);
        if let Some(event_functions) = event_functions {
            motion.event_functions(self, &self.structure, &conditions.contacts, event_functions);
        }
    }

    /// Calls `ends` with the state of a rod with `more` modes than its `own`, and takes its rates. Modes that are added stand
    /// still.
    fn with_more_modes(
        &self,
        own: Counts,
        more: Counts,
        y: &[f64],
        rates: &mut [f64],
        ends: impl FnOnce(&[f64], &mut [f64]),
    ) {
        let bent = self.structure.positions + own.bending;
        let (p, longer) = (bent + own.axial, self.structure.positions + more.modes());
        let stretched = bent + more.bending - own.bending;
        let bristles = y.len() - 2 * p;
        // Where states stand, where they go, and how many.
        let runs = [
            (0, 0, bent),
            (bent, stretched, own.axial),
            (p, longer, bent),
            (p + bent, longer + stretched, own.axial),
            (2 * p, 2 * longer, bristles),
        ];
        let (mut states, mut found) = ([0.0; MAX_STATES], [0.0; MAX_STATES]);
        let all = 2 * longer + bristles;
        for (from, to, count) in runs {
            states[to..][..count].copy_from_slice(&y[from..][..count]);
        }
        ends(&states[..all], &mut found[..all]);
        for (from, to, count) in runs {
            rates[from..][..count].copy_from_slice(&found[to..][..count]);
        }
    }

    #[inline(never)]
    fn flexible_rates_of_eight(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: F64x8,
        y: &[F64x8],
        rates: &mut [F64x8],
    ) {
        let inertia = &mut Inertia::default();
        self.flexible_rates::<F64x8, RuntimeCounts, { RodCapacity::Many.size()[0] }, { RodCapacity::Many.size()[1] }>(
            &self.structure,
            rod,
            conditions,
            t,
            y,
            rates,
            inertia,
            None,
        );
    }

    #[inline(never)]
    #[expect(clippy::too_many_arguments, reason = "as of what is inlined into it")]
    fn flexible_motion<R: Scalar>(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
        inertia: &mut Inertia<R, ALL_MODES>,
        modal_energy: Option<&mut R>,
    ) -> FlexibleMotion<R, ALL_MODES> {
        self.flexible_rates::<R, RuntimeCounts, ALL_MODES, ALL_FUNCTIONS>(
            &self.structure,
            rod,
            conditions,
            t,
            y,
            rates,
            inertia,
            modal_energy,
        )
    }

    /// Writes the rates and discards the motion.
    #[inline(never)]
    fn drop_flexible_motion(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: Tangent,
        y: &[Tangent],
        rates: &mut [Tangent],
    ) {
        self.flexible_motion::<Tangent>(rod, conditions, t, y, rates, &mut Inertia::default(), None);
    }

    #[inline(never)]
    fn flexible_instant<R: Scalar>(
        &self,
        rod: &FlexibleRod,
        conditions: &Conditions,
        t: R,
        y: &[R],
        rates: &mut [R],
    ) -> Evaluation<R> {
        let mut inertia = Inertia::default();
        let mut energy = R::ZERO;
        let motion = self.flexible_motion::<R>(rod, conditions, t, y, rates, &mut inertia, Some(&mut energy));
        motion.evaluation(&inertia, energy, self, rod, y, rates)
    }
}
