//! Ideal joints and a prescribed crank as constraints Φ(q, t) = 0, held by Lagrange multipliers:
//! M·q̈ − Φ_qᵀ·λ = Q and Φ_q·q̈ = γ, so that Φ_qᵀ·λ is the reaction.

use super::bodies::{Bodies, CRANK, Motion, Nine, SLIDER, Vector};
use nalgebra::{SMatrix, SVector};
use slidercrank::scene::{DriveMode, JointModel, Scene};

/// Rows of each constraint; a joint with clearance leaves its rows empty.
pub const REVOLUTE_ROWS: [usize; 3] = [0, 2, 4];
const HEIGHT_ROW: usize = 6;
const TILT_ROW: usize = 7;
pub const DRIVE_ROW: usize = 8;

type Square = SMatrix<f64, 9, 9>;
type Eighteen = SVector<f64, 18>;

/// Which constraints hold, and what they ask for.
pub struct Constraints {
    held: [bool; 9],
    guide_offset: f64,
    angle_start: f64,
    speed: f64,
    time_start: f64,
}

/// The constraints at one instant.
struct Rows {
    /// Φ_q, zero in rows not held.
    jacobian: Square,
    /// Φ.
    miss: Nine,
    /// What Φ_q·v must be.
    rate: Nine,
    /// γ, what Φ_q·q̈ must be.
    acceleration: Nine,
}

/// q̈ and λ.
pub struct Solution {
    pub acceleration: Nine,
    pub multipliers: Nine,
}

impl Constraints {
    pub fn new(scene: &Scene, time_start: f64) -> Self {
        let joint = &scene.joint;
        let [a, b, c, t] = [joint.a.model, joint.b.model, joint.c.model, joint.t.model].map(|m| m == JointModel::Ideal);
        let drive = scene.drive.mode == DriveMode::Speed;
        Self {
            held: [a, a, b, b, c, c, t, t, drive],
            guide_offset: scene.guide.offset,
            angle_start: scene.crank.angle_start,
            speed: scene.crank.speed_start,
            time_start,
        }
    }

    fn rows(&self, bodies: &Bodies, time: f64, motion: &Motion) -> Rows {
        let mut rows =
            Rows { jacobian: Square::zeros(), miss: Nine::zeros(), rate: Nine::zeros(), acceleration: Nine::zeros() };
        for (joint, &row) in REVOLUTE_ROWS.iter().enumerate() {
            // Journal centre = bearing centre.
            let (bearing, journal) = (&bodies.bearings[joint], &bodies.journals[joint]);
            let jacobian = journal.jacobian(motion) - bearing.jacobian(motion);
            let miss = journal.position(motion) - bearing.position(motion);
            let drift = journal.centripetal(motion) - bearing.centripetal(motion);
            rows.jacobian.fixed_rows_mut::<2>(row).copy_from(&jacobian);
            rows.miss.fixed_rows_mut::<2>(row).copy_from(&miss);
            rows.acceleration.fixed_rows_mut::<2>(row).copy_from(&-drift);
        }
        // The rectangle's centre on the middle line, untilted.
        let height = bodies.centre.jacobian(motion).row(1).into_owned();
        rows.jacobian.row_mut(HEIGHT_ROW).copy_from(&height);
        rows.miss[HEIGHT_ROW] = bodies.centre.position(motion).y - self.guide_offset;
        rows.acceleration[HEIGHT_ROW] = -bodies.centre.centripetal(motion).y;
        rows.jacobian[(TILT_ROW, 3 * SLIDER + 2)] = 1.0;
        rows.miss[TILT_ROW] = motion.angle(SLIDER);
        // θ1 = θ0 + ω0·(t − t0).
        rows.jacobian[(DRIVE_ROW, 3 * CRANK + 2)] = 1.0;
        rows.miss[DRIVE_ROW] = motion.angle(CRANK) - (self.angle_start + self.speed * (time - self.time_start));
        rows.rate[DRIVE_ROW] = self.speed;
        for row in (0..9).filter(|&row| !self.held[row]) {
            rows.jacobian.row_mut(row).fill(0.0);
            (rows.miss[row], rows.rate[row], rows.acceleration[row]) = (0.0, 0.0, 0.0);
        }
        rows
    }

    /// Solves [M Φ_qᵀ; Φ_q 0]·[x; −λ] = [load; right].
    fn solve(&self, bodies: &Bodies, jacobian: &Square, load: &Nine, right: &Nine) -> Solution {
        let mut matrix = SMatrix::<f64, 18, 18>::zeros();
        matrix.fixed_view_mut::<9, 9>(0, 0).set_diagonal(&bodies.inertia);
        matrix.fixed_view_mut::<9, 9>(0, 9).copy_from(&jacobian.transpose());
        matrix.fixed_view_mut::<9, 9>(9, 0).copy_from(jacobian);
        for row in (0..9).filter(|&row| !self.held[row]) {
            matrix[(9 + row, 9 + row)] = 1.0;
        }
        let mut right_side = Eighteen::zeros();
        right_side.fixed_rows_mut::<9>(0).copy_from(load);
        right_side.fixed_rows_mut::<9>(9).copy_from(right);
        let solved = matrix.lu().solve(&right_side).expect("the mechanism stands away from its singular positions");
        Solution {
            acceleration: solved.fixed_rows::<9>(0).into_owned(),
            multipliers: -solved.fixed_rows::<9>(9).into_owned(),
        }
    }

    /// Accelerations and multipliers under these generalized forces.
    pub fn accelerate(&self, bodies: &Bodies, time: f64, motion: &Motion, loads: &Nine) -> Solution {
        let rows = self.rows(bodies, time, motion);
        self.solve(bodies, &rows.jacobian, loads, &rows.acceleration)
    }

    /// The nearest motion, measured by mass, that keeps every constraint.
    pub fn project(&self, bodies: &Bodies, time: f64, mut motion: Motion) -> Motion {
        // Newton from a miss of 1e-13 is at round-off after the first of these.
        for _ in 0..2 {
            let rows = self.rows(bodies, time, &motion);
            motion.q += self.solve(bodies, &rows.jacobian, &Nine::zeros(), &-rows.miss).acceleration;
        }
        let rows = self.rows(bodies, time, &motion);
        let miss = rows.rate - rows.jacobian * motion.v;
        motion.v += self.solve(bodies, &rows.jacobian, &Nine::zeros(), &miss).acceleration;
        motion
    }

    /// Generalized reaction of an ideal revolute joint, force on the journal's body: (λ_x, λ_y).
    pub fn revolute_reaction(solution: &Solution, joint: usize) -> Vector {
        let row = REVOLUTE_ROWS[joint];
        Vector::new(solution.multipliers[row], solution.multipliers[row + 1])
    }

    /// Reaction of an ideal guide: force along y at the rectangle's centre, and a couple.
    pub fn guide_reaction(solution: &Solution) -> (f64, f64) {
        (solution.multipliers[HEIGHT_ROW], solution.multipliers[TILT_ROW])
    }
}
