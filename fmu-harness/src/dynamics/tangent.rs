//! A running mechanism with the tangent of its motion.

use super::Machine;
use super::machine::{Simulated, start_values, values};
use anyhow::{Context, Result};
use nalgebra::DMatrix;
use slidercrank::model::coordinates::state_variables;
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::Scene;
use slidercrank::scene::profile::Profiles;
use slidercrank::scene::read::SceneFile;
use slidercrank::simulation::Phase;
use slidercrank::simulation::step_map::grazed;
use slidercrank::simulation::variation::{Seed, Variation};

/// A simulation with its tangent, whose inputs may follow the crank angle.
pub struct Tangent {
    variation: Variation,
    /// Place of the crank angle among the states, if it is one.
    crank_angle: Option<usize>,
    scene: Scene,
}

impl Machine<Tangent> {
    /// Starts a scene, to differentiate by `seeds`.
    ///
    /// # Errors
    /// If it cannot start or has no tangent.
    pub fn with_tangent(file: &SceneFile, seeds: &[Seed]) -> Result<Self> {
        let variation = Variation::start(&file.scene, start_values(file), seeds)?;
        let crank_angle = state_variables(&file.scene).iter().position(|state| state.name.ends_with("crank.angle"));
        let scales = variation.phase_scales().clone();
        let scene = file.scene.clone();
        Self::of(file, Tangent { variation, crank_angle, scene }, scales)
    }

    /// The simulation with its tangent.
    pub fn variation(&mut self) -> &mut Variation {
        &mut self.simulation.variation
    }

    /// Derivatives of the point of phase space (states, then approach speeds of all contacts) by each seed, in columns,
    /// all in noticeable differences.
    ///
    /// # Errors
    /// Where the first order has ended near grazing, with joint and time.
    pub fn directions(&mut self) -> Result<DMatrix<f64>> {
        let scales: Vec<f64> = self.rows().into_iter().map(|(_, scale)| scale).collect();
        self.directions_in(&scales)
    }

    /// As [`directions`](Self::directions), in units of these scales.
    ///
    /// # Errors
    /// As [`directions`](Self::directions).
    pub fn directions_in(&mut self, scales: &[f64]) -> Result<DMatrix<f64>> {
        let rows = self.rows();
        let directions = self.simulation.directions()?;
        Ok(DMatrix::from_fn(rows.len(), directions.ncols(), |i, j| directions[(rows[i].0, j)] / scales[i]))
    }

    /// Replaces the directions, given as by [`directions`](Self::directions). Grazing before no longer counts.
    pub fn set_directions(&mut self, directions: &DMatrix<f64>) {
        let rows = self.rows();
        let states = self.simulation.variation.states();
        let mut all = DMatrix::zeros(states + slidercrank::simulation::CONTACTS, directions.ncols());
        for (i, (row, scale)) in rows.into_iter().enumerate() {
            for j in 0..directions.ncols() {
                all[(row, j)] = directions[(i, j)] * scale;
            }
        }
        self.simulation.variation.set_directions(all);
    }

    /// Row and scale of each number of phase space.
    fn rows(&mut self) -> Vec<(usize, f64)> {
        let states = self.simulation.variation.states();
        let scales = self.simulation.variation.phase_scales();
        let approach = (states..states + slidercrank::simulation::CONTACTS).map(|row| (row, scales.approach));
        scales.states.iter().copied().enumerate().chain(approach).collect()
    }

    /// Derivatives of the outputs by each seed.
    ///
    /// # Errors
    /// As [`directions`](Self::directions).
    pub fn output_derivatives(&mut self) -> Result<Vec<Outputs>> {
        let Tangent { variation, scene, .. } = &mut self.simulation;
        Ok(variation.output_derivatives().map_err(|grazing| grazed(scene, grazing))?)
    }
}

impl Tangent {
    fn directions(&mut self) -> Result<DMatrix<f64>> {
        Ok(self.variation.directions().map_err(|grazing| grazed(&self.scene, grazing))?)
    }
}

impl Simulated for Tangent {
    fn time(&self) -> f64 {
        self.variation.time()
    }

    fn advance_to(&mut self, time: f64) -> Result<()> {
        Ok(self.variation.advance_to(time)?)
    }

    fn outputs(&mut self) -> Outputs {
        self.variation.outputs()
    }

    fn output_rates(&mut self) -> Outputs {
        self.variation.output_rates()
    }

    fn apply(&mut self, inputs: &Profiles) {
        let (time, angle) = (self.time(), self.outputs().crank.angle);
        let Profiles { crank_torque, slider_load } = inputs;
        // Per radian of the crank, at constant time.
        let slope = |profile: &slidercrank::scene::profile::Profile| {
            profile.rate(time, angle, 1.0) - profile.rate(time, angle, 0.0)
        };
        let (torque, load) = (slope(crank_torque), slope(slider_load));
        let angles = self.crank_angle.zip(self.variation.directions().ok());
        self.variation.set_dependent_inputs(values(inputs, time, angle), |seed| {
            let turned = angles.as_ref().map_or(0.0, |(place, directions)| directions[(*place, seed)]);
            Inputs { crank_torque: torque * turned, slider_load: load * turned }
        });
    }

    fn phase(&mut self) -> Phase {
        self.variation.phase()
    }

    fn place(&mut self, phase: &Phase) {
        self.variation.place(phase);
    }
}

/// A seed for each state of a scene.
///
/// # Errors
/// If the scene cannot start.
pub fn all_states(file: &SceneFile) -> Result<Vec<Seed>> {
    let simulation =
        slidercrank::simulation::Simulation::start(&file.scene, start_values(file)).context("the scene")?;
    Ok((0..simulation.phase_scales().states.len()).map(Seed::State).collect())
}
