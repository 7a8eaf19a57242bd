//! Derivatives of outputs with respect to start values, while these may still be set.
//!
//! A mechanism is assembled from numbers, not from numbers with derivatives; so the mechanism is assembled anew with start
//! values a little to either side, and the outputs' differences are extrapolated (see [`difference`](super::difference)).

use super::access::finite_number;
use super::difference::{Estimate, derivatives};
use super::error::Error;
use super::settings::Settings;
use crate::model::signals::Outputs;
use crate::scene::parameter::{Kind, Parameter};

/// A real parameter and how fast it changes.
pub type Rate = (&'static Parameter, f64);

/// The longest step changes a parameter by this share of itself …
const SHARE: f64 = 1.0 / 16.0;
/// … or, where it is 0, by this share of its range, …
const SHARE_OF_RANGE: f64 = 1e-3;
/// … and by no more than this.
const MOST: f64 = 0.1;
/// A derivative whose error may be larger than this share of it is none, …
const DOUBTFUL: f64 = 1e-3;
/// … unless what the longest step makes of the error is less than this share of the output.
const NOTICEABLE: f64 = 1e-6;

/// An output by its name, and how it is read.
pub type Reading = (&'static str, fn(&Outputs) -> f64);

/// Derivatives of `outputs` along a direction of the start values. `assembled` tells the outputs of settings.
///
/// # Errors
/// `NoDerivative` if an output jumps there; the refusal of the settings if they cannot be changed to either side.
pub fn along(
    direction: &[Rate],
    settings: &Settings,
    outputs: &[Reading],
    mut assembled: impl FnMut(Settings) -> Result<Outputs, Error>,
) -> Result<Vec<f64>, Error> {
    let largest = direction.iter().fold(0.0, |largest: f64, (_, rate)| largest.max(rate.abs()));
    if largest == 0.0 {
        return Ok(vec![0.0; outputs.len()]);
    }
    // Of a direction whose largest part is 1, so that no step overflows.
    let reach = |(parameter, rate): &Rate| scale(parameter, settings) / (rate / largest).abs();
    let longest = direction.iter().filter(|(_, rate)| *rate != 0.0).map(reach).fold(f64::MAX, f64::min);
    let estimates = derivatives(longest, |step| {
        let mut changed = settings.clone();
        for (parameter, rate) in direction {
            let value = parameter.value(&changed.scene) + step * (rate / largest);
            parameter.write(&mut changed.scene, value)?;
        }
        let found = assembled(changed)?;
        let values = outputs.iter().map(|(name, get)| finite_number(name, get(&found)));
        values.collect::<Result<Vec<_>, Error>>()
    })?;
    let accepted = |(&(name, _), estimate): (&Reading, Estimate)| {
        let Estimate { value, error, size } = estimate;
        let sure = error <= DOUBTFUL * value.abs() || error * longest <= NOTICEABLE * size;
        if sure { Ok(value * largest) } else { Err(Error::NoDerivative(name)) }
    };
    outputs.iter().zip(estimates).map(accepted).collect()
}

/// How far a parameter may be changed for a start.
fn scale(parameter: &Parameter, settings: &Settings) -> f64 {
    match (parameter.value(&settings.scene).abs(), &parameter.kind) {
        (0.0, Kind::Real { max, .. }) => (SHARE_OF_RANGE * max).min(MOST),
        (size, _) => SHARE * size,
    }
}
