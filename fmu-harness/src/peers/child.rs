//! Runs another program as a process and reads its results line by line, within a time limit.

use anyhow::{Context, Result};
use serde_json::Value;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// The results of a run, one list for each instant.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// Positions of our mechanism.
    Positions(Vec<f64>),
    /// The measured quantities of the error.
    Measured(Vec<f64>),
}

/// The result of a program at one tolerance.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// The run reached its end.
    Run {
        /// Or step.
        tolerance: f64,
        /// [s] CPU time of the whole run.
        seconds: f64,
        /// Number of evaluations in the whole run.
        evaluations: f64,
        /// Results at equidistant instants.
        found: Found,
    },
    /// The run failed.
    Failure {
        /// Or step.
        tolerance: f64,
        /// The reason.
        note: String,
    },
}

impl Answer {
    /// Reads a line of JSON.
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

/// Time that a program has spent compiling for the result in a line of JSON; it does not count against the budget.
fn compilation(line: &str) -> Duration {
    let value = serde_json::from_str(line).ok();
    let seconds = value.and_then(|value: Value| value.get("compilation")?.as_f64());
    seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()).unwrap_or_default()
}

/// Runs the command until it ends or has taken the time `budget` without its compilations. Returns its results and, if
/// it did not end well, a note.
pub fn run(mut command: Command, budget: Duration) -> Result<(Vec<Answer>, Option<String>)> {
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .with_context(|| format!("{} cannot be started", command.get_program().to_string_lossy()))?;
    let (send, receive) = mpsc::channel();
    let output = child.stdout.take().context("the process has no standard output")?;
    let reader = thread::spawn(move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            if send.send(line).is_err() {
                break;
            }
        }
    });
    let mut errors = child.stderr.take().context("the process has no standard error")?;
    let complaints = thread::spawn(move || {
        let mut text = vec![];
        errors.read_to_end(&mut text).map(|_| String::from_utf8_lossy(&text).into_owned())
    });
    let mut answers = vec![];
    let mut end = Instant::now() + budget;
    let ended = loop {
        match receive.recv_timeout(end.saturating_duration_since(Instant::now())) {
            Ok(line) => {
                end += compilation(&line);
                answers.extend(Answer::parse(&line));
            }
            Err(RecvTimeoutError::Disconnected) => break true,
            Err(RecvTimeoutError::Timeout) => break false,
        }
    };
    if !ended {
        child.kill().context("the process cannot be stopped")?;
    }
    let status = child.wait()?;
    // Both threads end when the process closes its pipes.
    let complaint = complaints.join().ok().and_then(Result::ok).unwrap_or_default();
    drop(receive);
    let _ = reader.join();
    let note = match (ended, status.success()) {
        (false, _) => Some(format!("stopped after {} s", budget.as_secs())),
        (true, true) => None,
        (true, false) => Some(complaint.trim().lines().last().unwrap_or("failed without a message").to_owned()),
    };
    Ok((answers, note))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A shell that takes 0.6 s for two answers, the first of which has `compilation` [s].
    fn answers(compilation: f64) -> (Vec<Answer>, Option<String>) {
        let line = |more: &str| format!(r#"{{"tolerance":1,"seconds":1,"evaluations":1,"measured":[]{more}}}"#);
        let [first, second] = [line(&format!(",\"compilation\":{compilation}")), line("")];
        let mut command = Command::new("sh");
        command.args(["-c", &format!("echo '{first}'; sleep 0.6; echo '{second}'")]);
        run(command, Duration::from_millis(300)).expect("a shell")
    }

    #[test]
    #[cfg(unix)]
    fn compilation_is_added_to_the_budget() {
        let (all, note) = answers(60.0);
        assert_eq!((all.len(), note), (2, None));
        let (all, note) = answers(0.0);
        assert_eq!(all.len(), 1);
        assert!(note.is_some_and(|note| note.starts_with("stopped after")));
    }
}
