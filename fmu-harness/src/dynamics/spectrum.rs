//! Power spectral density by Welch's method (P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70): half
//! overlapping segments under a Hann window, their periodograms averaged.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

/// One-sided power spectral density of samples with the spacing `step` [s]: frequency [Hz] and density [unit²/Hz]. The
/// segments have `length` samples, and their means are subtracted.
pub fn density(values: &[f64], step: f64, length: usize) -> Vec<(f64, f64)> {
    let length = length.min(values.len());
    if length < 4 {
        return vec![];
    }
    let window: Vec<f64> = (0..length).map(|i| 0.5 - 0.5 * (TAU * i as f64 / length as f64).cos()).collect();
    let power: f64 = window.iter().map(|w| w * w).sum();
    let fft = FftPlanner::new().plan_fft_forward(length);
    let (mut sum, mut segments) = (vec![0.0; length / 2 + 1], 0.0);
    let mut start = 0;
    while start + length <= values.len() {
        let segment = &values[start..start + length];
        let mean = segment.iter().sum::<f64>() / length as f64;
        let windowed = segment.iter().zip(&window).map(|(value, w)| Complex::new((value - mean) * w, 0.0));
        let mut line: Vec<Complex<f64>> = windowed.collect();
        fft.process(&mut line);
        sum.iter_mut().zip(&line).for_each(|(sum, x)| *sum += x.norm_sqr());
        segments += 1.0;
        start += length / 2;
    }
    let last = length / 2;
    let scale = |i: usize| if i == 0 || 2 * i == length { 1.0 } else { 2.0 };
    let of = |i: usize| scale(i) * sum[i] * step / (power * segments);
    (0..=last).map(|i| (i as f64 / (length as f64 * step), of(i))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_has_its_power_at_its_frequency() {
        let (step, amplitude) = (1e-3, 3.0);
        let values: Vec<f64> = (0..8192).map(|i| amplitude * (TAU * 62.5 * f64::from(i) * step).sin() + 7.0).collect();
        let spectrum = density(&values, step, 1024);
        let peak = spectrum.iter().max_by(|a, b| a.1.total_cmp(&b.1)).expect("a spectrum");
        assert!((peak.0 - 62.5).abs() < 0.5 / (1024.0 * step), "{peak:?}");
        // Parseval: the mean square of a sine is half its amplitude squared.
        let whole: f64 = spectrum.iter().map(|(_, density)| density).sum::<f64>() / (1024.0 * step);
        assert!((whole / (0.5 * amplitude * amplitude) - 1.0).abs() < 1e-2, "{whole}");
    }

    #[test]
    fn too_few_samples_have_no_spectrum() {
        assert_eq!(density(&[1.0, 2.0, 3.0], 1.0, 512), []);
    }
}
