//! A simulation with the tangent of its motion: derivatives of states and outputs by start states, parameters and
//! inputs, through impacts.
//!
//! The motion is that of a [`Simulation`](super::Simulation) to the bit. The equations of the tangent stand in
//! [`tangent`](crate::integrator::tangent).

mod levels;
pub(super) mod line;
mod neighbours;
mod seed;
mod varied;

pub use crate::integrator::tangent::Grazing;
pub use seed::Seed;

use super::assemble;
use super::error::SimulationError;
use super::motion::Motion;
use super::names::Names;
use super::phase::{Phase, PhaseScales};
use super::run::Run;
use super::side::Side;
use super::start::pose;
use crate::integrator::tangent::Tangents;
use crate::integrator::{Reader, Snapshot, SolverState};
use crate::model::drive::InputSignal;
use crate::model::signals::{Inputs, Outputs};
use crate::model::state::{CONTACTS, Conditions};
use crate::scene::parameter::Kind;
use crate::scene::{Method, Scene};
use line::Line;
use nalgebra::DMatrix;
use neighbours::Neighbours;
use varied::Varied;

/// A simulation with the tangent of its motion.
pub struct Variation {
    run: Run,
    names: Names,
    time: f64,
    scales: PhaseScales,
    seeds: Vec<Seed>,
    /// Those of the parameters among the seeds, then those of torque and load and of their slopes.
    neighbours: Vec<Neighbours>,
    tangents: Tangents<Conditions>,
    /// Whether the tangent has followed the last step, which may also lie before where it began.
    followed: bool,
    tolerance: f64,
}

/// Tolerance of a scene that is loose enough for its tangent.
const LOOSEST: f64 = 1e-5;

impl Variation {
    /// Starts the simulation of a scene. Derivatives by parameters include that of the start state.
    ///
    /// # Errors
    /// `Scene` as in [`Simulation::start`](super::Simulation::start), or if the scene has no tangent: with the method
    /// `moreau`, or by a parameter that is not real or has no neighbouring values.
    pub fn start(scene: &Scene, inputs: Inputs, seeds: &[Seed]) -> Result<Self, SimulationError> {
        let mut variation = Self::new(scene, inputs, seeds)?;
        let Self { run, neighbours, seeds, .. } = &mut variation;
        let (model, _, integrator) = run.parts();
        let n = model.layout().states;
        let mut directions = DMatrix::zeros(n + CONTACTS, seeds.len());
        for (mut direction, seed) in directions.column_iter_mut().zip(&*seeds) {
            match seed {
                Seed::Parameter(_) => {
                    if let Some(neighbours) = neighbours.iter().find(|neighbours| neighbours.is_of(seed)) {
                        neighbours.write_start(direction.as_mut_slice());
                    }
                }
                _ => seed_present(seed, integrator.state(), direction.as_mut_slice()),
            }
        }
        variation.begin(directions);
        Ok(variation)
    }

    /// A simulation of `scene` that continues where `snapshot` was taken. The state there does not depend on
    /// parameters.
    ///
    /// # Errors
    /// As [`Variation::start`], and `Snapshot` as in [`Simulation::restore`](super::Simulation::restore).
    pub fn resume(scene: &Scene, snapshot: &Snapshot, seeds: &[Seed]) -> Result<Self, SimulationError> {
        let mut variation = Self::new(scene, Inputs::default(), seeds)?;
        let mut reader = Reader::new(snapshot);
        let time = reader.real().filter(|&time| variation.run.load(time, &mut reader).is_some());
        match time {
            Some(time) if reader.is_at_end() => {
                variation.time = time;
                variation.run.phase(time);
                variation.begin_here();
                Ok(variation)
            }
            _ => Err(SimulationError::Snapshot("the saved state is not one of a run of this scene".into())),
        }
    }

    fn new(scene: &Scene, inputs: Inputs, seeds: &[Seed]) -> Result<Self, SimulationError> {
        scene.check_method().map_err(|error| SimulationError::Scene(error.to_string()))?;
        if scene.solver.method == Method::Moreau {
            let reason = "solver.method = moreau: rigid impacts of time stepping have no tangent";
            return Err(SimulationError::Scene(reason.into()));
        }
        let pose = pose(scene)?;
        let signal = InputSignal { at: 0.0, value: inputs, rate: Inputs::default() };
        let mut run = Run::start(scene, &pose, signal, assemble::model(scene));
        let mut neighbours = vec![];
        for seed in seeds {
            match seed {
                Seed::Parameter(parameter) if !matches!(parameter.kind, Kind::Real { .. }) => {
                    return Err(SimulationError::Scene(format!("{} is not a real number", parameter.name)));
                }
                Seed::Parameter(parameter) => neighbours.push(Neighbours::of_parameter(scene, parameter)?),
                _ => {}
            }
        }
        neighbours.extend([Seed::CrankTorque, Seed::SliderLoad].map(Neighbours::of_input));
        neighbours.extend([Seed::CrankTorque, Seed::SliderLoad].map(Neighbours::of_slope));
        let tolerance = scene.solver.tolerance.min(LOOSEST);
        let scales = run.phase_scales();
        let tangents = {
            let (model, _, integrator) = run.parts();
            let varied = Varied { model, neighbours: &neighbours };
            let rows = model.layout().states + CONTACTS;
            Tangents::new(
                &varied,
                integrator.state(),
                DMatrix::zeros(rows, seeds.len()),
                shares(seeds, &neighbours),
                least(scene, &scales, seeds),
                tolerance,
            )
        };
        Ok(Self {
            run,
            names: Names::of(scene),
            time: 0.0,
            scales,
            seeds: seeds.to_vec(),
            neighbours,
            tangents,
            followed: false,
            tolerance,
        })
    }

