//! Files that belong to a file of measurements, by their names.

use std::path::{Path, PathBuf};

/// Stem of the measurements whose other files have plain names.
const MEASUREMENTS: &str = "measurements";

/// Returns the path of the file `name` (`clusters.parquet`) that belongs to `measurements`. Beside
/// `measurements.csv` the file has this name. Beside measurements of another name, `mine.csv`, it is
/// `mine.clusters.parquet`: outcomes of several pipelines can stand in one directory, and none is scored with
/// the files of another.
pub fn file_beside(measurements: &Path, name: &str) -> PathBuf {
    let stem = measurements.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
    if stem.is_empty() || stem == MEASUREMENTS {
        return measurements.with_file_name(name);
    }
    measurements.with_file_name(format!("{stem}.{name}"))
}

/// Returns the path of [`file_beside`] if the file exists.
pub fn existing_file_beside(measurements: &Path, name: &str) -> Option<PathBuf> {
    Some(file_beside(measurements, name)).filter(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_of_another_name_have_files_of_their_own() {
        let beside = |measurements| file_beside(Path::new(measurements), "clusters.parquet");
        assert_eq!(beside("m/measurements.csv"), Path::new("m/clusters.parquet"));
        assert_eq!(beside("measurements.parquet"), Path::new("clusters.parquet"));
        assert_eq!(beside("m/mine.csv"), Path::new("m/mine.clusters.parquet"));
        assert_eq!(beside("m/mine.v2.csv"), Path::new("m/mine.v2.clusters.parquet"));
        assert_eq!(beside("m/mine"), Path::new("m/mine.clusters.parquet"));
    }
}
