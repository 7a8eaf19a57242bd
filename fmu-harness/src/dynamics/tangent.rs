//! A running mechanism with the tangent of its motion.

use super::Machine;
use super::machine::Simulated;
use anyhow::{Context, Result};
use nalgebra::DMatrix;
use slidercrank::model::coordinates::{Role, state_variables};
use slidercrank::model::signals::{CrankOutputs, Inputs, Outputs};
use slidercrank::scene::Scene;
use slidercrank::scene::profile::{Profile, Profiles};
use slidercrank::scene::read::SceneFile;
use slidercrank::simulation::Phase;
use slidercrank::simulation::step_map::grazed;
use slidercrank::simulation::variation::{Seed, Variation};

/// A simulation with its tangent, whose inputs may follow the crank angle.
pub struct Tangent {
    variation: Variation,
    /// Places of the crank's angle and speed among the states, if they are states.
    crank: Option<[usize; 2]>,
    scene: Scene,
}

impl Machine<Tangent> {
    /// Starts a scene, to differentiate by `seeds`.
    ///
    /// # Errors
    /// If it cannot start or has no tangent.
    pub fn with_tangent(file: &SceneFile, seeds: &[Seed]) -> Result<Self> {
        let variation = Variation::start(&file.scene, Inputs::at_start(file), seeds)?;
        let crank = state_variables(&file.scene).iter().enumerate().find_map(|(place, state)| match state.role {
            Role::Position(rate) if state.name.ends_with("crank.angle") => Some([place, rate]),
            _ => None,
        });
        let scales = variation.phase_scales().clone();
        let scene = file.scene.clone();
        Self::of(file, Tangent { variation, crank, scene }, scales)
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
        // Inputs that follow the crank depend on the new directions.
        self.look();
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

    /// Derivatives of the crank's angle and speed by each seed; 0 where the first order has ended.
    fn crank_derivatives(&mut self) -> Vec<[f64; 2]> {
        let time = self.time();
        let directions = self.crank.map(|places| (places, self.variation.directions().ok()));
        let of_seed = |(column, seed): (usize, &Seed)| match (&directions, seed) {
            (Some((places, Some(directions))), _) => places.map(|place| directions[(place, column)]),
            // With a prescribed speed, angle = angle_start + speed_start·t.
            (None, Seed::Parameter(parameter)) if parameter.name == "crank.angle_start" => [1.0, 0.0],
            (None, Seed::Parameter(parameter)) if parameter.name == "crank.speed_start" => [time, 1.0],
            _ => [0.0; 2],
        };
        self.variation.seeds().iter().enumerate().map(of_seed).collect()
    }
}

/// Derivatives of a chord's value and slope over a step between two times [s] by the angle and the speed of the crank.
fn chord_derivatives(profile: &Profile, [from, to]: [f64; 2], crank: &CrankOutputs) -> [[f64; 2]; 2] {
    let step = to - from;
    let [before, after] = [0.0, step].map(|passed| profile.slope_over_angle(crank.angle + crank.speed * passed));
    [[before, 0.0], [(after - before) / step, after]]
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

    fn apply(&mut self, inputs: &Profiles, until: f64) {
        let (step, crank) = ([self.time(), until], self.outputs().crank);
        let Profiles { crank_torque, slider_load } = inputs;
        let [torque, load] = [crank_torque, slider_load].map(|profile| chord_derivatives(profile, step, &crank));
        let moved = self.crank_derivatives();
        let [values, rates] = Inputs::chords(inputs, step, &crank);
        self.variation.set_dependent_inputs(values, rates, |seed| {
            let [turned, faster] = moved[seed];
            [0, 1].map(|order| Inputs {
                crank_torque: torque[order][0] * turned + torque[order][1] * faster,
                slider_load: load[order][0] * turned + load[order][1] * faster,
            })
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
        slidercrank::simulation::Simulation::start(&file.scene, Inputs::at_start(file)).context("the scene")?;
    Ok((0..simulation.phase_scales().states.len()).map(Seed::State).collect())
}
