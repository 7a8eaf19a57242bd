//! Three bodies: masses, and the points where they meet.

use crate::beam::{Beam, mode_count};
use crate::coordinates::{CRANK, Coordinates, GROUND, Mass, Motion, RIGID, ROD, SLIDER, Vector};
use crate::film::Film;
use crate::mark::Mark;
use crate::mechanism::{Mechanism, Point};

/// Masses and the points where the bodies meet.
pub struct Bodies {
    /// Coordinates in use: those of the bodies and of the rod's modes.
    pub count: usize,
    /// Diagonal of the mass matrix, 0 for a flexible rod.
    inertia: Coordinates,
    /// The flexible rod.
    pub beam: Option<Beam>,
    /// [m/s²] Of a body that falls freely.
    pub gravity: Vector,
    /// Where the load pushes the slider.
    pub loaded: Mark,
    /// The crank's centre of mass.
    pub crank: Mark,
    /// Bearing centres of A, B, C.
    pub bearings: [Mark; 3],
    /// Journal centres of A, B, C.
    pub journals: [Mark; 3],
    /// The oil in A, B, C.
    pub films: [Option<Film>; 3],
    /// Centre of the slider's rectangle.
    pub centre: Mark,
    /// (+a, +b), (−a, +b), (+a, −b), (−a, −b): upper ones first.
    pub corners: [Mark; 4],
}

/// Mass matrix, and the generalized forces of gravity and of q̇.
pub struct Inertia {
    pub mass: Mass,
    pub loads: Coordinates,
}

impl Bodies {
    /// `points`: of the quadrature along the rod.
    pub fn new(mechanism: &Mechanism, points: usize) -> Self {
        let (crank, rod, slider) = (&mechanism.crank, &mechanism.rod, &mechanism.slider);
        let mark = |body, com: Point, x: f64, y: f64| Mark::fixed(body, x - com.x, y - com.y);
        let on_slider = |x, y| mark(SLIDER, slider.com, slider.centre.x + x, slider.centre.y + y);
        let (a, b) = (slider.length / 2.0, slider.height / 2.0);
        let beam = Beam::new(mechanism, points);
        let [big_end, small_end] = match &beam {
            None => [mark(ROD, rod.com, 0.0, 0.0), mark(ROD, rod.com, rod.length, 0.0)],
            Some(beam) => [Mark::on_beam(beam.big_end), Mark::on_beam(beam.small_end)],
        };
        let mut inertia = Coordinates::zeros();
        let mut place = |body: usize, mass: f64, about: f64| {
            inertia.fixed_rows_mut::<3>(3 * body).copy_from_slice(&[mass, mass, about]);
        };
        place(CRANK, crank.mass, crank.inertia);
        place(SLIDER, slider.mass, slider.inertia);
        if beam.is_none() {
            place(ROD, rod.mass, rod.inertia);
        }
        Self {
            count: RIGID + mode_count(&rod.flexible),
            inertia,
            beam,
            gravity: mechanism.gravity * Vector::new(mechanism.gravity_angle.cos(), mechanism.gravity_angle.sin()),
            loaded: mark(SLIDER, slider.com, 0.0, slider.load_offset),
            crank: mark(CRANK, crank.com, crank.com.x, crank.com.y),
            bearings: [Mark::fixed(GROUND, 0.0, 0.0), big_end, small_end],
            journals: [
                mark(CRANK, crank.com, 0.0, 0.0),
                mark(CRANK, crank.com, crank.length, 0.0),
                mark(SLIDER, slider.com, 0.0, 0.0),
            ],
            films: [&mechanism.joint.a, &mechanism.joint.b, &mechanism.joint.c].map(Film::new),
            centre: on_slider(0.0, 0.0),
            corners: [on_slider(a, b), on_slider(-a, b), on_slider(a, -b), on_slider(-a, -b)],
        }
    }

    pub fn inertia(&self, motion: &Motion) -> Inertia {
        let mut mass = Mass::from_diagonal(&self.inertia);
        let mut loads = Coordinates::zeros();
        if let Some(beam) = &self.beam {
            beam.add_inertia(motion, &mut mass, &mut loads);
        }
        // Gravity pulls as if every point of every body accelerated against it.
        for body in [CRANK, ROD, SLIDER] {
            loads += self.gravity.x * mass.column(3 * body) + self.gravity.y * mass.column(3 * body + 1);
        }
        Inertia { mass, loads }
    }

    /// [J] Of the heights of all bodies above the origin.
    pub fn height_energy(&self, motion: &Motion) -> f64 {
        let rigid = |body: usize| -self.inertia[3 * body] * self.gravity.dot(&motion.origin(body));
        let beam = self.beam.as_ref().map_or(0.0, |beam| beam.height_energy(motion, self.gravity));
        [CRANK, ROD, SLIDER].map(rigid).iter().sum::<f64>() + beam
    }
}
