//! Wear of joints over many strokes: sliding work of runs through the packaged FMU, Archard's law, and an extrapolation
//! that feeds the grown clearance and the worn radius back.
//!
//! [`Study::measure`] runs the FMU with given clearances and returns the [`Measured`] sliding work, or finds it in a
//! [`Journal`]. [`Study::follow`] extrapolates in strokes. Nothing wears within a run.

pub mod extrapolation;
pub mod joint;
pub mod sectors;

use crate::accuracy::farthest;
use crate::host::{Fmu, Setting};
use crate::inputs;
use crate::run::{Ending, Experiment, Look, Until, afford, march};
use crate::scenes::Scenario;
use crate::sweep::journal::{Journal, Line, Outcome};
use crate::sweep::plan::digest;
use crate::sweep::quantity::{Quantity, Reduction};
use anyhow::{Context, Result, bail, ensure};
use extrapolation::{Extrapolation, Growth, extrapolate};
use joint::{Coefficients, Wearing, Work};
use sectors::Sectors;
use slidercrank::scene::write::write;
use std::f64::consts::TAU;
use std::time::Duration;

/// Least number of communication points of a stroke at the crank's start speed.
const POINTS: f64 = 360.0;
/// Longest time for a crank's turns, relative to the time at its start speed.
const SLOW: f64 = 10.0;

/// How the runs are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Strokes of a run before the evaluation starts.
    pub transient: usize,
    /// Strokes that are evaluated.
    pub turns: usize,
    /// Sectors of each body.
    pub sectors: usize,
    /// Longest time for one run.
    pub budget: Duration,
}

/// A scene whose joints wear.
pub struct Study<'a> {
    /// The scene.
    pub scenario: &'a Scenario,
    /// Its package.
    pub fmu: &'a Fmu,
    /// The joints that wear.
    pub joints: Vec<Wearing>,
    /// How the runs are made.
    pub plan: Plan,
}

/// What a run with given clearances gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// [strokes] Where in the extrapolation the run was first asked for.
    pub strokes: f64,
    /// [m] Clearance of each joint that wears.
    pub clearances: Vec<f64>,
    /// Sliding work of each joint that wears.
    pub works: Vec<Work>,
    /// [m] Error of the slider's position at bottom dead centre: mean over the strokes, and its standard error.
    pub dead_centre: [f64; 2],
}

/// The result of a study.
pub struct Worn {
    /// Steps of the extrapolation.
    pub extrapolation: Extrapolation,
    /// The runs, in the order in which the steps count them.
    pub runs: Vec<Measured>,
}

impl<'a> Study<'a> {
    /// A study of these joints.
    ///
    /// # Errors
    /// If a joint is ideal or named twice, the crank stands, or there are too few strokes or sectors.
    pub fn new(scenario: &'a Scenario, fmu: &'a Fmu, coefficients: &[Coefficients], plan: Plan) -> Result<Self> {
        let scene = &scenario.file.scene;
        ensure!(!coefficients.is_empty(), "no joint wears: give at least one coefficient");
        let mut joints: Vec<Wearing> = Vec::new();
        for &own in coefficients {
            ensure!(joints.iter().all(|joint| joint.letter != own.joint), "joint {} is given twice", own.joint);
            joints.push(Wearing::of(scene, own)?);
        }
        ensure!(scene.crank.speed_start != 0.0, "crank.speed_start = 0 rad/s: a crank that stands makes no strokes");
        ensure!(plan.turns >= 3, "{} strokes are too few for a standard error; at least 3 are needed", plan.turns);
        ensure!(plan.sectors >= 4, "{} sectors are too few; at least 4 are needed", plan.sectors);
        Ok(Self { scenario, fmu, joints, plan })
    }

    /// Digest of all that runs at equal clearances and radii depend on. It identifies the journal.
    pub fn digest(&self) -> String {
        let Plan { transient, turns, sectors, .. } = self.plan;
        let joints: String = self.joints.iter().map(|joint| joint.letter).collect();
        let numbers = [transient, turns, sectors].map(|number| number as f64);
        digest([write(&self.scenario.file).as_str(), &joints, env!("CARGO_PKG_VERSION")], &numbers)
    }

    /// Follows the clearances over `strokes` strokes.
    ///
    /// # Errors
    /// If the scene itself cannot run, or the journal cannot be written.
    pub fn follow(&self, strokes: f64, tolerance: f64, journal: &Journal, tick: impl Fn(f64)) -> Result<Worn> {
        let start: Vec<f64> = self.joints.iter().map(|joint| joint.clearance).collect();
        let mut runs: Vec<Measured> = Vec::new();
        let growth = |at: f64, clearances: &[f64]| {
            tick(at);
            let measured = self.measure(at, clearances, journal)?;
            let rates = self.joints.iter().zip(clearances).zip(&measured.works);
            let rates: Vec<[f64; 2]> = rates.map(|((joint, clearance), work)| joint.growth(*clearance, work)).collect();
            runs.push(measured);
            let [mean, error] = [0, 1].map(|which| rates.iter().map(|rate| rate[which]).collect());
            Ok(Growth { mean, error })
        };
        let extrapolation = extrapolate(&start, strokes, tolerance, growth)?;
        Ok(Worn { extrapolation, runs })
    }

