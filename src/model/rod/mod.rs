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
//! | q_i, φ_i(x) | amplitude [m] and shape of a bending mode; φ_i is 0 at both ends, which puts the frame on the chord |
//! | p_j, ψ_j(x) | amplitude [m] and shape of an axial mode, 0 at the big end |
//! | Γ_ij(x) = ½·∫₀ˣ φ_i'·φ_j' | foreshortening: what bending takes from the length before x |
//! | η = (q, p) | the modal coordinates |
//!
//! The point lies in the frame at ρ = (X, Y),
//!
//! X = x + Σ p_j·ψ_j − Σ_ij q_i·q_j·Γ_ij = Σ_k ξ_k·B_k,  Y = Σ q_i·φ_i,
//!
//! with B = (x, ψ_j, Γ_ij for i ≤ j) and the amplitudes ξ = (1, p_j, −q_i² or −2·q_i·q_j). The chord is L = X(l). Modes
//! are those of the beam between its pins: what couples on the end sections do to them goes by the slopes φ_i'(0) and φ_i'(l).
//!
//! With the origin moving at u in the frame's axes, the point moves at u + θ̇·perp(ρ) + ρ̇. So the kinetic energy is
//!
//! T = ½·m·u² + u·(θ̇·perp(D) + Σ η̇_a·∂D/∂η_a) + ½·J·θ̇² + θ̇·Σ T_a·η̇_a + ½·Σ m_ab·η̇_a·η̇_b,
//!
//! D = ∫ρ dm, J = ∫|ρ|² dm, T_a = ∫ρ × ∂ρ/∂η_a dm, m_ab = ∫∂ρ/∂η_a · ∂ρ/∂η_b dm ([`Inertia`]). At accelerations of zero
//! the point still accelerates by a = ρ̈₀ + 2·θ̇·perp(ρ̇) − θ̇²·ρ against the origin, ρ̈₀ the second derivative at η̈ = 0, and asks for
//! the force ∫a dm, the moment ∫ρ × a dm and, of each mode, ∫∂ρ/∂η_a · a dm. Nothing is dropped: all of these are sums over
//! constant integrals of products of B and φ ([`ModalTable`](crate::scene::modal::ModalTable)) and over the amplitudes ξ and η with
//! their rates. How the rod stands in its mechanism is told in `modal`, the module beside this one.

pub mod beam;
mod counts;
mod elastic;
mod flexible;
mod inertia;
mod modes;
mod shape;
mod sums;
mod tables;

pub use counts::{CompiledCounts, Counts, FEW_MODES, FixedCounts, RodCapacity, RuntimeCounts};
pub use elastic::Elastic;
pub use flexible::Rod;
pub use inertia::Inertia;
pub(super) use modes::Arrays;
pub use modes::Modes;
pub use shape::{Chord, Shape};
