//! The flexible rod: a beam in a floating frame on its chord (A. A. Shabana, Dynamics of Multibody Systems, 5.3).
//!
//! ```text
//!                        . - ´ ¯ ¯ ` - .
//!                  . ´      │            ` .      deformed rod
//!               ´           │ Y             `
//!     big end o─────────────┴─────────────────o small end ───> x axis e of the frame, at the angle θ2
//!             │<──── X ────>│                 │
//!             │<────────────── L ────────────>│   chord
//! ```
//!
//! | symbol | |
//! |---|---|
//! | x in 0..l | a point of the undeformed rod, of the mass dm |
//! | q_i, φ_i(x) | amplitude [m] and shape of a bending mode, 0 at both ends: the frame lies on the chord |
//! | p_j, ψ_j(x) | amplitude [m] and shape of an axial mode, 0 at the big end |
//! | Γ_ij(x) = ½·∫₀ˣ φ_i'·φ_j' | foreshortening: what bending takes from the length before x |
//! | η = (q, p) | the modal coordinates |
//!
//! A point of the rod is at ρ = (X, Y) in the frame,
//!
//! X = x + Σ p_j·ψ_j − Σ_ij q_i·q_j·Γ_ij = Σ_k ξ_k·B_k,  Y = Σ q_i·φ_i,
//!
//! with B = (x, ψ_j, Γ_ij for i ≤ j) and the amplitudes ξ = (1, p_j, −q_i² or −2·q_i·q_j). The chord has the length L =
//! X(l). The modes are those of the beam between its pins; couples on the end sections act on them through the slopes
//! φ_i'(0) and φ_i'(l).
//!
//! If the frame's origin moves at u (in the frame's axes), the point moves at u + θ̇·perp(ρ) + ρ̇. The kinetic energy
//! is
//!
//! T = ½·m·u² + u·(θ̇·perp(D) + Σ η̇_a·∂D/∂η_a) + ½·J·θ̇² + θ̇·Σ T_a·η̇_a + ½·Σ m_ab·η̇_a·η̇_b,
//!
//! with D = ∫ρ dm, J = ∫|ρ|² dm, T_a = ∫ρ × ∂ρ/∂η_a dm, m_ab = ∫∂ρ/∂η_a · ∂ρ/∂η_b dm ([`Inertia`]). At zero
//! accelerations of the coordinates the point accelerates by a = ρ̈₀ + 2·θ̇·perp(ρ̇) − θ̇²·ρ relative to the origin,
//! where ρ̈₀ is the second derivative at η̈ = 0. This requires the force ∫a dm, the moment ∫ρ × a dm and, for each
//! mode, the force ∫∂ρ/∂η_a · a dm. No term is neglected: all of them are sums over constant integrals of products of B
//! and φ ([`ModalTable`](crate::scene::modal::ModalTable)) and over the amplitudes ξ and η and their rates. The rod's
//! place in its mechanism is described in `modal`, the module beside this one.

pub mod beam;
mod counts;
mod elastic;
mod flexible;
mod inertia;
mod modes;
mod shape;
mod sums;
mod tables;

pub use counts::{
    ALL_FUNCTIONS, ALL_MODES, CompiledCounts, Counts, FixedCounts, KNOWN, ROWS_WITH_MODES, RodCapacity, RuntimeCounts,
    in_registers,
};
pub use elastic::Elastic;
pub use flexible::Rod;
pub use inertia::Inertia;
pub(super) use modes::Arrays;
pub use modes::Modes;
pub use shape::{Chord, Shape};
