//! What the asked-for mechanism is.
//!
//! [`scene`](crate::scene) says which joints are ideal and which have clearance; here that becomes a
//! set of minimal coordinates and a right-hand side that holds the effects called for and no others.
//! Reading order: `mechanism` (bodies, chains), `coordinates`, `kinematics`, `dynamics` (M·q̈ = Q),
//! `open` and `closed` (the two kinds of mechanism with a rigid rod), `rod` and `flexible` (those with a flexible
//! one), `joint` and `contact` (forces), `reactions` and `outputs`.

pub mod audit;
pub mod bristles;
pub mod clearances;
pub mod closed;
pub mod contact;
pub mod coordinates;
pub mod drive;
pub mod dynamics;
pub mod flexible;
pub mod friction;
pub mod ideal;
pub mod jacobian;
pub mod joint;
pub mod kinematics;
pub mod linkage;
pub mod mechanism;
pub mod open;
pub mod outputs;
pub mod plane;
pub mod plant;
pub mod reactions;
pub mod rigid;
pub mod rod;
pub mod scalar;
pub mod scales;
pub mod signals;
pub mod stages;
pub mod start;
pub mod state;
