//! The slider crank of the test set for initial value problem solvers (B. Simeon 1996, as problem II-20
//! of F. Mazzia, C. Magherini's set): flexible rod, ideal joints, crank at 150 rad/s.
//!
//! Its rod has two sine states in bending and one quadratic element along its axis. The printed model's
//! axial mass block lacks the element's factor 1/15; both are run here. It knows no foreshortening.

use slidercrank::integrator::methods::named;
use slidercrank::integrator::{Integrator, Settings, WorkLimit};
use slidercrank::model::Model;
use slidercrank::model::mechanism_model::MechanismModel;
use slidercrank::model::state::{Conditions, Evaluation};
use slidercrank::scene::modal::{AxialMode, BendingMode, ModalTable};
use slidercrank::scene::{DriveMode, Scene};
use std::f64::consts::PI;

const LENGTH: f64 = 0.3;
const MASS: f64 = 0.151104;
const SIDE: f64 = 0.008;
const YOUNG: f64 = 0.2e12;
const SPEED: f64 = 150.0;
/// The printed inertia about the rod's pin, the cross-section's included.
const INERTIA: f64 = 0.004_533_925_9;

/// ∫₀¹ f ds by Simpson's rule on a fine grid.
fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let n = 2000;
    let term = |i: i32| f64::from(if i % n == 0 { 1 } else { 2 + 2 * (i % 2) }) * f(f64::from(i) / f64::from(n));
    (0..=n).map(term).sum::<f64>() / f64::from(3 * n)
}

/// Shapes of the quadratic element with nodes at the middle and the far end.
fn nodes(s: f64) -> [f64; 2] {
    [4.0 * s * (1.0 - s), s * (2.0 * s - 1.0)]
}

/// Modes (frequency, amplitudes of the nodes with Φᵀ·M·Φ = 1) of a pair of symmetric matrices.
fn states(k: [[f64; 2]; 2], m: [[f64; 2]; 2]) -> [(f64, [f64; 2]); 2] {
    let det = |a: [[f64; 2]; 2]| a[0][0] * a[1][1] - a[0][1] * a[1][0];
    let mixed = k[0][0] * m[1][1] + k[1][1] * m[0][0] - 2.0 * k[0][1] * m[0][1];
    let root = (mixed * mixed - 4.0 * det(k) * det(m)).sqrt();
    [-1.0, 1.0].map(|sign| {
        let square = (mixed + sign * root) / (2.0 * det(m));
        let v = [k[0][1] - square * m[0][1], square * m[0][0] - k[0][0]];
        let norm = (v[0] * v[0] * m[0][0] + 2.0 * v[0] * v[1] * m[0][1] + v[1] * v[1] * m[1][1]).sqrt();
        (square.sqrt(), v.map(|x| x / norm))
    })
}

/// The rod's table, the axial mass block multiplied by `factor`, and the axial states' nodes.
fn table(factor: f64) -> (ModalTable, [[f64; 2]; 2]) {
    let stiffness = YOUNG * SIDE * SIDE / (3.0 * LENGTH);
    let k = [[16.0 * stiffness, -8.0 * stiffness], [-8.0 * stiffness, 7.0 * stiffness]];
    let share = factor * MASS / 15.0;
    let m = [[8.0 * share, share], [share, 2.0 * share]];
    let axial = states(k, m);
    let shape = |j: usize, s: f64| axial[j].1[0] * nodes(s)[0] + axial[j].1[1] * nodes(s)[1];
    let sine = |i: usize, s: f64| ((i + 1) as f64 * PI * s).sin();
    let bending = [0, 1].map(|i| {
        let wave = (i + 1) as f64 * PI / LENGTH;
        BendingMode {
            frequency: wave * wave * (YOUNG * SIDE.powi(4) / 12.0 * LENGTH / MASS).sqrt(),
            mass: 0.5 * MASS,
            moment: MASS * integral(|s| sine(i, s)),
            middle: [1.0, 0.0][i],
            slope_start: wave,
            slope_end: [-wave, wave][i],
        }
    });
    let along = |k: usize, s: f64| if k == 0 { s * LENGTH } else { shape(k - 1, s) };
    let zeros = || vec![0.0; 6];
    let mut second: Vec<Vec<f64>> = (0..6).map(|_| zeros()).collect();
    second[0][0] = INERTIA;
    for j in 0..2 {
        second[1 + j][1 + j] = 1.0;
        let lever = MASS * integral(|s| along(0, s) * shape(j, s));
        (second[0][1 + j], second[1 + j][0]) = (lever, lever);
    }
    let mut coupling: Vec<Vec<f64>> =
        (0..3).map(|k| (0..2).map(|i| MASS * integral(|s| along(k, s) * sine(i, s))).collect()).collect();
    coupling.extend([vec![0.0; 2], vec![0.0; 2], vec![0.0; 2]]);
    let mut first: Vec<f64> = (0..3).map(|k| MASS * integral(|s| along(k, s))).collect();
    first.extend([0.0; 3]);
    let table = ModalTable {
        mass: MASS,
        bending: bending.to_vec(),
        axial: axial
            .iter()
            .map(|(frequency, nodes)| AxialMode { frequency: *frequency, mass: 1.0, end: nodes[1] })
            .collect(),
        shortening: vec![0.0; 3],
        first,
        second,
        coupling,
    };
    (table, axial.map(|(_, nodes)| nodes))
}

