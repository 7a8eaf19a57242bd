//! A beam of finite elements as a modal table: it must move as the built-in beam does.
//!
//! Hermite elements in bending and quadratic ones along the axis know nothing of sines: the table that
//! they export is the shipped example, `fmu-harness/scenes/modes/steel-beam.toml`.

use nalgebra::{DMatrix, SymmetricEigen};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::modal::{AxialMode, BendingMode, ModalTable};
use slidercrank::scene::write::write_table;
use slidercrank::scene::{DriveMode, JointModel, Scene};
use slidercrank::simulation::Simulation;
use std::path::Path;

/// Elements of equal length.
const ELEMENTS: usize = 48;
const BENDING: usize = 3;
const AXIAL: usize = 2;
/// Gauss's points and weights on (0, 1).
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_4, 0.239_314_335_249_683_2),
    (0.5, 0.284_444_444_444_444_4),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_2),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// Hermite's cubics over an element of length `h` at the share `s`: values, slopes and curvatures.
fn hermite(s: f64, h: f64) -> [[f64; 4]; 3] {
    let (s2, s3) = (s * s, s * s * s);
    [
        [1.0 - 3.0 * s2 + 2.0 * s3, h * (s - 2.0 * s2 + s3), 3.0 * s2 - 2.0 * s3, h * (s3 - s2)],
        [6.0 * (s2 - s) / h, 1.0 - 4.0 * s + 3.0 * s2, 6.0 * (s - s2) / h, 3.0 * s2 - 2.0 * s],
        [(12.0 * s - 6.0) / (h * h), (6.0 * s - 4.0) / h, (6.0 - 12.0 * s) / (h * h), (6.0 * s - 2.0) / h],
    ]
}

/// Quadratic shapes with nodes at both ends and the middle: values and slopes.
fn quadratic(s: f64, h: f64) -> [[f64; 3]; 2] {
    [
        [(1.0 - s) * (1.0 - 2.0 * s), 4.0 * s * (1.0 - s), s * (2.0 * s - 1.0)],
        [(4.0 * s - 3.0) / h, (4.0 - 8.0 * s) / h, (4.0 * s - 1.0) / h],
    ]
}

