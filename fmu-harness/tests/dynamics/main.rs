//! Sections, exponents and verdicts, on motions whose answers are known.

mod ball;
mod linear;
mod lorenz;
mod mechanism;
mod system;
mod tangent;
