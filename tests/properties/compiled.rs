//! A motion does not depend on what it is compiled for: a constant structure and a flexible rod's number of modes, any of
//! them, any in larger arrays, or any in numbers with derivatives.

use super::chance::Chance;
use super::scenes::{all_plays, contacts, crooked, letters, with_play};
use slidercrank::integrator::{Events, Ode};
use slidercrank::math::Real;
use slidercrank::model::Model;
use slidercrank::model::mechanism_model::MechanismModel;
use slidercrank::model::rod::RodCapacity;
use slidercrank::model::scalar::Tangent;
use slidercrank::model::start::StartPose;
use slidercrank::model::state::Conditions;
use slidercrank::scene::{DriveMode, FrictionLaw, Scene};

/// A state of a motion that leaves nothing out.
fn moving(scene: &Scene, model: &Model) -> (Vec<f64>, Conditions) {
    let positions = model.layout().positions;
    let mut y = vec![0.0; model.layout().states];
    model.write_start(&StartPose::of(scene).expect("the loop closes"), &mut y);
    let mut chance = Chance(5);
    for (i, state) in y.iter_mut().enumerate().take(2 * positions) {
        // Some bearings touch.
        *state += if i < positions { chance.between(-8e-4, 8e-4) } else { chance.between(-2.0, 2.0) };
    }
    let conditions = Conditions::without_inputs(model.start_contacts(0.0, &y));
    (y, conditions)
}

/// Its rates, in plain numbers and in those with derivatives, which are put at 0.
fn rates(scene: &Scene, model: &Model) -> [Vec<f64>; 2] {
    let (y, conditions) = moving(scene, model);
    let states = y.len();
    let (mut plain, mut tangent) = (vec![0.0; states], vec![Tangent::ZERO; states]);
    model.rates(&conditions, 0.0, &y, &mut plain);
    let constants: Vec<_> = y.iter().map(|y| Tangent::constant(*y)).collect();
    model.tangent_rates(&conditions, Tangent::ZERO, &constants, &mut tangent);
    let (mut again, mut events) = (vec![0.0; states], Default::default());
    model.rates_and_event_functions(&conditions, 0.0, &y, &mut again, &mut events);
    assert_eq!(plain, again, "rates with and without event functions");
    [plain, tangent.iter().map(|rate| rate.value()).collect()]
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

/// All numbers, code for every structure, and all rooms that are large enough move `scenes` alike.
fn move_alike(scenes: Vec<(String, Scene)>, rooms: &[RodCapacity]) {
    for (name, scene) in scenes {
        let [own, tangent] = rates(&scene, &Model::assemble(&scene));
        differ(&name, &own, &tangent);
        differ(&name, &own, &rates(&scene, &Model::assemble(&scene).general())[0]);
        for room in rooms {
            let model = Model::assemble(&scene).with_capacity(*room);
            differ(&format!("{name}, {room:?}"), &own, &rates(&scene, &model)[0]);
        }
    }
}

#[test]
fn a_rigid_rod_moves_alike_by_code_of_its_own_structure_and_of_all() {
    let mut scenes = scenes(0, 0, true);
    // A prescribed crank without any play leaves nothing that moves by itself.
    scenes.retain(|(_, scene)| Model::assemble(scene).layout().states > 0);
    move_alike(scenes, &[]);
}

#[test]
fn few_modes_move_alike_in_all_arrays() {
    for (bending, axial) in [(1, 0), (2, 0), (3, 0), (4, 0), (1, 1), (2, 1), (3, 1), (2, 2), (0, 1), (1, 3), (0, 4)] {
        for stiffens in [true, false] {
            move_alike(scenes(bending, axial, stiffens), &[RodCapacity::Many, RodCapacity::All]);
        }
    }
}

#[test]
fn many_modes_move_alike_in_all_arrays() {
    for (bending, axial) in [(5, 0), (8, 0), (6, 2), (3, 4), (0, 8)] {
        move_alike(scenes(bending, axial, true), &[RodCapacity::All]);
    }
    move_alike(scenes(8, 8, true), &[]);
}
