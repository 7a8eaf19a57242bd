//! Derivatives of quantities of a run by parameters, from the tangent of the motion: exact through impacts.
//!
//! A quantity at a crank angle is differentiated at that angle, which neighbours pass at other times. The largest value
//! of an output is differentiated at its instant, which is located: its own change has no influence to first order.
//!
//! Where a motion is chaotic, derivatives grow like the motion's largest exponent, and the changes for which they hold
//! shrink alike. [`Sensitivities`] has both: the growth, and the change of each parameter that moves the mechanism by one
//! noticeable difference.

use crate::dynamics::{Flow, Machine};
use crate::output::Output;
use crate::sweep::quantity::{Quantity, Reduction};
use anyhow::{Context, Result, anyhow, bail, ensure};
use slidercrank::scene::parameter::{Kind, PARAMETERS, Parameter};
use slidercrank::scene::read::SceneFile;
use slidercrank::simulation::variation::Seed;
use std::f64::consts::{PI, TAU};
use std::str::FromStr;

/// Samples per turn in the search for the largest values.
const SAMPLES: f64 = 2000.0;
/// Rounds of that search, each among this many times in the neighbourhood of the largest value before.
const ROUNDS: usize = 4;
const TIMES: usize = 12;
/// Samples per turn of a mean.
const MEAN_SAMPLES: f64 = 200.0;
/// Turns that count as rounding.
const SAME_TURN: f64 = 1e-9;
/// Tolerance of the motions.
const TOLERANCE: f64 = 1e-9;

/// A crank angle at which a quantity is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    /// [rad]
    Angle(f64),
    /// The dead centre with the slider farthest from the crank.
    OuterDeadCentre,
    /// The other dead centre.
    InnerDeadCentre,
}

/// A quantity of a run: `accuracy.position@bdc`, `joint.C.force:peak`, `slider.angle@30deg:mean`.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// As it was written.
    pub text: String,
    of: Output,
    /// At a crank angle, or at all times.
    at: Option<At>,
    /// Reduction of many values to one.
    reduce: Reduction,
}

impl FromStr for Wanted {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let (rest, reduce) = match text.split_once(':') {
            Some((rest, word)) => (rest, Some(word.parse()?)),
            None => (text, None),
        };
        let (name, at) = match rest.split_once('@') {
            Some((name, place)) => (name, Some(place.parse::<At>()?)),
            None => (rest, None),
        };
        let of = differentiable(name)?;
        Ok(Self { text: text.into(), of, at, reduce: reduce.unwrap_or(Reduction::Last) })
    }
}

/// The output of this name, if it has a derivative.
fn differentiable(name: &str) -> Result<Output> {
    let output = Output::named(name)?;
    ensure!(!output.is_of_an_interval(), "`{name}` tells of an interval, and has no derivative");
    Ok(output)
}

impl FromStr for At {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        match text {
            "bdc" | "odc" => Ok(Self::OuterDeadCentre),
            "tdc" | "idc" => Ok(Self::InnerDeadCentre),
            _ => {
                let degrees = text.strip_suffix("deg").and_then(|number| number.trim().parse::<f64>().ok());
                let angle = degrees.filter(|angle| angle.is_finite());
                angle.map(|angle| Self::Angle(angle.to_radians())).with_context(|| {
                    format!("`{text}` is no crank angle: bdc (outer dead centre), tdc (inner), or an angle like 30deg")
                })
            }
        }
    }
}

impl At {
    /// [rad] The angle, with ideal joints.
    fn angle(self, file: &SceneFile) -> f64 {
        let scene = &file.scene;
        match self {
            Self::Angle(angle) => angle,
            Self::OuterDeadCentre => (scene.guide.offset / (scene.rod.length + scene.crank.length)).asin(),
            Self::InnerDeadCentre => PI + (scene.guide.offset / (scene.rod.length - scene.crank.length)).asin(),
        }
    }
}

impl Wanted {
    /// A quantity that a study keeps under this name.
    ///
    /// # Errors
    /// If it has no derivative.
    pub fn kept(name: &str, quantity: &Quantity) -> Result<Self> {
        let Quantity { of, reduce, at } = quantity;
        Ok(Self { text: name.into(), of: differentiable(of)?, at: at.map(At::Angle), reduce: *reduce })
    }
}

