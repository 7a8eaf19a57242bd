//! What a diagram says to one who must choose: a method's coarsest run that keeps an error, the cheapest of these, and
//! what one more digit costs.

use super::diagram::{Diagram, Point, Verdict};
use slidercrank::scene::Method;

/// Above this error a run says little about the price of a digit.
const ROUGH: f64 = 0.1;
/// Runs that a line is drawn through.
const NEAREST: usize = 4;
/// So many times the reference's own error is told apart from it.
const CLEAR: f64 = 10.0;

/// What a method costs at an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// [s/s]
    pub cost: f64,
    /// It costs no more, since its coarsest run has a smaller error.
    pub is_bound: bool,
}

impl Diagram {
    /// The coarsest run of the method from which on every finer one keeps to `error` too: an error that is small by
    /// chance is no choice. Runs that were stopped tell nothing.
    pub fn keeping(&self, method: Method, error: f64) -> Option<&Point> {
        let points: Vec<&Point> = self.of_method(method).filter(|point| !point.is_stopped()).collect();
        let broken = points.iter().rposition(|point| !point.keeps(error));
        points.get(broken.map_or(0, |place| place + 1)).copied()
    }

    /// The cheapest run that keeps to `error`, over all methods.
    pub fn cheapest(&self, error: f64) -> Option<&Point> {
        let runs = self.methods().into_iter().filter_map(|method| self.keeping(method, error));
        runs.min_by(|a, b| cost(a).total_cmp(&cost(b)))
    }

    /// What the method costs at an error between those of its runs: on the line through the nearest of them, both in
    /// logarithms. It tells methods apart where the rungs of a ladder are wide; a tolerance that keeps to the error is told by
    /// [`Self::keeping`]. At an error that all its runs keep to, what the coarsest costs; at one that none does, nothing.
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

    /// The method that costs least at an error between those of its runs.
    pub fn cheapest_between(&self, error: f64) -> Option<(Method, Price)> {
        let prices = self.methods().into_iter().filter_map(|method| Some((method, self.between(method, error)?)));
        prices.min_by(|(_, a), (_, b)| a.cost.total_cmp(&b.cost))
    }

    /// By what factor the method's cost rises for one more digit: the mean from the coarsest run that keeps to 0.1
    /// to the finest whose error stands clear of the reference's; `None` over less than one digit.
    pub fn digit(&self, method: Method) -> Option<f64> {
        let coarse = self.keeping(method, ROUGH)?;
        let fine = self.clear(method).last()?;
        let digits = (coarse.error? / fine.error?).log10();
        (digits >= 1.0).then(|| (cost(fine) / cost(coarse)).powf(1.0 / digits))
    }

    /// The method's runs that tell what accuracy costs: neither rough nor as good as the reference.
    fn clear(&self, method: Method) -> impl Iterator<Item = &Point> {
        let is_clear = |own: f64| own > CLEAR * self.floor;
        self.of_method(method).filter(move |point| point.keeps(ROUGH) && point.error.is_some_and(is_clear))
    }

    /// How many runs failed, and how many were stopped.
    pub fn losses(&self) -> [usize; 2] {
        let count = |lost: fn(&Point) -> bool| self.points.iter().filter(|point| lost(point)).count();
        [count(Point::has_failed), count(Point::is_stopped)]
    }
}

impl Point {
    /// Whether it gave up or lost the motion.
    pub fn has_failed(&self) -> bool {
        matches!(self.verdict, Verdict::Failed(_))
    }

    /// Whether it was too dear.
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
