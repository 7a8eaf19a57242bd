//! The model: a mechanism and its equations of motion, assembled from a scene.
//!
//! The [`scene`](crate::scene) says which joints are ideal and which have clearance. The model has minimal coordinates
//! and a right-hand side with the requested effects and no others.
//!
//! Reading order: `structure` (topology), `bodies`, `kinematics` (outwards), `dynamics` (inwards, M·q̈ = Q), `rod`,
//! `modal` and `condensation` (flexible rod), `mechanism` (the whole), `compiled` and `assembled` ([`Model`], with the
//! integrator's interface), `joint` and `contact` (forces), `reactions` and `outputs`.

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
mod films;
pub mod friction;
mod gravity;
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
mod part;
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
pub mod touches;
pub mod unilateral;

pub use assembled::Model;
