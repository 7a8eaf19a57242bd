//! Which file imports which, read from the text of the files.

use crate::{read, root, sources};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

/// Path of a module from the crate's root.
type Module = Vec<String>;

/// Which files each file imports.
pub type Imports = BTreeMap<String, BTreeSet<String>>;

/// The imports among the files below `folder`, a folder of `src` or `src` itself.
pub fn imports_within(folder: &str) -> Imports {
    let files: BTreeMap<Module, PathBuf> = sources("src").into_iter().map(|file| (module_of(&file), file)).collect();
    let modules = files.keys().cloned().collect();
    let within = |module: &Module| files[module].starts_with(root().join(folder));
    let name = |module: &Module| files[module].strip_prefix(root()).expect("a path below").display().to_string();
    let imports = |(from, file): (&Module, &PathBuf)| {
        let targets = targets(from, &read(file), &modules);
        (name(from), targets.iter().filter(|to| within(to)).map(name).collect())
    };
    files.iter().filter(|(module, _)| within(module)).map(imports).collect()
}

/// Files each of which imports all others, itself or by way of others.
pub struct Knot {
    /// All of them.
    pub files: Vec<String>,
    /// A shortest cycle among them, from a file back to itself.
    pub cycle: Vec<String>,
}

/// The strongly connected components that have a cycle.
pub fn knots(imports: &Imports) -> Vec<Knot> {
    let ways: BTreeMap<_, _> = imports.keys().map(|file| (file, ways(imports, file))).collect();
    let mut knots: Vec<Knot> = vec![];
    for (file, targets) in ways.iter().filter(|(file, targets)| targets.contains_key(**file)) {
        if knots.iter().any(|knot| knot.files.contains(file)) {
            continue;
        }
        let back = |other: &&String| ways.get(other).is_some_and(|targets| targets.contains_key(*file));
        let files: Vec<String> = targets.keys().filter(back).cloned().collect();
        let cycle = files.iter().map(|file| ways[file][file].clone()).min_by_key(Vec::len).unwrap_or_default();
        knots.push(Knot { files, cycle });
    }
    knots
}

/// Shortest way from `start` to each file that it imports, itself or by way of others.
fn ways(imports: &Imports, start: &str) -> BTreeMap<String, Vec<String>> {
    let mut ways: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut ends = VecDeque::from([vec![start.to_owned()]]);
    while let Some(way) = ends.pop_front() {
        for to in way.last().and_then(|end| imports.get(end)).into_iter().flatten() {
            if !ways.contains_key(to) {
                let longer: Vec<_> = way.iter().chain([to]).cloned().collect();
                ways.insert(to.clone(), longer.clone());
                ends.push_back(longer);
            }
        }
    }
    ways
}

fn module(path: &str) -> Module {
    path.split("::").filter(|name| !name.is_empty()).map(String::from).collect()
}

/// The module that a file below `src` holds.
fn module_of(file: &Path) -> Module {
    let path = file.strip_prefix(root().join("src")).expect("a file below src").with_extension("");
    let mut names: Module = path.iter().map(|name| name.to_string_lossy().into_owned()).collect();
    if names.last().is_some_and(|last| last == "mod" || last == "lib") {
        names.pop();
    }
    names
}

/// The modules of other files that `text`, which is the file of the module `own`, names in `use` or by a path that
/// begins with `crate`, `self` or `super`. Its tests and comments do not count.
fn targets(own: &Module, text: &str, modules: &BTreeSet<Module>) -> BTreeSet<Module> {
    let code = without_comments_and_literals(text);
    let tokens = tokens(code.split("mod tests {").next().unwrap_or_default());
    let token = |at: usize| tokens.get(at).copied().unwrap_or_default();
    // The modules written inside the file around the place `at`, each with the depth in braces outside of it.
    let mut inner: Vec<(&str, usize)> = vec![];
    let (mut depth, mut at) = (0_usize, 0);
    let mut found = BTreeSet::new();
    while at < tokens.len() {
        let mut paths = vec![];
        match (token(at), token(at + 1), token(at + 2)) {
            ("mod", name, "{") => {
                inner.push((name, depth));
                (depth, at) = (depth + 1, at + 2);
            }
            ("{", ..) => depth += 1,
            ("}", ..) => {
                depth = depth.saturating_sub(1);
                inner.retain(|(_, outside)| *outside < depth);
            }
            ("use", ..) => at = tree(&tokens, at + 1, &[], &mut paths),
            ("crate" | "$crate" | "self" | "super", "::", _) => {
                let path = tokens[at..].iter().copied().take_while(|&part| part == "::" || is_part(part));
                let path: Vec<_> = path.collect();
                at += path.len() - 1;
                paths.push(path.into_iter().filter(|&part| part != "::").collect());
            }
            _ => {}
        }
        for path in &paths {
            let here = own.iter().map(String::as_str).chain(inner.iter().map(|(name, _)| *name));
            found.extend(resolve(here.collect(), path, modules));
        }
        at += 1;
    }
    found.remove(own);
    found
}

