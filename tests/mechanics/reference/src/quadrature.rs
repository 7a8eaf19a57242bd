//! Gauss and Legendre: n points integrate polynomials of degree 2n − 1 exactly.

use std::f64::consts::PI;

/// Points in (0, `end`) and their weights.
pub fn gauss_legendre(count: usize, end: f64) -> Vec<(f64, f64)> {
    let n = count as f64;
    let point = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        // Newton from a guess of 1e-4 is at round-off after four.
        for _ in 0..8 {
            let (value, slope) = legendre(count, x);
            x -= value / slope;
        }
        let slope = legendre(count, x).1;
        let weight = 2.0 / ((1.0 - x * x) * slope * slope);
        (end * (1.0 - x) / 2.0, end * weight / 2.0)
    };
    (0..count).map(point).collect()
}

/// P_n and its derivative.
fn legendre(count: usize, x: f64) -> (f64, f64) {
    let (mut before, mut here) = (1.0, x);
    for k in 2..=count {
        let k = k as f64;
        (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
    }
    (here, count as f64 * (x * here - before) / (x * x - 1.0))
}

#[test]
fn ten_points_are_exact_on_degree_nineteen() {
    let sum: f64 = gauss_legendre(10, 2.0).into_iter().map(|(x, weight)| weight * x.powi(19)).sum();
    let exact = 2.0_f64.powi(20) / 20.0;
    // Ten terms, each within some units of round-off.
    assert!((sum / exact - 1.0).abs() < 100.0 * f64::EPSILON);
}
