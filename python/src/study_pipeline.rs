//! Pipeline written in Python, for the cases of a study. Cases call it in parallel, one call at a time.

use std::path::Path;
use std::sync::Arc;

use boresight::failure::Failure;
use boresight::run::{AnyFactory, AnyScenario, AnyWorld};
use boresight::study::{Study, StudyPipeline};
use contract::{ContractError, Pipeline, PipelineFactory};
use pyo3::prelude::*;

use crate::errors::BoresightError;
use crate::json::text_to_python;
use crate::python_pipeline::{PythonPipeline, RunningPipeline, check, name};
use crate::wait::Interruption;
use crate::worlds::{PythonFactory, PythonInterface, factory};

/// Callable of (frame, telemetry), or a class of such callables with one instance per case.
pub(crate) struct PythonStudyPipeline {
    name: String,
    given: Py<PyAny>,
    /// SHA-256 of the name and the source of the callable.
    hash: [u8; 32],
    ended: Arc<Interruption>,
}

impl PythonStudyPipeline {
    /// Creates a pipeline for the cases of a study; an exception that it raises and that is no `Exception`
    /// sets `ended`.
    pub(crate) fn new(given: &Bound<'_, PyAny>, ended: &Arc<Interruption>) -> PyResult<Self> {
        check(given)?;
        let hash =
            given.py().import("boresight._values")?.call_method1("callable_hash", (given,))?.extract()?;
        Ok(Self { name: name(given), given: given.clone().unbind(), hash, ended: Arc::clone(ended) })
    }

    fn clone_for_thread(&self) -> Self {
        let given = Python::attach(|py| self.given.clone_ref(py));
        Self { name: self.name.clone(), given, hash: self.hash, ended: Arc::clone(&self.ended) }
    }

    /// Creates the pipeline of a case, with the setup from the greeting of the protocol.
    fn build_for_case(
        &self,
        greeting: impl FnOnce() -> Result<Vec<u8>, String>,
    ) -> Result<PythonPipeline, ContractError> {
        let made = Python::attach(|py| {
            let setup = || {
                let line = greeting().map_err(BoresightError::new_err)?;
                text_to_python(py, &String::from_utf8_lossy(&line))
            };
            PythonPipeline::for_case(self.given.bind(py), setup, &self.ended)
        });
        made.map_err(|error| ContractError::CannotBuild {
            pipeline: self.name.clone(),
            reason: error.to_string(),
        })
    }
}

impl StudyPipeline for PythonStudyPipeline {
    fn check(&self, _: &AnyScenario) -> Result<(), Failure> {
        Ok(())
    }

    fn hash(&self, _: &dyn AnyWorld) -> Option<[u8; 32]> {
        Some(self.hash)
    }

    fn replay(&self, study: &Study, path: &Path, case: u64) -> String {
        let range = study.file.frames.as_ref().and_then(|frames| frames.split_once(".."));
        let frames = range.map(|(from, to)| format!(", frames=range({}, {})", from.trim(), to.trim()));
        format!(
            "boresight.run(boresight.Scenario.from_case({:?}, {case}){}, pipeline={})",
            path.display().to_string(),
            frames.unwrap_or_default(),
            self.name
        )
    }

    fn factory(&self, scenario: &AnyScenario, _: &Path) -> Result<AnyFactory, Failure> {
        factory(scenario.world(), self.clone_for_thread())
    }
}

impl PythonFactory for PythonStudyPipeline {
    fn into_factory<I: PythonInterface>(self) -> Box<dyn PipelineFactory<I> + Send> {
        Box::new(self)
    }
}

impl<I: PythonInterface> PipelineFactory<I> for PythonStudyPipeline {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn build(&self, setup: &I::Setup) -> Result<Box<dyn Pipeline<I>>, ContractError> {
        let callable = self.build_for_case(|| I::greeting(setup))?;
        Ok(Box::new(RunningPipeline::<I> { callable, setup: setup.clone() }))
    }
}
