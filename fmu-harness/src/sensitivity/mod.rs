//! Derivatives of quantities of a run by parameters, from the tangent of the motion: exact through impacts.
//!
//! A quantity at a crank angle is differentiated at that angle, which neighbours pass at other times; at a dead centre, at
//! each neighbour's own. The largest value
//! of an output is differentiated where it is reached, on both sides if it lies in a corner.
//!
//! Where a motion is chaotic, derivatives grow like the motion's largest exponent, and the changes for which they hold
//! shrink alike. [`Sensitivities`] has both: the growth, and the change of each parameter that moves the mechanism by one
//! noticeable difference.

mod extremum;

use crate::accuracy::{farthest, nearest, slope_of_dead_centre};
use crate::dynamics::machine::Simulated;
use crate::dynamics::tangent::Tangent;
use crate::dynamics::{Flow, Machine};
use crate::output::Output;
use crate::sweep::quantity::{Quantity, Reduction};
use anyhow::{Context, Error, Result, anyhow, bail, ensure};
use extremum::{Instant, Search};
use slidercrank::model::signals::Outputs;
use slidercrank::scene::parameter::{Kind, PARAMETERS, Parameter};
use slidercrank::scene::read::SceneFile;
use slidercrank::simulation::variation::Seed;
use std::f64::consts::TAU;
use std::str::FromStr;

