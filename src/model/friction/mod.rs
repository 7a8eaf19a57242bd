//! Friction: f_t = f_n·ratio(v_t). Each law has a file and is odd in the sliding speed.
//!
//! A law may have a state, the mean deflection of bristles between the surfaces, which is reset when the contact opens.
//! The laws are data: the force evaluation branches on them.

// Defines `friction_laws!`, which passes the list of declared laws to another macro.
include!(concat!(env!("OUT_DIR"), "/friction_laws.rs"));

mod law;

pub use law::{FrictionResponse, Law};

use crate::math::Real;
use crate::scene;

/// Declares the files and [`Friction`] from the list of declared laws.
macro_rules! friction {
    ($($law:ident in $file:ident,)+) => {
        $(mod $file; pub use $file::$law;)+

        /// The friction law of one contact with its parameters.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[expect(missing_docs, reason = "each is the law of its name")]
        pub enum Friction {
            None,
            $($law($law),)+
        }

        impl Friction {
            /// The friction law with the parameters of the scene.
            pub fn new(friction: &scene::Friction) -> Self {
                match friction.law {
                    scene::FrictionLaw::None => Self::None,
                    $(scene::FrictionLaw::$law => Self::$law($law::new(friction)),)+
                }
            }

            /// The response of any law, out of line, so that the common laws do not pay for the others.
            #[cold]
            #[inline(never)]
            fn rare_response<R: Real>(&self, v: R, z: R) -> FrictionResponse<R> {
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

            /// [m] The largest deflection of bristles at rest, at which they slip; `None` without bristles.
            pub fn max_deflection(&self) -> Option<f64> {
                match self {
                    Self::None => None,
                    $(Self::$law(law) => law.max_deflection(),)+
                }
            }
        }
    };
}

friction_laws!(friction);

impl Friction {
    /// The response at the sliding speed `v` [m/s] and the bristle deflection `z` [m].
    #[inline(always)]
    pub fn response<R: Real>(&self, v: R, z: R) -> FrictionResponse<R> {
        match self {
            Self::Ambrosio(law) => law.response(v, z),
            _ => self.rare_response(v, z),
        }
    }
}
