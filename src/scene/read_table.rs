//! The modal table of a scene: in the scene file, or in a file that it names.

use super::modal::ModalTable;
use super::problem::{Fault, Problem, ReadError, position};
use super::read_value::{Value, source};
use serde::Deserialize;
use std::io;
use toml::de::{DeValue, Deserializer, Error, ValueDeserializer};

/// Returns the text of a file, given the name in a scene.
pub type Files<'a> = &'a dyn Fn(&str) -> io::Result<String>;

/// The table that a value contains or names; otherwise a problem and its byte offset in the scene.
pub(super) fn table(text: &str, key: &str, value: &Value, files: Files) -> Result<ModalTable, (usize, Fault)> {
    let start = value.span().start;
    match value.get_ref() {
        DeValue::Table(_) => ModalTable::deserialize(ValueDeserializer::from(value.clone())).map_err(|error| {
            let offset = error.span().map_or(start, |span| span.start);
            (offset, fault(key, &error))
        }),
        DeValue::String(name) => file(key, name, files).map_err(|fault| (start, fault)),
        _ => {
            let wanted = "a table of modes or the name of a file that holds one".to_owned();
            Err((start, Fault::Type { key: key.to_owned(), found: source(text, value), wanted }))
        }
    }
}

/// The table in the file of this name.
fn file(key: &str, name: &str, files: Files) -> Result<ModalTable, Fault> {
    let text = files(name).map_err(|error| Fault::File {
        key: key.to_owned(),
        file: name.to_owned(),
        why: error.to_string(),
    })?;
    let read = Deserializer::parse(&text).and_then(ModalTable::deserialize);
    read.map_err(|error| {
        let (line, column) = position(&text, error.span().map_or(0, |span| span.start));
        let problems = vec![Problem { line, column, fault: fault(key, &error) }];
        Fault::Inside(Box::new(ReadError { file: name.to_owned(), problems }))
    })
}

fn fault(key: &str, error: &Error) -> Fault {
    Fault::Form { key: key.to_owned(), why: error.message().to_owned() }
}
