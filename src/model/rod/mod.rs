//! The flexible rod: inertia, elasticity and ends of a floating frame on the chord.
//!
//! In the chord's frame a point of the rod lies at (X, Y) = (Σ_k B_k(x)·ξ_k, Σ_i φ_i(x)·q_i): B holds x,
//! the axial modes and the foreshortenings Γ_ij, ξ their amplitudes 1, p_j and −σ_ij, where σ_ij is
//! q_i² or 2·q_i·q_j. All of the kinetic energy then follows from constant integrals over products of
//! B and φ ([`ModalTable`](crate::scene::modal::ModalTable)) and from how ξ depends on the modal coordinates η = (q, p); nothing is
//! dropped. See A. A. Shabana, Dynamics of Multibody Systems, 5.3, for the floating frame.

pub mod beam;
mod counts;
mod elastic;
mod flexible;
mod inertia;
mod modes;
mod shape;
mod sums;
mod tables;

pub use counts::{Any, Counted, Counts, Exactly, FEW_MODES, Room};
pub use elastic::Elastic;
pub use flexible::Rod;
pub use inertia::Inertia;
pub(super) use modes::Arrays;
pub use modes::Modes;
pub use shape::{Chord, Shape};
