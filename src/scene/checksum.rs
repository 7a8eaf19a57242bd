//! The checksum of what the library reads back: an embedded scene, a saved state.

use crc::{CRC_32_ISO_HDLC, Crc};

/// Its table has 1 kB. Tables of 16 kB would be faster, but a hundredth of the FMU.
static TABLE: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The CRC-32 of `bytes` (ISO 3309, as in ZIP archives).
pub fn crc32(bytes: &[u8]) -> u32 {
    TABLE.checksum(bytes)
}
