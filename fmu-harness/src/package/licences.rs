//! The licences of the FMU's library: its own, and those of the crates that are linked into it.

use super::build;
use anyhow::{Context, Result, ensure};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

const RULE: &str = "────────────────────────────────────────────────────────────────────────────────";

/// The two licences of SliderCrank.
pub fn own() -> String {
    let mit = include_str!("../../../LICENSE-MIT");
    let apache = include_str!("../../../LICENSE-APACHE");
    format!(
        "SliderCrank is licensed under either of the two licences below, at your choice.\n\n{RULE}\n{mit}\n{RULE}\n{apache}"
    )
}

/// Name, licence and licence text of every crate that is linked into the libraries for these platforms, of Rust's
/// standard library, and of the runtime that MinGW-w64 links into Windows libraries.
pub fn third_party(triples: &BTreeSet<&str>) -> Result<String> {
    let mut text = String::from(
        "The binary contains code of these packages beside SliderCrank's own.\n\n\
         Rust's standard library, licensed under MIT or Apache-2.0, copyright The Rust Project Developers.\n",
    );
    if triples.contains("x86_64-pc-windows-gnu") {
        text.push_str(
            "In the library for Windows: MinGW-w64's runtime, in the public domain, and GCC's runtime library, licensed \
             under GPL-3.0-or-later WITH GCC-exception-3.1.\n",
        );
    }
    let linked = linked_packages(&metadata(triples)?)?;
    for Package { name, version, licence, .. } in &linked {
        text.push_str(&format!("{name} {version}, licensed under {licence}.\n"));
    }
    for (words, owners) in texts(&linked) {
        text.push_str(&format!("\n{RULE}\n{}\n\n{words}\n", owners.join(", ")));
    }
    Ok(text)
}

/// Every licence text once, with the crates that contain it, in the order of its first crate.
fn texts(packages: &[Package]) -> Vec<(&str, Vec<String>)> {
    let mut texts: Vec<(&str, Vec<String>)> = Vec::new();
    for package in packages {
        for (file, words) in &package.texts {
            let owner = format!("{} ({file})", package.name);
            match texts.iter_mut().find(|(known, _)| *known == words.trim_end()) {
                Some((_, owners)) => owners.push(owner),
                None => texts.push((words.trim_end(), vec![owner])),
            }
        }
    }
    texts
}

/// A linked crate.
struct Package {
    name: String,
    version: String,
    licence: String,
    /// Licence files, by file name.
    texts: BTreeMap<String, String>,
}

/// Output of `cargo metadata` for these platforms.
fn metadata(triples: &BTreeSet<&str>) -> Result<Value> {
    let mut command = build::cargo();
    command.args(["metadata", "--format-version", "1"]);
    command.args(triples.iter().flat_map(|triple| ["--filter-platform", triple]));
    let output = command.output().context("cargo cannot be started")?;
    let words = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "cargo cannot list the linked crates: {}", words.trim());
    serde_json::from_slice(&output.stdout).context("the output of cargo metadata is not JSON")
}

/// The crates that `slidercrank` depends on through normal dependencies, without procedural macros, sorted by name.
fn linked_packages(metadata: &Value) -> Result<Vec<Package>> {
    let of_id = |list: &'static str, at: &Value| -> BTreeMap<String, Value> {
        let entries = at[list].as_array().into_iter().flatten();
        entries.filter_map(|entry| Some((entry["id"].as_str()?.to_owned(), entry.clone()))).collect()
    };
    let packages = of_id("packages", metadata);
    let nodes = of_id("nodes", &metadata["resolve"]);
    let own = packages.iter().find(|(_, package)| package["name"] == "slidercrank" && package["source"].is_null());
    let (own, _) = own.context("cargo metadata does not list slidercrank")?;

    let mut reached = BTreeSet::new();
    let mut open = vec![own.clone()];
    while let Some(id) = open.pop() {
        let dependencies = nodes.get(&id).and_then(|node| node["deps"].as_array()).into_iter().flatten();
        for dependency in dependencies {
            let normal = (dependency["dep_kinds"].as_array().into_iter().flatten()).any(|kind| kind["kind"].is_null());
            let Some(id) = dependency["pkg"].as_str() else { continue };
            let is_macro = packages.get(id).is_some_and(is_procedural_macro);
            if normal && !is_macro && reached.insert(id.to_owned()) {
                open.push(id.to_owned());
            }
        }
    }
    let mut linked: Vec<Package> = reached.iter().filter_map(|id| packages.get(id)).map(package).collect();
    linked.sort_by(|a, b| (&a.name, &a.version).cmp(&(&b.name, &b.version)));
    Ok(linked)
}

fn is_procedural_macro(package: &Value) -> bool {
    let targets = package["targets"].as_array().into_iter().flatten();
    let mut kinds = targets.flat_map(|target| target["kind"].as_array().into_iter().flatten());
    kinds.any(|kind| kind == "proc-macro")
}

fn package(entry: &Value) -> Package {
    let field = |name: &str| entry[name].as_str().unwrap_or("unknown").to_owned();
    let directory = Path::new(entry["manifest_path"].as_str().unwrap_or_default()).parent();
    let files = directory.and_then(|directory| fs::read_dir(directory).ok()).into_iter().flatten().flatten();
    let texts = files.filter_map(|file| {
        let name = file.file_name().to_string_lossy().into_owned();
        let is_licence =
            ["LICENSE", "LICENCE", "COPYING", "NOTICE"].iter().any(|word| name.to_uppercase().starts_with(word));
        is_licence.then(|| fs::read_to_string(file.path()).ok()).flatten().map(|words| (name, words))
    });
    Package { name: field("name"), version: field("version"), licence: field("license"), texts: texts.collect() }
}
