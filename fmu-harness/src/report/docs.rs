//! The page `fmu-harness/docs/benchmarks.md`. Each section is between two markers and is written by its command.

use super::say::say;
use crate::package::build::workspace;
use anyhow::{Context, Result, ensure};
use clap::Args;
use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Path of the page in the source tree.
const PAGE: &str = "fmu-harness/docs/benchmarks.md";

/// The flag `--docs` of the commands that have a section.
#[derive(Args)]
pub struct Docs {
    /// Write the tables to fmu-harness/docs/benchmarks.md, too, and replace those of an earlier run
    #[arg(long)]
    docs: bool,
}

/// A section that will be written.
pub struct Section {
    name: String,
    origin: String,
}

impl Docs {
    /// With `--docs`, the section `command`; if only `one` scene or kind is run, the section `command-one`.
    ///
    /// A command calls this before it measures, so that a run of ten minutes does not end with an error that could have
    /// been known at its start.
    ///
    /// # Errors
    /// If the page cannot be read, a marker is missing, or git cannot be run.
    pub fn section(&self, command: &str, one: Option<&str>) -> Result<Option<Section>> {
        if !self.docs {
            return Ok(None);
        }
        let stem = one.map(|one| Path::new(one).file_stem().unwrap_or_default().to_string_lossy());
        let name = stem.map_or_else(|| command.to_owned(), |stem| format!("{command}-{stem}"));
        replaced(&page()?, &name, "")?;
        let origin = format!(
            "Measured with `{}` at commit {} on this processor: {}.",
            command_line(env::args()),
            commit()?,
            processor()
        );
        Ok(Some(Section { name, origin }))
    }
}

impl Section {
    /// Replaces the section by one line about the measurement and by `text`.
    ///
    /// # Errors
    /// If the page cannot be read or written, or a marker is missing.
    pub fn write(&self, text: &str) -> Result<()> {
        let page = replaced(&page()?, &self.name, &format!("{}\n\n{}", self.origin, text.trim()))?;
        fs::write(workspace().join(PAGE), page).with_context(|| format!("cannot write {PAGE}"))?;
        say(format!("{PAGE}, section {}", self.name));
        Ok(())
    }
}

fn page() -> Result<String> {
    fs::read_to_string(workspace().join(PAGE)).with_context(|| format!("cannot read {PAGE}"))
}

/// The page with `text` between the markers of `section`.
fn replaced(page: &str, section: &str, text: &str) -> Result<String> {
    let [begin, end] = ["begin", "end"].map(|side| format!("<!-- {section}: {side} -->"));
    let place = |marker: &str| page.find(marker).with_context(|| format!("{PAGE} has no marker `{marker}`"));
    let (from, to) = (place(&begin)? + begin.len(), place(&end)?);
    ensure!(from <= to, "{PAGE} has the marker `{end}` before `{begin}`");
    Ok(format!("{}\n\n{}\n\n{}", &page[..from], text.trim(), &page[to..]))
}

/// The command line, without the directory of the results, which does not change the numbers.
fn command_line(arguments: impl Iterator<Item = String>) -> String {
    let mut line = format!("cargo run{} --", if cfg!(debug_assertions) { "" } else { " --release" });
    let mut arguments = arguments.skip(1);
    while let Some(argument) = arguments.next() {
        if ["-o", "--output"].contains(&argument.as_str()) {
            arguments.next();
        } else if !argument.starts_with("-o") && !argument.starts_with("--output=") {
            let quoted = if argument.contains(' ') { format!("\"{argument}\"") } else { argument };
            line = format!("{line} {quoted}");
        }
    }
    line
}

/// The short hash of the commit, and whether the sources differ from it.
fn commit() -> Result<String> {
    let git = |arguments: &[&str]| {
        let done = Command::new("git").args(arguments).current_dir(workspace()).output().context("cannot run git")?;
        ensure!(done.status.success(), "git {}: {}", arguments.join(" "), String::from_utf8_lossy(&done.stderr).trim());
        Ok(String::from_utf8_lossy(&done.stdout).trim().to_owned())
    };
    let hash = git(&["rev-parse", "--short", "HEAD"])?;
    let changes = git(&["status", "--porcelain", "--untracked-files=no", "--", ".", &format!(":(exclude){PAGE}")])?;
    Ok(if changes.is_empty() { hash } else { format!("{hash} with uncommitted changes") })
}

/// Name of the processor, or its architecture if the system does not provide the name.
fn processor() -> String {
    let system = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let named = system.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    named.map_or(env::consts::ARCH, |(_, name)| name).trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = "# Title\n\n<!-- one: begin -->\n\nold\n\n<!-- one: end -->\n\nprose\n\n<!-- one-more: begin -->\n\nkept\n\n\
                       <!-- one-more: end -->\n";

    #[test]
    fn a_section_is_replaced_and_all_else_is_kept() -> Result<()> {
        let new = replaced(TWO, "one", "| new |\n")?;
        assert_eq!(new, TWO.replace("old", "| new |"));
        assert_eq!(replaced(&new, "one", "old")?, TWO);
        assert_eq!(replaced(TWO, "one-more", "other")?, TWO.replace("kept", "other"));
        Ok(())
    }

    #[test]
    fn a_missing_marker_is_named() {
        let error = |page: &str, section: &str| replaced(page, section, "").map_err(|error| error.to_string());
        let lacks = |marker: &str| Err(format!("{PAGE} has no marker `{marker}`"));
        assert_eq!(error(TWO, "two"), lacks("<!-- two: begin -->"));
        assert_eq!(error("<!-- one: begin -->", "one"), lacks("<!-- one: end -->"));
        let turned = error("<!-- one: end --><!-- one: begin -->", "one");
        assert_eq!(turned, Err(format!("{PAGE} has the marker `<!-- one: end -->` before `<!-- one: begin -->`")));
    }

    #[test]
    fn every_command_with_the_flag_has_its_section() -> Result<()> {
        for section in
            ["effects", "precision", "precision-wornpin", "precision-flexrod", "realtime", "peers", "campaign"]
        {
            replaced(&page()?, section, "")?;
        }
        Ok(())
    }

    #[test]
    fn a_command_line_can_be_typed_again() {
        let arguments = ["harness", "precision", "--window", "20 ms", "-o", "out", "--output=out", "--docs"];
        let line = command_line(arguments.into_iter().map(String::from));
        assert!(line.ends_with(" -- precision --window \"20 ms\" --docs"), "{line}");
    }
}
