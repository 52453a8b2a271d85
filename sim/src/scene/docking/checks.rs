//! What every table of a target file is checked for.

use nalgebra::Vector3;

use crate::SimError;
use crate::error::require;

/// How far from the disk anything of a target file may be, m.
pub(super) const FARTHEST_M: f64 = 1000.0;

/// Refuses an empty source: a figure without one is not to be told from a measured one.
pub(super) fn check_source(path: &str, source: &str) -> Result<(), SimError> {
    if source.trim().is_empty() {
        return Err(entry(path, "empty", "a citation, or \"assumed: why\""));
    }
    Ok(())
}

pub(super) fn check_reflectance(field: &'static str, reflectance: f64) -> Result<(), SimError> {
    require(field, reflectance, "0 to 1", |rho| (0.0..=1.0).contains(&rho))
}

/// The error of a value at a path that is known at run time only.
pub(super) fn entry(path: impl Into<String>, value: impl Into<String>, expected: &'static str) -> SimError {
    SimError::Entry { path: path.into(), value: value.into(), expected }
}

/// As [`require`], at a path that is known at run time only.
pub(super) fn require_at(
    path: String,
    value: f64,
    expected: &'static str,
    holds: impl Fn(f64) -> bool,
) -> Result<(), SimError> {
    if value.is_finite() && holds(value) { Ok(()) } else { Err(entry(path, value.to_string(), expected)) }
}

/// Checks that every coordinate of a point is finite and at most [`FARTHEST_M`] from the disk.
pub(super) fn check_point(path: String, point_m: [f64; 3]) -> Result<(), SimError> {
    // The largest as `max` orders it would pass over a NaN.
    if point_m.iter().all(|x| x.abs() <= FARTHEST_M) {
        return Ok(());
    }
    Err(entry(path, format!("{point_m:?}"), "coordinates of -1000 to 1000"))
}

pub(super) fn vector(point_m: [f64; 3]) -> Vector3<f64> {
    Vector3::from(point_m)
}
