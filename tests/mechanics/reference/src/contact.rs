//! Where bodies may touch: three journals in bearings, four corners or two faces between two lines.

use crate::bodies::Bodies;
use crate::coordinates::{CONTACTS, Coordinates, Motion, Vector, perp};
use crate::face::Face;
use crate::film::way;
use crate::laws::Laws;
use crate::mark::Mark;
use crate::mechanism::{Guide, JointModel, Mechanism, Revolute, Surface as Kind};
use crate::phase::Phase;

/// A pair of surfaces.
pub struct Contact {
    surface: Surface,
    pub laws: Laws,
}

enum Surface {
    /// Journal in bearing.
    Bearing { bearing: Mark, journal: Mark, radius: f64, way: f64 },
    /// Corner under (`side` +1) or above (−1) the line at `height`.
    Line { corner: Mark, height: f64, side: f64 },
    /// Face between two corners, at the line likewise.
    Bed { corners: [Mark; 2], face: Face, height: f64, side: f64 },
}

/// The state of a pair of surfaces.
#[derive(Clone, Copy)]
pub struct Touch {
    /// [m] δ, negative when open: of a face's two corners, else of the contact and −∞.
    pub depths: [f64; 2],
    /// [m/s] Their rates.
    pub rates: [f64; 2],
    /// [m/s] δ̇, of a face at its centre of pressure.
    pub rate: f64,
    /// [m/s] v_t, of the inner body against the outer.
    pub sliding: f64,
    /// [N] Elastic force.
    pub elastic: f64,
    /// The inner body is pushed along −normal and rubbed along −tangent.
    pub normal: Vector,
    pub tangent: Vector,
    /// Common point of application.
    pub point: Vector,
}

impl Contact {
    pub fn of_revolute(joint: &Revolute, bearing: Mark, journal: Mark) -> Option<Self> {
        (joint.model == JointModel::Clearance).then(|| Self {
            surface: Surface::Bearing { bearing, journal, radius: joint.radius, way: way(joint) },
            laws: Laws::of_revolute(joint),
        })
    }

    fn of_corner(guide: &Guide, corner: Mark, height: f64, side: f64) -> Self {
        Self { surface: Surface::Line { corner, height, side }, laws: Laws::of_corner(guide) }
    }

    fn of_face(mechanism: &Mechanism, corners: [Mark; 2], height: f64, side: f64) -> Self {
        let face = Face::new(mechanism);
        Self { surface: Surface::Bed { corners, face, height, side }, laws: Laws::of_face(&mechanism.joint.t) }
    }

    /// Generalized force of `force` on the inner body, and of its reaction on the outer.
    pub fn push(&self, motion: &Motion, point: Vector, force: Vector) -> Coordinates {
        match &self.surface {
            Surface::Bearing { bearing, journal, .. } => {
                journal.push(motion, point, force) - bearing.push(motion, point, force)
            }
            Surface::Line { corner, .. } => corner.push(motion, point, force),
            Surface::Bed { corners, .. } => corners[0].push(motion, point, force),
        }
    }

    /// On the branch of `phase`.
    pub fn touch(&self, motion: &Motion, phase: &Phase) -> Touch {
        match &self.surface {
            Surface::Bearing { bearing, journal, radius, way } => {
                let (p, e) = (bearing.position(motion), eccentricity(bearing, journal, motion));
                let distance = e.norm();
                // At ε = 0 the gap is open and nothing but the penetration is asked for.
                let normal = if distance > 0.0 { e / distance } else { Vector::x() };
                let tangent = perp(normal);
                let point = p + *radius * normal;
                let slip = journal.material_velocity(motion, point) - bearing.material_velocity(motion, point);
                let rate = (journal.velocity(motion) - bearing.velocity(motion)).dot(&normal);
                let penetration = distance - way;
                let (depths, rates) = alone(penetration, rate);
                let elastic = self.laws.elastic_force(penetration);
                Touch { depths, rates, rate, sliding: slip.dot(&tangent), elastic, normal, tangent, point }
            }
            &Surface::Line { ref corner, height, side } => {
                let (point, velocity) = (corner.position(motion), corner.velocity(motion));
                let penetration = side * (point.y - height);
                let rate = side * velocity.y;
                let (depths, rates) = alone(penetration, rate);
                let elastic = self.laws.elastic_force(penetration);
                let (normal, tangent) = (side * Vector::y(), Vector::x());
                Touch { depths, rates, rate, sliding: velocity.x, elastic, normal, tangent, point }
            }
            &Surface::Bed { ref corners, face, height, side } => {
                let (points, velocities) =
                    (corners.each_ref().map(|c| c.position(motion)), corners.each_ref().map(|c| c.velocity(motion)));
                let depths = points.map(|point| side * (point.y - height));
                let rates = velocities.map(|velocity| side * velocity.y);
                let pressure = face.pressure(depths, phase.inside);
                let at_centre = |of: [Vector; 2]| (of[0] + of[1]) / 2.0 + pressure.centre * (of[0] - of[1]) / 2.0;
                let velocity = at_centre(velocities);
                Touch {
                    depths,
                    rates,
                    rate: side * velocity.y,
                    sliding: velocity.x,
                    elastic: pressure.force,
                    normal: side * Vector::y(),
                    tangent: Vector::x(),
                    point: at_centre(points),
                }
            }
        }
    }

    /// [J] In the elastic force.
    pub fn energy(&self, motion: &Motion, phase: &Phase) -> f64 {
        let depths = self.touch(motion, phase).depths;
        match &self.surface {
            Surface::Bed { face, .. } => face.pressure(depths, phase.inside).energy,
            _ => self.laws.elastic_energy(depths[0]),
        }
    }
}

/// One penetration and its rate, beside one that never is.
fn alone(penetration: f64, rate: f64) -> ([f64; 2], [f64; 2]) {
    ([penetration, f64::NEG_INFINITY], [rate, f64::NEG_INFINITY])
}

/// e = Q − P: journal centre minus bearing centre.
pub fn eccentricity(bearing: &Mark, journal: &Mark, motion: &Motion) -> Vector {
    journal.position(motion) - bearing.position(motion)
}

/// A, B, C, then the corners or the faces of the guide; `None` where the joint is ideal.
pub fn contacts(mechanism: &Mechanism, bodies: &Bodies) -> [Option<Contact>; CONTACTS] {
    let (joint, corners) = (&mechanism.joint, &bodies.corners);
    let revolute = |joint: &Revolute, k: usize| {
        Contact::of_revolute(joint, bodies.bearings[k].clone(), bodies.journals[k].clone())
    };
    let half = mechanism.slider.height / 2.0 + joint.t.clearance;
    let height = |side: f64| mechanism.guide.offset + side * half;
    let corner = |k: usize, side: f64| Some(Contact::of_corner(&joint.t, corners[k].clone(), height(side), side));
    let face = |k: usize, side: f64| {
        Some(Contact::of_face(mechanism, [corners[k].clone(), corners[k + 1].clone()], height(side), side))
    };
    let guide = match (joint.t.model, joint.t.surface) {
        (JointModel::Ideal, _) => [None, None, None, None],
        (JointModel::Clearance, Kind::Corner) => [corner(0, 1.0), corner(1, 1.0), corner(2, -1.0), corner(3, -1.0)],
        (JointModel::Clearance, Kind::Foundation) => [face(0, 1.0), face(2, -1.0), None, None],
    };
    let [t0, t1, t2, t3] = guide;
    [revolute(&joint.a, 0), revolute(&joint.b, 1), revolute(&joint.c, 2), t0, t1, t2, t3]
}
