// The README's pictures and pages, as seen from target/doc/slidercrank/: the first definition of a link counts.
#![doc = "[picture]: ../../../fmu-harness/assets/model.png"]
#![doc = "[benchmarks]: ../../../fmu-harness/docs/benchmarks.md"]
#![doc = "[guide]: ../../../fmu-harness/docs/guide.md"]
#![doc = "[how-to-add]: ../../../fmu-harness/docs/how-to-add.md"]
#![doc = ""]
#![doc = include_str!("../README.md")]

pub mod fmi;
pub mod integrator;
pub mod math;
pub mod model;
pub mod scene;
pub mod simulation;

pub use model_description;
