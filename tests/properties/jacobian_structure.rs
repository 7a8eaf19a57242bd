//! What a Jacobian must be by its nature: invariant under motions of the whole, finite where laws have
//! corners, symmetric in its stiffness, and good for Newton's method.

use super::chance::Chance;
use super::scenes::{at, contacts, crooked, elastic, inputs, revolutes, start, with_play};
use nalgebra::{DMatrix, DVector};
use slidercrank::integrator::{Jacobian, Linearizable, Ode};
use slidercrank::math::Real;
use slidercrank::model::Model;
use slidercrank::model::contact::ContactState;
use slidercrank::model::mechanism_model::MechanismModel;
use slidercrank::model::scalar::Tangent;
use slidercrank::model::start::StartPose;
use slidercrank::model::state::Conditions;
use slidercrank::scene::{FrictionLaw, Scene};
use slidercrank::simulation::Simulation;

const N: usize = 18;
/// Positions: x, y of three roots and three angles.
const P: usize = N / 2;

/// Everything has clearance.
type Loose = Model;

/// Three bodies that touch each other at crank pin and slider pin alone: state and contacts.
fn afloat(chance: &mut Chance, law: FrictionLaw) -> (Loose, [f64; N], Conditions) {
    let mut scene = with_play(crooked(), [true; 4]);
    scene.gravity = 0.0;
    for joint in revolutes(&mut scene) {
        joint.clearance = 1e-4;
    }
    for contact in contacts(&mut scene) {
        contact.friction.law = law;
    }
    let model = Loose::assemble(&scene);
    let mut y = [0.0; N];
    model.write_start(&StartPose::of(&scene).expect("the loop closes"), &mut y);
    // Rod and slider each a play and a penetration off, in any direction.
    for root in [2, 4] {
        let (angle, way) = (chance.between(0.0, 6.3), 1e-4 + chance.between(1e-6, 8e-6));
        y[root] += way * angle.cos();
        y[root + 1] += way * angle.sin();
    }
    for rate in &mut y[P..] {
        *rate += chance.between(-0.3, 0.3);
    }
    let mut conditions = Conditions::default();
    for contact in &mut conditions.contacts[1..3] {
        *contact = ContactState::closing(0.2, 1e-3);
    }
    (model, y, conditions)
}

/// ∂ẏ along `direction`.
fn along(jacobian: &Jacobian, direction: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| jacobian.row(i).iter().zip(direction).map(|(slope, by)| slope * by).sum())
}

fn near(name: &str, found: &[f64], wanted: &[f64], size: f64) {
    for (i, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        assert!((found - wanted).abs() < size, "{name}, {i}: {found:e} is not {wanted:e}, ± {size:e}");
    }
}

#[test]
fn moving_turning_and_boosting_the_whole_changes_no_force() {
    let mut chance = Chance(11);
    for law in [FrictionLaw::None, FrictionLaw::Ambrosio, FrictionLaw::Stribeck] {
        for _ in 0..50 {
            let (model, y, conditions) = afloat(&mut chance, law);
            let (mut jacobian, mut rates) = (Jacobian::new(N), [0.0; N]);
            model.jacobian(&conditions, 0.0, &y, &mut jacobian);
            model.rates(&conditions, 0.0, &y, &mut rates);
            // Rounding: of sums of the rows' terms.
            let row = |i: usize| jacobian.row(i).iter().map(|slope| slope.abs()).sum::<f64>();
            let size = 1e-14 * (0..N).map(row).fold(0.0, f64::max);
            for axis in 0..2 {
                let shift = |offset: usize| {
                    std::array::from_fn(|k| f64::from(k >= offset && k < offset + 6 && (k - offset) % 2 == axis))
                };
                near("shift", &along(&jacobian, &shift(0)), &[0.0; N], size);
                near("boost", &along(&jacobian, &shift(P)), &shift(0), size);
            }
            // Turned by dφ: roots and their rates by perp, angles by one, angular speeds not at all.
            let turned = |list: &[f64; N], angle: f64| -> [f64; N] {
                std::array::from_fn(|k| match k % P {
                    place @ 0..6 if place % 2 == 0 => -list[k + 1],
                    0..6 => list[k - 1],
                    _ if k < P => angle,
                    _ => 0.0,
                })
            };
            near("turn", &along(&jacobian, &turned(&y, 1.0)), &turned(&rates, 0.0), size);
            assert!(jacobian.time.iter().all(|slope| *slope == 0.0));
            assert!(size > 1e-9, "the bodies touch");
        }
    }
}