/// The real parameters that a pattern such as `joint.*.clearance` names.
///
/// # Errors
/// If there are none.
pub fn parameters(pattern: &str) -> Result<Vec<&'static Parameter>> {
    let parts: Vec<&str> = pattern.split('.').collect();
    let fits = |name: &str| {
        let own: Vec<&str> = name.split('.').collect();
        own.len() == parts.len() && own.iter().zip(&parts).all(|(own, part)| part == &"*" || own == part)
    };
    let found: Vec<_> = PARAMETERS
        .iter()
        .filter(|parameter| fits(parameter.name) && matches!(parameter.kind, Kind::Real { .. }))
        .collect();
    ensure!(!found.is_empty(), "there is no real parameter `{pattern}`");
    Ok(found)
}

/// The derivatives of one quantity.
#[derive(Debug)]
pub struct Sensitivity {
    /// The quantity.
    pub wanted: Wanted,
    /// Its value.
    pub value: f64,
    /// [s] The last time that counts.
    pub time: f64,
    /// Its derivatives by the parameters, or why there are none.
    pub slopes: Result<Vec<f64>>,
}

/// The derivatives of all quantities of a run.
pub struct Sensitivities {
    /// The parameters.
    pub parameters: Vec<&'static Parameter>,
    /// Their values.
    pub values: Vec<f64>,
    /// The quantities.
    pub rows: Vec<Sensitivity>,
    /// For each parameter the change that moves the mechanism by a noticeable difference at the end of the run; infinite
    /// if none does.
    pub reach: Vec<f64>,
    /// [1/s] Mean rate at which neighbouring motions part over the run.
    pub growth: f64,
    /// [s] The end of the run.
    pub time: f64,
}

/// A run whose quantities are differentiated.
pub struct Experiment<'a> {
    /// The scene.
    pub file: &'a SceneFile,
    /// Turns of the run.
    pub turns: f64,
    /// First turns that do not count.
    pub transient: f64,
}

/// A time at which quantities are taken.
struct Sample {
    time: f64,
    /// The quantities, by their index.
    of: Vec<usize>,
}

impl Experiment<'_> {
    /// The derivatives of the quantities `wanted` by `parameters`.
    ///
    /// # Errors
    /// If the scene cannot run or has no tangent.
    pub fn run(&self, wanted: &[Wanted], parameters: &[&'static Parameter]) -> Result<Sensitivities> {
        ensure!(self.turns > self.transient && self.transient >= 0.0, "the run must be longer than its first turns");
        let file = self.accurate();
        let samples = samples(self, &file, wanted)?;
        let mut seeds: Vec<Seed> = parameters.iter().map(|parameter| Seed::Parameter(parameter)).collect();
        // The growth is that of neighbouring motions.
        seeds.extend(crate::dynamics::tangent::all_states(&file)?);
        let mut machine = Machine::with_tangent(&file, &seeds)?;
        let first = machine.directions()?;
        let count = parameters.len();
        let mut taken: Vec<Vec<(f64, Result<Vec<f64>>)>> = wanted.iter().map(|_| vec![]).collect();
        let mut last = vec![0.0; wanted.len()];
        for Sample { time, of } in samples {
            machine.advance(time)?;
            let outputs = machine.outputs();
            let slopes = machine.output_derivatives();
            let rates = of.iter().any(|&i| wanted[i].at.is_some()).then(|| machine.variation().output_rates());
            for i in of {
                let slopes = match &slopes {
                    Ok(slopes) => Ok(slopes[..count]
                        .iter()
                        .map(|slopes| {
                            let slope = wanted[i].of.slope(&outputs, slopes);
                            // At the same angle, which comes later by −δθ/θ̇.
                            let late = rates.as_ref().filter(|_| wanted[i].at.is_some());
                            let late = late.map_or(0.0, |rates| {
                                wanted[i].of.slope(&outputs, rates) * slopes.crank.angle / outputs.crank.speed
                            });
                            slope - late
                        })
                        .collect()),
                    Err(error) => Err(anyhow!("{error:#}")),
                };
                taken[i].push((wanted[i].of.value(&outputs), slopes));
                last[i] = time;
            }
        }
        machine.advance(machine.turn() * self.turns)?;
        let (reach, growth) = match machine.directions() {
            Ok(end) => {
                let norm = |matrix: &nalgebra::DMatrix<f64>, column: usize| matrix.column(column).amax();
                let reach = (0..count).map(|column| 1.0 / norm(&end, column)).collect();
                let grown = (count..seeds.len()).map(|column| (norm(&end, column) / norm(&first, column)).ln());
                (reach, grown.fold(f64::NEG_INFINITY, f64::max) / machine.time())
            }
            Err(_) => (vec![f64::NAN; count], f64::NAN),
        };
        let rows = wanted.iter().zip(taken).zip(last).map(|((wanted, taken), time)| {
            let values: Vec<f64> = taken.iter().map(|(value, _)| *value).collect();
            let slopes = taken.into_iter().map(|(_, slopes)| slopes).collect::<Result<Vec<_>>>();
            let (value, slopes) = reduced(wanted.reduce, &values, slopes, count);
            Sensitivity { wanted: wanted.clone(), value, time, slopes }
        });
        let rows = rows.collect();
        let values = parameters.iter().map(|parameter| parameter.value(&file.scene)).collect();
        Ok(Sensitivities { parameters: parameters.to_vec(), values, rows, reach, growth, time: machine.time() })
    }

    /// The quantities alone, for a scene with other parameters.
    ///
    /// # Errors
    /// If it cannot run.
    pub fn values(&self, wanted: &[Wanted]) -> Result<Vec<f64>> {
        let file = self.accurate();
        let mut machine = Machine::start(&file)?;
        let mut taken: Vec<Vec<f64>> = wanted.iter().map(|_| vec![]).collect();
        for Sample { time, of } in samples(self, &file, wanted)? {
            machine.advance(time)?;
            let outputs = machine.outputs();
            of.into_iter().for_each(|i| taken[i].push(wanted[i].of.value(&outputs)));
        }
        Ok(wanted.iter().zip(taken).map(|(wanted, values)| wanted.reduce.of(&values)).collect())
    }

    fn accurate(&self) -> SceneFile {
        let mut file = self.file.clone();
        file.scene.solver.tolerance = file.scene.solver.tolerance.min(TOLERANCE);
        file
    }
}

