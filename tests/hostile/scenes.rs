//! Mechanisms that differ in all that a saved state holds.

use crate::host::Slave;
use slidercrank::fmi::v2::Status;

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
    /// An instance in initialization mode.
    pub fn initializing(&self) -> Slave {
        self.initializing_from(0.0)
    }

    /// The same, with the start time `start` [s].
    pub fn initializing_from(&self, start: f64) -> Slave {
        let slave = Slave::new();
        assert_eq!(slave.setup_raw(0, 0.0, start, 0, 0.0), Status::Ok);
        assert_eq!(slave.enter(), Status::Ok);
        for (name, value) in self.integers {
            assert_eq!(slave.set_integer(name, *value), Status::Ok, "{name}");
        }
        for (name, value) in self.reals {
            assert_eq!(slave.set(name, *value), Status::Ok, "{name}");
        }
        assert_eq!(slave.set_boolean("energy.audit", i32::from(self.audit)), Status::Ok);
        slave
    }

    /// An instance at time 0.
    pub fn running(&self) -> Slave {
        self.running_from(0.0)
    }

    /// An instance at the time `start` [s].
    pub fn running_from(&self, start: f64) -> Slave {
        let slave = self.initializing_from(start);
        assert_eq!(slave.exit(), Status::Ok, "{}: {:?}", self.name, slave.log.take());
        slave
    }
}
