//! The mechanisms that the tests start from.

use reference_mechanism::Mechanism;
use reference_mechanism::mechanism::{Contact, DriveMode, FrictionLaw, JointModel};

/// The joints with clearance.
pub type Play = [bool; 4];
pub const NONE: Play = [false; 4];
pub const ALL: Play = [true; 4];

/// The worn pin of the literature: clearance at C, 5000 rpm, from dead centre.
pub fn worn_pin() -> Mechanism {
    let mut mechanism = Mechanism::default();
    mechanism.drive.mode = DriveMode::Speed;
    mechanism.crank.speed_start = 5000.0 * std::f64::consts::TAU / 60.0;
    mechanism.joint.c.model = JointModel::Clearance;
    mechanism
}

/// A fast mechanism off dead centre with small clearances, so that impacts come soon.
pub fn brisk(mode: DriveMode, play: Play) -> Mechanism {
    let mut mechanism = Mechanism::default();
    mechanism.drive.mode = mode;
    mechanism.crank.angle_start = 0.7;
    mechanism.crank.speed_start = 300.0;
    let model = play.map(|has| if has { JointModel::Clearance } else { JointModel::Ideal });
    let joint = &mut mechanism.joint;
    (joint.a.model, joint.b.model, joint.c.model, joint.t.model) = (model[0], model[1], model[2], model[3]);
    (joint.a.clearance, joint.b.clearance, joint.c.clearance, joint.t.clearance) = (8e-5, 1e-4, 1.2e-4, 9e-5);
    mechanism
}

/// The contact data of all four joints.
pub fn each_contact(mechanism: &mut Mechanism, change: impl Fn(&mut Contact)) {
    let joint = &mut mechanism.joint;
    for contact in [&mut joint.a.contact, &mut joint.b.contact, &mut joint.c.contact, &mut joint.t.contact] {
        change(contact);
    }
}

/// A soft beam of steel's density, with that many modes.
pub fn flexible(mechanism: &mut Mechanism, bending_modes: i32, axial_modes: i32) {
    let f = &mut mechanism.rod.flexible;
    (f.bending_modes, f.axial_modes) = (bending_modes, axial_modes);
    (f.young, f.damping_ratio, f.geometric_stiffness) = (20e9, 0.02, true);
}

/// Bristles soft enough for their equation to be no stiffer than the contacts'.
pub fn lugre(contact: &mut Contact) {
    let friction = &mut contact.friction;
    friction.law = FrictionLaw::Lugre;
    (friction.coefficient, friction.static_coefficient) = (0.1, 0.15);
    (friction.sigma0, friction.sigma1, friction.sigma2) = (1e4, 1.0, 1e-3);
    friction.v_stribeck = 0.1;
}
