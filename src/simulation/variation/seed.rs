//! By what a motion is differentiated.

use crate::scene::parameter::Parameter;

/// By what a motion is differentiated.
#[derive(Clone, Copy)]
pub enum Seed {
    /// A state where the tangent begins, by its index.
    State(usize),
    /// [m/s] The approach speed of a contact that is closed where the tangent begins, by its index.
    Approach(usize),
    /// A real parameter of the scene.
    Parameter(&'static Parameter),
    /// [N·m] The crank torque from where the tangent begins.
    CrankTorque,
    /// [N] The slider load from where the tangent begins.
    SliderLoad,
}
