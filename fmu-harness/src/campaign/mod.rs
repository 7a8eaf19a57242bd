//! A randomized campaign: scenes are drawn from the whole legal parameter space or from plausible machines, and each of
//! them is put to the same test.
//!
//! Kind, seed and number determine a scene, whatever else is run. If a run ends with an error, the other adaptive
//! methods repeat it; if one of them finishes, the scene has failed. A scene that fails is simplified for as long as it
//! still fails, and is kept as a scene file.

mod agreement;
mod draw;
mod machine;
mod shipped;
pub mod stiffness;
pub mod trial;
mod usual;
mod watch;

use proptest::strategy::{BoxedStrategy, Just, Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use rayon::prelude::*;
use slidercrank::scene::read::{SceneFile, read};
use slidercrank::scene::write::write;
use slidercrank::scene::{Method, Scene};
use std::time::{Duration, Instant};
use stiffness::Stiffness;
use trial::{Cost, Terms, Verdict, trial};
use watch::Watch;

/// The scenes from which a campaign draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// Any legal scene, with parameters at the ends of their ranges, too.
    Legal,
    /// Machines of plausible sizes, loads and speeds.
    Machines,
    /// The shipped scenes with every choice of clearances, with both drives, at three tolerances, with the default
    /// method. Where another adaptive method finishes, the default must finish, too, with the same motion.
    Shipped,
}

/// A campaign.
#[derive(Clone, Copy, Debug)]
pub struct Campaign {
    /// Kind of its scenes.
    pub kind: Kind,
    /// Number of scenes.
    pub scenes: u64,
    /// Seed: the same seed draws the same scenes.
    pub seed: u64,
    /// Turns of each run.
    pub turns: f64,
    /// Maximum number of evaluations of a trial, in the usual ones.
    pub effort: f64,
}

/// The outcome of a scene.
pub struct Outcome {
    /// Number of illegal scenes that were drawn before it.
    pub refused: u64,
    /// Ending of its run.
    pub verdict: Verdict,
    /// Cost of its run.
    pub cost: Cost,
    /// A run that failed: its scene, and the simplest that fails alike.
    pub failure: Option<[SceneFile; 2]>,
}

/// One of the most expensive scenes.
pub struct Slow {
    /// Its number.
    pub number: u64,
    /// The scene.
    pub scene: Scene,
    /// What it took.
    pub cost: Cost,
    /// Evaluations per turn, divided by the median of all scenes.
    pub over_median: f64,
    /// The stiff parts of it.
    pub stiffness: Stiffness,
}

/// Maximum number of draws for one legal scene.
const DRAWS: u64 = 10_000;
/// Minimum number of turns of a run whose cost per turn counts.
const LEAST_TURNS: f64 = 0.01;
/// Maximum time for simplifying a scene that failed.
const SIMPLER: Duration = Duration::from_secs(60);
/// A trial that takes longer counts as hanging.
pub const HANGS: Duration = Duration::from_secs(600);
/// Maximum number of evaluations of a rigid mechanism's equations of motion: in a trial of a legal scene, and per turn
/// of a machine.
const EVALUATIONS: f64 = 1.2e6;
const EVALUATIONS_PER_TURN: f64 = 5e5;
/// If the default method has spent all evaluations of a shipped scene, it has failed only if another method finishes
/// with this share of them: evaluations in blocks are numerous, but cheap.
const FAR_LESS: f64 = 0.1;

impl Cost {
    /// Evaluations per turn.
    pub fn per_turn(&self) -> f64 {
        f64::from(self.evaluations) / self.turns
    }
}

impl Kind {
    /// Number of scenes of this kind, unless they are drawn at random.
    pub fn count(self) -> Option<u64> {
        (self == Self::Shipped).then(shipped::count)
    }
}

impl Campaign {
    /// Runs all trials on all threads. `progress` is called after each trial, `late` with the scene of a trial that
    /// hangs.
    pub fn run(&self, progress: impl Fn() + Sync, late: impl Fn(u64, &SceneFile) + Sync) -> Vec<Outcome> {
        let watch = Watch::default();
        std::thread::scope(|threads| {
            threads.spawn(|| watch.wait(HANGS, |number| late(number, &self.scene(number))));
            let one = |number: u64| {
                let outcome = watch.over(number, || self.outcome(number));
                progress();
                outcome
            };
            let outcomes = (0..self.scenes).into_par_iter().map(one).collect();
            watch.end();
            outcomes
        })
    }

    /// The scenes that took the most evaluations per turn, among those whose cranks turned.
    pub fn slowest(&self, outcomes: &[Outcome], most: usize) -> Vec<Slow> {
        let mut costs: Vec<(u64, Cost)> = (0..).zip(outcomes).map(|(number, outcome)| (number, outcome.cost)).collect();
        costs.retain(|(_, cost)| cost.turns >= LEAST_TURNS);
        costs.sort_by(|one, other| other.1.per_turn().total_cmp(&one.1.per_turn()));
        let Some(median) = costs.get(costs.len() / 2).map(|(_, cost)| cost.per_turn()) else { return vec![] };
        let slow = |(number, cost): &(u64, Cost)| {
            let file = self.scene(*number);
            let stiffness = Stiffness::of(&file);
            Slow { number: *number, scene: file.scene, cost: *cost, over_median: cost.per_turn() / median, stiffness }
        };
        costs.par_iter().take(most).map(slow).collect()
    }

    /// The scene of this number.
    pub fn scene(&self, number: u64) -> SceneFile {
        self.draw(number).1.current()
    }

