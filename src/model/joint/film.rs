//! The oil film of a lubricated journal: a short bearing.
//!
//! Reynolds' equation without pressure flow around the journal (F. W. Ocvirk, NACA TN 2808, 1952), constant viscosity
//! η, ambient pressure at both ends of the bearing, and only the positive pressure (L. Gümbel's half film) of the film
//! as it moves:
//!
//! ```text
//!             p = 6η·(−V·u)·(z² − L²/4)/h³,   h = c − e·u,   u = (cos φ, sin φ)
//!
//!     V       V = ė − ω̄·perp(e): velocity of the journal's centre, seen from axes that turn with the mean spin
//!      ^      ω̄ = (ω_journal + ω_bearing)/2
//!      |
//!   _-'''-_   p > 0 on the half circle around V: the oil there is squeezed. On the other half the film cavitates.
//!  '       '
//! ```
//!
//! With d = V/|V|, κ = e/c, a = κ·d, b = κ·perp(d), q² = 1 − a² − b², A = π/2 + atan(a/q) the pressure adds up to
//!
//! F = −(η·R·L³/c³)·|V|·(I_c·d + I_s·perp(d)) on the journal, −F on the bearing,
//!
//! I_c = 3a/q⁴ + A·(q² + 3a²)/q⁵, I_s = b·(2/q⁴ + a²/(q⁴·(q² + a²)) + 3A·a/q⁵):
//! the integrals of cos²ψ/H³ and sin ψ·cos ψ/H³, H = 1 − a·cos ψ − b·sin ψ, over −π/2 … π/2. It is the vector form of
//! J. F. Booker's mobility (J. Basic Eng. 87, 1965, 537) and of the impedance of D. Childs, H. Moes and H. van Leeuwen
//! (J. Lubr. Technol. 99, 1977, 198). Both sums cancel where the journal leaves the wall; there
//! they are expanded in powers of q/|a|.
//!
//! Shear acts on the whole circle: M_journal = −T − ½·e×F, M_bearing = T − ½·e×F about the centres, T =
//! 2π·η·R³·L·(ω_journal − ω_bearing)/(c·q). The power lost is −F·V + T·(ω_journal − ω_bearing).
//!
//! Surfaces are rough: with σ the height of both, dry contact begins where the thinnest film h = c − ε is 3σ, and below
//! 5σ the film's resistance is that of a thicker film h_e, which comes to rest at 4σ: the asperities begin to carry
//! where the film stops to thin. Dry contact and film act side by side.

use super::journal::{JournalMotion, Load};
use crate::math::{self, Real};
use crate::model::plane::{Vec2, cross, perp};
use crate::scene::{self, Lubrication};
use std::f64::consts::PI;

/// Film thickness in heights of the roughness below which the resistance grows more slowly.
const THIN: f64 = 5.0;
/// Thickness at which dry contact begins.
const TOUCH: f64 = 3.0;
/// Thickness of the film whose resistance remains in contact.
const LEAST: f64 = 4.0;

/// Value of q/|a| below which a film that is being stretched is expanded.
const SMALL: f64 = 0.6;
/// Number of terms of the expansion: the next one is below a rounding.
const TERMS: usize = 38;
/// Coefficients of (−q²/a²)^j in |a|³·I_c and a⁴·I_s/b.
const SERIES: [[f64; TERMS]; 2] = {
    let mut series = [[0.0; TERMS]; 2];
    let mut j = 0;
    while j < TERMS {
        let k = j as f64 + 2.0;
        series[0][j] = 4.0 * (k - 1.0) / (4.0 * k * k - 1.0);
        series[1][j] = (2.0 * k - 2.0) / (2.0 * k + 1.0);
        j += 1;
    }
    series
};

/// The oil film of one joint.
#[derive(Clone, Copy, Debug)]
pub struct Film {
    /// [m] c: radial clearance.
    clearance: f64,
    /// [m] σ: composite height of the roughness.
    roughness: f64,
    /// [N·s/m] η·R·L³/c³.
    squeeze: f64,
    /// [N·m·s] 2π·η·R³·L/c.
    shear: f64,
}

