//! Tables and columns of derivatives of quantities by parameters.

use super::table::Table;
use super::units::known;
use crate::frame::{Column, Frame};
use crate::sensitivity::Sensitivities;
use anyhow::Result;

/// Differences by each parameter, of all quantities.
type Checked = [Result<Vec<f64>>];

/// Relative derivatives of a value that is 0 but for rounding errors.
const MEANINGLESS: f64 = 1e10;

/// A row for each quantity and parameter.
pub fn table(found: &Sensitivities, checked: Option<&Checked>) -> Table {
    let mut table = Table::default();
    let mut head = vec!["quantity", "its value", "parameter", "its unit", "derivative", "relative derivative"];
    head.extend(checked.map(|_| "difference quotient"));
    table.line(head.into_iter().map(Into::into).collect());
    for (i, row) in found.rows.iter().enumerate() {
        let value = format!("{:.6e}", row.value);
        match &row.slopes {
            Ok(slopes) => {
                for (k, (parameter, slope)) in found.parameters.iter().zip(slopes).enumerate() {
                    let relative = slope * found.values[k] / row.value;
                    let mut line = vec![
                        row.wanted.text.clone(),
                        value.clone(),
                        parameter.name.into(),
                        parameter.unit().into(),
                        format!("{slope:.6e}"),
                        known(if relative.abs() < MEANINGLESS { relative } else { f64::NAN }),
                    ];
                    line.extend(checked.map(|checked| match &checked[k] {
                        Ok(differences) if differences[i].is_finite() => format!("{:.6e}", differences[i]),
                        _ => "–".into(),
                    }));
                    table.line(line);
                }
            }
            Err(error) => {
                let mut line: Vec<String> = vec![row.wanted.text.clone(), value];
                line.resize(if checked.is_some() { 7 } else { 6 }, "–".into());
                table.gap(line, &format!("{error:#}"));
            }
        }
    }
    table
}

/// The changes for which the derivatives hold.
pub fn reach(found: &Sensitivities) -> Table {
    let mut table = Table::default();
    table.row(["parameter", "its value", "its reach", "the reach over the value"]);
    for ((parameter, value), reach) in found.parameters.iter().zip(&found.values).zip(&found.reach) {
        let unit = parameter.unit();
        let share = (reach / value).abs();
        table.row([
            parameter.name.to_owned(),
            format!("{value:.4e} {unit}"),
            format!("{reach:.2e} {unit}"),
            if share.is_finite() { format!("{share:.1e}") } else { "–".into() },
        ]);
    }
    table.row(["growth of neighbouring motions [1/s]".to_owned(), known(found.growth), String::new(), String::new()]);
    table
}

/// The derivatives as columns.
pub fn frame(found: &Sensitivities, checked: Option<&Checked>) -> Frame {
    let rows: Vec<(usize, usize)> =
        (0..found.rows.len()).flat_map(|i| (0..found.parameters.len()).map(move |k| (i, k))).collect();
    let texts = |of: &dyn Fn(usize, usize) -> String| Column::Texts(rows.iter().map(|&(i, k)| of(i, k)).collect());
    let reals = |of: &dyn Fn(usize, usize) -> f64| rows.iter().map(|&(i, k)| of(i, k)).collect::<Vec<_>>();
    let slope = |i: usize, k: usize| found.rows[i].slopes.as_ref().map_or(f64::NAN, |slopes| slopes[k]);
    let mut frame = Frame::default()
        .with("quantity", texts(&|i, _| found.rows[i].wanted.text.clone()))
        .reals("value", reals(&|i, _| found.rows[i].value))
        .reals("time", reals(&|i, _| found.rows[i].time))
        .with("parameter", texts(&|_, k| found.parameters[k].name.to_owned()))
        .reals("parameter.value", reals(&|_, k| found.values[k]))
        .reals("derivative", reals(&slope))
        .reals("reach", reals(&|_, k| found.reach[k]));
    if let Some(checked) = checked {
        let difference = |i: usize, k: usize| checked[k].as_ref().map_or(f64::NAN, |all| all[i]);
        frame = frame.reals("difference", reals(&difference));
    }
    frame
}
