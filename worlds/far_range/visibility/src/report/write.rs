//! Files of a report: `visibility.json`, `visibility.md`, and one CSV file per curve.
use std::path::{Path, PathBuf};

use files::{AtomicFile, CsvLine, Failure, FieldDeclaration, FileError, Table, read_csv, table, write_csv};

use crate::report::{DetectionPoint, LimitPoint, PointingStars, RangeByPhase, VisibilityReport, WindowPoint};

table! {
    /// Point of the detection curve, with the simulated stars near its magnitude.
    struct DetectionRow: csv {
        /// V magnitude of a star of mean colour
        magnitude: f64,
        /// electrons of the star at the nominal exposure
        electrons: f64,
        /// probability of detection according to the analytic model
        probability: f64,
        /// number of stars near the magnitude that the detector found in simulated frames
        simulated_count: Option<u64>,
        /// number of stars near the magnitude in these frames
        simulated_of: Option<u64>,
        /// lower limit of the detection rate, 95 % two-sided (Wilson)
        simulated_low: Option<f64>,
        /// upper limit of the detection rate, 95 % two-sided (Wilson)
        simulated_high: Option<f64>,
        /// mean probability of these stars according to the analytic model
        simulated_analytic: Option<f64>,
    }
}

/// Returns the columns of each table of a report, by file name.
pub fn tables() -> [(&'static str, Vec<FieldDeclaration>); 5] {
    [
        ("detection.csv", DetectionRow::declarations()),
        ("limiting_magnitude.csv", LimitPoint::declarations()),
        ("sky.csv", PointingStars::declarations()),
        ("exposure_window.csv", WindowPoint::declarations()),
        ("target_range.csv", RangeByPhase::declarations()),
    ]
}

/// Writes a report into a new or empty directory, each file atomically and `visibility.json` last: if it
/// exists, the report is complete. `markdown` is the report for readers.
///
/// # Errors
/// A [`Failure`] when the directory is in use or a file cannot be written.
pub fn write_report(
    report: &VisibilityReport,
    markdown: &str,
    folder: &Path,
) -> Result<Vec<PathBuf>, Failure> {
    prepare(folder)?;
    let json = serde_json::to_string_pretty(report)
        .map_err(|error| Failure::Usage(format!("the report cannot be written as JSON: {error}")))?;
    let paths = [
        write(folder, "detection.csv", &detection(report))?,
        write(folder, "limiting_magnitude.csv", &report.limiting_magnitude)?,
        write(folder, "sky.csv", &report.sky.map)?,
        write(folder, "exposure_window.csv", &report.exposure_window)?,
        write(folder, "target_range.csv", &report.target_range)?,
        write_text(folder, "visibility.md", markdown)?,
        write_text(folder, "visibility.json", &(json + "\n"))?,
    ];
    Ok(paths.to_vec())
}

fn write<T: CsvLine>(folder: &Path, name: &str, rows: &[T]) -> Result<PathBuf, FileError> {
    let path = folder.join(name);
    write_csv(&path, rows)?;
    Ok(path)
}

fn write_text(folder: &Path, name: &str, text: &str) -> Result<PathBuf, FileError> {
    let path = folder.join(name);
    AtomicFile::with_text(&path, text)?.commit_new()?;
    Ok(path)
}

fn io(path: &Path, doing: &'static str) -> impl Fn(std::io::Error) -> FileError {
    move |source| FileError::Io { path: path.to_owned(), doing, source }
}

fn prepare(folder: &Path) -> Result<(), FileError> {
    std::fs::create_dir_all(folder).map_err(io(folder, "create"))?;
    let mut entries = std::fs::read_dir(folder).map_err(io(folder, "open"))?;
    if entries.next().is_some() {
        let reason = "exists and is not empty; nothing is overwritten";
        return Err(FileError::OutputTaken { path: folder.to_owned(), reason });
    }
    Ok(())
}

/// Returns the detection curve with the simulated rates.
fn detection(report: &VisibilityReport) -> Vec<DetectionRow> {
    let row = |point: &DetectionPoint| {
        let simulated = report.detection_simulated.iter().find(|s| s.magnitude == point.magnitude);
        DetectionRow {
            magnitude: point.magnitude,
            electrons: point.electrons,
            probability: point.probability,
            simulated_count: simulated.map(|s| s.count),
            simulated_of: simulated.map(|s| s.of),
            simulated_low: simulated.map(|s| s.low),
            simulated_high: simulated.map(|s| s.high),
            simulated_analytic: simulated.map(|s| s.analytic),
        }
    };
    report.detection.iter().map(row).collect()
}

/// Reads `sky.csv`.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, or an invalid cell, with line and column.
pub fn read_sky(path: &Path) -> Result<Vec<PointingStars>, FileError> {
    read_csv(path)
}
