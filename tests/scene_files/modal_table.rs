//! Modal tables of scenes: in the file, beside it, and what is said of wrong ones.

use super::refused;
use slidercrank::model::{self, signals::Inputs};
use slidercrank::scene::modal::{AxialMode, BendingMode, MAX_MODES, MAX_NUMBERS, ModalTable};
use slidercrank::scene::read::{SceneFile, read, read_with};
use slidercrank::scene::write::{write, write_table};
use slidercrank::scene::{DriveMode, JointModel, Scene};
use slidercrank::simulation::Simulation;
use std::f64::consts::PI;
use std::{fs, io};

/// Length and mass of the declared beam.
const LENGTH: f64 = 0.12;
const MASS: f64 = 7850.0 * 2.23e-4 * LENGTH;

/// What `modal.rs` tells of the format, for a uniform rod: φ_i = sin(iπx/l), ψ_j = sin((2j−1)πx/2l).
pub fn beam(bending: usize, axial: usize) -> ModalTable {
    let wave = |i: usize| i as f64 * PI / LENGTH;
    let half_wave = |j: usize| (2 * j - 1) as f64 * PI / (2.0 * LENGTH);
    // ½∫₀ˣ cos(as)·cos(bs) ds·ab, the integral of half the slopes' product.
    let shortening = |i: usize, j: usize, x: f64| {
        let (sum, difference) = (wave(i) + wave(j), wave(i) - wave(j));
        let part = |k: f64| if k == 0.0 { x } else { (k * x).sin() / k };
        0.25 * wave(i) * wave(j) * (part(sum) + part(difference))
    };
    let pairs: Vec<(usize, usize)> = (1..=bending).flat_map(|i| (i..=bending).map(move |j| (i, j))).collect();
    let along = |x: f64| -> Vec<f64> {
        let stretches = (1..=axial).map(|j| (half_wave(j) * x).sin());
        let shortenings = pairs.iter().map(|(i, j)| shortening(*i, *j, x));
        std::iter::once(x).chain(stretches).chain(shortenings).collect()
    };
    let across = |x: f64| -> Vec<f64> { (1..=bending).map(|i| (wave(i) * x).sin()).collect() };
    let functions = along(0.0).len();
    let mut table = ModalTable {
        mass: MASS,
        bending: (1..=bending)
            .map(|i| BendingMode {
                frequency: 6e3 * (i * i) as f64,
                middle: (wave(i) * LENGTH / 2.0).sin(),
                slope_start: wave(i),
                slope_end: wave(i) * (wave(i) * LENGTH).cos(),
                ..BendingMode::default()
            })
            .collect(),
        axial: (1..=axial)
            .map(|j| AxialMode { frequency: 7e4 * (2 * j - 1) as f64, mass: 0.0, end: (half_wave(j) * LENGTH).sin() })
            .collect(),
        shortening: pairs.iter().map(|(i, j)| shortening(*i, *j, LENGTH)).collect(),
        first: vec![0.0; functions],
        second: vec![vec![0.0; functions]; functions],
        coupling: vec![vec![0.0; bending]; functions],
    };
    // Simpson's rule. The shortest waves are of wave number k = 32π/l, in a product of two Γ: an error
    // of (k·h)⁴/180 = 4e-8.
    let parts = 2000;
    for node in 0..=parts {
        let x = LENGTH * node as f64 / parts as f64;
        let weight = if node == 0 || node == parts { 1.0 } else { 2.0 + 2.0 * (node % 2) as f64 };
        let (b, phi, dm) = (along(x), across(x), weight * MASS / (3.0 * parts as f64));
        for (mode, phi) in table.bending.iter_mut().zip(&phi) {
            mode.mass += phi * phi * dm;
            mode.moment += phi * dm;
        }
        for row in 0..functions {
            table.first[row] += b[row] * dm;
            table.second[row].iter_mut().zip(&b).for_each(|(entry, b_column)| *entry += b[row] * b_column * dm);
            table.coupling[row].iter_mut().zip(&phi).for_each(|(entry, phi)| *entry += b[row] * phi * dm);
        }
    }
    for (mode, row) in table.axial.iter_mut().zip(1..) {
        mode.mass = table.second[row][row];
    }
    table
}

