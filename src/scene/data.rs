//! The data of a scene.

use super::enumerations::{DampingLaw, DriveMode, Elasticity, FrictionLaw, JointModel, Lubrication, Method, Surface};
use super::modal::ModalTable;
use serde::{Deserialize, Serialize};

/// The parameters that are fixed before time advances; the model is assembled from them. The `Default` of a scene has
/// the declared start values; the `Default` of its parts has zeros.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Drive of the crank.
    pub drive: Drive,
    /// [m/s²] Gravity.
    pub gravity: f64,
    /// [rad] Direction of gravity, counter-clockwise from +x.
    pub gravity_angle: f64,
    /// Body 1: crank.
    pub crank: Crank,
    /// Body 2: rod.
    pub rod: Rod,
    /// Body 3: slider.
    pub slider: Slider,
    /// The two lines of the guide.
    pub guide: GuideLines,
    /// The four joints.
    pub joint: Joints,
    /// Energy accounts.
    pub energy: Energy,
    /// Time integration.
    pub solver: Solver,
}

/// Drive of the crank.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Whether the torque or the angle is prescribed.
    pub mode: DriveMode,
}

/// Crank: main journal at its reference point, crank pin at distance `length` along its x axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Crank {
    /// [rad] θ0: angle at the start.
    pub angle_start: f64,
    /// [rad/s] ω0: speed at the start, and constant speed of a speed drive.
    pub speed_start: f64,
    /// [m] Distance from the main journal's centre to the crank pin's centre.
    pub length: f64,
    /// [kg] Mass.
    pub mass: f64,
    /// [kg·m²] Moment of inertia about the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass in body axes.
    pub com: Point,
}

/// Connecting rod: big end at its reference point, small end at distance `length` along its x axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rod {
    /// [m] Distance from the big end's centre to the small end's centre.
    pub length: f64,
    /// [kg] Mass.
    pub mass: f64,
    /// [kg·m²] Moment of inertia about the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass in body axes.
    pub com: Point,
    /// Flexibility. With modes, the mass properties of the beam replace `mass`, `inertia` and `com`.
    pub flexible: Flexible,
}

/// Elastic modes of the rod: those of a uniform beam, unless a table is given. A rod without modes is rigid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flexible {
    /// Number of bending modes.
    pub bending_modes: i32,
    /// Number of axial modes.
    pub axial_modes: i32,
    /// [Pa] Young's modulus.
    pub young: f64,
    /// [kg/m³] Density.
    pub density: f64,
    /// [m²] Area of the cross-section.
    pub area: f64,
    /// [m⁴] Second moment of area of the cross-section.
    pub second_moment: f64,
    /// Damping ratio of every mode.
    pub damping_ratio: f64,
    /// Whether bending foreshortens the rod.
    pub geometric_stiffness: bool,
    /// Modal table that replaces the uniform beam; its first `bending_modes` and `axial_modes` modes are used.
    pub table: Option<ModalTable>,
}

/// Slider: its pin journal is at the reference point; a rectangle runs in the guide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Slider {
    /// [kg] Mass.
    pub mass: f64,
    /// [kg·m²] Moment of inertia about the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass in body axes.
    pub com: Point,
    /// [m] Length of the rectangle, 2a.
    pub length: f64,
    /// [m] Height of the rectangle, 2b.
    pub height: f64,
    /// [m] Centre of the rectangle from the pin, in body axes.
    pub centre: Point,
    /// [m] Point where the load acts: its distance from the pin across the guide, in body axes.
    pub load_offset: f64,
}

/// The guide's middle line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GuideLines {
    /// [m] Height h of the middle line above the main bearing.
    pub offset: f64,
}

/// A point or vector in the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// [m] x coordinate.
    pub x: f64,
    /// [m] y coordinate.
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

