//! The flexible rod: sections at (x + u − ½∫w'², w) in the chord's frame, with nothing dropped, and
//! every integral along the rod a sum over quadrature points.

use crate::coordinates::{COORDINATES, Coordinates, MODES, Mass, Modal, Motion, RIGID, ROD, Vector, perp, turned};
use crate::mechanism::{Flexible, Mechanism};
use crate::quadrature::gauss_legendre;
use nalgebra::SMatrix;
use std::f64::consts::PI;

type Square = SMatrix<f64, MODES, MODES>;

/// A cross-section of the beam.
#[derive(Clone, Copy)]
pub struct Section {
    /// [m] Arc length x.
    at: f64,
    /// ∂w/∂e, 0 for axial modes.
    bend: Modal,
    /// ∂w'/∂e.
    pub slope: Modal,
    /// ∂u/∂e, 0 for bending modes.
    axial: Modal,
    /// ∫₀ˣ of the products of slopes; 0 without foreshortening.
    shortening: Square,
}

/// Mode shapes and their derivatives, one number per mode.
struct Shapes {
    bend: Modal,
    slope: Modal,
    curvature: Modal,
    axial: Modal,
    strain: Modal,
}

fn shapes(mechanism: &Mechanism, x: f64) -> Shapes {
    let (flexible, length) = (&mechanism.rod.flexible, mechanism.rod.length);
    let bending = flexible.bending_modes as usize;
    let count = bending + flexible.axial_modes as usize;
    // w: sin(iπx/l), i = 1, 2, …; u: sin((2j − 1)πx/(2l)), j = 1, 2, ….
    let number =
        |mode: usize| PI / length * if mode < bending { mode as f64 + 1.0 } else { (mode - bending) as f64 + 0.5 };
    let bends =
        |value: &dyn Fn(f64) -> f64| Modal::from_fn(|mode, _| if mode < bending { value(number(mode)) } else { 0.0 });
    let stretches = |value: &dyn Fn(f64) -> f64| {
        Modal::from_fn(|mode, _| if (bending..count).contains(&mode) { value(number(mode)) } else { 0.0 })
    };
    Shapes {
        bend: bends(&|k| (k * x).sin()),
        slope: bends(&|k| k * (k * x).cos()),
        curvature: bends(&|k| -k * k * (k * x).sin()),
        axial: stretches(&|k| (k * x).sin()),
        strain: stretches(&|k| k * (k * x).cos()),
    }
}

impl Section {
    pub fn new(mechanism: &Mechanism, x: f64, points: usize) -> Self {
        let Shapes { bend, slope, axial, .. } = shapes(mechanism, x);
        let products = |(s, weight): (f64, f64)| {
            let slope = shapes(mechanism, s).slope;
            weight * slope * slope.transpose()
        };
        let shortening = if mechanism.rod.flexible.geometric_stiffness && x > 0.0 {
            gauss_legendre(points, x).into_iter().map(products).sum()
        } else {
            Square::zeros()
        };
        Self { at: x, bend, slope, axial, shortening }
    }

    /// [m] Place in the chord's frame.
    pub fn place(&self, modes: &Modal) -> Vector {
        Vector::new(self.at + self.stretch(modes), self.bend.dot(modes))
    }

    /// [m] u − ½∫w'².
    pub fn stretch(&self, modes: &Modal) -> f64 {
        self.axial.dot(modes) - 0.5 * modes.dot(&(self.shortening * modes))
    }

    /// Derivatives of the place with respect to the modes: along the chord, and across it.
    pub fn derivatives(&self, modes: &Modal) -> (Modal, Modal) {
        (self.axial - self.shortening * modes, self.bend)
    }

    /// [m/s] Rate of the place.
    pub fn rate(&self, modes: &Modal, rates: &Modal) -> Vector {
        let (along, across) = self.derivatives(modes);
        Vector::new(along.dot(rates), across.dot(rates))
    }

    /// [m/s²] Acceleration of the place when no mode accelerates.
    pub fn drift(&self, rates: &Modal) -> Vector {
        Vector::new(-rates.dot(&(self.shortening * rates)), 0.0)
    }
}

/// The beam as a whole.
pub struct Beam {
    /// Mass that each section stands for.
    sections: Vec<(f64, Section)>,
    /// [N/m] Elastic energy is half of this times e².
    stiffness: Square,
    /// [N·s/m] One for each mode.
    damping: Modal,
    pub big_end: Section,
    pub middle: Section,
    pub small_end: Section,
}

