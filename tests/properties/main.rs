//! What must hold of the mechanism whatever computes it: closed forms, balances, limits, symmetries.

mod audit;
mod chance;
mod clearance_to_zero;
mod conservation;
mod consistency;
mod differences;
mod finite_elements;
mod first_impact;
mod flexible;
mod foundation_guide;
mod foundation_law;
mod foundation_motion;
mod friction;
mod ideal;
mod ivp_slider_crank;
mod jacobian;
mod jacobian_structure;
mod lugre;
mod motion;
mod restitution;
mod restitution_laws;
mod scenes;
mod symmetry;
mod told_twice;
