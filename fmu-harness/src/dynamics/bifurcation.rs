//! Bifurcation diagrams: points of the Poincaré section as one parameter changes.

use super::portrait::{Plan, noticed};
use super::response::Response;
use super::section::{Visit, stroboscope, turn};
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
    /// The response that is measured at each value.
    pub response: Option<Response>,
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
    /// The response, if it was asked for.
    pub response: Option<f64>,
}

impl Range {
    /// `count` values of a parameter, spaced evenly or, with `logarithmic`, logarithmically.
    ///
    /// # Errors
    /// If there is no such real parameter, or values lie outside its range.
    pub fn new(name: &str, from: f64, to: f64, count: usize, logarithmic: bool) -> Result<Self> {
        let parameter = Parameter::named(name).with_context(|| format!("there is no parameter `{name}`"))?;
        ensure!(matches!(parameter.kind, Kind::Real { .. }), "`{name}` is not a real number");
        ensure!(count >= 2, "`{name}`: a range needs at least 2 values, not {count}");
        ensure!(
            !logarithmic || (from > 0.0 && to > 0.0),
            "`{name}`: logarithmic spacing needs values above 0, not {from} and {to}"
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
        Ok(Self { name: name.into(), values: (0..count).map(value).collect(), response: None })
    }

    /// Whether the scene allows all values.
    ///
    /// # Errors
    /// If it does not.
    pub fn check(&self, file: &SceneFile) -> Result<()> {
        self.values.iter().try_for_each(|value| self.applied(file, *value).map(|_| ()))
    }

    /// Runs all values. A run that fails does not stop the others.
    ///
    /// # Errors
    /// If the scene does not allow a value.
    pub fn branches(&self, file: &SceneFile, plan: &Plan, from: From, tick: impl Fn() + Sync) -> Result<Vec<Branch>> {
        match from {
            From::Before => self.carried(file, plan, &mut None, self.values.iter().copied(), tick),
            From::Fresh => {
                let files = self.values.iter().map(|value| self.applied(file, *value)).collect::<Result<Vec<_>>>()?;
                let runs: Vec<_> = self.values.iter().zip(&files).collect();
                let run = |(value, file): (&f64, &SceneFile)| {
                    let outcome = plan.settled(file).and_then(|machine| self.look(file, plan, machine));
                    tick();
                    Branch::of(*value, outcome).0
                };
                Ok(runs.into_par_iter().map(run).collect())
            }
        }
    }

    /// Runs all values from the first to the last and back, each from the end state of the value before.
    ///
    /// # Errors
    /// If the scene does not allow a value.
    pub fn up_and_down(&self, file: &SceneFile, plan: &Plan, tick: impl Fn()) -> Result<[Vec<Branch>; 2]> {
        let mut last = None;
        let up = self.carried(file, plan, &mut last, self.values.iter().copied(), &tick)?;
        let down = self.carried(file, plan, &mut last, self.values.iter().rev().copied(), &tick)?;
        Ok([up, down])
    }

    /// Runs values one after the other, each from the end state of the one before.
    fn carried(
        &self,
        file: &SceneFile,
        plan: &Plan,
        last: &mut Option<Machine>,
        values: impl Iterator<Item = f64>,
        tick: impl Fn(),
    ) -> Result<Vec<Branch>> {
        let mut branches = vec![];
        for value in values {
            let file = self.applied(file, value)?;
            let started = match last {
                None => plan.settled(&file),
                Some(machine) => go_on(&file, plan, machine),
            };
            let (branch, end) = Branch::of(value, started.and_then(|machine| self.look(&file, plan, machine)));
            if let Some(end) = end {
                *last = Some(end);
            }
            branches.push(branch);
            tick();
        }
        Ok(branches)
    }

    /// What is found from the state of a machine on, and the machine at its end.
    fn look(&self, file: &SceneFile, plan: &Plan, mut machine: Machine) -> Result<(Look, Machine)> {
        let begin = machine.point();
        let visits = stroboscope(&mut machine, plan.section, plan.turns, || {})?;
        let turn = turn(&machine, &visits);
        machine.place(&begin);
        let mut response = None;
        if let Some(wanted) = &self.response {
            response = Some(wanted.of(&mut machine, plan.turns)?);
            machine.place(&begin);
        }
        let exponent = plan.exponent(file, &mut machine, turn, || {})?;
        let vectors: Vec<Vec<f64>> = visits.iter().map(|visit| noticed(&file.scene, &visit.outputs)).collect();
        let evidence = judge(&vectors, &exponent);
        Ok((Look { visits, evidence, response }, machine))
    }

    /// The scene with this value of the parameter.
    fn applied(&self, file: &SceneFile, value: f64) -> Result<SceneFile> {
        let mut file = file.clone();
        Parameter::named(&self.name).context("a parameter")?.write(&mut file.scene, value)?;
        file.scene.check()?;
        Ok(file)
    }
}

/// What is found at one value.
struct Look {
    visits: Vec<Visit>,
    evidence: Evidence,
    response: Option<f64>,
}

impl Branch {
    /// The results of a value, and the machine at the end of its run.
    fn of(value: f64, outcome: Result<(Look, Machine)>) -> (Self, Option<Machine>) {
        match outcome {
            Ok((Look { visits, evidence, response }, end)) => {
                (Self { value, outcome: Ok((visits, evidence)), response }, Some(end))
            }
            Err(error) => (Self { value, outcome: Err(error), response: None }, None),
        }
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
