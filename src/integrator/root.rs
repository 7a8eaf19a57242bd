//! A bracketing root finder with a bounded number of iterations.

/// Enough for any bracket in [0, 1]: the bisection steps among the iterations halve it to the last bit.
const ITERATIONS: usize = 120;

/// The point in [a, b] at which `f` falls through zero, to `resolution`. `f` must be ≥ 0 at `a` and ≤ 0 at `b`. Returns
/// the end of the last bracket that lies behind the fall. Inverse quadratic interpolation with bisection: T. R.
/// Chandrupatla, Adv. Eng. Softw. 28 (1997) 145-149.
pub fn falling(a: f64, b: f64, fa: f64, fb: f64, resolution: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    // The newest point, the other end of the bracket and the point before.
    let (mut new, mut f_new) = (b, fb);
    let (mut other, mut f_other) = (a, fa);
    let mut share = 0.5;
    for _ in 0..ITERATIONS {
        let x = new + share * (other - new);
        let fx = f(x);
        let (old, f_old);
        if (fx > 0.0) == (f_new > 0.0) {
            (old, f_old) = (new, f_new);
        } else {
            (old, f_old) = (other, f_other);
            (other, f_other) = (new, f_new);
        }
        (new, f_new) = (x, fx);
        let least = 0.5 * resolution / (other - new).abs();
        if f_new == 0.0 || least >= 0.5 {
            break;
        }
        let xi = (new - other) / (old - other);
        let phi = (f_new - f_other) / (f_old - f_other);
        let interpolates = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        share = if interpolates {
            f_new / (f_other - f_new) * f_old / (f_other - f_old)
                + (old - new) / (other - new) * f_new / (f_old - f_new) * f_other / (f_old - f_other)
        } else {
            0.5
        };
        share = share.clamp(least, 1.0 - least);
    }
    if f_new > 0.0 { other } else { new }
}

#[cfg(test)]
mod tests {
    use super::falling;

    #[test]
    fn finds_simple_and_triple_roots() {
        for root in [1e-9, 0.3, 0.999_999] {
            for power in [1, 3] {
                let f = |s: f64| (root - s).powi(power);
                let found = falling(0.0, 1.0, f(0.0), f(1.0), 1e-14, f);
                assert!((found - root).abs() <= 1e-13, "power {power}, root {root}: {found}");
            }
        }
    }

    #[test]
    fn returns_the_end_after_the_fall() {
        for root in [0.123, 0.77] {
            let f = |s: f64| 3.0 * (root - s) + (root - s).powi(3);
            assert!(f(falling(0.0, 1.0, f(0.0), f(1.0), 1e-10, f)) <= 0.0);
        }
    }

    #[test]
    fn a_jump_is_a_root() {
        let f = |s: f64| if s < 0.25 { 1.0 } else { -1e-300 };
        assert!((falling(0.0, 1.0, 1.0, -1e-300, 1e-14, f) - 0.25).abs() <= 1e-14);
    }

    #[test]
    fn a_smooth_root_takes_few_evaluations() {
        let count = std::cell::Cell::new(0);
        let f = |s: f64| {
            count.set(count.get() + 1);
            (0.7f64).sin() - s.sin()
        };
        falling(0.0, 1.0, f(0.0), f(1.0), 1e-13, f);
        assert!(count.get() <= 12, "{} evaluations", count.get());
    }
}
