//! A randomised campaign: scenes drawn by lot over the whole legal parameter space, each put to the same test.
//!
//! A scene is known by the campaign's seed and its number, whatever runs beside it. What fails is made simpler as long
//! as it fails, and kept as a scene file.

mod draw;
pub mod trial;
mod usual;
mod watch;

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use rayon::prelude::*;
use slidercrank::scene::Method;
use slidercrank::scene::read::{SceneFile, read};
use slidercrank::scene::write::write;
use std::time::{Duration, Instant};
use trial::{Terms, Verdict, trial};
use watch::Watch;

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Campaign {
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
    /// A run that failed: its scene, and the simplest that fails alike.
    pub failure: Option<[SceneFile; 2]>,
}

/// Most draws for one legal scene.
const DRAWS: u64 = 10_000;
/// Longest time that a failure is made simpler for.
const SIMPLER: Duration = Duration::from_secs(60);
/// A trial that takes longer hangs.
pub const HANGS: Duration = Duration::from_secs(120);
/// Evaluations of the equations of motion that a trial of a rigid mechanism may spend.
const EVALUATIONS: f64 = 1.2e6;

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

    /// The scene of a number.
    pub fn scene(&self, number: u64) -> SceneFile {
        self.draw(number).1.current()
    }

    /// The trial of a scene by its number.
    pub fn outcome(&self, number: u64) -> Outcome {
        let (refused, mut tree) = self.draw(number);
        let file = tree.current();
        let verdict = verdict(&file, number);
        let failure = matches!(verdict, Verdict::Failed(_)).then(|| {
            let simpler = simplest(&mut tree, &verdict, number);
            [file, simpler].map(|file| SceneFile { name: format!("{}-{number}", self.seed), ..file })
        });
        Outcome { refused, verdict, failure }
    }

    /// The first legal scene of a number, and how many draws were none before it.
    fn draw(&self, number: u64) -> (u64, impl ValueTree<Value = SceneFile> + use<>) {
        let mut seed = [0; 32];
        seed[..8].copy_from_slice(&self.seed.to_le_bytes());
        seed[8..16].copy_from_slice(&number.to_le_bytes());
        let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
        let mut runner = TestRunner::new_with_rng(Config::default(), rng);
        let scenes = draw::scene_files(self.turns);
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
}

/// The trial of a scene, and of its file.
fn verdict(file: &SceneFile, number: u64) -> Verdict {
    match read(&write(file), "drawn.toml") {
        Ok(found) if found == *file => {}
        Ok(_) => return Verdict::Failed("its file reads back as another scene".into()),
        Err(error) => return Verdict::Failed(format!("its file is refused: {error}")),
    }
    // Numbers that have no pattern with what is drawn.
    let saved_at = (number as f64 * 0.618_033_988_75).fract();
    trial(&with_budget(file), Terms { evaluations: evaluations(file), saved_at })
}

/// The scene with a bound on the work of each communication step.
fn with_budget(file: &SceneFile) -> SceneFile {
    let mut file = file.clone();
    file.scene.solver.max_evaluations = evaluations(&file);
    file
}

/// How many evaluations a trial may spend: those of a rod with many modes, with an audit or a Jacobian, are dear.
fn evaluations(file: &SceneFile) -> i32 {
    let scene = &file.scene;
    let modes = f64::from(scene.rod.flexible.bending_modes + scene.rod.flexible.axial_modes);
    let mut price = if modes > 0.0 { 2.0 + 0.25 * modes * modes } else { 1.0 };
    if scene.energy.audit {
        price *= 1.5;
    }
    if scene.solver.method == Method::Rodas4 {
        price *= 3.0;
    }
    (EVALUATIONS / price) as i32
}

/// The simplest scene found that fails in the same words, numbers aside.
fn simplest(tree: &mut impl ValueTree<Value = SceneFile>, failed: &Verdict, number: u64) -> SceneFile {
    let words = |verdict: &Verdict| match verdict {
        Verdict::Failed(what) => what.split([' ', ',']).take(3).collect::<Vec<_>>().join(" "),
        _ => String::new(),
    };
    let (began, mut simplest) = (Instant::now(), tree.current());
    while began.elapsed() < SIMPLER {
        let legal = |file: &SceneFile| file.scene.check().is_ok();
        let fails = |file: &SceneFile| legal(file) && words(&verdict(file, number)) == words(failed);
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
