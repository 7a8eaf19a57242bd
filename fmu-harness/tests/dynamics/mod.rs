//! Sections, exponents, verdicts and branches, on motions whose answers are known.

mod ball;
mod linear;
mod lorenz;
mod maps;
mod mechanism;
mod oscillator;
mod response;
mod system;
mod tangent;
