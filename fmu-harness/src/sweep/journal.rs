//! A file of finished runs, one line for each, from which a study that was killed continues.

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// A finished run.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Line {
    /// Its number.
    pub run: usize,
    /// Its outcome.
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// The outcome of a run.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Values of its quantities.
    Values(Vec<f64>),
    /// The error that ended it.
    Failed(String),
    /// Its budget ended it. The file has no such line, so that another journal of the study runs it again.
    #[serde(skip)]
    Stopped(String),
}

/// First line of a journal.
#[derive(Deserialize, Serialize)]
struct Head {
    digest: String,
}

/// The finished runs of one study.
pub struct Journal {
    file: Mutex<File>,
    lines: Mutex<BTreeMap<usize, Line>>,
}

impl Journal {
    /// Opens the journal of the study with this digest, or starts one. An incomplete last line is dropped. While the journal
    /// is open no other program can open it.
    ///
    /// # Errors
    /// If the journal belongs to another study, another program has it open, or the file cannot be read or written.
    pub fn open(path: &Path, digest: &str) -> Result<Self> {
        let context = || format!("cannot use {}", path.display());
        let mut file = OpenOptions::new().create(true).read(true).append(true).open(path).with_context(context)?;
        // A file system may have no locks: then nothing is locked.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            bail!("another program is at work on the study of {}", path.display());
        }
        let mut text = Vec::new();
        file.read_to_end(&mut text).with_context(context)?;
        // A line may have been torn within a character.
        let whole = &text[..text.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1)];
        let whole = std::str::from_utf8(whole).with_context(context)?;
        let mut rows = whole.lines();
        let mut lines = BTreeMap::new();
        if let Some(head) = rows.next() {
            match serde_json::from_str::<Head>(head) {
                Ok(head) if head.digest == digest => {}
                _ => bail!("{} belongs to another study: choose another directory, or remove the file", path.display()),
            }
            for (number, row) in rows.enumerate() {
                let line: Line = serde_json::from_str(row)
                    .with_context(|| format!("{}, line {} is damaged", path.display(), number + 2))?;
                lines.insert(line.run, line);
            }
        }
        file.set_len(whole.len() as u64).with_context(context)?;
        if whole.is_empty() {
            let head = serde_json::to_string(&Head { digest: digest.into() })?;
            file.write_all(format!("{head}\n").as_bytes()).with_context(context)?;
        }
        Ok(Self { file: Mutex::new(file), lines: Mutex::new(lines) })
    }

    /// Whether a run is finished.
    pub fn has(&self, run: usize) -> bool {
        self.locked().contains_key(&run)
    }

    /// Number of finished runs.
    pub fn len(&self) -> usize {
        self.locked().len()
    }

    /// Whether no run is finished.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All finished runs, by number.
    pub fn lines(&self) -> BTreeMap<usize, Line> {
        self.locked().clone()
    }

    /// Adds a run, in one write; one that was stopped is not written.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn add(&self, line: &Line) -> Result<()> {
        if !matches!(line.outcome, Outcome::Stopped(_)) {
            let text = serde_json::to_string(line)? + "\n";
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            file.write_all(text.as_bytes()).context("cannot write the journal")?;
        }
        self.locked().insert(line.run, line.clone());
        Ok(())
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, BTreeMap<usize, Line>> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// File of a study's journal.
pub fn path(directory: &Path, study: &str) -> PathBuf {
    directory.join(format!("sweep-{study}.jsonl"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn line(run: usize, value: f64) -> Line {
        Line { run, outcome: Outcome::Values(vec![value]) }
    }

    #[test]
    fn what_was_cut_off_is_run_again_and_nothing_else() {
        let directory = tempfile::tempdir().expect("a directory");
        let file = path(directory.path(), "own");
        let journal = Journal::open(&file, "digest").expect("a journal");
        let values = [0.1 + 0.2, 1e-300, -7.0];
        for (run, value) in values.into_iter().enumerate() {
            journal.add(&line(run, value)).expect("a line");
        }
        drop(journal);
        let whole = fs::read(&file).expect("a file");
        for cut in 1..=whole.len() {
            fs::write(&file, &whole[..cut]).expect("a file");
            let journal = Journal::open(&file, "digest").expect("a journal");
            let lines = whole[..cut].iter().filter(|byte| **byte == b'\n').count().saturating_sub(1);
            assert_eq!(journal.len(), lines, "{cut}");
            let second = Journal::open(&file, "digest").err().expect("a refusal");
            assert!(second.to_string().contains("another program is at work"), "{second}");
            for (run, value) in values.into_iter().enumerate().skip(lines) {
                journal.add(&line(run, value)).expect("a line");
            }
            assert_eq!(fs::read(&file).expect("a file"), whole, "{cut}");
            assert!(journal.lines().values().zip(values).all(|(found, value)| *found == line(found.run, value)));
        }
    }

    #[test]
    fn a_line_that_was_cut_off_within_a_character_is_dropped() {
        let directory = tempfile::tempdir().expect("a directory");
        let file = path(directory.path(), "own");
        let failed = Line { run: 1, outcome: Outcome::Failed("35 °C".into()) };
        let journal = Journal::open(&file, "digest").expect("a journal");
        journal.add(&line(0, 1.0)).and_then(|()| journal.add(&failed)).expect("lines");
        drop(journal);
        let text = fs::read(&file).expect("a file");
        let degree = text.iter().position(|byte| *byte == 0xc2).expect("a character of two bytes");
        fs::write(&file, &text[..=degree]).expect("a file");
        assert_eq!(Journal::open(&file, "digest").expect("a journal").len(), 1);
    }

    #[test]
    fn another_study_s_journal_is_left_alone() {
        let directory = tempfile::tempdir().expect("a directory");
        let file = path(directory.path(), "own");
        Journal::open(&file, "one").expect("a journal").add(&line(0, 1.0)).expect("a line");
        let before = fs::read(&file).expect("a file");
        let error = Journal::open(&file, "another").err().expect("a refusal");
        assert!(error.to_string().contains("another study"), "{error}");
        assert_eq!(fs::read(&file).expect("a file"), before);
    }
}
