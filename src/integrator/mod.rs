//! Marches a hybrid system through time and knows no mechanism, only [`Problem`].
//!
//! A hybrid system has a continuous state, which follows its rates, and discrete modes, which hold
//! during a step and change only at events. [`Integrator::advance`] attempts a step, judges its
//! error, locates the first event in it, lands on that event and commits. Steps never look at
//! communication points: [`Integrator::state_at`] interpolates back into the last step, so that the
//! sequence of steps is the same however a host cuts up time.

pub mod block;
pub mod complementarity;
mod controller;
pub mod dense_output;
mod error;
mod event;
mod kink;
mod landing;
mod length;
mod linear;
mod memory;
mod method;
pub mod methods;
mod moreau;
mod nodes;
mod problem;
mod regime;
mod rewind;
pub mod root;
pub mod rosenbrock;
pub mod stages;
mod statistics;
mod step;
mod switching;
mod tableau;
mod unilateral;

pub use block::Past;
pub use controller::{Effort, Settings};
pub use error::IntegrationError;
pub use memory::{Front, Memory};
pub use method::{Character, Method, Room};
pub use moreau::Moreau;
pub use problem::{Crossed, Extent, GUARDS, Guard, Jacobian, Kinks, Problem, ROOM, Reset, by_halves, one_by_one};
pub use regime::{Manner, Regime};
pub use statistics::Statistics;
pub use step::Integrator;
pub use tableau::{Explicit, STAGES, Tableau};
pub use unilateral::{ContactLaw, Impulses, Relative, Unilateral};
