//! Ideal joints and a prescribed crank as constraints Φ(q, t) = 0, held by Lagrange multipliers:
//! M·q̈ − Φ_qᵀ·λ = Q and Φ_q·q̈ = γ, so that Φ_qᵀ·λ is the reaction.

use crate::bodies::Bodies;
use crate::coordinates::{COORDINATES, CRANK, Coordinates, Mass, Motion, SLIDER, Vector};
use crate::elimination::System;
use crate::mechanism::{DriveMode, JointModel, Mechanism};
use nalgebra::{SMatrix, SVector};

/// Rows of each constraint; a joint with clearance leaves its rows empty.
pub const REVOLUTE_ROWS: [usize; 3] = [0, 2, 4];
const HEIGHT_ROW: usize = 6;
const TILT_ROW: usize = 7;
pub const DRIVE_ROW: usize = 8;

const ROWS: usize = 9;
/// One number per row.
type Nine = SVector<f64, ROWS>;
type Jacobian = SMatrix<f64, ROWS, COORDINATES>;

/// Which constraints hold, and what they ask for.
pub struct Constraints {
    held: [bool; ROWS],
    guide_offset: f64,
    angle_start: f64,
    speed: f64,
    time_start: f64,
}

/// The constraints at one instant.
struct Rows {
    /// Φ_q, zero in rows not held.
    jacobian: Jacobian,
    /// Φ.
    miss: Nine,
    /// What Φ_q·v must be.
    rate: Nine,
    /// γ, what Φ_q·q̈ must be.
    acceleration: Nine,
}

/// q̈ and λ.
pub struct Solution {
    pub acceleration: Coordinates,
    pub multipliers: Nine,
}

impl Constraints {
    pub fn new(mechanism: &Mechanism, time_start: f64) -> Self {
        let joint = &mechanism.joint;
        let [a, b, c, t] = [joint.a.model, joint.b.model, joint.c.model, joint.t.model].map(|m| m == JointModel::Ideal);
        let drive = mechanism.drive.mode == DriveMode::Speed;
        Self {
            held: [a, a, b, b, c, c, t, t, drive],
            guide_offset: mechanism.guide.offset,
            angle_start: mechanism.crank.angle_start,
            speed: mechanism.crank.speed_start,
            time_start,
        }
    }

    fn rows(&self, bodies: &Bodies, time: f64, motion: &Motion) -> Rows {
        let mut rows =
            Rows { jacobian: Jacobian::zeros(), miss: Nine::zeros(), rate: Nine::zeros(), acceleration: Nine::zeros() };
        for (joint, &row) in REVOLUTE_ROWS.iter().enumerate() {
            // Journal centre = bearing centre.
            let (bearing, journal) = (&bodies.bearings[joint], &bodies.journals[joint]);
            let jacobian = journal.jacobian(motion) - bearing.jacobian(motion);
            let miss = journal.position(motion) - bearing.position(motion);
            let drift = journal.drift(motion) - bearing.drift(motion);
            rows.jacobian.fixed_rows_mut::<2>(row).copy_from(&jacobian);
            rows.miss.fixed_rows_mut::<2>(row).copy_from(&miss);
            rows.acceleration.fixed_rows_mut::<2>(row).copy_from(&-drift);
        }
        // The rectangle's centre on the middle line, untilted.
        let height = bodies.centre.jacobian(motion).row(1).into_owned();
        rows.jacobian.row_mut(HEIGHT_ROW).copy_from(&height);
        rows.miss[HEIGHT_ROW] = bodies.centre.position(motion).y - self.guide_offset;
        rows.acceleration[HEIGHT_ROW] = -bodies.centre.drift(motion).y;
        rows.jacobian[(TILT_ROW, 3 * SLIDER + 2)] = 1.0;
        rows.miss[TILT_ROW] = motion.angle(SLIDER);
        // θ1 = θ0 + ω0·(t − t0).
        rows.jacobian[(DRIVE_ROW, 3 * CRANK + 2)] = 1.0;
        rows.miss[DRIVE_ROW] = motion.angle(CRANK) - (self.angle_start + self.speed * (time - self.time_start));
        rows.rate[DRIVE_ROW] = self.speed;
        for row in (0..ROWS).filter(|&row| !self.held[row]) {
            rows.jacobian.row_mut(row).fill(0.0);
            (rows.miss[row], rows.rate[row], rows.acceleration[row]) = (0.0, 0.0, 0.0);
        }
        rows
    }

    /// Solves [M Φ_qᵀ; Φ_q 0]·[x; −λ] = [load; right], leaving out what is not there.
    fn solve(&self, count: usize, mass: &Mass, jacobian: &Jacobian, load: &Coordinates, right: &Nine) -> Solution {
        let held: Vec<usize> = (0..ROWS).filter(|&row| self.held[row]).collect();
        let mut system = System::new(count + held.len());
        for row in 0..count {
            (0..count).for_each(|column| system.set(row, column, mass[(row, column)]));
            system.set_right(row, load[row]);
        }
        for (k, &row) in held.iter().enumerate() {
            for column in 0..count {
                system.set(count + k, column, jacobian[(row, column)]);
                system.set(column, count + k, jacobian[(row, column)]);
            }
            system.set_right(count + k, right[row]);
        }
        let solved = system.solve();
        let mut solution = Solution { acceleration: Coordinates::zeros(), multipliers: Nine::zeros() };
        solution.acceleration.rows_mut(0, count).copy_from_slice(&solved[..count]);
        for (k, &row) in held.iter().enumerate() {
            solution.multipliers[row] = -solved[count + k];
        }
        solution
    }

    /// Accelerations and multipliers under these generalized forces, and under gravity and the
    /// forces of q̇.
    pub fn accelerate(&self, bodies: &Bodies, time: f64, motion: &Motion, loads: &Coordinates) -> Solution {
        let rows = self.rows(bodies, time, motion);
        let inertia = bodies.inertia(motion);
        self.solve(bodies.count, &inertia.mass, &rows.jacobian, &(loads + inertia.loads), &rows.acceleration)
    }

    /// The nearest motion, measured by mass, that keeps every constraint.
    pub fn project(&self, bodies: &Bodies, time: f64, mut motion: Motion) -> Motion {
        let none = Coordinates::zeros();
        let mass = bodies.inertia(&motion).mass;
        // Newton from a miss of 1e-13 is at round-off after the first of these.
        for _ in 0..2 {
            let rows = self.rows(bodies, time, &motion);
            motion.q += self.solve(bodies.count, &mass, &rows.jacobian, &none, &-rows.miss).acceleration;
        }
        let rows = self.rows(bodies, time, &motion);
        let miss = rows.rate - rows.jacobian * motion.v;
        motion.v += self.solve(bodies.count, &mass, &rows.jacobian, &none, &miss).acceleration;
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
