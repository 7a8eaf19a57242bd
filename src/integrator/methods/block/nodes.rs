//! Nodes of a [`block`](super) and the tables of the polynomials through the accelerations at the nodes.

#![expect(clippy::excessive_precision, reason = "coefficients stand as printed")]

use crate::math::{F64x8, ROW, Real};

/// Nodes c₁ … c₈ of a step, as shares of its length: those of Radau's right quadrature, which include 1.
pub const NODES: [f64; ROW] = [
    0.022_479_386_438_712_498_108_825_5,
    0.114_679_053_160_904_231_909_640_2,
    0.265_789_822_784_589_468_476_789_4,
    0.452_846_373_669_444_616_998_551_4,
    0.647_375_282_886_830_362_626_092_2,
    0.819_759_308_263_107_635_012_420_1,
    0.943_737_439_463_077_853_534_347_8,
    1.0,
];
/// Nodes and weights of Gauss quadrature on 0 to 1, exact for polynomials up to degree nine.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668_003_601_186_56, 0.118_463_442_528_094_543_757_132_0),
    (0.230_765_344_947_158_454_481_842_8, 0.239_314_335_249_683_234_020_645_8),
    (0.5, 0.284_444_444_444_444_444_444_444_4),
    (0.769_234_655_052_841_545_518_157_2, 0.239_314_335_249_683_234_020_645_8),
    (0.953_089_922_969_331_996_398_813_4, 0.118_463_442_528_094_543_757_132_0),
];
/// Number of interpolation points: the step's start, c₀ = 0, and its nodes.
pub const POINTS: usize = 1 + ROW;

const fn point(j: usize) -> f64 {
    if j == 0 { 0.0 } else { NODES[j - 1] }
}

/// Lagrange polynomial ℓ_j(x): 1 at point j, 0 at all other points.
const fn cardinal(j: usize, x: f64) -> f64 {
    let (mut product, mut k) = (1.0, 0);
    while k < POINTS {
        if k != j {
            product *= (x - point(k)) / (point(j) - point(k));
        }
        k += 1;
    }
    product
}

/// Two tables stored by columns, one for velocities and one for positions: A_ij and B_ij of [`block`](super). Column 0
/// belongs to the step's start.
pub type Tables = [[F64x8; POINTS]; 2];

/// ∫ ℓ_j dx and ∫∫ ℓ_j dx² from `start` to `start` + c_i, stored by columns j.
const fn integrals(start: f64) -> Tables {
    let mut all = [[F64x8::ZERO; POINTS]; 2];
    let mut j = 0;
    while j < POINTS {
        let (mut once, mut twice) = ([0.0; ROW], [0.0; ROW]);
        let mut i = 0;
        while i < ROW {
            let (c, mut g) = (NODES[i], 0);
            while g < GAUSS.len() {
                let (x, weight) = GAUSS[g];
                let value = weight * c * cardinal(j, start + c * x);
                once[i] += value;
                twice[i] += value * c * (1.0 - x);
                g += 1;
            }
            i += 1;
        }
        (all[0][j], all[1][j]) = (F64x8::of(once), F64x8::of(twice));
        j += 1;
    }
    all
}

/// A and B: integrals of the accelerations in a step.
pub static INTEGRALS: Tables = integrals(0.0);

/// Integrals of the polynomial of the step before over a step of the same length.
pub static EXTRAPOLATION: Tables = integrals(1.0);

/// Coefficients of x¹ … x⁸ of the polynomials ℓ_j about the step's start (0) and about its end (1), stored by columns
/// j.
pub static POWERS: [[F64x8; POINTS]; 2] = {
    let mut all = [[F64x8::ZERO; POINTS]; 2];
    let mut origin = 0;
    while origin < 2 {
        let mut j = 0;
        while j < POINTS {
            // Π (x − (c_k − origin))/(c_j − c_k), multiplied factor by factor.
            let mut coefficients = [0.0; POINTS];
            coefficients[0] = 1.0;
            let (mut degree, mut k) = (0, 0);
            while k < POINTS {
                if k != j {
                    let (root, scale) = (point(k) - origin as f64, point(j) - point(k));
                    degree += 1;
                    let mut n = degree;
                    loop {
                        let lower = if n > 0 { coefficients[n - 1] } else { 0.0 };
                        coefficients[n] = (lower - root * coefficients[n]) / scale;
                        if n == 0 {
                            break;
                        }
                        n -= 1;
                    }
                }
                k += 1;
            }
            let [_, a, b, c, d, e, f, g, h] = coefficients;
            all[origin][j] = F64x8::of([a, b, c, d, e, f, g, h]);
            j += 1;
        }
        origin += 1;
    }
    all
};

/// Integrals of the monomials xⁿ from 0 to c_i: c_i^(n+1)/(n + 1) and c_i^(n+2)/((n + 1)·(n + 2)) in column n.
pub static MONOMIALS: Tables = {
    let mut all = [[F64x8::ZERO; POINTS]; 2];
    let (mut n, mut powers) = (0, NODES);
    while n < POINTS {
        let (mut once, mut twice) = ([0.0; ROW], [0.0; ROW]);
        let mut i = 0;
        while i < ROW {
            once[i] = powers[i] / (n + 1) as f64;
            powers[i] *= NODES[i];
            twice[i] = powers[i] / ((n + 1) * (n + 2)) as f64;
            i += 1;
        }
        (all[0][n], all[1][n]) = (F64x8::of(once), F64x8::of(twice));
        n += 1;
    }
    all
};

