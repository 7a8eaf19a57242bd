//! Results of a study.

use super::table::Table;
use super::units::significant;
use crate::frame::{Column, Frame};
use crate::realtime::quantile;
use crate::sweep::quantity::Reduction;
use crate::sweep::{Plan, Study};

/// Quantile of the standard normal distribution at 97.5 %.
const NORMAL: f64 = 1.959_963_984_540_054;

/// The table of runs.
pub fn plan(plan: &Plan) -> Frame {
    let runs = Frame::default().with("run", Column::Integers((0..plan.len() as i64).collect()));
    let column = |place: usize| (0..plan.len()).map(move |run| plan.value(run, place));
    plan.names().iter().enumerate().fold(runs, |frame, (place, name)| frame.reals(name.clone(), column(place)))
}

/// Statistics of each quantity over all runs that did not fail.
pub fn summary(study: &Study, frame: &Frame) -> Table {
    let mut table = Table::default();
    table.row(["quantity", "runs", "mean", "95 % of it", "deviation", "least", "5 %", "median", "95 %", "greatest"]);
    for name in study.keep.keys() {
        let Some((_, Column::Reals(values))) = frame.columns().iter().find(|(own, _)| own == name) else { continue };
        let mut kept: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        kept.sort_by(f64::total_cmp);
        let (mean, deviation) = (Reduction::Mean.of(&kept), Reduction::Deviation.of(&kept));
        let half = NORMAL * deviation / (kept.len() as f64).sqrt();
        let [least, low, median, high, greatest] = [0.0, 0.05, 0.5, 0.95, 1.0].map(|share| quantile(&kept, share));
        let numbers = [mean, half, deviation, least, low, median, high, greatest].map(significant);
        let [mean, half, deviation, least, low, median, high, greatest] = numbers;
        let runs = kept.len().to_string();
        if kept.is_empty() {
            table.gap(vec![name.clone(), runs], "no run came to its end");
            continue;
        }
        table.row([name, &runs, &mean, &format!("± {half}"), &deviation, &least, &low, &median, &high, &greatest]);
    }
    table
}

/// A sentence with the number of runs that failed, and the first failure.
pub fn failures(frame: &Frame) -> String {
    let Some((_, Column::Texts(status))) = frame.columns().iter().find(|(name, _)| name == "status") else {
        return String::new();
    };
    let failed: Vec<(usize, &String)> = status.iter().enumerate().filter(|(_, status)| *status != "ok").collect();
    match failed.first() {
        None => format!("all {} runs came to their end", status.len()),
        Some((run, why)) => format!("{} of {} runs failed; run {run}: {why}", failed.len(), status.len()),
    }
}
