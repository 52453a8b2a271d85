//! Arguments shared by several commands.
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use clap::builder::{OsStringValueParser, TypedValueParser};
use files::{Failure, parse_utc};
use hifitime::Epoch;
use pipeline::external::{DEFAULT_MEMORY_MB, Sandbox};
use run::ScenarioSource;
use run::pipeline_choice::PipelineChoice;
use scenario::AttitudeChoice;

use super::interrupt::clean_up_when_interrupted;

/// A range of frames, `A..B`: from A up to, but excluding, B.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FrameRange(pub(super) Range<u64>);

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || format!("range of frames is `{text}`, expected A..B with A < B, as in 0..100");
        let (from, to) = text.split_once("..").ok_or_else(expected)?;
        let from = from.trim().parse().map_err(|_| expected())?;
        let to = to.trim().parse().map_err(|_| expected())?;
        if from < to { Ok(Self(from..to)) } else { Err(expected()) }
    }
}

/// Selection of scenario, frames and seed.
#[derive(Debug, Args)]
pub(super) struct Selection {
    /// A built-in scenario (see `boresight scenario list`) or a TOML file
    pub(super) scenario: String,
    /// Only these frames (docking: fields), from A up to, but excluding, B
    #[arg(long, value_name = "A..B")]
    pub(super) frames: Option<FrameRange>,
    /// Seed instead of the scenario's seed
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(0..=i64::MAX as u64))]
    pub(super) seed: Option<u64>,
    /// Threads that make frames; default: all cores. The results do not depend on the number of threads
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) jobs: Option<u16>,
}

/// Selection of the pipeline, and limits of an external pipeline.
#[derive(Debug, Args)]
pub(super) struct PipelineOptions {
    /// `far_range` or `docking`, or `exec:COMMAND` for a program that implements the protocol of
    /// docs/external-pipeline.md; default: the pipeline of the scenario's world
    #[arg(long, value_name = "NAME|exec:COMMAND")]
    pub(super) pipeline: Option<String>,
    /// Maximum time of an `exec:` pipeline per frame, s
    #[arg(long, value_name = "S", default_value_t = 10.0)]
    pub(super) timeout_s: f64,
    /// Maximum memory of an `exec:` pipeline, and of each process that it starts, MB; enforced on Linux
    #[arg(long, value_name = "MB", default_value_t = DEFAULT_MEMORY_MB)]
    pub(super) memory_mb: u64,
    /// Let an `exec:` pipeline read the system, the files beside it and its frames, write temporary files,
    /// and nothing else: no truth, no scenario, no run, no network. Rejected if the kernel has no Landlock
    #[arg(long, requires = "pipeline")]
    pub(super) sandbox: bool,
    /// A file or folder that an `exec:` pipeline may also read in its sandbox; may be given several times
    #[arg(long, value_name = "PATH", requires = "sandbox")]
    pub(super) sandbox_read: Vec<PathBuf>,
}

impl PipelineOptions {
    /// Returns the requested pipeline. An external program is from now on ended together with this process
    /// when the process is requested to end. A sandbox hides `hidden` from it, even if its own files lie
    /// beside them.
    pub(super) fn choice(&self, hidden: &[&Path]) -> PipelineChoice {
        if self.pipeline.as_deref().is_some_and(|word| word.starts_with("exec:")) {
            clean_up_when_interrupted();
        }
        let sandbox = self.sandbox.then(|| Sandbox {
            readable: self.sandbox_read.clone(),
            hidden: hidden.iter().map(|path| path.to_path_buf()).collect(),
        });
        PipelineChoice {
            word: self.pipeline.clone(),
            timeout_s: self.timeout_s,
            memory_mb: self.memory_mb,
            sandbox,
        }
    }
}

impl Default for PipelineOptions {
    fn default() -> Self {
        Self {
            pipeline: None,
            timeout_s: 10.0,
            memory_mb: DEFAULT_MEMORY_MB,
            sandbox: false,
            sandbox_read: Vec::new(),
        }
    }
}

/// Attitude provided to a pipeline that measures only in the image.
#[derive(Debug, Default, Args)]
pub(super) struct AttitudeOption {
    /// Far range: convert a centroid without a line of sight to a line of sight by this attitude, to give
    /// figures of the direction; default: none, unless the scenario sets one ([score] attitude)
    #[arg(long = "attitude", value_name = "ATTITUDE", value_enum)]
    pub(super) choice: Option<AttitudeChoice>,
}

/// Parses the path of a command's output; rejects `-`, which means standard output elsewhere.
pub(super) fn output_path() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|word| match word.to_str() {
        Some("-") => Err("expected a path: only `render` and `process` of videos write to standard output \
            (a file named - is ./-)"),
        Some("") => Err("expected a name"),
        _ => Ok(PathBuf::from(word)),
    })
}

impl Selection {
    /// Selects frames of a scenario with its own seed.
    pub(super) fn for_scenario(scenario: &str, frames: Option<FrameRange>, jobs: Option<u16>) -> Self {
        Self { scenario: scenario.to_owned(), frames, seed: None, jobs }
    }

    /// Returns the scenario, with the requested seed.
    pub(super) fn scenario(&self) -> Result<ScenarioSource, Failure> {
        let mut source = ScenarioSource::read(&self.scenario)?;
        if let Some(seed) = self.seed {
            source.scenario.set_seed(seed);
        }
        Ok(source)
    }

    /// Returns the requested frames of a scenario with `count` frames.
    pub(super) fn frames(&self, count: u64) -> Result<Range<u64>, Failure> {
        let frames = self.frames.as_ref().map_or(0..count, |range| range.0.clone());
        if frames.end > count {
            return Err(Failure::Usage(format!(
                "--frames is {}..{}, expected frames of the scenario, which has {count} (0..{count})",
                frames.start, frames.end
            )));
        }
        Ok(frames)
    }

    /// Returns the number of threads.
    pub(super) fn jobs(&self) -> usize {
        self.jobs.map_or_else(default_jobs, usize::from)
    }
}

/// Returns one thread per core.
pub(super) fn default_jobs() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// Parses an exposure time, s.
pub(in crate::command) fn exposure(text: &str) -> Result<f64, String> {
    number(text, 1e-6, 1000.0)
}

/// Parses a number within limits.
pub(in crate::command) fn number(text: &str, low: f64, high: f64) -> Result<f64, String> {
    let parsed: Option<f64> = text.parse().ok();
    parsed
        .filter(|value| (low..=high).contains(value))
        .ok_or_else(|| format!("expected a number from {low} to {high}"))
}

/// Parses a time for which the simulator has ephemerides.
pub(in crate::command) fn time(text: &str) -> Result<Epoch, String> {
    let time = parse_utc(text).map_err(|expected| format!("expected {expected}"))?;
    let limits = [parse_utc("1990-01-01T00:00:00Z")?, parse_utc("2050-01-05T00:00:00Z")?];
    let is_known = (limits[0]..=limits[1]).contains(&time);
    is_known.then_some(time).ok_or_else(|| "expected a time from 1990-01-01 to 2050-01-05".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_of_frames_is_read() {
        assert_eq!("3..10".parse(), Ok(FrameRange(3..10)));
    }

    #[test]
    fn a_range_that_is_empty_or_not_a_range_is_refused() {
        for text in ["", "..", "3", "3..", "10..3", "3..3", "-1..3", "a..b", "0..99999999999999999999999"] {
            assert!(text.parse::<FrameRange>().is_err(), "{text}");
        }
    }
}
