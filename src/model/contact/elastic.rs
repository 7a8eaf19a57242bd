//! Elastic force as a function of penetration: the laws that there are.

use super::elastic_law::{ElasticLaw, PowerLaw};
use super::linear::Linear;
use crate::math::Real;
use crate::scene;

/// Declares [`Elastic`] from the declared elasticities.
macro_rules! elastic {
    ($($law:ident in $file:ident,)+) => {
        $(use super::$file::$law;)+

        /// The elastic law of one contact with its numbers: one of the scene's elasticities, or that of the slider's faces.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[expect(missing_docs, reason = "each is the law of its name")]
        pub enum Elastic {
            $($law($law),)+
            Linear(Linear),
        }

        impl Elastic {
            /// Of a revolute joint.
            pub fn new(joint: &scene::Revolute) -> Self {
                match joint.elasticity {
                    $(scene::Elasticity::$law => Self::$law($law::new(joint)),)+
                }
            }

            /// Any law's, out of line: a call costs the common laws nothing.
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

            /// The power law for penetrations that go to 0.
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
    /// [N] F at the penetration `depth` [m], which is not negative.
    #[inline(always)]
    pub fn force<R: Real>(&self, depth: R) -> R {
        match self {
            Self::Hertz(law) => law.force(depth),
            Self::Linear(law) => law.force(depth),
            _ => self.rare_force(depth),
        }
    }
}
