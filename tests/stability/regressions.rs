//! Scenes that a campaign has found to fail once, put to the campaign's test again.

use crate::run::folder;
use crate::trial::{Terms, Verdict, trial};
use slidercrank::scene::read::read;

/// Evaluations of the equations of motion that a scene may spend.
const EVALUATIONS: i32 = 1_000_000;

#[test]
fn what_a_campaign_once_found_fails_no_more() {
    let mut seen = 0;
    for entry in std::fs::read_dir(folder("regressions")).expect("the folder of regressions").flatten() {
        let path = entry.path();
        let name = path.display().to_string();
        let mut file = read(&std::fs::read_to_string(&path).expect("a scene file"), &name).expect("a legal scene");
        file.scene.solver.max_evaluations = EVALUATIONS;
        for saved_at in [0.1, 0.4, 0.7, 0.95] {
            let (verdict, _) = trial(&file, Terms { evaluations: EVALUATIONS, saved_at });
            println!("{name}: {verdict:?}");
            assert!(!matches!(verdict, Verdict::Failed(_)), "{name}: {verdict:?}");
        }
        seen += 1;
    }
    assert!(seen > 0);
}