/// Collects the paths of one tree of `use`, which begins at `at`; the place of the token that ends the tree.
fn tree<'a>(tokens: &[&'a str], mut at: usize, prefix: &[&'a str], paths: &mut Vec<Vec<&'a str>>) -> usize {
    let (mut path, start) = (prefix.to_vec(), at);
    while let Some(&token) = tokens.get(at) {
        match token {
            "{" => {
                while !matches!(tokens.get(at), None | Some(&"}")) {
                    at = tree(tokens, at + 1, &path, paths);
                }
                return at + 1;
            }
            "," | "}" | ";" => break,
            "as" => at += 1,
            part if is_part(part) && (part != "self" || path.is_empty()) => path.push(part),
            _ => {}
        }
        at += 1;
    }
    // Nothing need follow the last comma.
    if at > start {
        paths.push(path);
    }
    at
}

/// The innermost module with a file of its own on a path that is written in the module `here`; where a macro's variable
/// stands in its place, each module that it may be.
fn resolve<'a>(mut here: Vec<&'a str>, path: &[&'a str], modules: &BTreeSet<Module>) -> Vec<Module> {
    let owned = |names: &[&str]| names.iter().map(ToString::to_string).collect::<Module>();
    for (place, &name) in path.iter().enumerate() {
        match name {
            "crate" | "$crate" => here.clear(),
            "self" => {}
            "super" => here.truncate(here.len().saturating_sub(1)),
            name if name.starts_with('$') => {
                let below = |module: &&Module| module.len() == here.len() + 1 && module.starts_with(&owned(&here));
                return modules.iter().filter(below).cloned().collect();
            }
            name => {
                here.push(name);
                if place == 0 && !modules.contains(&owned(&here)) {
                    return vec![];
                }
            }
        }
    }
    let innermost = (0..=here.len()).rev().map(|length| owned(&here[..length])).find(|module| modules.contains(module));
    innermost.into_iter().collect()
}

/// The text with each comment and each literal of characters as a space.
fn without_comments_and_literals(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '"' => literal(rest, '"'),
            // A lifetime has no second quotation mark that near.
            '\'' if rest.starts_with("'\\") => literal(rest, '\''),
            '\'' if rest.chars().nth(2) == Some('\'') => literal(rest, '\''),
            plain => {
                code.push(plain);
                rest = &rest[plain.len_utf8()..];
                continue;
            }
        };
        code.push(' ');
        rest = &rest[length..];
    }
    code
}

/// Length of the literal that `text` begins with.
fn literal(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, character) in text.char_indices().skip(1) {
        match character {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if character == quote => return at + quote.len_utf8(),
            _ => {}
        }
    }
    text.len()
}

/// Names, a macro's variables, `::` and single other characters.
fn tokens(code: &str) -> Vec<&str> {
    let mut tokens = vec![];
    let mut rest = code.trim_start();
    while let Some(first) = rest.chars().next() {
        let variable = usize::from(first == '$');
        let name = rest[variable..].find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len() - variable);
        let length = if name > 0 {
            variable + name
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        let (token, after) = rest.split_at(length);
        tokens.push(token);
        rest = after.trim_start();
    }
    tokens
}

/// Part of a path: a name or a macro's variable.
fn is_part(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_' || c == '$' && token.len() > 1)
}

#[test]
fn an_import_is_found_however_it_is_written() {
    let modules: BTreeSet<Module> = ["", "a", "a::b", "a::b::c", "d"].map(module).into();
    let found = |text: &str| -> Vec<String> {
        targets(&module("a::b"), text, &modules).into_iter().map(|module| module.join("::")).collect()
    };
    assert_eq!(found("use crate::d::{self, X as Y, z::*};"), ["d"]);
    assert_eq!(found("use super::{\n    b::c::X,\n    Y,\n};"), ["a", "a::b::c"]);
    assert_eq!(found("use super::{\n    b::c::X,\n};"), ["a::b::c"]);
    assert_eq!(found("pub use c::X; use std::fmt; use self::c;"), ["a::b::c"]);
    assert_eq!(found("fn f() -> super::X { crate::d::g::<crate::a::Z>() }"), ["a", "d"]);
    assert_eq!(found("mod inner { use super::X; use super::c::Y; use super::super::Z; }"), ["a", "a::b::c"]);
    assert_eq!(found("mod inner { fn f() {} } use super::X;"), ["a"]);
    assert_eq!(found("$(mod $file; pub use $file::$law; use crate::$file;)+"), ["a", "a::b::c", "d"]);
    assert_eq!(found("pub(super) mod c; // use crate::d::X;\nmod tests { use crate::d::X; }"), [""; 0]);
    assert_eq!(found("let (c, s) = ('\"', \"{ use crate::d::X; \\\" \"); use super::X;"), ["a"]);
}

#[test]
fn one_cycle_is_found_of_each_set_of_files_wherever_it_begins() {
    let graph = |edges: &[(&str, &str)]| {
        let mut graph = Imports::new();
        for &(from, to) in edges {
            graph.entry(from.into()).or_default().insert(to.into());
        }
        graph
    };
    let found = |edges| knots(&graph(edges)).iter().map(|knot| knot.cycle.join(" ")).collect::<Vec<_>>();
    assert_eq!(found(&[("a", "b"), ("b", "c"), ("a", "c")]), [""; 0]);
    assert_eq!(found(&[("a", "b"), ("b", "c"), ("c", "d"), ("d", "b"), ("c", "e")]), ["b c d b"]);
    assert_eq!(found(&[("a", "b"), ("b", "c"), ("c", "a"), ("b", "d"), ("d", "b")]), ["b d b"]);
    assert_eq!(found(&[("a", "b"), ("b", "a"), ("b", "c"), ("c", "d"), ("d", "c")]), ["a b a", "c d c"]);
}
