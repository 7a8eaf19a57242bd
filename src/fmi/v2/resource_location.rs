//! Checks the importer's location of the resources. Nothing is read from it (start values are in the library), so an
//! unusual spelling is only a remark in the log.

use std::fmt;

/// A resource location is unusual.
#[derive(Clone, Debug, PartialEq)]
pub struct OddLocation {
    location: String,
    oddity: &'static str,
}

impl fmt::Display for OddLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { location, oddity } = self;
        write!(f, "fmuResourceLocation '{location}' {oddity}; nothing is read from it")
    }
}

/// The unusual part of a location, if there is one. `file:/x`, `file:///x`, `file:////x` and
/// `file://localhost/x` are all in use, with spaces raw or as %20; and some importers pass no location.
pub fn oddity(location: &str) -> Option<OddLocation> {
    let odd = |oddity| Some(OddLocation { location: location.to_owned(), oddity });
    if location.is_empty() {
        return None;
    }
    let path = match location.split_at_checked("file:".len()) {
        Some((scheme, path)) if scheme.eq_ignore_ascii_case("file:") => path,
        _ => return odd("is not a file: URI"),
    };
    let path = match path.strip_prefix("//") {
        Some(rest) => {
            let (authority, path) = rest.split_at(rest.find('/').unwrap_or(rest.len()));
            if !authority.is_empty() && !authority.eq_ignore_ascii_case("localhost") {
                return odd("names another host");
            }
            path
        }
        None => path,
    };
    if !path.starts_with('/') {
        return odd("has no absolute path");
    }
    if path.split('%').skip(1).any(|after| !starts_with_two_hex_digits(after)) {
        return odd("has a '%' without two hexadecimal digits");
    }
    None
}

fn starts_with_two_hex_digits(text: &str) -> bool {
    text.len() >= 2 && text.bytes().take(2).all(|byte| byte.is_ascii_hexdigit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_in_use_is_plain() {
        for location in [
            "",
            "file:/x/resources",
            "file:///x/resources",
            "file:////x/resources",
            "file://localhost/x/resources",
            "FILE:///x/resources",
            "file:///a%20b/{0f}/resources",
            "file:////a b/resources",
            "file:///C:/x/resources/",
        ] {
            assert_eq!(oddity(location), None, "{location}");
        }
    }

    #[test]
    fn anything_else_is_odd() {
        for location in
            ["http://x/y", "/x/resources", "file:x", "file://", "file://elsewhere/x", "file:///a%2", "file:///%zz", "é"]
        {
            assert!(oddity(location).is_some(), "{location}");
        }
    }
}
