//! Joints with clearance: contact detection and contact forces.

mod corners;
pub mod film;
pub mod foundation;
pub mod guide;
pub mod journal;
pub mod rectangle;
pub mod revolute;
mod rigid;