#[test]
fn values_beside_derivatives_have_the_bits_of_the_rates() {
    let mut chance = Chance(12);
    for law in [FrictionLaw::None, FrictionLaw::Ambrosio, FrictionLaw::Tanh, FrictionLaw::Stribeck] {
        for _ in 0..50 {
            let (model, y, conditions) = afloat(&mut chance, law);
            let (mut rates, mut found) = ([0.0; N], [Tangent::ZERO; N]);
            model.rates(&conditions, 0.1, &y, &mut rates);
            model.tangent_rates(&conditions, Tangent::constant(0.1), &y.map(Tangent::constant), &mut found);
            assert_eq!(found.map(|rate| rate.value.to_bits()), rates.map(f64::to_bits));
            assert!(found.iter().all(|rate| rate.slope.iter().all(|slope| *slope == 0.0)));
        }
    }
}

#[test]
fn it_is_finite_where_journals_are_centred_and_contacts_just_touch() {
    for law in [FrictionLaw::None, FrictionLaw::Ambrosio, FrictionLaw::Tanh, FrictionLaw::Stribeck, FrictionLaw::Lugre]
    {
        let mut scene = with_play(crooked(), [true; 4]);
        for contact in contacts(&mut scene) {
            contact.friction.law = law;
        }
        let model = Model::assemble(&scene);
        let n = model.layout().states;
        let mut centred = vec![0.0; n];
        model.write_start(&StartPose::of(&scene).expect("the loop closes"), &mut centred);
        let mut touching = centred.clone();
        touching[1] = scene.joint.a.clearance; // exactly, in the main bearing: roots are centres of mass
        for y in [centred, touching] {
            let mut jacobian = Jacobian::new(n);
            model.jacobian(&Conditions::without_inputs([ContactState::closing(0.1, 1e-3); 7]), 0.0, &y, &mut jacobian);
            let rows = (0..n).flat_map(|i| jacobian.row(i));
            assert!(rows.chain(&jacobian.time).all(|slope| slope.is_finite()), "{law:?}");
        }
    }
}

/// Held by a torque against a load, elastic, without friction or damping, gravity off.
fn conservative() -> Scene {
    let mut scene = elastic(with_play(crooked(), [false, false, true, false]));
    (scene.gravity, scene.crank.speed_start) = (0.0, 3.0);
    (scene.joint.c.clearance, scene.joint.c.contact.stiffness) = (1e-4, 1e9);
    scene
}

/// The simulation when its pin has found its bearing, or lost it.
fn in_contact(simulation: &mut Simulation, t: f64) {
    for k in 0..2000 {
        if at(simulation, t + 1e-5 * f64::from(k)).joint_c.contact {
            return;
        }
    }
    unreachable!("the pin touches its bearing");
}

/// Jacobian of the accelerations by positions, and the accelerations.
fn stiffness(simulation: &Simulation, q: &DVector<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let n = q.len();
    let mut y = q.as_slice().to_vec();
    y.resize(2 * n, 0.0);
    let line = simulation.linearization_at(0.0, &y);
    let matrix = DMatrix::from_fn(n, n, |i, j| line.by_state[n + i][j]);
    (matrix, DVector::from_fn(n, |i, _| line.rates[n + i]))
}

#[test]
fn newton_finds_the_equilibrium_squared_and_its_stiffness_is_symmetric() {
    // Coordinates: the pin's x, the angles of crank and rod.
    let scene = conservative();
    let (torque, load) = (-2.0, -60.0);
    let mut simulation = start(&scene, inputs(torque, load));
    in_contact(&mut simulation, 0.001);
    let mut q = DVector::from_column_slice(&simulation.front().1[..3]);
    let first = stiffness(&simulation, &q).1.norm();
    let mut whole = vec![];
    for _ in 0..2000 {
        let (matrix, rates) = stiffness(&simulation, &q);
        let step = matrix.lu().solve(&rates).expect("regular");
        let longest = step.amax();
        if longest < 1e-3 {
            whole.push(rates.norm() / first);
        }
        if whole.len() == 6 {
            break;
        }
        q -= if longest < 1e-3 { step } else { step * (1e-3 / longest) };
    }
    println!("{whole:?}");
    let (matrix, rest) = stiffness(&simulation, &q);
    assert!(rest.norm() < 1e-10 * first, "{rest} at {q}");
    // M⁻¹ times the generalized forces of load (x) and torque (crank's angle), by superposition.
    let answer = |torque_by: f64, load_by: f64| {
        let other = start(&scene, inputs(torque + torque_by, load + load_by));
        let mut other = other;
        in_contact(&mut other, 0.001);
        stiffness(&other, &q).1 - &rest
    };
    let (by_load, by_torque) = (answer(0.0, 1.0), answer(1.0, 0.0));
    // K = −M·A is symmetric, so that A·M⁻¹ and its powers are: Maxwell and Betti.
    let (mut a, mut b) = (by_load, by_torque);
    for power in 1..4 {
        (a, b) = (&matrix * a, &matrix * b);
        let (one, other) = (a[1], b[0]);
        assert!((one - other).abs() < 1e-9 * one.abs(), "power {power}: {one:e} and {other:e}");
    }
}
