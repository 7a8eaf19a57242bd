//! The ideal mechanism against closed-form kinematics and Newton's and Euler's equations of its three
//! bodies, solved as one linear system: nine equations for eight reactions and the unknown of the drive.

use super::scenes::{at, at_tolerance, crooked, inputs, speed_driven, start, worst_difference};
use nalgebra::{SMatrix, SVector, Vector2};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{DriveMode, Point, Scene};
use std::f64::consts::TAU;

type Vec2 = Vector2<f64>;

fn turned(angle: f64, p: Point) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y)
}

fn perp(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// Outputs of the ideal mechanism at the crank's angle and speed under these inputs.
fn closed_form(scene: &Scene, angle: f64, speed: f64, inputs: Inputs) -> Outputs {
    let Scene { crank, rod, slider, joint, gravity, .. } = scene;
    let (r, l) = (crank.length, rod.length);
    let height = scene.guide.offset - slider.centre.y;
    let (sin, cos) = angle.sin_cos();
    // r·sin θ + l·sin φ = height, then once and twice differentiated; φ̈ = ratio·θ̈ + bias.
    let rod_angle = ((height - r * sin) / l).asin();
    let (rod_sin, rod_cos) = rod_angle.sin_cos();
    let ratio = -r * cos / (l * rod_cos);
    let rod_speed = ratio * speed;
    let bias = (r * sin * speed.powi(2) + l * rod_sin * rod_speed.powi(2)) / (l * rod_cos);
    // x = r·cos θ + l·cos φ.
    let x = r * cos + l * rod_cos;
    let x_ratio = -r * sin - l * rod_sin * ratio;
    let x_bias = -r * cos * speed.powi(2) - l * rod_cos * rod_speed.powi(2) - l * rod_sin * bias;
    let v = x_ratio * speed;

    // Unknowns: A, B, C (x, y each), T.y, moment, drive torque, crank acceleration.
    const DRIVE: usize = 8;
    const ACCELERATION: usize = 9;
    let mut m = SMatrix::<f64, 10, 10>::zeros();
    let mut b = SVector::<f64, 10>::zeros();
    let arm = turned(angle, Point { x: r, y: 0.0 });
    let com1 = turned(angle, crank.com);
    let com2 = turned(rod_angle, rod.com);
    let to_small_end = turned(rod_angle, Point { x: l, y: 0.0 });
    let com3 = Vec2::new(slider.com.x, slider.com.y);
    // Accelerations of the centres of mass: jacobian·θ̈ + rest.
    let jacobian1 = perp(com1);
    let rest1 = -speed.powi(2) * com1;
    let jacobian2 = perp(arm) + ratio * perp(com2);
    let rest2 = -speed.powi(2) * arm + bias * perp(com2) - rod_speed.powi(2) * com2;
    let (jacobian3, rest3) = (Vec2::new(x_ratio, 0.0), Vec2::new(x_bias, 0.0));
    let guide_drag = -joint.t.damping * v;
    let weight = |mass: f64| Vec2::new(0.0, -mass * gravity);
    // m·a = forces, for the crank (A − B), the rod (B − C) and the slider (C + T + load).
    let along = Vec2::new(inputs.slider_load + guide_drag, 0.0);
    let bodies = [
        (crank.mass, jacobian1, rest1, Vec2::zeros()),
        (rod.mass, jacobian2, rest2, Vec2::zeros()),
        (slider.mass, jacobian3, rest3, along),
    ];
    for (i, (mass, jacobian, rest, applied)) in bodies.into_iter().enumerate() {
        for axis in 0..2 {
            let row = 2 * i + axis;
            m[(row, 2 * i + axis)] = 1.0;
            if i < 2 {
                m[(row, 2 * i + 2 + axis)] = -1.0;
            }
            m[(row, ACCELERATION)] = -mass * jacobian[axis];
            b[row] = mass * rest[axis] - applied[axis] - weight(mass)[axis];
        }
    }
    m[(5, 6)] = 1.0;
    // Moments about the centres of mass. A force f at p gives p.x·f.y − p.y·f.x.
    let mut moment = |row: usize, force: usize, at: Vec2, sign: f64| {
        m[(row, force)] = -sign * at.y;
        m[(row, force + 1)] = sign * at.x;
    };
    moment(6, 0, -com1, 1.0);
    moment(6, 2, arm - com1, -1.0);
    moment(7, 2, -com2, 1.0);
    moment(7, 4, to_small_end - com2, -1.0);
    moment(8, 4, -com3, 1.0);
    m[(8, 6)] = -com3.x;
    m[(8, 7)] = 1.0;
    m[(6, DRIVE)] = 1.0;
    m[(6, ACCELERATION)] = -crank.inertia;
    m[(7, ACCELERATION)] = -rod.inertia * ratio;
    let [drag_a, drag_b, drag_c] =
        [joint.a.damping * speed, joint.b.damping * (speed - rod_speed), joint.c.damping * (0.0 - rod_speed)];
    b[6] = drag_a + drag_b;
    b[7] = rod.inertia * bias - drag_b - drag_c;
    b[8] = drag_c - (com3.y * along.x - com3.x * along.y);
    // The tenth equation says what is known of the drive.
    match scene.drive.mode {
        DriveMode::Speed => m[(9, ACCELERATION)] = 1.0,
        DriveMode::Torque => {
            m[(9, DRIVE)] = 1.0;
            b[9] = inputs.crank_torque;
        }
    }
    let mut solved = m.full_piv_lu().solve(&b).expect("a mechanism that can move");

    // What is known of the drive is known exactly, whatever rounding the elimination leaves.
    match scene.drive.mode {
        DriveMode::Speed => solved[ACCELERATION] = 0.0,
        DriveMode::Torque => solved[DRIVE] = inputs.crank_torque,
    }

    let mut outputs = Outputs::default();
    outputs.slider.x = x;
    outputs.slider.v = v;
    outputs.slider.a = x_ratio * solved[ACCELERATION] + x_bias;
    outputs.slider.y = height;
    outputs.crank.angle = angle;
    outputs.crank.speed = speed;
    outputs.crank.acceleration = solved[ACCELERATION];
    outputs.rod.angle = rod_angle;
    outputs.rod.speed = rod_speed;
    outputs.joint_a.force = [solved[0], solved[1]];
    outputs.joint_b.force = [solved[2], solved[3]];
    outputs.joint_c.force = [solved[4], solved[5]];
    outputs.joint_t.force = [guide_drag, solved[6]];
    outputs.joint_t.moment = solved[7];
    outputs.drive_torque = solved[DRIVE];
    outputs
}

/// Named mechanisms with their inputs.
fn cases() -> Vec<(&'static str, Scene, Inputs)> {
    let mut damped = crooked();
    damped.joint.a.damping = 2e-3;
    damped.joint.b.damping = 3e-3;
    damped.joint.c.damping = 4e-3;
    damped.joint.t.damping = 5.0;
    let mut backwards = damped.clone();
    backwards.crank.speed_start = -320.0;
    let mut press = Scene::default();
    (press.crank.length, press.crank.mass, press.crank.inertia) = (0.015, 800.0, 60.0);
    (press.rod.length, press.rod.mass, press.rod.inertia, press.rod.com.x) = (0.35, 120.0, 2.5, 0.11);
    press.slider.mass = 400.0;
    press.gravity = 9.81;
    press.crank.speed_start = 60.0;
    let mut plain = Scene::default();
    plain.crank.speed_start = 5000.0 * TAU / 60.0;
    vec![
        ("plain", plain, inputs(0.0, 0.0)),
        ("crooked", crooked(), inputs(7.0, -120.0)),
        ("damped", damped, inputs(-3.0, 50.0)),
        ("backwards", backwards, inputs(4.0, 300.0)),
        ("press", press, inputs(2e3, -3e5)),
    ]
}

/// Largest relative difference from the closed form over a full turn.
///
/// What was integrated, the crank's angle and speed, is taken from the outputs: the rest is algebra.
fn difference_over_a_turn(scene: &Scene, inputs: Inputs) -> (f64, &'static str) {
    let mut simulation = start(scene, inputs);
    let period = TAU / scene.crank.speed_start.abs();
    let mut pairs = vec![];
    for i in 0..=720 {
        let outputs = at(&mut simulation, period * f64::from(i) / 720.0);
        pairs.push((closed_form(scene, outputs.crank.angle, outputs.crank.speed, inputs), outputs));
    }
    let (first, last) = (pairs[0].1.crank.angle, pairs[720].1.crank.angle);
    assert!((last - first).abs() > 1.0, "the crank turns");
    worst_difference(&pairs)
}

#[test]
fn every_output_of_the_ideal_mechanism_is_the_closed_form_under_a_torque_drive() {
    for (name, scene, inputs) in cases() {
        let (error, what) = difference_over_a_turn(&scene, inputs);
        println!("{name}: {error:.1e} in {what}");
        assert!(error < 1e-12, "{name}: {error:e} in {what}");
    }
}

#[test]
fn every_output_of_the_ideal_mechanism_is_the_closed_form_under_a_speed_drive() {
    for (name, scene, inputs) in cases() {
        let scene = speed_driven(scene);
        let (error, what) = difference_over_a_turn(&scene, inputs);
        println!("{name}: {error:.1e} in {what}");
        assert!(error < 1e-12, "{name}: {error:e} in {what}");
    }
}

#[test]
fn a_speed_drive_turns_at_its_speed() {
    let scene = speed_driven(crooked());
    let mut simulation = slidercrank::simulation::Simulation::start(&scene, Inputs::default()).expect("a start");
    for t in [0.0, 0.001, 0.5, 8.0] {
        let outputs = at(&mut simulation, t);
        let angle = 0.4 + 150.0 * t;
        assert!((outputs.crank.angle - angle).abs() <= 2.0 * f64::EPSILON * angle);
        assert_eq!((outputs.crank.speed, outputs.crank.acceleration), (150.0, 0.0));
    }
}

#[test]
fn crank_speed_under_a_torque_follows_from_the_energy() {
    // ½·I(θ)·ω² + weight = ½·I(θ0)·ω0² + τ·(θ − θ0) + F·(x − x0), I(θ) from the closed form's inertia:
    // the drive torque that a unit acceleration adds.
    let (torque, load) = (7.0, -120.0);
    let scene = at_tolerance(crooked(), 1e-12);
    let kinetic_and_weight = |angle: f64, speed: f64| {
        let still = closed_form(&speed_driven(scene.clone()), angle, speed, inputs(0.0, 0.0));
        let with = |body: Point, at: Vec2, angle: f64| at + turned(angle, body);
        let arm = turned(angle, Point { x: scene.crank.length, y: 0.0 });
        let place1 = with(scene.crank.com, Vec2::zeros(), angle);
        let place2 = with(scene.rod.com, arm, still.rod.angle);
        let velocity1 = speed * perp(place1);
        let velocity2 = speed * perp(arm) + still.rod.speed * perp(place2 - arm);
        let height3 = still.slider.y + scene.slider.com.y;
        0.5 * (scene.crank.mass * velocity1.norm_squared()
            + scene.crank.inertia * speed.powi(2)
            + scene.rod.mass * velocity2.norm_squared()
            + scene.rod.inertia * still.rod.speed.powi(2)
            + scene.slider.mass * still.slider.v.powi(2))
            + scene.gravity * (scene.crank.mass * place1.y + scene.rod.mass * place2.y + scene.slider.mass * height3)
            - torque * angle
            - load * still.slider.x
    };
    let mut simulation = start(&scene, inputs(torque, load));
    let wanted = kinetic_and_weight(0.4, 150.0);
    let mut worst = 0.0f64;
    for i in 0..=400 {
        let outputs = at(&mut simulation, 1e-3 * f64::from(i));
        let found = kinetic_and_weight(outputs.crank.angle, outputs.crank.speed);
        worst = worst.max((found - wanted).abs() / (torque * outputs.crank.angle).abs().max(wanted.abs()));
    }
    println!("energy of a torque drive at tolerance 1e-12: {worst:.1e}");
    // Ten turns in some 300 steps at an error of 1e-12 of 5 % of a radian each: measured 4e-12.
    assert!(worst < 1e-10, "{worst:e}");
}

#[test]
fn the_published_peaks_of_the_5000_rpm_mechanism() {
    let mut scene = speed_driven(Scene::default());
    scene.crank.speed_start = 5000.0 * TAU / 60.0;
    let mut simulation = start(&scene, Inputs::default());
    let steps = 36_000;
    let (mut highest, mut lowest, mut fastest) = ((0.0f64, 0.0), 0.0f64, 0.0f64);
    let (mut pin, mut crank_pin, mut torque) = (0.0f64, 0.0f64, (0.0f64, 0.0f64));
    for i in 0..=steps {
        let degrees = 360.0 * f64::from(i) / f64::from(steps);
        let o = at(&mut simulation, degrees / 360.0 / (5000.0 / 60.0));
        if o.slider.a > highest.0 {
            highest = (o.slider.a, degrees);
        }
        lowest = lowest.min(o.slider.a);
        fastest = fastest.max(o.slider.v.abs());
        pin = pin.max(o.joint_c.force[0].hypot(o.joint_c.force[1]));
        crank_pin = crank_pin.max(o.joint_b.force[0].hypot(o.joint_b.force[1]));
        torque = (torque.0.min(o.drive_torque), torque.1.max(o.drive_torque));
    }
    // Printed values: half a unit of the last place; a hundredth of a degree apart, peaks are sharper.
    let printed = [
        ("largest acceleration", highest.0, 9695.9, 0.05),
        ("its angle", if highest.1 > 180.0 { 360.0 - highest.1 } else { highest.1 }, 122.0, 0.05),
        ("smallest acceleration", lowest, -19419.4, 0.05),
        ("largest speed", fastest, 28.411, 0.0005),
        ("largest pin force", pin, 2718.7, 0.05),
        ("largest crank-pin force", crank_pin, 6197.1, 0.05),
        ("largest torque", torque.1, 138.52, 0.005),
        ("smallest torque", torque.0, -138.52, 0.005),
    ];
    for (name, found, wanted, half_unit) in printed {
        println!("{name}: {found:.4}");
        assert!((found - wanted).abs() <= half_unit, "{name}: {found}, printed {wanted}");
    }
}
