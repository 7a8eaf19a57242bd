//! A flexible rod's motion does not depend on what it is compiled for: the number of modes and the joints, any of them
//! in larger arrays, or any in numbers with derivatives; nor a step on whether its stages are compiled with it.

use super::chance::Chance;
use super::scenes::{all_plays, contacts, crooked, letters, with_play};
use slidercrank::integrator::method::Attempt;
use slidercrank::integrator::methods::VERNER7;
use slidercrank::integrator::methods::explicit::Explicit;
use slidercrank::integrator::{Method, StepPoint};
use slidercrank::math::Real;
use slidercrank::model::flexible::{Flexible, most_equations, state_count};
use slidercrank::model::plant::Plant;
use slidercrank::model::rod::{Rod, most_functions};
use slidercrank::model::scalar::Tangent;
use slidercrank::model::stages::IN_REGISTERS;
use slidercrank::model::start::StartPose;
use slidercrank::model::state::Contacts;
use slidercrank::scene::{DriveMode, FrictionLaw, Scene};

/// Room for every state.
const N: usize = 64;
type In<const K: usize, const S: usize, const F: usize> = Flexible<N, S, K, F>;
type Few = In<4, { most_equations(4) }, { most_functions(4) }>;
type Many = In<8, { most_equations(8) }, { most_functions(8) }>;
type Most = In<16, { most_equations(16) }, { most_functions(16) }>;

/// A mechanism, and a state of a motion that leaves nothing out.
fn moving<P: Plant>(scene: &Scene, assemble: fn(&Scene, f64, Rod) -> P) -> (P, Vec<f64>, Contacts) {
    let plant = assemble(scene, 0.0, Rod::new(scene).expect("a flexible rod"));
    let positions = plant.extent().positions;
    let mut y = vec![0.0; plant.extent().states];
    plant.write_start(&StartPose::of(scene).expect("the loop closes"), &mut y);
    let mut chance = Chance(5);
    for (i, state) in y.iter_mut().enumerate().take(2 * positions) {
        // Some bearings touch.
        *state += if i < positions { chance.between(-8e-4, 8e-4) } else { chance.between(-2.0, 2.0) };
    }
    let contacts = plant.start_contacts(0.0, &y);
    (plant, y, contacts)
}

/// Its rates, in plain numbers and in those with derivatives, which are put at 0.
fn rates<P: Plant>(scene: &Scene, assemble: fn(&Scene, f64, Rod) -> P) -> [Vec<f64>; 2] {
    let (plant, y, contacts) = moving(scene, assemble);
    let states = y.len();
    let (mut plain, mut tangent) = (vec![0.0; states], vec![Tangent::ZERO; states]);
    plant.rates(&contacts, 0.0, &y, &mut plain);
    let constants: Vec<_> = y.iter().map(|y| Tangent::constant(*y)).collect();
    plant.tangent_rates(&contacts, Tangent::ZERO, &constants, &mut tangent);
    let (mut again, mut events) = (vec![0.0; states], Default::default());
    plant.rates_and_event_functions(&contacts, 0.0, &y, &mut again, &mut events);
    assert_eq!(plain, again, "rates with and without event functions");
    [plain, tangent.iter().map(|rate| rate.value()).collect()]
}

/// The end of a step of that motion, and the step's error.
fn step<P: Plant>(scene: &Scene, assemble: fn(&Scene, f64, Rod) -> P) -> [Vec<f64>; 2] {
    let (plant, y, contacts) = moving(scene, assemble);
    let mut start = StepPoint::new(0.0, &y, contacts);
    plant.rates(&contacts, 0.0, &y, &mut start.rates);
    let (mut end, mut made) = (start.clone(), Attempt::new(y.len()));
    Explicit::new(&VERNER7, y.len()).attempt(&plant, &start, 1e-6, &mut end, &mut made);
    [end.y, made.error]
}

/// The same in arrays that fit, where those fit into registers.
fn fitting_step(scene: &Scene) -> Option<[Vec<f64>; 2]> {
    type Fitting<const N: usize> = Flexible<N, { most_equations(4) }, 4, { most_functions(4) }>;
    let rod = Rod::new(scene).expect("a flexible rod");
    match state_count(scene, &rod) {
        2 => Some(step(scene, Fitting::<2>::assemble)),
        4 => Some(step(scene, Fitting::<4>::assemble)),
        6 => Some(step(scene, Fitting::<6>::assemble)),
        8 => Some(step(scene, Fitting::<8>::assemble)),
        10 => Some(step(scene, Fitting::<10>::assemble)),
        12 => Some(step(scene, Fitting::<12>::assemble)),
        14 => Some(step(scene, Fitting::<14>::assemble)),
        more => {
            assert!(more > IN_REGISTERS, "{more} states");
            None
        }
    }
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
fn a_step_in_arrays_that_fit_has_the_bits_of_one_in_arrays_with_room() {
    let mut compared = 0;
    for (bending, axial) in [(1, 0), (2, 0), (3, 0), (2, 1), (3, 1), (0, 1)] {
        for stiffens in [true, false] {
            for (name, scene) in scenes(bending, axial, stiffens) {
                if let Some(fitting) = fitting_step(&scene) {
                    assert_eq!(fitting, step(&scene, Few::assemble), "{name}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 100, "{compared}");
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
