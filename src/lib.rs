//! An FMI 2.0 co-simulation unit of the slider-crank mechanism with clearance joints.
//!
//! Path of the data: `scene.toml → scene::read → Scene → Model::assemble → Model → Simulation
//! (integrator on System) → fmi::Instance → fmi::abi → importer`.

pub mod fmi;
pub mod integrator;
pub mod math;
pub mod model;
#[path = "../modelDescription/mod.rs"]
pub mod model_description;
pub mod scene;
pub mod simulation;
