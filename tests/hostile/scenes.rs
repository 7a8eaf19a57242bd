//! Mechanisms that differ in all that a saved state holds.

use crate::brief;
use crate::face::Face;
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::v2::Status;
use slidercrank::scene::parameter::Parameter;
use slidercrank::scene::{Scene, slot};

/// A mechanism, by what its start values differ in.
pub struct Mechanism {
    pub name: &'static str,
    integers: &'static [(&'static str, i32)],
    reals: &'static [(&'static str, f64)],
    audit: bool,
}

/// Speed of the crank [rad/s], and an angle away from the dead centre, where a load turns it.
const TURNING: [(&str, f64); 2] = [("crank.speed_start", 500.0), ("crank.angle_start", 1.0)];

const CLEARANCE: i32 = 2;

/// Place of the mechanism whose states are those of the declared start values.
const IDEAL: usize = 1;

pub const MECHANISMS: [Mechanism; 6] = [
    Mechanism { name: "worn pin", integers: &[("joint.C.model", CLEARANCE)], reals: &TURNING, audit: false },
    Mechanism { name: "ideal", integers: &[], reals: &TURNING, audit: false },
    // Without any state.
    Mechanism { name: "ideal at a speed", integers: &[("drive.mode", 2)], reals: &TURNING, audit: false },
    Mechanism {
        name: "rigid contacts",
        integers: &[("joint.C.model", CLEARANCE), ("joint.T.model", CLEARANCE), ("solver.method", 8)],
        reals: &[("crank.speed_start", 200.0), ("crank.angle_start", 1.0), ("solver.step", 1e-5)],
        audit: false,
    },
    Mechanism {
        name: "four plays, bristles, audit",
        integers: &[
            ("joint.A.model", CLEARANCE),
            ("joint.B.model", CLEARANCE),
            ("joint.C.model", CLEARANCE),
            ("joint.T.model", CLEARANCE),
            ("joint.C.friction.law", 5),
            ("joint.T.friction.law", 5),
            ("solver.method", 3),
        ],
        reals: &TURNING,
        audit: true,
    },
    Mechanism {
        name: "flexible rod",
        integers: &[("rod.flexible.bending_modes", 2), ("rod.flexible.axial_modes", 1), ("joint.C.model", CLEARANCE)],
        reals: &[("crank.speed_start", 100.0), ("crank.angle_start", 1.0)],
        audit: false,
    },
];

impl Mechanism {
    /// Start values in which it differs from the declared ones.
    fn starts(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let integers = self.integers.iter().map(|(name, value)| (*name, f64::from(*value)));
        integers.chain(self.reals.iter().copied()).chain([("energy.audit", f64::from(u8::from(self.audit)))])
    }

    /// As a library is packaged with it.
    pub fn scene(&self) -> Scene {
        let mut scene = Scene::default();
        for (name, value) in self.starts() {
            Parameter::named(name).expect("a parameter").write(&mut scene, value).expect("a legal value");
        }
        scene
    }

    /// An instance in initialization mode.
    pub fn initializing<F: Face>(&self) -> F {
        self.initializing_from(0.0)
    }

    /// The same, with the start time `start` [s].
    pub fn initializing_from<F: Face>(&self, start: f64) -> F {
        let slave = F::new();
        assert_eq!(slave.enter_from(start), Status::Ok);
        for (name, value) in self.starts() {
            assert_eq!(slave.set(name, value), Status::Ok, "{name}: {:?}", slave.lines());
        }
        slave
    }

    /// An instance at time 0.
    pub fn running<F: Face>(&self) -> F {
        self.running_from(0.0)
    }

    /// An instance at the time `start` [s].
    pub fn running_from<F: Face>(&self, start: f64) -> F {
        let slave = self.initializing_from::<F>(start);
        assert_eq!(slave.begin(), Status::Ok, "{}: {:?}", self.name, slave.lines());
        slave
    }
}

/// The mechanism that the linked library is packaged with, which is the only one for model exchange.
pub fn packaged() -> usize {
    let scene = slot::read().expect("a readable slot").0;
    MECHANISMS.iter().position(|mechanism| mechanism.scene() == scene).unwrap_or(IDEAL)
}

/// The mechanisms that can be hosted so, or the first of them.
pub fn hosted<F: Face>() -> Vec<usize> {
    match F::INTERFACE {
        Interface::ModelExchange => vec![packaged()],
        Interface::CoSimulation if brief() => vec![0],
        Interface::CoSimulation => (0..MECHANISMS.len()).collect(),
    }
}
