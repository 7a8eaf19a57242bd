//! The scene embedded in the library, so that a packaged FMU needs no resource file.
//!
//! A block in the library's data contains, little endian: a magic, the version of the block, the length of the payload,
//! its CRC-32, and the payload: the guid, the values of all parameters in the order of the declaration, and the numbers
//! of the rod's modal table if there is one. The rest is zeros. In a library as compiled the length is 0, which stands
//! for the declared start values. The packager searches the library file for the magic and writes a scene's values
//! behind it.

use super::checksum::crc32;
use super::data::Scene;
use super::modal::{MAX_NUMBERS, ModalTable};
use super::modal_check::TableError;
use super::parameter::{DECLARATION, DEFAULT_GUID, PARAMETER_COUNT, PARAMETERS, Refusal};
use crate::model_description::guid as digest;
use std::fmt;
use std::hint::black_box;

/// The magic in reverse order: the block is the only place in a library where it stands forward.
const MAGIC_REVERSED: [u8; 24] = *b"\x01tols-enecs-knarcredils\xF5";
const VERSION: u32 = 2;
const GUID: usize = 36;
const MAGIC: usize = MAGIC_REVERSED.len();
const HEADER: usize = MAGIC + 12;
/// Length of the payload without a modal table [bytes].
const PAYLOAD: usize = GUID + 8 * PARAMETER_COUNT;
const BLOCK: usize = HEADER + PAYLOAD + 8 * MAX_NUMBERS;

static SLOT: [u8; BLOCK] = blank();

const fn blank() -> [u8; BLOCK] {
    let mut block = [0; BLOCK];
    let mut i = 0;
    while i < MAGIC {
        block[i] = MAGIC_REVERSED[MAGIC - 1 - i];
        i += 1;
    }
    block[MAGIC] = VERSION as u8;
    block
}

/// Errors of the embedded scene.
#[derive(Clone, Debug, PartialEq)]
pub enum SlotError {
    /// The library contains no block.
    Missing,
    /// The library contains several blocks.
    Repeated(usize),
    /// The block is truncated or has another version.
    Version(u32),
    /// The length of the payload does not fit this version.
    Length(u32),
    /// The checksum of the payload is wrong.
    Checksum,
    /// The value of a parameter is not allowed.
    Value(Refusal),
    /// The modal table is invalid.
    Table(TableError),
}

impl fmt::Display for SlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("the library holds no block for a scene"),
            Self::Repeated(count) => {
                write!(f, "the library holds {count} blocks for a scene, not one")
            }
            Self::Version(version) => {
                write!(f, "the library's scene is of version {version}, not {VERSION}")
            }
            Self::Length(length) => {
                write!(f, "the library's scene has {length} bytes, not {PAYLOAD} and those of a modal table")
            }
            Self::Checksum => f.write_str("the library's scene is damaged"),
            Self::Value(refusal) => write!(f, "the library's scene: {refusal}"),
            Self::Table(error) => write!(f, "the library's scene: {error}"),
        }
    }
}

impl std::error::Error for SlotError {}

/// The guid of a package of this scene: a digest of the declaration and of the scene's values.
pub fn guid(scene: &Scene) -> String {
    digest::guid(&DECLARATION, numbers(scene))
}

/// The scene with which this library was packaged, and its guid.
pub fn read() -> Result<(Scene, String), SlotError> {
    // Without `black_box` the compiler would use the bytes that it knows at compile time.
    parse(black_box(&SLOT))
}