    /// Begins the tangent at the communication point, where nothing depends on parameters yet.
    fn begin_here(&mut self) {
        let (model, _, integrator) = self.run.parts();
        let mut directions = DMatrix::zeros(model.layout().states + CONTACTS, self.seeds.len());
        for (mut direction, seed) in directions.column_iter_mut().zip(&self.seeds) {
            seed_present(seed, integrator.state(), direction.as_mut_slice());
        }
        self.begin(directions);
    }

    /// Begins the tangent at the front with these directions.
    fn begin(&mut self, directions: DMatrix<f64>) {
        let (model, _, integrator) = self.run.parts();
        let varied = Varied { model, neighbours: &self.neighbours };
        let shares = shares(&self.seeds, &self.neighbours);
        let least = self.tangents.least().to_vec();
        self.tangents = Tangents::new(&varied, integrator.state(), directions, shares, least, self.tolerance);
        self.followed = false;
    }

    /// [s] The communication point reached.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Number of states, including those of an energy audit: the first rows of [`Variation::directions`].
    pub fn states(&mut self) -> usize {
        self.run.parts().0.layout().states
    }

    /// By what the motion is differentiated, in the order of the columns of [`Variation::directions`].
    pub fn seeds(&self) -> &[Seed] {
        &self.seeds
    }

    /// Advances to `time` [s], which must not be less than the time reached.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`](super::Simulation::advance_to).
    pub fn advance_to(&mut self, time: f64) -> Result<(), SimulationError> {
        let Self { run, neighbours, tangents, followed, .. } = self;
        run.begin_interval(self.time);
        let advanced = run.advance_followed(time, &mut |model, integrator| {
            *followed = true;
            tangents.follow(&Varied { model, neighbours }, integrator);
        });
        match advanced {
            Ok(()) => self.time = time,
            Err(error) => {
                self.time = self.time.max(error.time());
                return Err(self.names.explain(error));
            }
        }
        Ok(())
    }

    /// Sets the inputs and their rates from the communication point on, as
    /// [`Simulation::set_inputs`](super::Simulation::set_inputs).
    pub fn set_inputs(&mut self, inputs: Inputs, rates: Inputs) {
        self.run.set_inputs(InputSignal { at: self.time, value: inputs, rate: rates });
        self.shorten();
    }

    /// Sets inputs and rates that depend on the motion from the communication point on: `slopes` are the derivatives of both
    /// by each seed, where the seed is not the input itself.
    pub fn set_dependent_inputs(&mut self, inputs: Inputs, rates: Inputs, slopes: impl Fn(usize) -> [Inputs; 2]) {
        self.set_inputs(inputs, rates);
        self.phase();
        let own = shares(&self.seeds, &self.neighbours);
        // Lines that go on to the bit have begun at an earlier communication point.
        let passed = self.time - self.run.parts().2.state().front().discrete.inputs.at;
        let of_seed = |seed: usize| {
            let [inputs, rates] = slopes(seed);
            let (torque, load) = (rates.crank_torque, rates.slider_load);
            [inputs.crank_torque - passed * torque, inputs.slider_load - passed * load, torque, load]
        };
        let columns: Vec<[f64; 4]> = (0..self.seeds.len()).map(of_seed).collect();
        for (place, row) in (own.nrows() - 4..own.nrows()).enumerate() {
            let own = own.row(row);
            self.tangents.set_shares(row, columns.iter().zip(own.iter()).map(|(added, own)| own + added[place]));
        }
    }

    /// Follows the last step if it has become shorter.
    fn shorten(&mut self) {
        if !self.followed {
            return;
        }
        let (model, _, integrator) = self.run.parts();
        self.tangents.shorten(&Varied { model, neighbours: &self.neighbours }, integrator);
    }

    /// Ends the last step at the communication point; the point of phase space there.
    pub fn phase(&mut self) -> Phase {
        let phase = self.run.phase(self.time);
        self.shorten();
        phase
    }

    /// Continues from `phase`, where nothing depends on parameters and the tangent begins.
    pub fn place(&mut self, phase: &Phase) {
        self.run.place(self.time, phase);
        self.time = phase.time;
        self.begin_here();
    }

