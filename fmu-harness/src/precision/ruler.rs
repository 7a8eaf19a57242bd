//! Measures the error of a run: E = max over the grid of |Δposition|/c.
//!
//! Positions are the centre of the slider's pin and the eccentricity of every joint with clearance (both as vectors),
//! the angles of crank, rod and slider times the length of the body, and the rod's deflection and stretch. c is the
//! smallest clearance of the scene or, if there is none, the crank's length.

use crate::trajectory::Trajectory;
use anyhow::{Result, ensure};
use slidercrank::scene::{JointModel, Scene};

/// A time counts as that of a grid point if it differs by less than this share of the grid's step.
const SAME: f64 = 1e-3;

/// Measures runs of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Ruler {
    /// [m] Length c.
    pub clearance: f64,
    /// Names of the outputs of each position, with a factor: 1, or a length [m] for an angle.
    positions: Vec<(Vec<String>, f64)>,
}

impl Ruler {
    /// A ruler for runs of this scene.
    pub fn of(scene: &Scene) -> Self {
        let Scene { crank, rod, slider, joint, .. } = scene;
        let mut clearance = f64::INFINITY;
        let mut positions: Vec<(Vec<String>, f64)> = vec![
            (vec!["slider.x".into(), "slider.y".into()], 1.0),
            (vec!["crank.angle".into()], crank.length),
            (vec!["rod.angle".into()], rod.length),
            (vec!["slider.angle".into()], slider.length),
            (vec!["rod.deflection".into()], 1.0),
            (vec!["rod.stretch".into()], 1.0),
        ];
        for (name, joint) in [("A", &joint.a), ("B", &joint.b), ("C", &joint.c)] {
            if joint.model == JointModel::Clearance {
                clearance = clearance.min(joint.clearance);
                positions.push((["x", "y"].map(|axis| format!("joint.{name}.eccentricity.{axis}")).into(), 1.0));
            }
        }
        if joint.t.model == JointModel::Clearance {
            clearance = clearance.min(joint.t.clearance);
        }
        let clearance = if clearance.is_finite() { clearance } else { crank.length };
        Self { clearance, positions }
    }

    /// Names of the outputs that it compares.
    pub fn outputs(&self) -> Vec<&str> {
        self.positions.iter().flat_map(|(names, _)| names.iter().map(String::as_str)).collect()
    }

    /// Time [s] and E at every point of `run` that is on the grid of `reference`; E is infinite if a number of `run` is
    /// NaN.
    pub fn errors(&self, run: &Trajectory, reference: &Trajectory) -> Result<Vec<(f64, f64)>> {
        let pairs = common(run.times(), reference.times());
        ensure!(!pairs.is_empty(), "no communication point of the run is on the reference's grid");
        let mut errors: Vec<(f64, f64)> = pairs.iter().map(|(row, _)| (run.times()[*row], 0.0)).collect();
        for (names, lever) in &self.positions {
            let columns = |own: &'_ Trajectory| -> Result<Vec<Vec<f64>>> {
                names.iter().map(|name| Ok(own.column(name)?.to_vec())).collect()
            };
            let (ours, theirs) = (columns(run)?, columns(reference)?);
            for ((_, error), (row, grid)) in errors.iter_mut().zip(&pairs) {
                let square: f64 = ours.iter().zip(&theirs).map(|(a, b)| (a[*row] - b[*grid]).powi(2)).sum();
                let share = square.sqrt() * lever / self.clearance;
                *error = if share.is_nan() { f64::INFINITY } else { error.max(share) };
            }
        }
        Ok(errors)
    }

    /// Largest E up to `window` [s].
    pub fn error(&self, run: &Trajectory, reference: &Trajectory, window: f64) -> Result<f64> {
        let errors = self.errors(run, reference)?;
        let within = errors.iter().filter(|(time, _)| *time <= window * (1.0 + SAME));
        Ok(within.map(|(_, error)| *error).fold(0.0, f64::max))
    }
}

