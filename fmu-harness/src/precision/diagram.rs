//! Runs every method at every tolerance or step size of its series: the points of a work-precision diagram, with
//! failures.

use super::Subject;
use super::ladder::{self, Rung};
use super::reference::Reference;
use super::ruler::Ruler;
use crate::run::{Ending, Look, March, Repeats, march};
use anyhow::Result;
use slidercrank::scene::Method;
use std::time::{Duration, Instant};

/// A run with a larger error has lost the motion.
pub const LOST: f64 = 1.0;

/// Time limits of a diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Limit of one run.
    pub run: Duration,
    /// Limit of each of the two runs of the reference.
    pub reference: Duration,
    /// Limit of the whole diagram. Runs that have not started by then are stopped.
    pub scene: Duration,
    /// Whether every second tolerance is left out.
    pub quick: bool,
}

impl Budget {
    /// Limits with which six diagrams take less than a quarter of an hour.
    pub const FULL: Self = Self {
        run: Duration::from_millis(2500),
        reference: Duration::from_secs(8),
        scene: Duration::from_secs(120),
        quick: false,
    };
    /// Limits for a quick overview.
    pub const QUICK: Self = Self {
        run: Duration::from_millis(400),
        reference: Duration::from_secs(3),
        scene: Duration::from_secs(12),
        quick: true,
    };
}

/// The ending of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It has an error and a cost.
    Reached,
    /// It ended with an error or lost the motion.
    Failed(String),
    /// It took too long.
    Stopped(String),
}

/// One method at one tolerance or step size.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The method.
    pub method: Method,
    /// The tolerance or step size.
    pub rung: Rung,
    /// The largest error in the window, as [`Ruler`] measures it.
    pub error: Option<f64>,
    /// [s/s] CPU time per simulated second. For a run that ended early: up to its end.
    pub cost: Option<f64>,
    /// Evaluations of the right-hand side per simulated second.
    pub evaluations: Option<f64>,
    /// [s] Simulated time over which the cost was measured.
    pub over: f64,
    /// Its ending.
    pub verdict: Verdict,
}

/// A scene's work-precision diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// The scene.
    pub scene: String,
    /// [s] Time in which errors count.
    pub window: f64,
    /// [s] Time over which costs are measured, or only its first part if a run takes too long.
    pub span: f64,
    /// Error of the reference.
    pub floor: f64,
    /// All points, by method, from coarse to fine.
    pub points: Vec<Point>,
    /// Methods that solve a different model.
    pub others: Vec<Method>,
}

impl Diagram {
    /// Runs everything. `tick` is called before every point.
    pub fn of(
        subject: &Subject,
        ruler: &Ruler,
        reference: &Reference,
        budget: &Budget,
        tick: impl Fn(Method, Rung),
    ) -> Result<Self> {
        let span = subject.span(reference.window);
        let (methods, others) = ladder::methods();
        let deadline = Instant::now() + budget.scene;
        let bench = Bench { subject, ruler, reference, budget, span };
        let ladders: Vec<Vec<Rung>> = methods.iter().map(|method| ladder::rungs(*method, budget.quick)).collect();
        let longest = ladders.iter().map(Vec::len).max().unwrap_or_default();
        let mut columns: Vec<Vec<Point>> = methods.iter().map(|_| Vec::new()).collect();
        // All methods at one tolerance first: a diagram that runs out of time has no fine tolerances, but all methods.
        for place in 0..longest {
            for ((method, rungs), column) in methods.iter().zip(&ladders).zip(&mut columns) {
                let Some(rung) = rungs.get(place) else { continue };
                tick(*method, *rung);
                let hopeless = matches!(column.last(), Some(Point { verdict: Verdict::Stopped(_), .. }));
                column.push(match () {
                    () if hopeless => Point::stopped(*method, *rung, "a coarser run was stopped"),
                    () if Instant::now() > deadline => {
                        Point::stopped(*method, *rung, "the time limit of the scene is reached")
                    }
                    () => bench.point(*method, *rung)?,
                });
            }
        }
        let points = columns.concat();
        Ok(Self {
            scene: subject.file.name.clone(),
            window: reference.window,
            span,
            floor: reference.error,
            points,
            others,
        })
    }

