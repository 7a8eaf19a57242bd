//! Libraries for macOS: several processors in one file, and code signatures that match the bytes.
//!
//! macOS on ARM kills a process whose code does not match the digests in its signature. The linker signs the library
//! (ad hoc: digests without a key), and the scene is written into the library after that, so it must be signed again.
//! Layouts: Apple's `mach-o/loader.h`, `mach-o/fat.h` and, for signatures, `kern/cs_blobs.h` of XNU.

use anyhow::{Context, Result, ensure};
use hmac_sha256::Hash;
use std::ops::Range;

const MAGIC_64: u32 = 0xFEED_FACF;
const HEADER_64: usize = 32;
const CODE_SIGNATURE: u32 = 0x1D;
const SUPER_BLOB: u32 = 0xFADE_0CC0;
const CODE_DIRECTORY: u32 = 0xFADE_0C02;
const HASH_SHA256: u8 = 2;
const UNIVERSAL: u32 = 0xCAFE_BABE;
/// Base-2 logarithm of the largest page size of these processors.
const ALIGNMENT: u32 = 14;

/// Computes the digests of all pages anew and writes them into the library's signature, if it has one.
///
/// # Errors
/// If the bytes are not a 64-bit Mach-O file, or if the signature has a form that linkers do not write.
pub fn sign(library: &mut [u8]) -> Result<()> {
    let Some(signature) = signature(library)? else { return Ok(()) };
    let directory = code_directory(library, signature)?;
    let byte = |at: usize| library.get(directory + at).copied().context("the signature is cut short");
    let word = |at: usize| big(library, directory + at);
    let (hashes, pages, limit) = (word(16)? as usize, word(28)? as usize, word(32)? as usize);
    let (length, kind, page) = (usize::from(byte(36)?), byte(37)?, 1usize << byte(39)?.min(ALIGNMENT as u8));
    ensure!(kind == HASH_SHA256 && length == 32, "the signature's digests are not SHA-256");
    ensure!(limit.div_ceil(page) == pages, "the signature does not cover all pages");
    let code = library.get(..limit).context("the signature covers more than the file")?;
    let digests: Vec<u8> = code.chunks(page).flat_map(|page| Hash::hash(page).to_vec()).collect();
    let place = library.get_mut(directory + hashes..).and_then(|rest| rest.get_mut(..digests.len()));
    place.context("the signature is cut short")?.copy_from_slice(&digests);
    Ok(())
}

/// Joins the libraries of several processors to one universal file. A single library is returned unchanged.
///
/// # Errors
/// If one of them is not a 64-bit Mach-O file.
pub fn universal(libraries: Vec<Vec<u8>>) -> Result<Vec<u8>> {
    if let [_] = libraries[..] {
        return Ok(libraries.into_iter().flatten().collect());
    }
    let mut file: Vec<u8> = [UNIVERSAL, libraries.len() as u32].into_iter().flat_map(u32::to_be_bytes).collect();
    let align = |end: usize| end.next_multiple_of(1 << ALIGNMENT);
    let mut end = file.len() + 20 * libraries.len();
    for library in &libraries {
        ensure!(little(library, 0)? == MAGIC_64, "not a 64-bit Mach-O file");
        let (processor, kind, start) = (little(library, 4)?, little(library, 8)?, align(end));
        let entry = [processor, kind, u32::try_from(start)?, u32::try_from(library.len())?, ALIGNMENT];
        file.extend(entry.into_iter().flat_map(u32::to_be_bytes));
        end = start + library.len();
    }
    for library in &libraries {
        file.resize(align(file.len()), 0);
        file.extend(library);
    }
    Ok(file)
}

/// Offset of the signature in the file, if there is one.
fn signature(library: &[u8]) -> Result<Option<Range<usize>>> {
    ensure!(little(library, 0)? == MAGIC_64, "not a 64-bit Mach-O file");
    let mut at = HEADER_64;
    for _ in 0..little(library, 16)? {
        let (command, size) = (little(library, at)?, little(library, at + 4)? as usize);
        if command == CODE_SIGNATURE {
            let start = little(library, at + 8)? as usize;
            return Ok(Some(start..start + little(library, at + 12)? as usize));
        }
        at += size;
    }
    Ok(None)
}

/// Offset of the code directory, which holds the digests.
fn code_directory(library: &[u8], signature: Range<usize>) -> Result<usize> {
    let start = signature.start;
    ensure!(big(library, start)? == SUPER_BLOB, "the signature has an unknown form");
    for blob in 0..big(library, start + 8)? as usize {
        let at = start + big(library, start + 12 + 8 * blob + 4)? as usize;
        if signature.contains(&at) && big(library, at)? == CODE_DIRECTORY {
            return Ok(at);
        }
    }
    anyhow::bail!("the signature has no digests")
}

fn word(bytes: &[u8], at: usize) -> Result<[u8; 4]> {
    let found = bytes.get(at..).and_then(|rest| rest.first_chunk());
    found.copied().context("the Mach-O file is cut short")
}

fn little(bytes: &[u8], at: usize) -> Result<u32> {
    Ok(u32::from_le_bytes(word(bytes, at)?))
}

fn big(bytes: &[u8], at: usize) -> Result<u32> {
    Ok(u32::from_be_bytes(word(bytes, at)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A library of two pages, the second not full, whose signature has no digests yet.
    fn library() -> Vec<u8> {
        const CODE: u32 = 5000;
        let header = [MAGIC_64, 7, 3, 6, 1, 16, 0, 0, CODE_SIGNATURE, 16, CODE, 20 + 44 + 64];
        let mut library: Vec<u8> = header.into_iter().flat_map(u32::to_le_bytes).collect();
        library.resize(CODE as usize, 0xAB);
        let blob = [SUPER_BLOB, 20 + 44 + 64, 1, 0, 20];
        let directory = [CODE_DIRECTORY, 44 + 64, 0x2_0400, 2, 44, 0, 0, 2, CODE];
        library.extend(blob.into_iter().chain(directory).flat_map(u32::to_be_bytes));
        library.extend([32, HASH_SHA256, 0, 12, 0, 0, 0, 0]);
        library.resize(library.len() + 64, 0);
        library
    }

    #[test]
    fn a_signature_has_the_digest_of_every_page_after_a_change() {
        let mut library = library();
        library[4500] = 1;
        sign(&mut library).expect("a signed library");
        let [first, second] = [&library[..4096], &library[4096..5000]].map(|page| Hash::hash(page).to_vec());
        assert_eq!(library[library.len() - 64..], [first, second].concat());
        let short = library.len() - 1;
        assert!(sign(&mut library[..short]).is_err());
        assert!(sign(&mut [0; 64]).is_err());
    }

    #[test]
    fn a_universal_file_tells_where_each_library_is() {
        let one = library();
        assert!(universal(vec![one.clone()]).expect("a library") == one);
        let both = universal(vec![one.clone(), one.clone()]).expect("two libraries");
        for entry in [8, 28] {
            let [start, length] = [entry + 8, entry + 12].map(|at| big(&both, at).expect("an entry") as usize);
            assert_eq!(start % (1 << ALIGNMENT), 0);
            assert!(both[start..start + length] == one);
        }
    }
}