/// Amplitudes of the states at given nodes.
fn amplitudes(states: [[f64; 2]; 2], nodes: [f64; 2]) -> [f64; 2] {
    let [[a, c], [b, d]] = states;
    let det = a * d - b * c;
    [(nodes[0] * d - b * nodes[1]) / det, (a * nodes[1] - c * nodes[0]) / det]
}

/// The mechanism at 0.1 s, and q1 to q4.
fn at_the_end(factor: f64) -> (Evaluation, [f64; 4]) {
    let (table, nodes) = table(factor);
    let mut scene = Scene::default();
    scene.drive.mode = DriveMode::Speed;
    (scene.crank.length, scene.crank.mass, scene.crank.inertia) = (0.15, 0.36, 0.002727);
    (scene.crank.speed_start, scene.slider.mass, scene.rod.length) = (SPEED, 0.075552, LENGTH);
    let f = &mut scene.rod.flexible;
    (f.bending_modes, f.axial_modes, f.damping_ratio, f.geometric_stiffness) = (2, 2, 0.0, false);
    f.table = Some(table);
    let model = Model::assemble(&scene);
    // Positions and rates of the set's initial state.
    let [a, b] = amplitudes(nodes, [0.103339863e-4, 0.169327969e-4]);
    let [c, d] = amplitudes(nodes, [-0.178591076e-5, -0.268938672e-5]);
    let y = [0.0, 0.0, a, b, 0.444896105, 0.463434311e-2, c, d];
    let conditions = Conditions::without_inputs(model.start_contacts(0.0, &y));
    let settings = Settings { tolerance: 1e-9, fixed_step: 0.0, effort: WorkLimit::ANY };
    let mut integrator =
        Integrator::start(&model, named("verner7", 8).expect("a method"), settings, 0.0, &y, conditions);
    integrator.advance(&model, 0.1).expect("no trouble");
    let (y, conditions) = integrator.state_at(&model, 0.1);
    let node = |k: usize| y[2] * nodes[0][k] + y[3] * nodes[1][k];
    (model.evaluation(&conditions, 0.1, y), [y[0], y[1], node(0), node(1)])
}

fn relative(found: f64, wanted: f64) -> f64 {
    (found / wanted - 1.0).abs()
}

#[test]
fn the_printed_model_reaches_its_reference() {
    let (instant, q) = at_the_end(15.0);
    let pose = &instant.pose;
    println!("{q:?} {} {}", pose.rotations.angle[1], pose.place.pin.x);
    assert!(relative(pose.rotations.angle[1], -0.331_173_498_791) < 1e-8);
    assert!(relative(pose.place.pin.x, 0.169_737_332_663) < 1e-8);
    assert!(relative(pose.rotations.speed[1], 60.253_466_83) < 1e-6);
    assert!(relative(pose.velocity.pin.x, -8.753_116_990) < 1e-6);
    for (found, wanted) in q.into_iter().zip([1.893192460e-4, 2.375751866e-5, -5.323907989e-6, -8.363283142e-6]) {
        assert!(relative(found, wanted) < 1e-5, "{found:e} is not {wanted:e}");
    }
}

#[test]
fn with_the_element_s_own_mass_the_slider_is_where_a_correct_model_has_it() {
    let (instant, q) = at_the_end(1.0);
    println!("{q:?} {}", instant.pose.place.pin.x);
    assert!(relative(instant.pose.place.pin.x, 0.169_737_396) < 1e-8);
    assert!(relative(q[0], 1.89308e-4) < 1e-5);
}