/// A revolute joint. An ideal joint uses only `damping`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Revolute {
    /// Whether the joint is ideal or has clearance.
    pub model: JointModel,
    /// [N·m·s/rad] Viscous friction of the relative rotation.
    pub damping: f64,
    /// [m] Bearing radius R_b.
    pub radius: f64,
    /// [m] Radial clearance c = R_b − R_j.
    pub clearance: f64,
    /// [m] Eccentricity at the start: journal centre minus bearing centre.
    pub eccentricity_start: Point,
    /// Elastic law.
    pub elasticity: Elasticity,
    /// Elastic layer on the bearing, if the elastic law has one.
    pub layer: Layer,
    /// Oil film, if any.
    pub lubrication: Lubrication,
    /// [Pa·s] Dynamic viscosity of the oil.
    pub viscosity: f64,
    /// [m] Composite (root mean square) height of the roughness of journal and bearing.
    pub roughness: f64,
    /// Materials, damping and friction of the contact.
    pub contact: Contact,
    /// Whether the largest force between communication points is asked for.
    pub peak: Audit,
    /// Whether the integrals over sliding are asked for.
    pub wear: Audit,
}

/// Something that is computed beside the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Audit {
    /// Whether it is asked for.
    pub audit: bool,
}

/// An elastic layer on a bearing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// [m] Thickness.
    pub thickness: f64,
    /// [N/m³] Pressure per compression; 0 selects that of the thickness and the bearing's material.
    pub stiffness: f64,
}

/// The guide as a joint. An ideal guide uses only `damping`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Guide {
    /// Whether the guide is ideal or has clearance.
    pub model: JointModel,
    /// [N·s/m] Viscous friction along the guide.
    pub damping: f64,
    /// [m] Clearance c_T on each side.
    pub clearance: f64,
    /// [m] Corner radius R_c.
    pub corner_radius: f64,
    /// [m] Height of the rectangle's centre above the middle line at the start.
    pub offset_start: f64,
    /// Whether corners or faces are in contact.
    pub surface: Surface,
    /// [N/m²] Stiffness of the faces per length; 0 selects that of the elastic half-space.
    pub foundation_stiffness: f64,
    /// Materials, damping and friction of the contact.
    pub contact: Contact,
    /// Whether the largest force between communication points is asked for.
    pub peak: Audit,
    /// Whether the integrals over sliding are asked for.
    pub wear: Audit,
}

/// Materials, damping and friction of a contact. For the guide, `bearing` is the guide and
/// `journal` the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// [Pa] Young's moduli.
    pub young: Pair,
    /// Poisson's ratios.
    pub poisson: Pair,
    /// [N/m^p] Contact stiffness; 0 selects Hertz's stiffness.
    pub stiffness: f64,
    /// Exponent p of the elastic force.
    pub exponent: f64,
    /// [m] Axial length of the bearing or guide.
    pub width: f64,
    /// Law of hysteresis damping.
    pub law: DampingLaw,
    /// Limit s_max of the damping ratio; there is no limit at or below 0.
    pub ratio_limit: f64,
    /// Coefficient of restitution c_r.
    pub restitution: f64,
    /// [m/s] Lower limit v_floor of the approach speed.
    pub speed_floor: f64,
    /// Friction.
    pub friction: Friction,
}

/// A property of the outer and of the inner body of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Property of the bearing or the guide.
    pub bearing: f64,
    /// Property of the journal or the slider.
    pub journal: f64,
}

/// Friction of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Friction {
    /// Friction law.
    pub law: FrictionLaw,
    /// μ: coefficient, or kinetic coefficient of a law that has two.
    pub coefficient: f64,
    /// μ_s: static coefficient.
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

/// Energy accounts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Whether energies, works and losses are computed.
    pub audit: bool,
}

/// Time integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Solver {
    /// Integration method.
    pub method: Method,
    /// Relative tolerance.
    pub tolerance: f64,
    /// [s] Step of fixed-step methods.
    pub step: f64,
    /// Maximum number of evaluations of the equations of motion in one communication step; 0 selects the simulation's
    /// default.
    pub max_evaluations: i32,
    /// [1/s] Maximum number of evaluations of the equations of motion per second of simulated time, which an adaptive
    /// method keeps at the cost of accuracy; 0 means none.
    pub deadline: f64,
    /// [s] Length of the intervals, each of which has its share of the evaluations of `deadline`.
    pub deadline_interval: f64,
    /// The same bits on every processor. It is the FMU that has two libraries to choose from.
    pub portable: bool,
}
