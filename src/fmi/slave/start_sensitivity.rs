//! Derivatives of a mechanism's numbers with respect to start values, while start values may be set.
//!
//! A mechanism is assembled from numbers without derivatives. Therefore it is assembled anew with start values a little
//! smaller and larger, and the differences are extrapolated (see [`difference`](super::difference)).

use super::access::finite_number;
use super::difference::{Estimate, derivatives};
use super::error::Error;
use super::settings::Settings;
use crate::scene::parameter::{Kind, Parameter};

/// A real parameter and its component of the direction.
pub type Rate = (&'static Parameter, f64);

/// The longest step changes a parameter by this share of itself …
const SHARE: f64 = 1.0 / 16.0;
/// … or, if it is 0, by this share of its range, …
const SHARE_OF_RANGE: f64 = 1e-3;
/// … and by not more than this.
const MOST: f64 = 0.1;
/// A derivative is rejected if its error may be larger than this share of it, …
const DOUBTFUL: f64 = 1e-3;
/// … unless the error times the longest step is less than this share of the number, or of the size below which it counts as
/// nothing.
const NOTICEABLE: f64 = 1e-6;

/// A number whose derivative is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// Its name.
    pub name: &'static str,
    /// Size below which it counts as nothing: what is zero but for rounding has no derivative from differences.
    pub least: f64,
}

/// Derivatives of numbers along a direction of the start values. `assembled` returns the numbers for settings.
///
/// # Errors
/// `NoDerivative` if a number jumps; the error of the settings if they cannot be changed in either direction.
pub fn along(
    direction: &[Rate],
    settings: &Settings,
    wanted: &[Wanted],
    mut assembled: impl FnMut(Settings) -> Result<Vec<f64>, Error>,
) -> Result<Vec<f64>, Error> {
    let largest = direction.iter().fold(0.0, |largest: f64, (_, rate)| largest.max(rate.abs()));
    if largest == 0.0 {
        return Ok(vec![0.0; wanted.len()]);
    }
    // The largest component of the direction becomes 1, so that no step overflows.
    let reach = |(parameter, rate): &Rate| scale(parameter, settings) / (rate / largest).abs();
    let longest = direction.iter().filter(|(_, rate)| *rate != 0.0).map(reach).fold(f64::MAX, f64::min);
    let estimates = derivatives(longest, |step| {
        let mut changed = settings.clone();
        for (parameter, rate) in direction {
            let value = parameter.value(&changed.scene) + step * (rate / largest);
            parameter.write(&mut changed.scene, value)?;
        }
        let values = wanted.iter().zip(assembled(changed)?).map(|(wanted, value)| finite_number(wanted.name, value));
        values.collect::<Result<Vec<_>, Error>>()
    })?;
    let accepted = |(&Wanted { name, least }, estimate): (&Wanted, Estimate)| {
        let Estimate { value, error, size } = estimate;
        let sure = error <= DOUBTFUL * value.abs() || error * longest <= NOTICEABLE * size.max(least);
        if sure { Ok(value * largest) } else { Err(Error::NoDerivative(name)) }
    };
    wanted.iter().zip(estimates).map(accepted).collect()
}

/// Longest step of a parameter.
fn scale(parameter: &Parameter, settings: &Settings) -> f64 {
    match (parameter.value(&settings.scene).abs(), &parameter.kind) {
        (0.0, Kind::Real { max, .. }) => (SHARE_OF_RANGE * max).min(MOST),
        (size, _) => SHARE * size,
    }
}
