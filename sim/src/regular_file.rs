//! Files that a user names: read whole, if they have an end.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

use std::io::{Error, Result};
use std::path::Path;

/// The bytes of a file of at most `max_bytes`. A pipe or a device, which may have no end, is refused.
///
/// # Errors
/// Those of the operating system, and for a file that is not regular or larger.
pub fn read(path: &Path, max_bytes: u64) -> Result<Vec<u8>> {
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(Error::other("it is not a regular file"));
    }
    if metadata.len() > max_bytes {
        return Err(Error::other(format!("it has {} bytes, expected at most {max_bytes}", metadata.len())));
    }
    std::fs::read(path)
}

/// The text of such a file.
///
/// # Errors
/// Those of [`read`], and for bytes that are not UTF-8.
pub fn read_text(path: &Path, max_bytes: u64) -> Result<String> {
    String::from_utf8(read(path, max_bytes)?)
        .map_err(|_| Error::new(std::io::ErrorKind::InvalidData, "stream did not contain valid UTF-8"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_have_no_end_or_is_too_large_is_refused() {
        assert!(read(Path::new("/dev/zero"), 10).is_err());
        assert!(read_text(Path::new("/dev/zero"), 10).is_err());
        let own = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        let bytes = read(own, 1 << 20).unwrap();
        assert!(read(own, bytes.len() as u64 - 1).unwrap_err().to_string().contains("expected at most"));
        assert_eq!(read_text(own, bytes.len() as u64).unwrap().as_bytes(), bytes);
    }
}