/// Numbers of the rows of both trajectories at the same times.
fn common(times: &[f64], grid: &[f64]) -> Vec<(usize, usize)> {
    let step = match grid {
        [first, second, ..] => second - first,
        _ => return vec![],
    };
    let on_grid = |(row, time): (usize, &f64)| {
        let place = ((time - grid[0]) / step).round();
        let there = grid.get(place as usize)?;
        (place >= 0.0 && (there - time).abs() <= SAME * step).then_some((row, place as usize))
    };
    times.iter().enumerate().filter_map(on_grid).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use slidercrank::scene::Scene;

    const NAMES: [&str; 10] = [
        "slider.x",
        "slider.y",
        "slider.angle",
        "crank.angle",
        "rod.angle",
        "rod.deflection",
        "rod.stretch",
        "joint.A.eccentricity.x",
        "joint.C.eccentricity.x",
        "joint.C.eccentricity.y",
    ];

    /// Rows at multiples of `step`; `value(name, time)`.
    fn trajectory(step: f64, rows: usize, value: impl Fn(&str, f64) -> f64) -> Trajectory {
        let mut trajectory = Trajectory::new(NAMES.map(str::to_owned));
        for row in 0..rows {
            let time = row as f64 * step;
            trajectory.push(time, &NAMES.map(|name| value(name, time)));
        }
        trajectory
    }

    fn worn_pin() -> Ruler {
        let mut scene = Scene::default();
        (scene.crank.length, scene.rod.length) = (0.05, 0.2);
        scene.joint.c.model = JointModel::Clearance;
        scene.joint.c.clearance = 1e-3;
        Ruler::of(&scene)
    }

    fn error_of(name: &'static str, error: f64) -> f64 {
        let truth = trajectory(1e-5, 11, |_, time| time);
        let run = trajectory(1e-5, 11, |own, time| if own == name { time + error } else { time });
        worn_pin().error(&run, &truth, 1.0).expect("the same columns")
    }

    #[test]
    fn positions_count_over_the_clearance_and_angles_times_their_length() {
        for (name, error, wanted) in [
            ("slider.x", 1e-6, 1e-3),
            ("crank.angle", 1e-6, 0.05e-3),
            ("rod.angle", 1e-6, 0.2e-3),
            ("rod.stretch", -1e-6, 1e-3),
            ("joint.C.eccentricity.y", 1e-6, 1e-3),
            ("joint.A.eccentricity.x", 1e-6, 0.0), // ideal: not compared
        ] {
            let found = error_of(name, error);
            assert!((found - wanted).abs() <= 1e-9 * wanted.max(1e-6), "{name}: {found}");
        }
        assert_eq!(error_of("slider.x", f64::NAN), f64::INFINITY);
    }

    #[test]
    fn the_error_is_the_largest_on_the_common_grid_and_in_the_window() {
        let truth = trajectory(1e-5, 101, |_, time| time);
        let late = |own: &str, time: f64| time + if own == "slider.x" { time.powi(2) } else { 0.0 };
        let run = trajectory(1e-4, 11, late);
        let error = |window: f64| worn_pin().error(&run, &truth, window).expect("the same columns");
        assert!((error(1e-3) - 1e-3).abs() < 1e-12 && (error(5e-4) - 2.5e-4).abs() < 1e-12);
        let between = trajectory(1.5e-5, 3, |_, time| time);
        let errors = worn_pin().errors(&between, &truth).expect("common points");
        assert_eq!(errors.len(), 2, "0 and 30 µs are on the grid, 15 µs is not");
        assert!(worn_pin().errors(&trajectory(1e-4, 1, late), &Trajectory::new([])).is_err());
    }

    #[test]
    fn the_smallest_clearance_is_the_measure_and_the_crank_where_there_is_none() {
        let mut scene = Scene::default();
        scene.crank.length = 0.07;
        assert_eq!(Ruler::of(&scene).clearance, 0.07);
        scene.joint.a.model = JointModel::Clearance;
        scene.joint.a.clearance = 2e-4;
        scene.joint.t.model = JointModel::Clearance;
        scene.joint.t.clearance = 1e-4;
        assert_eq!(Ruler::of(&scene).clearance, 1e-4);
    }
}
