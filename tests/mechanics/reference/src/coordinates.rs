//! Coordinates of the mechanism: (X, Y, θ) of each of the three bodies, then the rod's modes.

use nalgebra::{SMatrix, SVector, Vector2};

pub const CRANK: usize = 0;
pub const ROD: usize = 1;
pub const SLIDER: usize = 2;
pub const GROUND: usize = 3;

/// Coordinates of the bodies as wholes.
pub const RIGID: usize = 9;
/// Most modes of the rod.
pub const MODES: usize = 5;
pub const COORDINATES: usize = RIGID + MODES;
/// A, B, C, then the corners, or two faces and two places left empty.
pub const CONTACTS: usize = 7;

/// One number per coordinate; those of modes that the rod has not stay 0.
pub type Coordinates = SVector<f64, COORDINATES>;
pub type Mass = SMatrix<f64, COORDINATES, COORDINATES>;
/// One number per mode: bending ones, then axial ones.
pub type Modal = SVector<f64, MODES>;
pub type Bristles = SVector<f64, CONTACTS>;
/// [J] Torque's work, load's work; losses in contacts, friction, viscous friction, modes.
pub type Account = SVector<f64, 6>;
pub type Vector = Vector2<f64>;

/// v turned by +90°: (−v_y, v_x).
pub fn perp(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// v turned by `angle`.
pub fn turned(angle: f64, v: Vector) -> Vector {
    let (sin, cos) = angle.sin_cos();
    v.x * Vector::new(cos, sin) + v.y * Vector::new(-sin, cos)
}

/// The planar cross product a_x·b_y − a_y·b_x.
pub fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

/// All that time changes continuously.
#[derive(Clone, Copy)]
pub struct Motion {
    pub q: Coordinates,
    pub v: Coordinates,
    /// [m] Lugre's z of each contact.
    pub bristles: Bristles,
    pub account: Account,
}

impl Motion {
    pub fn at_rest() -> Self {
        Self {
            q: Coordinates::zeros(),
            v: Coordinates::zeros(),
            bristles: Bristles::zeros(),
            account: Account::zeros(),
        }
    }

    /// The point that a body's coordinates are of: a rigid body's centre of mass, a flexible rod's
    /// big end.
    pub fn origin(&self, body: usize) -> Vector {
        Vector::new(self.q[3 * body], self.q[3 * body + 1])
    }

    pub fn origin_velocity(&self, body: usize) -> Vector {
        Vector::new(self.v[3 * body], self.v[3 * body + 1])
    }

    pub fn angle(&self, body: usize) -> f64 {
        self.q[3 * body + 2]
    }

    /// [rad/s] Rate of turn.
    pub fn spin(&self, body: usize) -> f64 {
        self.v[3 * body + 2]
    }

    pub fn modes(&self) -> Modal {
        self.q.fixed_rows::<MODES>(RIGID).into_owned()
    }

    pub fn mode_rates(&self) -> Modal {
        self.v.fixed_rows::<MODES>(RIGID).into_owned()
    }
}
