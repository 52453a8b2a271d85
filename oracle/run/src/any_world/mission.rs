//! Scenarios that are ready to run, and scored runs, without their types.

use std::any::Any;
use std::ops::Range;
use std::path::Path;
use std::str::FromStr;

use files::{Failure, RunDirectory};
use indexmap::IndexMap;
use labels::{LabelCounts, LabelFormats};
use scenario::run_file::ScenarioValues as _;
use score::{Figure, UnitTable};
use serde_json::Value;

use super::AnyFactory;
use super::erased::erased;
use crate::check::unit_mistakes::unit_mistakes;
use crate::choice::pipeline_choice::PipelineChoice;
use crate::frame_jobs::FrameJobs;
use crate::run_result::RunResult;
use crate::sequence;
use crate::world::{Judgement, World};

erased! {
    /// A scenario with its simulator, of any world.
    pub trait AnyMission: Any, Send, Sync;

    impl<W: World> for W {
        /// Returns the number of frames of the whole scenario.
        fn frame_count(&self) -> u64 {
            W::frame_count(self)
        }

        /// Returns the summary of a scenario check: as JSON, and as text for the user.
        fn summary(&self) -> (Value, String) {
            W::summary(self)
        }

        /// Returns warnings about values that are permitted and may be unintended.
        fn warnings(&self) -> Vec<String> {
            let scenario = self.scenario().to_json().unwrap_or_default();
            W::warnings(self).into_iter().chain(unit_mistakes(&scenario)).collect()
        }

        /// Returns the factory of the chosen pipeline.
        ///
        /// # Errors
        /// Those of [`PipelineChoice::factory`].
        fn factory(&self, choice: &PipelineChoice, scratch: &Path) -> Result<AnyFactory, Failure> {
            Ok(AnyFactory::new(choice.factory::<W>(W::config(self.scenario()), scratch)?))
        }

        /// Refuses a flight that cannot succeed, before anything is written.
        ///
        /// # Errors
        /// A [`Failure`] with the reason.
        fn check_frame_jobs(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure> {
            W::check_frame_jobs(self, &frame_jobs.parse()?)
        }

        /// Refuses label formats that cannot express the labels of the world, before anything is written;
        /// returns a note for the user about the labels, if there is one.
        ///
        /// # Errors
        /// [`Failure::Usage`] with the reason.
        fn check_labels(&self, formats: &LabelFormats) -> Result<Option<String>, Failure> {
            let set = self.label_set()?;
            set.check(formats)?;
            Ok(set.note)
        }

        /// Renders a dataset, as [`sequence::render`]; returns a description of the files that it contains
        /// for a pipeline, and the numbers of labels.
        ///
        /// # Errors
        /// A [`Failure`] when a file cannot be written.
        fn render(
            &self,
            directory: &RunDirectory,
            frame_jobs: &FrameJobs<String>,
            label_formats: Option<&LabelFormats>,
            done: &dyn Fn(),
        ) -> Result<(String, Option<LabelCounts>), Failure> {
            let frame_jobs: FrameJobs<W::Images> = frame_jobs.parse()?;
            let images = frame_jobs.images.unwrap_or(W::IMAGES);
            let frame_jobs = FrameJobs { images: Some(images), ..frame_jobs };
            let counts = sequence::render(self, directory, &frame_jobs, label_formats, done)?;
            Ok((W::files_for_pipelines(images), counts))
        }

        /// Refuses a flight whose images cannot be written to standard output.
        ///
        /// # Errors
        /// [`Failure::Usage`] for a format that cannot be streamed, or a world without a stream.
        fn check_stream(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure> {
            W::check_stream(self, &frame_jobs.parse()?)
        }

        /// Writes images to standard output, in a format that can be streamed.
        ///
        /// # Errors
        /// A [`Failure`] when standard output cannot be written, or the world has no stream.
        fn stream(&self, frame_jobs: &FrameJobs<String>) -> Result<(), Failure> {
            W::stream(self, &frame_jobs.parse()?)
        }

        /// Makes, processes, scores and writes frames, as [`sequence::run`].
        ///
        /// # Errors
        /// A [`Failure`] when a file cannot be written or the pipeline cannot be built; the error of `go_on`.
        fn run(
            &self,
            directory: &RunDirectory,
            frame_jobs: &FrameJobs<String>,
            factory: &AnyFactory,
            go_on: &dyn Fn() -> Result<(), Failure>,
        ) -> Result<RunResult<Box<dyn AnyJudgement>>, Failure> {
            Ok(sequence::run(self, directory, &frame_jobs.parse()?, factory.downcast()?, go_on)?.boxed())
        }

        /// Makes, processes and scores frames without files, as [`sequence::score`].
        ///
        /// # Errors
        /// A [`Failure`] when the pipeline cannot be built.
        fn score(
            &self,
            frames: Range<u64>,
            factory: &AnyFactory,
        ) -> Result<RunResult<Box<dyn AnyJudgement>>, Failure> {
            Ok(sequence::score(self, frames, factory.downcast()?)?.boxed())
        }
    }
}

/// A scored run of any world.
pub trait AnyJudgement: Any + Send {
    /// Returns the content of `score.json`.
    ///
    /// # Errors
    /// A [`Failure`] when the score cannot be written as JSON.
    fn json(&self) -> Result<String, Failure>;

    /// Returns the figures over all frames.
    fn figures(&self) -> &IndexMap<String, Figure>;

    /// Returns the run frame by frame, for a comparison with another run.
    fn units(&self) -> UnitTable;
}

impl<S: Judgement + Send + 'static> AnyJudgement for S {
    fn json(&self) -> Result<String, Failure> {
        serde_json::to_string_pretty(self.score())
            .map_err(|error| Failure::Usage(format!("the score cannot be written as JSON: {error}")))
    }

    fn figures(&self) -> &IndexMap<String, Figure> {
        Judgement::figures(self)
    }

    fn units(&self) -> UnitTable {
        Judgement::units(self)
    }
}

impl dyn AnyJudgement {
    /// Returns the scored run with its type `S`; `None` for a run of another world.
    pub fn typed<S: Judgement + 'static>(&self) -> Option<&S> {
        let scored: &dyn Any = self;
        scored.downcast_ref()
    }

    /// Returns the mutable scored run with its type `S`; `None` for a run of another world.
    pub fn typed_mut<S: Judgement + 'static>(&mut self) -> Option<&mut S> {
        let scored: &mut dyn Any = self;
        scored.downcast_mut()
    }
}

impl<S: Judgement + Send + 'static> RunResult<S> {
    fn boxed(self) -> RunResult<Box<dyn AnyJudgement>> {
        let Self { scored, first_failure, incomplete } = self;
        RunResult { scored: Box::new(scored), first_failure, incomplete }
    }
}

impl FrameJobs<String> {
    /// Returns the flight with the image format parsed for a world.
    fn parse<F: FromStr<Err = String>>(&self) -> Result<FrameJobs<F>, Failure> {
        let images = self.images.as_deref().map(str::parse).transpose().map_err(Failure::Usage)?;
        Ok(FrameJobs {
            frames: self.frames.clone(),
            jobs: self.jobs,
            images,
            expectation: self.expectation,
            states_of: self.states_of.clone(),
        })
    }
}
