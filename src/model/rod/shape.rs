//! The deformed rod in its own frame: amplitudes of its functions, and its chord.

#![allow(clippy::needless_range_loop)] // several arrays are read by the number of one mode

use super::counts::{CompiledCounts, Counts};
use super::modes::Arrays;
use super::sums::{ModesToModes, add_rows};
use crate::math::{Real, unroll_four};

/// Deformation of the rod and its rate, in arrays for `K` modes and `F` functions.
#[derive(Clone, Copy, Debug)]
pub struct Shape<R, const K: usize, const F: usize> {
    /// Chord of the deformed rod.
    pub chord: Chord<R>,
    /// ∂L/∂η.
    pub chord_slope: [R; K],
    /// [rad/s] Rates of the slopes at both ends.
    pub slope_rate: [R; 2],
    pub(super) xi: [R; F],
    pub(super) xi_rate: [R; F],
    /// ξ̈ at η̈ = 0.
    pub(super) xi_bias: [R; F],
}

/// The chord of the deformed rod: the straight line between its ends.
#[derive(Clone, Copy, Debug)]
pub struct Chord<R> {
    /// [m] Length L = l + stretch.
    pub length: R,
    /// [m] Change of the chord's length.
    pub stretch: R,
    /// [m/s] Rate of the chord's length.
    pub rate: R,
    /// [m/s²] L̈ at η̈ = 0.
    pub bias: R,
}

impl<const K: usize, const F: usize> Arrays<'_, K, F> {
    /// The shape of the modal coordinates `eta` [m] and their `rate` [m/s].
    #[inline(always)]
    pub fn shape<R: Real, C: CompiledCounts>(&self, eta: &[R], rate: &[R]) -> Shape<R, K, F> {
        let counts = C::COUNTS.unwrap_or(self.counts);
        let Counts { bending, axial, shortening } = counts;
        let mut shape = Shape {
            chord: Chord { length: R::ZERO, stretch: R::ZERO, rate: R::ZERO, bias: R::ZERO },
            chord_slope: [R::ZERO; K],
            slope_rate: [R::ZERO; 2],
            xi: [R::ZERO; F],
            xi_rate: [R::ZERO; F],
            xi_bias: [R::ZERO; F],
        };
        let Shape { chord, chord_slope, slope_rate, xi, xi_rate, xi_bias } = &mut shape;
        let (eta, rate) = (&eta[..counts.modes()], &rate[..counts.modes()]);
        // Foreshortening is quadratic in the bending modes: half the product of their amplitudes and its slope.
        let mut with_rate = [R::ZERO; K];
        let lists = [&mut *chord_slope, &mut with_rate];
        add_rows::<R, ModesToModes<C>, _, _>(lists, self.tables.shortening, 0..shortening, [eta, rate], bending);
        unroll_four!(C::KNOWN, i < shortening, C::MODES => {
            chord.stretch = (eta[i] * 0.5).multiply_add(chord_slope[i], chord.stretch);
            chord.rate = rate[i].multiply_add(chord_slope[i], chord.rate);
            chord.bias = rate[i].multiply_add(with_rate[i], chord.bias);
        });
        xi[0] = R::ONE;
        unroll_four!(C::KNOWN, j < axial, C::MODES => {
            let (place, end) = (1 + j, self.end[1 + j]);
            (xi[place], xi_rate[place]) = (eta[bending + j], rate[bending + j]);
            chord_slope[bending + j] = R::constant(end);
            chord.stretch = xi[place].multiply_add(end, chord.stretch);
            chord.rate = xi_rate[place].multiply_add(end, chord.rate);
        });
        chord.length = chord.stretch + self.length;
        unroll_four!(C::KNOWN, i < shortening, C::MODES => {
            let first = counts.pair(i, i);
            unroll_four!(C::KNOWN, further < shortening - i, C::MODES => {
                let (j, place) = (i + further, first + further);
                let twice = if i == j { 1.0 } else { 2.0 };
                xi[place] = eta[i] * -twice * eta[j];
                xi_rate[place] = eta[i].multiply_add(rate[j], rate[i] * eta[j]) * -twice;
                xi_bias[place] = rate[i] * (-2.0 * twice) * rate[j];
            });
        });
        unroll_four!(C::KNOWN, i < bending, C::MODES => {
            for (end, slope) in slope_rate.iter_mut().zip(&self.slope) {
                *end = rate[i].multiply_add(slope[i], *end);
            }
        });
        shape
    }
}
