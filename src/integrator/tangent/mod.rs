//! The tangent of a motion: what a small change of its start or of a parameter does to it later.
//!
//! Between events a direction v of neighbouring motions follows the variational equation
//!
//! v̇ = J(t)·v + F, J = ∂ẏ/∂y, F = Σ_m ∂ẏ/∂m·v_m + Σ_p ∂ẏ/∂p·π_p,
//!
//! where m are numbers that the discrete state remembers, such as the approach speed of a closed contact, and π is the
//! direction's share of the parameters. `flow` integrates it along the dense output of each accepted step.
//!
//! At an event the neighbour comes at another time. With the event function g, the rates f⁻ before and f⁺ after it,
//!
//! τ = −(g_y·v⁻ + g_p·π)/(g_t + g_y·f⁻), v⁺ = R·(v⁻ + f⁻·τ) − f⁺·τ, v_m⁺ = m_y·(v⁻ + f⁻·τ) + m_t·τ + m_p·π,
//!
//! where R drops the states that are reset and m(t, y, p) is what the event leaves in memory: the saltation matrix (M. A.
//! Aizerman, F. R. Gantmakher, Quart. J. Mech. Appl. Math. 11 (1958) 407; P. C. Müller, Chaos, Solitons & Fractals 5
//! (1995) 1671; N. Kong et al., arXiv 2306.06862, eq. 9). Where only the slope of a rate jumps, as at the corner of a
//! friction law, f⁺ = f⁻ and nothing is remembered: the saltation matrix is the identity, and the step's end there is
//! enough. That fails where a motion slides along such a corner, since no step can end where it is left; an error of the
//! first order then remains, as large as the smoothing of the law. It fails, too, where a face lands flat: which of its ends
//! touches first depends on the sign of the tilt, and directions along the tilt are the mean of those on both sides.
//!
//! Near grazing τ grows like one over the approach speed, and the first order ends: [`Grazing`].

mod flow;
mod legendre;
mod saltation;
mod tangents;
mod variational;

pub use saltation::Grazing;
pub use tangents::Tangents;
pub use variational::{Companion, Crossing, Gradient, Variational};
