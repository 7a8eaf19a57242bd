//! The mechanism against itself told otherwise: an independent solution in maximal coordinates.

mod against_reference;
mod chance;
mod comparison;
mod elastic_scenes;
mod scenes;
mod translation;