/// A speed-driven crank with a rod of so many modes and play in the slider pin.
fn flexible(bending: usize, axial: usize) -> Scene {
    let mut scene = Scene::default();
    scene.drive.mode = DriveMode::Speed;
    scene.crank.speed_start = 500.0;
    scene.joint.c.model = JointModel::Clearance;
    scene.rod.flexible.bending_modes = bending as i32;
    scene.rod.flexible.axial_modes = axial as i32;
    scene
}

#[test]
fn the_model_s_own_beam_keeps_to_the_format() {
    for (bending, axial) in [(1, 0), (0, 2), (3, 1), (MAX_MODES, MAX_MODES)] {
        let of_model = model::rod::beam::table(&flexible(bending, axial));
        let mut by_hand = beam(bending, axial);
        let frequencies = of_model.bending.iter().map(|mode| mode.frequency);
        by_hand.bending.iter_mut().zip(frequencies).for_each(|(mode, frequency)| mode.frequency = frequency);
        let frequencies = of_model.axial.iter().map(|mode| mode.frequency);
        by_hand.axial.iter_mut().zip(frequencies).for_each(|(mode, frequency)| mode.frequency = frequency);
        assert_eq!(of_model.check(), Ok(()), "{bending} bending, {axial} axial modes");
        let (one, other) = (of_model.numbers(), by_hand.numbers());
        assert_eq!(one.len(), other.len());
        for (index, (one, other)) in one.iter().zip(&other).enumerate() {
            // A hundred times Simpson's error, for small integrals of shapes that are not.
            assert!((one - other).abs() < 4e-6 * one.abs().max(1e-3), "{bending}, {axial}: {index}: {one} {other}");
        }
    }
}

#[test]
fn a_beam_told_by_its_table_moves_as_the_beam() {
    let built_in = flexible(2, 1);
    let mut told = built_in.clone();
    // More modes than are asked for: the first ones count.
    told.rod.flexible.table = Some(model::rod::beam::table(&flexible(3, 2)));
    let run = |scene: &Scene| {
        scene.check().expect("a legal scene");
        let mut simulation = Simulation::start(scene, Inputs::default()).expect("a start");
        simulation.advance_to(2e-3).expect("a motion without trouble");
        simulation.outputs()
    };
    let (one, other) = (run(&built_in), run(&told));
    assert!(one.rod.deflection != 0.0 && one.rod.stretch != 0.0 && one.slider.x != 0.12);
    assert_eq!(one, other);
}

fn with_table(table: ModalTable) -> SceneFile {
    let mut file = SceneFile::default();
    file.scene.rod.flexible.table = Some(table);
    file
}

#[test]
fn a_uniform_rod_s_table_is_legal_for_every_number_of_modes() {
    for (bending, axial) in [(0, 0), (1, 0), (0, 1), (3, 1), (1, 8), (MAX_MODES, MAX_MODES)] {
        let table = beam(bending, axial);
        assert_eq!(table.check(), Ok(()), "{bending} bending, {axial} axial modes");
        let numbers = table.numbers();
        assert_eq!(ModalTable::from_numbers(&numbers).as_ref(), Some(&table));
        assert_eq!(ModalTable::from_numbers(&numbers[..numbers.len() - 1]), None);
        assert!(numbers.len() <= MAX_NUMBERS && (bending + axial < 16 || numbers.len() == MAX_NUMBERS));
    }
}

#[test]
fn a_table_is_written_and_read_back_to_the_bit() {
    let file = with_table(beam(3, 2));
    assert_eq!(read(&write(&file), "x.toml"), Ok(file.clone()));
    let beside = |name: &str| match name {
        "beam.toml" => Ok(write_table(&beam(3, 2))),
        _ => Err(io::Error::from(io::ErrorKind::NotFound)),
    };
    let named = read_with("rod.flexible.table = \"beam.toml\"", "x.toml", &beside);
    assert_eq!(named, Ok(file));
    let missing = read_with("rod.flexible.table = \"boom.toml\"", "x.toml", &beside).expect_err("no such file");
    assert!(missing.to_string().starts_with("x.toml:1:22: rod.flexible.table = \"boom.toml\": "), "{missing}");
}

