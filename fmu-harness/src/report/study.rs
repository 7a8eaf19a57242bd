//! Results of a study.

use super::student::student;
use super::table::Table;
use super::units::{self, significant};
use crate::frame::{Column, Frame};
use crate::sweep::linear::deviation;
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

/// Quantile `share` of numbers in ascending order, on the straight line between the two beside it (type 7 of Hyndman and
/// Fan, The American Statistician 50, 1996); NaN of no numbers.
fn quantile(numbers: &[f64], share: f64) -> f64 {
    let place = share * numbers.len().saturating_sub(1) as f64;
    let at = |place: f64| numbers.get(place as usize).copied().unwrap_or(f64::NAN);
    let (before, after) = (at(place.floor()), at(place.ceil()));
    before + place.fract() * (after - before)
}

/// Statistics of each quantity over all runs that did not fail.
pub fn summary(study: &Study, frame: &Frame) -> Table {
    let mut table = Table::default();
    table.row(["quantity", "runs", "mean", "± 95 %", "deviation", "least", "5 %", "median", "95 %", "greatest"]);
    for name in study.keep.keys() {
        let Some(values) = frame.column(name) else { continue };
        let mut kept: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        kept.sort_by(f64::total_cmp);
        let (mean, deviation) = (Reduction::Mean.of(&kept), Reduction::Deviation.of(&kept));
        // The runs of a grid are no sample: their mean has no confidence interval.
        let count = if study.is_sample() { kept.len() as f64 } else { f64::NAN };
        let half = student(count - 1.0) * deviation / count.sqrt();
        let [least, low, median, high, greatest] = [0.0, 0.05, 0.5, 0.95, 1.0].map(|share| quantile(&kept, share));
        let half = if half.is_finite() { format!("± {}", significant(half)) } else { known(half) };
        let numbers = [mean, deviation, least, low, median, high, greatest].map(known);
        let [mean, deviation, least, low, median, high, greatest] = numbers;
        let runs = kept.len().to_string();
        if kept.is_empty() {
            table.gap(vec![name.clone(), runs], "no run came to its end");
            continue;
        }
        table.row([name, &runs, &mean, &half, &deviation, &least, &low, &median, &high, &greatest]);
    }
    table
}

/// The standard deviation of each quantity by the runs and to first order, the shares of the parameters, and sentences
/// about quantities that are not linear.
pub fn linear(linear: &Linear, frame: &Frame) -> ([Table; 2], Vec<String>) {
    let mut table = Table::default();
    let mut sentences = vec![];
    table.row(["quantity", "deviation", "± 95 %", "linear", "ratio", "explained", "verdict"]);
    for (name, row) in &linear.rows {
        match linear.compare(name, row, frame) {
            Ok(found) if found.is_constant() => table.row([name, "0", "–", "0", "–", "–", "constant"]),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_drawn_runs_have_a_wider_interval_and_those_of_a_grid_have_none() {
        let text = |parameters: &str| {
            format!(
                "name = 'own'\nscene = 'wornpin'\n{parameters}\n[run]\nturns = 1\nstep = 1e-4\n\
                 [keep]\nv = {{ of = 'slider.v', reduce = 'last' }}"
            )
        };
        let drawn = text("draws = 4\nrandom.gravity = { uniform = { min = 1, max = 2 } }");
        let frame = Frame::default().reals("v", [4.0, 1.0, 3.0, 2.0, f64::NAN]);
        for (text, half) in [(drawn, "± 2.052"), (text("grid.gravity = [1, 2]"), "–")] {
            let study: Study = toml::from_str(&text).expect("a study");
            let table = summary(&study, &frame);
            let row = &table.lines()[1];
            // Mean, its interval and the deviation; then least, 5 %, median, 95 % and greatest.
            assert_eq!(row[1..], ["4", "2.500", half, "1.291", "1.000", "1.150", "2.500", "3.850", "4.000"]);
        }
        assert!(quantile(&[], 0.5).is_nan() && quantile(&[7.0], 0.95) == 7.0);
    }
}
