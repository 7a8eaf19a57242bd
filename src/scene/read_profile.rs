//! The table form of an input in a scene file: points over time or over the crank angle.

use super::problem::{Fault, nearest};
use super::profile::{Profile, ProfileArgument};
use super::read_value::{Value, number, source};
use std::f64::consts::TAU;
use toml::de::DeTable;

/// A problem and its byte offset.
type Located = (usize, Fault);

/// Reads `{ against = ..., points = [[argument, value], ...] }`; `start` is the byte offset of the table.
pub(super) fn points(text: &str, key: &str, table: &DeTable, start: usize, unit: &str) -> Result<Profile, Located> {
    let known = ["against", "points"].map(|name| format!("{key}.{name}")).to_vec();
    for name in table.keys() {
        let path = format!("{key}.{}", name.get_ref());
        if !known.contains(&path) {
            let nearest = nearest(&path, &known).cloned();
            let fault = Fault::UnknownKey { key: path, nearest, known };
            return Err((name.span().start, fault));
        }
    }
    let against = against(text, key, table, start)?;
    let missing = || {
        let wanted = format!("points = [[{}, {unit}], ...]", against.unit());
        let found = "a table without points".to_owned();
        (start, Fault::Type { key: key.to_owned(), found, wanted })
    };
    let list = table.get("points").ok_or_else(missing)?;
    let mut points: Vec<[f64; 2]> = vec![];
    let path = format!("{key}.points");
    let rows = list.get_ref().as_array().filter(|rows| !rows.is_empty()).ok_or_else(missing)?;
    for row in rows.iter() {
        let point = point(text, &path, row, against, unit)?;
        let after = points.last().map_or(f64::NEG_INFINITY, |last| last[0]);
        let most = if against == ProfileArgument::CrankAngle { TAU } else { f64::MAX };
        let least = if against == ProfileArgument::CrankAngle { 0.0 } else { f64::MIN };
        if !(point[0] > after && (least..=most).contains(&point[0])) {
            let allowed = match against {
                ProfileArgument::Time => "rising times",
                ProfileArgument::CrankAngle => "rising angles from 0 to 360 deg",
            };
            return Err((row.span().start, value_fault(text, &path, row, allowed)));
        }
        points.push(point);
    }
    if let (Some([0.0, first]), Some([TAU, last]), Some(row)) = (points.first(), points.last(), rows.iter().next_back())
        && first != last
    {
        let allowed = "at 360 deg the value at 0 deg, for the turn repeats";
        return Err((row.span().start, value_fault(text, &path, row, allowed)));
    }
    Ok(Profile::Points { against, points })
}

fn against(text: &str, key: &str, table: &DeTable, start: usize) -> Result<ProfileArgument, Located> {
    let wanted = || format!("against = {}", ProfileArgument::ITEMS.map(|(name, _)| format!("{name:?}")).join(" or "));
    let Some(value) = table.get("against") else {
        let found = "a table without against".to_owned();
        return Err((start, Fault::Type { key: key.to_owned(), found, wanted: wanted() }));
    };
    let name = value.get_ref().as_str();
    let item = ProfileArgument::ITEMS.iter().find(|(item, _)| Some(*item) == name);
    item.map(|(_, against)| *against).ok_or_else(|| {
        let path = format!("{key}.against");
        let found = source(text, value);
        (value.span().start, Fault::Type { key: path, found, wanted: wanted() })
    })
}

fn point(text: &str, path: &str, row: &Value, against: ProfileArgument, unit: &str) -> Result<[f64; 2], Located> {
    let pair = row.get_ref().as_array().filter(|pair| pair.len() == 2);
    let [Some(abscissa), Some(value)] = [0, 1].map(|i| pair.and_then(|pair| pair.get(i))) else {
        let wanted = format!("[{}, {unit}]", against.unit());
        let found = source(text, row);
        return Err((row.span().start, Fault::Type { key: path.to_owned(), found, wanted }));
    };
    let read = |value: &Value, unit: &str| number(text, path, value, unit).map_err(|fault| (value.span().start, fault));
    Ok([read(abscissa, against.unit())?, read(value, unit)?])
}

fn value_fault(text: &str, path: &str, value: &Value, allowed: &str) -> Fault {
    let (key, found) = (path.to_owned(), source(text, value));
    Fault::Value { key, found, allowed: allowed.to_owned() }
}
