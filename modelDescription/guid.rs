//! guid = digest of the declaration, then of the start values.

use hmac_sha256::Hash;

/// Digest of a declaration, told as the XML that it makes with no guid in it.
pub fn digest(xml: &str) -> [u8; 32] {
    Hash::hash(xml.as_bytes())
}

/// The guid of a package: 32 hexadecimal digits in the customary groups.
pub fn guid(declaration: &[u8; 32], starts: impl IntoIterator<Item = f64>) -> String {
    let mut hasher = Hash::new();
    hasher.update(declaration);
    for start in starts {
        hasher.update(start.to_le_bytes());
    }
    let digits: String = hasher.finalize().iter().take(16).map(|byte| format!("{byte:02x}")).collect();
    [0..8, 8..12, 12..16, 16..20, 20..32].map(|group| &digits[group]).join("-")
}
