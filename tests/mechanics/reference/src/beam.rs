//! The flexible rod: sections at (x + u − ½∫w'², w) in the chord's frame, with nothing dropped, and
//! every integral along the rod a sum over quadrature points.

use crate::coordinates::{Coordinates, MODES, Mass, Modal, Motion, RIGID, ROD, Vector, perp, turned};
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

/// A product of few numbers, without a library's loop for many.
fn times(square: &Square, modes: &Modal) -> Modal {
    let mut product = Modal::zeros();
    for j in 0..MODES {
        for i in 0..MODES {
            product[i] += square[(i, j)] * modes[j];
        }
    }
    product
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
        self.axial.dot(modes) - 0.5 * modes.dot(&times(&self.shortening, modes))
    }

    /// Derivatives of the place with respect to the modes: along the chord, and across it.
    pub fn derivatives(&self, modes: &Modal) -> (Modal, Modal) {
        (self.axial - times(&self.shortening, modes), self.bend)
    }

    /// [m/s] Rate of the place.
    pub fn rate(&self, modes: &Modal, rates: &Modal) -> Vector {
        let (along, across) = self.derivatives(modes);
        Vector::new(along.dot(rates), across.dot(rates))
    }

    /// [m/s²] Acceleration of the place when no mode accelerates.
    pub fn drift(&self, rates: &Modal) -> Vector {
        Vector::new(-rates.dot(&times(&self.shortening, rates)), 0.0)
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
        // In the chord's axes, where the sums are simple; of the symmetric matrix the lower half.
        let mut local_mass = [[0.0; WIDTH]; WIDTH];
        let mut local_loads = [0.0; WIDTH];
        for (weight, section) in &self.sections {
            let place = section.place(&modes);
            let (along, across) = section.derivatives(&modes);
            let rate = Vector::new(along.dot(&rates), across.dot(&rates));
            let drift = -spin * spin * place + 2.0 * spin * perp(rate) + section.drift(&rates);
            let turn = perp(place);
            let jacobian = [([1.0, 0.0, turn.x], along, drift.x), ([0.0, 1.0, turn.y], across, drift.y)];
            for (rigid, bent, drift) in jacobian {
                let row: [f64; WIDTH] = std::array::from_fn(|i| if i < 3 { rigid[i] } else { bent[i - 3] });
                for (i, entry) in row.iter().enumerate() {
                    local_loads[i] -= weight * entry * drift;
                    for (sum, other) in local_mass[i].iter_mut().zip(&row[..=i]) {
                        *sum += weight * entry * other;
                    }
                }
            }
        }
        // The origin's two coordinates are along the fixed axes.
        let axes = [Vector::x(), Vector::y()].map(|axis| turned(motion.angle(ROD), axis));
        let coordinate = |i: usize| if i < 3 { 3 * ROD + i } else { RIGID + i - 3 };
        let turned_back = |[along, across]: [f64; 2]| along * axes[0] + across * axes[1];
        let corner = [0, 1].map(|j| turned_back([local_mass[j][0], local_mass[1][j]]));
        let corner = [0, 1].map(|k| turned_back([corner[0][k], corner[1][k]]));
        for i in 0..WIDTH {
            let on_origin = if i < 2 { corner[i] } else { turned_back([local_mass[i][0], local_mass[i][1]]) };
            for k in 0..2 {
                mass[(coordinate(i), coordinate(k))] += on_origin[k];
                if i >= 2 {
                    mass[(coordinate(k), coordinate(i))] += on_origin[k];
                }
            }
            for j in 2..=i {
                mass[(coordinate(i), coordinate(j))] += local_mass[i][j];
                if i != j {
                    mass[(coordinate(j), coordinate(i))] += local_mass[i][j];
                }
            }
        }
        let on_origin = turned_back([local_loads[0], local_loads[1]]);
        for (i, load) in local_loads.iter().enumerate() {
            loads[coordinate(i)] += if i < 2 { on_origin[i] } else { *load };
        }
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
