//! Derivatives: of inputs, of outputs, and of outputs with respect to inputs.

use host::{Slave, vr};
use slidercrank::fmi::v2::Status;

const H: f64 = 1e-3;

/// A resting crank whose speed shows the torque's integral, since only the crank can turn: the
/// slider's mass and load act through a lever that is 0 at the dead centre and small near it.
fn resting() -> Slave {
    let slave = Slave::initializing();
    assert_eq!(slave.exit(), Status::Ok);
    slave
}

#[test]
fn value_and_derivative_combine_in_either_order() {
    let [first, second] = [true, false].map(|value_first| {
        let slave = resting();
        let point = slave.steps(0.0, H, 2);
        for value in [value_first, !value_first] {
            let status = if value { slave.set("crank.torque", 2.0) } else { slave.set_rate("crank.torque", 1, 3.0) };
            assert_eq!(status, Status::Ok);
        }
        assert_eq!(slave.get("crank.torque"), 2.0);
        let end = slave.steps(point, H, 1);
        assert_eq!(slave.get("crank.torque"), 2.0 + 3.0 * (end - point));
        slave.picture()
    });
    assert_eq!(first, second);
}

#[test]
fn what_is_not_set_again_goes_on() {
    let slave = resting();
    assert_eq!(slave.set("slider.load", 1.0), Status::Ok);
    assert_eq!(slave.set_rate("slider.load", 1, 100.0), Status::Ok);
    let end = slave.steps(0.0, H, 7);
    assert!((slave.get("slider.load") - (1.0 + 100.0 * end)).abs() < 1e-12);
    // The other input, set alone, leaves this one on its line.
    assert_eq!(slave.set("crank.torque", 1.0), Status::Ok);
    let end = slave.steps(end, H, 3);
    assert!((slave.get("slider.load") - (1.0 + 100.0 * end)).abs() < 1e-12);
    assert_eq!(slave.get("crank.torque"), 1.0);
}

#[test]
fn a_value_set_later_without_a_derivative_is_held() {
    let slave = resting();
    assert_eq!(slave.set_rate("slider.load", 1, 100.0), Status::Ok);
    let end = slave.steps(0.0, H, 2);
    assert_eq!(slave.set("slider.load", 5.0), Status::Ok);
    slave.steps(end, H, 2);
    assert_eq!(slave.get("slider.load"), 5.0);
}

#[test]
fn a_derivative_set_later_starts_from_the_value_reached() {
    let slave = resting();
    assert_eq!(slave.set_rate("slider.load", 1, 100.0), Status::Ok);
    let turn = slave.steps(0.0, H, 2);
    assert_eq!(slave.set_rate("slider.load", 1, -50.0), Status::Ok);
    assert!((slave.get("slider.load") - 100.0 * turn).abs() < 1e-12);
    let end = slave.steps(turn, H, 2);
    assert!((slave.get("slider.load") - (100.0 * turn - 50.0 * (end - turn))).abs() < 1e-12);
}