/// The times at which the quantities are taken, in order.
fn samples(of: &Experiment<'_>, file: &SceneFile, wanted: &[Wanted]) -> Result<Vec<Sample>> {
    let mut samples: Vec<(f64, usize)> = vec![];
    let turn = Machine::start(file)?.turn();
    let (begin, end) = (of.transient * turn, of.turns * turn);
    for (i, wanted) in wanted.iter().enumerate() {
        let grid = |per_turn: f64| {
            let count = ((of.turns - of.transient) * per_turn).ceil() as usize;
            (0..=count).map(move |k| begin + (end - begin) * k as f64 / count as f64)
        };
        match (wanted.at, wanted.reduce) {
            (Some(at), _) => {
                let passages = passages(file, at.angle(file), [of.transient, of.turns])?;
                samples.extend(passages.into_iter().map(|time| (time, i)));
            }
            (None, Reduction::Last) => samples.push((end, i)),
            (None, Reduction::Mean | Reduction::Rms | Reduction::Deviation) => {
                samples.extend(grid(MEAN_SAMPLES).map(|time| (time, i)));
            }
            (None, Reduction::Max) => {
                samples.push((extremum(file, wanted, grid(SAMPLES).collect(), |value| value)?, i))
            }
            (None, Reduction::Min) => {
                samples.push((extremum(file, wanted, grid(SAMPLES).collect(), |value| -value)?, i))
            }
            (None, Reduction::Peak) => {
                samples.push((extremum(file, wanted, grid(SAMPLES).collect(), f64::abs)?, i));
            }
            (None, Reduction::Range) => {
                samples.push((extremum(file, wanted, grid(SAMPLES).collect(), |value| value)?, i));
                samples.push((extremum(file, wanted, grid(SAMPLES).collect(), |value| -value)?, i));
            }
        }
    }
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut grouped: Vec<Sample> = vec![];
    for (time, i) in samples {
        match grouped.last_mut() {
            Some(sample) if sample.time == time => sample.of.push(i),
            _ => grouped.push(Sample { time, of: vec![i] }),
        }
    }
    Ok(grouped)
}

/// The times [s] at which the crank passes an angle [rad] after `begin` turns, until it has made `end` turns.
fn passages(file: &SceneFile, angle: f64, [begin, end]: [f64; 2]) -> Result<Vec<f64>> {
    let mut machine = Machine::start(file)?;
    let sign = file.scene.crank.speed_start.signum();
    // Turned since the start, in the direction of rotation; a passage at an end of the window is that of its last turn.
    let first = (sign * (angle - file.scene.crank.angle_start)).rem_euclid(TAU) / TAU;
    let counts = |turned: f64| turned > begin + SAME_TURN && turned < end + SAME_TURN;
    let mut times = vec![];
    for turned in (0..=end.ceil() as u32).map(|turn| first + f64::from(turn)).filter(|turned| counts(*turned)) {
        machine.advance_turned(TAU * turned)?;
        times.push(machine.time());
    }
    ensure!(!times.is_empty(), "the crank does not pass {:.1}° in the turns that count", angle.to_degrees());
    Ok(times)
}

