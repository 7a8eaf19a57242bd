//! What the asked-for mechanism is.
//!
//! [`scene`](crate::scene) says which joints are ideal and which have clearance; here that becomes a
//! set of minimal coordinates and a right-hand side that holds the effects called for and no others.
//! Reading order: `structure` (what hangs on what), `bodies`, `kinematics` (outwards), `dynamics` (inwards, M·q̈ = Q),
//! `rod`, `modal` and `condensation` (what a flexible rod adds), `mechanism` (all together), `compiled` and `assembled` ([`Model`], as the
//! integrator asks for it), `joint` and `contact` (forces), `reactions` and `outputs`.

mod assembled;
pub mod audit;
pub mod bodies;
pub mod body;
pub mod bristles;
pub mod clearances;
pub mod compiled;
mod condensation;
pub mod contact;
pub mod coordinates;
pub mod drive;
pub mod dynamics;
pub mod friction;
pub mod ideal;
pub mod inertial_load;
pub mod jacobian;
pub mod joint;
pub mod joint_set;
pub mod kinematics;
pub mod loads;
pub mod mechanism;
pub mod mechanism_model;
mod modal;
pub mod outputs;
pub mod plane;
pub mod reactions;
pub mod rod;
pub mod scalar;
pub mod scales;
pub mod signals;
pub mod stages;
pub mod start;
pub mod state;
pub mod structure;
pub mod unilateral;

pub use assembled::Model;
