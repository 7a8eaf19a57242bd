//! The rates of eight states together are to the bit those of each alone: for joints, laws and rods of every kind, in
//! contacts that touch and that do not.

use super::chance::Chance;
use super::scenes::{Play, all_plays, contacts, crooked, letters, revolutes, with_play};
use slidercrank::integrator::SeveralInstants;
use slidercrank::integrator::system::{Ode, one_by_one};
use slidercrank::math::{F64x8, ROW, Real};
use slidercrank::model::Model;
use slidercrank::model::mechanism_model::MechanismModel;
use slidercrank::model::start::StartPose;
use slidercrank::model::state::Conditions;
use slidercrank::scene::{DampingLaw, DriveMode, Elasticity, FrictionLaw, Scene, Surface};

/// States that the model may be in, with the contacts of one of them, and its rates together and one by one.
fn agree<P: MechanismModel>(name: &str, scene: &Scene, model: P, chance: &mut Chance) {
    let layout = model.layout();
    let n = layout.states;
    let mut start = vec![0.0; n];
    model.write_start(&StartPose::of(scene).expect("the loop closes"), &mut start);
    let states: [Vec<f64>; ROW] = std::array::from_fn(|_| {
        let mut y = start.clone();
        for (i, state) in y.iter_mut().enumerate() {
            *state += match i {
                _ if i < layout.positions => chance.between(-8e-4, 8e-4),
                _ if i < 2 * layout.positions => chance.between(-2.0, 2.0),
                _ => chance.between(-1e-6, 1e-6),
            };
        }
        y
    });
    let conditions = Conditions::without_inputs(model.start_contacts(0.0, &states[0]));
    let times: [f64; ROW] = std::array::from_fn(|k| 1e-4 * k as f64);
    let y: Vec<F64x8> = (0..n).map(|i| F64x8::of(std::array::from_fn(|k| states[k][i]))).collect();
    let mut together = vec![F64x8::ZERO; n];
    model.rates_in_row(&conditions, &F64x8::of(times), &y, &mut together);
    for k in 0..ROW {
        let mut alone = vec![0.0; n];
        model.rates(&conditions, times[k], &states[k], &mut alone);
        for i in 0..n {
            let together = together[i].numbers()[k];
            assert_eq!(
                together.to_bits(),
                alone[i].to_bits(),
                "{name}, rate {i} of state {k}: {together} {}",
                alone[i]
            );
        }
    }
}

/// With contacts of all kinds.
fn laws(play: Play, drive: DriveMode) -> Vec<(String, Scene)> {
    let mut all = vec![];
    let frictions =
        [FrictionLaw::None, FrictionLaw::Ambrosio, FrictionLaw::Tanh, FrictionLaw::Stribeck, FrictionLaw::Lugre];
    let elastic = [
        (Elasticity::Hertz, 1.5),
        (Elasticity::Hertz, 1.4),
        (Elasticity::Liu, 1.5),
        (Elasticity::BaiZhao, 1.5),
        (Elasticity::Winkler, 1.5),
    ];
    for friction in frictions {
        for (elasticity, exponent) in elastic {
            for (damping, surface) in
                [(DampingLaw::Hertz, Surface::Foundation), (DampingLaw::LankaraniNikravesh, Surface::Corner)]
            {
                let mut scene = with_play(crooked(), play);
                scene.drive.mode = drive;
                scene.joint.t.surface = surface;
                revolutes(&mut scene).into_iter().for_each(|joint| joint.elasticity = elasticity);
                for contact in contacts(&mut scene) {
                    (contact.friction.law, contact.law, contact.exponent) = (friction, damping, exponent);
                    (contact.friction.coefficient, contact.friction.static_coefficient) = (0.1, 0.15);
                }
                let play = letters(play);
                all.push((format!("{play} {drive:?} {friction:?} {elasticity:?} {exponent} {damping:?}"), scene));
            }
        }
    }
    all
}

#[test]
fn a_rigid_mechanism_moves_alike() {
    let mut chance = Chance(11);
    for play in all_plays() {
        for drive in [DriveMode::Torque, DriveMode::Speed] {
            for (name, scene) in laws(play, drive) {
                for _ in 0..4 {
                    agree(&name, &scene, Model::assemble(&scene), &mut chance);
                }
            }
        }
    }
}

#[test]
fn a_mechanism_with_a_flexible_rod_moves_alike() {
    let mut chance = Chance(12);
    for play in all_plays() {
        for drive in [DriveMode::Torque, DriveMode::Speed] {
            for (bending, axial) in [(1, 0), (2, 1), (3, 0), (3, 1), (4, 2)] {
                let (name, mut scene) = laws(play, drive).swap_remove(8);
                (scene.rod.flexible.bending_modes, scene.rod.flexible.axial_modes) = (bending, axial);
                let name = format!("{name}, {bending} + {axial} modes");
                agree(&name, &scene, Model::assemble(&scene), &mut chance);
            }
        }
    }
}

#[test]
fn a_problem_that_knows_no_rows_is_asked_for_each_state() {
    let scene = crooked();
    let model = Model::assemble(&scene);
    let rows = [F64x8::of(std::array::from_fn(|k| 0.1 * k as f64)); 2];
    let mut alone = [F64x8::ZERO; 2];
    let of = |t: f64, y: &[f64], rates: &mut [f64]| model.rates(&Default::default(), t, y, rates);
    one_by_one(&of, &F64x8::ZERO, &rows, &mut alone);
    let mut together = [F64x8::ZERO; 2];
    model.rates_in_row(&Default::default(), &F64x8::ZERO, &rows, &mut together);
    assert_eq!(alone, together);
}
