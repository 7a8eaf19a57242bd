//! Derivatives of outputs with respect to start values, in initialization mode.

use host::{Slave, vr};
use slidercrank::fmi::v2::Status;
use slidercrank::model_description::exchange::{FIRST_DERIVATIVE, FIRST_STATE};

/// Lengths, angle, speed and torque of a mechanism whose motion has a closed form.
const R: f64 = 0.05;
const L: f64 = 0.12;
const H: f64 = 0.01;
const ANGLE: f64 = 1.0;
const SPEED: f64 = 30.0;
/// What is asked of a derivative with a closed form; the largest relative error measured is 2.4e-13.
const DIGITS: f64 = 1e-10;

fn ideal() -> Slave {
    start(Slave::initializing())
}

/// The same for an importer that integrates.
fn exchanging() -> Slave {
    let slave = Slave::exchanging();
    assert_eq!((slave.setup_raw(0, 0.0, 0.0, 0, 0.0), slave.enter()), (Status::Ok, Status::Ok));
    start(slave)
}

fn start(slave: Slave) -> Slave {
    let starts = [("guide.offset", H), ("crank.angle_start", ANGLE), ("crank.speed_start", SPEED)];
    for (name, value) in starts {
        assert_eq!(slave.set(name, value), Status::Ok);
    }
    slave
}

/// Of several unknowns along several knowns.
fn along(slave: &Slave, unknowns: &[&str], knowns: &[(&str, f64)]) -> Result<Vec<f64>, Status> {
    let unknowns: Vec<_> = unknowns.iter().map(|name| vr(name)).collect();
    let (references, seeds): (Vec<_>, Vec<_>) = knowns.iter().map(|(name, seed)| (vr(name), *seed)).unzip();
    let mut values = vec![f64::NAN; unknowns.len()];
    // SAFETY: a live component, arrays of the lengths said.
    let status = unsafe {
        let (unknowns, count) = (unknowns.as_ptr(), unknowns.len());
        let (references, seeds, places) = (references.as_ptr(), seeds.as_ptr(), values.as_mut_ptr());
        (slave.api.GetDirectionalDerivative)(slave.c, unknowns, count, references, knowns.len(), seeds, places)
    };
    if status == Status::Ok { Ok(values) } else { Err(status) }
}

#[test]
fn they_are_those_of_the_closed_form() {
    let slave = ideal();
    let (sin, cos) = ANGLE.sin_cos();
    let rise = H - R * sin;
    let reach = (L * L - rise * rise).sqrt();
    let by_angle = -R * sin + rise * R * cos / reach;
    // d²x/dθ² = −r·cos θ + d/dθ (rise·r·cos θ/reach), where d rise/dθ = −r·cos θ.
    let curvature =
        -R * cos - R * rise * sin / reach - (R * cos).powi(2) / reach - (R * cos * rise).powi(2) / reach.powi(3);
    let mut worst: f64 = 0.0;
    for (unknown, known, exact) in [
        ("slider.x", "crank.length", cos + rise * sin / reach),
        ("slider.x", "rod.length", L / reach),
        ("slider.x", "guide.offset", -rise / reach),
        ("slider.x", "slider.centre.y", rise / reach),
        ("slider.x", "crank.angle_start", by_angle),
        ("slider.v", "crank.speed_start", by_angle),
        ("slider.v", "crank.angle_start", curvature * SPEED),
        ("rod.angle", "guide.offset", 1.0 / reach),
        ("crank.angle", "crank.angle_start", 1.0),
        ("slider.y", "guide.offset", 1.0),
        ("solver.tolerance_used", "solver.tolerance", 1.0),
    ] {
        let found = slave.sensitivity(unknown, known, 2.0).expect("a derivative") / 2.0;
        worst = worst.max((found / exact - 1.0).abs());
        assert!((found - exact).abs() < DIGITS * exact.abs(), "{unknown} by {known}: {found} {exact}");
    }
    println!("largest relative error: {worst:.1e}");
    for (unknown, known) in [("slider.x", "crank.mass"), ("slider.x", "joint.C.clearance"), ("slider.angle", "gravity")]
    {
        assert_eq!(slave.sensitivity(unknown, known, 1.0), Ok(0.0), "{unknown} by {known}");
    }
}