    /// Runs the trial of the scene of this number.
    pub fn outcome(&self, number: u64) -> Outcome {
        let (refused, mut tree) = self.draw(number);
        let file = tree.current();
        let (verdict, cost) = self.verdict(&file, number);
        let failure = matches!(verdict, Verdict::Failed(_)).then(|| {
            let simpler = self.simplest(&mut tree, &verdict, number);
            [file, simpler].map(|file| SceneFile { name: format!("{}-{number}", self.seed), ..file })
        });
        Outcome { refused, verdict, cost, failure }
    }

    /// The first legal scene of this number, and how many illegal scenes were drawn before it.
    fn draw(&self, number: u64) -> (u64, impl ValueTree<Value = SceneFile> + use<>) {
        let mut seed = [0; 32];
        seed[..8].copy_from_slice(&self.seed.to_le_bytes());
        seed[8..16].copy_from_slice(&number.to_le_bytes());
        let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
        let mut runner = TestRunner::new_with_rng(Config::default(), rng);
        let scenes: BoxedStrategy<SceneFile> = match self.kind {
            Kind::Legal => draw::scene_files(self.turns).boxed(),
            Kind::Machines => machine::scene_files(self.turns).boxed(),
            Kind::Shipped => match shipped::scene_file(number, self.turns) {
                Ok(file) => Just(file).boxed(),
                Err(error) => unreachable!("{error:#}"),
            },
        };
        for refused in 0..DRAWS {
            // These strategies never reject a draw.
            if let Ok(tree) = scenes.new_tree(&mut runner)
                && tree.current().scene.check().is_ok()
            {
                return (refused, tree);
            }
        }
        unreachable!("none of {DRAWS} draws is a legal scene")
    }

    /// Runs the trial of a scene, after its file has been written and read.
    fn verdict(&self, file: &SceneFile, number: u64) -> (Verdict, Cost) {
        match read(&write(file), "drawn.toml") {
            Ok(found) if found == *file => {}
            Ok(_) => {
                return (
                    Verdict::Failed("the scene differs after its file has been written and read".into()),
                    Cost::default(),
                );
            }
            Err(error) => return (Verdict::Failed(format!("its file is refused: {error}")), Cost::default()),
        }
        // These numbers are independent of the draws.
        let saved_at = (number as f64 * 0.618_033_988_75).fract();
        let by = |method: Method, share: f64| {
            let mut file = file.clone();
            file.scene.solver.method = method;
            let evaluations = (share * self.evaluations(&file.scene)) as i32;
            file.scene.solver.max_evaluations = evaluations;
            trial(&file, Terms { evaluations, saved_at })
        };
        let own = file.scene.solver.method;
        let (verdict, cost) = by(own, 1.0);
        let why = match &verdict {
            Verdict::Ended(why) if !own.has("fixed step") => why.clone(),
            Verdict::Spent if self.kind == Kind::Shipped => {
                "it needs more than the maximum number of evaluations".into()
            }
            Verdict::Finished if self.kind == Kind::Shipped => match agreement::parts(file) {
                Some(how) => return (Verdict::Failed(format!("{} leaves the reference: {how}", own.name())), cost),
                None => return (verdict, cost),
            },
            _ => return (verdict, cost),
        };
        let share = if verdict == Verdict::Spent { FAR_LESS } else { 1.0 };
        let finishes = |other: &&Method| **other != own && by(**other, share).0 == Verdict::Finished;
        match Method::ALL.iter().filter(|other| !other.has("fixed step")).find(finishes) {
            Some(other) => {
                (Verdict::Failed(format!("{} ends early, {} finishes: {why}", own.name(), other.name())), cost)
            }
            None => (verdict, cost),
        }
    }

    /// Maximum number of evaluations of a trial. It is smaller for a rod with many modes, an audit or a Jacobian, whose
    /// evaluations are expensive.
    fn evaluations(&self, scene: &Scene) -> f64 {
        let most = match self.kind {
            Kind::Legal => EVALUATIONS,
            Kind::Machines | Kind::Shipped => EVALUATIONS_PER_TURN * self.turns,
        };
        let modes = f64::from(scene.rod.flexible.bending_modes + scene.rod.flexible.axial_modes);
        let mut price = if modes > 0.0 { 2.0 + 0.25 * modes * modes } else { 1.0 };
        if scene.energy.audit {
            price *= 1.5;
        }
        if matches!(scene.solver.method, Method::Radau13 | Method::Rodas4) {
            price *= 3.0;
        }
        self.effort * most / price
    }

    /// The simplest scene found that fails with the same message, apart from numbers.
    fn simplest(&self, tree: &mut impl ValueTree<Value = SceneFile>, failed: &Verdict, number: u64) -> SceneFile {
        let words = |verdict: &Verdict| match verdict {
            Verdict::Failed(what) => what.split([' ', ',']).take(3).collect::<Vec<_>>().join(" "),
            _ => String::new(),
        };
        let (began, mut simplest) = (Instant::now(), tree.current());
        while began.elapsed() < SIMPLER {
            let legal = |file: &SceneFile| file.scene.check().is_ok();
            let fails = |file: &SceneFile| legal(file) && words(&self.verdict(file, number).0) == words(failed);
            let moved = if fails(&tree.current()) {
                simplest = tree.current();
                tree.simplify()
            } else {
                tree.complicate()
            };
            if !moved {
                break;
            }
        }
        simplest
    }
}
