//! The elastic laws: force as a function of penetration.

use super::elastic_law::{ElasticLaw, PowerLaw};
use super::linear::Linear;
use crate::math::Real;
use crate::scene;

/// Declares [`Elastic`] from the list of declared elasticities.
macro_rules! elastic {
    ($($law:ident in $file:ident,)+) => {
        $(use super::$file::$law;)+

        /// The elastic law of one contact with its parameters: one of the scene's elasticities, or that of the slider's
        /// faces.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[expect(missing_docs, reason = "each is the law of its name")]
        pub enum Elastic {
            $($law($law),)+
            Linear(Linear),
        }

        impl Elastic {
            /// The elastic law of a revolute joint.
            pub fn new(joint: &scene::Revolute) -> Self {
                match joint.elasticity {
                    $(scene::Elasticity::$law => Self::$law($law::new(joint)),)+
                }
            }

            /// The force of any law, out of line, so that the common laws do not pay for the others.
            #[cold]
            #[inline(never)]
            fn rare_force<R: Real>(&self, depth: R) -> R {
                match self {
                    $(Self::$law(law) => law.force(depth),)+
                    Self::Linear(law) => law.force(depth),
                }
            }

            /// [J] ∫F dδ from 0 to `depth` [m].
            pub fn energy<R: Real>(&self, depth: R) -> R {
                match self {
                    $(Self::$law(law) => law.energy(depth),)+
                    Self::Linear(law) => law.energy(depth),
                }
            }

            /// The power law that this law tends to as the penetration tends to 0.
            pub fn for_small_penetrations(&self) -> PowerLaw {
                match self {
                    $(Self::$law(law) => law.for_small_penetrations(),)+
                    Self::Linear(law) => law.for_small_penetrations(),
                }
            }
        }
    };
}

elasticities!(elastic);

impl Elastic {
    /// [N] F at the penetration `depth` [m] ≥ 0.
    #[inline(always)]
    pub fn force<R: Real>(&self, depth: R) -> R {
        match self {
            Self::Hertz(law) => law.force(depth),
            Self::Linear(law) => law.force(depth),
            _ => self.rare_force(depth),
        }
    }
}
