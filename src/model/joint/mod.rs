//! Joints with clearance: where they are open or closed, and what force they carry.

mod corners;
pub mod foundation;
pub mod guide;
pub mod revolute;
mod rigid;

use super::contact::{ContactParameters, Damped, Elastic, HertzThreeHalves, Hysteresis, Liu, Power, Undamped, damping};
use super::friction::{Ambrosio, Friction, FrictionParameters, Frictionless, Lugre, Stribeck, Tanh};
use crate::math::{Real, Row};
use crate::model::scalar::Tangent;
use crate::scene::{Contact, DampingLaw, Elasticity, FrictionLaw};

/// What is compiled for each combination of laws.
pub trait Kernel {
    /// The kernel for the number `R`.
    type Of<R: Real>: Clone + Copy + std::fmt::Debug;
}

/// The kernels of one combination of laws.
#[derive(Clone, Copy, Debug)]
pub struct Kernels<K: Kernel> {
    /// For plain numbers.
    pub value: K::Of<f64>,
    /// For eight numbers together.
    pub row: K::Of<Row>,
    /// For four numbers together.
    pub half: K::Of<Row<1>>,
    /// For numbers with derivatives.
    pub tangent: K::Of<Tangent>,
}

/// Compiles a contact kernel for every combination of laws and hands out the scene's.
pub trait KernelFamily {
    /// What it compiles.
    type Kernel: Kernel;
    /// The kernel of one combination.
    fn kernel<R: Real, E: Elastic, D: Damped, F: Friction>() -> <Self::Kernel as Kernel>::Of<R>;

    /// The kernels of one combination.
    fn kernels<E: Elastic, D: Damped, F: Friction>() -> Kernels<Self::Kernel> {
        Kernels {
            value: Self::kernel::<f64, E, D, F>(),
            row: Self::kernel::<Row, E, D, F>(),
            half: Self::kernel::<Row<1>, E, D, F>(),
            tangent: Self::kernel::<Tangent, E, D, F>(),
        }
    }
}

/// The kernel of the laws that the scene calls for.
pub fn choose<K: KernelFamily>(elasticity: Elasticity, contact: &Contact) -> Kernels<K::Kernel> {
    match elasticity {
        Elasticity::Liu => with_damping::<K, Liu>(contact),
        Elasticity::Hertz if contact.exponent == 1.5 => with_damping::<K, HertzThreeHalves>(contact),
        Elasticity::Hertz => with_damping::<K, Power>(contact),
    }
}

fn with_damping<K: KernelFamily, E: Elastic>(contact: &Contact) -> Kernels<K::Kernel> {
    if damping::factor(contact.law, contact.restitution) == 0.0 {
        with_friction::<K, E, Undamped>(contact)
    } else {
        with_friction::<K, E, Hysteresis>(contact)
    }
}

fn with_friction<K: KernelFamily, E: Elastic, D: Damped>(contact: &Contact) -> Kernels<K::Kernel> {
    match contact.friction.law {
        FrictionLaw::None => K::kernels::<E, D, Frictionless>(),
        FrictionLaw::Ambrosio => K::kernels::<E, D, Ambrosio>(),
        FrictionLaw::Tanh => K::kernels::<E, D, Tanh>(),
        FrictionLaw::Stribeck => K::kernels::<E, D, Stribeck>(),
        FrictionLaw::Lugre => K::kernels::<E, D, Lugre>(),
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
