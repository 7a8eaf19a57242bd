//! Saved states as bytes, cut, damaged and of others: refused in one line each, and nothing changed.

use crate::face::Face;
use crate::scenes::{MECHANISMS, hosted};
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::v2::Status;

/// What the magic and the format's version take, and the digest of the declaration after them.
const VERSION: std::ops::Range<usize> = 8..12;
const DIGEST: std::ops::Range<usize> = 12..44;

/// Bytes before the content: magic, version, digest, length.
pub const HEADER: usize = 48;

/// A run that has begun, and its bytes.
fn begun<F: Face>(mechanism: usize) -> (F, Vec<u8>) {
    let slave: F = MECHANISMS[mechanism].running();
    let point = slave.steps(0.0, 1e-4, 5);
    assert_eq!(slave.set("slider.load", 3.0), Status::Ok);
    slave.steps(point, 1e-4, 1);
    let bytes = slave.memory();
    (slave, bytes)
}

/// A run that has begun of a mechanism that can be hosted so, and its bytes.
fn any<F: Face>() -> (F, Vec<u8>) {
    begun(hosted::<F>()[0])
}

/// The bytes are refused in one line with these words.
fn refused<F: Face>(slave: &F, bytes: &[u8], words: &str, what: &str) {
    assert_eq!(slave.deserialize(bytes), Err(Status::Error), "{what}");
    let line = slave.only();
    let named = line.text.starts_with(&format!("{}: ", F::DESERIALIZE));
    assert!(named && line.text.contains(words), "{what}: {line:?}");
}

/// With its checksum mended.
pub fn resealed(bytes: &[u8], change: impl FnOnce(&mut [u8])) -> Vec<u8> {
    let (sealed, _) = bytes.split_at(bytes.len() - 4);
    let mut sealed = sealed.to_vec();
    change(&mut sealed);
    let checksum = crc32fast::hash(&sealed).to_le_bytes();
    [&sealed[..], &checksum].concat()
}

fn bytes_cut_at_any_length_are_refused<F: Face>() {
    for mechanism in hosted::<F>() {
        let (slave, bytes) = begun::<F>(mechanism);
        for length in 0..bytes.len() {
            let words = if length < VERSION.start { "not a state of this FMU" } else { "instead of" };
            refused(&slave, &bytes[..length], words, &format!("{length} bytes"));
        }
        assert_eq!(slave.memory(), bytes);
    }
}

fn a_damaged_byte_anywhere_is_refused<F: Face>() {
    for mechanism in hosted::<F>() {
        let (slave, bytes) = begun::<F>(mechanism);
        for at in 0..bytes.len() {
            for pattern in [1 << (at % 8), 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= pattern;
                refused(&slave, &damaged, "state", &format!("byte {at} by {pattern:#x}"));
            }
        }
        assert_eq!(slave.memory(), bytes);
    }
}

fn another_version_and_another_declaration_are_told_from_damage<F: Face>() {
    let (slave, bytes) = any::<F>();
    for bit in 0..32 {
        let other = resealed(&bytes, |sealed| sealed[VERSION.start + bit / 8] ^= 1 << (bit % 8));
        refused(&slave, &other, "format version", &format!("bit {bit}"));
    }
    for at in DIGEST {
        let other = resealed(&bytes, |sealed| sealed[at] ^= 0x10);
        refused(&slave, &other, "other variables", &format!("byte {at}"));
    }
}

fn what_follows_a_state_is_zeros_or_the_state_is_refused<F: Face>() {
    let (slave, bytes) = any::<F>();
    for spare in [1, 2, 100] {
        let mut longer = [&bytes[..], &vec![0; spare]].concat();
        assert!(slave.deserialize(&longer).is_ok());
        longer[bytes.len() + spare - 1] = 1;
        refused(&slave, &longer, "instead of", &format!("{spare} bytes more"));
    }
    refused(&slave, &[&bytes[..], &bytes[..]].concat(), "instead of", "twice the state");
}

fn each_kind_of_damage_is_told_in_words_of_its_own<F: Face>() {
    let (slave, bytes) = any::<F>();
    let told = |change: &dyn Fn(&mut Vec<u8>), words: &str| {
        let mut damaged = bytes.clone();
        change(&mut damaged);
        refused(&slave, &damaged, words, words);
    };
    let known = F::Content::FORMAT;
    let of_fmi = |format: u32| match format >> 16 {
        3 => format!("version {} for FMI 3.0", format & 0xffff),
        _ => format!("version {format} for FMI 2.0"),
    };
    let of_version = |found: u32| {
        let words = format!("{}; this FMU reads {}", of_fmi(found), of_fmi(known));
        told(&|bytes| bytes[VERSION].copy_from_slice(&found.to_le_bytes()), &words);
    };
    told(&|bytes| bytes[0] = b'X', "not a state of this FMU");
    of_version(known + 1);
    of_version(1);
    told(&|bytes| bytes.truncate(bytes.len() - 1), "instead of");
    told(&|bytes| *bytes.last_mut().expect("bytes") ^= 1, "checksum");
    told(&|bytes| *bytes = resealed(bytes, |sealed| sealed[HEADER] = 99), "contradicts itself");
}

on_each_face! {
    bytes_cut_at_any_length_are_refused
    a_damaged_byte_anywhere_is_refused
    another_version_and_another_declaration_are_told_from_damage
    what_follows_a_state_is_zeros_or_the_state_is_refused
    each_kind_of_damage_is_told_in_words_of_its_own
}
