//! The fuzzer's targets with its seeds, whole, cut and flipped: what a fuzzer does for hours, for a moment.

#[path = "../fuzz/src/lib.rs"]
mod targets;

use std::fs;
use std::path::{Path, PathBuf};

/// Places of a seed at which it is cut and where a bit is flipped.
const PLACES: usize = 40;

/// The seeds of a target.
fn seeds(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds").join(target);
    let files: Vec<PathBuf> = fs::read_dir(folder).expect("seeds").map(|entry| entry.expect("a seed").path()).collect();
    assert!(!files.is_empty(), "no seeds of {target}");
    files.iter().map(|file| fs::read(file).expect("a seed")).collect()
}

fn mangled(target: &str, run: fn(&[u8])) {
    for seed in seeds(target) {
        run(&seed);
        for place in (0..seed.len()).step_by(seed.len() / PLACES + 1) {
            run(&seed[..place]);
            let mut flipped = seed.clone();
            flipped[place] ^= 0b101;
            run(&flipped);
        }
    }
}

#[test]
fn scenes_are_refused_or_run() {
    mangled("scene", targets::scene);
}

#[test]
fn tables_of_modes_are_refused_or_run() {
    mangled("modes", targets::modes);
}

#[test]
fn states_of_every_kind_are_refused_or_go_on() {
    for kind in 0..=u8::MAX {
        targets::state(&[kind]);
        // A number that is none, a huge one, one that is a little too large; at three places each.
        for (number, bits) in [f64::NAN, 1e300, 1.0].map(f64::to_bits).into_iter().enumerate() {
            let place = [u8::try_from(7 * number).expect("small"), kind];
            let edit = [&[kind | 1][..], &place, &bits.to_le_bytes()].concat();
            targets::state(&edit);
        }
    }
}
