//! The modal table of a uniform beam: the exact modes of the simply supported beam in bending, φ_i = sin(iπx/l), and of
//! the fixed-free bar along its axis, ψ_j = sin((2j − 1)πx/(2l)).
//!
//! With S_m(x) = sin(mπx/l)·l/(mπ) and S_0(x) = x, the foreshortening of two bending modes is Γ_ij =
//! ¼·ij·(π/l)²·(S_|i−j| + S_(i+j)), so that every integral is one of a product of sines.

use crate::scene::modal::{AxialMode, BendingMode, ModalTable, pairs};
use crate::scene::{Flexible, Scene};
use std::f64::consts::PI;

/// A function of x for which integrals of products have a closed form.
#[derive(Clone, Copy)]
enum Shape {
    /// S_m.
    Sine(usize),
    /// ψ_j.
    Axial(usize),
}

/// −1 to the power of `n`.
fn sign(n: usize) -> f64 {
    if n.is_multiple_of(2) { 1.0 } else { -1.0 }
}

struct Beam {
    length: f64,
}

impl Beam {
    /// Wave number (2j − 1)π/(2l).
    fn axial(&self, j: usize) -> f64 {
        (2.0 * j as f64 - 1.0) * PI / (2.0 * self.length)
    }

    /// Wave number mπ/l.
    fn bending(&self, m: usize) -> f64 {
        m as f64 * PI / self.length
    }

    /// ∫ shape dx.
    fn integral(&self, shape: Shape) -> f64 {
        match shape {
            Shape::Sine(0) => 0.5 * self.length * self.length,
            Shape::Sine(m) => (1.0 - sign(m)) / self.bending(m).powi(2),
            Shape::Axial(j) => 1.0 / self.axial(j),
        }
    }

    /// ∫ a·b dx.
    fn product(&self, a: Shape, b: Shape) -> f64 {
        let l = self.length;
        match (a, b) {
            (Shape::Sine(0), Shape::Sine(0)) => l * l * l / 3.0,
            (Shape::Sine(0), Shape::Sine(m)) | (Shape::Sine(m), Shape::Sine(0)) => {
                -sign(m) * l / self.bending(m).powi(2)
            }
            (Shape::Sine(m), Shape::Sine(k)) if m == k => 0.5 * l / self.bending(m).powi(2),
            (Shape::Sine(_), Shape::Sine(_)) => 0.0,
            (Shape::Axial(j), Shape::Axial(k)) => {
                if j == k {
                    0.5 * l
                } else {
                    0.0
                }
            }
            (Shape::Sine(0), Shape::Axial(j)) | (Shape::Axial(j), Shape::Sine(0)) => -sign(j) / self.axial(j).powi(2),
            (Shape::Sine(m), Shape::Axial(j)) | (Shape::Axial(j), Shape::Sine(m)) => {
                let (a, b) = (self.axial(j), self.bending(m));
                -sign(j + m) / ((a - b) * (a + b))
            }
        }
    }

    /// ∫ a·φ_i dx.
    fn with_mode(&self, a: Shape, i: usize) -> f64 {
        self.bending(i) * self.product(a, Shape::Sine(i))
    }
}

/// The functions along x of the modal table, each a weighted sum of shapes.
fn functions(beam: &Beam, bending: usize, axial: usize) -> Vec<Vec<(f64, Shape)>> {
    let mut all = vec![vec![(1.0, Shape::Sine(0))]];
    all.extend((1..=axial).map(|j| vec![(1.0, Shape::Axial(j))]));
    for i in 1..=bending {
        for j in i..=bending {
            let weight = 0.25 * beam.bending(i) * beam.bending(j);
            all.push(vec![(weight, Shape::Sine(j - i)), (weight, Shape::Sine(i + j))]);
        }
    }
    all
}

/// The modal table of the scene's beam with its numbers of modes.
pub fn table(scene: &Scene) -> ModalTable {
    let length = scene.rod.length;
    let Flexible { bending_modes, axial_modes, young, density, area, second_moment, .. } = scene.rod.flexible;
    let count = |modes: i32| usize::try_from(modes).unwrap_or(0);
    let (bending, axial) = (count(bending_modes), count(axial_modes));
    let beam = Beam { length };
    let line = density * area;
    let functions = functions(&beam, bending, axial);
    let sum = |terms: &[(f64, Shape)], integral: &dyn Fn(Shape) -> f64| -> f64 {
        line * terms.iter().map(|(weight, shape)| weight * integral(*shape)).sum::<f64>()
    };
    ModalTable {
        mass: line * length,
        bending: (1..=bending)
            .map(|i| {
                let wave = beam.bending(i);
                BendingMode {
                    frequency: wave * wave * (young * second_moment / line).sqrt(),
                    mass: 0.5 * line * length,
                    moment: line * (1.0 - sign(i)) / wave,
                    middle: [0.0, 1.0, 0.0, -1.0][i % 4],
                    slope_start: wave,
                    slope_end: sign(i) * wave,
                }
            })
            .collect(),
        axial: (1..=axial)
            .map(|j| AxialMode {
                frequency: beam.axial(j) * (young / density).sqrt(),
                mass: 0.5 * line * length,
                end: -sign(j),
            })
            .collect(),
        shortening: (1..=bending)
            .flat_map(|i| (i..=bending).map(move |j| (i, j)))
            .map(|(i, j)| if i == j { 0.25 * beam.bending(i).powi(2) * length } else { 0.0 })
            .collect(),
        first: functions.iter().map(|f| sum(f, &|shape| beam.integral(shape))).collect(),
        second: functions
            .iter()
            .map(|f| functions.iter().map(|g| sum(f, &|a| sum(g, &|b| beam.product(a, b)) / line)).collect())
            .collect(),
        coupling: functions
            .iter()
            .map(|f| (1..=bending).map(|i| sum(f, &|shape| beam.with_mode(shape, i))).collect())
            .collect(),
    }
}

/// Number of functions along x in a table with these numbers of modes.
pub fn function_count(bending: usize, axial: usize) -> usize {
    1 + axial + pairs(bending)
}
