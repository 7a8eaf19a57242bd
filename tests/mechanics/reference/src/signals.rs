//! What goes into the mechanism and what comes out of it.

/// Inputs at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {
    /// [N·m] Torque on the crank; ignored where its speed is given.
    pub crank_torque: f64,
    /// [N] Force on the slider along +x at its pin centre.
    pub slider_load: f64,
}

/// Outputs at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outputs {
    /// Motion of the slider.
    pub slider: SliderOutputs,
    /// Motion of the crank.
    pub crank: CrankOutputs,
    /// Motion of the rod.
    pub rod: RodOutputs,
    /// Main bearing: force of the ground on the crank.
    pub joint_a: RevoluteOutputs,
    /// Crank pin: force of the crank on the rod.
    pub joint_b: RevoluteOutputs,
    /// Slider pin: force of the rod on the slider.
    pub joint_c: RevoluteOutputs,
    /// Force of the guide on the slider.
    pub joint_t: GuideOutputs,
    /// [N·m] Torque on the crank: the input, or what its speed needs.
    pub drive_torque: f64,
    /// [W] Of that torque.
    pub drive_power: f64,
    /// Slider against the ideal rigid mechanism at the same crank motion.
    pub accuracy: AccuracyOutputs,
    /// Energies, works and losses, with an audit; 0 otherwise.
    pub energy: EnergyOutputs,
}

/// Motion of the slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderOutputs {
    /// [m] Pin centre along the guide.
    pub x: f64,
    /// [m/s]
    pub v: f64,
    /// [m/s²]
    pub a: f64,
    /// [m] Pin centre across the guide.
    pub y: f64,
    /// [rad] Tilt.
    pub angle: f64,
}

/// Motion of the crank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrankOutputs {
    /// [rad] Unwrapped.
    pub angle: f64,
    /// [rad/s]
    pub speed: f64,
    /// [rad/s²]
    pub acceleration: f64,
}

/// Motion of the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodOutputs {
    /// [rad]
    pub angle: f64,
    /// [rad/s]
    pub speed: f64,
    /// [m] Deflection at mid-span; 0 of a rigid rod.
    pub deflection: f64,
    /// [m] Stretch from end to end; 0 of a rigid rod.
    pub stretch: f64,
}

/// State and force of a revolute joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RevoluteOutputs {
    /// [N] x and y.
    pub force: [f64; 2],
    /// [m] Journal centre minus bearing centre.
    pub eccentricity: [f64; 2],
    /// [m] Negative when open; 0 of an ideal joint.
    pub penetration: f64,
    /// [N] Of the oil's pressure.
    pub film_force: f64,
    /// [N·m] Of the oil on the journal's body, about the journal's centre.
    pub film_moment: f64,
    /// [m/s] Of the fastest touch since the last of the times that were moved to.
    pub impact_speed: f64,
    /// Touches since the start.
    pub impacts: i32,
    /// In contact.
    pub contact: bool,
}

/// State and force of the guide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GuideOutputs {
    /// [N] x and y.
    pub force: [f64; 2],
    /// [N·m] About the slider pin.
    pub moment: f64,
    /// [m] The deepest corner's; negative when open; 0 of an ideal guide.
    pub penetration: f64,
    /// [m/s] Of the fastest touch since the last of the times that were moved to.
    pub impact_speed: f64,
    /// Touches since the start.
    pub impacts: i32,
    /// Number of corners in contact.
    pub contacts: i32,
}

/// Slider minus the ideal rigid mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccuracyOutputs {
    /// [m]
    pub position: f64,
    /// [m/s]
    pub velocity: f64,
    /// [m/s²]
    pub acceleration: f64,
}

/// Energies, works since the start and losses since the start [J].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyOutputs {
    /// Kinetic.
    pub kinetic: f64,
    /// Gravity (heights from y = 0), elastic rod and contacts.
    pub potential: f64,
    /// Work of torque and load.
    pub input: f64,
    /// Lost in contacts, friction, viscous and modal damping.
    pub dissipated: f64,
    /// Change of (kinetic + potential) − input + dissipated.
    pub residual: f64,
    /// Gravity's part of `potential`.
    pub gravity: f64,
    /// The rod's part of `potential`.
    pub elastic: f64,
    /// The contacts' part of `potential`.
    pub contact: f64,
    /// The torque's part of `input`.
    pub torque_work: f64,
    /// The slider load's part of `input`.
    pub load_work: f64,
    /// The contacts' hysteresis in `dissipated`.
    pub contact_loss: f64,
    /// Friction in `dissipated`.
    pub friction_loss: f64,
    /// Viscous friction in `dissipated`.
    pub viscous_loss: f64,
    /// Modal damping in `dissipated`.
    pub modal_loss: f64,
}
