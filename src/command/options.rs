//! Arguments that several commands share.
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::builder::{OsStringValueParser, TypedValueParser};
use clap::{Args, ValueEnum};
use files::Failure;
use pipeline::external::{DEFAULT_MEMORY_MB, Sandbox};
use run::RendererChoice;
use run::ScenarioSource;
use run::pipeline_choice::PipelineChoice;
use scenario::AttitudeChoice;

use super::interrupt::clean_up_when_interrupted;

/// A range of frames, `A..B`: from A up to and without B.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FrameRange(pub(super) Range<u64>);

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected =
            || format!("`{text}` is not a range of frames; expected A..B with A < B, as in 0..100");
        let (from, to) = text.split_once("..").ok_or_else(expected)?;
        let from = from.trim().parse().map_err(|_| expected())?;
        let to = to.trim().parse().map_err(|_| expected())?;
        if from < to { Ok(Self(from..to)) } else { Err(expected()) }
    }
}

/// Which scenario, which of its frames, which seed.
#[derive(Debug, Args)]
pub(super) struct Selection {
    /// A built-in scenario (see `boresight scenario list`) or a TOML file
    pub(super) scenario: String,
    /// Only these frames (docking: fields), A up to and without B
    #[arg(long, value_name = "A..B")]
    pub(super) frames: Option<FrameRange>,
    /// Seed instead of the scenario's own
    #[arg(long, value_name = "N")]
    pub(super) seed: Option<u64>,
    /// Threads that make frames; default: all cores. The results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) jobs: Option<u16>,
}

/// Which pipeline, and how long a foreign one may take.
#[derive(Debug, Args)]
pub(super) struct PipelineOptions {
    /// `far_range` or `docking`, or `exec:COMMAND` for a program that speaks the protocol of docs/external-pipeline.md;
    /// default: the one of the scenario's world
    #[arg(long, value_name = "NAME|exec:COMMAND")]
    pub(super) pipeline: Option<String>,
    /// Longest time that an `exec:` pipeline may take for a frame, s
    #[arg(long, value_name = "S", default_value_t = 10.0)]
    pub(super) timeout_s: f64,
    /// Most memory of an `exec:` pipeline, and of each process that it starts, MB; heeded on Linux
    #[arg(long, value_name = "MB", default_value_t = DEFAULT_MEMORY_MB)]
    pub(super) memory_mb: u64,
    /// Let an `exec:` pipeline read the system, the files beside it and its frames, write temporary files, and nothing else: no truth, no
    /// scenario, no run, no network. Refused where the kernel has no Landlock
    #[arg(long, requires = "pipeline")]
    pub(super) sandbox: bool,
    /// A file or folder that an `exec:` pipeline may read in its sandbox as well; may be given for several
    #[arg(long, value_name = "PATH", requires = "sandbox")]
    pub(super) sandbox_read: Vec<PathBuf>,
}

impl PipelineOptions {
    /// The pipeline asked for. If it is a program, it is ended with this process from now on, when that is asked to end. A sandbox hides
    /// `hidden` from it, though its own files may lie beside them.
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

/// What is granted to a pipeline that measures in the image alone.
#[derive(Debug, Default, Args)]
pub(super) struct AttitudeOption {
    /// Far range: turn a centroid without a line of sight into one by this attitude, so that RA and Dec have figures; default: none
    /// unless the scenario says so ([score] attitude)
    #[arg(long = "attitude", value_name = "ATTITUDE", value_enum)]
    pub(super) choice: Option<AttitudeChoice>,
}

/// Reads the place of a command's output: `-`, which elsewhere is standard output, is none.
pub(super) fn output_path() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|word| match word.to_str() {
        Some("-") => Err("expected a name: only docking's `render` and `process` write to standard output (`./-` is a file)"),
        Some("") => Err("expected a name"),
        _ => Ok(PathBuf::from(word)),
    })
}

/// Who draws a docking scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum RendererName {
    /// The fast renderer
    #[default]
    Fast,
    /// Mitsuba 3.9.1, its judge; seconds to minutes a field
    Mitsuba,
}

/// Who draws a docking scene, and where Mitsuba is.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Docking images")]
pub(super) struct RendererOptions {
    /// Who draws the scene of a docking scenario
    #[arg(long, value_name = "RENDERER", value_enum, default_value_t)]
    renderer: RendererName,
    /// The command of Mitsuba, as a shell would split it; default: that of BORESIGHT_MITSUBA, or `mitsuba`, or `uvx`
    #[arg(long, value_name = "COMMAND")]
    mitsuba: Option<String>,
    /// Folder that keeps Mitsuba's images; default: `boresight/mitsuba` in the user's cache
    #[arg(long, value_name = "DIR")]
    mitsuba_cache: Option<PathBuf>,
    /// Mitsuba's rays a pixel, a square number up to 4096; default: 256
    #[arg(long, value_name = "N")]
    mitsuba_rays: Option<u32>,
}

impl RendererOptions {
    fn check_fast(&self) -> Result<(), Failure> {
        let given = [
            ("--mitsuba", self.mitsuba.is_some()),
            ("--mitsuba-cache", self.mitsuba_cache.is_some()),
            ("--mitsuba-rays", self.mitsuba_rays.is_some()),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => {
                Err(Failure::Usage(format!("{option} is given, expected with --renderer mitsuba alone")))
            }
            None => Ok(()),
        }
    }

    /// The renderer asked for.
    pub(super) fn renderer(&self) -> Result<RendererChoice, Failure> {
        if self.renderer == RendererName::Fast {
            self.check_fast()?;
            return Ok(RendererChoice::BuiltIn);
        }
        self.mitsuba_renderer()
    }

    #[cfg(feature = "mitsuba")]
    fn mitsuba_renderer(&self) -> Result<RendererChoice, Failure> {
        let mut options = mitsuba::MitsubaOptions {
            command: self.mitsuba.clone(),
            cache: self.mitsuba_cache.clone(),
            ..mitsuba::MitsubaOptions::default()
        };
        options.settings.samples = self.mitsuba_rays.unwrap_or(options.settings.samples);
        Ok(RendererChoice::Mitsuba(Box::new(options)))
    }

    #[cfg(not(feature = "mitsuba"))]
    fn mitsuba_renderer(&self) -> Result<RendererChoice, Failure> {
        Err(super::missing_feature("mitsuba"))
    }

    /// The number of threads: one where each image has several of its own.
    pub(super) fn jobs(&self, selection: &Selection) -> usize {
        match (self.renderer, selection.jobs) {
            (RendererName::Mitsuba, None) => 1,
            _ => selection.jobs(),
        }
    }
}

impl Selection {
    /// A whole scenario as it is.
    pub(super) fn for_scenario(scenario: &str) -> Self {
        Self { scenario: scenario.to_owned(), frames: None, seed: None, jobs: None }
    }

    /// The scenario, with the seed asked for.
    pub(super) fn scenario(&self) -> Result<ScenarioSource, Failure> {
        let mut source = ScenarioSource::read(&self.scenario)?;
        if let Some(seed) = self.seed {
            source.scenario.set_seed(seed);
        }
        Ok(source)
    }

    /// The frames asked for, of a scenario of `count`.
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

    /// The number of threads.
    pub(super) fn jobs(&self) -> usize {
        self.jobs.map_or_else(default_jobs, usize::from)
    }
}

/// A thread a core.
pub(super) fn default_jobs() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
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
