//! Bifurcation diagrams: points of the Poincaré section as one parameter changes.

use super::portrait::{Plan, noticed};
use super::section::{Visit, stroboscope};
use super::verdict::{Evidence, judge};
use super::{Flow, Machine};
use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::read::SceneFile;
use std::f64::consts::TAU;

/// A parameter and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// The parameter's name.
    pub name: String,
    /// Its values, in order.
    pub values: Vec<f64>,
}

/// The start state of each value's run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum From {
    /// The scene's start state. Values are independent and run on all cores.
    Fresh,
    /// The end state of the run at the value before. A branch is followed, one value after the other.
    Before,
}

/// The results of one value.
pub struct Branch {
    /// The parameter's value.
    pub value: f64,
    /// Points and evidence, or the error that prevented them.
    pub outcome: Result<(Vec<Visit>, Evidence)>,
}

impl Range {
    /// `count` values of a parameter, spaced evenly or, with `logarithmic`, logarithmically.
    ///
    /// # Errors
    /// If there is no such real parameter, or values lie outside its range.
    pub fn new(name: &str, from: f64, to: f64, count: usize, logarithmic: bool) -> Result<Self> {
        let parameter = Parameter::named(name).with_context(|| format!("there is no parameter `{name}`"))?;
        ensure!(matches!(parameter.kind, Kind::Real { .. }), "`{name}` is not a real number");
        ensure!(count >= 2, "a range needs at least 2 values, not {count}");
        ensure!(
            !logarithmic || (from > 0.0 && to > 0.0),
            "logarithmic spacing needs values above 0, not {from} and {to}"
        );
        parameter.admit(from)?;
        parameter.admit(to)?;
        let share = |i: usize| i as f64 / (count - 1) as f64;
        let value = |i: usize| {
            if i == count - 1 {
                to
            } else if logarithmic {
                from * (to / from).powf(share(i))
            } else {
                from + share(i) * (to - from)
            }
        };
        Ok(Self { name: name.into(), values: (0..count).map(value).collect() })
    }

    /// Runs all values. A run that fails does not stop the others.
    ///
    /// # Errors
    /// If the scene does not allow a value.
    pub fn branches(&self, file: &SceneFile, plan: &Plan, from: From, tick: impl Fn() + Sync) -> Result<Vec<Branch>> {
        let files = self.values.iter().map(|value| self.applied(file, *value)).collect::<Result<Vec<_>>>()?;
        let runs = self.values.iter().zip(&files);
        Ok(match from {
            From::Fresh => {
                let runs: Vec<_> = runs.collect();
                runs.into_par_iter()
                    .map(|(value, file)| {
                        let outcome = plan.settled(file).and_then(|machine| look(file, plan, machine));
                        tick();
                        Branch { value: *value, outcome: outcome.map(|(found, _)| found) }
                    })
                    .collect()
            }
            From::Before => {
                let mut last: Option<Machine> = None;
                let mut branches = Vec::new();
                for (value, file) in runs {
                    let started = match &mut last {
                        None => plan.settled(file),
                        Some(machine) => go_on(file, plan, machine),
                    };
                    let outcome = started.and_then(|machine| look(file, plan, machine)).map(|(found, end)| {
                        last = Some(end);
                        found
                    });
                    branches.push(Branch { value: *value, outcome });
                    tick();
                }
                branches
            }
        })
    }

    /// The scene with this value of the parameter.
    fn applied(&self, file: &SceneFile, value: f64) -> Result<SceneFile> {
        let mut file = file.clone();
        Parameter::named(&self.name).context("a parameter")?.write(&mut file.scene, value)?;
        file.scene.check()?;
        Ok(file)
    }
}

/// A machine that starts from the state of another one, after its transient.
fn go_on(file: &SceneFile, plan: &Plan, other: &mut Machine) -> Result<Machine> {
    let mut machine = Machine::start(file)?;
    machine.take_over(other);
    let turned = machine.turned();
    machine.advance_turned(turned + TAU * plan.transient as f64)?;
    Ok(machine)
}

fn look(file: &SceneFile, plan: &Plan, mut machine: Machine) -> Result<((Vec<Visit>, Evidence), Machine)> {
    let begin = machine.point();
    let visits = stroboscope(&mut machine, plan.section, plan.turns, || {})?;
    machine.place(&begin);
    let exponent = plan.exponent(file, &mut machine, || {})?;
    let vectors: Vec<Vec<f64>> = visits.iter().map(|visit| noticed(&file.scene, &visit.outputs)).collect();
    let evidence = judge(&vectors, &exponent);
    Ok(((visits, evidence), machine))
}