impl Beam {
    /// `None` where the mechanism has no modes.
    pub fn new(mechanism: &Mechanism, points: usize) -> Option<Self> {
        let f = &mechanism.rod.flexible;
        let count = mode_count(f);
        assert!(count <= MODES, "the reference has room for {MODES} modes");
        (count > 0).then(|| {
            let length = mechanism.rod.length;
            let mut sections = Vec::new();
            let (mut stiffness, mut modal_mass) = (Square::zeros(), Modal::zeros());
            for (x, weight) in gauss_legendre(points, length) {
                let Shapes { bend, curvature, axial, strain, .. } = shapes(mechanism, x);
                stiffness += weight * f.young * f.second_moment * curvature * curvature.transpose();
                stiffness += weight * f.young * f.area * strain * strain.transpose();
                let mass = weight * f.density * f.area;
                modal_mass += mass * (bend.component_mul(&bend) + axial.component_mul(&axial));
                sections.push((mass, Section::new(mechanism, x, points)));
            }
            // 2·ζ·ω·m with ω² = k/m.
            let damping = (stiffness.diagonal().component_mul(&modal_mass)).map(|km| 2.0 * f.damping_ratio * km.sqrt());
            let section = |x: f64| Section::new(mechanism, x, points);
            let [big_end, middle, small_end] = [0.0, length / 2.0, length].map(section);
            Self { sections, stiffness, damping, big_end, middle, small_end }
        })
    }

    /// The rod's part of the mass matrix, ∫ρA·JᵀJ, and the generalized force of what accelerates
    /// though no coordinate does, −∫ρA·Jᵀ·drift.
    pub fn add_inertia(&self, motion: &Motion, mass: &mut Mass, loads: &mut Coordinates) {
        const WIDTH: usize = 3 + MODES;
        let (modes, rates, spin) = (motion.modes(), motion.mode_rates(), motion.spin(ROD));
        // In the chord's axes, where the sums are simple.
        let mut local_mass = SMatrix::<f64, WIDTH, WIDTH>::zeros();
        let mut local_loads = SMatrix::<f64, WIDTH, 1>::zeros();
        for (weight, section) in &self.sections {
            let place = section.place(&modes);
            let (along, across) = section.derivatives(&modes);
            let rate = Vector::new(along.dot(&rates), across.dot(&rates));
            let mut jacobian = SMatrix::<f64, 2, WIDTH>::zeros();
            (jacobian[(0, 0)], jacobian[(1, 1)]) = (1.0, 1.0);
            jacobian.set_column(2, &perp(place));
            jacobian.fixed_view_mut::<1, MODES>(0, 3).copy_from(&along.transpose());
            jacobian.fixed_view_mut::<1, MODES>(1, 3).copy_from(&across.transpose());
            let drift = -spin * spin * place + 2.0 * spin * perp(rate) + section.drift(&rates);
            local_mass += jacobian.transpose() * (*weight * jacobian);
            local_loads -= jacobian.transpose() * (*weight * drift);
        }
        let mut turn = SMatrix::<f64, COORDINATES, WIDTH>::zeros();
        for (column, axis) in [Vector::x(), Vector::y()].into_iter().enumerate() {
            turn.fixed_view_mut::<2, 1>(3 * ROD, column).copy_from(&turned(motion.angle(ROD), axis));
        }
        turn[(3 * ROD + 2, 2)] = 1.0;
        for mode in 0..MODES {
            turn[(RIGID + mode, 3 + mode)] = 1.0;
        }
        *mass += turn * local_mass * turn.transpose();
        *loads += turn * local_loads;
    }

    /// Generalized forces of bending, stretching and modal damping.
    pub fn inner_forces(&self, motion: &Motion) -> Coordinates {
        let forces = -self.stiffness * motion.modes() - self.damping.component_mul(&motion.mode_rates());
        let mut loads = Coordinates::zeros();
        loads.fixed_rows_mut::<MODES>(RIGID).copy_from(&forces);
        loads
    }

    /// [W] What modal damping takes.
    pub fn loss(&self, motion: &Motion) -> f64 {
        let rates = motion.mode_rates();
        self.damping.component_mul(&rates).dot(&rates)
    }

    /// [J] ½∫E·I·w''² + ½∫E·A·u'².
    pub fn energy(&self, motion: &Motion) -> f64 {
        0.5 * motion.modes().dot(&(self.stiffness * motion.modes()))
    }

    /// [J] Height of the rod, each section for itself.
    pub fn height_energy(&self, motion: &Motion, gravity: Vector) -> f64 {
        let modes = motion.modes();
        let place = |section: &Section| motion.origin(ROD) + turned(motion.angle(ROD), section.place(&modes));
        self.sections.iter().map(|(mass, section)| -mass * gravity.dot(&place(section))).sum()
    }
}

pub fn mode_count(flexible: &Flexible) -> usize {
    (flexible.bending_modes + flexible.axial_modes) as usize
}
