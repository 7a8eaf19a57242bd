//! Usual values of parameters: values around the declared one or, if that is 0, of the size that machines have.

use super::draw::logarithmic;
use slidercrank::scene::Scene;
use std::f64::consts::PI;

/// Number of decades around the declared value.
const SPREAD: f64 = 1.0;

/// A usual value of the parameter `name` with the declared value `start`. `place`, from 0 to 1, selects the value.
pub fn usual(name: &str, start: f64, scene: &Scene, place: f64) -> f64 {
    let signed = 2.0 * place - 1.0;
    let joint = &scene.joint;
    let clearance = match name.as_bytes().get(6) {
        Some(b'A') => joint.a.clearance,
        Some(b'B') => joint.b.clearance,
        Some(b'C') => joint.c.clearance,
        _ => joint.t.clearance,
    };
    let last = name.rsplit('.').next().unwrap_or(name);
    match (name, last) {
        ("crank.angle_start", _) => signed * PI,
        ("crank.speed_start", _) => signed * 500.0,
        ("gravity", _) => signed * 20.0,
        ("gravity.angle", _) => signed * PI,
        ("slider.load.offset", _) => signed * scene.slider.height,
        ("guide.offset", _) => signed * 0.02,
        ("solver.tolerance", _) => logarithmic(1e-9, 1e-3, place),
        ("solver.step", _) => logarithmic(1e-6, 1e-4, place),
        _ if name.contains("eccentricity_start") || last == "offset_start" => signed * 0.7 * clearance,
        _ if name.contains(".com.") || name.contains(".centre.") => signed * 0.02,
        (_, "damping") => logarithmic(1e-5, 1.0, place),
        _ if name.ends_with("layer.stiffness") => logarithmic(1e12, 1e15, place),
        (_, "stiffness") => logarithmic(1e8, 1e12, place),
        (_, "foundation_stiffness") => logarithmic(1e8, 1e11, place),
        (_, "sigma2") => logarithmic(1e-5, 1e-2, place),
        (_, "viscosity") => logarithmic(1e-3, 1.0, place),
        (_, "roughness") => clearance * logarithmic(1e-3, 0.1, place),
        (_, "clearance") => logarithmic(1e-5, 1e-3, place),
        (_, "restitution") => 0.02 + 0.98 * place,
        (_, "exponent") => 1.0 + place,
        (_, "ratio_limit") => signed * 3.0,
        _ => start * 10_f64.powf(SPREAD * (place - 0.5)),
    }
}