/// What a film exerts.
#[derive(Clone, Copy, Debug)]
struct Response<R> {
    /// [N] F, on the journal.
    force: Vec2<R>,
    /// [m/s] V.
    velocity: Vec2<R>,
    /// [N·m] T.
    torque: R,
}

impl Film {
    /// The film of a scene's joint; `None` if the joint is dry.
    pub fn new(joint: &scene::Revolute) -> Option<Self> {
        let (viscosity, radius, length, c) = (joint.viscosity, joint.radius, joint.contact.width, joint.clearance);
        (joint.lubrication != Lubrication::None && viscosity > 0.0).then(|| Self {
            clearance: c,
            roughness: joint.roughness,
            squeeze: viscosity * radius * (length / c) * (length / c) * (length / c),
            shear: 2.0 * PI * viscosity * radius * radius * radius * length / c,
        })
    }

    /// [m] The eccentricity at which the surfaces of a scene's joint touch: the clearance, less the roughness of
    /// lubricated surfaces.
    pub fn free_eccentricity(joint: &scene::Revolute) -> f64 {
        match joint.lubrication {
            Lubrication::None => joint.clearance,
            Lubrication::ShortBearing => joint.clearance - TOUCH * joint.roughness,
        }
    }

    /// The film's load on both bodies.
    #[inline(never)]
    pub fn load<R: Real>(&self, journal: &JournalMotion<R>) -> Load<R> {
        let Response { force, torque, .. } = self.response(journal);
        let half = cross(journal.eccentricity, force) * -0.5;
        Load { force, journal_couple: half - torque, bearing_couple: half + torque, ..Load::default() }
    }

    /// [W] Power lost in the film.
    pub fn loss<R: Real>(&self, journal: &JournalMotion<R>) -> R {
        let Response { force, velocity, torque } = self.response(journal);
        torque * (journal.journal_speed - journal.bearing_speed) - force.dot(velocity)
    }

    /// [m] Thickness of the film less 5σ: at 0 the curvature of the resistance over the thickness jumps.
    pub fn discontinuity(&self, journal: &JournalMotion) -> f64 {
        self.clearance - journal.eccentricity.norm() - THIN * self.roughness
    }

    fn response<R: Real>(&self, journal: &JournalMotion<R>) -> Response<R> {
        let Self { clearance: c, roughness, squeeze, shear } = *self;
        let JournalMotion { eccentricity: e, journal_speed, bearing_speed, .. } = *journal;
        let velocity = squeeze_velocity(journal);

        // The thickness that decides on the resistance, and the eccentricity that belongs to it.
        let eccentricity = e.norm_squared().max(f64::MIN_POSITIVE).sqrt();
        let thickness = -eccentricity + c;
        let thin = || {
            let over = (thickness - TOUCH * roughness).max(0.0);
            over * over / (LEAST * roughness) + LEAST * roughness
        };
        let wet = (thickness - THIN * roughness).choose(|| thickness, thin);
        let per_length =
            (thickness - THIN * roughness).choose(|| R::constant(1.0 / c), || (-wet + c) / (eccentricity * c));
        let gap = wet / c;
        let square = gap * (-gap + 2.0);
        let q = square.sqrt();

        let speed = velocity.norm_squared().max(f64::MIN_POSITIVE).sqrt();
        let direction = speed.recip() * velocity;
        let (a, b) = (per_length * e.dot(direction), per_length * e.dot(perp(direction)));
        let [along, across] = integrals(a, b, square, q);
        let force = (along * velocity + across * perp(velocity)) * -squeeze;
        Response { force, velocity, torque: (journal_speed - bearing_speed) * shear / q }
    }
}

/// [m/s] V: velocity of a journal's centre, seen from axes that turn with the mean spin.
#[inline(always)]
pub fn squeeze_velocity<R: Real>(journal: &JournalMotion<R>) -> Vec2<R> {
    let JournalMotion { eccentricity, rate, journal_speed, bearing_speed } = *journal;
    rate - (journal_speed + bearing_speed) * 0.5 * perp(eccentricity)
}

