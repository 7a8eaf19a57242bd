//! What makes a scene slow: which contacts stay closed after a soft touch, and how fast the fastest motion of its equations
//! is.
//!
//! A contact that closed more slowly than its law's least approach speed is damped as if by that speed: pressed on by a
//! load it is stiff out of all proportion to its own motion. So are bristles, and high modes of a rod.

use super::trial::inputs;
use nalgebra::DMatrix;
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::read::SceneFile;
use slidercrank::simulation::{Linearization, Simulation};

/// Evaluations after which a look is over.
const EVALUATIONS: i32 = 3_000_000;
/// Communication points between two looks at the derivatives.
const SELDOM: usize = 16;
/// A contact that approached by less than this many times the least speed counts as one that closed at it.
const AT_FLOOR: f64 = 1.01;

/// What was seen of a run, as shares of its communication points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stiffness {
    /// [1/s] The greatest eigenvalue of the equations of motion, by size.
    pub fastest: f64,
    /// It is that of a decay; otherwise of an oscillation.
    pub decays: bool,
    /// Contacts in A, B, C and T (any corner or face) that were closed.
    pub closed: [f64; 4],
    /// And those of them that had closed at the law's least approach speed.
    pub at_floor: [f64; 4],
}

impl Stiffness {
    /// Of the first part of a scene's run; nothing of one that cannot start.
    pub fn of(file: &SceneFile) -> Self {
        let mut seen = Self::default();
        let start = inputs(file, 0.0, file.scene.crank.angle_start);
        let Ok(mut simulation) = Simulation::start(&file.scene, start) else { return seen };
        let points = (file.run.stop(&file.scene) / file.run.step).round().max(1.0) as usize;
        let mut looks = 0.0;
        for point in 1..=points {
            let Outputs { crank, solver, .. } = simulation.outputs();
            simulation.set_inputs(inputs(file, simulation.time(), crank.angle), Inputs::default());
            let stepped = simulation.advance_to(file.run.stop(&file.scene) * (point as f64 / points as f64));
            if stepped.is_err() || solver.evaluations > EVALUATIONS {
                break;
            }
            looks += 1.0;
            seen.look(file, &mut simulation, point % SELDOM == 0);
        }
        for share in seen.closed.iter_mut().chain(&mut seen.at_floor) {
            *share /= f64::max(looks, 1.0);
        }
        seen
    }

    fn look(&mut self, file: &SceneFile, simulation: &mut Simulation, derivatives: bool) {
        let joint = &file.scene.joint;
        let floors =
            [&joint.a.contact, &joint.b.contact, &joint.c.contact, &joint.t.contact].map(|contact| contact.speed_floor);
        let approach = simulation.phase().approach;
        // A, B, C, then the guide's corners or faces.
        for (number, floor) in floors.iter().enumerate() {
            let contacts = if number < 3 { number..number + 1 } else { 3..approach.len().max(3) };
            let closed = approach.get(contacts).unwrap_or_default().iter().flatten();
            let soft = closed.clone().any(|speed| *speed < AT_FLOOR * floor);
            self.closed[number] += f64::from(u8::from(closed.count() > 0));
            self.at_floor[number] += f64::from(u8::from(soft));
        }
        if derivatives {
            let (time, states) = simulation.front();
            let Linearization { by_state, .. } = simulation.linearization_at(time, &states);
            let n = by_state.len();
            let matrix = DMatrix::from_fn(n, n, |i, j| by_state[i][j]);
            if n == 0 || matrix.iter().any(|slope| !slope.is_finite()) {
                return;
            }
            for value in matrix.complex_eigenvalues().iter() {
                let size = value.re.hypot(value.im);
                if size > self.fastest {
                    (self.fastest, self.decays) = (size, value.re.abs() > value.im.abs());
                }
            }
        }
    }
}
