//! The table of all runs of a study: every row of the study's table, with every point of its grid and every random
//! draw.

use super::distribution::Law;
use super::study::{Study, parameter};
use super::values::{Number, Values};
use anyhow::{Context, Result, ensure};
use hmac_sha256::Hash;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::path::Path;

/// A study with more runs than this counts as a mistake.
const MOST_RUNS: usize = 10_000_000;

/// A table of runs. Each column is a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    names: Vec<String>,
    values: Vec<f64>,
    runs: usize,
}

impl Plan {
    /// The runs of a study.
    ///
    /// # Errors
    /// If a parameter does not exist or cannot take a value, or there are too many runs.
    pub fn of(study: &Study) -> Result<Self> {
        let mut blocks = Vec::new();
        if let Some(file) = &study.table {
            blocks.push(table(&study.directory.join(file))?);
        }
        let rows = blocks.first().map_or(1, |(_, rows)| rows.len());
        let draws = if study.random.is_empty() { 1 } else { study.draws };
        let mut factors = study.grid.values().map(Values::len).chain([draws]);
        let runs = factors.try_fold(rows, |runs, factor| runs.checked_mul(factor)).filter(|runs| *runs <= MOST_RUNS);
        let runs = runs.with_context(|| format!("the study has more than {MOST_RUNS} runs"))?;
        for (name, values) in &study.grid {
            let list = values.list(parameter(name)?)?;
            blocks.push((vec![name.clone()], list.into_iter().map(|value| vec![value]).collect()));
        }
        if !study.random.is_empty() {
            blocks.push(random_rows(study)?);
        }
        let names: Vec<String> = blocks.iter().flat_map(|(names, _)| names.clone()).collect();
        for (place, name) in names.iter().enumerate() {
            ensure!(!names[..place].contains(name), "`{name}` is listed twice");
        }
        let mut values = Vec::with_capacity(runs * names.len());
        for run in 0..runs {
            let mut rest = run;
            let mut row: Vec<&[f64]> = Vec::new();
            // The last block varies fastest.
            for (_, rows) in blocks.iter().rev() {
                row.push(&rows[rest % rows.len()]);
                rest /= rows.len();
            }
            row.iter().rev().for_each(|part| values.extend_from_slice(part));
        }
        Ok(Self { names, values, runs })
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.runs
    }

    /// Whether there are no runs.
    pub fn is_empty(&self) -> bool {
        self.runs == 0
    }

    /// The parameters.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Value of a parameter in a run.
    pub fn value(&self, run: usize, place: usize) -> f64 {
        self.values[run * self.names.len() + place]
    }

    /// Names and values of a run.
    pub fn row(&self, run: usize) -> impl Iterator<Item = (&str, f64)> {
        self.names.iter().enumerate().map(move |(place, name)| (name.as_str(), self.value(run, place)))
    }

    /// Digest of all names and values and of `parts`. It identifies the study of a journal.
    pub fn digest(&self, parts: &[&str]) -> String {
        digest(self.names.iter().map(String::as_str).chain(parts.iter().copied()), &self.values)
    }
}

/// Digest of texts and numbers.
pub fn digest<'a>(texts: impl IntoIterator<Item = &'a str>, numbers: &[f64]) -> String {
    let mut digest = Hash::new();
    for text in texts {
        digest.update((text.len() as u64).to_le_bytes());
        digest.update(text);
    }
    numbers.iter().for_each(|number| digest.update(number.to_le_bytes()));
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Names of parameters, and rows of their values.
type Block = (Vec<String>, Vec<Vec<f64>>);

/// Rows of a CSV file.
fn table(file: &Path) -> Result<Block> {
    let context = || format!("{}", file.display());
    let mut reader = csv::Reader::from_path(file).with_context(context)?;
    let names: Vec<String> = reader.headers().with_context(context)?.iter().map(String::from).collect();
    let parameters = names.iter().map(|name| parameter(name)).collect::<Result<Vec<_>>>().with_context(context)?;
    let mut rows = Vec::new();
    for (number, record) in reader.records().enumerate() {
        let record = record.with_context(context)?;
        let cells = record.iter().zip(&parameters).map(|(cell, parameter)| {
            let number = cell.trim().parse().map_or_else(|_| Number::Text(cell.trim().into()), Number::Plain);
            number.value(parameter)
        });
        let row = cells.collect::<Result<Vec<f64>>>();
        rows.push(row.with_context(|| format!("{}, line {}", file.display(), number + 2))?);
    }
    ensure!(!rows.is_empty(), "{} has no rows", file.display());
    Ok((names, rows))
}

/// Random rows. Each draw has its own stream of random numbers, so it does not depend on the number of draws.
fn random_rows(study: &Study) -> Result<Block> {
    let names: Vec<String> = study.random.keys().cloned().collect();
    let row = |draw: usize| {
        let mut generator = ChaCha8Rng::seed_from_u64(study.seed);
        generator.set_stream(draw as u64);
        let values = study.random.iter();
        values.map(|(name, distribution)| Law::of(parameter(name)?, distribution)?.sample(&mut generator)).collect()
    };
    Ok((names, (0..study.draws).map(row).collect::<Result<_>>()?))
}
