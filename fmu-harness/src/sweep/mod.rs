//! Studies: many runs of one scene with different parameters, on all cores. A study can be resumed, and its results are
//! the same for any number of workers.
//!
//! A [`Study`] is read from a file and expanded into a [`Plan`], a table of all runs. Each finished run is one line of
//! a [`Journal`] and is not run again; a run that its budget stopped is. The results are compiled from the journal.

pub mod distribution;
pub mod journal;
pub mod linear;
pub mod plan;
pub mod quantity;
pub mod study;
pub mod values;

pub use journal::Journal;
pub use linear::Linear;
pub use plan::Plan;
pub use study::Study;

use crate::frame::{Column, Frame};
use crate::host::{Fmu, Setting};
use crate::inputs;
use crate::run::{Ending, Experiment, Look, Until, afford, march};
use crate::scenes::Scenario;
use anyhow::{Context, Result, ensure};
use journal::{Line, Outcome};
use quantity::Quantity;
use rayon::prelude::*;
use serde_json::json;
use slidercrank::scene::profile::Profile;
use slidercrank::scene::write::write;
use std::f64::consts::TAU;
use std::path::Path;
use std::time::Duration;

/// Longest time for a crank's turns, relative to the time at its start speed.
const SLOW: f64 = 10.0;

/// A study that is being run.
pub struct Sweep<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its scene.
    pub scenario: &'a Scenario,
    /// All its runs.
    pub plan: &'a Plan,
    /// The packaged scene.
    pub fmu: &'a Path,
    /// Longest time for one run.
    pub budget: Duration,
}

impl Sweep<'_> {
    /// Runs all runs that the journal does not contain, and adds them to it.
    ///
    /// # Errors
    /// If the FMU cannot be opened, or the journal cannot be written or has lines that are none of the study's. A run that
    /// fails is a line of the journal.
    pub fn run(&self, journal: &Journal, tick: impl Fn() + Sync) -> Result<()> {
        let (runs, kept) = (self.plan.len(), self.study.keep.len());
        for Line { run, outcome } in journal.lines().values() {
            let fits = match outcome {
                Outcome::Values(values) => values.len() == kept,
                Outcome::Failed(_) | Outcome::Stopped(_) => true,
            };
            ensure!(
                fits && *run < runs,
                "the journal is damaged in the line of run {run}: the study has {runs} runs, from 0 on, with {kept} values each"
            );
        }
        let open: Vec<usize> = (0..runs).filter(|run| !journal.has(*run)).collect();
        open.into_par_iter().try_for_each_init(
            || Fmu::open(self.fmu),
            |fmu, run| {
                let fmu = fmu.as_ref().map_err(|error| anyhow::anyhow!("{error}"))?;
                let outcome = self.one(fmu, run).unwrap_or_else(|error| Outcome::Failed(format!("{error:#}")));
                journal.add(&Line { run, outcome })?;
                tick();
                Ok(())
            },
        )
    }

    /// The quantities of one run, or that its budget stopped it.
    fn one(&self, fmu: &Fmu, run: usize) -> Result<Outcome> {
        let settings: Vec<Setting> =
            self.plan.row(run).map(|(name, value)| Setting { name: name.into(), value: value.to_string() }).collect();
        let own = |name: &str| self.plan.row(run).find(|(own, _)| *own == name).map(|(_, value)| value);
        let scene = &self.scenario.file.scene;
        let speed = own("crank.speed_start").unwrap_or(scene.crank.speed_start).abs();
        let turns = self.study.run.turns;
        ensure!(speed > 0.0, "crank.speed_start = 0 rad/s: turns cannot be counted if the crank does not turn");
        let span = turns * TAU / speed;
        afford(span, self.study.run.step)?;
        let experiment = Experiment {
            settings,
            inputs: inputs::of_scene(&self.scenario.file.inputs),
            start: 0.0,
            until: Until::Turns { turns, latest: SLOW * span },
            step: self.study.run.step,
            tolerance: None,
        };
        let march = march(fmu, &experiment, Look::Everywhere, self.budget)?;
        let stopped = march.ending == Ending::Stopped;
        match march.ending.complete(self.budget) {
            Err(why) if stopped => return Ok(Outcome::Stopped(why.to_string())),
            ended => ended?,
        }
        let of = |(name, quantity): (&String, &Quantity)| {
            quantity.of(&march.trajectory, self.study.run.transient).with_context(|| name.clone())
        };
        Ok(Outcome::Values(self.study.keep.iter().map(of).collect::<Result<_>>()?))
    }

    /// Everything that another program needs to run the plan in the same way: communication points, inputs over time or
    /// crank angle, quantities to keep, and the digest of the journal.
    pub fn recipe(study: &Study, scenario: &Scenario, plan: &Plan) -> serde_json::Value {
        let input = |input: &inputs::Input| match &input.profile {
            Profile::Constant(value) => json!({ "name": input.name, "constant": value }),
            Profile::Points { against, points } => {
                json!({ "name": input.name, "against": against.name(), "points": points })
            }
        };
        let inputs: Vec<_> = inputs::of_scene(&scenario.file.inputs).iter().map(input).collect();
        json!({
            "name": study.name,
            "digest": Self::digest(study, scenario, plan),
            "scene": scenario.name,
            "run": study.run,
            "slow": SLOW,
            "speed": scenario.file.scene.crank.speed_start,
            "inputs": inputs,
            "keep": study.keep,
            "origin": origin(study, scenario).into_iter().collect::<std::collections::BTreeMap<_, _>>(),
        })
    }

    /// Digest that identifies the study of a journal. The scene is written out for it, with a table of modes from elsewhere.
    pub fn digest(study: &Study, scenario: &Scenario, plan: &Plan) -> String {
        plan.digest(&[&study.text, &write(&scenario.file), env!("CARGO_PKG_VERSION")])
    }

    /// All runs in their order, with their outcomes.
    ///
    /// # Errors
    /// If a run is not in the journal.
    pub fn frame(&self, journal: &Journal) -> Result<Frame> {
        let lines = journal.lines();
        ensure!(lines.len() == self.plan.len(), "only {} of {} runs are finished", lines.len(), self.plan.len());
        let mut frame = Frame::default().with("run", Column::Integers((0..self.plan.len() as i64).collect()));
        for (place, name) in self.plan.names().iter().enumerate() {
            frame = frame.reals(name.clone(), (0..self.plan.len()).map(|run| self.plan.value(run, place)));
        }
        for (place, name) in self.study.keep.keys().enumerate() {
            let value = |line: &Line| match &line.outcome {
                Outcome::Values(values) => values[place],
                Outcome::Failed(_) | Outcome::Stopped(_) => f64::NAN,
            };
            frame = frame.reals(name.clone(), lines.values().map(value).collect::<Vec<_>>());
        }
        let status = |line: &Line| match &line.outcome {
            Outcome::Values(_) => "ok".to_owned(),
            Outcome::Failed(why) | Outcome::Stopped(why) => why.clone(),
        };
        frame = frame.with("status", Column::Texts(lines.values().map(status).collect()));
        frame.origin = origin(self.study, self.scenario);
        Ok(frame)
    }
}

/// Origin of the results.
fn origin(study: &Study, scenario: &Scenario) -> Vec<(String, String)> {
    let study_text = ("study".into(), study.text.clone());
    let version = ("version".into(), env!("CARGO_PKG_VERSION").into());
    let seed = ("seed".into(), study.seed.to_string());
    [study_text].into_iter().chain(scenario.texts()).chain([version, seed]).collect()
}
