//! The files of a report: `visibility.json`, `visibility.md`, and a CSV a curve.
use std::path::{Path, PathBuf};

use files::{Failure, FileError, Lines, WholeFile, open_regular};

use crate::report::{PointingStars, VisibilityReport};

/// Files that a report has, in the order in which they are written.
const NAMES: [&str; 7] = [
    "detection.csv",
    "limiting_magnitude.csv",
    "sky.csv",
    "exposure_window.csv",
    "target_range.csv",
    "visibility.md",
    "visibility.json",
];

/// Writes a report into a new or empty directory, each file at once or not at all, `visibility.json` last: where it is, all is.
/// `markdown` is the report for a person.
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
    let texts = [
        detection(report),
        limiting_magnitude(report),
        sky(report),
        exposure_window(report),
        target_range(report),
        markdown.to_owned(),
        json + "\n",
    ];
    let mut paths = Vec::new();
    for (name, text) in NAMES.iter().zip(texts) {
        let path = folder.join(name);
        WholeFile::with_text(&path, &text)?.commit_new()?;
        paths.push(path);
    }
    Ok(paths)
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

/// A table of lines that `header` names the columns of.
fn table(header: &str, lines: impl Iterator<Item = String>) -> String {
    let mut text = format!("{header}\n");
    for line in lines {
        text.push_str(&line);
        text.push('\n');
    }
    text
}

/// A number as it reads back to the bit; empty where there is none.
fn cell(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{value:?}"))
}

fn cells(values: &[Option<f64>]) -> String {
    values.iter().map(|value| cell(*value)).collect::<Vec<_>>().join(",")
}

fn detection(report: &VisibilityReport) -> String {
    let lines = report.detection.iter().map(|point| {
        let simulated = report.detection_simulated.iter().find(|s| s.magnitude == point.magnitude);
        let own = [Some(point.magnitude), Some(point.electrons), Some(point.probability)];
        let counts = simulated.map_or_else(|| ",".to_owned(), |s| format!("{},{}", s.count, s.of));
        let rates = simulated.map_or([None; 3], |s| [Some(s.low), Some(s.high), Some(s.analytic)]);
        format!("{},{counts},{}", cells(&own), cells(&rates))
    });
    let header = "magnitude,electrons,probability,simulated_count,simulated_of,simulated_low,simulated_high,simulated_analytic";
    table(header, lines)
}

fn limiting_magnitude(report: &VisibilityReport) -> String {
    let lines = report.limiting_magnitude.iter();
    let lines =
        lines.map(|p| cells(&[Some(p.exposure_s), p.half, p.asked, Some(p.stars), Some(p.probability)]));
    table("exposure_s,magnitude_half,magnitude_asked,stars,probability", lines)
}

fn sky(report: &VisibilityReport) -> String {
    let lines = report.sky.map.iter().map(|p| {
        format!(
            "{},{},{},{},{},{}",
            cells(&[Some(p.ra_deg), Some(p.dec_deg), Some(p.roll_deg)]),
            p.time_utc,
            p.excluded.as_deref().unwrap_or(""),
            cell(Some(p.background_e_per_s)),
            p.in_field,
            cells(&[Some(p.stars), Some(p.probability)])
        )
    });
    table("ra_deg,dec_deg,roll_deg,time_utc,excluded,background_e_per_s,in_field,stars,probability", lines)
}

/// Reads `sky.csv`.
///
/// # Errors
/// [`FileError`] for a file that cannot be read, or a row that is none of its.
pub fn read_sky(path: &Path) -> Result<Vec<PointingStars>, FileError> {
    let format = |error: csv::Error| FileError::format(path, "sky.csv", error);
    let file = Lines::new(open_regular(path)?);
    csv::Reader::from_reader(file).deserialize().map(|row| row.map_err(format)).collect()
}

fn exposure_window(report: &VisibilityReport) -> String {
    let lines = report.exposure_window.iter().map(|p| {
        let exposures = cells(&[Some(p.range_km), Some(p.longest_s), Some(p.median_s), p.shortest_s]);
        format!("{exposures},{},{}", p.is_open, cells(&[Some(p.stars), Some(p.probability)]))
    });
    table("range_km,longest_s,median_s,shortest_s,is_open,stars,probability", lines)
}

fn target_range(report: &VisibilityReport) -> String {
    let lines = report.target_range.iter().map(|p| {
        let [low, high] = p.phases_deg;
        cells(&[Some(low), Some(high), p.nominal_km, p.longest_km])
    });
    table("phase_low_deg,phase_high_deg,nominal_km,longest_km", lines)
}
