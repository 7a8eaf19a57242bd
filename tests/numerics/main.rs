//! The integrator on problems with known answers.

mod bathe;
mod complementarity;
mod conditions;
mod dense_output;
mod dual;
mod events;
mod failures;
mod first_order;
mod free;
mod hand_over;
mod kinks;
mod order;
mod polynomials;
mod row;
mod step_control;
mod switching;
mod time_stepping;
