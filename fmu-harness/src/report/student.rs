//! Student's t: the quantile by which a confidence interval of a mean of few values is wider than that of many.

use crate::sweep::linear::NORMAL;

/// Quantile of Student's t at 97.5 % with so many degrees of freedom; with fewer than 1 it is NaN.
///
/// With 1 and 2 it is in closed form, with 3 and more the expansion of Abramowitz and Stegun, 26.7.5, which is low by 0.12 %
/// with 3 and by less with more.
pub fn student(freedom: f64) -> f64 {
    const SHARE: f64 = 0.95;
    if freedom < 1.0 {
        return f64::NAN;
    }
    if freedom < 2.0 {
        return (SHARE * std::f64::consts::FRAC_PI_2).tan();
    }
    if freedom < 3.0 {
        return SHARE * (2.0 / (1.0 - SHARE * SHARE)).sqrt();
    }
    let x = NORMAL;
    let terms = [
        x,
        (x.powi(3) + x) / 4.0,
        (5.0 * x.powi(5) + 16.0 * x.powi(3) + 3.0 * x) / 96.0,
        (3.0 * x.powi(7) + 19.0 * x.powi(5) + 17.0 * x.powi(3) - 15.0 * x) / 384.0,
        (79.0 * x.powi(9) + 776.0 * x.powi(7) + 1482.0 * x.powi(5) - 1920.0 * x.powi(3) - 945.0 * x) / 92160.0,
    ];
    terms.iter().rev().fold(0.0, |sum, term| sum / freedom + term)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        let known = [
            (1.0, 12.7062),
            (2.0, 4.3027),
            (3.0, 3.1824),
            (4.0, 2.7764),
            (9.0, 2.2622),
            (29.0, 2.0452),
            (199.0, 1.97196),
            (1e7, NORMAL),
        ];
        for (freedom, known) in known {
            let error = student(freedom) / known - 1.0;
            let bound = if freedom == 3.0 { 1.3e-3 } else { 3e-4 };
            assert!(error.abs() < bound, "{freedom}: {error:e}");
        }
        assert!(student(0.0).is_nan());
    }
}
