//! Derivatives: of outputs in time, and of outputs with respect to inputs, forward and adjoint.

use crate::importer::{Handle, Options, Slave, vr};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::fmi::v3::abi::types::*;

impl Handle {
    /// The independent variable.
    pub fn time(&self) -> f64 {
        let reference = slidercrank::fmi::v3::variables::time_reference();
        self.try_get_reference(reference).expect("the time")
    }
}

const OUTPUTS: [&str; 3] = ["slider.a", "joint.C.force.x", "crank.acceleration"];
const INPUTS: [&str; 2] = ["crank.torque", "slider.load"];

/// A function of the standard that takes a product with the Jacobian of outputs by inputs, or with its transpose.
type Product = unsafe extern "C" fn(
    fmi3Instance,
    *const fmi3ValueReference,
    usize,
    *const fmi3ValueReference,
    usize,
    *const fmi3Float64,
    usize,
    *mut fmi3Float64,
    usize,
) -> fmi3Status;

fn product<const SEEDS: usize, const ANSWERS: usize>(of: Product, slave: &Slave, seed: [f64; SEEDS]) -> [f64; ANSWERS] {
    let (unknowns, knowns, mut answer) = (OUTPUTS.map(vr), INPUTS.map(vr), [f64::NAN; ANSWERS]);
    // SAFETY: live instance, arrays of the lengths said.
    let status = unsafe {
        of(
            slave.0,
            unknowns.as_ptr(),
            unknowns.len(),
            knowns.as_ptr(),
            knowns.len(),
            seed.as_ptr(),
            SEEDS,
            answer.as_mut_ptr(),
            ANSWERS,
        )
    };
    assert_eq!(status, Status::Ok);
    answer
}

/// J·seed.
fn forward(slave: &Slave, seed: [f64; 2]) -> [f64; 3] {
    product(fmi3GetDirectionalDerivative, slave, seed)
}

/// Jᵀ·seed.
fn adjoint(slave: &Slave, seed: [f64; 3]) -> [f64; 2] {
    product(fmi3GetAdjointDerivative, slave, seed)
}

#[test]
fn the_adjoint_is_the_transpose() {
    let slave = Slave::running(Options::default());
    slave.step(0.0, 1e-3);
    let columns = [forward(&slave, [1.0, 0.0]), forward(&slave, [0.0, 1.0])];
    assert!(columns.iter().flatten().any(|slope| *slope != 0.0));
    for i in 0..3 {
        let mut seed = [0.0; 3];
        seed[i] = 1.0;
        assert_eq!(adjoint(&slave, seed), [columns[0][i], columns[1][i]]);
    }
    let (seed, direction) = ([0.3, -2.0, 0.7], [5.0, -11.0]);
    let one: f64 = forward(&slave, direction).iter().zip(seed).map(|(slope, seed)| slope * seed).sum();
    let other: f64 = adjoint(&slave, seed).iter().zip(direction).map(|(slope, seed)| slope * seed).sum();
    assert!((one - other).abs() <= 1e-12 * one.abs().max(1.0), "{one} and {other}");
}

#[test]
fn rates_are_those_of_fmi2() {
    let (three, two) = (Slave::running(Options::default()), host::Slave::running());
    three.step(0.0, 1e-3);
    two.steps(0.0, 1e-3, 1);
    for name in ["slider.x", "slider.v", "joint.C.force.x", "accuracy.position"] {
        assert_eq!(three.rate(name).map(f64::to_bits), Ok(two.rate(name, 1).expect("a rate").to_bits()), "{name}");
    }
    assert_eq!(three.rate("slider.v").map(f64::to_bits), Ok(three.get("slider.a").to_bits()));
}

#[test]
fn the_time_is_a_variable() {
    let slave = Slave::new(Options { logging: true, ..Options::default() });
    let reference = slidercrank::fmi::v3::variables::time_reference();
    assert_eq!(slave.enter_with(None, 3.0, None), Status::Ok);
    assert_eq!(slave.time(), 3.0);
    assert_eq!(slave.exit(), Status::Ok);
    assert_eq!(slave.step(3.0, 0.25).time, 3.25);
    let (references, mut values) = ([vr("crank.angle"), reference, vr("slider.x"), reference], [f64::NAN; 4]);
    // SAFETY: live instance, arrays of the lengths said.
    let status = unsafe { fmi3GetFloat64(slave.0, references.as_ptr(), 4, values.as_mut_ptr(), 4) };
    assert_eq!(status, Status::Ok);
    assert_eq!(values, [slave.get("crank.angle"), 3.25, slave.get("slider.x"), 3.25]);
    // Only the standard's own functions move it.
    // SAFETY: live instance, arrays of one entry.
    assert_eq!(unsafe { fmi3SetFloat64(slave.0, &reference, 1, &1.0, 1) }, Status::Error);
}
