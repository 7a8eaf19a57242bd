//! Classifies one scene's motion with one long run and a neighbouring run.

use super::exponents::{Exponents, Measurement};
use super::lyapunov::{Exponent, Probe};
use super::orbit::{Return, ReturnMap};
use super::poincare::PoincareMap;
use super::section::{Impact, Visit, impacts, stroboscope, turn};
use super::tangent::all_states;
use super::verdict::{Evidence, SAME, judge};
use super::{Flow, Machine, machine, spectrum};
use anyhow::{Context, Result, ensure};
use slidercrank::model::signals::Outputs;
use slidercrank::scene::Scene;
use slidercrank::scene::read::SceneFile;
use std::f64::consts::TAU;

/// Length of the run, and the section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Turns before the evaluation starts.
    pub transient: usize,
    /// Turns that are evaluated.
    pub turns: usize,
    /// [rad] Crank angle of the section, relative to the start angle.
    pub section: f64,
    /// Number of measurements of the exponents in each turn.
    pub per_turn: usize,
    /// Turns in which all exponents are measured; 0: none are.
    pub tangent_turns: usize,
}

/// Number of turns of the stored path, points per turn of the path, and points per turn for the spectrum.
const PATH_TURNS: usize = 8;
const PATH_POINTS: usize = 2000;
/// Number of samples of one segment of the spectrum.
const SEGMENT: usize = 8192;
/// Maximum number of impacts that are stored.
const MOST_IMPACTS: usize = 20_000;
/// The neighbour's distance, in noticeable differences: far above the integrator's errors and far below distances that
/// change contacts.
const DISTANCE: f64 = 1e-3;
/// A share of the crank's speed that counts like a clearance.
const SPEED: f64 = 1e-2;
/// Share of the measurements that are not counted.
const SETTLING: f64 = 0.1;

/// The results.
pub struct Portrait {
    /// Points of the section, one for each turn.
    pub visits: Vec<Visit>,
    /// Path of the last turns.
    pub path: Vec<Visit>,
    /// Impacts of journals.
    pub impacts: Vec<Impact>,
    /// Power spectral density of the slider's acceleration: frequency [Hz], density [(m/s²)²/Hz].
    pub spectrum: Vec<(f64, f64)>,
    /// The largest Lyapunov exponent, by two trajectories.
    pub exponent: Exponent,
    /// All exponents, from the tangent, or why there are none; `None` if they were not asked for.
    pub exponents: Option<Result<Exponents>>,
    /// [s] Mean time of a turn.
    pub turn: f64,
    /// The verdict with its evidence.
    pub evidence: Evidence,
}

impl Plan {
    /// Number of progress ticks of one portrait.
    pub fn ticks(&self) -> usize {
        self.turns * (1 + self.per_turn) + self.tangent_turns * self.per_turn
    }

    /// Classifies the motion of a scene.
    ///
    /// # Errors
    /// If it cannot run.
    pub fn portrait(&self, file: &SceneFile, mut tick: impl FnMut()) -> Result<Portrait> {
        let mut machine = self.settled(file)?;
        let begin = machine.point();
        let visits = stroboscope(&mut machine, self.section, self.turns, &mut tick)?;
        let turn = turn(&machine, &visits);
        let path = path(&mut machine, turn, PATH_TURNS, PATH_POINTS)?;
        let accelerations: Vec<f64> = path.iter().map(|visit| visit.outputs.slider.a).collect();
        let spectrum = spectrum::density(&accelerations, turn / PATH_POINTS as f64, SEGMENT);
        let impacts = impacts(&mut machine, PATH_TURNS as f64 * turn, MOST_IMPACTS)?;
        machine.place(&begin);
        let exponent = self.exponent(file, &mut machine, turn, &mut tick)?;
        machine.place(&begin);
        let exponents = (self.tangent_turns > 0).then(|| self.exponents(file, &mut machine, turn, &mut tick));
        let vectors: Vec<Vec<f64>> = visits.iter().map(|visit| noticed(machine.scene(), &visit.outputs)).collect();
        let evidence = judge(&vectors, &exponent);
        Ok(Portrait { visits, path, impacts, spectrum, exponent, exponents, turn, evidence })
    }

    /// The exponent, measured from the machine's current state, with turns of `turn` [s].
    ///
    /// # Errors
    /// If it cannot run.
    pub fn exponent(&self, file: &SceneFile, machine: &mut Machine, turn: f64, tick: impl FnMut()) -> Result<Exponent> {
        let count = self.turns * self.per_turn;
        let interval = turn / self.per_turn as f64;
        let settling = (SETTLING * count as f64) as usize;
        let probe = Probe { interval, count, settling, distance: DISTANCE };
        probe.measure(machine, &mut Machine::start(file)?, tick)
    }

