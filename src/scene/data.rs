//! What a scene holds.

use super::enumerations::{DampingLaw, DriveMode, Elasticity, FrictionLaw, JointModel, Method, Surface};
use super::modal::ModalTable;
use serde::{Deserialize, Serialize};

/// Everything that is fixed before time runs. The only ground state: the model is made from it.
/// Its `Default` has the declared start values; those of its parts are blank.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// How the crank is driven.
    pub drive: Drive,
    /// [m/s²] Gravity, along −y.
    pub gravity: f64,
    /// Body 1.
    pub crank: Crank,
    /// Body 2.
    pub rod: Rod,
    /// Body 3.
    pub slider: Slider,
    /// The two lines that the slider runs between.
    pub guide: GuideLines,
    /// The four joints.
    pub joint: Joints,
    /// What is reckoned up beside the motion.
    pub energy: Energy,
    /// How time is integrated.
    pub solver: Solver,
}

/// How the crank is driven.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Torque given or angle given.
    pub mode: DriveMode,
}

/// Crank: main journal at its reference point, crank pin at distance `length` along its x axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Crank {
    /// [rad] θ0.
    pub angle_start: f64,
    /// [rad/s] ω0, also the speed drive's speed.
    pub speed_start: f64,
    /// [m] Main journal centre to crank-pin centre.
    pub length: f64,
    /// [kg]
    pub mass: f64,
    /// [kg·m²] About the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass in body axes.
    pub com: Point,
}

/// Connecting rod: big end at its reference point, small end at distance `length` along its x axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rod {
    /// [m] Big-end centre to small-end centre.
    pub length: f64,
    /// [kg]
    pub mass: f64,
    /// [kg·m²] About the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass in body axes.
    pub com: Point,
    /// Bending and stretching. With modes, `mass`, `inertia` and `com` are the beam's.
    pub flexible: Flexible,
}

/// Elastic modes of the rod: a uniform beam. No modes: rigid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flexible {
    /// Number of bending modes.
    pub bending_modes: i32,
    /// Number of axial modes.
    pub axial_modes: i32,
    /// [Pa] Young's modulus.
    pub young: f64,
    /// [kg/m³]
    pub density: f64,
    /// [m²] Area of the cross-section.
    pub area: f64,
    /// [m⁴] Second moment of the cross-section.
    pub second_moment: f64,
    /// Damping ratio of every mode.
    pub damping_ratio: f64,
    /// Foreshortening of the bent rod.
    pub geometric_stiffness: bool,
    /// Modes that stand in for the beam's: the first `bending_modes` and `axial_modes` of them.
    pub table: Option<ModalTable>,
}

/// Slider: pin journal at its reference point; a rectangle runs in the guide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Slider {
    /// [kg]
    pub mass: f64,
    /// [kg·m²] About the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass in body axes.
    pub com: Point,
    /// [m] Length of the rectangle, 2a.
    pub length: f64,
    /// [m] Height of the rectangle, 2b.
    pub height: f64,
    /// [m] Centre of the rectangle from the pin, in body axes.
    pub centre: Point,
}

/// The guide's middle line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GuideLines {
    /// [m] Height of the middle line above the main bearing, h.
    pub offset: f64,
}

/// A point or vector in the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// [m]
    pub x: f64,
    /// [m]
    pub y: f64,
}

/// The four joints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Joints {
    /// Main bearing: ground and crank.
    pub a: Revolute,
    /// Crank pin: rod's big end and crank.
    pub b: Revolute,
    /// Slider pin: rod's small end and slider.
    pub c: Revolute,
    /// Guide: ground and slider.
    pub t: Guide,
}

/// A revolute joint. Of an ideal one only `damping` counts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Revolute {
    /// Ideal or with clearance.
    pub model: JointModel,
    /// [N·m·s/rad] Viscous friction in the relative rotation.
    pub damping: f64,
    /// [m] Bearing radius R_b.
    pub radius: f64,
    /// [m] Radial clearance c = R_b − R_j.
    pub clearance: f64,
    /// [m] Journal centre minus bearing centre at the start.
    pub eccentricity_start: Point,
    /// Elastic force as a function of penetration.
    pub elasticity: Elasticity,
    /// Materials, damping and friction of the contact.
    pub contact: Contact,
}

/// The guide as a joint. Of an ideal one only `damping` counts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Guide {
    /// Ideal or with clearance.
    pub model: JointModel,
    /// [N·s/m] Viscous friction along the guide.
    pub damping: f64,
    /// [m] Clearance on each side, c_T.
    pub clearance: f64,
    /// [m] Corner radius R_c.
    pub corner_radius: f64,
    /// [m] Rectangle's centre above the middle line at the start.
    pub offset_start: f64,
    /// Corners or faces.
    pub surface: Surface,
    /// [N/m²] Stiffness of the faces per length; 0: of the elastic half-space.
    pub foundation_stiffness: f64,
    /// Materials, damping and friction of the contact.
    pub contact: Contact,
}

/// Materials, damping and friction of a contact. For the guide, `bearing` is the guide and
/// `journal` the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// [Pa] Young's moduli.
    pub young: Pair,
    /// Poisson's ratios.
    pub poisson: Pair,
    /// [N/m^p] Above 0: in place of Hertz's stiffness.
    pub stiffness: f64,
    /// Exponent p of the elastic force.
    pub exponent: f64,
    /// [m] Axial length of the bearing or guide.
    pub width: f64,
    /// Hysteresis damping.
    pub law: DampingLaw,
    /// Limit of the damping ratio, s_max; at or below 0: none.
    pub ratio_limit: f64,
    /// Restitution c_r.
    pub restitution: f64,
    /// [m/s] Least approach speed, v_floor.
    pub speed_floor: f64,
    /// Friction.
    pub friction: Friction,
}

/// A property of the outer and of the inner body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Of the bearing, or of the guide.
    pub bearing: f64,
    /// Of the journal, or of the slider.
    pub journal: f64,
}

/// Friction of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Friction {
    /// Which law.
    pub law: FrictionLaw,
    /// μ, the kinetic one where the law knows two.
    pub coefficient: f64,
    /// μ_s.
    pub static_coefficient: f64,
    /// [m/s] v0 of Ambrosio's ramp.
    pub v0: f64,
    /// [m/s] v1 of Ambrosio's ramp and of the hyperbolic tangent.
    pub v1: f64,
    /// [m/s] Stribeck speed v_s.
    pub v_stribeck: f64,
    /// [1/m] Bristle stiffness σ0 of lugre.
    pub sigma0: f64,
    /// [s/m] Bristle damping σ1.
    pub sigma1: f64,
    /// [s/m] Viscous coefficient σ2.
    pub sigma2: f64,
}

/// What is reckoned up beside the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Energies, works and losses.
    pub audit: bool,
}

/// How time is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Solver {
    /// Which method.
    pub method: Method,
    /// Relative tolerance.
    pub tolerance: f64,
    /// [s] Step of the fixed-step methods.
    pub step: f64,
    /// Most evaluations of the equations of motion in one communication step; 0 leaves it to the simulation.
    pub max_evaluations: i32,
    /// The same bits on every processor. It is the FMU that has two libraries to choose from.
    pub portable: bool,
}
