//! The rules of the README's "Invariants" that a program can check.
#![allow(clippy::panic)]

#[path = "tidy/imports.rs"]
mod imports;

use imports::{imports_within, knots};
use std::fs;
use std::path::{Path, PathBuf};

/// Folders of `src`, each with those that it may import.
const FOLDERS: &[(&str, &[&str])] = &[
    ("math", &[]),
    ("scene", &["math"]),
    ("integrator", &["math"]),
    ("model", &["math", "scene", "integrator"]),
    ("simulation", &["math", "scene", "integrator", "model"]),
    ("fmi", &["math", "scene", "integrator", "model", "simulation"]),
];

#[test]
fn folders_import_one_way() {
    for (from, files) in imports_within("src") {
        // The crate's root holds the declaration.
        for to in files.iter().filter(|to| *to != "src/lib.rs") {
            let (from_folder, to_folder) = (folder(&from), folder(to));
            let may = |(own, others): &(&str, &[&str])| *own == from_folder && others.contains(&to_folder);
            assert!(from_folder == to_folder || FOLDERS.iter().any(may), "{from} imports {to}");
        }
    }
}

/// The folder of `src` that a file is in.
fn folder(file: &str) -> &str {
    file.split('/').nth(1).unwrap_or_default()
}

#[test]
fn the_model_knows_neither_fmi_nor_files() {
    lacks("src/model", &["crate::fmi", "crate::simulation", "std::fs", "std::io", "println!"]);
}

#[test]
fn nothing_below_the_face_knows_it() {
    for place in ["src/integrator", "src/model", "src/simulation", "src/scene"] {
        lacks(place, &["crate::fmi", "fmi2"]);
    }
}

#[test]
fn the_slave_knows_no_version_of_fmi() {
    lacks("src/fmi/slave", &["::v2", "::v3", "fmi2", "fmi3", "extern "]);
}

#[test]
fn no_file_imports_itself_by_way_of_others() {
    let cycles: Vec<_> = knots(&imports_within("src")).iter().map(|knot| knot.cycle.join(" -> ")).collect();
    assert!(cycles.is_empty(), "imports in cycles:\n{}", cycles.join("\n"));
}

#[test]
fn unsafe_code_lives_where_pointers_come_in() {
    let allowed = [
        "src/fmi/abi",
        "src/fmi/v2/abi",
        "src/fmi/v3/abi",
        "fmu-harness/host/src/host/library.rs",
        "fmu-harness/peers",
    ];
    for file in ["src", "fmu-harness/src", "fmu-harness/peers"].into_iter().flat_map(sources) {
        if !allowed.iter().any(|place| file.strip_prefix(root()).is_ok_and(|path| path.starts_with(place))) {
            let text = read(&file);
            let found = text.lines().find(|line| line.contains("unsafe ") && !line.trim_start().starts_with("//"));
            assert!(found.is_none(), "{}: {}", file.display(), found.unwrap_or_default());
        }
    }
}

#[test]
fn elementary_functions_come_from_one_module() {
    for place in ["src/model", "src/integrator", "src/simulation"] {
        lacks(place, &["libm::", ".sin()", ".cos()", ".sin_cos()", ".powf(", ".exp()", ".ln()", ".tanh()", ".atan2("]);
        lacks(place, &[".hypot(", ".tan()", ".atan()", ".asin()", ".acos()", ".cbrt()", ".exp_m1()", ".ln_1p()"]);
        // Of two that are equal, or not numbers, processors choose differently.
        lacks(place, &[".fast_max(", ".fast_min("]);
    }
}

/// Longest README, in lines.
const LONGEST_README: usize = 150;

#[test]
fn the_readme_is_short_and_its_map_is_that_of_the_source() {
    let readme = read(&root().join("README.md"));
    let lines = readme.lines().count();
    assert!(lines <= LONGEST_README, "README.md has {lines} lines, more than {LONGEST_README}");
    exist(&readme, "README.md");
    let map = readme.split("\n## ").find(|section| section.starts_with("Map\n")).unwrap_or_default();
    for entry in fs::read_dir(root().join("src")).into_iter().flatten().flatten().filter(|entry| entry.path().is_dir())
    {
        let folder = format!("`src/{}/`", entry.file_name().to_string_lossy());
        assert!(map.contains(&folder), "the README's map lacks {folder}");
    }
}

#[test]
fn the_documents_name_files_that_exist() {
    for document in ["benchmarks.md", "guide.md", "how-to-add.md"] {
        let document = format!("fmu-harness/docs/{document}");
        exist(&read(&root().join(&document)), &document);
    }
    let page = read(&root().join("modelDescription/page.html"));
    exist(&page.replace("<code>", "`").replace("</code>", "`"), "modelDescription/page.html");
}

/// Every path of this tree that stands between backticks in `text` exists.
fn exist(text: &str, document: &str) {
    let tops = ["src/", "modelDescription/", "fmu-harness/", "tests/"];
    let quoted = text.split('`').skip(1).step_by(2);
    let paths =
        quoted.filter(|path| tops.iter().any(|top| path.starts_with(top)) && !path.contains(char::is_whitespace));
    let mut named = 0;
    for path in paths {
        assert!(root().join(path).exists(), "{document} names {path}, which does not exist");
        named += 1;
    }
    assert!(named > 0, "{document} names no path");
}

/// No line of code under `place`, comments and tests apart, holds any of `words`.
fn lacks(place: &str, words: &[&str]) {
    for file in sources(place) {
        let text = read(&file);
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        for (number, line) in code.lines().enumerate() {
            let line = line.split("//").next().unwrap_or_default();
            for word in words {
                assert!(!line.contains(word), "{}:{}: {word}", file.display(), number + 1);
            }
        }
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace").to_path_buf()
}

fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// Rust files below `place`.
fn sources(place: &str) -> Vec<PathBuf> {
    let mut found = vec![];
    let mut folders = vec![root().join(place)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                found.push(path);
            }
        }
    }
    assert!(!found.is_empty(), "no source under {place}");
    found
}
