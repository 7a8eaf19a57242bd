//! What must hold of the mechanism whatever computes it: closed forms, balances, limits, symmetries.

mod audit;
mod chance;
mod change_point;
mod clearance_to_zero;
mod compiled;
mod conservation;
mod consistency;
mod coordinates;
mod differences;
mod elasticity;
mod film;
mod finite_elements;
mod first_impact;
mod flexible;

mod foundation_guide;
mod foundation_law;
mod foundation_motion;
mod friction;
mod gravity;
mod ideal;
mod intervals;
mod ivp_slider_crank;
mod jacobian;
mod jacobian_structure;
mod lugre;
mod metamorphic;
mod motion;
mod restitution;
mod restitution_laws;
mod rigid_limits;
mod rigid_motion;
mod rigid_scenes;
mod rows;
mod scenes;
mod symmetry;