    /// Scales of just noticeable differences in a point of phase space.
    pub fn phase_scales(&self) -> &PhaseScales {
        &self.scales
    }

    /// Derivatives of the states (first rows) and of the contacts' approach speeds (below; 0 for open ones) at the
    /// communication point by each seed, in columns.
    ///
    /// # Errors
    /// `Grazing`, where the first order has ended.
    pub fn directions(&mut self) -> Result<DMatrix<f64>, Grazing> {
        let (model, _, integrator) = self.run.parts();
        self.tangents.at(&Varied { model, neighbours: &self.neighbours }, integrator, self.time)
    }

    /// Replaces the directions at the communication point, where the last step then ends. Grazing before no longer counts.
    pub fn set_directions(&mut self, directions: DMatrix<f64>) {
        self.phase();
        self.tangents.set_directions(directions);
    }

    /// Outputs at the communication point.
    pub fn outputs(&mut self) -> Outputs {
        self.run.outputs(self.time, Side::After)
    }

    /// First time derivatives of the real outputs at the communication point; integers and Booleans are meaningless.
    pub fn output_rates(&mut self) -> Outputs {
        self.run.output_rates(self.time, Side::After)
    }

    /// Rates of the states at the communication point.
    pub fn rates(&mut self) -> Vec<f64> {
        let (model, _, integrator) = self.run.parts();
        let (y, conditions) = integrator.state_at(model, self.time);
        let mut rates = vec![0.0; y.len()];
        model.rates(&conditions, self.time, y, &mut rates);
        rates
    }

    /// Derivatives of the real outputs at the communication point by each seed, at constant time; integers and Booleans
    /// are meaningless, and outputs of intervals are 0.
    ///
    /// # Errors
    /// `Grazing`, where the first order has ended.
    pub fn output_derivatives(&mut self) -> Result<Vec<Outputs>, Grazing> {
        let directions = self.directions()?;
        let time = self.time;
        let (model, observer, integrator) = self.run.parts();
        let (y, conditions) = integrator.state_at(model, time);
        let columns = directions.column_iter().zip(&self.seeds).zip(self.tangents.shares().column_iter());
        Ok(columns
            .map(|((direction, seed), shares)| {
                let direction = direction.as_slice();
                let states = Line { model, conditions: &conditions, t: time, y, direction, levels: None };
                let mut moved = match self.neighbours.iter().find(|neighbours| neighbours.is_of(seed)) {
                    Some(of) => of.output_derivative(states, observer),
                    None => states.fitted().outputs(observer),
                };
                for (of, share) in self.neighbours.iter().zip(&shares).filter(|(_, share)| **share != 0.0) {
                    of.add_input(&states, observer, *share, &mut moved);
                }
                moved
            })
            .collect())
    }

    /// Trace of the Jacobian of the rates at the communication point [1/s]: the rate of volume in the space of states.
    pub fn divergence(&mut self) -> f64 {
        let (model, _, integrator) = self.run.parts();
        let (y, conditions) = integrator.state_at(model, self.time);
        let mut jacobian = crate::integrator::Jacobian::new(y.len());
        model.jacobian(&conditions, self.time, y, &mut jacobian);
        (0..model.layout().weighted).map(|i| jacobian.row(i)[i]).sum()
    }
}

/// The shares of each seed in each of the neighbours.
fn shares(seeds: &[Seed], neighbours: &[Neighbours]) -> DMatrix<f64> {
    DMatrix::from_fn(neighbours.len(), seeds.len(), |row, column| {
        f64::from(u8::from(neighbours[row].is_of(&seeds[column])))
    })
}

/// The size of each direction below which it counts as none: that of one state's noticeable difference, or of a noticeable
/// difference from a change of the parameter by all of itself.
fn least(scene: &Scene, scales: &PhaseScales, seeds: &[Seed]) -> Vec<f64> {
    let positive = |size: f64| if size > 0.0 { size } else { 1.0 };
    let of = |seed: &Seed| match seed {
        Seed::State(place) => positive(scales.states.get(*place).copied().unwrap_or_default()),
        Seed::Approach(_) => positive(scales.approach),
        Seed::Parameter(parameter) => positive(levels::size(parameter, scene)),
        Seed::CrankTorque | Seed::SliderLoad => 1.0,
    };
    seeds.iter().map(|seed| 1.0 / of(seed)).collect()
}

/// Writes the direction of a seed in the space of states, where the tangent begins.
fn seed_present(seed: &Seed, state: &SolverState<Conditions>, direction: &mut [f64]) {
    let front = state.front();
    match *seed {
        Seed::State(place) if place < front.y.len() => direction[place] = 1.0,
        Seed::Approach(contact) if contact < CONTACTS && front.discrete.contacts[contact].closed => {
            direction[front.y.len() + contact] = 1.0;
        }
        _ => {}
    }
}
