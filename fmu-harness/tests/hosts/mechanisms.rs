//! Every mechanism as an FMU of its own: in model exchange the package decides which states there are.

use anyhow::Result;
use fmu_harness::package::{Stock, Version};
use fmu_harness::scenes::Scenario;
use slidercrank::scene::read::read;

/// What all of them have in common: gravity, a torque-driven crank at speed, bodies.
const BODIES: &str = r#"
name = "mechanism"
description = "one of the mechanisms"
gravity = 9.81
[run]
stop = "1 ms"
step = "10 us"
[drive]
mode = "torque"
[crank]
angle_start = "40 deg"
speed_start = "3000 rpm"
length = "50 mm"
mass = "300 g"
inertia = 1.0e-4
com.x = "25 mm"
[rod]
length = "120 mm"
mass = "210 g"
inertia = 2.5e-4
com.x = "60 mm"
[slider]
mass = "140 g"
inertia = 1.0e-4
length = "40 mm"
height = "20 mm"
"#;

/// A joint with play, and what else is said of it.
fn joint(letter: char, more: &str) -> String {
    format!("[joint.{letter}]\nmodel = \"clearance\"\nclearance = \"0.2 mm\"\nrestitution = 0.8\n{more}\n")
}

/// The sixteen mechanisms by their joints with play, and others that have states or contacts of another kind.
fn texts() -> Vec<(String, String)> {
    let with = |letters: &str, more: &str| -> String { letters.chars().map(|letter| joint(letter, more)).collect() };
    let mut texts: Vec<(String, String)> = (0..16_usize)
        .map(|bits| {
            let letters: String =
                "ABCT".chars().enumerate().filter(|(bit, _)| bits >> bit & 1 == 1).map(|(_, c)| c).collect();
            (format!("joints-{letters}"), format!("{BODIES}{}", with(&letters, "")))
        })
        .collect();
    let bar = BODIES.replace("mass = \"210 g\"\ninertia = 2.5e-4\ncom.x = \"60 mm\"\n", "");
    let modes = "[rod.flexible]\nbending_modes = 2\naxial_modes = 1\n";
    for (name, text) in [
        ("bristles", format!("{BODIES}{}", with("CT", "friction = { law = \"lugre\" }"))),
        ("faces", format!("{BODIES}{}", with("T", "surface = \"foundation\"\nwidth = \"20 mm\""))),
        ("flexible", format!("{bar}{modes}{}", with("C", ""))),
        // Without any state.
        ("prescribed", BODIES.replace("\"torque\"", "\"speed\"")),
        ("driven", format!("{}{}", BODIES.replace("\"torque\"", "\"speed\""), with("C", ""))),
        ("rigid", format!("{BODIES}[solver]\nmethod = \"moreau\"\n{}", with("C", ""))),
    ] {
        texts.push((name.to_owned(), text));
    }
    texts
}

/// Every mechanism by name, packaged by `stock` for a version of FMI.
pub fn packages(version: Version, stock: &Stock) -> impl Iterator<Item = (String, Result<Vec<u8>>)> {
    texts().into_iter().map(move |(name, text)| {
        let package = || -> Result<Vec<u8>> {
            let file = read(&text, &name)?;
            Ok(stock.package_for(version, &Scenario { name: name.clone(), text: text.clone(), file })?.bytes)
        };
        let bytes = package();
        (name, bytes)
    })
}
