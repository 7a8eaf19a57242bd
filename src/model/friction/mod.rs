//! Friction: f_t = f_n·ratio(v_t), one law a file, each odd in the sliding speed.
//!
//! A law may have a state, the mean deflection of bristles between the surfaces, which a contact starts anew each time
//! that it closes. Which law it is is data and looked up where the force is computed.

// Defines `friction_laws!`, which hands the list of the declared laws to another macro.
include!(concat!(env!("OUT_DIR"), "/friction_laws.rs"));

mod law;

pub use law::{FrictionResponse, Law};

use crate::math::Real;
use crate::scene;

/// Declares the files and [`Friction`] from the declared laws.
macro_rules! friction {
    ($($law:ident in $file:ident,)+) => {
        $(mod $file; pub use $file::$law;)+

        /// The friction law of one contact with its numbers.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[expect(missing_docs, reason = "each is the law of its name")]
        pub enum Friction {
            None,
            $($law($law),)+
        }

        impl Friction {
            /// Of the scene's.
            pub fn new(friction: &scene::Friction) -> Self {
                match friction.law {
                    scene::FrictionLaw::None => Self::None,
                    $(scene::FrictionLaw::$law => Self::$law($law::new(friction)),)+
                }
            }

            /// Any law's, out of line: a call costs the common laws nothing.
            #[cold]
            #[inline(never)]
            fn rub_rarely<R: Real>(&self, v: R, z: R) -> FrictionResponse<R> {
                match self {
                    Self::None => FrictionResponse::default(),
                    $(Self::$law(law) => law.response(v, z),)+
                }
            }

            /// [m/s] Sliding speeds at which the law has corners.
            pub fn corners(&self) -> [Option<f64>; 2] {
                match self {
                    Self::None => [None; 2],
                    $(Self::$law(law) => law.corners(),)+
                }
            }

            /// [m] The deflection at which bristles at rest let go, where there are bristles.
            pub fn greatest_deflection(&self) -> Option<f64> {
                match self {
                    Self::None => None,
                    $(Self::$law(law) => law.greatest_deflection(),)+
                }
            }
        }
    };
}

friction_laws!(friction);

impl Friction {
    /// At the sliding speed `v` [m/s], with the bristles deflected by `z` [m].
    #[inline(always)]
    pub fn response<R: Real>(&self, v: R, z: R) -> FrictionResponse<R> {
        match self {
            Self::Ambrosio(law) => law.response(v, z),
            _ => self.rub_rarely(v, z),
        }
    }
}
