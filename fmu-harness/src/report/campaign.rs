//! What came of a campaign, as a table.

use super::table::Table;
use crate::campaign::Outcome;
use crate::campaign::trial::Verdict;
use std::collections::BTreeMap;

/// How many scenes were drawn, run and finished, by which errors the others ended, and how many failed.
pub fn table(outcomes: &[Outcome]) -> Table {
    let refused: u64 = outcomes.iter().map(|outcome| outcome.refused).sum();
    let count = |of: fn(&Verdict) -> bool| outcomes.iter().filter(|outcome| of(&outcome.verdict)).count();
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for outcome in outcomes {
        if let Verdict::Ended(kind) = &outcome.verdict {
            *kinds.entry(kind).or_default() += 1;
        }
    }
    let mut table = Table::default();
    table.row(["drawn and refused as no legal scene".to_owned(), refused.to_string()]);
    table.row(["run".to_owned(), outcomes.len().to_string()]);
    table.row(["finished".to_owned(), count(|verdict| *verdict == Verdict::Finished).to_string()]);
    table.row(["ended by the budget of work".to_owned(), count(|verdict| *verdict == Verdict::Spent).to_string()]);
    for (kind, count) in kinds {
        table.row([format!("ended: {kind}"), count.to_string()]);
    }
    table.row(["failed".to_owned(), count(|verdict| matches!(verdict, Verdict::Failed(_))).to_string()]);
    table
}
