//! A face of the slider on a bed of springs: force per length k·max(0, δ) along the face, with δ
//! linear between its corners' δ1 at +a and δ2 at −a.

use crate::laws::compliance;
use crate::mechanism::Mechanism;
use std::f64::consts::PI;

/// [m] Below this sum of penetrations, the sign of each is round-off.
const NOTHING: f64 = 1e-14;

/// A face: its half length and its stiffness per length.
#[derive(Clone, Copy)]
pub struct Face {
    /// [m] a.
    pub half: f64,
    /// [N/m²] k.
    pub stiffness: f64,
}

/// What the springs do together.
pub struct Pressure {
    /// [N]
    pub force: f64,
    /// Centre of pressure from the middle, over a: the place of the force.
    pub centre: f64,
    /// [J]
    pub energy: f64,
}

impl Face {
    pub fn new(mechanism: &Mechanism) -> Self {
        let guide = &mechanism.joint.t;
        let (length, width) = (mechanism.slider.length, guide.contact.width);
        let given = guide.foundation_stiffness;
        // The half-space under a stiff rectangle: K = √A/(m·(σ_g + σ_s)).
        let face = || (length * width).sqrt() / (shape_factor(length / width) * compliance(&guide.contact));
        Self { half: length / 2.0, stiffness: if given > 0.0 { given } else { face() / length } }
    }

    /// On the branch where the corners of `inside` are inside.
    pub fn pressure(&self, depths: [f64; 2], inside: [bool; 2]) -> Pressure {
        let (k, a, [d1, d2]) = (self.stiffness, self.half, depths);
        // One corner is in as far as the wet length: δ falls to 0 there.
        let wedge = |depth: f64, other: f64, side: f64| {
            let wet = depth / (depth - other) * 2.0 * a;
            Pressure {
                force: k * depth * wet / 2.0,
                centre: side * (1.0 - wet / (3.0 * a)),
                energy: k * depth * depth * wet / 6.0,
            }
        };
        match inside {
            [false, false] => Pressure { force: 0.0, centre: if d1 >= d2 { 1.0 } else { -1.0 }, energy: 0.0 },
            [true, false] => wedge(d1, d2, 1.0),
            [false, true] => wedge(d2, d1, -1.0),
            [true, true] => Pressure {
                force: k * a * (d1 + d2),
                centre: if (d1 + d2).abs() < NOTHING { 0.0 } else { (d1 - d2) / (d1 + d2) / 3.0 },
                energy: k * a * (d1 * d1 + d1 * d2 + d2 * d2) / 3.0,
            },
        }
    }
}

/// m(r) of a rectangle with this ratio of sides.
fn shape_factor(ratio: f64) -> f64 {
    let r = ratio.max(1.0 / ratio);
    let ends = 2.0 / 3.0 * (1.0 + r.powi(3) - (1.0 + r * r).powf(1.5));
    (2.0 * r * r.asinh() + 2.0 * r * r * (1.0 / r).asinh() + ends) / (PI * r.powf(1.5))
}

/// Against the springs one by one.
#[test]
fn a_face_sums_its_springs() {
    const SPRINGS: u32 = 200_000;
    let face = Face { half: 0.02, stiffness: 3.0 };
    for depths in [[2.0, 1.0], [1.0, 2.0], [1.0, -0.3], [-3.0, 1.0], [-1.0, -2.0]] {
        let pressure = face.pressure(depths, depths.map(|depth| depth > 0.0));
        let (mut force, mut moment, mut energy) = (0.0, 0.0, 0.0);
        for k in 0..SPRINGS {
            let place = 2.0 * (f64::from(k) + 0.5) / f64::from(SPRINGS) - 1.0;
            let depth = (depths[0] * (1.0 + place) / 2.0 + depths[1] * (1.0 - place) / 2.0).max(0.0);
            let spring = face.stiffness * 2.0 * face.half / f64::from(SPRINGS);
            force += spring * depth;
            moment += spring * depth * place;
            energy += spring * depth * depth / 2.0;
        }
        // The midpoint rule errs by (length of a spring)²/24 of the second derivative.
        assert!((pressure.force - force).abs() < 1e-10);
        assert!((pressure.force * pressure.centre - moment).abs() < 1e-10);
        assert!((pressure.energy - energy).abs() < 1e-10);
    }
}

/// Roark, Young: the shape factor of a square is 0.95.
#[test]
fn the_shape_factor_of_a_square_is_known() {
    assert!((shape_factor(1.0) - 0.95).abs() < 5e-3, "{}", shape_factor(1.0));
    assert!((shape_factor(3.0) - shape_factor(1.0 / 3.0)).abs() < 1e-15);
}
