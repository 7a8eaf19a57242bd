//! Joints with clearance: where they are open or closed, and what force they carry.

mod corners;
pub mod foundation;
pub mod guide;
pub mod revolute;
mod rigid;

use super::contact::{ContactParameters, Damped, Elastic, HertzThreeHalves, Hysteresis, Liu, Power, Undamped, damping};
use super::friction::{Ambrosio, Friction, FrictionParameters, Frictionless, Lugre, Stribeck, Tanh};
use crate::scene::{Contact, DampingLaw, Elasticity, FrictionLaw};

/// Compiles a contact kernel for every combination of laws and hands out the scene's.
pub trait KernelFamily {
    /// The kernel's type.
    type Kernel;
    /// The kernel of one combination.
    fn kernel<E: Elastic, D: Damped, F: Friction>() -> Self::Kernel;
}

/// The kernel of the laws that the scene calls for.
pub fn choose<K: KernelFamily>(elasticity: Elasticity, contact: &Contact) -> K::Kernel {
    match elasticity {
        Elasticity::Liu => with_damping::<K, Liu>(contact),
        Elasticity::Hertz if contact.exponent == 1.5 => with_damping::<K, HertzThreeHalves>(contact),
        Elasticity::Hertz => with_damping::<K, Power>(contact),
    }
}

fn with_damping<K: KernelFamily, E: Elastic>(contact: &Contact) -> K::Kernel {
    if damping::factor(contact.law, contact.restitution) == 0.0 {
        with_friction::<K, E, Undamped>(contact)
    } else {
        with_friction::<K, E, Hysteresis>(contact)
    }
}

fn with_friction<K: KernelFamily, E: Elastic, D: Damped>(contact: &Contact) -> K::Kernel {
    match contact.friction.law {
        FrictionLaw::None => K::kernel::<E, D, Frictionless>(),
        FrictionLaw::Ambrosio => K::kernel::<E, D, Ambrosio>(),
        FrictionLaw::Tanh => K::kernel::<E, D, Tanh>(),
        FrictionLaw::Stribeck => K::kernel::<E, D, Stribeck>(),
        FrictionLaw::Lugre => K::kernel::<E, D, Lugre>(),
    }
}

/// σ_b + σ_j [1/Pa], σ = (1 − ν²)/E.
pub fn compliance(contact: &Contact) -> f64 {
    let sigma = |young: f64, poisson: f64| (1.0 - poisson * poisson) / young;
    sigma(contact.young.bearing, contact.poisson.bearing) + sigma(contact.young.journal, contact.poisson.journal)
}

/// Numbers of a contact whose stiffness is `stiffness` and, for the conformal law, whose clearance
/// is `clearance` [m].
pub fn parameters(contact: &Contact, stiffness: f64, clearance: f64) -> ContactParameters {
    let limit = contact.ratio_limit;
    ContactParameters {
        stiffness,
        exponent: contact.exponent,
        clearance,
        damping: match contact.law {
            DampingLaw::Hertz => 0.0,
            law => damping::factor(law, contact.restitution),
        },
        ratio_limit: if limit > 0.0 { limit } else { f64::INFINITY },
        speed_floor: contact.speed_floor,
        friction: FrictionParameters::new(&contact.friction),
    }
}
