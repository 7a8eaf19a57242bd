//! What the integrator needs to know of a method. A method is a value that owns what it works with and what it predicts
//! the next step from.

use super::snapshot::{Reader, Snapshot};
use super::state::StepPoint;
use super::system::{EventFunctions, MAX_EVENTS, System};

/// What the control of a step needs to know of the method that makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// Name in the `solver.method` enumeration.
    pub name: &'static str,
    /// Order of the solution that is carried on.
    pub order: u32,
    /// There is an error estimate, to which the step is fitted; otherwise the step is fixed.
    pub adaptive: bool,
    /// There is a second, lower-order estimate.
    pub coarse: bool,
    /// Events are located and landed on; otherwise they are noticed at the end of a step.
    pub locates: bool,
    /// The power of the step with which the error estimate falls.
    pub error_power: f64,
    /// States within a step are interpolated; otherwise a shorter step is made to each: an interpolant
    /// leaves the slow motion of a stiff system.
    pub interpolates: bool,
    /// An attempt gives rates and event functions at its end.
    pub gives_end: bool,
    /// A step is predicted from the one before it.
    pub predicts: bool,
    /// This share of the tolerance is for one step.
    pub error_share: f64,
    /// The kinds that attempt a step which time and again cannot be made in the present one, in their order.
    pub others: &'static [MethodKind],
}

/// The share of the tolerance for one step where the errors of many add up.
pub const ERROR_SHARE: f64 = 0.4;

/// How a step is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodKind {
    /// By accelerations at several instants together, see [`block`](super::methods::block).
    Block,
    /// By the stages of an explicit method, one after the other.
    Explicit,
    /// By a linearly implicit method.
    Implicit,
}

impl MethodKind {
    /// All, in their order.
    pub const ALL: [Self; 3] = [Self::Block, Self::Explicit, Self::Implicit];
}

/// What an attempted step tells beside the state at its end.
#[derive(Clone, Debug)]
pub struct Attempt {
    /// The step's error in every state.
    pub error: Vec<f64>,
    /// A second estimate, where the method has one.
    pub coarse_error: Vec<f64>,
    /// What early stages saw that no error estimate weighs: by how much h times their rates leaves
    /// the line between the first stage and the first that is weighted, beyond half of those.
    pub unseen: Vec<f64>,
    /// The event functions at the end, where the method gives them; otherwise once they are computed.
    pub events: EventFunctions,
}

impl Attempt {
    /// Of no step yet, for so many states.
    pub fn new(states: usize) -> Self {
        let zeros = || vec![0.0; states];
        Self { error: zeros(), coarse_error: zeros(), unseen: zeros(), events: [Default::default(); MAX_EVENTS] }
    }
}

/// What a method says after a step of it has been accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepAdvice {
    /// [s] The next step should not be longer.
    pub longest_step: f64,
    /// How many evaluations it took to find out.
    pub evaluations: u64,
}

impl StepAdvice {
    /// None.
    pub const NONE: Self = Self { longest_step: f64::INFINITY, evaluations: 0 };
}

/// A one-step method, or some that take turns.
pub trait Method<D: Copy>: Send {
    /// What is particular to its steps of the present kind.
    fn properties(&self) -> &Properties;

    /// Prepares for the first step of a motion of `system`.
    fn begin(&mut self, _system: &dyn System<Discrete = D>) {
        self.forget();
    }

    /// Attempts a step of `h` from `start`: writes the state at its `end`, where it gives them the rates there, too, and
    /// what else it tells. Returns how many evaluations of the rates it took.
    fn attempt(
        &mut self,
        system: &dyn System<Discrete = D>,
        start: &StepPoint<D>,
        h: f64,
        end: &mut StepPoint<D>,
        attempt: &mut Attempt,
    ) -> u64;

    /// From now on predicts from the last attempt, which went from `start` to `end` [s]; a method that
    /// [predicts](Properties::predicts) only.
    fn remember(&mut self, _start: &StepPoint<D>, _end: f64) {}

    /// Predicts nothing from what has been.
    fn forget(&mut self) {}

    /// To be called after the last attempt has become the step from `start` to `end`.
    fn accepted(
        &mut self,
        _system: &dyn System<Discrete = D>,
        _start: &StepPoint<D>,
        _end: &StepPoint<D>,
    ) -> StepAdvice {
        StepAdvice::NONE
    }

    /// How attempts are made.
    fn kind(&self) -> MethodKind {
        MethodKind::Explicit
    }

    /// Makes attempts in this way, if there is a choice.
    fn set_kind(&mut self, _kind: MethodKind) {}

    /// How the next step is to be made.
    fn next_kind(&self) -> MethodKind {
        self.kind()
    }

    /// Stays with the present kind, after a step that could not be made as it was to be.
    fn hand_over(&mut self) {}

    /// Appends what it remembers.
    fn save(&self, _snapshot: &mut Snapshot) {}

    /// Takes back what [`save`](Self::save) appended; `None` for what no run can have come to.
    fn load(&mut self, _reader: &mut Reader<'_>) -> Option<()> {
        Some(())
    }
}