/// Frequencies and shapes of K·v = ω²·M·v with some degrees of freedom held.
fn lowest(k: &DMatrix<f64>, m: &DMatrix<f64>, held: &[usize], count: usize) -> Vec<(f64, Vec<f64>)> {
    let free: Vec<usize> = (0..k.nrows()).filter(|i| !held.contains(i)).collect();
    let reduced = |a: &DMatrix<f64>| DMatrix::from_fn(free.len(), free.len(), |i, j| a[(free[i], free[j])]);
    let lower = reduced(m).cholesky().expect("a positive mass").l();
    let inverse = lower.clone().try_inverse().expect("a regular factor");
    let eigen = SymmetricEigen::new(&inverse * reduced(k) * inverse.transpose());
    let mut order: Vec<usize> = (0..free.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let shape = |mode: usize| {
        let v = inverse.transpose() * eigen.eigenvectors.column(mode);
        let v = v.clone() * v[0].signum(); // a mode's sign is a matter of taste
        let mut full = vec![0.0; k.nrows()];
        free.iter().zip(v.iter()).for_each(|(place, value)| full[*place] = *value);
        full
    };
    order[..count].iter().map(|&mode| (eigen.eigenvalues[mode].sqrt(), shape(mode))).collect()
}

/// The beam in elements.
struct Mesh {
    /// [m] Of an element.
    h: f64,
    /// [kg/m]
    line: f64,
    bending: Vec<(f64, Vec<f64>)>,
    axial: Vec<(f64, Vec<f64>)>,
}

impl Mesh {
    fn of(scene: &Scene) -> Self {
        let f = &scene.rod.flexible;
        let (h, line) = (scene.rod.length / ELEMENTS as f64, f.density * f.area);
        let (nodes, points) = (2 * (ELEMENTS + 1), 2 * ELEMENTS + 1);
        let zeros = |n: usize| DMatrix::<f64>::zeros(n, n);
        let (mut kb, mut mb, mut ka, mut ma) = (zeros(nodes), zeros(nodes), zeros(points), zeros(points));
        for element in 0..ELEMENTS {
            for (s, weight) in GAUSS {
                let [w, _, curvature] = hermite(s, h);
                let [u, strain] = quadratic(s, h);
                for i in 0..4 {
                    for j in 0..4 {
                        let at = (2 * element + i, 2 * element + j);
                        kb[at] += weight * h * f.young * f.second_moment * curvature[i] * curvature[j];
                        mb[at] += weight * h * line * w[i] * w[j];
                    }
                }
                for i in 0..3 {
                    for j in 0..3 {
                        let at = (2 * element + i, 2 * element + j);
                        ka[at] += weight * h * f.young * f.area * strain[i] * strain[j];
                        ma[at] += weight * h * line * u[i] * u[j];
                    }
                }
            }
        }
        // Pinned at both ends; held along the axis at the big end.
        let bending = lowest(&kb, &mb, &[0, nodes - 2], BENDING);
        let axial = lowest(&ka, &ma, &[0], AXIAL);
        Self { h, line, bending, axial }
    }

    /// φ, φ' of a bending mode in an element.
    fn bent(&self, mode: usize, element: usize, s: f64) -> (f64, f64) {
        let [w, slope, _] = hermite(s, self.h);
        let nodes = &self.bending[mode].1[2 * element..2 * element + 4];
        let sum = |shape: [f64; 4]| shape.iter().zip(nodes).map(|(a, b)| a * b).sum::<f64>();
        (sum(w), sum(slope))
    }

    /// ψ of an axial mode in an element.
    fn stretched(&self, mode: usize, element: usize, s: f64) -> f64 {
        let nodes = &self.axial[mode].1[2 * element..2 * element + 3];
        quadratic(s, self.h)[0].iter().zip(nodes).map(|(a, b)| a * b).sum()
    }

    /// ½∫φ_i'·φ_j' over the share 0 to `s` of an element.
    fn shortened(&self, (i, j): (usize, usize), element: usize, s: f64) -> f64 {
        let at = |x: f64| self.bent(i, element, s * x).1 * self.bent(j, element, s * x).1;
        0.5 * s * self.h * GAUSS.iter().map(|(x, weight)| weight * at(*x)).sum::<f64>()
    }

    fn table(&self) -> ModalTable {
        let pairs: Vec<(usize, usize)> = (0..BENDING).flat_map(|i| (i..BENDING).map(move |j| (i, j))).collect();
        let count = 1 + AXIAL + pairs.len();
        let mut shortening = vec![0.0; pairs.len()];
        let mut first = vec![0.0; count];
        let mut second = vec![vec![0.0; count]; count];
        let mut coupling = vec![vec![0.0; BENDING]; count];
        let mut moment = [0.0; BENDING];
        let mut mass = [0.0; BENDING];
        for element in 0..ELEMENTS {
            for (s, weight) in GAUSS {
                let dm = weight * self.h * self.line;
                let phi: Vec<f64> = (0..BENDING).map(|i| self.bent(i, element, s).0).collect();
                let mut b = vec![(element as f64 + s) * self.h];
                b.extend((0..AXIAL).map(|j| self.stretched(j, element, s)));
                b.extend(
                    pairs.iter().zip(&shortening).map(|(pair, so_far)| so_far + self.shortened(*pair, element, s)),
                );
                for i in 0..BENDING {
                    moment[i] += dm * phi[i];
                    mass[i] += dm * phi[i] * phi[i];
                }
                for k in 0..count {
                    first[k] += dm * b[k];
                    (0..count).for_each(|l| second[k][l] += dm * b[k] * b[l]);
                    (0..BENDING).for_each(|i| coupling[k][i] += dm * b[k] * phi[i]);
                }
            }
            for (sum, pair) in shortening.iter_mut().zip(&pairs) {
                *sum += self.shortened(*pair, element, 1.0);
            }
        }
        let end = ELEMENTS - 1;
        let bending = (0..BENDING).map(|i| BendingMode {
            frequency: self.bending[i].0,
            mass: mass[i],
            moment: moment[i],
            middle: self.bent(i, ELEMENTS / 2, 0.0).0,
            slope_start: self.bent(i, 0, 0.0).1,
            slope_end: self.bent(i, end, 1.0).1,
        });
        let axial = (0..AXIAL).map(|j| AxialMode {
            frequency: self.axial[j].0,
            mass: second[1 + j][1 + j],
            end: self.stretched(j, end, 1.0),
        });
        let mass = self.line * self.h * ELEMENTS as f64;
        ModalTable { mass, bending: bending.collect(), axial: axial.collect(), shortening, first, second, coupling }
    }
}

/// Clearance at the slider pin, a rod soft enough to bend visibly.
fn mechanism() -> Scene {
    let mut scene = Scene::default();
    (scene.drive.mode, scene.crank.speed_start, scene.crank.angle_start) = (DriveMode::Speed, 300.0, 0.7);
    (scene.joint.c.model, scene.joint.c.clearance) = (JointModel::Clearance, 1e-4);
    let rod = &mut scene.rod.flexible;
    (rod.bending_modes, rod.axial_modes) = (BENDING as i32, AXIAL as i32);
    scene.solver.tolerance = 1e-9;
    scene
}

#[test]
fn a_table_of_finite_elements_moves_as_the_built_in_beam() {
    let built_in = mechanism();
    let mut exported = built_in.clone();
    exported.rod.flexible.table = Some(Mesh::of(&built_in).table());
    exported.check().expect("a legal table");
    let mut runs = [&built_in, &exported].map(|scene| Simulation::start(scene, Inputs::default()).expect("closes"));
    let (mut error, mut most, mut stretch) = (0.0f64, 0.0f64, 0.0f64);
    for i in 1..=100 {
        let outputs = runs.each_mut().map(|run| {
            run.advance_to(1e-5 * f64::from(i)).expect("no trouble");
            run.outputs()
        });
        let difference =
            |of: &dyn Fn(&slidercrank::model::signals::Outputs) -> f64| (of(&outputs[0]) - of(&outputs[1])).abs();
        error = error.max(difference(&|o| o.rod.deflection)).max(difference(&|o| o.rod.stretch));
        error = error.max(difference(&|o| o.joint_c.eccentricity[0])).max(difference(&|o| o.joint_c.eccentricity[1]));
        most = most.max(outputs[0].rod.deflection.abs());
        stretch = stretch.max(outputs[0].rod.stretch.abs());
    }
    let events = runs[0].outputs().solver.events;
    println!("{events} events, deflection {most:.1e} m, stretch {stretch:.1e} m, difference {error:.1e} m");
    assert!(events > 1 && most > 1e-6 && stretch > 1e-8);
    // 48 elements: frequencies are good to (π·3/48)⁴/720 of themselves.
    assert!(error < 1e-4 * most, "{error:e} of {most:e}");
}

#[test]
fn the_shipped_example_is_what_the_elements_export() {
    let text = write_table(&Mesh::of(&mechanism()).table());
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fmu-harness/scenes/modes/steel-beam.toml");
    if std::env::var_os("WRITE_EXAMPLE").is_some() {
        std::fs::create_dir_all(file.parent().expect("a directory")).expect("a place to write");
        std::fs::write(&file, &text).expect("the example is written");
    }
    let shipped = std::fs::read_to_string(&file).expect("the shipped example");
    let numbers = |text: &str| -> Vec<f64> {
        let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c)));
        words.filter(|word| word.contains('.') || word.contains('e')).filter_map(|word| word.parse().ok()).collect()
    };
    let (shipped, exported) = (numbers(&shipped), numbers(&text));
    assert_eq!(shipped.len(), exported.len());
    for (a, b) in shipped.iter().zip(&exported) {
        assert!((a - b).abs() < 1e-6 * b.abs() + 1e-12, "{a} is not {b}");
    }
}
