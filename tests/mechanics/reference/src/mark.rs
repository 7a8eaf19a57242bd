//! Points that move with a body, with the material around them: what they do, and what forces on
//! that material do to the coordinates.

use crate::beam::Section;
use crate::coordinates::{COORDINATES, Coordinates, GROUND, MODES, Motion, RIGID, ROD, Vector, cross, perp, turned};
use nalgebra::SMatrix;

/// Derivative of a point's position with respect to the coordinates.
pub type Jacobian = SMatrix<f64, 2, COORDINATES>;

/// A point that moves with a body.
#[derive(Clone)]
pub struct Mark {
    pub body: usize,
    place: Place,
}

#[derive(Clone)]
enum Place {
    /// [m] From the body's origin in body axes; on the ground, from the inertial origin.
    Arm(Vector),
    /// Middle of a flexible rod's cross-section.
    Section(Box<Section>),
}

impl Mark {
    pub fn fixed(body: usize, x: f64, y: f64) -> Self {
        Self { body, place: Place::Arm(Vector::new(x, y)) }
    }

    pub fn on_beam(section: Section) -> Self {
        Self { body: ROD, place: Place::Section(Box::new(section)) }
    }

    /// [m] From the body's origin, in inertial axes.
    fn lever(&self, motion: &Motion) -> Vector {
        let local = match &self.place {
            Place::Arm(arm) => *arm,
            Place::Section(section) => section.place(&motion.modes()),
        };
        if self.body == GROUND { local } else { turned(motion.angle(self.body), local) }
    }

    pub fn position(&self, motion: &Motion) -> Vector {
        if self.body == GROUND {
            return self.lever(motion);
        }
        motion.origin(self.body) + self.lever(motion)
    }

    pub fn velocity(&self, motion: &Motion) -> Vector {
        if self.body == GROUND {
            return Vector::zeros();
        }
        let whole = motion.origin_velocity(self.body) + motion.spin(self.body) * perp(self.lever(motion));
        whole + self.deforming(motion)
    }

    /// [m/s] Velocity against the body's axes, in inertial ones.
    fn deforming(&self, motion: &Motion) -> Vector {
        match &self.place {
            Place::Arm(_) => Vector::zeros(),
            Place::Section(section) => {
                turned(motion.angle(self.body), section.rate(&motion.modes(), &motion.mode_rates()))
            }
        }
    }

    /// [rad/s] Rate of turn of the material around the point; the ground's is 0.
    pub fn spin(&self, motion: &Motion) -> f64 {
        match &self.place {
            Place::Arm(_) if self.body == GROUND => 0.0,
            Place::Arm(_) => motion.spin(self.body),
            Place::Section(section) => motion.spin(self.body) + section.slope.dot(&motion.mode_rates()),
        }
    }

    /// Velocity of the material around it, at an inertial point.
    pub fn material_velocity(&self, motion: &Motion, point: Vector) -> Vector {
        self.velocity(motion) + self.spin(motion) * perp(point - self.position(motion))
    }

    pub fn jacobian(&self, motion: &Motion) -> Jacobian {
        let mut jacobian = Jacobian::zeros();
        if self.body == GROUND {
            return jacobian;
        }
        let column = 3 * self.body;
        jacobian[(0, column)] = 1.0;
        jacobian[(1, column + 1)] = 1.0;
        jacobian.set_column(column + 2, &perp(self.lever(motion)));
        if let Place::Section(section) = &self.place {
            let (along, across) = section.derivatives(&motion.modes());
            let axis = turned(motion.angle(ROD), Vector::x());
            let columns = axis * along.transpose() + perp(axis) * across.transpose();
            jacobian.fixed_columns_mut::<MODES>(RIGID).copy_from(&columns);
        }
        jacobian
    }

    /// [m/s²] The part of the acceleration that remains when all q̈ are 0:
    /// −ω²·lever + 2ω·perp(local velocity) + local acceleration.
    pub fn drift(&self, motion: &Motion) -> Vector {
        if self.body == GROUND {
            return Vector::zeros();
        }
        let spin = motion.spin(self.body);
        let whole = -spin.powi(2) * self.lever(motion) + 2.0 * spin * perp(self.deforming(motion));
        match &self.place {
            Place::Arm(_) => whole,
            Place::Section(section) => whole + turned(motion.angle(ROD), section.drift(&motion.mode_rates())),
        }
    }

    /// Generalized force of an inertial force on the material at an inertial point; none on the
    /// ground.
    pub fn push(&self, motion: &Motion, point: Vector, force: Vector) -> Coordinates {
        self.jacobian(motion).transpose() * force + self.twist(cross(point - self.position(motion), force))
    }

    /// Generalized force of a couple on the material; none on the ground.
    pub fn twist(&self, couple: f64) -> Coordinates {
        let mut loads = Coordinates::zeros();
        if self.body != GROUND {
            loads[3 * self.body + 2] = couple;
        }
        if let Place::Section(section) = &self.place {
            loads.fixed_rows_mut::<MODES>(RIGID).copy_from(&(couple * section.slope));
        }
        loads
    }
}
