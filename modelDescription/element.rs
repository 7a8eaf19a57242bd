//! XML elements as `parent` and `leaf`, and the standard's way to write a date.

use quick_xml::Writer;
use std::io;

/// The text so far.
pub(super) type Xml = Writer<Vec<u8>>;
/// Names and values.
pub(super) type Attributes<'a> = Vec<(&'a str, String)>;

/// An element with children.
pub(super) fn parent(
    xml: &mut Xml,
    name: &str,
    attributes: Attributes,
    children: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    xml.create_element(name).with_attributes(borrowed(&attributes)).write_inner_content(children)?;
    Ok(())
}

/// An element without children.
pub(super) fn leaf(xml: &mut Xml, name: &str, attributes: Attributes) -> io::Result<()> {
    xml.create_element(name).with_attributes(borrowed(&attributes)).write_empty()?;
    Ok(())
}

/// An element without children for each of these.
pub(super) fn leaves(xml: &mut Xml, name: &str, all: Vec<Attributes>) -> io::Result<()> {
    all.into_iter().try_for_each(|attributes| leaf(xml, name, attributes))
}

fn borrowed<'a>(attributes: &'a Attributes) -> impl Iterator<Item = (&'a str, &'a str)> {
    attributes.iter().map(|(name, value)| (*name, value.as_str()))
}

/// Seconds since 1970 as `2026-01-31T12:00:00Z`.
pub(super) fn date(seconds: u64) -> String {
    let (mut day, time) = (seconds / 86_400, seconds % 86_400);
    let leap = |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let mut year = 1970;
    while day >= 365 + u64::from(leap(year)) {
        day -= 365 + u64::from(leap(year));
        year += 1;
    }
    let mut month = 1;
    for length in [31, 28 + u64::from(leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if day < length {
            break;
        }
        day -= length;
        month += 1;
    }
    let (hour, minute, second) = (time / 3600, time / 60 % 60, time % 60);
    format!("{year:04}-{month:02}-{:02}T{hour:02}:{minute:02}:{second:02}Z", day + 1)
}
