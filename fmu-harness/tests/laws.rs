//! The comparison of contact laws: it has a row for every combination, and the rows are ordered as the laws demand.

use crate::program::stock;
use fmu_harness::laws::{Case, Comparison, JointLoads, Loads};
use fmu_harness::scenes::Scenario;
use slidercrank::model::contact::damping::factor;
use slidercrank::scene::{DampingLaw, Elasticity};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::Duration;
use tempfile::TempDir;

const BUDGET: Duration = Duration::from_secs(60);
/// Turns from the start to just after the first impact of the worn pin.
const ONE_IMPACT: f64 = 0.03;

/// Restitution of the worn pin.
const RESTITUTION: f64 = 0.9;

/// The packaged worn pin.
static WORNPIN: LazyLock<(TempDir, PathBuf)> = LazyLock::new(|| {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("wornpin.fmu");
    let package = stock().package(&wornpin(&[])).expect("a package");
    package.save(&file).expect("written");
    (directory, file)
});

fn fmu() -> &'static Path {
    &WORNPIN.1
}

fn wornpin(settings: &[&str]) -> Scenario {
    let settings: Vec<_> = settings.iter().map(|setting| setting.parse().expect("a setting")).collect();
    Scenario::find("wornpin").expect("a scene").with(&settings).expect("a legal scene")
}

/// All cases of the worn pin over its first impact, with communication points near its largest penetration.
fn one_impact() -> Vec<(Case, JointLoads)> {
    let mut scenario = wornpin(&[]);
    scenario.file.run.step = 1e-6;
    let comparison = Comparison::of(&scenario.file, None, Some(ONE_IMPACT), BUDGET).expect("a comparison");
    let loads = |loads: Loads| loads.joints.into_iter().next().expect("joint C");
    let rows = comparison.run(fmu(), || ());
    rows.into_iter().map(|(case, found)| (case, loads(found.expect("a run")))).collect()
}

#[test]
fn every_elasticity_meets_every_damping_law_and_each_has_its_own_impact() {
    let rows = one_impact();
    assert_eq!(rows[0].0, Case::Ideal);
    let of = |elasticity: Elasticity, law: DampingLaw| {
        let case = Case::Laws { elasticity: Some(elasticity), law };
        let mut found = rows.iter().filter(|(own, _)| *own == case);
        let name = case.name();
        let loads = &found.next().expect(&name).1;
        assert!(found.next().is_none(), "two rows {name}");
        loads
    };
    assert_eq!(rows.len(), 1 + Elasticity::ALL.len() * DampingLaw::ALL.len());
    for &elasticity in Elasticity::ALL {
        for &law in DampingLaw::ALL {
            let loads = of(elasticity, law);
            // The first impact is the same whatever the law, as published.
            assert!(
                (loads.approach - 4.38578).abs() < 1e-5 && loads.touches == 1.0,
                "{elasticity:?} {law:?} {loads:?}"
            );
        }
        // The more a law damps, the smaller is the peak of an impact at so high a restitution.
        let mut laws: Vec<(f64, DampingLaw)> =
            DampingLaw::ALL.iter().map(|&law| (factor(law, RESTITUTION), law)).collect();
        laws.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(laws[0].1, DampingLaw::Hertz);
        // Nearly equal factors differ by less than the tolerance.
        laws.dedup_by(|a, b| a.0 - b.0 < 1e-4);
        assert!(laws.len() >= 8, "{laws:?}");
        for pair in laws.windows(2) {
            let [less, more] = [pair[0], pair[1]].map(|(_, law)| of(elasticity, law).peak);
            assert!(less > more, "{elasticity:?}: {pair:?}: {less} N, {more} N");
        }
    }
    // Of two elastic forces, one of which is 3/2 of the other for small penetrations.
    for &law in DampingLaw::ALL {
        let [soft, stiff] = [Elasticity::Liu, Elasticity::BaiZhao].map(|elasticity| of(elasticity, law));
        assert!(soft.penetration > stiff.penetration && soft.peak < stiff.peak, "{law:?}: {soft:?}, {stiff:?}");
    }
    // No contact presses as little as the ideal joint does.
    assert!(rows[1..].iter().all(|(_, loads)| loads.peak > rows[0].1.peak));
}

#[test]
fn a_law_that_refuses_the_restitution_says_so_and_the_others_run() {
    let scenario = wornpin(&["joint.C.law=hertz", "joint.C.restitution=0.01"]);
    let file = tempfile::NamedTempFile::new().expect("a file");
    let package = stock().package(&scenario).expect("a package");
    package.save(file.path()).expect("written");
    let comparison = Comparison::of(&scenario.file, Some("C"), Some(ONE_IMPACT), BUDGET).expect("a comparison");
    for (case, found) in comparison.run(file.path(), || ()) {
        let refused = case.law().is_some_and(|law| law.has("grows without bound"));
        match found {
            Ok(_) => assert!(!refused, "{}", case.name()),
            Err(error) => {
                let reason = format!(
                    "joint.C.restitution = 0.01 is not allowed: 0.02 to 1 for law {}",
                    case.law().map_or("", DampingLaw::name)
                );
                assert!(refused && format!("{error:#}").contains(&reason), "{}: {error:#}", case.name());
            }
        }
    }
}

#[test]
fn only_joints_with_clearance_are_varied_and_a_guide_has_no_elasticity() {
    let comparison = |scene: &str, joint: Option<&str>| {
        let file = Scenario::find(scene).expect("a scene").file;
        Comparison::of(&file, joint, None, BUDGET)
            .map(|comparison| (comparison.varied.concat(), comparison.cases().len()))
    };
    let refused = |scene: &str, joint: Option<&str>| comparison(scene, joint).expect_err(scene).to_string();
    assert_eq!(comparison("allplay", None).ok(), Some(("ABCT".into(), 45)));
    assert_eq!(comparison("allplay", Some("B")).ok(), Some(("B".into(), 45)));
    assert_eq!(comparison("guideplay", None).ok(), Some(("T".into(), 12)));
    assert_eq!(refused("wornpin", Some("B")), "joint B has no clearance; those with clearance: C");
    assert_eq!(refused("ideal", None), "the scene has no joint with clearance");
    let file = wornpin(&["solver.method=moreau"]).file;
    let rigid = Comparison::of(&file, None, None, BUDGET).err().expect("rigid contacts").to_string();
    assert_eq!(rigid, "solver.method = moreau: its rigid contacts have no elasticity and no damping law");
}
