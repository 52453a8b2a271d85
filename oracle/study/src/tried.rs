//! The pipeline that a study tries.
use std::path::Path;

use contract::docking::Docking;
use contract::{FarRange, PipelineFactory};
use files::Failure;
use files::sha256::{hex, sha256_hex};
use pipeline::docking::DockingConfig;
use pipeline::far_range::FarRangeConfig;
use run::pipeline_choice::PipelineChoice;
use scenario::{Scenario, World};

use super::definition::Study;

/// The pipeline that a study tries, built anew for every case: one that a command line can name ([`PipelineChoice`]), or one of the
/// caller's own, alive in this process. Cases ask it from several threads at once.
pub trait StudyPipeline: Sync {
    /// Refuses a scenario of a world that it is not for, before anything is written.
    ///
    /// # Errors
    /// A [`Failure`] that says what was expected.
    fn check(&self, scenario: &Scenario) -> Result<(), Failure>;

    /// SHA-256 of what its answers depend on, as far as it can be known, so that rows of two pipelines never mix; none for the built-in
    /// pipeline of a world, whose parameters are the scenario's.
    fn hash(&self, world: World) -> Option<[u8; 32]>;

    /// What runs a case of a study again, as a reader would type it; `path` is the study's file.
    fn replay(&self, study: &Study, path: &Path, case: u64) -> String;

    /// Builds it for a case of the far range. A program finds the images of its frames in `scratch`.
    ///
    /// # Errors
    /// A [`Failure`] when there is no such pipeline.
    fn factory(
        &self,
        far_range: &FarRangeConfig,
        scratch: &Path,
    ) -> Result<Box<dyn PipelineFactory<FarRange>>, Failure>;

    /// The same for a case of docking.
    ///
    /// # Errors
    /// As [`StudyPipeline::factory`].
    fn docking_factory(
        &self,
        docking: &DockingConfig,
        scratch: &Path,
    ) -> Result<Box<dyn PipelineFactory<Docking>>, Failure>;
}

impl Study {
    /// The hash of rows by a pipeline.
    pub fn hash_with(&self, pipeline: &dyn StudyPipeline) -> String {
        match pipeline.hash(self.scenario().world()) {
            Some(own) => sha256_hex(format!("{} {}", self.hash(), hex(own))),
            None => self.hash().to_owned(),
        }
    }
}

impl StudyPipeline for PipelineChoice {
    fn check(&self, scenario: &Scenario) -> Result<(), Failure> {
        PipelineChoice::check(self, scenario)
    }

    fn hash(&self, world: World) -> Option<[u8; 32]> {
        PipelineChoice::hash(self, world)
    }

    fn replay(&self, study: &Study, path: &Path, case: u64) -> String {
        let mut words = ["boresight", "study", "replay"].map(str::to_owned).to_vec();
        words.push(path.display().to_string());
        words.extend(["--case".to_owned(), case.to_string()]);
        words.extend(self.arguments(study.scenario().world()));
        words.extend(["--save-frames", "png"].map(str::to_owned));
        command_line(&words)
    }

    fn factory(
        &self,
        far_range: &FarRangeConfig,
        scratch: &Path,
    ) -> Result<Box<dyn PipelineFactory<FarRange>>, Failure> {
        PipelineChoice::factory(self, far_range, scratch)
    }

    fn docking_factory(
        &self,
        docking: &DockingConfig,
        scratch: &Path,
    ) -> Result<Box<dyn PipelineFactory<Docking>>, Failure> {
        PipelineChoice::docking_factory(self, docking, scratch)
    }
}

/// Words as a shell takes them.
pub fn command_line(words: &[String]) -> String {
    // A word of a command line has no zero byte.
    shlex::try_join(words.iter().map(String::as_str)).unwrap_or_else(|_| words.join(" "))
}
