//! Three bodies with nine coordinates, (X, Y, θ) of each centre of mass, and points fixed on them.

use nalgebra::{SMatrix, SVector, Vector2};
use slidercrank::scene::{Point, Scene};

pub const CRANK: usize = 0;
pub const ROD: usize = 1;
pub const SLIDER: usize = 2;
const GROUND: usize = 3;

/// One number per coordinate.
pub type Nine = SVector<f64, 9>;
pub type Vector = Vector2<f64>;

/// v turned by +90°: (−v_y, v_x).
pub fn perp(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// The planar cross product a_x·b_y − a_y·b_x.
pub fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Coordinates and velocities of the three bodies.
#[derive(Clone, Copy)]
pub struct Motion {
    pub q: Nine,
    pub v: Nine,
}

impl Motion {
    pub fn centre_of_mass(&self, body: usize) -> Vector {
        Vector::new(self.q[3 * body], self.q[3 * body + 1])
    }

    pub fn angle(&self, body: usize) -> f64 {
        self.q[3 * body + 2]
    }

    /// [rad/s] Rate of turn; the ground's is 0.
    pub fn spin(&self, body: usize) -> f64 {
        if body == GROUND { 0.0 } else { self.v[3 * body + 2] }
    }
}

/// A point that moves with a body.
#[derive(Clone, Copy)]
pub struct Mark {
    pub body: usize,
    /// [m] From the centre of mass in body axes; on the ground, from the origin.
    arm: Vector,
}

impl Mark {
    /// [m] From the centre of mass, in inertial axes.
    pub fn lever(&self, motion: &Motion) -> Vector {
        if self.body == GROUND {
            return self.arm;
        }
        let (sin, cos) = motion.angle(self.body).sin_cos();
        self.arm.x * Vector::new(cos, sin) + self.arm.y * Vector::new(-sin, cos)
    }

    pub fn position(&self, motion: &Motion) -> Vector {
        if self.body == GROUND {
            return self.arm;
        }
        motion.centre_of_mass(self.body) + self.lever(motion)
    }

    pub fn velocity(&self, motion: &Motion) -> Vector {
        material_velocity(motion, self.body, self.position(motion))
    }

    /// Derivative of the position with respect to the nine coordinates.
    pub fn jacobian(&self, motion: &Motion) -> SMatrix<f64, 2, 9> {
        let mut jacobian = SMatrix::zeros();
        if self.body != GROUND {
            let column = 3 * self.body;
            let turn = perp(self.lever(motion));
            jacobian[(0, column)] = 1.0;
            jacobian[(1, column + 1)] = 1.0;
            jacobian[(0, column + 2)] = turn.x;
            jacobian[(1, column + 2)] = turn.y;
        }
        jacobian
    }

    /// [m/s²] The part of the acceleration that remains when all q̈ are 0: −ω²·lever.
    pub fn centripetal(&self, motion: &Motion) -> Vector {
        -motion.spin(self.body).powi(2) * self.lever(motion)
    }
}

/// Velocity of a body's material at an inertial point.
pub fn material_velocity(motion: &Motion, body: usize, point: Vector) -> Vector {
    if body == GROUND {
        return Vector::zeros();
    }
    let centre = Vector::new(motion.v[3 * body], motion.v[3 * body + 1]);
    centre + motion.spin(body) * perp(point - motion.centre_of_mass(body))
}

/// Generalized force of an inertial force on a body at an inertial point; none on the ground.
pub fn push(motion: &Motion, body: usize, point: Vector, force: Vector) -> Nine {
    let mut loads = Nine::zeros();
    if body != GROUND {
        loads[3 * body] = force.x;
        loads[3 * body + 1] = force.y;
        loads[3 * body + 2] = cross(point - motion.centre_of_mass(body), force);
    }
    loads
}

/// Generalized force of a couple on a body; none on the ground.
pub fn twist(body: usize, couple: f64) -> Nine {
    let mut loads = Nine::zeros();
    if body != GROUND {
        loads[3 * body + 2] = couple;
    }
    loads
}

/// Masses and the points where the bodies meet.
pub struct Bodies {
    /// Diagonal of the mass matrix.
    pub inertia: Nine,
    /// Bearing centres of A, B, C.
    pub bearings: [Mark; 3],
    /// Journal centres of A, B, C.
    pub journals: [Mark; 3],
    /// Centre of the slider's rectangle.
    pub centre: Mark,
    /// (+a, +b), (−a, +b), (+a, −b), (−a, −b): upper ones first.
    pub corners: [Mark; 4],
}

impl Bodies {
    pub fn new(scene: &Scene) -> Self {
        let (crank, rod, slider) = (&scene.crank, &scene.rod, &scene.slider);
        let mark = |body, com: Point, x: f64, y: f64| Mark { body, arm: Vector::new(x - com.x, y - com.y) };
        let on_slider = |x, y| mark(SLIDER, slider.com, slider.centre.x + x, slider.centre.y + y);
        let (a, b) = (slider.length / 2.0, slider.height / 2.0);
        Self {
            inertia: Nine::from_row_slice(&[
                crank.mass,
                crank.mass,
                crank.inertia,
                rod.mass,
                rod.mass,
                rod.inertia,
                slider.mass,
                slider.mass,
                slider.inertia,
            ]),
            bearings: [
                Mark { body: GROUND, arm: Vector::zeros() },
                mark(ROD, rod.com, 0.0, 0.0),
                mark(ROD, rod.com, rod.length, 0.0),
            ],
            journals: [
                mark(CRANK, crank.com, 0.0, 0.0),
                mark(CRANK, crank.com, crank.length, 0.0),
                mark(SLIDER, slider.com, 0.0, 0.0),
            ],
            centre: on_slider(0.0, 0.0),
            corners: [on_slider(a, b), on_slider(-a, b), on_slider(a, -b), on_slider(-a, -b)],
        }
    }
}