#[test]
fn a_file_is_sought_beside_the_scene() {
    let folder = std::env::temp_dir().join(format!("slidercrank-modal-table-{}", std::process::id()));
    fs::create_dir_all(folder.join("modes")).expect("a folder");
    fs::write(folder.join("modes/beam.toml"), write_table(&beam(1, 1))).expect("written");
    let scene = folder.join("scene.toml").display().to_string();
    let found = read("rod.flexible = { bending_modes = 1, table = \"modes/beam.toml\" }", &scene);
    fs::remove_dir_all(&folder).expect("removed");
    let flexible = found.expect("a legal scene").scene.rod.flexible;
    assert_eq!((flexible.bending_modes, flexible.table), (1, Some(beam(1, 1))));
}

#[test]
fn every_shipped_table_is_legal() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../fmu-harness/scenes/modes");
    let files = fs::read_dir(folder).expect("the folder of tables").map(|entry| entry.expect("an entry").path());
    let read = files.map(|file| {
        let name = file.file_name().expect("a name").to_string_lossy().into_owned();
        let text = format!("rod.flexible.table = \"modes/{name}\"");
        read(&text, &format!("{folder}/../x.toml")).map(|_| name).map_err(|error| error.to_string())
    });
    let (legal, wrong): (Vec<_>, Vec<_>) = read.partition(Result::is_ok);
    assert!(
        wrong.is_empty()
            && legal.contains(&Ok("steel-beam.toml".to_owned()))
            && legal.contains(&Ok("ferod.toml".to_owned())),
        "{wrong:?}"
    );
}

#[test]
fn a_table_without_its_form_is_told_with_its_place() {
    assert_eq!(
        refused("[rod.flexible]\ntable = 3\n"),
        "x.toml:2:9: rod.flexible.table = 3: wanted a table of modes or the name of a file that holds one"
    );
    let told = refused("[rod.flexible.table]\nmass = 1.0\n\n[[rod.flexible.table.bending]]\nfrequency = \"1 kHz\"\n");
    assert!(told.starts_with("x.toml:5:13: rod.flexible.table: ") && told.contains("string"), "{told}");
    let told = refused("[rod.flexible.table]\nmass = 1.0\nmas = 2\n");
    assert!(told.starts_with("x.toml:3:1: rod.flexible.table: unknown field `mas`"), "{told}");
    let told = refused("[rod.flexible.table]\nbending = []\n");
    assert!(told.contains("rod.flexible.table: missing field `mass`"), "{told}");
    let inside = |text: &'static str| {
        let file = move |_: &str| Ok(text.to_owned());
        read_with("rod.flexible.table = \"b.toml\"", "x.toml", &file).expect_err("a faulty file").to_string()
    };
    let told = inside("mass = 1\naxial = [{ frequency = 1 }]");
    assert!(told.starts_with("x.toml:1:22: b.toml:2:") && told.ends_with("missing field `mass`"), "{told}");
    assert!(inside("mass = ").starts_with("x.toml:1:22: b.toml:1:"), "not TOML");
}

#[test]
fn a_table_that_is_of_no_rod_and_modes_that_it_lacks_are_refused() {
    let mut short = beam(2, 1);
    short.shortening.pop();
    let told = refused(&write(&with_table(short)));
    assert!(told.ends_with(": rod.flexible.table: 2 numbers in shortening, not 3"), "{told}");
    for (key, wanted) in [("bending", 2), ("axial", 1)] {
        let ask = |modes: i32| {
            let mut file = with_table(beam(2, 1));
            let flexible = &mut file.scene.rod.flexible;
            *(if key == "bending" { &mut flexible.bending_modes } else { &mut flexible.axial_modes }) = modes;
            read(&write(&file), "x.toml").map(|file| file.scene)
        };
        assert!(ask(0).is_ok() && ask(wanted).is_ok());
        let told = ask(wanted + 1).expect_err("a mode too many").to_string();
        let number = wanted + 1;
        let said = format!(
            "rod.flexible.{key}_modes = {number} is not allowed: at most {wanted}, the {key} modes of rod.flexible.table"
        );
        assert!(told.ends_with(&said), "{told}");
    }
}
