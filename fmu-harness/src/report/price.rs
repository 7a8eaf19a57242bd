//! Tables of the cost of effects: the cost of each scene of a series, and what its effect adds to the scene before.

use super::bars::{Bar, Bars};
use super::plot::{Role, Sheet};
use super::table::Table;
use super::units::{grouped, three_digits};
use crate::effects::{Price, TangentPrice};
use anyhow::Result;
use std::path::Path;

/// One column: head, function that reads the number, and format.
type Column = (&'static str, fn(&Price) -> f64, fn(f64) -> String);

const COLUMNS: [Column; 8] = [
    ("degrees of freedom", |price| price.size.degrees_of_freedom as f64, grouped),
    ("states", |price| price.size.states as f64, grouped),
    ("event functions", |price| price.size.event_functions as f64, grouped),
    ("ns/evaluation, bare", |price| price.evaluation * 1e9, grouped),
    ("ns/evaluation, all in", |price| price.all_in() * 1e9, grouped),
    ("evaluations/s", |price| price.evaluations, grouped),
    ("events/s", |price| price.events, grouped),
    ("CPU ms/s", |price| price.time * 1e3, three_digits),
];

/// Cost of every scene per simulated second.
pub fn prices(prices: &[Price]) -> Table {
    let mut table = Table::default();
    let mut head = vec!["scene".to_owned()];
    head.extend(COLUMNS.iter().map(|(name, ..)| (*name).to_owned()));
    head.push("× real time".into());
    table.line(head);
    for price in prices {
        let mut line = vec![price.scene.clone()];
        line.extend(COLUMNS.iter().map(|(_, number, print)| print(number(price))));
        line.push(three_digits(1.0 / price.time));
        table.line(line);
    }
    table
}

/// Difference in cost between every scene and the scene before.
pub fn increments(prices: &[Price]) -> Table {
    let mut table = Table::default();
    let mut head = vec!["scene adds".to_owned()];
    head.extend(COLUMNS.iter().map(|(name, ..)| (*name).to_owned()));
    head.push("× CPU".into());
    table.line(head);
    for pair in prices.windows(2) {
        let [before, after] = pair else { continue };
        let mut line = vec![after.scene.clone()];
        line.extend(COLUMNS.iter().map(|(_, number, print)| signed(number(after) - number(before), *print)));
        line.push(format!("{:.2}", after.time / before.time));
        table.line(line);
    }
    table
}

/// Cost of tangents.
pub fn tangents(prices: &[TangentPrice]) -> Table {
    let mut table = Table::default();
    table.row(["tangent of", "directions", "× CPU", "more for each direction"]);
    for TangentPrice { scene, directions, ratio } in prices {
        let each = (ratio - 1.0) / *directions as f64;
        table.row([scene.clone(), directions.to_string(), three_digits(*ratio), three_digits(each)]);
    }
    table
}

/// All numbers in SI units.
pub fn write_csv(prices: &[Price], file: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(file)?;
    csv.write_record([
        "scene",
        "degrees_of_freedom",
        "states",
        "event_functions",
        "evaluation_bare_s",
        "evaluation_all_in_s",
        "evaluations_per_s",
        "steps_per_s",
        "events_per_s",
        "cpu_s_per_s",
    ])?;
    for price in prices {
        let Price { scene, size, evaluation, evaluations, steps, events, time } = price;
        let counts = [size.degrees_of_freedom, size.states, size.event_functions].map(|count| count.to_string());
        let numbers = [*evaluation, price.all_in(), *evaluations, *steps, *events, *time].map(|x| x.to_string());
        csv.write_record(std::iter::once(scene.clone()).chain(counts).chain(numbers))?;
    }
    Ok(csv.flush()?)
}

/// Figure of the time of every scene and of its evaluations.
pub fn sheet(prices: &[Price]) -> Sheet<Bars> {
    let bar = |value: f64, role: Role, label: String| Bar { value, role, label };
    let time = prices.iter().map(|price| {
        let label = format!("{} ms", three_digits(price.time * 1e3));
        (price.scene.clone(), vec![bar(price.time * 1e3, Role::Whole, label)])
    });
    let evaluation = prices.iter().map(|price| {
        let both = [(price.evaluation, Role::Part), (price.all_in(), Role::Whole)];
        let bars = both.map(|(seconds, role)| bar(seconds * 1e9, role, format!("{} ns", grouped(seconds * 1e9))));
        (price.scene.clone(), bars.into())
    });
    Sheet {
        title: "What an effect costs: every scene is the one above it with one effect more".into(),
        legend: vec![(Role::Whole, "fmi2DoStep".into()), (Role::Part, "right-hand side alone".into())],
        panels: vec![
            Bars { label: "CPU time per simulated second [ms]".into(), rows: time.collect() },
            Bars { label: "CPU time per evaluation [ns]".into(), rows: evaluation.collect() },
        ],
        columns: 2,
        panel_size: (560, 40 * prices.len() as u32 + 70),
    }
}

fn signed(number: f64, print: fn(f64) -> String) -> String {
    match print(number.abs()) {
        zero if zero == "0" => zero,
        size if number < 0.0 => format!("−{size}"),
        size => format!("+{size}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slidercrank::simulation::Size;

    fn ladder() -> Vec<Price> {
        let price = |scene: &str, [freedoms, states, guards]: [usize; 3], [evaluation, evaluations, time]: [f64; 3]| {
            let size = Size { degrees_of_freedom: freedoms, states, event_functions: guards };
            let scene = scene.to_owned();
            Price { scene, size, evaluation, evaluations, steps: 100.0, events: evaluations / 100.0, time }
        };
        vec![
            price("ideal", [1, 2, 0], [31e-9, 2e3, 1e-3]),
            price("play", [3, 6, 1], [62e-9, 1e5, 12.5e-3]),
            price("audit", [3, 13, 1], [90e-9, 1e5, 0.25]),
        ]
    }

    #[test]
    fn the_table_tells_prices_and_increments() {
        let wanted = "  scene   degrees of freedom   states   event functions   ns/evaluation, bare   ns/evaluation, all in   evaluations/s   events/s   CPU ms/s   × real time
  ideal                    1        2                 0                    31                     500           2 000         20       1.00         1 000
  play                     3        6                 1                    62                     125         100 000      1 000       12.5          80.0
  audit                    3       13                 1                    90                   2 500         100 000      1 000        250          4.00
";
        assert_eq!(prices(&ladder()).print(), wanted);
        let wanted = "\
| scene adds | degrees of freedom | states | event functions | ns/evaluation, bare | ns/evaluation, all in | evaluations/s | events/s | CPU ms/s | × CPU |
|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|
| play | +2 | +4 | +1 | +31 | −375 | +98 000 | +980 | +11.5 | 12.50 |
| audit | 0 | +7 | 0 | +28 | +2 375 | 0 | 0 | +238 | 20.00 |
";
        assert_eq!(increments(&ladder()).markdown(), wanted);
    }

    #[test]
    fn digits_are_three_after_rounding_too() {
        assert_eq!([0.0999_96, 9.996, 99.96, 1234.5, 0.0].map(three_digits), ["0.100", "10.0", "100", "1 234", "0"]);
    }

    #[test]
    fn the_drawing_names_every_scene_and_its_time() {
        let svg = sheet(&ladder()).svg().expect("a drawing");
        for text in ["ideal", "play", "audit", "1.00 ms", "12.5 ms", "250 ms", "31 ns", "2 500 ns"] {
            assert!(svg.contains(text), "{text}");
        }
    }
}
