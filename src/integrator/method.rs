//! The interface between the integrator and an integration method. A method is a value that owns its workspace and the
//! history from which it predicts the next step.

use super::dense_output::Step;
use super::snapshot::{Reader, Snapshot};
use super::state::StepPoint;
use super::system::{EventFunctions, MAX_EVENTS, System};

/// Properties of a method that step control depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// Name in the `solver.method` enumeration.
    pub name: &'static str,
    /// Order of the solution.
    pub order: u32,
    /// Whether the method has an error estimate that determines the step; otherwise the step is fixed.
    pub adaptive: bool,
    /// Whether the method has a second error estimate, of lower order.
    pub coarse: bool,
    /// Whether events are located and steps end at them; otherwise events are noticed at the end of a step.
    pub locates: bool,
    /// The error estimate is proportional to the step raised to this power.
    pub error_power: f64,
    /// Whether the state within a step is interpolated between its ends. An interpolant would leave the slow motion of a stiff
    /// system: otherwise the method has a [polynomial of its own](Method::inside), or a shorter step is made to each requested
    /// time.
    pub interpolates: bool,
    /// Whether an attempt computes the rates and event functions at its end.
    pub gives_end: bool,
    /// Whether a step is predicted from the one before it.
    pub predicts: bool,
    /// Whether a step as long as the one before it is predicted with less work.
    pub keeps_length: bool,
    /// Share of the tolerance that one step may use.
    pub error_share: f64,
    /// The other kinds of this method, in the order in which they take over a step whose attempts keep failing.
    pub others: &'static [MethodKind],
}

/// Share of the tolerance that one step may use where the errors of many steps accumulate.
pub const ERROR_SHARE: f64 = 0.4;
/// [scales] Error of each state in an attempt in which Newton's method has not converged. No budget makes it tolerable.
pub const NOT_CONVERGED: f64 = 1e30;

/// How a method computes a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodKind {
    /// From accelerations at several nodes, evaluated together; see [`block`](super::methods::block).
    Block,
    /// From the stages of an explicit method, evaluated one after the other.
    Explicit,
    /// By an implicit or linearly implicit method.
    Implicit,
}

impl MethodKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Block, Self::Explicit, Self::Implicit];
}

/// The tolerance of an attempted step, and its results other than the state at its end.
#[derive(Clone, Debug)]
pub struct Attempt {
    /// The tolerance, in scales of the states, for a method that iterates.
    pub tolerance: f64,
    /// Number of Jacobians that the attempt has computed and factorised.
    pub jacobians: u64,
    /// Estimated error of each state.
    pub error: Vec<f64>,
    /// Second error estimate, where the method has one.
    pub coarse_error: Vec<f64>,
    /// Deviation of the early stages, which no error estimate weighs: how far h times their rates departs from the line
    /// between the first stage and the first weighted stage, beyond half the larger of those two.
    pub unseen: Vec<f64>,
    /// Event functions at the end, once they are computed.
    pub events: EventFunctions,
}

impl Attempt {
    /// Workspace for `states` states and a tolerance.
    pub fn new(states: usize, tolerance: f64) -> Self {
        let zeros = || vec![0.0; states];
        let events = [Default::default(); MAX_EVENTS];
        Self { tolerance, jacobians: 0, error: zeros(), coarse_error: zeros(), unseen: zeros(), events }
    }
}

/// What an accepted step took, and what follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepWork {
    /// Number of evaluations of the rates, those of rejected attempts included.
    pub evaluations: u64,
    /// [s] Length that step control proposes for the next step.
    pub next: f64,
}

/// What a method reports after one of its steps has been accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepAdvice {
    /// [s] Upper bound of the next step.
    pub longest_step: f64,
    /// Number of evaluations of the rates that the report took.
    pub evaluations: u64,
}

impl StepAdvice {
    /// No bound and no evaluations.
    pub const NONE: Self = Self { longest_step: f64::INFINITY, evaluations: 0 };
}

/// An integration method, or several that take turns.
pub trait Method<D: Copy>: Send {
    /// Properties of the present kind of steps.
    fn properties(&self) -> &Properties;

    /// Prepares for the first step of a motion of `system`.
    fn begin(&mut self, _system: &dyn System<Discrete = D>) {
        self.forget();
    }

    /// Attempts a step of `h` [s] from `start`: writes the state at the `end`, the rates there if the method gives
    /// them, and the results in `attempt`. Returns the number of evaluations of the rates.
    fn attempt(
        &mut self,
        system: &dyn System<Discrete = D>,
        start: &StepPoint<D>,
        h: f64,
        end: &mut StepPoint<D>,
        attempt: &mut Attempt,
    ) -> u64;

    /// Keeps the last attempt, which went from `start` to the time `end` [s], as the history for the next prediction.
    /// Only for a method that [predicts](Properties::predicts).
    fn remember(&mut self, _start: &StepPoint<D>, _end: f64) {}

    /// Writes the state at the time `t` [s] in the `step`, if that is the step that was remembered last and the method has a
    /// polynomial of its own. Returns whether it is written.
    fn inside(&self, _step: &Step<'_>, _t: f64, _y: &mut [f64]) -> bool {
        false
    }

    /// Discards the history; the next step is not predicted.
    fn forget(&mut self) {}

    /// Reports on the step from `start` to `end`, which the last attempt has become.
    fn accepted(
        &mut self,
        _system: &dyn System<Discrete = D>,
        _start: &StepPoint<D>,
        _end: &StepPoint<D>,
        _work: StepWork,
    ) -> StepAdvice {
        StepAdvice::NONE
    }

    /// The present kind of steps.
    fn kind(&self) -> MethodKind {
        MethodKind::Explicit
    }

    /// Selects the kind of steps, if the method has more than one.
    fn set_kind(&mut self, _kind: MethodKind) {}

    /// The kind that the next step should have.
    fn next_kind(&self) -> MethodKind {
        self.kind()
    }

    /// Stays with the present kind, after a step that failed in the intended kind.
    fn hand_over(&mut self) {}

    /// Appends the method's memory to a snapshot.
    fn save(&self, _snapshot: &mut Snapshot) {}

    /// Restores what [`save`](Self::save) appended; `None` if no run can have produced it.
    fn load(&mut self, _reader: &mut Reader<'_>) -> Option<()> {
        Some(())
    }
}
