//! The Poincaré map of a mechanism with its exact Jacobian.
//!
//! The section is passed once a turn of the crank. Of a crank with a prescribed speed the map is the motion over a time;
//! of a free crank it is the motion to an angle, along which the neighbours come at other times: its Jacobian is that of
//! the flow, projected along the motion onto the section (T. S. Parker, L. O. Chua, Practical Numerical Algorithms for
//! Chaotic Systems, Springer 1989, 3.2).
//!
//! A contact that never opens keeps the approach speed of its last touch, whatever the motion is. That number is no
//! unknown: there is a periodic motion for each.

use super::machine::Simulated;
use super::orbit::{Orbit, Return, ReturnMap, multipliers};
use super::response::Response;
use super::section::Visit;
use super::tangent::{Tangent, all_states};
use super::{Flow, Machine};
use anyhow::{Result, ensure};
use nalgebra::{DMatrix, DVector};
use slidercrank::model::coordinates::state_variables;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::profile::{Profile, ProfileArgument};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{DriveMode, Scene};
use slidercrank::simulation::variation::Seed;
use slidercrank::simulation::{CONTACTS, Phase, Simulation};
use std::f64::consts::TAU;

/// Tolerance of the motions.
const TOLERANCE: f64 = 1e-10;
/// What is neither 0 nor 1 in the row of an approach speed shows that the contact touched anew.
const KEPT: f64 = 1e-9;

/// A scene whose periodic motions depend on one parameter.
pub struct PoincareMap<'a> {
    file: &'a SceneFile,
    /// The parameter.
    pub parameter: &'static Parameter,
    /// [rad] Crank angle of the section, relative to the start angle.
    section: f64,
    /// Place of the crank angle among the states, if it is one.
    crank_angle: Option<usize>,
    seeds: Vec<Seed>,
    /// Noticeable differences, those of the scene as it was given.
    scales: Vec<f64>,
}

impl<'a> PoincareMap<'a> {
    /// The map of a scene.
    ///
    /// # Errors
    /// If the parameter is not real or moves the section, or the inputs depend on time.
    pub fn new(file: &'a SceneFile, parameter: &'static Parameter, section: f64) -> Result<Self> {
        ensure!(matches!(parameter.kind, Kind::Real { .. }), "`{}` is not a real number", parameter.name);
        ensure!(parameter.name != "crank.angle_start", "crank.angle_start moves the section and cannot be followed");
        let by_time = |profile: &Profile| matches!(profile, Profile::Points { against: ProfileArgument::Time, .. });
        ensure!(
            !by_time(&file.inputs.crank_torque) && !by_time(&file.inputs.slider_load),
            "inputs that depend on time have no periodic motions with the crank"
        );
        let crank_angle = state_variables(&file.scene).iter().position(|state| state.name.ends_with("crank.angle"));
        let mut seeds = all_states(file)?;
        seeds.extend((0..CONTACTS).map(Seed::Approach));
        seeds.push(Seed::Parameter(parameter));
        let scales = Simulation::start(&file.scene, Inputs::at_start(file))?.phase_scales();
        let scales = scales.states.into_iter().chain([scales.approach; CONTACTS]).collect();
        Ok(Self { file, parameter, section, crank_angle, seeds, scales })
    }

    /// The scene with another value of the parameter, computed accurately.
    ///
    /// # Errors
    /// If it is not allowed.
    pub fn file(&self, value: f64) -> Result<SceneFile> {
        let mut file = self.file.clone();
        self.parameter.write(&mut file.scene, value)?;
        file.scene.solver.tolerance = file.scene.solver.tolerance.min(TOLERANCE);
        file.scene.check()?;
        Ok(file)
    }

    /// The response of a periodic motion.
    ///
    /// # Errors
    /// If it cannot run.
    pub fn response(&self, orbit: &Orbit, response: &Response) -> Result<f64> {
        let mut machine = Machine::start(&self.file(orbit.value)?)?;
        machine.set_phase(&orbit.phase);
        response.of(&mut machine, orbit.turns)
    }

    /// Whether a number of phase space is free to change from one period to the next.
    fn is_unknown(&self, place: usize, phase: &Phase, by_point: &DMatrix<f64>) -> bool {
        if Some(place) == self.crank_angle {
            return false;
        }
        let Some(contact) = place.checked_sub(phase.states.len()) else { return true };
        let kept = by_point
            .row(place)
            .iter()
            .enumerate()
            .all(|(column, slope)| (slope - f64::from(u8::from(column == place))).abs() < KEPT);
        phase.approach[contact].is_some() && !kept
    }

