//! The exact Jacobian against extrapolated differences of the rates, at states along runs of every
//! topology, drive, law and effect.

use super::differences::{Derivative, derivatives};
use super::scenes::{all_plays, at, contacts, crooked, inputs, letters, revolutes, speed_driven, start, with_play};
use slidercrank::scene::{DampingLaw, Elasticity, FrictionLaw, JointModel, Scene, Surface};
use slidercrank::simulation::{Linearization, Simulation};

const ALL: [bool; 4] = [true; 4];
/// [s] Length of a run, and states on it.
const SPAN: f64 = 0.01;
const STATES: usize = 8;
/// First increments of positions [m, rad], of rates, of bristles [m], of time [s].
const INCREMENTS: [f64; 4] = [2e-6, 0.05, 2e-6, 2e-7];

/// How many derivatives other than 0 were compared, how many of them were known to 3e-8 of themselves, and the
/// largest error of those relative to themselves.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    compared: usize,
    known: usize,
    worst: f64,
}

/// Compares a derivative with its difference.
fn judge(name: &str, place: (usize, usize), exact: f64, difference: Derivative, tally: &mut Tally) {
    let Derivative { value, error } = difference;
    let apart = (exact - value).abs();
    assert!(apart <= 1e-7 * exact.abs() + 10.0 * error, "{name}, {place:?}: {exact:e} is not {value:e} ± {error:e}");
    tally.compared += usize::from(exact != 0.0);
    if exact != 0.0 && error <= 3e-8 * exact.abs() {
        tally.known += 1;
        tally.worst = f64::max(tally.worst, apart / exact.abs());
    }
}

/// [s] Steps end and start at discontinuities of the rates, where differences tell nothing: so far on the discontinuities are passed.
const ONWARD: f64 = 1e-5;

/// Compares all columns close to the state where the next step starts.
fn compare(name: &str, simulation: &Simulation, tally: &mut Tally) {
    let (t, mut y) = simulation.front();
    let rates = simulation.rates_at(t, &y);
    for (y, rate) in y.iter_mut().zip(rates) {
        *y += ONWARD * rate;
    }
    let Linearization { rates, by_state, by_time, positions, .. } = simulation.linearization_at(t, &y);
    assert_eq!(rates, simulation.rates_at(t, &y));
    // Rates are sums of products; penetrations, differences of places that are themselves rounded.
    let noise: Vec<f64> = by_state
        .iter()
        .zip(&rates)
        .map(|(row, rate)| {
            let moved: f64 = row.iter().zip(&y).map(|(slope, y)| (slope * y).abs()).sum();
            f64::EPSILON * (rate.abs() + moved)
        })
        .collect();
    let [position, rate, bristle, time] = INCREMENTS;
    for j in 0..y.len() {
        let first = [position, rate, bristle][(j / positions.max(1)).min(2)];
        let moved = |h: f64| {
            let mut y = y.clone();
            y[j] += h;
            simulation.rates_at(t, &y)
        };
        for (i, difference) in derivatives(first, &noise, moved).into_iter().enumerate() {
            judge(name, (i, j), by_state[i][j], difference, tally);
        }
    }
    for (i, difference) in derivatives(time, &noise, |h| simulation.rates_at(t + h, &y)).into_iter().enumerate() {
        judge(name, (i, y.len()), by_time[i], difference, tally);
    }
    for i in 0..positions {
        let unit: Vec<f64> = (0..y.len()).map(|j| f64::from(j == positions + i)).collect();
        assert_eq!((&by_state[i], by_time[i]), (&unit, 0.0), "{name}: row {i} is a velocity");
    }
}

/// Compares along a run, and asks that differences tell something.
fn run(name: &str, scene: &Scene, span: f64) {
    let mut simulation = start(scene, inputs(20.0, -300.0));
    simulation.set_inputs(inputs(20.0, -300.0), inputs(3e3, 4e4));
    let mut tally = Tally::default();
    let mut touching = false;
    for k in 1..=STATES {
        let o = at(&mut simulation, span * k as f64 / STATES as f64);
        touching |= o.joint_a.contact || o.joint_b.contact || o.joint_c.contact || o.joint_t.contacts > 0;
        compare(name, &simulation, &mut tally);
    }
    println!("{name}: {tally:?}");
    let joint = &scene.joint;
    let models = [joint.a.model, joint.b.model, joint.c.model, joint.t.model];
    let clear = models.contains(&JointModel::Clearance);
    assert!(touching || !clear, "{name}: nothing touches");
    if clear {
        assert!(2 * tally.known > tally.compared, "{name}: {tally:?}");
    }
    assert!(tally.worst < 1e-7, "{name}: {tally:?}");
}