/// The time at which `of` the quantity is largest, near the best of some `times`.
fn extremum(file: &SceneFile, wanted: &Wanted, mut times: Vec<f64>, of: impl Fn(f64) -> f64) -> Result<f64> {
    let (begin, end) = (times[0], times[times.len() - 1]);
    let mut best = begin;
    for _ in 0..=ROUNDS {
        let mut machine = Machine::start(file)?;
        let mut largest = f64::NEG_INFINITY;
        for &time in &times {
            machine.advance(time)?;
            let value = of(wanted.of.value(&machine.outputs()));
            if value > largest {
                (largest, best) = (value, time);
            }
        }
        let width = times.get(1).map_or(0.0, |next| next - times[0]);
        let start = (best - width).max(begin);
        let span = (best + width).min(end) - start;
        times = (0..=TIMES).map(|k| start + span * k as f64 / TIMES as f64).collect();
    }
    Ok(best)
}

/// Value and derivatives of a reduced list.
fn reduced(reduce: Reduction, values: &[f64], slopes: Result<Vec<Vec<f64>>>, count: usize) -> (f64, Result<Vec<f64>>) {
    let value = reduce.of(values);
    let number = values.len() as f64;
    let mean = values.iter().sum::<f64>() / number;
    let place = |key: &dyn Fn(f64) -> f64| {
        (0..values.len()).max_by(|&a, &b| key(values[a]).total_cmp(&key(values[b]))).unwrap_or_default()
    };
    // Each value's share of the derivative.
    let mut shares = vec![0.0; values.len()];
    match reduce {
        Reduction::Last => *shares.last_mut().unwrap_or(&mut 0.0) = 1.0,
        Reduction::Max => shares[place(&|value| value)] = 1.0,
        Reduction::Min => shares[place(&|value| -value)] = 1.0,
        Reduction::Peak => {
            let place = place(&f64::abs);
            shares[place] = values[place].signum();
        }
        Reduction::Range => {
            shares[place(&|value| value)] += 1.0;
            shares[place(&|value| -value)] -= 1.0;
        }
        Reduction::Mean => shares.fill(1.0 / number),
        Reduction::Rms => shares.iter_mut().zip(values).for_each(|(share, one)| *share = one / (number * value)),
        Reduction::Deviation => {
            shares.iter_mut().zip(values).for_each(|(share, one)| *share = (one - mean) / ((number - 1.0) * value))
        }
    }
    let sum = |slopes: Vec<Vec<f64>>| {
        (0..count).map(|k| shares.iter().zip(&slopes).map(|(share, slopes)| share * slopes[k]).sum()).collect()
    };
    (value, slopes.map(sum))
}

/// Central differences of all quantities by a parameter for ever smaller changes: for each quantity the one that agrees
/// best with its neighbours.
///
/// # Errors
/// If no change of the parameter can be run.
pub fn differences(of: &Experiment<'_>, wanted: &[Wanted], parameter: &'static Parameter) -> Result<Vec<f64>> {
    let value = parameter.value(&of.file.scene);
    let unit = if value == 0.0 { 1.0 } else { value.abs() };
    let at = |change: f64| -> Result<Vec<f64>> {
        let mut file = of.file.clone();
        parameter.write(&mut file.scene, value + change)?;
        file.scene.check()?;
        Experiment { file: &file, ..*of }.values(wanted)
    };
    let mut slopes: Vec<Vec<f64>> = vec![];
    for decade in 2..9 {
        let step = unit * 10f64.powi(-decade);
        let four = [2.0, 1.0, -1.0, -2.0].map(|place| at(place * step));
        if let [Ok(a), Ok(b), Ok(c), Ok(d)] = four {
            let one = |i: usize| (8.0 * (b[i] - c[i]) - (a[i] - d[i])) / (12.0 * step);
            slopes.push((0..wanted.len()).map(one).collect());
        }
    }
    if slopes.len() < 2 {
        bail!("{} has no neighbouring values", parameter.name);
    }
    let best = |i: usize| {
        let pairs = slopes.windows(2).map(|pair| (pair[0][i], pair[1][i]));
        pairs.min_by(|a, b| (a.0 - a.1).abs().total_cmp(&(b.0 - b.1).abs())).map_or(f64::NAN, |pair| pair.0)
    };
    Ok((0..wanted.len()).map(best).collect())
}