#[test]
fn inertias_change_the_acceleration_as_newton_has_it() {
    let slave = Slave::initializing();
    let torque = 3.0;
    assert_eq!(slave.set("crank.torque", torque), Status::Ok);
    // Where the crank points along the guide the slider stands still for a moment, and the rod turns about its pin.
    let (ratio, big_end) = (R / L, 1.0 - 0.06 / L);
    let inertia = 1e-4 + 0.3 * 0.025_f64.powi(2) + 0.21 * (R * big_end).powi(2) + 2.5e-4 * ratio * ratio;
    let found = slave.get("crank.acceleration");
    assert!((found - torque / inertia).abs() < 1e-12 * found, "{found}");
    let slope = -torque / (inertia * inertia);
    for (known, share) in [
        ("crank.inertia", 1.0),
        ("crank.mass", 0.025_f64.powi(2)),
        ("rod.mass", (R * big_end).powi(2)),
        ("rod.inertia", ratio * ratio),
    ] {
        let found = slave.sensitivity("crank.acceleration", known, 1.0).expect("a derivative");
        assert!((found - slope * share).abs() < DIGITS * (slope * share).abs(), "{known}: {found} {}", slope * share);
    }
    // Inputs and start values along one direction, one of them named twice.
    let knowns = [("crank.torque", 2.0), ("crank.inertia", 1e-5), ("crank.inertia", 2e-5)];
    let found = along(&slave, &["crank.acceleration", "drive.torque"], &knowns).expect("derivatives");
    let exact = 2.0 / inertia + 3e-5 * slope;
    assert!((found[0] - exact).abs() < DIGITS * exact.abs() && found[1] == 2.0, "{found:?} {exact}");
}

#[test]
fn at_an_end_of_a_range_they_come_from_the_other_side() {
    let slave = ideal();
    // Viscous friction of the main bearing: a torque of −damping·ω, so that damping acts as a torque does.
    let by_torque = slave.sensitivity("slider.a", "crank.torque", 1.0).expect("a derivative");
    let by_damping = slave.sensitivity("slider.a", "joint.A.damping", 1.0).expect("a derivative");
    assert!((by_damping + SPEED * by_torque).abs() < DIGITS * by_damping.abs(), "{by_damping} {by_torque}");
}

#[test]
fn a_contact_is_felt_and_where_an_output_jumps_it_has_none() {
    let slave = Slave::initializing();
    assert_eq!(slave.set_integer("joint.C.model", 2), Status::Ok);
    assert_eq!(slave.set("joint.C.eccentricity_start.x", 5.1e-4), Status::Ok);
    let by = |known: &str| slave.sensitivity("joint.C.force.x", known, 1.0).expect("a derivative");
    // F = K·δ^1.5 with δ = e − c, K as Young's moduli.
    let (force, depth) = (slave.get("joint.C.force.x"), 1e-5);
    assert!((by("joint.C.eccentricity_start.x") * depth / force - 1.5).abs() < 1e-6);
    let both = by("joint.C.young.bearing") + by("joint.C.young.journal");
    assert!((both * 207e9 / force - 1.0).abs() < 1e-6, "{both}");
    // A stiffness of 0 stands for Hertz's: no derivative there.
    assert_eq!(slave.sensitivity("joint.C.force.x", "joint.C.stiffness", 1.0), Err(Status::Discard));
    let text = slave.log.only().text;
    assert!(text.ends_with("joint.C.force.x has no derivative with respect to these start values: it jumps there"));
}

