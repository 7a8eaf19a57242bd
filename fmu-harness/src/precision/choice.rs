//! Evaluates a diagram for the choice of a method: the coarsest run that keeps an error, the cheapest of these runs,
//! and the cost of one more digit.

use super::diagram::{Diagram, Point, Verdict};
use slidercrank::scene::Method;

/// Runs with larger errors are not used for the cost of a digit.
const ROUGH: f64 = 0.1;
/// Number of runs for fitting a line.
const NEAREST: usize = 4;
/// An error above this multiple of the reference's own error is reliable.
const CLEAR: f64 = 10.0;

/// The cost of a method at an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// [s/s]
    pub cost: f64,
    /// Whether the cost is an upper bound, since the coarsest run already has a smaller error.
    pub is_bound: bool,
}

impl Diagram {
    /// The coarsest run of the method whose error is at most `error` and for which the same holds for all finer runs,
    /// so that the error is not small by chance. Runs that were stopped do not count.
    pub fn keeping(&self, method: Method, error: f64) -> Option<&Point> {
        let points: Vec<&Point> = self.of_method(method).filter(|point| !point.is_stopped()).collect();
        let broken = points.iter().rposition(|point| !point.keeps(error));
        points.get(broken.map_or(0, |place| place + 1)).copied()
    }

    /// The cheapest such run of all methods.
    pub fn cheapest(&self, error: f64) -> Option<&Point> {
        let runs = self.methods().into_iter().filter_map(|method| self.keeping(method, error));
        runs.min_by(|a, b| cost(a).total_cmp(&cost(b)))
    }

    /// The method's cost at an error between those of its runs, on the line through the nearest runs in logarithmic
    /// scales. It compares methods between the tolerances of the series; [`Self::keeping`] gives a tolerance that keeps
    /// the error. If all runs keep the error, the cost is that of the coarsest run; if no run does, there is none.
    pub fn between(&self, method: Method, error: f64) -> Option<Price> {
        let place = |point: &Point| Some([point.error?.ln() - error.ln(), point.cost?.ln()]);
        let mut runs: Vec<[f64; 2]> = self.clear(method).filter_map(place).collect();
        if runs.iter().all(|[x, _]| *x < 0.0) {
            return runs.first().map(|[_, y]| Price { cost: y.exp(), is_bound: true });
        }
        if runs.len() < NEAREST || runs.iter().all(|[x, _]| *x > 0.0) {
            return None;
        }
        runs.sort_by(|[a, _], [b, _]| a.abs().total_cmp(&b.abs()));
        runs.truncate(NEAREST);
        let mean = |of: &dyn Fn(&[f64; 2]) -> f64| runs.iter().map(of).sum::<f64>() / NEAREST as f64;
        let [x, y] = [0, 1].map(|axis| mean(&|run| run[axis]));
        let slope = mean(&|run| (run[0] - x) * (run[1] - y)) / mean(&|run| (run[0] - x).powi(2));
        Some(Price { cost: (y - slope * x).exp(), is_bound: false })
    }

    /// The method with the lowest cost at an error between those of its runs.
    pub fn cheapest_between(&self, error: f64) -> Option<(Method, Price)> {
        let prices = self.methods().into_iter().filter_map(|method| Some((method, self.between(method, error)?)));
        prices.min_by(|(_, a), (_, b)| a.cost.total_cmp(&b.cost))
    }

    /// Factor by which the method's cost rises for one more digit: the mean from the coarsest run with an error below
    /// 0.1 to the finest run whose error is well above the reference's; `None` if these are less than one digit apart.
    pub fn digit(&self, method: Method) -> Option<f64> {
        let coarse = self.keeping(method, ROUGH)?;
        let fine = self.clear(method).last()?;
        let digits = (coarse.error? / fine.error?).log10();
        (digits >= 1.0).then(|| (cost(fine) / cost(coarse)).powf(1.0 / digits))
    }

    /// The method's runs for the cost of accuracy: neither inaccurate nor as good as the reference.
    fn clear(&self, method: Method) -> impl Iterator<Item = &Point> {
        let is_clear = |own: f64| own > CLEAR * self.floor;
        self.of_method(method).filter(move |point| point.keeps(ROUGH) && point.error.is_some_and(is_clear))
    }

    /// Numbers of runs that failed and that were stopped.
    pub fn losses(&self) -> [usize; 2] {
        let count = |lost: fn(&Point) -> bool| self.points.iter().filter(|point| lost(point)).count();
        [count(Point::has_failed), count(Point::is_stopped)]
    }
}

impl Point {
    /// Whether the run failed.
    pub fn has_failed(&self) -> bool {
        matches!(self.verdict, Verdict::Failed(_))
    }

    /// Whether the run was stopped.
    pub fn is_stopped(&self) -> bool {
        matches!(self.verdict, Verdict::Stopped(_))
    }

    fn keeps(&self, error: f64) -> bool {
        self.verdict == Verdict::Reached && self.error.is_some_and(|own| own <= error) && self.cost.is_some()
    }
}

fn cost(point: &Point) -> f64 {
    point.cost.unwrap_or(f64::INFINITY)
}