/// What the coefficients of x¹ … x⁸ are multiplied by in an integral over 0 to 1, once and twice: 1/(n + 1) and
/// 1/((n + 1)·(n + 2)).
pub const PER_INTEGRAL: [F64x8; 2] = {
    let (mut once, mut twice, mut n) = ([0.0; ROW], [0.0; ROW], 0);
    while n < ROW {
        once[n] = 1.0 / (n + 2) as f64;
        twice[n] = once[n] / (n + 3) as f64;
        n += 1;
    }
    [F64x8::of(once), F64x8::of(twice)]
};

/// Weights that give the coefficient of degree eight of the accelerations in Legendre polynomials: that of the start,
/// and those of the nodes.
pub static TOP_DEGREE_WEIGHTS: (f64, F64x8) = {
    let mut all = [0.0; POINTS];
    let mut j = 0;
    while j < POINTS {
        let (mut product, mut k) = (12_870.0, 0);
        while k < POINTS {
            if k != j {
                product *= point(j) - point(k);
            }
            k += 1;
        }
        all[j] = 1.0 / product;
        j += 1;
    }
    let [first, a, b, c, d, e, f, g, h] = all;
    (first, F64x8::of([a, b, c, d, e, f, g, h]))
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Through the values of x^degree at the points, this sum over columns at every node.
    fn sums(columns: &[F64x8; POINTS], degree: i32, at: impl Fn(usize) -> f64) -> [f64; ROW] {
        std::array::from_fn(|i| (0..POINTS).map(|j| columns[j].numbers()[i] * at(j).powi(degree)).sum())
    }

    #[test]
    fn nodes_are_those_of_radau() {
        // ∏(c − c_j) is orthogonal to all polynomials of degree six: their quadrature is exact to degree 14.
        let last = |columns: &[F64x8; POINTS], degree| sums(columns, degree, point)[ROW - 1];
        for degree in 0..=14 {
            let n = f64::from(degree);
            assert!((last(&INTEGRALS[0], degree) - 1.0 / (n + 1.0)).abs() < 1e-15, "degree {degree}");
        }
        assert!((last(&INTEGRALS[0], 15) - 1.0 / 16.0).abs() > 1e-10);
        assert!(INTEGRALS[0][0].last().abs() < 1e-15, "the start has no weight in it");
    }

    #[test]
    fn polynomials_up_to_degree_eight_are_integrated_exactly() {
        // Sums about the next step are of terms up to a million.
        for (tables, start, bound) in [(&INTEGRALS, 0.0, 8e-16), (&EXTRAPOLATION, 1.0, 1e-9)] {
            for degree in 0..=8 {
                let [once, twice] = [0, 1].map(|times| sums(&tables[times], degree, point));
                // From the start, of x^degree: ∫ = (x^(n+1) − start^(n+1))/(n+1), and so on.
                let n = f64::from(degree);
                for (i, c) in NODES.iter().enumerate() {
                    let end = start + c;
                    let wanted_once = (end.powf(n + 1.0) - start) / (n + 1.0);
                    let wanted_twice = ((end.powf(n + 2.0) - start) / (n + 2.0) - start * c) / (n + 1.0);
                    let errors = [once[i] - wanted_once, twice[i] - wanted_twice];
                    assert!(errors.iter().all(|e| e.abs() < bound), "x^{degree} from {start} to {end}: {errors:?}");
                }
            }
        }
    }

    #[test]
    fn coefficients_about_either_end_are_those_of_the_polynomial() {
        for (origin, columns) in POWERS.iter().enumerate() {
            for degree in 0..=8 {
                let found = sums(columns, degree, |j| point(j) - origin as f64);
                for (n, found) in found.iter().enumerate() {
                    let wanted = if degree == n as i32 + 1 { 1.0 } else { 0.0 };
                    // Of terms up to a million.
                    assert!((found - wanted).abs() < 1e-9, "x^{degree} about {origin}: {found:e} of x^{}", n + 1);
                }
            }
        }
        for (n, rows) in MONOMIALS[0].iter().zip(&MONOMIALS[1]).enumerate() {
            let rows = (rows.0.numbers(), rows.1.numbers());
            for (i, c) in NODES.iter().enumerate() {
                let power = c.powi(n as i32 + 1) / (n + 1) as f64;
                assert!((rows.0[i] - power).abs() < 1e-15 && (rows.1[i] - power * c / (n + 2) as f64).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_part_of_degree_eight_is_that_of_legendre() {
        // x⁸ on 0 to 1 has 1/12870 of the polynomial, and what is lower has none.
        for degree in 0..=8 {
            let at_start = if degree == 0 { TOP_DEGREE_WEIGHTS.0 } else { 0.0 };
            let found = at_start + (TOP_DEGREE_WEIGHTS.1 * F64x8::of(NODES.map(|c| c.powi(degree)))).sum();
            let wanted = if degree == 8 { 1.0 / 12_870.0 } else { 0.0 };
            assert!((found - wanted).abs() < 1e-14, "degree {degree}: {found:e}");
        }
    }
}