#[test]
fn they_are_for_initialization_mode_and_leave_the_run_alone() {
    let (asked, alone) = (ideal(), ideal());
    assert!(asked.sensitivity("slider.a", "rod.mass", 1.0).is_ok());
    assert_eq!(asked.sensitivity("slider.a", "drive.mode", 1.0), Err(Status::Error));
    let text = asked.log.only().text;
    assert!(text.contains("drive.mode is not a real input, nor a real parameter in initialization mode"), "{text}");
    for slave in [&asked, &alone] {
        assert_eq!(slave.exit(), Status::Ok);
        slave.steps(0.0, 1e-3, 5);
    }
    assert_eq!(asked.picture(), alone.picture());
    assert_eq!(asked.sensitivity("slider.a", "rod.mass", 1.0), Err(Status::Error));
    assert!(asked.log.only().text.contains("rod.mass is not a real input"));
    // Start values that contradict each other are told, not differentiated.
    let lost = ideal();
    assert_eq!(lost.set("guide.offset", 0.3), Status::Ok);
    assert_eq!(lost.sensitivity("slider.x", "rod.length", 1.0), Err(Status::Error));
    assert!(lost.log.only().text.contains("rod.length = 0.12 is not allowed"));
}

/// Of several unknowns along one known, by their references.
fn of(slave: &Slave, unknowns: &[u32], known: u32) -> Result<Vec<f64>, Status> {
    let (count, mut values) = (unknowns.len(), vec![f64::NAN; unknowns.len()]);
    // SAFETY: a live component, arrays of the lengths said.
    let status = unsafe {
        (slave.api.GetDirectionalDerivative)(slave.c, unknowns.as_ptr(), count, &known, 1, &1.0, values.as_mut_ptr())
    };
    if status == Status::Ok { Ok(values) } else { Err(status) }
}

#[test]
fn in_model_exchange_they_are_those_of_co_simulation() {
    let (exchange, stepping) = (exchanging(), ideal());
    let unknowns = ["slider.x", "slider.v", "slider.a", "crank.acceleration", "joint.C.force.x", "accuracy.velocity"];
    for known in ["crank.length", "rod.mass", "slider.mass", "guide.offset", "crank.speed_start", "crank.torque"] {
        let [here, there] = [&exchange, &stepping].map(|slave| along(slave, &unknowns, &[(known, 1.5)]).expect("some"));
        for (at, (here, there)) in here.iter().zip(&there).enumerate() {
            // One difference is as good as the other.
            assert!((here - there).abs() <= 1e-9 * there.abs() + 1e-12, "{} by {known}: {here} {there}", unknowns[at]);
        }
    }
    assert_eq!(exchange.exit(), Status::Ok);
    assert_eq!(exchange.sensitivity("slider.a", "rod.mass", 1.0), Err(Status::Error));
    assert!(exchange.log.only().text.contains("rod.mass is not a real input or a continuous state"));
}

#[test]
fn states_and_their_derivatives_follow_start_values_in_either_interface() {
    let (angle, speed) = (FIRST_STATE, FIRST_STATE + 1);
    let unknowns = [angle, speed, FIRST_DERIVATIVE, FIRST_DERIVATIVE + 1, vr("crank.acceleration")];
    for slave in [exchanging(), ideal()] {
        let by = |known: &str| of(&slave, &unknowns, vr(known)).expect("derivatives");
        for (known, starts) in [
            ("crank.angle_start", [1.0, 0.0, 0.0]),
            ("crank.speed_start", [0.0, 1.0, 1.0]),
            ("rod.mass", [0.0; 3]),
            ("crank.torque", [0.0; 3]),
        ] {
            let found = by(known);
            // The angle's derivative is the speed, and that of the speed an output.
            for (found, exact) in found.iter().zip(starts) {
                assert!((found - exact).abs() < DIGITS, "{known}: {found} {exact}");
            }
            assert!(found[3] != 0.0 && (found[3] - found[4]).abs() < 1e-9 * found[4].abs(), "{known}: {found:?}");
        }
        assert_eq!(slave.exit(), Status::Ok);
        assert_eq!(of(&slave, &[angle], vr("crank.torque")), Err(Status::Error));
        assert!(slave.log.only().text.contains("nor a state"));
        // A state that the scene does not have.
        assert_eq!(of(&slave, &[FIRST_DERIVATIVE + 2], vr("crank.torque")), Err(Status::Error));
        slave.log.only();
    }
}
