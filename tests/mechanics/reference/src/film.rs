//! The oil between a journal and its bearing: Reynolds' pressure of a short film, summed point by point where it is
//! positive, and the shear of the whole film.

use crate::coordinates::{Vector, cross, perp};
use crate::mechanism::{Lubrication, Revolute};
use crate::quadrature::gauss_legendre;
use std::f64::consts::{PI, TAU};

/// Points over the half circle. The integrand's poles keep 0.28 away from the real axis at the thinnest film of a tenth
/// of the clearance in roughness; this many points then leave 1e-15.
const POINTS: usize = 160;

/// A film.
pub struct Film {
    viscosity: f64,
    radius: f64,
    length: f64,
    clearance: f64,
    roughness: f64,
    /// Angles from the direction of V, and weights.
    arc: Vec<(f64, f64)>,
}

/// What a film does.
#[derive(Clone, Copy)]
pub struct Pressed {
    /// [N] On the journal.
    pub force: Vector,
    /// [N·m] On the journal's body about the journal's centre, and on the bearing's about the bearing's.
    pub couples: [f64; 2],
    /// [W]
    pub loss: f64,
}

/// [m] How far a journal goes before it touches.
pub fn way(joint: &Revolute) -> f64 {
    match joint.lubrication {
        Lubrication::None => joint.clearance,
        Lubrication::ShortBearing => joint.clearance - 3.0 * joint.roughness,
    }
}

impl Film {
    pub fn new(joint: &Revolute) -> Option<Self> {
        (joint.lubrication == Lubrication::ShortBearing).then(|| Self {
            viscosity: joint.viscosity,
            radius: joint.radius,
            length: joint.contact.width,
            clearance: joint.clearance,
            roughness: joint.roughness,
            arc: gauss_legendre(POINTS, PI).into_iter().map(|(x, weight)| (x - PI / 2.0, weight)).collect(),
        })
    }

    /// At an eccentricity and its rate, and the spins of journal and bearing.
    pub fn pressed(&self, e: Vector, rate: Vector, spins: [f64; 2]) -> Pressed {
        let Self { viscosity, radius, length, clearance, roughness, ref arc } = *self;
        let squeeze = rate - (spins[0] + spins[1]) / 2.0 * perp(e);
        let thickness = clearance - e.norm();
        let held = if thickness >= 5.0 * roughness {
            thickness
        } else if thickness > 3.0 * roughness {
            4.0 * roughness + (thickness - 3.0 * roughness).powi(2) / (4.0 * roughness)
        } else {
            4.0 * roughness
        };
        let place = if e.norm() > 0.0 { (clearance - held) * e / e.norm() } else { Vector::zeros() };
        // Along the bearing the pressure is a parabola, whose integral is L³/6 of its curvature's half.
        let mut force = Vector::zeros();
        let towards = squeeze.y.atan2(squeeze.x);
        for (angle, weight) in arc {
            let u = Vector::new((towards + angle).cos(), (towards + angle).sin());
            let gap = clearance - place.dot(&u);
            force -= *weight * radius * viscosity * length.powi(3) * squeeze.dot(&u) / gap.powi(3) * u;
        }
        // ∫dφ/h over the whole circle.
        let round = TAU / (clearance.powi(2) - place.norm_squared()).sqrt();
        let torque = viscosity * radius.powi(3) * length * (spins[0] - spins[1]) * round;
        let shared = -0.5 * cross(e, force);
        Pressed {
            force,
            couples: [shared - torque, shared + torque],
            loss: torque * (spins[0] - spins[1]) - force.dot(&squeeze),
        }
    }
}

#[test]
fn a_film_presses_as_the_closed_forms_say() {
    // R = 10 mm, L = 15 mm, c = 0.1 mm, η = 0.05 Pa·s, σ = 1 µm; e [µm], ė [mm/s], spins; F, moments and loss.
    let joint = Revolute {
        radius: 0.01,
        clearance: 1e-4,
        lubrication: Lubrication::ShortBearing,
        viscosity: 0.05,
        roughness: 1e-6,
        contact: crate::mechanism::Contact { width: 0.015, ..crate::Mechanism::default().joint.a.contact },
        ..crate::Mechanism::default().joint.a
    };
    let film = Film::new(&joint).expect("oil");
    for (e, rate, spins, wanted) in [
        (
            [60.0, -30.0],
            [10.0, 20.0],
            [40.0, -20.0],
            [-208.23297293, -53.474497522, 9.1521911661e-4, 8.5402399225e-3, 3.2860157135],
        ),
        (
            [60.0, -30.0],
            [-30.0, 0.0],
            [40.0, -20.0],
            [26.835121026, 13.141754084, -4.6092898408e-3, 3.0157309650e-3, 1.0497398437],
        ),
        (
            [96.0, 0.0],
            [10.0, 0.0],
            [0.0, 100.0],
            [-75245.841991, 1053.0798561, -3.4209950105e-2, -6.6885716084e-2, 759.14699152],
        ),
        (
            [98.5, 0.0],
            [10.0, 0.0],
            [0.0, 100.0],
            [-87576.964045, 1181.7081122, -4.1369163883e-2, -7.5029085171e-2, 883.27254896],
        ),
    ] {
        let Pressed { force, couples, loss } = film.pressed(1e-6 * Vector::from(e), 1e-3 * Vector::from(rate), spins);
        for (found, wanted) in [force.x, force.y, couples[0], couples[1], loss].into_iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 1e-9, "{found:e}, not {wanted:e}");
        }
    }
}
