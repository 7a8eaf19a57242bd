//! Finds why a scene is stiff: contacts that stay closed after a slow impact, and the fastest rate of the equations.
//!
//! A contact that closed more slowly than its law's minimum approach speed is damped as if it had closed at that speed.
//! Under a load such a contact is far stiffer than its own motion requires. Bristles and high modes of a rod are stiff,
//! too.

use nalgebra::DMatrix;
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::read::SceneFile;
use slidercrank::simulation::{Linearization, Simulation};

/// Maximum number of evaluations of this analysis.
const EVALUATIONS: i32 = 3_000_000;
/// Communication points between two evaluations of the Jacobian.
const SELDOM: usize = 16;
/// A contact whose approach speed is below this multiple of the minimum speed counts as closed at the minimum speed.
const AT_FLOOR: f64 = 1.01;

/// Stiffness of a run. Shares are those of its communication points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stiffness {
    /// [1/s] Largest absolute eigenvalue of the equations of motion.
    pub fastest: f64,
    /// Whether the eigenvalue belongs to a decay; otherwise it belongs to an oscillation.
    pub decays: bool,
    /// Shares with closed contacts in A, B, C and T (any corner or face).
    pub closed: [f64; 4],
    /// Shares with contacts that had closed at the law's minimum approach speed.
    pub at_floor: [f64; 4],
}

impl Stiffness {
    /// Analyses the first part of a scene's run. The result is empty if the run cannot start.
    pub fn of(file: &SceneFile) -> Self {
        let mut seen = Self::default();
        let Ok(mut simulation) = Simulation::start(&file.scene, Inputs::at_start(file)) else {
            return seen;
        };
        let points = (file.run.stop(&file.scene) / file.run.step).round().max(1.0) as usize;
        let mut looks = 0.0;
        for point in 1..=points {
            let Outputs { crank, solver, .. } = simulation.outputs();
            let time = file.run.stop(&file.scene) * (point as f64 / points as f64);
            let [inputs, rates] = Inputs::chords(&file.inputs, [simulation.time(), time], &crank);
            simulation.set_inputs(inputs, rates);
            let stepped = simulation.advance_to(time);
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
        // Order: A, B, C, then the guide's corners or faces.
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
