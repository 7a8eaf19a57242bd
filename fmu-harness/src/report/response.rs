//! Figure and columns of a response: simulated as a parameter goes up and down, and followed through its folds.

use super::plot::{Curve, Mark, Panel, Role, Sheet};
use super::table::Table;
use super::units::{Shown, significant};
use crate::dynamics::bifurcation::{Branch, Range};
use crate::dynamics::continuation::{Bifurcation, Branch as Orbits};
use crate::frame::{Column, Frame};
use crate::host::Description;
use slidercrank::fmi::v2::description::model_description;
use slidercrank::scene::Scene;
use slidercrank::scene::parameter::Parameter;

const UP: Role = Role::Member(0);
const DOWN: Role = Role::Member(1);
const FOLLOWED: Role = Role::Member(8);
const SPECIAL: Role = Role::Limit;

/// Two responses differ by more than this share.
const DIFFERENT: f64 = 0.01;

/// What is known of a response over a parameter.
pub struct Curves<'a> {
    /// The range.
    pub range: &'a Range,
    /// Its values, with increasing parameter and back.
    pub simulated: [&'a [Branch]; 2],
    /// Branches of periodic motions.
    pub followed: &'a [Orbits],
    /// The responses of each branch.
    pub responses: &'a [Responses],
}

/// Responses of a branch; NaN where they are not known.
#[derive(Clone, Debug, Default)]
pub struct Responses {
    /// Of its motions.
    pub motions: Vec<f64>,
    /// At its bifurcations.
    pub found: Vec<f64>,
}

/// A stretch of a branch whose motions are all stable or all unstable, up to the next motion.
struct Stretch {
    stable: bool,
    points: Vec<(f64, f64)>,
}

impl Curves<'_> {
    /// The figure.
    pub fn sheet(&self, title: &str, scene: &Scene) -> Sheet {
        let response = self.range.response.as_ref();
        let (text, name) = response.map_or(("", ""), |response| (&response.text, response.name()));
        let peak = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |peak: f64, value| peak.max(value.abs()));
        let unit = Parameter::named(&self.range.name).map_or("1", Parameter::unit);
        let of_x = Shown::of(unit, peak(&mut self.range.values.iter().copied()));
        let all = self.simulated.iter().flat_map(|branches| branches.iter().filter_map(|branch| branch.response));
        let of_y = Shown::of(
            &unit_of_output(scene, name),
            peak(&mut all.chain(self.responses.iter().flat_map(|of| of.motions.iter().copied()))),
        );
        let shown = |points: Vec<(f64, f64)>| points.iter().map(|(x, y)| (x * of_x.factor, y * of_y.factor)).collect();
        let mut curves = vec![];
        for Stretch { stable, points } in self.stretches() {
            let mark = if stable { Mark::Path } else { Mark::Dashes };
            curves.push(Curve { role: FOLLOWED, points: shown(points), mark });
        }
        for ((branches, role), mark) in self.simulated.iter().zip([UP, DOWN]).zip([Mark::Up, Mark::Down]) {
            let points = branches.iter().filter_map(|branch| Some((branch.value, branch.response?)));
            curves.push(Curve { role, points: shown(points.collect()), mark });
        }
        for (kind, point) in self.bifurcations() {
            curves.push(Curve { role: SPECIAL, points: shown(vec![point]), mark: Mark::Named(kind.name()) });
        }
        let panel = Panel { x_label: of_x.axis(&self.range.name), y_label: of_y.axis(text), curves, square: false };
        let mut legend = vec![(UP, "△ simulated, going up".into()), (DOWN, "▽ simulated, going down".into())];
        if !self.followed.is_empty() {
            legend.push((FOLLOWED, "followed; dashed: unstable".into()));
        }
        Sheet {
            title: format!("{title}: {text} over {}", self.range.name),
            legend,
            panels: vec![panel],
            columns: 1,
            panel_size: (1000, 560),
        }
    }

    fn stretches(&self) -> Vec<Stretch> {
        let mut stretches = vec![];
        for (branch, responses) in self.followed.iter().zip(self.responses) {
            let values = branch.orbits.iter().map(|orbit| orbit.value);
            let points: Vec<(f64, f64)> = values.zip(responses.motions.iter().copied()).collect();
            let mut place = 0;
            for part in branch.orbits.chunk_by(|one, other| one.is_stable() == other.is_stable()) {
                let end = (place + part.len() + 1).min(points.len());
                let known = points[place..end].iter().copied().filter(|point| point.1.is_finite());
                stretches.push(Stretch { stable: part[0].is_stable(), points: known.collect() });
                place += part.len();
            }
        }
        stretches
    }

    /// Bifurcations with parameter and response.
    fn bifurcations(&self) -> Vec<(Bifurcation, (f64, f64))> {
        let branches = self.followed.iter().zip(self.responses);
        let all = branches.flat_map(|(branch, responses)| branch.found.iter().zip(&responses.found));
        let known = all.filter(|(_, response)| response.is_finite());
        known.map(|(found, response)| (found.kind, (found.orbit.value, *response))).collect()
    }

    /// Every number as columns.
    pub fn frame(&self) -> Frame {
        let mut rows: Vec<(f64, f64, String)> = vec![];
        for (branches, way) in self.simulated.iter().zip(["up", "down"]) {
            let known = branches.iter().filter_map(|branch| Some((branch.value, branch.response?, way.into())));
            rows.extend(known);
        }
        for (branch, responses) in self.followed.iter().zip(self.responses) {
            for (orbit, response) in branch.orbits.iter().zip(&responses.motions) {
                let way = if orbit.is_stable() { "stable" } else { "unstable" };
                rows.push((orbit.value, *response, way.into()));
            }
        }
        for (kind, (value, response)) in self.bifurcations() {
            rows.push((value, response, kind.to_string()));
        }
        Frame::default()
            .reals(self.range.name.clone(), rows.iter().map(|row| row.0).collect::<Vec<_>>())
            .reals("response", rows.iter().map(|row| row.1).collect::<Vec<_>>())
            .with("motion", Column::Texts(rows.into_iter().map(|row| row.2).collect()))
    }

    /// Where the simulated response jumps, and where both ways differ.
    pub fn table(&self) -> Table {
        let mut table = Table::default();
        table.row([self.range.name.as_str(), "going up", "going down", "difference"]);
        let [up, down] = self.simulated;
        for (one, other) in up.iter().zip(down.iter().rev()) {
            if let (Some(a), Some(b)) = (one.response, other.response)
                && (a - b).abs() > DIFFERENT * a.abs().max(b.abs())
            {
                table.row([format!("{:.6e}", one.value), significant(a), significant(b), significant(a - b)]);
            }
        }
        table
    }
}

/// Unit of an output, or of the components of a vector.
fn unit_of_output(scene: &Scene, name: &str) -> String {
    let text = model_description(scene, None, None).unwrap_or_default();
    let unit = Description::parse(&text).ok().and_then(|description| {
        let names = [name.to_owned(), format!("{name}.x")];
        let variable = names.iter().find_map(|name| description.variable(name).ok())?;
        description.unit(variable).map(str::to_owned)
    });
    unit.unwrap_or_else(|| "1".into())
}
