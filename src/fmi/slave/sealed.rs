//! Versioned bytes: content between a header and a checksum.
//!
//! Layout, little-endian: magic (8), format version (4), digest of the declaration of variables (32), length of the
//! content (4), content, CRC-32 of everything before it (4). The bytes contain no pointers, so another process can read
//! them, and every value keeps all its bits.

use super::error::SavedStateError;
use crate::scene::checksum::crc32;
use crate::scene::parameter::DECLARATION;
use serde::Serialize;
use serde::de::DeserializeOwned;

const MAGIC: &[u8; 8] = b"SLCRANK\x1a";

/// The bytes of `content`, in format `version`.
pub fn seal(version: u32, content: &impl Serialize) -> Result<Vec<u8>, SavedStateError> {
    let content = postcard::to_allocvec(content).map_err(|_| SavedStateError::Content)?;
    let length = u32::try_from(content.len()).map_err(|_| SavedStateError::Content)?;
    let sealed = [&MAGIC[..], &version.to_le_bytes(), &DECLARATION, &length.to_le_bytes(), &content].concat();
    let checksum = crc32(&sealed).to_le_bytes();
    Ok([&sealed[..], &checksum].concat())
}

/// The content of bytes in format `version`. Zeros after the end are allowed, since an importer's buffer may be longer
/// than the state.
pub fn open<T: DeserializeOwned>(version: u32, bytes: &[u8]) -> Result<T, SavedStateError> {
    let mut reader = Reader { rest: bytes };
    if reader.take(MAGIC.len()) != Ok(MAGIC) {
        return Err(SavedStateError::NotOurs);
    }
    let found = reader.number()?;
    if found != version {
        return Err(SavedStateError::Version { found, known: version });
    }
    let declaration = reader.take(DECLARATION.len())?;
    let length = reader.number()?;
    let content = reader.take(length as usize)?;
    let sealed = bytes.len() - reader.rest.len();
    let checksum = reader.number()?;
    if reader.rest.iter().any(|&byte| byte != 0) {
        return Err(SavedStateError::Length { expected: sealed + 4, given: bytes.len() });
    }
    if crc32(&bytes[..sealed]) != checksum {
        return Err(SavedStateError::Checksum);
    }
    if declaration != DECLARATION {
        return Err(SavedStateError::Declaration);
    }
    match postcard::take_from_bytes(content) {
        Ok((content, [])) => Ok(content),
        _ => Err(SavedStateError::Content),
    }
}

/// Takes bytes from the front.
struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8], SavedStateError> {
        let cut = SavedStateError::Length { expected: length, given: self.rest.len() };
        let (taken, rest) = self.rest.split_at_checked(length).ok_or(cut)?;
        self.rest = rest;
        Ok(taken)
    }

    fn number(&mut self) -> Result<u32, SavedStateError> {
        let mut bytes = [0; 4];
        bytes.copy_from_slice(self.take(4)?);
        Ok(u32::from_le_bytes(bytes))
    }
}
