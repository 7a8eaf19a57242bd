//! A scene: a mechanism, its drive and its solver, as plain data in SI units.

pub mod check;
pub mod checksum;
pub mod closure;
mod data;
pub mod enumerations;
mod error;
mod method_check;
pub mod modal;
pub mod modal_check;
pub mod parameter;
pub mod problem;
pub mod profile;
pub mod read;
mod read_profile;
mod read_table;
mod read_value;
pub mod run;
pub mod slot;
pub mod units;
pub mod write;

pub use data::{
    Audit, Contact, Crank, Drive, Energy, Flexible, Friction, Guide, GuideLines, Joints, Pair, Point, Revolute, Rod,
    Scene, Slider, Solver,
};
pub use enumerations::{DampingLaw, DriveMode, Elasticity, FrictionLaw, JointModel, Lubrication, Method, Surface};
pub use error::SceneError;
pub use modal::ModalTable;
pub use parameter::PARAMETERS;