    /// The points of one method, from coarse to fine.
    pub fn of_method(&self, method: Method) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(move |point| point.method == method)
    }

    /// The methods, in order.
    pub fn methods(&self) -> Vec<Method> {
        let mut methods: Vec<Method> = self.points.iter().map(|point| point.method).collect();
        methods.dedup();
        methods
    }
}

impl Point {
    /// Runs a method over the reference's window for at most about `budget`. The point has its error, if it reaches the
    /// end, and its cost on the reference's grid.
    ///
    /// # Errors
    /// If the run cannot be compared with the reference.
    pub fn in_window(
        subject: &Subject,
        ruler: &Ruler,
        reference: &Reference,
        method: Method,
        rung: Rung,
        budget: Duration,
    ) -> Result<Self> {
        let Reference { trajectory, window, grid, .. } = reference;
        let mut point = Self { verdict: Verdict::Reached, ..Self::stopped(method, rung, "") };
        let experiment = subject.experiment(method, rung, *window, *grid);
        let run = match march(subject.fmu, &experiment, Look::Everywhere, budget) {
            Ok(run) => run,
            // A method may not support a scene.
            Err(error) => return Ok(Self { verdict: Verdict::Failed(format!("{error:#}")), ..point }),
        };
        point.account(&run);
        match run.ending {
            Ending::Reached => point.error = Some(ruler.error(&run.trajectory, trajectory, *window)?),
            Ending::Stopped => {
                let seconds = budget.as_secs_f64();
                point.verdict = Verdict::Stopped(format!("it did not reach {window} s within {seconds} s"));
            }
            Ending::Failed(why) => point.verdict = Verdict::Failed(why),
        }
        Ok(point)
    }

    /// A point that was not run.
    pub fn stopped(method: Method, rung: Rung, why: &str) -> Self {
        let verdict = Verdict::Stopped(why.into());
        Self { method, rung, error: None, cost: None, evaluations: None, over: 0.0, verdict }
    }
}

/// The common data of a diagram's points.
struct Bench<'a> {
    subject: &'a Subject<'a>,
    ruler: &'a Ruler,
    reference: &'a Reference,
    budget: &'a Budget,
    span: f64,
}

impl Bench<'_> {
    /// Measures first the error, then the cost.
    fn point(&self, method: Method, rung: Rung) -> Result<Point> {
        let mut point = Point::in_window(self.subject, self.ruler, self.reference, method, rung, self.budget.run)?;
        let Some(error) = point.error else { return Ok(point) };
        let experiment = self.subject.experiment(method, rung, self.span, self.subject.cost_step());
        let fastest = self.repeats().fastest(self.subject.fmu, &experiment, self.budget.run)?;
        point.account(&fastest);
        if let Ending::Failed(why) = fastest.ending {
            point.verdict = Verdict::Failed(why);
        } else if error > LOST {
            point.verdict = Verdict::Failed(format!("error above {LOST}"));
        }
        Ok(point)
    }

    fn repeats(&self) -> Repeats {
        if self.budget.quick {
            Repeats { least: 1, enough: Duration::from_millis(30), most: 20 }
        } else {
            Repeats { least: 1, enough: Duration::from_millis(400), most: 100 }
        }
    }
}

impl Point {
    fn account(&mut self, run: &March) {
        let evaluations = run.trajectory.column("solver.evaluations").ok().and_then(|column| column.last().copied());
        if run.simulated > 0.0 {
            self.cost = Some(run.spent.as_secs_f64() / run.simulated);
            self.evaluations = evaluations.map(|count| count / run.simulated);
            self.over = run.simulated;
        }
    }
}
