//! SHA-256 as text: 64 hexadecimal digits.

use sha2::{Digest, Sha256};

/// Returns the hexadecimal digits of a digest.
pub fn hex(digest: impl AsRef<[u8]>) -> String {
    digest.as_ref().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns the hexadecimal digits of the SHA-256 of `bytes`.
pub fn sha256_hex(bytes: impl AsRef<[u8]>) -> String {
    hex(Sha256::digest(bytes))
}
