//! A flexible rod's motion does not depend on what it is compiled for: the number of modes and the joints, any of them
//! in larger arrays, or any in numbers with derivatives.

use super::chance::Chance;
use super::scenes::{all_plays, contacts, crooked, letters, with_play};
use slidercrank::integrator::Extent;
use slidercrank::math::Real;
use slidercrank::model::flexible::{Flexible, most_equations};
use slidercrank::model::plant::Plant;
use slidercrank::model::rod::{Rod, most_functions};
use slidercrank::model::scalar::Tangent;
use slidercrank::model::start::StartPose;
use slidercrank::scene::{DriveMode, FrictionLaw, Scene};

/// Room for every state.
const N: usize = 64;
type In<const K: usize, const S: usize, const F: usize> = Flexible<N, S, K, F>;
type Few = In<4, { most_equations(4) }, { most_functions(4) }>;
type Many = In<8, { most_equations(8) }, { most_functions(8) }>;
type Most = In<16, { most_equations(16) }, { most_functions(16) }>;

/// The rates of a motion that leaves nothing out, in plain numbers and in those with derivatives, which are put at 0.
fn rates<P: Plant<N>>(scene: &Scene, assemble: fn(&Scene, f64, Rod) -> P) -> [Vec<f64>; 2] {
    let plant = assemble(scene, 0.0, Rod::new(scene).expect("a flexible rod"));
    let Extent { positions, states, .. } = plant.extent();
    let mut y = plant.start(&StartPose::of(scene).expect("the loop closes"));
    let mut chance = Chance(5);
    for (i, state) in y.iter_mut().enumerate().take(2 * positions) {
        // Some bearings touch.
        *state += if i < positions { chance.between(-8e-4, 8e-4) } else { chance.between(-2.0, 2.0) };
    }
    let contacts = plant.start_contacts(0.0, &y);
    let (mut plain, mut tangent) = ([0.0; N], [Tangent::ZERO; N]);
    plant.rates(&contacts, 0.0, &y, &mut plain);
    plant.tangent_rates(&contacts, Tangent::ZERO, &y.map(Tangent::constant), &mut tangent);
    let (mut again, mut guards) = ([0.0; N], Default::default());
    plant.rates_and_guards(&contacts, 0.0, &y, &mut again, &mut guards);
    assert_eq!(plain, again, "rates with and without event functions");
    [plain[..states].to_vec(), tangent[..states].iter().map(|rate| rate.value()).collect()]
}

fn scenes(bending: i32, axial: i32, stiffens: bool) -> Vec<(String, Scene)> {
    let of = |drive: DriveMode| {
        all_plays().map(move |play| {
            let mut scene = with_play(crooked(), play);
            let rod = &mut scene.rod.flexible;
            (rod.bending_modes, rod.axial_modes, rod.geometric_stiffness) = (bending, axial, stiffens);
            scene.drive.mode = drive;
            contacts(&mut scene).into_iter().for_each(|contact| contact.friction.law = FrictionLaw::Ambrosio);
            (format!("{} {drive:?}, {bending} + {axial} modes, {stiffens}", letters(play)), scene)
        })
    };
    of(DriveMode::Torque).chain(of(DriveMode::Speed)).collect()
}

/// Largest difference over the largest rate.
fn differ(name: &str, one: &[f64], other: &[f64]) {
    let size = one.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
    assert!(size > 1.0 && one.len() == other.len(), "{name}: {one:?}, {other:?}");
    for (i, (one, other)) in one.iter().zip(other).enumerate() {
        assert!((one - other).abs() < 1e-11 * size, "{name}, rate {i}: {one:e}, {other:e} of {size:e}");
    }
}

#[test]
fn few_modes_move_alike_in_all_arrays() {
    for (bending, axial) in [(1, 0), (2, 0), (3, 0), (4, 0), (1, 1), (2, 1), (3, 1), (2, 2), (0, 1), (1, 3), (0, 4)] {
        for stiffens in [true, false] {
            for (name, scene) in scenes(bending, axial, stiffens) {
                let [few, tangent] = rates(&scene, Few::assemble);
                differ(&name, &few, &tangent);
                differ(&name, &few, &rates(&scene, Many::assemble)[0]);
                differ(&name, &few, &rates(&scene, Most::assemble)[0]);
            }
        }
    }
}

#[test]
fn many_modes_move_alike_in_all_arrays() {
    for (bending, axial) in [(5, 0), (8, 0), (6, 2), (3, 4), (0, 8)] {
        for (name, scene) in scenes(bending, axial, true) {
            let [many, tangent] = rates(&scene, Many::assemble);
            differ(&name, &many, &tangent);
            differ(&name, &many, &rates(&scene, Most::assemble)[0]);
        }
    }
    for (name, scene) in scenes(8, 8, true) {
        let [most, tangent] = rates(&scene, Most::assemble);
        differ(&name, &most, &tangent);
    }
}
