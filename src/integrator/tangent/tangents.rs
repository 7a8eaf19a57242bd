//! Directions that follow a motion, step by step.

use super::flow::{Flow, Path, Roots};
use super::saltation::{Grazing, cross, near_miss};
use super::variational::Variational;
use crate::integrator::dense_output::Step;
use crate::integrator::{EventFunction, Integrator, MAX_EVENTS, MAX_STATES, SolverState, StepPoint};
use nalgebra::{DMatrix, RowDVector};

/// Directions of neighbouring motions, in columns: states in the first rows, then memories, in the order of the
/// [`Variational`] system.
///
/// They are known at the start and at the front of the integrator's last step and follow it: [`Tangents::follow`] after
/// each accepted step, [`Tangents::shorten`] after the step was shortened.
#[derive(Clone, Debug)]
pub struct Tangents<D> {
    start: Placed<D>,
    front: Placed<D>,
    /// Parameters in rows.
    parameters: DMatrix<f64>,
    least: Vec<f64>,
    tolerance: f64,
    flow: Flow,
    /// Where the first order ended.
    grazing: Option<Grazing>,
}

/// Directions at one point of the motion.
#[derive(Clone, Debug)]
struct Placed<D> {
    point: StepPoint<D>,
    directions: DMatrix<f64>,
    /// Whether an event happened there.
    crossed: bool,
}

impl<D: Copy> Tangents<D> {
    /// Directions at the front of `state`. `parameters` are the shares of each direction (in columns) in each parameter
    /// of the system (in rows). A part of a step errs by at most `tolerance` relative to its direction, or to the size `least`
    /// of that direction, states in units of their scales, if the direction is smaller.
    ///
    /// # Panics
    /// If rows or columns do not fit.
    pub fn new(
        system: &dyn Variational<Discrete = D>,
        state: &SolverState<D>,
        directions: DMatrix<f64>,
        parameters: DMatrix<f64>,
        least: Vec<f64>,
        tolerance: f64,
    ) -> Self {
        let n = state.front().y.len();
        assert_eq!(directions.nrows(), n + system.memories(), "a row for each state and memory");
        assert_eq!(parameters.shape(), (system.parameters(), directions.ncols()), "a row for each parameter");
        let flow = Flow::new(system.system().layout(), system.system().scales(), directions.ncols());
        let front = Placed { point: state.front().clone(), directions, crossed: true };
        Self { start: front.clone(), front, parameters, least, tolerance, flow, grazing: None }
    }

    /// Directions at the front.
    ///
    /// # Errors
    /// `Grazing`, where the first order has ended.
    pub fn directions(&self) -> Result<&DMatrix<f64>, Grazing> {
        self.grazing.map_or(Ok(&self.front.directions), Err)
    }

    /// The size of each direction below which it counts as none.
    pub fn least(&self) -> &[f64] {
        &self.least
    }

    /// Replaces the directions at the front, for instance by orthogonal ones. Directions before are then unknown: the
    /// motion must not be shortened beyond. What came near grazing before no longer counts.
    pub fn set_directions(&mut self, directions: DMatrix<f64>) {
        self.front.directions = directions;
        self.grazing = None;
    }

    /// The shares of each direction (in columns) in each parameter (in rows).
    pub fn shares(&self) -> &DMatrix<f64> {
        &self.parameters
    }

    /// Replaces the share of each direction in one parameter, from the front on.
    ///
    /// # Panics
    /// If there is no such parameter, or not one share for each direction.
    pub fn set_shares(&mut self, parameter: usize, shares: impl Iterator<Item = f64>) {
        self.parameters.set_row(parameter, &RowDVector::from_iterator(self.parameters.ncols(), shares));
    }

    /// Follows the last step of `motion`, which was accepted after the last call.
    pub fn follow(&mut self, system: &dyn Variational<Discrete = D>, motion: &Integrator<D>) {
        let state = motion.state();
        let close = self.close(system);
        // An event may have happened at the front before the step.
        let Placed { point, directions, crossed } = &mut self.front;
        if system.differ(&point.discrete, &state.start().discrete) {
            note(&mut self.grazing, cross(system, [point, state.start()], &self.parameters, close, directions));
            *crossed = true;
        }
        point.copy_from(state.start());
        std::mem::swap(&mut self.start, &mut self.front);
        self.run(system, motion);
    }

    /// Follows the last step of `motion`, whose end has changed since the last call.
    pub fn shorten(&mut self, system: &dyn Variational<Discrete = D>, motion: &Integrator<D>) {
        self.run(system, motion);
    }

    /// Directions at `t` in the last step of `motion`; at its end, behind the events there.
    ///
    /// # Errors
    /// `Grazing`, where the first order has ended.
    pub fn at(
        &mut self,
        system: &dyn Variational<Discrete = D>,
        motion: &Integrator<D>,
        t: f64,
    ) -> Result<DMatrix<f64>, Grazing> {
        if let Some(grazing) = self.grazing {
            return Err(grazing);
        }
        if t >= self.front.point.t {
            return Ok(self.front.directions.clone());
        }
        let mut directions = self.start.directions.clone();
        let step = motion.state().last_step(system.system().layout());
        let share = (t - step.t) / step.h;
        self.advance(system, motion, step, share, &mut directions);
        Ok(directions)
    }

    /// The largest error of a distance that counts as small.
    fn close(&self, system: &dyn Variational<Discrete = D>) -> f64 {
        self.tolerance * system.system().event_scale()
    }

    /// From the start of the last step to its front.
    fn run(&mut self, system: &dyn Variational<Discrete = D>, motion: &Integrator<D>) {
        let state = motion.state();
        let (end, front) = (state.end(), state.front());
        let step = state.last_step(system.system().layout());
        let mut directions = self.start.directions.clone();
        self.advance(system, motion, step, 1.0, &mut directions);
        let close = self.close(system);
        let missed = near_miss([step.t, end.t], system.system().event_count(), close, |share| {
            let mut y = [0.0; MAX_STATES];
            let y = &mut y[..step.layout.states];
            step.state(share, None, y);
            let mut functions = [EventFunction::default(); MAX_EVENTS];
            let t = step.t + share * step.h;
            system.system().event_functions(&state.start().discrete, t, y, &mut functions);
            functions
        });
        note(&mut self.grazing, missed.map_or(Ok(()), Err));
        let crossed = system.differ(&end.discrete, &front.discrete);
        if crossed {
            note(&mut self.grazing, cross(system, [end, front], &self.parameters, close, &mut directions));
        }
        self.front.point.copy_from(front);
        self.front.directions = directions;
        self.front.crossed = crossed;
    }

    fn advance(
        &mut self,
        system: &dyn Variational<Discrete = D>,
        motion: &Integrator<D>,
        step: Step<'_>,
        share: f64,
        directions: &mut DMatrix<f64>,
    ) {
        let state = motion.state();
        let end = system.differ(&state.end().discrete, &state.front().discrete);
        let path = Path {
            system,
            discrete: &state.start().discrete,
            step,
            inside: &|t, y| motion.inside(t, y),
            roots: Roots { start: self.start.crossed, end },
            parameters: &self.parameters,
            least: &self.least,
            tolerance: self.tolerance,
        };
        self.flow.advance(&path, [0.0, share], directions);
    }
}

/// Keeps the first end of the first order.
fn note(grazing: &mut Option<Grazing>, result: Result<(), Grazing>) {
    if grazing.is_none() {
        *grazing = result.err();
    }
}