/// Without symmetry, with friction and viscous damping everywhere, so fast that joints soon touch.
fn rattling() -> Scene {
    let mut scene = crooked();
    scene.crank.speed_start = 300.0;
    for joint in revolutes(&mut scene) {
        (joint.clearance, joint.damping) = (1e-4, 1e-3);
    }
    (scene.joint.t.clearance, scene.joint.t.damping) = (9e-5, 0.5);
    for contact in contacts(&mut scene) {
        (contact.friction.law, contact.restitution) = (FrictionLaw::Ambrosio, 0.6);
    }
    scene
}

#[test]
fn it_is_exact_for_every_topology_under_both_drives() {
    for play in all_plays() {
        let scene = with_play(rattling(), play);
        run(&format!("torque {}", letters(play)), &scene, SPAN);
        run(&format!("speed {}", letters(play)), &speed_driven(scene), SPAN);
    }
}

#[test]
fn it_is_exact_for_every_friction_and_elasticity() {
    for law in [FrictionLaw::None, FrictionLaw::Ambrosio, FrictionLaw::Tanh, FrictionLaw::Stribeck, FrictionLaw::Lugre]
    {
        for (elasticity, exponent, damping) in [
            (Elasticity::Hertz, 1.5, DampingLaw::Flores),
            (Elasticity::Hertz, 1.5, DampingLaw::Hertz),
            (Elasticity::Hertz, 1.3, DampingLaw::LankaraniNikravesh),
            (Elasticity::Liu, 1.5, DampingLaw::HuGuo),
            (Elasticity::BaiZhao, 1.5, DampingLaw::ZhiyingQishao),
            (Elasticity::Winkler, 1.5, DampingLaw::Flores),
        ] {
            let mut scene = with_play(rattling(), ALL);
            for joint in revolutes(&mut scene) {
                joint.elasticity = elasticity;
            }
            for contact in contacts(&mut scene) {
                (contact.law, contact.exponent) = (damping, exponent);
                soft_bristles(&mut contact.friction, law);
            }
            run(&format!("{law:?} {elasticity:?} {exponent} {damping:?}"), &scene, SPAN);
        }
    }
}

/// The law, and bristles no stiffer than the contacts.
fn soft_bristles(friction: &mut slidercrank::scene::Friction, law: FrictionLaw) {
    friction.law = law;
    (friction.coefficient, friction.static_coefficient, friction.v_stribeck) = (0.1, 0.15, 0.1);
    (friction.sigma0, friction.sigma1, friction.sigma2) = (1e4, 1.0, 1e-3);
}

#[test]
fn it_is_exact_for_elastic_faces() {
    for play in all_plays().filter(|play| play[3]) {
        for law in [FrictionLaw::Tanh, FrictionLaw::Lugre] {
            let mut scene = with_play(rattling(), play);
            (scene.joint.t.surface, scene.joint.t.foundation_stiffness) = (Surface::Foundation, 2e9);
            soft_bristles(&mut scene.joint.t.contact.friction, law);
            run(&format!("faces {} {law:?}", letters(play)), &scene, SPAN);
        }
    }
}

#[test]
fn it_is_exact_for_flexible_rods() {
    for (bending, axial) in [(2, 0), (3, 1), (0, 2), (5, 1)] {
        for play in
            [[false; 4], [true, false, false, false], [false, true, false, true], [false, false, true, false], ALL]
        {
            for shortens in [true, false] {
                let mut scene = with_play(rattling(), play);
                let rod = &mut scene.rod.flexible;
                (rod.bending_modes, rod.axial_modes) = (bending, axial);
                (rod.young, rod.damping_ratio, rod.geometric_stiffness) = (20e9, 0.02, shortens);
                let name = format!("rod {bending}+{axial} {} {shortens}", letters(play));
                let scene = if shortens { scene } else { speed_driven(scene) };
                run(&name, &scene, 0.4 * SPAN);
            }
        }
    }
}

#[test]
fn it_is_exact_for_an_audit_s_powers_and_no_state_follows_from_them() {
    let mut bent = rattling();
    (bent.rod.flexible.bending_modes, bent.rod.flexible.damping_ratio) = (2, 0.02);
    for (name, scene) in [("rigid", rattling()), ("flexible", bent)] {
        for play in [[false; 4], [false, false, true, false], [false, true, false, true], ALL] {
            for scene in [scene.clone(), speed_driven(scene.clone())] {
                let mut scene = with_play(scene, play);
                scene.energy.audit = true;
                run(&format!("audit {name} {} {:?}", letters(play), scene.drive.mode), &scene, 0.4 * SPAN);
                let mut simulation = start(&scene, inputs(20.0, -300.0));
                at(&mut simulation, 0.002);
                let (t, y) = simulation.front();
                let Linearization { by_state, .. } = simulation.linearization_at(t, &y);
                assert!(by_state.iter().all(|row| row[y.len() - 7..].iter().all(|slope| *slope == 0.0)));
            }
        }
    }
}
