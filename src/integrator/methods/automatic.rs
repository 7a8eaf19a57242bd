//! `verner7`, and `rodas4` where the motion is stiff; `cong8` where it is not at all, if the mechanism suits it.

use super::rodas4::Rodas;
use super::verner7::Verner7;
use crate::integrator::switching::{Pair, Switching};

/// The order-7 pair that changes to the L-stable order-4 pair in stiff motion, and to steps in blocks where they pay.
pub type Automatic = Switching<VernerRodas>;

/// Its two methods.
#[derive(Clone, Copy, Debug)]
pub struct VernerRodas;

impl Pair for VernerRodas {
    const NAME: &'static str = "automatic";
    type Loose = Verner7;
    type Stiff = Rodas;
    /// In the left half plane, |R(z)| passes 1 between |z| = 4.44 (at 110° from the positive axis) and 4.75.
    const BOUND: f64 = 4.4;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::tableau::Explicit;

    /// |R(z)|: by how much a step multiplies the solution of ẏ = λ·y, for z = hλ.
    fn growth([re, im]: [f64; 2]) -> f64 {
        let method = Verner7::TABLEAU;
        let times = |x: [f64; 2]| [re * x[0] - im * x[1], re * x[1] + im * x[0]];
        let mut k = vec![];
        let sum = |weights: &[f64], k: &[[f64; 2]]| {
            let parts = weights.iter().zip(k).fold([0.0; 2], |sum, (w, k)| [sum[0] + w * k[0], sum[1] + w * k[1]]);
            let part = times(parts);
            [1.0 + part[0], part[1]]
        };
        for row in &method.a[..method.stages] {
            k.push(sum(row, &k));
        }
        let [re, im] = sum(&method.b, &k);
        re.hypot(im)
    }

    #[test]
    fn the_explicit_method_is_stable_up_to_its_bound() {
        for degrees in (95..=180).step_by(5) {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let at = |size: f64| growth([size * cos, size * sin]);
            let within = (1..=44).map(|part| at(VernerRodas::BOUND * f64::from(part) / 44.0)).fold(0.0, f64::max);
            assert!(within <= 1.0, "{within} at {degrees}°");
            assert!(at(1.09 * VernerRodas::BOUND) > 1.0, "at {degrees}°");
        }
    }
}