/// Writes a scene and its guid into the bytes of a compiled library.
pub fn write(library: &mut [u8], scene: &Scene) -> Result<(), SlotError> {
    let start = locate(library)?;
    let block = library.get_mut(start..start + BLOCK).ok_or(SlotError::Missing)?;
    let version = word(block, MAGIC);
    if version != VERSION {
        return Err(SlotError::Version(version));
    }
    if let Some(table) = &scene.rod.flexible.table {
        table.check().map_err(SlotError::Table)?;
    }
    let mut payload = guid(scene).into_bytes();
    payload.extend(numbers(scene).into_iter().flat_map(f64::to_le_bytes));
    let words = [payload.len() as u32, crc32(&payload)];
    block[MAGIC + 4..HEADER].copy_from_slice(words.map(u32::to_le_bytes).as_flattened());
    let (front, rest) = block[HEADER..].split_at_mut(payload.len());
    front.copy_from_slice(&payload);
    rest.fill(0);
    Ok(())
}

/// Byte offset of the only block in a library.
fn locate(library: &[u8]) -> Result<usize, SlotError> {
    let mut magic = black_box(MAGIC_REVERSED);
    magic.reverse();
    let windows = library.windows(MAGIC).enumerate();
    let found: Vec<usize> = windows.filter(|(_, bytes)| *bytes == magic).map(|(offset, _)| offset).collect();
    match found[..] {
        [] => Err(SlotError::Missing),
        [offset] => Ok(offset),
        _ => Err(SlotError::Repeated(found.len())),
    }
}

/// The scene and guid in a block.
fn parse(block: &[u8; BLOCK]) -> Result<(Scene, String), SlotError> {
    let (version, length, checksum) = (word(block, MAGIC), word(block, MAGIC + 4), word(block, MAGIC + 8));
    if version != VERSION {
        return Err(SlotError::Version(version));
    }
    let mut scene = Scene::default();
    if length == 0 {
        return Ok((scene, DEFAULT_GUID.to_owned()));
    }
    let payload = block[HEADER..].get(..length as usize).filter(|payload| payload.len() >= PAYLOAD);
    let payload = payload.ok_or(SlotError::Length(length))?;
    if crc32(payload) != checksum {
        return Err(SlotError::Checksum);
    }
    let (guid, numbers) = payload.split_at(GUID);
    let guid = std::str::from_utf8(guid).map_err(|_| SlotError::Checksum)?;
    let (numbers, rest) = numbers.as_chunks::<8>();
    let numbers: Vec<f64> = numbers.iter().map(|number| f64::from_le_bytes(*number)).collect();
    let (values, table) = numbers.split_at(PARAMETER_COUNT);
    for (parameter, value) in PARAMETERS.iter().zip(values) {
        parameter.write(&mut scene, *value).map_err(SlotError::Value)?;
    }
    if !table.is_empty() || !rest.is_empty() {
        let table = ModalTable::from_numbers(table).filter(|_| rest.is_empty()).ok_or(SlotError::Length(length))?;
        table.check().map_err(SlotError::Table)?;
        scene.rod.flexible.table = Some(table);
    }
    Ok((scene, guid.to_owned()))
}

/// All values of a scene that the payload contains.
fn numbers(scene: &Scene) -> Vec<f64> {
    let mut numbers: Vec<f64> = PARAMETERS.iter().map(|parameter| parameter.value(scene)).collect();
    numbers.extend(scene.rod.flexible.table.iter().flat_map(ModalTable::numbers));
    numbers
}

/// The little-endian word at a byte offset of a block.
fn word(block: &[u8], offset: usize) -> u32 {
    let bytes = [0, 1, 2, 3].map(|i| block[offset + i]);
    u32::from_le_bytes(bytes)
}

#[cfg(test)]
mod tests {
    use super::super::modal::AxialMode;
    use super::*;

    fn library() -> Vec<u8> {
        [&[0xAB; 777], SLOT.as_slice(), &[0xCD; 99]].concat()
    }

    fn reread(library: &[u8]) -> Result<(Scene, String), SlotError> {
        let start = locate(library)?;
        parse(library[start..start + BLOCK].try_into().expect("a whole block"))
    }

    #[test]
    fn an_unwritten_library_has_the_declared_scene_and_its_guid() {
        let declared = (Scene::default(), guid(&Scene::default()));
        assert_eq!(read(), Ok(declared.clone()));
        assert_eq!(reread(&library()), Ok(declared));
    }

