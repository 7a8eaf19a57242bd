//! Results of a study.

use super::table::Table;
use super::units::{self, significant};
use crate::frame::{Column, Frame};
use crate::realtime::quantile;
use crate::sweep::linear::{NORMAL, deviation};
use crate::sweep::quantity::Reduction;
use crate::sweep::{Linear, Plan, Study};

/// The table of runs.
pub fn plan(plan: &Plan) -> Frame {
    let runs = Frame::default().with("run", Column::Integers((0..plan.len() as i64).collect()));
    let column = |place: usize| (0..plan.len()).map(move |run| plan.value(run, place));
    plan.names().iter().enumerate().fold(runs, |frame, (place, name)| frame.reals(name.clone(), column(place)))
}

/// A number with four digits; a dash for the deviation of a single run.
fn known(number: f64) -> String {
    if number.is_finite() { significant(number) } else { "–".into() }
}

/// Statistics of each quantity over all runs that did not fail.
pub fn summary(study: &Study, frame: &Frame) -> Table {
    let mut table = Table::default();
    table.row(["quantity", "runs", "mean", "95 % of it", "deviation", "least", "5 %", "median", "95 %", "greatest"]);
    for name in study.keep.keys() {
        let Some(values) = frame.column(name) else { continue };
        let mut kept: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        kept.sort_by(f64::total_cmp);
        let (mean, deviation) = (Reduction::Mean.of(&kept), Reduction::Deviation.of(&kept));
        let half = NORMAL * deviation / (kept.len() as f64).sqrt();
        let [least, low, median, high, greatest] = [0.0, 0.05, 0.5, 0.95, 1.0].map(|share| quantile(&kept, share));
        let numbers = [mean, half, deviation, least, low, median, high, greatest].map(known);
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

/// The standard deviation of each quantity by the runs and to first order, the shares of the parameters, and sentences
/// about quantities that are not linear.
pub fn linear(linear: &Linear, frame: &Frame) -> ([Table; 2], Vec<String>) {
    let mut table = Table::default();
    let mut sentences = vec![];
    table.row(["quantity", "deviation", "95 % of it", "linear", "ratio", "explained", "verdict"]);
    for (name, row) in &linear.rows {
        match linear.compare(name, row, frame) {
            Ok(found) => {
                let numbers = [found.deviation, found.half_width(), found.linear].map(significant);
                let [deviation, half, first_order] = numbers;
                let ratio = known(found.linear / found.deviation);
                let explained = format!("{} %", known(100.0 * found.explained));
                let verdict = if found.agrees() { "linear" } else { "not linear" };
                table.row([name, &deviation, &format!("± {half}"), &first_order, &ratio, &explained, verdict]);
                if !found.agrees() {
                    let reason = linear.parts(row).map(|parts| linear.reason(&parts)).unwrap_or_default();
                    sentences.push(format!("{name} is not linear: {reason}"));
                }
            }
            Err(why) => {
                let first_order = linear.parts(row).map(|parts| deviation(&parts));
                let verdict = if first_order.is_ok() { "not compared" } else { "no derivative" };
                table.row([name, "–", "–", &first_order.map_or("–".into(), significant), "–", "–", verdict]);
                sentences.push(format!("{name}: {verdict}: {why:#}"));
            }
        }
    }
    ([table, shares(linear)], sentences)
}

/// The share of each parameter in the first-order variance of each quantity.
fn shares(linear: &Linear) -> Table {
    let mut table = Table::default();
    let names = linear.found.parameters.iter().map(|parameter| parameter.name.to_owned());
    table.line(["share of the variance [%]".to_owned()].into_iter().chain(names).collect());
    for (name, row) in &linear.rows {
        let Ok(parts) = linear.parts(row) else { continue };
        let variance: f64 = parts.iter().map(|part| part * part).sum();
        let shares = parts.iter().map(|part| units::known(100.0 * part * part / variance));
        table.line([name.clone()].into_iter().chain(shares).collect());
    }
    table
}

/// The derivatives of a linear analysis as columns, with the standard deviations of the parameters.
pub fn derivatives(linear: &Linear) -> Frame {
    let (deviations, rows) = (&linear.deviations, linear.found.rows.len());
    let frame = super::sensitivity::frame(&linear.found, None);
    frame.reals("parameter.deviation", (0..rows).flat_map(|_| deviations.iter().copied()))
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
