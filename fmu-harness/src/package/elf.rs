//! What a Linux library asks of the machine that loads it.

use object::elf::FileHeader64;
use object::endian::Endianness;
use object::read::elf::FileHeader;

/// The newest glibc that a 64-bit ELF library has symbols of, such as `2.34`; `None` if it asks for none or is no ELF.
pub fn glibc(library: &[u8]) -> Option<String> {
    let newest = versions(library)?.into_iter().max()?;
    Some(newest.map(|number| number.to_string()).join("."))
}

/// Every `GLIBC_…` version that it needs. A third number is none of ours: GLIBC_2.2.5 counts as 2.2.
fn versions(library: &[u8]) -> Option<Vec<[u32; 2]>> {
    let header = FileHeader64::<Endianness>::parse(library).ok()?;
    let endian = header.endian().ok()?;
    let sections = header.sections(endian, library).ok()?;
    let (mut files, strings) = sections.gnu_verneed(endian, library).ok()??;
    let strings = sections.strings(endian, library, strings).ok()?;
    let mut versions = Vec::new();
    while let Some((_, mut needs)) = files.next().ok()? {
        while let Some(need) = needs.next().ok()? {
            let name = std::str::from_utf8(need.name(endian, strings).ok()?).ok()?;
            let Some(numbers) = name.strip_prefix("GLIBC_") else { continue };
            let mut numbers = numbers.split('.').map_while(|number| number.parse().ok());
            versions.extend(numbers.next().zip(numbers.next()).map(|(major, minor)| [major, minor]));
        }
    }
    Some(versions)
}