    #[test]
    fn what_is_written_is_read_back_and_nothing_else_is_touched() {
        let mut scene = Scene::default();
        scene.joint.c.clearance = 1.25e-4;
        scene.joint.t.model = super::super::JointModel::Clearance;
        let mut patched = library();
        for _ in 0..2 {
            write(&mut patched, &scene).expect("room for the scene");
        }
        assert_eq!(reread(&patched), Ok((scene.clone(), guid(&scene))));
        assert_ne!(guid(&scene), guid(&Scene::default()));
        assert_eq!(patched[..777], library()[..777]);
        assert_eq!(patched[777 + BLOCK..], library()[777 + BLOCK..]);
    }

    #[test]
    fn modes_travel_with_the_scene_and_count_in_the_guid() {
        let mut scene = Scene::default();
        let plain = guid(&scene);
        let axial = |end: f64| ModalTable {
            mass: 2.0,
            axial: vec![AxialMode { frequency: 1e4, mass: 1.0, end }],
            first: vec![1.0, 1.2],
            second: vec![vec![0.6, 0.7], vec![0.7, 1.0]],
            coupling: vec![vec![], vec![]],
            ..ModalTable::default()
        };
        let mut guids = vec![plain];
        let mut patched = library();
        for end in [1.4, 1.5] {
            scene.rod.flexible.table = Some(axial(end));
            write(&mut patched, &scene).expect("room for the scene");
            assert_eq!(reread(&patched), Ok((scene.clone(), guid(&scene))));
            assert!(!guids.contains(&guid(&scene)));
            guids.push(guid(&scene));
        }
        let mut torn = patched.clone();
        torn[777 + HEADER + PAYLOAD + 40] ^= 1;
        assert_eq!(reread(&torn), Err(SlotError::Checksum));
        // A length that no table has, or beyond the block, is rejected before any number is read.
        for length in [PAYLOAD - 8, PAYLOAD + 12, PAYLOAD + 80, BLOCK, usize::MAX >> 32] {
            let mut foreign = patched.clone();
            let end = (777 + HEADER + length).min(777 + BLOCK);
            let checksum = crc32(&foreign[777 + HEADER..end]);
            foreign[777 + MAGIC + 4..777 + MAGIC + 8].copy_from_slice(&(length as u32).to_le_bytes());
            foreign[777 + MAGIC + 8..777 + HEADER].copy_from_slice(&checksum.to_le_bytes());
            assert_eq!(reread(&foreign), Err(SlotError::Length(length as u32)));
        }
        // The numbers of a former table are erased.
        scene.rod.flexible.table = None;
        write(&mut patched, &scene).expect("room for the scene");
        let mut fresh = library();
        write(&mut fresh, &scene).expect("room for the scene");
        assert!(patched == fresh);
        scene.rod.flexible.table = Some(ModalTable::default());
        assert!(matches!(write(&mut patched, &scene), Err(SlotError::Table(_))));
        assert!(patched == fresh);
    }

    #[test]
    fn damage_and_doubles_are_refused() {
        let scene = Scene::default();
        assert_eq!(write(&mut [0; 4096], &scene), Err(SlotError::Missing));
        assert_eq!(write(&mut [library(), library()].concat(), &scene), Err(SlotError::Repeated(2)));
        let mut cut = library();
        cut.truncate(800);
        assert_eq!(write(&mut cut, &scene), Err(SlotError::Missing));
        let mut damaged = library();
        write(&mut damaged, &scene).expect("room for the scene");
        damaged[777 + HEADER + 100] ^= 1;
        assert_eq!(reread(&damaged), Err(SlotError::Checksum));
        damaged[777 + MAGIC] = 9;
        assert_eq!(write(&mut damaged, &scene), Err(SlotError::Version(9)));
    }
}
