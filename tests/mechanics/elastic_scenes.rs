//! Mechanisms with a flexible rod, elastic faces, lugre's bristles, and an account of energy.

use crate::scenes::{Play, brisk};
use slidercrank::scene::{Contact, DriveMode, FrictionLaw, Scene};

/// A soft beam of steel's density, with that many modes.
pub fn flexible(scene: &mut Scene, bending_modes: i32, axial_modes: i32) {
    let f = &mut scene.rod.flexible;
    (f.bending_modes, f.axial_modes) = (bending_modes, axial_modes);
    (f.young, f.damping_ratio, f.geometric_stiffness) = (20e9, 0.02, true);
}

/// Brisk, with a rod of two bending modes.
pub fn bending(mode: DriveMode, play: Play) -> Scene {
    let mut scene = brisk(mode, play);
    flexible(&mut scene, 2, 0);
    scene
}

/// Bristles soft enough for their equation to be no stiffer than the contacts'.
pub fn lugre(contact: &mut Contact) {
    let friction = &mut contact.friction;
    friction.law = FrictionLaw::Lugre;
    (friction.coefficient, friction.static_coefficient) = (0.1, 0.15);
    (friction.sigma0, friction.sigma1, friction.sigma2) = (1e4, 1.0, 1e-3);
    friction.v_stribeck = 0.1;
}