/// Samples per turn in the search for the largest values: stiff surfaces touch for microseconds.
const SAMPLES: f64 = 20_000.0;
/// Samples per turn of a mean.
const MEAN_SAMPLES: f64 = 2000.0;
/// Turns that count as rounding.
const SAME_TURN: f64 = 1e-9;
/// Tolerance of the motions.
const TOLERANCE: f64 = 1e-9;
/// Rounding of a quantity of a run, as a share of it.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Difference quotients agree within this share of them, and have to agree better by this factor for each decade of their steps.
const AGREEING: f64 = 1e-2;
const BETTER: f64 = 3.0;

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
            Self::OuterDeadCentre => farthest(scene),
            Self::InnerDeadCentre => nearest(scene),
        }
    }

    /// [rad per unit of the parameter] Derivative of the angle by a parameter.
    fn slope(self, file: &SceneFile, parameter: &Parameter) -> f64 {
        match self {
            Self::Angle(_) => 0.0,
            Self::OuterDeadCentre => slope_of_dead_centre(&file.scene, 1.0, parameter),
            Self::InnerDeadCentre => slope_of_dead_centre(&file.scene, -1.0, parameter),
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

    /// Reduces its values: at a crank angle those of a sample, else of instants that stand for equal times.
    fn value(&self, values: &[f64]) -> f64 {
        match self.at {
            Some(_) => self.reduce.of(values),
            None => self.reduce.over(values, &vec![1.0; values.len()]),
        }
    }

    /// What outputs, their rates and their derivatives at a time [s] say about it. Its derivatives are those at a constant time
    /// or, with derivatives of a crank angle [rad], at that angle.
    fn reading(
        &self,
        time: f64,
        outputs: &Outputs,
        rates: &Outputs,
        slopes: Result<&[Outputs], &Error>,
        angle: Option<&[f64]>,
    ) -> Reading {
        let rate = self.of.slope(outputs, rates);
        let slope = |(place, slopes): (usize, &Outputs)| {
            // A neighbour is at its angle earlier by what it is ahead of it.
            let early = angle.map_or(0.0, |angle| (slopes.crank.angle - angle[place]) / outputs.crank.speed);
            self.of.slope(outputs, slopes) - rate * early
        };
        let slopes = slopes.map(|slopes| slopes.iter().enumerate().map(slope).collect());
        let slopes = slopes.map_err(|error| anyhow!("{error:#}"));
        Reading { time, value: self.of.value(outputs), rate, slopes }
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

/// The parameters that patterns name in a scene.
#[derive(Default)]
pub struct Named {
    /// Those by which the scene has derivatives.
    pub parameters: Vec<&'static Parameter>,
    /// Why the scene has none by others, such as those at the end of their range. A pattern leaves these out.
    pub left_out: Vec<String>,
}

impl Named {
    /// What these patterns name. A name without a `*` is kept in any case.
    ///
    /// # Errors
    /// If a pattern names no real parameter, or none by which the scene has derivatives.
    pub fn of(patterns: &[String], file: &SceneFile) -> Result<Self> {
        let mut named = Self::default();
        for pattern in patterns {
            let mut found = parameters(pattern)?;
            if pattern.contains('*') {
                let mut last = None;
                found.retain(|parameter| match Machine::with_tangent(file, &[Seed::Parameter(parameter)]) {
                    Ok(_) => true,
                    Err(error) => {
                        named.left_out.push(format!("{error:#}"));
                        last = Some(error);
                        false
                    }
                });
                if let (true, Some(error)) = (found.is_empty(), last) {
                    return Err(error.context(format!("`{pattern}` names no parameter with derivatives")));
                }
            }
            named.parameters.extend(found);
        }
        Ok(named)
    }
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
    /// Whether the window of time is that of the turns which the crank makes, as in studies; otherwise turns are timed with
    /// the start speed. Passages of an angle are always those of the crank.
    pub counted: bool,
}

/// A quantity at one time of a run.
struct Reading {
    /// [s]
    time: f64,
    value: f64,
    /// Its slope over time.
    rate: f64,
    /// Its derivatives by the parameters at constant time.
    slopes: Result<Vec<f64>>,
}

impl Experiment<'_> {
    /// The derivatives of the quantities `wanted` by `parameters`.
    ///
    /// # Errors
    /// If the scene cannot run or has no tangent.
    pub fn run(&self, wanted: &[Wanted], parameters: &[&'static Parameter]) -> Result<Sensitivities> {
        ensure!(self.turns > self.transient && self.transient >= 0.0, "the run must be longer than its first turns");
        let file = self.accurate();
        let mut seeds: Vec<Seed> = parameters.iter().map(|parameter| Seed::Parameter(parameter)).collect();
        // The growth is that of neighbouring motions.
        seeds.extend(crate::dynamics::tangent::all_states(&file)?);
        let mut machine = Machine::with_tangent(&file, &seeds)?;
        let first = machine.directions()?;
        let count = parameters.len();
        let derivatives = |machine: &mut Machine<Tangent>| {
            machine.output_derivatives().map(|mut slopes| {
                slopes.truncate(count);
                slopes
            })
        };
        let window = self.window(&file)?;
        let readings = self.readings(&file, window, wanted, parameters, &mut machine, derivatives)?;
        machine.advance(window[1])?;
        let (reach, growth) = match machine.directions() {
            Ok(end) => {
                let norm = |matrix: &nalgebra::DMatrix<f64>, column: usize| matrix.column(column).amax();
                let reach = (0..count).map(|column| 1.0 / norm(&end, column)).collect();
                let grown = (count..seeds.len()).map(|column| (norm(&end, column) / norm(&first, column)).ln());
                (reach, grown.fold(f64::NEG_INFINITY, f64::max) / machine.time())
            }
            Err(_) => (vec![f64::NAN; count], f64::NAN),
        };
        let rows = wanted.iter().zip(readings).map(|(wanted, readings)| {
            let time = readings.last().map_or(0.0, |reading| reading.time);
            let values: Vec<f64> = readings.iter().map(|reading| reading.value).collect();
            let slopes = readings.into_iter().map(|reading| reading.slopes).collect::<Result<Vec<_>>>();
            let (value, slopes) = reduced(wanted, &values, slopes, count);
            Sensitivity { wanted: wanted.clone(), value, time, slopes }
        });
        let rows = rows.collect();
        let values = parameters.iter().map(|parameter| parameter.value(&file.scene)).collect();
        Ok(Sensitivities { parameters: parameters.to_vec(), values, rows, reach, growth, time: machine.time() })
    }

    /// The quantities alone.
    ///
    /// # Errors
    /// If the scene cannot run.
    pub fn values(&self, wanted: &[Wanted]) -> Result<Vec<f64>> {
        self.values_within(self.window(&self.accurate())?, wanted)
    }

    /// The quantities alone within a window [s].
    fn values_within(&self, window: [f64; 2], wanted: &[Wanted]) -> Result<Vec<f64>> {
        let file = self.accurate();
        let mut machine = Machine::start(&file)?;
        let readings = self.readings(&file, window, wanted, &[], &mut machine, |_| Ok(vec![]))?;
        let value = |(wanted, readings): (&Wanted, Vec<Reading>)| {
            wanted.value(&readings.iter().map(|reading| reading.value).collect::<Vec<_>>())
        };
        Ok(wanted.iter().zip(readings).map(value).collect())
    }

    fn accurate(&self) -> SceneFile {
        let mut file = self.file.clone();
        file.scene.solver.tolerance = file.scene.solver.tolerance.min(TOLERANCE);
        file
    }

    /// Runs `machine` and reads each quantity at each of its instants within the window [s], in order. `derivatives` gives
    /// those of the outputs at the time reached by the parameters.
    fn readings<S: Simulated>(
        &self,
        file: &SceneFile,
        window: [f64; 2],
        wanted: &[Wanted],
        parameters: &[&'static Parameter],
        machine: &mut Machine<S>,
        derivatives: impl Fn(&mut Machine<S>) -> Result<Vec<Outputs>>,
    ) -> Result<Vec<Vec<Reading>>> {
        let instants = wanted.iter().map(|wanted| self.instants(file, window, wanted)).collect::<Result<Vec<_>>>()?;
        let at_edge = |time: f64| window.iter().any(|edge| (time - edge).abs() <= SAME_TURN * window[1]);
        // Turns are counted from the start.
        let edge: Vec<f64> = parameters.iter().map(|of| f64::from(of.name == "crank.angle_start")).collect();
        let slopes_at = |at: At| parameters.iter().map(|parameter| at.slope(file, parameter)).collect();
        let angles: Vec<Option<Vec<f64>>> = wanted.iter().map(|wanted| wanted.at.map(slopes_at)).collect();
        let mut times: Vec<(f64, usize)> = vec![];
        for (i, instants) in instants.iter().enumerate() {
            times.extend(instants.iter().flat_map(|instant| instant.times()).map(|time| (time, i)));
        }
        times.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut read: Vec<Vec<Reading>> = wanted.iter().map(|_| vec![]).collect();
        for together in times.chunk_by(|a, b| a.0 == b.0) {
            machine.advance(together[0].0)?;
            let (outputs, rates, slopes) = (machine.outputs(), machine.output_rates(), derivatives(machine));
            for &(time, i) in together {
                let angle = angles[i].as_ref().or_else(|| (self.counted && at_edge(time)).then_some(&edge));
                let slopes = slopes.as_ref().map(Vec::as_slice);
                read[i].push(wanted[i].reading(time, &outputs, &rates, slopes, angle.map(Vec::as_slice)));
            }
        }
        let taken = instants.into_iter().zip(read).map(|(instants, read)| {
            let mut read = read.into_iter();
            instants.into_iter().map(|instant| instant.reading(read.by_ref())).collect()
        });
        Ok(taken.collect())
    }

    /// [s] Begin and end of the window of time.
    fn window(&self, file: &SceneFile) -> Result<[f64; 2]> {
        let mut machine = Machine::start(file)?;
        let mut time = |turns: f64| -> Result<f64> {
            if !self.counted {
                return Ok(turns * machine.turn());
            }
            machine.advance_turned(TAU * turns)?;
            Ok(machine.time())
        };
        Ok([time(self.transient)?, time(self.turns)?])
    }

    /// The instants at which a quantity is taken within the window [s], in order.
    fn instants(&self, file: &SceneFile, [begin, end]: [f64; 2], wanted: &Wanted) -> Result<Vec<Instant>> {
        let count = |per_turn: f64| ((self.turns - self.transient) * per_turn).ceil() as usize;
        let largest = |sign: fn(f64) -> f64| {
            let count = count(SAMPLES);
            let times: Vec<f64> = (0..=count).map(|k| begin + (end - begin) * k as f64 / count as f64).collect();
            Search { file, of: &wanted.of, sign }.among(&times)
        };
        if let Some(at) = wanted.at {
            let passages = passages(file, at.angle(file), [self.transient, self.turns])?;
            return Ok(passages.into_iter().map(Instant::At).collect());
        }
        Ok(match wanted.reduce {
            Reduction::Last => vec![Instant::At(end)],
            Reduction::Mean | Reduction::Rms | Reduction::Deviation => {
                // The middles of equal parts, which count alike.
                let count = count(MEAN_SAMPLES);
                let time = |k: usize| begin + (end - begin) * (k as f64 + 0.5) / count as f64;
                (0..count).map(time).map(Instant::At).collect()
            }
            Reduction::Max => vec![largest(|_| 1.0)?],
            Reduction::Min => vec![largest(|_| -1.0)?],
            Reduction::Peak => vec![largest(f64::signum)?],
            Reduction::Range => {
                let mut both = vec![largest(|_| 1.0)?, largest(|_| -1.0)?];
                both.sort_by(|a, b| a.times()[0].total_cmp(&b.times()[0]));
                both
            }
        })
    }
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

/// Value and derivatives of a reduced list.
fn reduced(wanted: &Wanted, values: &[f64], slopes: Result<Vec<Vec<f64>>>, count: usize) -> (f64, Result<Vec<f64>>) {
    let value = wanted.value(values);
    let number = values.len() as f64;
    let mean = values.iter().sum::<f64>() / number;
    let place = |key: &dyn Fn(f64) -> f64| {
        (0..values.len()).max_by(|&a, &b| key(values[a]).total_cmp(&key(values[b]))).unwrap_or_default()
    };
    // Each value's share of the derivative.
    let mut shares = vec![0.0; values.len()];
    match wanted.reduce {
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
            let freedom = if wanted.at.is_some() { number - 1.0 } else { number };
            shares.iter_mut().zip(values).for_each(|(share, one)| *share = (one - mean) / (freedom * value));
        }
    }
    let sum = |slopes: Vec<Vec<f64>>| {
        // From 0, not from -0 as `sum`.
        let one = |k: usize| shares.iter().zip(&slopes).fold(0.0, |sum, (share, slopes)| sum + share * slopes[k]);
        (0..count).map(one).collect()
    };
    (value, slopes.map(sum))
}

/// Central differences of all quantities by a parameter for ever smaller changes: for each quantity that on which they agree;
/// NaN where they do not.
///
/// # Errors
/// If no change of the parameter can be run.
pub fn differences(of: &Experiment<'_>, wanted: &[Wanted], parameter: &'static Parameter) -> Result<Vec<f64>> {
    let value = parameter.value(&of.file.scene);
    let unit = if value == 0.0 { 1.0 } else { value.abs() };
    // The scene's own start speed times the turns of its neighbours, too.
    let window = if of.counted { None } else { Some(of.window(of.file)?) };
    let at = |change: f64| -> Result<Vec<f64>> {
        let mut file = of.file.clone();
        parameter.write(&mut file.scene, value + change)?;
        file.scene.check()?;
        let neighbour = Experiment { file: &file, ..*of };
        window.map_or_else(|| neighbour.values(wanted), |window| neighbour.values_within(window, wanted))
    };
    let mut quotients: Vec<Vec<Quotient>> = vec![vec![]; wanted.len()];
    for decade in 2..12 {
        let step = unit * 10f64.powi(-decade);
        let four = [2.0, 1.0, -1.0, -2.0].map(|place| at(place * step));
        if let [Ok(a), Ok(b), Ok(c), Ok(d)] = four {
            for (i, quotients) in quotients.iter_mut().enumerate() {
                let slope = (8.0 * (b[i] - c[i]) - (a[i] - d[i])) / (12.0 * step);
                quotients.push(Quotient { slope, noise: ROUNDING * b[i].abs() / step });
            }
        }
    }
    if quotients.iter().any(|quotients| quotients.len() < 2) {
        bail!("{} has no neighbouring values", parameter.name);
    }
    Ok(quotients.iter().map(|quotients| plateau(quotients)).collect())
}

/// A difference quotient.
#[derive(Clone, Copy)]
struct Quotient {
    slope: f64,
    /// What rounding makes of it.
    noise: f64,
}

/// The slope on which two quotients, of a step and of the next smaller one, agree best in relation to their size. Beside an
/// impact large steps lead to other motions, which may agree as well: for each decade by which its steps are larger, a pair has
/// to agree better. NaN if none agrees.
fn plateau(quotients: &[Quotient]) -> f64 {
    // Slopes within rounding of 0 are 0, and so are those of what is 0 and stays so in the smallest steps: an open contact's.
    let is_still = |one: &Quotient| one.slope == 0.0 && one.noise == 0.0;
    if quotients.iter().all(|one| one.slope.abs() <= one.noise) || quotients.iter().rev().take(2).all(is_still) {
        return 0.0;
    }
    let error = |pair: &[Quotient]| {
        let larger = pair[0].slope.abs().max(pair[1].slope.abs());
        ((pair[0].slope - pair[1].slope).abs() + pair[1].noise) / larger
    };
    let pairs = quotients.windows(2).rev().zip(0..).map(|(pair, decades)| (pair, error(pair), BETTER.powi(decades)));
    let agreeing = pairs.filter(|(_, error, _)| *error <= AGREEING);
    agreeing.min_by(|a, b| (a.1 * a.2).total_cmp(&(b.1 * b.2))).map_or(f64::NAN, |(pair, ..)| pair[0].slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(slopes: &[f64], value: f64) -> f64 {
        let noise = |place: usize| ROUNDING * value / 10f64.powi(-2 - place as i32);
        let quotient = |(place, slope): (usize, &f64)| Quotient { slope: *slope, noise: noise(place) };
        plateau(&slopes.iter().enumerate().map(quotient).collect::<Vec<_>>())
    }

    #[test]
    fn difference_quotients_are_those_of_the_plateau() {
        // As found: beside an impact; where larger steps have no force; where rounding soon counts.
        let impact = [-0.34, -0.0073, -46.3, 3.48, -270.0, 24_877.0, 2904.8, 3319.9, 3339.2, 3339.9];
        assert_eq!(of(&impact, 11.0), 3339.2);
        let force = [0.0, 0.0, -1.192e7, -2.149e7, -6.711e7, 4.138e7, -1.176_044e8, -1.176_028e8, -1.176_127e8];
        assert_eq!(of(&force, 72.0), -1.176_044e8);
        let rounded = [52.63, 51.3017, 51.3013, 51.3011, 51.313, 51.22, 50.379, 50.445, 126.3, -1325.0];
        assert_eq!(of(&rounded, 23.6), 51.3013);
    }

    #[test]
    fn where_nothing_changes_but_rounding_the_slope_is_0_and_without_a_plateau_there_is_none() {
        assert_eq!(of(&[0.0, 1e-14, 0.0, -1e-12], 1.0), 0.0);
        assert_eq!(of(&[0.0; 4], 0.0), 0.0);
        assert_eq!(of(&[7e3, -2e4, 0.0, 0.0], 0.0), 0.0);
        assert!(of(&[1.0, -3.0, 10.0, -45.0], 1.0).is_nan());
    }
}
