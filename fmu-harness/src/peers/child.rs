//! A competitor as a process: its answers, line by line, within a budget of time.

use anyhow::{Context, Result};
use serde_json::Value;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// What a run found, one instant after the other.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// Our positions.
    Positions(Vec<f64>),
    /// What the error is measured in.
    Measured(Vec<f64>),
}

/// What a competitor says of one tolerance.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// It got to the end.
    Run {
        /// Or step.
        tolerance: f64,
        /// [s] CPU time of the whole span.
        seconds: f64,
        /// In the whole span.
        evaluations: f64,
        /// At equidistant instants.
        found: Found,
    },
    /// It did not.
    Failure {
        /// Or step.
        tolerance: f64,
        /// Why.
        note: String,
    },
}

impl Answer {
    /// Of a line of JSON.
    pub fn parse(line: &str) -> Option<Self> {
        let value: Value = serde_json::from_str(line).ok()?;
        let number = |name: &str| value.get(name)?.as_f64();
        let tolerance = number("tolerance")?;
        if let Some(note) = value.get("note") {
            return Some(Self::Failure { tolerance, note: note.as_str()?.to_owned() });
        }
        let list = |name: &str| value.get(name)?.as_array()?.iter().map(Value::as_f64).collect::<Option<_>>();
        let found = list("positions").map(Found::Positions).or_else(|| list("measured").map(Found::Measured))?;
        Some(Self::Run { tolerance, seconds: number("seconds")?, evaluations: number("evaluations")?, found })
    }
}

/// Runs the command until it ends or has taken `budget`. The answers, and what is to be said of the ending if it was
/// not a good one.
pub fn run(mut command: Command, budget: Duration) -> Result<(Vec<Answer>, Option<String>)> {
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .with_context(|| format!("{} cannot be started", command.get_program().to_string_lossy()))?;
    let (send, receive) = mpsc::channel();
    let output = child.stdout.take().context("no output of the process")?;
    let reader = thread::spawn(move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            if send.send(line).is_err() {
                break;
            }
        }
    });
    let mut errors = child.stderr.take().context("no messages of the process")?;
    let complaints = thread::spawn(move || {
        let mut text = vec![];
        errors.read_to_end(&mut text).map(|_| String::from_utf8_lossy(&text).into_owned())
    });
    let mut answers = vec![];
    let end = Instant::now() + budget;
    let ended = loop {
        match receive.recv_timeout(end.saturating_duration_since(Instant::now())) {
            Ok(line) => answers.extend(Answer::parse(&line)),
            Err(RecvTimeoutError::Disconnected) => break true,
            Err(RecvTimeoutError::Timeout) => break false,
        }
    };
    if !ended {
        child.kill().context("a process cannot be stopped")?;
    }
    let status = child.wait()?;
    // Both threads end with the process's pipes.
    let complaint = complaints.join().ok().and_then(Result::ok).unwrap_or_default();
    drop(receive);
    let _ = reader.join();
    let note = match (ended, status.success()) {
        (false, _) => Some(format!("stopped after {} s", budget.as_secs())),
        (true, true) => None,
        (true, false) => Some(complaint.trim().lines().last().unwrap_or("failed without a word").to_owned()),
    };
    Ok((answers, note))
}
