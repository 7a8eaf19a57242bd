//! What the reference is told: a mechanism and its drive, as plain SI data. It can be read from any data whose fields
//! and items have these names; fields that it does not know are passed over.

use serde::Deserialize;

/// A mechanism at its start. Its `Default` is the worn pin of the literature with ideal joints, driven by a torque.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Mechanism {
    /// How the crank is driven.
    pub drive: Drive,
    /// [m/s²] Of free fall.
    pub gravity: f64,
    /// [rad] Where to, from +x.
    pub gravity_angle: f64,
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
}

/// How the crank is driven.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Drive {
    /// Torque given or speed given.
    pub mode: DriveMode,
}

/// What is given of the crank.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum DriveMode {
    /// The torque.
    Torque,
    /// The speed, which stays that of the start.
    Speed,
}

/// Crank: main journal at its reference point, crank pin at distance `length` along its x axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Crank {
    /// [rad] At the start.
    pub angle_start: f64,
    /// [rad/s] At the start.
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
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Rod {
    /// [m] Big-end centre to small-end centre.
    pub length: f64,
    /// [kg]
    pub mass: f64,
    /// [kg·m²] About the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass in body axes.
    pub com: Point,
    /// A uniform beam, in place of `mass`, `inertia` and `com` where it has modes.
    pub flexible: Flexible,
}

/// Elastic modes of the rod. No modes: rigid.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Flexible {
    /// Number of bending modes: sines between the ends.
    pub bending_modes: i32,
    /// Number of axial modes: quarter waves from the big end.
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
}

/// Slider: pin journal at its reference point; a rectangle runs in the guide.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Slider {
    /// [kg]
    pub mass: f64,
    /// [kg·m²] About the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass in body axes.
    pub com: Point,
    /// [m] Length of the rectangle.
    pub length: f64,
    /// [m] Height of the rectangle.
    pub height: f64,
    /// [m] Centre of the rectangle from the pin, in body axes.
    pub centre: Point,
    /// [m] Where the load acts, on the body's y axis.
    pub load_offset: f64,
}

/// The guide's middle line.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct GuideLines {
    /// [m] Height of the middle line above the main bearing.
    pub offset: f64,
}

/// A point or vector in the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub struct Point {
    /// [m]
    pub x: f64,
    /// [m]
    pub y: f64,
}

/// The four joints.
#[derive(Clone, Debug, PartialEq, Deserialize)]
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

/// Whether a joint has play.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum JointModel {
    /// A constraint.
    Ideal,
    /// Contact forces across a gap.
    Clearance,
}

/// A revolute joint. Of an ideal one only `damping` counts.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Revolute {
    /// Ideal or with clearance.
    pub model: JointModel,
    /// [N·m·s/rad] Viscous friction in the relative rotation.
    pub damping: f64,
    /// [m] Bearing radius.
    pub radius: f64,
    /// [m] Bearing radius minus journal radius.
    pub clearance: f64,
    /// [m] Journal centre minus bearing centre at the start.
    pub eccentricity_start: Point,
    /// Elastic force as a function of penetration.
    pub elasticity: Elasticity,
    /// The layer of that law.
    pub layer: Layer,
    /// What is between the surfaces.
    pub lubrication: Lubrication,
    /// [Pa·s] Of the oil.
    pub viscosity: f64,
    /// [m] Height of the surfaces' roughness together.
    pub roughness: f64,
    /// Materials, damping and friction of the contact.
    pub contact: Contact,
}

/// Elastic force of a journal in its bearing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Elasticity {
    /// A power of the penetration.
    Hertz,
    /// Conformal cylinders, Liu 2007.
    Liu,
    /// Elastic foundation beneath conformal cylinders, Bai and Zhao 2012.
    BaiZhao,
    /// An elastic layer on the bearing.
    Winkler,
}

/// What is between journal and bearing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Lubrication {
    /// Nothing.
    None,
    /// A film of oil, short beside its diameter.
    ShortBearing,
}

/// An elastic layer on a bearing.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Layer {
    /// [m] Thickness.
    pub thickness: f64,
    /// [N/m³] Pressure over compression; 0: from thickness and material.
    pub stiffness: f64,
}

/// The guide as a joint. Of an ideal one only `damping` counts.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Guide {
    /// Ideal or with clearance.
    pub model: JointModel,
    /// [N·s/m] Viscous friction along the guide.
    pub damping: f64,
    /// [m] Clearance on each side.
    pub clearance: f64,
    /// [m] Corner radius.
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

/// How the slider meets the guide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Surface {
    /// Four corners, each a contact of its own.
    Corner,
    /// Two faces, each on a bed of springs.
    Foundation,
}

/// Materials, damping and friction of a contact. Of the guide, `bearing` is the guide and `journal` the slider.
#[derive(Clone, Debug, PartialEq, Deserialize)]
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
    /// Most that the ratio of a rate to that at the touch counts; at or below 0: without limit.
    pub ratio_limit: f64,
    /// Restitution that the damping law is asked for.
    pub restitution: f64,
    /// [m/s] Least rate that counts as that at the touch.
    pub speed_floor: f64,
    /// Friction.
    pub friction: Friction,
}

/// A property of the outer and of the inner body.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Pair {
    /// Of the bearing, or of the guide.
    pub bearing: f64,
    /// Of the journal, or of the slider.
    pub journal: f64,
}

/// Hysteresis damping of a contact, by author.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[allow(missing_docs, reason = "names of authors; their formulas stand in `laws`")]
pub enum DampingLaw {
    Hertz,
    HuntCrossley,
    HerbertMcwhannell,
    LeeWang,
    LankaraniNikravesh,
    Gonthier,
    ZhangSharf,
    Flores,
    HuGuo,
    ZhiyingQishao,
    CarvalhoMartins,
}

/// Friction of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Friction {
    /// Which law.
    pub law: FrictionLaw,
    /// μ, the kinetic one where the law knows two.
    pub coefficient: f64,
    /// μ of a contact at rest.
    pub static_coefficient: f64,
    /// [m/s] Where Ambrosio's ramp begins.
    pub v0: f64,
    /// [m/s] Where Ambrosio's ramp ends; scale of the hyperbolic tangent.
    pub v1: f64,
    /// [m/s] Speed over which the coefficient falls.
    pub v_stribeck: f64,
    /// [1/m] Stiffness of lugre's bristles over the normal force.
    pub sigma0: f64,
    /// [s/m] Their damping.
    pub sigma1: f64,
    /// [s/m] Viscous coefficient.
    pub sigma2: f64,
}

/// Friction law of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum FrictionLaw {
    /// Frictionless.
    None,
    /// Coulomb friction with a ramp between two sliding speeds.
    Ambrosio,
    /// Coulomb friction smoothed by a hyperbolic tangent.
    Tanh,
    /// A coefficient that falls with sliding speed, on the hyperbolic tangent.
    Stribeck,
    /// Bristles that bend, slip and stick.
    Lugre,
}

/// What is reckoned up beside the motion.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Energy {
    /// Energies, works and losses.
    pub audit: bool,
}
