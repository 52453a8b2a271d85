//! Time that files of flight dynamics cover, and the times that a simulation needs.

use std::path::Path;

use files::{FileError, FileLocation};
use flight_dynamics::Coverage;
use hifitime::{Duration, Epoch};
use sim::onboard::ShutterConfig;
use sim::sensor::SensorConfig;
use sim::truth::{KnowledgeConfig, Schedule};

/// Interval about the middle of each exposure in which the motion is needed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reach {
    /// Before the middle: half the longest exposure (of both fields of an interlaced frame), and the delays
    /// of shutter control and telemetry.
    before: Duration,
    /// After the middle: half the longest exposure.
    after: Duration,
}

impl Reach {
    pub(crate) fn new(shutter: &ShutterConfig, sensor: &SensorConfig, knowledge: &KnowledgeConfig) -> Self {
        let (longest_s, lag_s) = match *shutter {
            ShutterConfig::Fixed { exposure_s } => (exposure_s, 0.0),
            ShutterConfig::Automatic { max_s, lag_s, .. } => (max_s, lag_s),
        };
        let fields_s = sensor.interlace.map_or(0.0, |interlace| interlace.offsets_s()[1]);
        let exposure_s = 0.5 * longest_s + fields_s;
        // Values outside their ranges are reported by the simulator.
        let duration = |seconds: f64| Duration::from_seconds(seconds.clamp(0.0, 1e6));
        Self { before: duration((exposure_s + lag_s).max(knowledge.latency_s)), after: duration(exposure_s) }
    }

    /// Before and after the middle of an exposure, s.
    pub(crate) fn seconds(&self) -> [f64; 2] {
        [self.before.to_seconds(), self.after.to_seconds()]
    }

    /// Span about the middle of an exposure.
    pub(crate) fn about(&self, time: Epoch) -> Coverage {
        Coverage { start: time - self.before, stop: time + self.after }
    }
}

/// Times at which the motion is needed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NeededTimes {
    /// Middles of the first and the last exposure.
    pub(crate) frames: [Epoch; 2],
    /// Interval about each of them.
    pub(crate) reach: Reach,
}

impl NeededTimes {
    /// Returns the times of a schedule; `None` for one without frames.
    pub(crate) fn of_schedule(schedule: &Schedule, reach: Reach) -> Option<Self> {
        schedule.ends().map(|frames| Self { frames, reach })
    }
}

/// Checks that spans without a gap between them cover the times that are needed.
///
/// # Errors
/// [`FileError::Value`] with the file and the spans.
pub(crate) fn check_coverage(
    path: &Path,
    needed: Option<NeededTimes>,
    coverage: &[Coverage],
) -> Result<(), FileError> {
    let (Some(needed), Some(start), Some(stop)) = (needed, coverage.first(), coverage.last()) else {
        return Ok(());
    };
    let whole = Coverage { start: start.start, stop: stop.stop };
    let [first, last] = needed.frames.map(|time| needed.reach.about(time));
    if whole.start <= first.start && last.stop <= whole.stop {
        return Ok(());
    }
    let frames = Coverage { start: first.start, stop: last.stop };
    let [before_s, after_s] = needed.reach.seconds();
    let expected = format!(
        "a span that contains {frames}: all frames, {before_s} s before (exposure, delays of shutter and \
         telemetry) and {after_s} s after (exposure)"
    );
    Err(FileError::value(path, FileLocation::Whole, "covered time", whole.to_string(), expected))
}
