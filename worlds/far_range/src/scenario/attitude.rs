//! Attitude of the chaser from a file.

use std::path::Path;
use std::sync::Arc;

use files::{Failure, FileError, FileLocation};
use flight_dynamics::{Aem, Coverage};
use sim::truth::{AttitudeConfig, AttitudeProfile, Guidance, Schedule};

use crate::scenario::coverage::Reach;

/// Returns the attitude of the file that guidance names; `None` for other guidance. Frames of `schedule`,
/// with `reach` about each, must lie within the time that the file covers; between its segments there may be
/// gaps without frames.
///
/// # Errors
/// A [`Failure`] for a file that cannot be read, or does not cover all frames.
pub(crate) fn attitude_profile(
    config: &AttitudeConfig,
    schedule: Option<&Schedule>,
    reach: Reach,
) -> Result<Option<AttitudeProfile>, Failure> {
    let Guidance::Aem { file } = &config.guidance else { return Ok(None) };
    let path = Path::new(file);
    let ephemeris = Aem::read_pointing(path)?.0.ephemeris();
    if let Some(schedule) = schedule {
        let coverage = ephemeris.coverage();
        for frame in 0..schedule.frame_count() {
            let Some((_, time)) = schedule.frame(frame) else { break };
            let needed = reach.about(time);
            let is_covered = |time| coverage.iter().any(|span| span.start <= time && time <= span.stop);
            if ![needed.start, time, needed.stop].into_iter().all(is_covered) {
                let spans: Vec<String> = coverage.iter().take(4).map(Coverage::to_string).collect();
                let expected = format!("spans that contain the times of frame {frame}, {needed}");
                let value = spans.join(", ");
                return Err(
                    FileError::value(path, FileLocation::Whole, "covered time", value, expected).into()
                );
            }
        }
    }
    Ok(Some(AttitudeProfile(Arc::new(ephemeris))))
}

/// Returns remarks on unusual attitudes in the file that guidance names, each with file and line; none for a
/// file with errors.
pub(crate) fn attitude_remarks(config: &AttitudeConfig) -> Vec<String> {
    let Guidance::Aem { file } = &config.guidance else { return Vec::new() };
    Aem::read_pointing(Path::new(file)).map(|(_, remarks)| remarks).unwrap_or_default()
}
