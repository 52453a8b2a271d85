//! Files named by the user: opened or read completely if they are finite.

use std::fs::File;
use std::io::{Error, Read, Result};
use std::path::Path;

/// Opens a file for reading. Refuses a pipe or a device, which may have no end or no process at the other
/// end.
///
/// # Errors
/// Those of the operating system, and for a file that is not regular.
pub fn open(path: &Path) -> Result<File> {
    // Checked before opening: opening a pipe waits for a writing process.
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() || (metadata.len() == 0 && is_kernel_file(path)) {
        return Err(Error::other("it is not a regular file"));
    }
    File::open(path)
}

/// Returns true if the kernel generates the file on reading: such a file is listed as regular and empty, and
/// may have no end.
fn is_kernel_file(path: &Path) -> bool {
    let resolved = std::fs::canonicalize(path);
    resolved.is_ok_and(|resolved| resolved.starts_with("/proc") || resolved.starts_with("/sys"))
}

/// Reads the bytes of a file of at most `max_bytes`. Refuses a pipe or a device, which may have no end.
///
/// # Errors
/// Those of the operating system, and for a file that is not regular or larger.
pub fn read(path: &Path, max_bytes: u64) -> Result<Vec<u8>> {
    let file = open(path)?;
    let length = file.metadata()?.len();
    let too_long = |length| Error::other(format!("it has {length} bytes, expected at most {max_bytes}"));
    if length > max_bytes {
        return Err(too_long(length));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    // The file may have grown since.
    file.take(max_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > max_bytes { Err(too_long(bytes.len() as u64)) } else { Ok(bytes) }
}

/// Reads the text of a file of at most `max_bytes`.
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
    fn endless_or_oversized_input_is_refused() {
        assert!(open(Path::new("/dev/zero")).is_err() && open(Path::new("/")).is_err());
        assert!(read(Path::new("/dev/zero"), 10).is_err());
        #[cfg(target_os = "linux")]
        assert!(read(Path::new("/proc/kmsg"), 10).is_err() && read(Path::new("/proc/cpuinfo"), 10).is_err());
        assert!(read_text(Path::new("/dev/zero"), 10).is_err());
        let manifest = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        let bytes = read(manifest, 1 << 20).unwrap();
        assert!(read(manifest, bytes.len() as u64 - 1).unwrap_err().to_string().contains("expected at most"));
        assert_eq!(read_text(manifest, bytes.len() as u64).unwrap().as_bytes(), bytes);
    }
}
