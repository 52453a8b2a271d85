//! Checks common to all tables of a target file.

use contract::OutOfRange;
use nalgebra::Vector3;

/// Rejects an empty source: without a source, an assumed value cannot be distinguished from a measured one.
pub(super) fn check_source(path: &str, source: &str) -> Result<(), OutOfRange> {
    if source.trim().is_empty() {
        return Err(OutOfRange::new(path, "empty", "a citation, or \"assumed: why\""));
    }
    Ok(())
}

pub(super) fn vector(point_m: [f64; 3]) -> Vector3<f64> {
    Vector3::from(point_m)
}
