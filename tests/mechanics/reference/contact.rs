//! Where bodies may touch: three journals in bearings, four corners between two lines.

use super::bodies::{Bodies, Mark, Motion, Vector, material_velocity, perp};
use super::laws::Laws;
use slidercrank::scene::{Guide, JointModel, Revolute, Scene};

/// A pair of surfaces.
pub struct Contact {
    surface: Surface,
    pub laws: Laws,
}

enum Surface {
    /// Journal in bearing.
    Bearing { bearing: Mark, journal: Mark, radius: f64, clearance: f64 },
    /// Corner under (`side` +1) or above (−1) the line at `height`.
    Line { corner: Mark, height: f64, side: f64 },
}

/// The state of a pair of surfaces.
#[derive(Clone, Copy)]
pub struct Touch {
    /// [m] δ, negative when open.
    pub penetration: f64,
    /// [m/s] δ̇.
    pub rate: f64,
    /// [m/s] v_t, of the inner body against the outer.
    pub sliding: f64,
    /// The inner body is pushed along −normal and rubbed along −tangent.
    pub normal: Vector,
    pub tangent: Vector,
    /// Common point of application.
    pub point: Vector,
}

impl Contact {
    pub fn of_revolute(joint: &Revolute, bearing: Mark, journal: Mark) -> Option<Self> {
        (joint.model == JointModel::Clearance).then(|| Self {
            surface: Surface::Bearing { bearing, journal, radius: joint.radius, clearance: joint.clearance },
            laws: Laws::of_revolute(joint),
        })
    }

    fn of_corner(guide: &Guide, corner: Mark, height: f64, side: f64) -> Option<Self> {
        (guide.model == JointModel::Clearance)
            .then(|| Self { surface: Surface::Line { corner, height, side }, laws: Laws::of_corner(guide) })
    }

    /// Body that is pushed along −normal, and the one that is pushed along +normal.
    pub fn inner_and_outer(&self) -> (usize, Option<usize>) {
        match &self.surface {
            Surface::Bearing { bearing, journal, .. } => (journal.body, Some(bearing.body)),
            Surface::Line { corner, .. } => (corner.body, None),
        }
    }

    pub fn touch(&self, motion: &Motion) -> Touch {
        match self.surface {
            Surface::Bearing { bearing, journal, radius, clearance } => {
                let (p, e) = (bearing.position(motion), eccentricity(&bearing, &journal, motion));
                let distance = e.norm();
                // At ε = 0 the gap is open and nothing but the penetration is asked for.
                let normal = if distance > 0.0 { e / distance } else { Vector::x() };
                let tangent = perp(normal);
                let point = p + radius * normal;
                let slip =
                    material_velocity(motion, journal.body, point) - material_velocity(motion, bearing.body, point);
                Touch {
                    penetration: distance - clearance,
                    rate: (journal.velocity(motion) - bearing.velocity(motion)).dot(&normal),
                    sliding: slip.dot(&tangent),
                    normal,
                    tangent,
                    point,
                }
            }
            Surface::Line { corner, height, side } => {
                let (point, velocity) = (corner.position(motion), corner.velocity(motion));
                Touch {
                    penetration: side * (point.y - height),
                    rate: side * velocity.y,
                    sliding: velocity.x,
                    normal: side * Vector::y(),
                    tangent: Vector::x(),
                    point,
                }
            }
        }
    }
}

/// e = Q − P: journal centre minus bearing centre.
pub fn eccentricity(bearing: &Mark, journal: &Mark, motion: &Motion) -> Vector {
    journal.position(motion) - bearing.position(motion)
}

/// A, B, C and the corners of the guide; `None` where the joint is ideal.
pub fn contacts(scene: &Scene, bodies: &Bodies) -> [Option<Contact>; 7] {
    let joint = &scene.joint;
    let revolute = |joint: &Revolute, k: usize| Contact::of_revolute(joint, bodies.bearings[k], bodies.journals[k]);
    let half = scene.slider.height / 2.0 + joint.t.clearance;
    let corner =
        |k: usize, side: f64| Contact::of_corner(&joint.t, bodies.corners[k], scene.guide.offset + side * half, side);
    [
        revolute(&joint.a, 0),
        revolute(&joint.b, 1),
        revolute(&joint.c, 2),
        corner(0, 1.0),
        corner(1, 1.0),
        corner(2, -1.0),
        corner(3, -1.0),
    ]
}