/// I_c and I_s, where `square` is q² = 1 − a² − b² > 0 and `q` its root.
#[inline(always)]
fn integrals<R: Real>(a: R, b: R, square: R, q: R) -> [R; 2] {
    let stretched = a * -SMALL - q;
    let per_square = square.recip();
    let per_fourth = per_square * per_square;
    let angle = math::atan2(q, -a);
    let per_fifth = angle * per_fourth / q;
    let ratio = -square / (a * a);
    let series = |number: usize| SERIES[number].iter().rev().fold(R::ZERO, |sum, term| sum * ratio + *term);
    [
        stretched.choose(|| -series(0) / (a * a * a), || a * per_fourth * 3.0 + per_fifth * (square + a * a * 3.0)),
        stretched.choose(
            || b * series(1) / (a * a * a * a),
            || b * (per_fourth * 2.0 + a * a * per_fourth / (square + a * a) + per_fifth * a * 3.0),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, wanted: f64, tolerance: f64, what: &str) {
        assert!((found - wanted).abs() <= tolerance * wanted.abs(), "{what}: {found:e}, not {wanted:e}");
    }

    /// The integrals over the half circle by the midpoint rule, after a substitution whose weight vanishes twice at both
    /// ends.
    fn quadrature(a: f64, b: f64) -> [f64; 2] {
        let (mut sums, steps) = ([0.0; 2], 4000);
        for i in 0..steps {
            let x = -1.0 + (2.0 * f64::from(i) + 1.0) / f64::from(steps);
            let psi = 0.5 * PI * (1.875 * x - 1.25 * x.powi(3) + 0.375 * x.powi(5));
            let weight = 0.5 * PI * (1.875 - 3.75 * x * x + 1.875 * x.powi(4)) * 2.0 / f64::from(steps);
            let (sin, cos) = psi.sin_cos();
            let h = 1.0 - a * cos - b * sin;
            sums[0] += weight * cos * cos / h.powi(3);
            sums[1] += weight * sin * cos / h.powi(3);
        }
        sums
    }

    fn of(a: f64, b: f64) -> [f64; 2] {
        let square = 1.0 - a * a - b * b;
        integrals(a, b, square, square.sqrt())
    }

    #[test]
    fn the_integrals_are_those_of_the_positive_pressure() {
        for (a, b, along, across) in [
            (0.5, 0.3, 11.9003604413, 4.265604863777),
            (-0.5, 0.3, 0.6168959069538, 0.270735816462),
            (-0.9, 0.2, 0.3154812532321, 0.09546774803151),
            (0.8, 0.0, 91.76502986286, 0.0),
            (0.0, 0.8, 7.272205216643, 12.34567901235),
            (-0.8, 0.0, 0.3495695479512, 0.0),
        ] {
            let [found_along, found_across] = of(a, b);
            near(found_along, along, 1e-12, "I_c");
            near(found_across, across, 1e-12, "I_s");
        }
        for a in [-0.95, -0.7, -0.52, -0.5, -0.3, -0.1, 0.0, 0.2, 0.6, 0.8] {
            for b in [-0.5, -0.2, 0.1, 0.55] {
                if a * a + b * b < 0.97 {
                    let ([along, across], [found_along, found_across]) = (quadrature(a, b), of(a, b));
                    near(found_along, along, 1e-11, "I_c");
                    near(found_across, across, 1e-11, "I_s");
                }
            }
        }
    }

    #[test]
    fn expansion_and_closed_form_meet() {
        // q/|a| = 0.6 at b = 0 where a² = 1/1.36.
        let a: f64 = -(1.0f64 / 1.36).sqrt();
        for b in [0.0, 0.1, -0.2] {
            let [below, above] = [of(a - 1e-9, b), of(a + 1e-9, b)];
            near(below[0], above[0], 1e-7, "I_c");
            near(below[1], above[1], 1e-7, "I_s");
        }
    }
}
