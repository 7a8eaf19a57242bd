//! Joints with clearance: where they are open or closed, and what force they carry.

mod corners;
pub mod foundation;
pub mod guide;
pub mod rectangle;
pub mod revolute;
mod rigid;
