//! Parts of all messages.

use std::path::Path;

use far_range::FarRangeScenario;
use far_range::rows::{FrameTruthRow, TelemetryRow};
use files::{Failure, FileError, FileLocation, TableReader};
use flight_dynamics::Header;
use scenario::run_file::RunFile;
use sim::truth::{FrameTruth, Schedule, clock};

/// Names of the spacecraft in messages.
pub(super) const CHASER: &str = "CHASER";
pub(super) const TARGET: &str = "TARGET";

/// A message, and the number of records that it cannot hold: those alone between two gaps.
pub(super) struct Export<M> {
    pub(super) message: M,
    pub(super) left_out: usize,
}

/// Returns the header of a message of a run, with comments on its content.
pub(super) fn header(run: &RunFile<FarRangeScenario>, comments: Vec<String>) -> Header {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let seconds = now.map_or(0, |now| now.as_secs());
    let version = &run.version;
    let common = [
        format!("scenario {}, hash {}, Boresight {version}", run.name, run.hash),
        "Axes are those of the star catalogue, ICRS.".to_owned(),
    ];
    Header {
        originator: "BORESIGHT".to_owned(),
        creation_time: clock::from_unix_ns(i64::try_from(seconds).unwrap_or(0).saturating_mul(1_000_000_000)),
        message_id: None,
        comments: common.into_iter().chain(comments).collect(),
    }
}

/// Returns the truth of the frames of a run, in order. Their times are those of the schedule: a timestamp of
/// the file has the same value throughout a leap second.
pub(super) fn true_frames(
    directory: &Path,
    run: &RunFile<FarRangeScenario>,
) -> Result<Vec<FrameTruth>, Failure> {
    let path = directory.join("truth/frames.parquet");
    let mut frames = Vec::new();
    for rows in TableReader::<FrameTruthRow>::open(&path)? {
        frames.extend(rows?.1.into_iter().map(|row| row.0));
    }
    if frames.is_empty() {
        return Err(FileError::value(&path, FileLocation::Whole, "number of rows", 0, "frames").into());
    }
    let schedule = Schedule::new(&run.scenario.schedule)?;
    for truth in &mut frames {
        if let Some((_, time)) = schedule.frame(truth.frame) {
            truth.time = time;
        }
    }
    Ok(frames)
}

/// Returns the telemetry of a frame.
pub(super) fn telemetry_of<'a>(
    directory: &Path,
    telemetry: &'a [TelemetryRow],
    frame: u64,
) -> Result<&'a TelemetryRow, Failure> {
    let row = telemetry.binary_search_by_key(&frame, |row| row.frame).ok();
    row.and_then(|place| telemetry.get(place)).ok_or_else(|| {
        let path = directory.join("telemetry.csv");
        let expected = "a row for every measured frame";
        FileError::value(&path, FileLocation::Whole, "frame", frame, expected).into()
    })
}
