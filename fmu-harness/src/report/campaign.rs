//! Tables of a campaign's results.

use super::table::Table;
use super::units::{grouped, significant};
use crate::campaign::stiffness::Stiffness;
use crate::campaign::trial::Verdict;
use crate::campaign::{Outcome, Slow};
use std::collections::BTreeMap;

/// Numbers of scenes that were drawn, run and finished, errors that ended the others, and number of failures.
pub fn table(outcomes: &[Outcome]) -> Table {
    let refused: u64 = outcomes.iter().map(|outcome| outcome.refused).sum();
    let count = |of: fn(&Verdict) -> bool| outcomes.iter().filter(|outcome| of(&outcome.verdict)).count();
    let mut causes: BTreeMap<&str, usize> = BTreeMap::new();
    for outcome in outcomes {
        if let Verdict::Ended(cause) = &outcome.verdict {
            *causes.entry(cause).or_default() += 1;
        }
    }
    let mut table = Table::default();
    table.row(["scenes", "number"]);
    table.row(["drawn and refused as no legal scene".to_owned(), refused.to_string()]);
    table.row(["run".to_owned(), outcomes.len().to_string()]);
    table.row(["finished".to_owned(), count(|verdict| *verdict == Verdict::Finished).to_string()]);
    table.row(["ended by the budget of work".to_owned(), count(|verdict| *verdict == Verdict::Spent).to_string()]);
    table.row(["ended by an error".to_owned(), causes.values().sum::<usize>().to_string()]);
    for (cause, count) in causes {
        table.row([format!("  {cause}"), count.to_string()]);
    }
    table.row(["failed".to_owned(), count(|verdict| matches!(verdict, Verdict::Failed(_))).to_string()]);
    table
}

/// The scenes with the most evaluations per turn, with their stiff parts.
pub fn slowest(scenes: &[Slow]) -> Table {
    let mut table = Table::default();
    table.row([
        "scene",
        "method",
        "evaluations/turn",
        "over the median",
        "turns made",
        "fastest rate [1/s]",
        "closed in A, B, C, T [%]",
        "of it softly [%]",
        "friction, modes",
    ]);
    for Slow { number, scene, cost, over_median, stiffness, .. } in scenes {
        let Stiffness { fastest, decays, closed, at_floor } = stiffness;
        let shares = |shares: &[f64; 4]| shares.map(|share| format!("{:.0}", 100.0 * share)).join(", ");
        table.row([
            number.to_string(),
            scene.solver.method.name().to_owned(),
            grouped(cost.per_turn()),
            format!("× {}", significant(*over_median)),
            significant(cost.turns),
            format!("{fastest:.1e}, {}", if *decays { "decays" } else { "oscillates" }),
            shares(closed),
            shares(at_floor),
            stiff_parts(scene),
        ]);
    }
    table
}

/// The parts of a scene that may be stiff independently of its contacts.
fn stiff_parts(scene: &slidercrank::scene::Scene) -> String {
    let joint = &scene.joint;
    let all = [
        ("A", joint.a.model, &joint.a.contact),
        ("B", joint.b.model, &joint.b.contact),
        ("C", joint.c.model, &joint.c.contact),
        ("T", joint.t.model, &joint.t.contact),
    ];
    let with_play = all.into_iter().filter(|(_, model, _)| *model == slidercrank::scene::JointModel::Clearance);
    let mut parts: Vec<String> =
        with_play.map(|(name, _, contact)| format!("{name} {}", contact.friction.law.name())).collect();
    let flexible = &scene.rod.flexible;
    if flexible.bending_modes + flexible.axial_modes > 0 {
        parts.push(format!("{}+{} modes", flexible.bending_modes, flexible.axial_modes));
    }
    parts.join(", ")
}
