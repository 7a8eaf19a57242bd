//! Numbers with derivatives, against closed forms.

use slidercrank::math::{self, Dual, Real, Vec2};

type D = Dual<2>;

/// x and y with unit derivatives along the two directions.
fn variables(x: f64, y: f64) -> (D, D) {
    (D::variable(x, 0), D::variable(y, 1))
}

fn near(found: D, value: f64, slope: [f64; 2]) {
    let close = |a: f64, b: f64| (a - b).abs() <= 4e-15 * (1.0 + b.abs());
    assert!(close(found.value, value), "{found:?} is not {value}");
    assert!(close(found.slope[0], slope[0]) && close(found.slope[1], slope[1]), "{found:?} does not have {slope:?}");
}

#[test]
fn arithmetic_has_the_derivatives_of_the_textbook() {
    for (a, b) in [(0.7, -1.3), (-2.0, 0.4), (3.5, 5.0)] {
        let (x, y) = variables(a, b);
        near(x + y, a + b, [1.0, 1.0]);
        near(x - y, a - b, [1.0, -1.0]);
        near(x * y, a * b, [b, a]);
        near(x / y, a / b, [1.0 / b, -a / (b * b)]);
        near(-x, -a, [-1.0, 0.0]);
        near(x * 3.0 + 2.0, 3.0 * a + 2.0, [3.0, 0.0]);
        near(y / 4.0 - 1.0, b / 4.0 - 1.0, [0.0, 0.25]);
        near(y.recip(), 1.0 / b, [0.0, -1.0 / (b * b)]);
        let mut sum = x;
        sum += y;
        sum -= x * y;
        near(sum, a + b - a * b, [1.0 - b, 1.0 - a]);
        near(D::constant(a) * y, a * b, [0.0, a]);
    }
}

#[test]
fn elementary_functions_have_the_derivatives_of_the_textbook() {
    for a in [0.2_f64, 0.9, 2.5] {
        let (x, y) = variables(a, 1.5);
        let (sin, cos) = math::sin_cos(x);
        near(sin, a.sin(), [a.cos(), 0.0]);
        near(cos, a.cos(), [-a.sin(), 0.0]);
        near(math::exp(x), a.exp(), [a.exp(), 0.0]);
        near(math::tanh(x), a.tanh(), [1.0 / a.cosh().powi(2), 0.0]);
        near(math::asinh(x), a.asinh(), [1.0 / (1.0 + a * a).sqrt(), 0.0]);
        near(math::powf(x, 2.3), a.powf(2.3), [2.3 * a.powf(1.3), 0.0]);
        near(x.sqrt(), a.sqrt(), [0.5 / a.sqrt(), 0.0]);
        let square = a * a + 1.5 * 1.5;
        near(math::atan2(y, x), 1.5_f64.atan2(a), [-1.5 / square, a / square]);
        near(Vec2::new(x, y).norm(), square.sqrt(), [a / square.sqrt(), 1.5 / square.sqrt()]);
    }
}

#[test]
fn corners_have_the_derivative_of_the_branch_that_the_value_takes() {
    for a in [-1.5, -0.25, 0.25, 1.5] {
        let (x, sign) = variables(a, -2.0);
        near(x.abs(), f64::abs(a), [f64::signum(a), 0.0]);
        near(Real::max(x, 0.5), f64::max(a, 0.5), [f64::from(a > 0.5), 0.0]);
        near(Real::min(x, 0.5), f64::min(a, 0.5), [f64::from(a < 0.5), 0.0]);
        near(Real::clamp(x, -0.5, 0.5), a.clamp(-0.5, 0.5), [f64::from(a.abs() < 0.5), 0.0]);
        near(x.copysign(sign), -f64::abs(a), [-f64::signum(a), 0.0]);
        assert!((x > 0.0) == (a > 0.0) && (x < D::ONE) == (a < 1.0));
    }
}

#[test]
fn derivatives_are_finite_where_functions_have_none() {
    let (x, y) = variables(0.0, 0.0);
    near(x.sqrt(), 0.0, [0.0; 2]);
    near(Vec2::new(x, y).norm(), 0.0, [0.0; 2]);
    near(math::powf(x, 1.5), 0.0, [0.0; 2]);
    near(math::powf(x, 1.0), 0.0, [1.0, 0.0]);
    near(x.abs(), 0.0, [1.0, 0.0]);
}

#[test]
fn values_have_the_bits_of_plain_numbers() {
    // Something long, in any number.
    fn chain<R: Real>(x: R, y: R) -> R {
        let mut sum = R::ZERO;
        let (mut a, mut b) = (x, y);
        for _ in 0..50 {
            let (sin, cos) = math::sin_cos(a * 3.0 + b);
            sum += math::tanh(sin / (cos * cos + 0.3)) - math::exp(-(a * a)) * b.abs().sqrt();
            (a, b) = (sum.recip() + sin, math::atan2(b, cos.abs() + 0.1).clamp(-1.0, 1.2));
        }
        sum
    }
    for i in 0..100 {
        let (a, b) = (f64::from(i) * 0.037 - 1.0, 2.0 - f64::from(i) * 0.021);
        let (x, y) = variables(a, b);
        assert_eq!(chain(x, y).value.to_bits(), chain(a, b).to_bits());
    }
}
