//! The largest Lyapunov exponent by two trajectories (G. Benettin, L. Galgani, J.-M. Strelcyn, Phys. Rev. A 14 (1976)
//! 2338): a neighbouring motion is followed for a while, the growth of its distance is recorded, and the neighbour is
//! moved near again along the same direction.
//!
//! The distance contains everything that determines the further motion, bristles and approach speeds of closed contacts
//! included. Neighbours begin with the same approach speeds: in a contact that never opens a difference would stay as it is,
//! and hide how fast the motions approach each other. Two neighbours may have different contacts closed for a moment; their distance is then measured as soon as
//! they agree again. Both start anew after each measurement, so that they take similar steps, whose errors cancel.

use super::{Flow, Point};
use anyhow::{Result, bail};

/// Settings for measuring an exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// [s] Time between two measurements.
    pub interval: f64,
    /// Number of measurements.
    pub count: usize,
    /// Number of first measurements that do not count, during which the neighbour turns into the direction of fastest
    /// growth.
    pub settling: usize,
    /// The neighbour's distance, in noticeable differences.
    pub distance: f64,
}

/// An exponent and its uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Exponent {
    /// [1/s]
    pub value: f64,
    /// [1/s] Standard error, from the standard deviation of the means of [`BATCHES`] consecutive parts.
    pub error: f64,
    /// Time [s] and the mean up to it [1/s].
    pub history: Vec<(f64, f64)>,
}

/// Number of parts whose means are compared. They are long enough to be independent.
pub const BATCHES: usize = 20;
/// Time between two comparisons of the discrete states, as a share of the interval.
const WAITS: usize = 400;
const PATIENCE: f64 = 0.02;

impl Probe {
    /// Measures the exponent of `flow` with `neighbour`, another flow of the same system in any state.
    ///
    /// # Errors
    /// If nothing is free to move, a flow cannot go on, or the neighbours' discrete states never agree.
    pub fn measure<F: Flow>(&self, flow: &mut F, neighbour: &mut F, mut tick: impl FnMut()) -> Result<Exponent> {
        let start = flow.point();
        if start.coordinates.is_empty() {
            bail!("the motion is prescribed and has no neighbouring motions");
        }
        let mut near = start.clone();
        // Alternating signs: such a direction is not invariant under any symmetry of the system.
        let sign = |i: usize| if i % 3 == 1 { -1.0 } else { 1.0 };
        let moving = near.coordinates.len() - near.remembered;
        near.coordinates[..moving].iter_mut().enumerate().for_each(|(i, x)| *x += sign(i) * self.distance);
        neighbour.place(&near);
        flow.place(&start);
        let (mut growths, mut history) = (Vec::with_capacity(self.count), Vec::with_capacity(self.count));
        let (mut sum, mut span) = (0.0, 0.0);
        let mut last = start.time;
        for number in 0..self.count {
            let (here, there) = self.meet(flow, neighbour, last + self.interval)?;
            let distance = here.distance(&there);
            if !(distance > 0.0 && distance.is_finite()) {
                bail!("at {} s the neighbour's distance is {distance}", here.time);
            }
            let (growth, passed) = ((distance / self.distance).ln(), here.time - last);
            last = here.time;
            if number >= self.settling {
                (sum, span) = (sum + growth, span + passed);
                growths.push((growth, passed));
                history.push((last, sum / span));
            }
            neighbour.place(&nearer(&here, &there, self.distance / distance));
            flow.place(&here);
            tick();
        }
        Ok(Exponent { value: sum / span, error: standard_error(&growths), history })
    }

    /// Both points at the first time from `time` on at which their discrete states agree.
    fn meet<F: Flow>(&self, flow: &mut F, neighbour: &mut F, time: f64) -> Result<(Point, Point)> {
        for wait in 0..WAITS {
            let to = time + PATIENCE * self.interval * wait as f64;
            flow.advance(to)?;
            neighbour.advance(to)?;
            let (here, there) = (flow.point(), neighbour.point());
            if here.modes == there.modes {
                return Ok((here, there));
            }
        }
        bail!("from {time} s on, two neighbouring motions have different contacts closed")
    }
}

/// The point between `here` and `there` at this share of the distance.
fn nearer(here: &Point, there: &Point, share: f64) -> Point {
    let between = here.coordinates.iter().zip(&there.coordinates).map(|(a, b)| a + share * (b - a));
    Point { coordinates: between.collect(), ..here.clone() }
}

/// Standard error of the mean rate of growths in times [s], by batch means.
pub fn standard_error(growths: &[(f64, f64)]) -> f64 {
    let size = growths.len() / BATCHES;
    if size == 0 {
        return f64::INFINITY;
    }
    let rate = |batch: &[(f64, f64)]| {
        let (sum, span) = batch.iter().fold((0.0, 0.0), |(sum, span), (growth, passed)| (sum + growth, span + passed));
        sum / span
    };
    let rates: Vec<f64> = growths.chunks_exact(size).take(BATCHES).map(rate).collect();
    let mean = rates.iter().sum::<f64>() / BATCHES as f64;
    let variance = rates.iter().map(|rate| (rate - mean).powi(2)).sum::<f64>() / (BATCHES - 1) as f64;
    (variance / BATCHES as f64).sqrt()
}
