//! The derivative of several functions of one number at 0, from differences whose error is estimated.
//!
//! Differences over a step that is halved time and again are extrapolated to a step of 0 (C. J. F. Ridders, Accurate
//! computation of F′(x) and F′(x)F″(x), Advances in Engineering Software 4, 1982). Long steps err by the functions'
//! curvature and short ones by rounding: of all extrapolations each function takes the one whose neighbours agree best.

/// Number of steps. Each is half of the step before.
const STEPS: usize = 30;
/// Number of terms of the error's series that are eliminated.
const ELIMINATED: usize = 6;
/// Relative rounding error of a function.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A derivative and an estimate of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The derivative.
    pub value: f64,
    /// Estimate of its error.
    pub error: f64,
    /// Largest size of the function at the ends of steps.
    pub size: f64,
}

/// Derivatives at 0 of the functions whose values `values` returns, from steps up to `longest`. If the functions do not
/// exist on one side of 0, even very near, the derivatives come from the other side alone.
///
/// # Errors
/// The error on the side of positive numbers, if the functions exist on neither side.
pub fn derivatives<E>(longest: f64, mut values: impl FnMut(f64) -> Result<Vec<f64>, E>) -> Result<Vec<Estimate>, E> {
    let shortest = longest * 0.5_f64.powi(STEPS as i32 - 1);
    let (above, below) = (values(shortest), values(-shortest));
    let sides = match (above, below) {
        (Ok(_), Ok(_)) => Sides::Both,
        (Ok(_), Err(_)) => Sides::One { sign: 1.0, here: values(0.0)? },
        (Err(_), Ok(_)) => Sides::One { sign: -1.0, here: values(0.0)? },
        (Err(refusal), Err(_)) => return Err(refusal),
    };
    let (mut tables, mut step) = (vec![], longest);
    for _ in 0..STEPS {
        // A step to where the functions do not exist is left out.
        if let Ok(ends) = sides.ends(step, &mut values) {
            tables.resize_with(ends.len(), Table::default);
            for (table, end) in tables.iter_mut().zip(ends) {
                table.add(end, step, sides.ratio());
            }
        }
        step *= 0.5;
    }
    Ok(tables.into_iter().map(|table| table.best).collect())
}

/// The sides on which the functions exist.
enum Sides {
    Both,
    One { sign: f64, here: Vec<f64> },
}

/// A difference over a step and the largest value in it.
struct Difference {
    slope: f64,
    size: f64,
}

impl Sides {
    fn ends<E>(&self, step: f64, values: &mut impl FnMut(f64) -> Result<Vec<f64>, E>) -> Result<Vec<Difference>, E> {
        let slope = |to: f64, from: f64, length: f64| Difference {
            slope: (to - from) / length,
            size: to.abs().max(from.abs()),
        };
        match self {
            Self::Both => {
                let (above, below) = (values(step)?, values(-step)?);
                Ok(above.into_iter().zip(below).map(|(above, below)| slope(above, below, 2.0 * step)).collect())
            }
            Self::One { sign, here } => {
                let there = values(sign * step)?;
                Ok(there.into_iter().zip(here).map(|(there, here)| slope(there, *here, sign * step)).collect())
            }
        }
    }

    /// Factor by which halving the step divides the error's first term, and once more each further term.
    fn ratio(&self) -> f64 {
        match self {
            Self::Both => 4.0,
            Self::One { .. } => 2.0,
        }
    }
}

/// The last line of extrapolations of one function, and the best of all.
struct Table {
    line: Vec<f64>,
    best: Estimate,
}

impl Default for Table {
    fn default() -> Self {
        Self { line: vec![], best: Estimate { value: 0.0, error: f64::INFINITY, size: 0.0 } }
    }
}

impl Table {
    fn add(&mut self, Difference { slope, size }: Difference, step: f64, ratio: f64) {
        let (mut line, mut weight) = (vec![slope], 1.0);
        for before in self.line.iter().take(ELIMINATED) {
            weight *= ratio;
            let shorter = line[line.len() - 1];
            let value = shorter + (shorter - before) / (weight - 1.0);
            let error = (value - shorter).abs().max((value - before).abs()) + ROUNDING * size / step;
            if error < self.best.error {
                self.best = Estimate { value, error, size: self.best.size };
            }
            line.push(value);
        }
        self.line = line;
        self.best.size = self.best.size.max(size);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function and its derivative at 0.
    type Case = (fn(f64) -> f64, f64);

    fn of(longest: f64, function: impl Fn(f64) -> Option<f64>) -> Estimate {
        derivatives(longest, |x| function(x).map(|value| vec![value]).ok_or(())).expect("a function there")[0]
    }

    #[test]
    fn smooth_functions_are_differentiated_to_ten_digits_and_the_estimate_holds() {
        let functions: [Case; 5] = [
            (|x| (3.0 * x + 1.0).sin(), 3.0 * 1.0_f64.cos()),
            (|x| 1.0 / (0.2 + x), -25.0),
            (|x| 1e3 + 1e-3 * x, 1e-3),
            (|x| 1e6 * x * x - 2.0 * x, -2.0),
            (|_| 7.0, 0.0),
        ];
        for (function, exact) in functions {
            let Estimate { value, error, size } = of(0.1, |x| Some(function(x)));
            // A large constant hides a small slope.
            let bound = 1e-11 * exact.abs() + 1e-15 * size / 0.1;
            assert!((value - exact).abs() <= error.max(bound), "{value} {exact} {error}");
            assert!((value - exact).abs() < 1e-10 * exact.abs() + 1e-13 * size, "{value} {exact}");
        }
    }

    #[test]
    fn one_side_is_enough_and_steps_that_lead_too_far_are_left_out() {
        let Estimate { value, .. } = of(0.1, |x| (x >= 0.0).then(|| x.exp()));
        assert!((value - 1.0).abs() < 1e-9, "{value}");
        let Estimate { value, .. } = of(0.1, |x| (x <= 0.0).then(|| x.exp()));
        assert!((value - 1.0).abs() < 1e-9, "{value}");
        let Estimate { value, .. } = of(0.1, |x| (x.abs() < 1e-3).then(|| x.exp()));
        assert!((value - 1.0).abs() < 1e-10, "{value}");
        assert_eq!(derivatives(0.1, Err::<Vec<f64>, f64>).map(drop), Err(0.1 * 0.5_f64.powi(29)));
    }

    #[test]
    fn a_kink_has_the_mean_slope_and_a_jump_none() {
        let Estimate { value, error, .. } = of(0.1, |x| Some(x.max(0.0)));
        assert!((value - 0.5).abs() < 1e-12 && error < 1e-12, "{value} {error}");
        let Estimate { value, error, .. } = of(0.1, |x| Some(f64::from(u8::from(x > 0.0))));
        assert!(error > 0.1 * value.abs(), "{value} {error}");
    }
}