    /// All exponents, measured from the state of `machine`, with turns of `turn` [s].
    ///
    /// # Errors
    /// If the scene has no tangent, cannot run or comes near grazing.
    pub fn exponents(
        &self,
        file: &SceneFile,
        machine: &mut Machine,
        turn: f64,
        tick: impl FnMut(),
    ) -> Result<Exponents> {
        let mut moving = Machine::with_tangent(file, &all_states(file)?)?;
        moving.take_over(machine);
        let count = self.tangent_turns * self.per_turn;
        let interval = turn / self.per_turn as f64;
        let settling = (SETTLING * count as f64) as usize;
        Measurement { interval, count, settling }.run(&mut moving, tick)
    }

    /// The periodic motion on which the motion settles at a value of the map's parameter.
    ///
    /// # Errors
    /// If it settles on none.
    pub fn periodic(&self, map: &PoincareMap<'_>, value: f64) -> Result<Return> {
        let file = map.file(value)?;
        let mut machine = self.settled(&file)?;
        let first = ((machine.turned() - self.section) / TAU - 1e-9).ceil();
        machine.advance_turned(self.section + TAU * first)?;
        let begin = machine.phase();
        let visits = stroboscope(&mut machine, self.section, self.turns.max(2), || {})?;
        let vectors: Vec<Vec<f64>> = visits.iter().map(|visit| noticed(&file.scene, &visit.outputs)).collect();
        let unknown = Exponent { value: 0.0, error: f64::INFINITY, history: vec![] };
        let name = map.parameter.name;
        let Evidence { repeats_after, misses_by, .. } = judge(&vectors, &unknown);
        ensure!(
            misses_by <= SAME,
            "at {name} = {value} the motion does not settle on a periodic one; begin at another value"
        );
        let orbit = map
            .solve(value, &begin, repeats_after)
            .with_context(|| format!("at {name} = {value} the motion repeats after {repeats_after} turns"))?;
        Ok(map.shortest(orbit))
    }

    /// The machine after the transient.
    ///
    /// # Errors
    /// If it cannot run.
    pub fn settled(&self, file: &SceneFile) -> Result<Machine> {
        let mut machine = Machine::start(file)?;
        machine.advance_turned(std::f64::consts::TAU * self.transient as f64)?;
        Ok(machine)
    }
}

/// Points at equal times of the next turns of `turn` [s].
fn path(machine: &mut Machine, turn: f64, turns: usize, points: usize) -> Result<Vec<Visit>> {
    let (start, step) = (machine.time(), turn / points as f64);
    let mut path = Vec::with_capacity(turns * points);
    for point in 1..=turns * points {
        machine.advance(start + step * point as f64)?;
        path.push(Visit { time: machine.time(), outputs: machine.outputs() });
    }
    Ok(path)
}

/// The numbers that are compared between points of the section: positions of journals and slider and the rod's deflection,
/// in clearances; if there is none, lengths in thousandths of the crank's, and the slider's velocity error in such lengths per
/// radian of the crank; and the crank's speed, in hundredths of itself.
pub fn noticed(scene: &Scene, outputs: &Outputs) -> Vec<f64> {
    let mut noticed = Vec::new();
    let clearances = machine::clearances(scene);
    for (joint, clearance) in &clearances {
        let revolute = match joint {
            'A' => outputs.joint_a,
            'B' => outputs.joint_b,
            'C' => outputs.joint_c,
            _ => {
                noticed.extend([outputs.slider.y / clearance, outputs.slider.angle * scene.slider.length / clearance]);
                continue;
            }
        };
        noticed.extend(revolute.eccentricity.map(|e| e / clearance));
    }
    let speed = outputs.crank.speed.abs().max(f64::MIN_POSITIVE);
    let thousandth = 1e-3 * scene.crank.length;
    let least = clearances.iter().map(|(_, clearance)| *clearance).reduce(f64::min);
    if least.is_none() {
        noticed.push(outputs.accuracy.velocity / (speed * thousandth));
    }
    let least = least.unwrap_or(thousandth);
    noticed.extend([outputs.accuracy.position / least, outputs.rod.deflection / least]);
    // Differences of logarithms are relative ones.
    noticed.push(speed.ln() / SPEED);
    noticed
}
