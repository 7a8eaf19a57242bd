//! A system of two or three states under the product's own integrator, as a flow.

use anyhow::Result;
use fmu_harness::dynamics::{Flow, Point};
use slidercrank::integrator::methods::named;
use slidercrank::integrator::{self, Integrator, Settings, WorkLimit};

/// Noticeable differences of these systems.
const SCALE: f64 = 1e-3;

/// A system that runs.
pub struct System<const N: usize, P> {
    problem: P,
    integrator: Integrator<()>,
    time: f64,
}

impl<const N: usize, P: integrator::System<Discrete = ()>> System<N, P> {
    /// Starts at time 0.
    pub fn start(problem: P, start: [f64; N]) -> Self {
        let settings = Settings { tolerance: 1e-9, fixed_step: 0.0, effort: WorkLimit::ANY };
        let integrator = Integrator::start(&problem, named("verner7", N).expect("a method"), settings, 0.0, &start, ());
        Self { problem, integrator, time: 0.0 }
    }

    /// Where it is.
    pub fn state(&mut self) -> [f64; N] {
        let (y, ()) = self.integrator.state_at(&self.problem, self.time);
        std::array::from_fn(|i| y[i])
    }
}

impl<const N: usize, P: integrator::System<Discrete = ()>> Flow for System<N, P> {
    fn time(&self) -> f64 {
        self.time
    }

    fn advance(&mut self, time: f64) -> Result<()> {
        self.integrator.advance(&self.problem, time)?;
        self.integrator.truncate(&self.problem, time);
        self.time = time;
        Ok(())
    }

    fn point(&mut self) -> Point {
        let coordinates = self.state().iter().map(|x| x / SCALE).collect();
        Point { time: self.time, coordinates, remembered: 0, modes: vec![] }
    }

    fn place(&mut self, point: &Point) {
        let mut state = [0.0; N];
        state.iter_mut().zip(&point.coordinates).for_each(|(x, coordinate)| *x = coordinate * SCALE);
        self.integrator.place(&self.problem, point.time, &state, ());
        self.time = point.time;
    }
}