    /// The point at the section's angle and its first time.
    fn placed(&self, scene: &Scene, phase: &Phase) -> Phase {
        let speed = scene.crank.speed_start;
        let mut placed = phase.clone();
        match self.crank_angle {
            Some(angle) => {
                placed.time = 0.0;
                placed.states[angle] = scene.crank.angle_start + speed.signum() * self.section;
            }
            None => placed.time = self.section / speed.abs(),
        }
        debug_assert_eq!(self.crank_angle.is_none(), scene.drive.mode == DriveMode::Speed);
        placed
    }

    /// Difference of two states, in noticeable differences. The crank turns on.
    fn between(&self, from: &Phase, to: &Phase) -> DVector<f64> {
        let states = from.states.iter().zip(&to.states).zip(&self.scales).enumerate();
        let differences = states.map(|(place, ((from, to), scale))| match Some(place) == self.crank_angle {
            true => 0.0,
            false => (to - from) / scale,
        });
        DVector::from_iterator(from.states.len(), differences)
    }

    /// Rates of all numbers of phase space, in noticeable differences per second.
    fn rates(&self, machine: &mut Machine<Tangent>, states: usize) -> DVector<f64> {
        let rates = machine.variation().rates();
        let rates = rates.iter().take(states).zip(&self.scales).map(|(rate, scale)| rate / scale);
        DVector::from_iterator(states + CONTACTS, rates.chain([0.0; CONTACTS]))
    }
}

impl ReturnMap for PoincareMap<'_> {
    fn name(&self) -> &str {
        self.parameter.name
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn apply(&self, value: f64, phase: &Phase, turns: usize) -> Result<Return> {
        let file = self.file(value)?;
        let (scene, states) = (&file.scene, phase.states.len());
        let mut machine = Machine::with_tangent(&file, &self.seeds)?;
        let phase = self.placed(scene, phase);
        machine.set_phase(&phase);
        let events = machine.outputs().solver.events;
        let before = self.rates(&mut machine, states);
        let (mut visits, mut halfway) = (vec![], phase.clone());
        for turn in 1..=turns {
            machine.advance_turned(self.section + TAU * turn as f64)?;
            visits.push(Visit { time: machine.time(), outputs: machine.outputs() });
            if turn == turns / 2 {
                halfway = machine.simulation.phase();
            }
        }
        let outputs = machine.outputs();
        let time = machine.time();
        let end = machine.simulation.phase();
        let directions = machine.directions_in(&self.scales)?;
        let after = self.rates(&mut machine, states);
        let closed = |phase: &Phase| phase.approach.iter().map(Option::is_some).collect::<Vec<_>>();
        ensure!(
            closed(&phase) == closed(&end),
            "other contacts are closed after {turns} turns; another section may do"
        );

        // All numbers of phase space, in noticeable differences.
        let flat = |phase: &Phase| -> Vec<f64> {
            let approach = phase.approach.iter().map(|speed| speed.unwrap_or_default());
            phase.states.iter().copied().chain(approach).zip(&self.scales).map(|(value, scale)| value / scale).collect()
        };
        let (from, to) = (flat(&phase), flat(&end));
        let rows = from.len();
        let mut by_point = directions.columns(0, rows).into_owned();
        // The seeds are in their own units.
        for (column, scale) in self.scales.iter().enumerate() {
            by_point.column_mut(column).scale_mut(*scale);
        }
        let mut by_parameter = directions.column(rows).into_owned();
        let mut miss = DVector::from_fn(rows, |i, _| to[i] - from[i]);
        if let Some(angle) = self.crank_angle {
            // Along the motion onto the section.
            let advance = TAU * turns as f64 * scene.crank.speed_start.signum() / self.scales[angle];
            let late = (miss[angle] - advance) / after[angle];
            miss.axpy(-late, &after, 1.0);
            let row = by_point.row(angle).into_owned();
            by_point.ger(-1.0 / after[angle], &after, &row.transpose(), 1.0);
            let share = by_parameter[angle] / after[angle];
            by_parameter.axpy(-share, &after, 1.0);
        } else if self.parameter.name == "crank.speed_start" {
            // The times at which the crank is at the section change, too.
            let speed = scene.crank.speed_start;
            let (start, end) = (-phase.time / speed, -time / speed);
            by_parameter += &after * end - &by_point * &before * start;
        }
        let unknowns: Vec<usize> = (0..rows).filter(|&place| self.is_unknown(place, &phase, &by_point)).collect();
        let part = |v: &DVector<f64>| DVector::from_iterator(unknowns.len(), unknowns.iter().map(|&place| v[place]));
        let (miss, by_parameter) = (part(&miss), part(&by_parameter));
        let by_unknowns = by_point.select_rows(&unknowns).select_columns(&unknowns);
        let multipliers = multipliers(&by_unknowns);
        let events = i64::from(outputs.solver.events) - i64::from(events);
        let apart = self.between(&phase, &halfway);
        let orbit = Orbit { value, phase, turns, multipliers, apart, visits, events };
        Ok(Return { miss, by_unknowns, by_parameter, unknowns, orbit })
    }
}
