//! A randomised campaign: scenes drawn by lot, over the whole legal parameter space or among plausible machines, each put
//! to the same test.
//!
//! A scene is known by the campaign's kind and seed and its number, whatever runs beside it. One that ends by an error is
//! run by the other adaptive methods, too: where one of them finishes it, it has failed. What fails is made simpler as
//! long as it fails, and kept as a scene file.

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

/// Among which scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// Anything that is legal, at the ends of every range, too.
    Legal,
    /// Machines of plausible sizes, loads and speeds.
    Machines,
    /// The shipped scenes with every choice of play, under both drives, at three tolerances, by the default method: where
    /// another adaptive method arrives, so must it, and by the same motion.
    Shipped,
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Campaign {
    /// Among which scenes.
    pub kind: Kind,
    /// How many scenes.
    pub scenes: u64,
    /// The same seed draws the same scenes.
    pub seed: u64,
    /// Turns of each run.
    pub turns: f64,
}

/// A scene and what came of it.
pub struct Outcome {
    /// Draws that were no legal scene, before it.
    pub refused: u64,
    /// How its run ended.
    pub verdict: Verdict,
    /// What it took.
    pub cost: Cost,
    /// A run that failed: its scene, and the simplest that fails alike.
    pub failure: Option<[SceneFile; 2]>,
}

/// One of the scenes that took most.
pub struct Slow {
    /// Its number.
    pub number: u64,
    /// The scene.
    pub scene: Scene,
    /// What it took.
    pub cost: Cost,
    /// Evaluations a turn over those of the median of all scenes.
    pub over_median: f64,
    /// What is stiff in it.
    pub stiffness: Stiffness,
}

/// Most draws for one legal scene.
const DRAWS: u64 = 10_000;
/// A crank that turned less has not shown what a turn takes.
const LEAST_TURNS: f64 = 0.01;
/// Longest time that a failure is made simpler for.
const SIMPLER: Duration = Duration::from_secs(60);
/// A trial that takes longer hangs.
pub const HANGS: Duration = Duration::from_secs(600);
/// Evaluations of the equations of motion that a trial of a rigid mechanism may spend: of any legal scene, and for each turn of
/// a machine.
const EVALUATIONS: f64 = 1.2e6;
const EVALUATIONS_PER_TURN: f64 = 5e5;
/// The share of these with which another method must finish a shipped scene for the default to have failed that has spent
/// them all: evaluations in blocks are many and cheap.
const FAR_LESS: f64 = 0.1;

impl Cost {
    /// Evaluations for each turn.
    pub fn per_turn(&self) -> f64 {
        f64::from(self.evaluations) / self.turns
    }
}

impl Kind {
    /// How many scenes there are of this kind, if they are not drawn.
    pub fn count(self) -> Option<u64> {
        (self == Self::Shipped).then(shipped::count)
    }
}

impl Campaign {
    /// Runs all trials on all threads; `progress` is called after each, `late` with the scene of one that hangs.
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

    /// So many of the scenes whose cranks turned, those that took the most evaluations a turn first.
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

    /// The scene of a number.
    pub fn scene(&self, number: u64) -> SceneFile {
        self.draw(number).1.current()
    }

    /// The trial of a scene by its number.
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

    /// The first legal scene of a number, and how many draws were none before it.
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
            // These strategies reject nothing.
            if let Ok(tree) = scenes.new_tree(&mut runner)
                && tree.current().scene.check().is_ok()
            {
                return (refused, tree);
            }
        }
        unreachable!("{DRAWS} draws in a row are no legal scene")
    }

    /// The trial of a scene, and of its file.
    fn verdict(&self, file: &SceneFile, number: u64) -> (Verdict, Cost) {
        match read(&write(file), "drawn.toml") {
            Ok(found) if found == *file => {}
            Ok(_) => return (Verdict::Failed("its file reads back as another scene".into()), Cost::default()),
            Err(error) => return (Verdict::Failed(format!("its file is refused: {error}")), Cost::default()),
        }
        // Numbers that have no pattern with what is drawn.
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
            Verdict::Spent if self.kind == Kind::Shipped => "its work is beyond its bound".into(),
            Verdict::Finished if self.kind == Kind::Shipped => match agreement::parts(file) {
                Some(how) => return (Verdict::Failed(format!("{} leaves the motion: {how}", own.name())), cost),
                None => return (verdict, cost),
            },
            _ => return (verdict, cost),
        };
        let share = if verdict == Verdict::Spent { FAR_LESS } else { 1.0 };
        let finishes = |other: &&Method| **other != own && by(**other, share).0 == Verdict::Finished;
        match Method::ALL.iter().filter(|other| !other.has("fixed step")).find(finishes) {
            Some(other) => {
                (Verdict::Failed(format!("{} ends where {} finishes: {why}", own.name(), other.name())), cost)
            }
            None => (verdict, cost),
        }
    }

    /// How many evaluations a trial may spend: those of a rod with many modes, with an audit or a Jacobian, are dear.
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
        if scene.solver.method == Method::Rodas4 {
            price *= 3.0;
        }
        most / price
    }

    /// The simplest scene found that fails in the same words, numbers aside.
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