    /// Sliding work with these clearances, from the journal or else from a run, which is then added to the journal.
    ///
    /// # Errors
    /// If a clearance is too large, or the run does not come to its end.
    pub fn measure(&self, strokes: f64, clearances: &[f64], journal: &Journal) -> Result<Measured> {
        self.joints.iter().zip(clearances).try_for_each(|(joint, clearance)| joint.admit(*clearance))?;
        let shape: Vec<f64> =
            self.joints.iter().zip(clearances).flat_map(|(joint, own)| [*own, joint.radii(*own)[0]]).collect();
        let known = journal.lines().into_values().find_map(|line| match line.outcome {
            Outcome::Values(values) => self.read(strokes, clearances, values.strip_prefix(shape.as_slice())?),
            Outcome::Failed(_) | Outcome::Stopped(_) => None,
        });
        if let Some(measured) = known {
            return Ok(measured);
        }
        let measured = self.run(strokes, clearances)?;
        let values = shape.into_iter().chain(written(&measured)).collect();
        journal.add(&Line { run: journal.len(), outcome: Outcome::Values(values) })?;
        Ok(measured)
    }

    fn run(&self, strokes: f64, clearances: &[f64]) -> Result<Measured> {
        let Plan { transient, turns, sectors, budget } = self.plan;
        let file = &self.scenario.file;
        let mut settings = Vec::new();
        for (joint, clearance) in self.joints.iter().zip(clearances) {
            let radius = joint.radii(*clearance)[0].to_string();
            let own = [("clearance", clearance.to_string()), ("radius", radius), ("wear.audit", "true".into())];
            settings.extend(own.map(|(name, value)| Setting { name: joint.variable(name), value }));
        }
        let turn = TAU / file.scene.crank.speed_start.abs();
        let all = (transient + turns) as f64;
        let step = file.run.step.min(turn / POINTS);
        afford(all * turn, step)?;
        let experiment = Experiment {
            settings,
            inputs: inputs::of_scene(&file.inputs),
            start: 0.0,
            until: Until::Turns { turns: all, latest: SLOW * all * turn },
            step,
            tolerance: None,
        };
        let march = march(self.fmu, &experiment, Look::Everywhere, budget)?;
        match march.ending {
            Ending::Reached => {}
            Ending::Stopped => bail!("a run was stopped after {} s", budget.as_secs_f64()),
            Ending::Failed(why) => bail!(why),
        }
        let work = |joint: &Wearing| {
            joint.work(&march.trajectory, transient, turns, sectors).with_context(|| format!("joint {}", joint.letter))
        };
        let works = self.joints.iter().map(work).collect::<Result<Vec<Work>>>()?;
        let bottom = |reduce: Reduction| {
            Quantity { of: "accuracy.position".into(), reduce, at: Some(farthest(&file.scene)) }
                .of(&march.trajectory, transient as f64)
        };
        let error = bottom(Reduction::Deviation)? / (turns as f64).sqrt();
        let dead_centre = [bottom(Reduction::Mean)?, error];
        Ok(Measured { strokes, clearances: clearances.to_vec(), works, dead_centre })
    }

    /// The contents of a journal's line after the clearances and radii.
    fn read(&self, strokes: f64, clearances: &[f64], values: &[f64]) -> Option<Measured> {
        let Plan { turns, sectors, .. } = self.plan;
        let (dead_centre, values) = values.split_first_chunk::<2>()?;
        let length = turns + 2 * sectors;
        (values.len() == length * self.joints.len()).then(|| {
            let work = |values: &[f64]| {
                let (strokes, bodies) = values.split_at(turns);
                let (bearing, journal) = bodies.split_at(sectors);
                let bodies = [bearing, journal].map(|work| Sectors { work: work.to_vec() });
                Work { strokes: strokes.to_vec(), bodies }
            };
            let works = values.chunks(length).map(work).collect();
            Measured { strokes, clearances: clearances.to_vec(), works, dead_centre: *dead_centre }
        })
    }
}

/// What a journal's line has after the clearances and radii.
fn written(measured: &Measured) -> Vec<f64> {
    let mut values = measured.dead_centre.to_vec();
    for Work { strokes, bodies } in &measured.works {
        values.extend(strokes);
        bodies.iter().for_each(|body| values.extend(&body.work));
    }
    values
}

impl Worn {
    /// Run with the clearances at the start (0) or after step `number`.
    pub fn run_after(&self, number: usize) -> &Measured {
        let last = number.checked_sub(1).and_then(|step| self.extrapolation.steps.get(step));
        &self.runs[last.map_or(0, |step| step.stages[3])]
    }

    /// [m] Worn depth of each sector of bearing and journal of a joint at the end.
    pub fn depths(&self, joints: &[Wearing], number: usize) -> [Vec<f64>; 2] {
        let joint = &joints[number];
        let depths: Vec<[Vec<f64>; 2]> =
            self.runs.iter().map(|run| joint.depths(run.clearances[number], &run.works[number])).collect();
        [0, 1].map(|body| {
            let sectors = depths.first().map_or(0, |bodies| bodies[body].len());
            let depth = |sector: usize| {
                let steps = self.extrapolation.steps.iter();
                steps.map(|step| step.increment([0, 1, 2].map(|k| depths[step.stages[k]][body][sector]))).sum()
            };
            (0..sectors).map(depth).collect()
        })
    }
}
