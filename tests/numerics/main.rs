//! The integrator on problems with known answers.

mod bathe;
mod complementarity;
mod conditions;
mod deadline;
mod dense_output;
mod discontinuities;
mod dual;
mod events;
mod f64x8;
mod failures;
mod first_order;
mod free;
mod hand_over;
mod order;
mod polynomials;
mod step_control;
mod switching;
mod tangent;
mod time_stepping;
