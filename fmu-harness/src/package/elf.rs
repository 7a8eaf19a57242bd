//! The glibc that a Linux library needs.

use object::elf::FileHeader64;
use object::endian::Endianness;
use object::read::elf::FileHeader;
use std::fmt::{Display, Formatter, Result};

/// A version of glibc. A third number is left out: the symbol version GLIBC_2.2.5 counts as 2.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Glibc {
    /// The first number.
    pub major: u32,
    /// The second number.
    pub minor: u32,
}

impl Display for Glibc {
    fn fmt(&self, formatter: &mut Formatter) -> Result {
        write!(formatter, "{}.{}", self.major, self.minor)
    }
}

/// The oldest glibc that a 64-bit ELF library can run with; `None` if it needs no glibc or is no ELF library.
pub fn glibc(library: &[u8]) -> Option<Glibc> {
    versions(library)?.into_iter().max()
}

/// Every version `GLIBC_…` among the symbol versions that the library needs.
fn versions(library: &[u8]) -> Option<Vec<Glibc>> {
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
            versions.extend(numbers.next().zip(numbers.next()).map(|(major, minor)| Glibc { major, minor }));
        }
    }
    Some(versions)
}
