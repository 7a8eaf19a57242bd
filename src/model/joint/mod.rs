//! Joints with clearance: contact detection and contact forces.

mod corners;
pub mod foundation;
pub mod guide;
pub mod rectangle;
pub mod revolute;
mod rigid;