#[test]
fn a_derivative_set_before_initialization_counts_from_the_start() {
    let slave = Slave::new();
    assert_eq!(slave.set_rate("slider.load", 1, 100.0), Status::Ok);
    assert_eq!(slave.set("slider.load", 3.0), Status::Ok);
    assert_eq!(slave.setup_raw(0, 0.0, 10.0, 0, 0.0), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    assert_eq!(slave.get("slider.load"), 3.0);
    let end = slave.steps(10.0, H, 2);
    assert!((slave.get("slider.load") - (3.0 + 100.0 * (end - 10.0))).abs() < 1e-9);
}

#[test]
fn the_mechanism_feels_the_slope_between_points() {
    // Many short steps with the torque of each midpoint, against one long step with its slope.
    let (ramp, stairs) = (resting(), resting());
    let (slope, h, n) = (40.0, 0.02, 2000);
    assert_eq!(ramp.set_rate("crank.torque", 1, slope), Status::Ok);
    ramp.steps(0.0, h, 1);
    let (mut point, small) = (0.0, h / f64::from(n));
    for _ in 0..n {
        assert_eq!(stairs.set("crank.torque", slope * (point + small / 2.0)), Status::Ok);
        point = stairs.steps(point, small, 1);
    }
    let (expected, found) = (ramp.get("crank.speed"), stairs.get("crank.speed"));
    // Midpoint stairs err by about (1/n)² of the whole, and the integrator by its tolerance 1e-6.
    assert!((found - expected).abs() < 1e-5 * expected.abs(), "{expected} {found}");
    assert!(expected > 0.1);
}

#[test]
fn derivatives_set_together_are_applied_all_or_none() {
    let slave = resting();
    let references = [vr("crank.torque"), vr("slider.load")];
    let (orders, rates) = ([1, 2], [5.0, 5.0]);
    // SAFETY: live component, arrays of two entries.
    let status = unsafe {
        (slave.api.SetRealInputDerivatives)(slave.c, references.as_ptr(), 2, orders.as_ptr(), rates.as_ptr())
    };
    assert_eq!(status, Status::Error);
    slave.steps(0.0, H, 1);
    assert_eq!(slave.get("crank.torque"), 0.0);
}

#[test]
fn output_derivatives_are_the_slopes_of_the_outputs() {
    let slave = Slave::running();
    let mut point = slave.steps(0.0, 1e-3, 3);
    let h = 1e-6;
    for name in ["slider.x", "slider.v", "crank.angle", "rod.angle", "joint.C.eccentricity.x"] {
        let (before, slope) = (slave.get(name), slave.rate(name, 1).expect("an output"));
        point = slave.steps(point, h, 1);
        let after = slave.rate(name, 1).expect("an output");
        let found = (slave.get(name) - before) / h;
        // The trapezoid's slope; its error is h² of the third derivative, and differences of
        // positions near 0.1 m lose 1e-17/h.
        let bound = 1e-4 * slope.abs().max(1.0);
        assert!((found - 0.5 * (slope + after)).abs() < bound, "{name}: {slope} {found}");
    }
    assert_eq!(slave.rate("slider.x", 1).expect("an output"), slave.get("slider.v"));
}

#[test]
fn sensitivities_are_what_a_changed_input_does() {
    let slave = Slave::running();
    let point = slave.steps(0.0, 1e-3, 3);
    for known in ["crank.torque", "slider.load"] {
        // A first change ends the integrator's step here; a second one leaves the state alone.
        assert_eq!(slave.set(known, 1.0), Status::Ok);
        for unknown in ["slider.a", "crank.acceleration", "joint.A.force.x", "drive.torque", "slider.x"] {
            let before = slave.get(unknown);
            let sensitivity = slave.sensitivity(unknown, known, 2.0).expect("an answer");
            assert_eq!(slave.set(known, 3.0), Status::Ok);
            let found = slave.get(unknown) - before;
            assert_eq!(slave.set(known, 1.0), Status::Ok);
            // Outputs are affine in the inputs: all but their rounding is the derivative.
            let bound = 1e-12 * before.abs().max(1.0);
            assert!((found - sensitivity).abs() < bound, "{unknown}/{known}: {sensitivity} {found}");
        }
    }
    assert_eq!(slave.sensitivity("slider.x", "slider.load", 1.0), Ok(0.0));
    slave.steps(point, 1e-3, 1);
}

#[test]
fn sensitivities_exist_in_initialization_mode_and_leave_the_run_alone() {
    let (asked, alone) = (Slave::initializing(), Slave::initializing());
    assert_eq!(asked.sensitivity("drive.torque", "crank.torque", 1.0), Ok(1.0));
    for slave in [&asked, &alone] {
        assert_eq!(slave.exit(), Status::Ok);
        assert_eq!(slave.set("crank.torque", 1.0), Status::Ok);
    }
    assert!(asked.sensitivity("slider.a", "slider.load", 1.0).is_ok());
    assert!(asked.rate("slider.a", 1).is_ok());
    for slave in [&asked, &alone] {
        slave.steps(0.0, 1e-3, 5);
    }
    assert_eq!(asked.picture(), alone.picture());
}

#[test]
fn infinity_is_never_handed_out_and_passes() {
    let slave = resting();
    assert_eq!(slave.set("crank.torque", f64::MAX), Status::Ok);
    let refused = |found: Result<f64, Status>, status: Status, name: &str| {
        assert_eq!(found, Err(status), "{name}");
        let text = slave.log.only().text;
        assert!(text.contains(name) && text.contains("not a finite number"), "{text}");
    };
    refused(slave.try_get("crank.acceleration"), Status::Discard, "crank.acceleration");
    refused(slave.rate("crank.speed", 1), Status::Discard, "crank.speed");
    refused(slave.sensitivity("crank.acceleration", "crank.torque", f64::MAX), Status::Discard, "crank.acceleration");
    assert_eq!(slave.try_get("slider.x"), Ok(slave.get("slider.x")), "what is a number is told");
    assert_eq!(slave.set("crank.torque", 1.0), Status::Ok);
    assert!(slave.get("crank.acceleration").is_finite());
    // A line may leave the numbers later than its start: such a step is refused, a shorter one is not.
    assert_eq!(slave.set_rate("slider.load", 1, f64::MAX), Status::Ok);
    assert_eq!(slave.step(0.0, 10.0), Status::Error);
    assert!(slave.log.only().text.contains("slider.load"));
    assert_eq!(slave.try_get("slider.x"), Ok(slave.get("slider.x")), "where it was");
}
