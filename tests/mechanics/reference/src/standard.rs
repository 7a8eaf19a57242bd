//! The mechanism that others are told by their differences from.

use crate::mechanism::{
    Contact, Crank, DampingLaw, Drive, DriveMode, Elasticity, Energy, Flexible, Friction, FrictionLaw, Guide,
    GuideLines, JointModel, Joints, Layer, Lubrication, Mechanism, Pair, Point, Revolute, Rod, Slider, Surface,
};

impl Default for Mechanism {
    fn default() -> Self {
        let origin = Point::default();
        Self {
            drive: Drive { mode: DriveMode::Torque },
            gravity: 0.0,
            gravity_angle: -std::f64::consts::FRAC_PI_2,
            crank: Crank {
                angle_start: 0.0,
                speed_start: 0.0,
                length: 0.05,
                mass: 0.30,
                inertia: 1e-4,
                com: Point { x: 0.025, y: 0.0 },
            },
            rod: Rod { length: 0.12, mass: 0.21, inertia: 2.5e-4, com: Point { x: 0.06, y: 0.0 }, flexible: beam() },
            slider: Slider {
                mass: 0.14,
                inertia: 1e-4,
                com: origin,
                length: 0.04,
                height: 0.02,
                centre: origin,
                load_offset: 0.0,
            },
            guide: GuideLines { offset: 0.0 },
            joint: Joints { a: revolute(), b: revolute(), c: revolute(), t: guide() },
            energy: Energy { audit: false },
        }
    }
}

/// Of steel, as heavy as the rigid rod; without modes it does not count.
fn beam() -> Flexible {
    Flexible {
        bending_modes: 0,
        axial_modes: 0,
        young: 207e9,
        density: 7850.0,
        area: 2.23e-4,
        second_moment: 4.1e-9,
        damping_ratio: 0.01,
        geometric_stiffness: true,
    }
}

fn revolute() -> Revolute {
    Revolute {
        model: JointModel::Ideal,
        damping: 0.0,
        radius: 0.01,
        clearance: 5e-4,
        eccentricity_start: Point::default(),
        elasticity: Elasticity::Hertz,
        layer: Layer { thickness: 1e-3, stiffness: 0.0 },
        lubrication: Lubrication::None,
        viscosity: 0.05,
        roughness: 1e-6,
        contact: contact(),
    }
}

fn guide() -> Guide {
    Guide {
        model: JointModel::Ideal,
        damping: 0.0,
        clearance: 5e-4,
        corner_radius: 1e-3,
        offset_start: 0.0,
        surface: Surface::Corner,
        foundation_stiffness: 0.0,
        contact: contact(),
    }
}

/// Steel on steel.
fn contact() -> Contact {
    let both = |value: f64| Pair { bearing: value, journal: value };
    Contact {
        young: both(207e9),
        poisson: both(0.3),
        stiffness: 0.0,
        exponent: 1.5,
        width: 0.02,
        law: DampingLaw::LankaraniNikravesh,
        ratio_limit: 1.0,
        restitution: 0.9,
        speed_floor: 1e-3,
        friction: Friction {
            law: FrictionLaw::None,
            coefficient: 0.03,
            static_coefficient: 0.05,
            v0: 1e-3,
            v1: 1e-2,
            v_stribeck: 1e-2,
            sigma0: 1e5,
            sigma1: 300.0,
            sigma2: 0.0,
        },
    }
}
