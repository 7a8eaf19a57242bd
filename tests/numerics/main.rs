//! The integrator on problems with known answers.

mod dense_output;
mod dual;
mod events;
mod failures;
mod first_order;
mod free;
mod order;
mod polynomials;
mod step_control;
