//! Method × rung → points of a work-precision diagram, failures included.

use super::Subject;
use super::ladder::{self, Rung};
use super::reference::Reference;
use super::ruler::Ruler;
use crate::run::{Ending, Look, March, Repeats, march};
use anyhow::Result;
use slidercrank::scene::Method;
use std::time::{Duration, Instant};

/// A run whose largest error is above this has lost the motion.
pub const LOST: f64 = 1.0;

/// How much time a diagram may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Of one run.
    pub run: Duration,
    /// Of one of the two runs of the reference.
    pub reference: Duration,
    /// Of the whole diagram; what is not begun by then is stopped.
    pub scene: Duration,
    /// Whether every other rung does.
    pub quick: bool,
}

impl Budget {
    /// Six diagrams in less than ten minutes.
    pub const FULL: Self = Self {
        run: Duration::from_millis(2500),
        reference: Duration::from_secs(8),
        scene: Duration::from_secs(65),
        quick: false,
    };
    /// For a first look.
    pub const QUICK: Self = Self {
        run: Duration::from_millis(400),
        reference: Duration::from_secs(3),
        scene: Duration::from_secs(12),
        quick: true,
    };
}

/// What became of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It has an error and a cost.
    Reached,
    /// It gave up or lost the motion.
    Failed(String),
    /// It was too dear.
    Stopped(String),
}

/// One method at one rung.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Which method.
    pub method: Method,
    /// How accurate it was asked to be.
    pub rung: Rung,
    /// The largest error in the window, as [`Ruler`] measures it.
    pub error: Option<f64>,
    /// [s/s] The processor's time per simulated second; of a run that did not end, up to there.
    pub cost: Option<f64>,
    /// Evaluations of the right-hand side per simulated second.
    pub evaluations: Option<f64>,
    /// [s] Simulated time that the cost was taken over.
    pub over: f64,
    /// What became of it.
    pub verdict: Verdict,
}

/// A scene's work-precision diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// The scene.
    pub scene: String,
    /// [s] In which errors are taken.
    pub window: f64,
    /// [s] Over which costs are taken; the first part of it where a run is too dear.
    pub span: f64,
    /// Error of the reference.
    pub floor: f64,
    /// All points, by method, from coarse to fine.
    pub points: Vec<Point>,
    /// Methods that solve another model.
    pub others: Vec<Method>,
}

impl Diagram {
    /// Runs everything; `tick` hears of every point before it is made.
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
        // Across the methods first: a diagram that runs out of time lacks its dear end, not a method.
        for place in 0..longest {
            for ((method, rungs), column) in methods.iter().zip(&ladders).zip(&mut columns) {
                let Some(rung) = rungs.get(place) else { continue };
                tick(*method, *rung);
                let hopeless = matches!(column.last(), Some(Point { verdict: Verdict::Stopped(_), .. }));
                column.push(match () {
                    () if hopeless => Point::stopped(*method, *rung, "a coarser one was stopped"),
                    () if Instant::now() > deadline => Point::stopped(*method, *rung, "the scene's time is over"),
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
    /// Runs a method over the reference's window for at most about `budget`: its error, where it reaches the end, and
    /// what it cost on the reference's grid.
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
            // A method may refuse a scene.
            Err(error) => return Ok(Self { verdict: Verdict::Failed(format!("{error:#}")), ..point }),
        };
        point.account(&run);
        match run.ending {
            Ending::Reached => point.error = Some(ruler.error(&run.trajectory, trajectory, *window)?),
            Ending::Stopped => {
                let seconds = budget.as_secs_f64();
                point.verdict = Verdict::Stopped(format!("{seconds} s did not take it to {window} s"));
            }
            Ending::Failed(why) => point.verdict = Verdict::Failed(why),
        }
        Ok(point)
    }

    /// One that was not run.
    pub fn stopped(method: Method, rung: Rung, why: &str) -> Self {
        let verdict = Verdict::Stopped(why.into());
        Self { method, rung, error: None, cost: None, evaluations: None, over: 0.0, verdict }
    }
}

/// What one diagram's points have in common.
struct Bench<'a> {
    subject: &'a Subject<'a>,
    ruler: &'a Ruler,
    reference: &'a Reference,
    budget: &'a Budget,
    span: f64,
}

impl Bench<'_> {
    /// First the error, then the cost.
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
