//! Pipeline written in Python. Its exceptions become outcomes that carry their message, like the faults of an
//! external program (`pipeline::external`), and its answers are parsed by the same code.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use contract::{ContractError, Pipeline, PipelineFactory};
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::errors::refused;
use crate::prepared_scenario::PreparedScenario;
use crate::scenario::setup;
use crate::wait::Interruption;
use crate::worlds::{PythonFactory, PythonInterface};

/// Maximum length of an exception's reason, characters: the reason appears in a table.
const REASON: usize = 400;

/// Callable of (frame, telemetry), ready to be called.
pub(crate) struct PythonPipeline {
    name: String,
    /// The callable, or the reason why its class could not be instantiated.
    callable: Result<Py<PyAny>, String>,
    /// Function that converts the callable's return value to a line of the protocol.
    line: Py<PyAny>,
    ended: Arc<Interruption>,
}

impl PythonPipeline {
    /// Creates a pipeline from a callable, or from a class, which is instantiated with the setup. An
    /// exception raised by the class is returned to the caller.
    pub(crate) fn new(
        given: &Bound<'_, PyAny>,
        prepared: &PreparedScenario,
        ended: &Arc<Interruption>,
    ) -> PyResult<Self> {
        let py = given.py();
        check(given)?;
        let callable = if is_class(given) { given.call1((setup(py, prepared)?,))? } else { given.clone() };
        if !callable.is_callable() {
            return Err(refused_kind(&callable)?);
        }
        Self::from_callable(given, Ok(callable.unbind()), ended)
    }

    /// Creates the pipeline of one case of a study, from a callable that all cases share, or from a class,
    /// which is instantiated with the case's setup. An exception raised by the class becomes the outcome of
    /// every frame of the case.
    pub(crate) fn for_case<'py>(
        given: &Bound<'py, PyAny>,
        setup: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
        ended: &Arc<Interruption>,
    ) -> PyResult<Self> {
        let made =
            if is_class(given) { setup().and_then(|setup| given.call1((setup,))) } else { Ok(given.clone()) };
        let callable =
            made.and_then(|made| if made.is_callable() { Ok(made) } else { Err(refused_kind(&made)?) });
        let callable = callable.map(Bound::unbind).map_err(|error| reason(given.py(), error, ended));
        Self::from_callable(given, callable, ended)
    }

    /// Creates a pipeline from a callable, or from the reason why there is none.
    fn from_callable(
        given: &Bound<'_, PyAny>,
        callable: Result<Py<PyAny>, String>,
        ended: &Arc<Interruption>,
    ) -> PyResult<Self> {
        let line = given.py().import("boresight._values")?.getattr("answer_line")?.unbind();
        Ok(Self { name: name(given), callable, line, ended: Arc::clone(ended) })
    }

    fn clone_for_thread(&self, py: Python<'_>) -> Self {
        Self {
            name: self.name.clone(),
            callable: self.callable.as_ref().map(|callable| callable.clone_ref(py)).map_err(Clone::clone),
            line: self.line.clone_ref(py),
            ended: Arc::clone(&self.ended),
        }
    }

    /// Calls the pipeline and returns its answer as a line of the protocol, or the reason why there is none;
    /// `key` names the unit that `number` counts.
    fn call(
        &self,
        (key, number): (&str, u64),
        question: impl FnOnce(Python<'_>) -> PyResult<(Py<PyAny>, Py<PyAny>)>,
    ) -> Result<String, String> {
        let callable = self.callable.as_ref().map_err(Clone::clone)?;
        if self.ended.flag().load(Ordering::Relaxed) {
            return Err("the run was interrupted".to_owned());
        }
        Python::attach(|py| {
            let asked = question(py).and_then(|(frame, telemetry)| callable.call1(py, (frame, telemetry)));
            let answer = asked.map_err(|error| reason(py, error, &self.ended))?;
            let line = self.line.call1(py, (answer, key, number)).and_then(|line| line.extract(py));
            line.map_err(|error| exception_text(&error))
        })
    }
}

/// Returns the reason for a missing answer, from the exception raised instead; an exception that is no
/// `Exception` also ends the work.
pub(crate) fn reason(py: Python<'_>, error: PyErr, ended: &Interruption) -> String {
    let reason = format!("{}{}", exception_text(&error), traceback_location(py, &error));
    if !error.is_instance_of::<PyException>(py) {
        ended.set(error);
    }
    reason
}

/// Message of an exception, cut to the maximum length.
fn exception_text(error: &PyErr) -> String {
    let text = error.to_string();
    match text.char_indices().nth(REASON).and_then(|(end, _)| text.get(..end)) {
        Some(beginning) => format!("{beginning}…"),
        None => text,
    }
}

/// Location where an exception was raised, as a suffix to its message.
fn traceback_location(py: Python<'_>, error: &PyErr) -> String {
    let mut traceback_location = String::new();
    let mut step = error.traceback(py).map(Bound::into_any);
    while let Some(at) = step {
        let line = at.getattr("tb_lineno").map(|line| line.to_string()).unwrap_or_default();
        let file = at.getattr("tb_frame").and_then(|frame| frame.getattr("f_code")?.getattr("co_filename"));
        traceback_location = file.map_or_else(|_| String::new(), |file| format!(" ({file}, line {line})"));
        step = at.getattr("tb_next").ok().filter(|next| !next.is_none());
    }
    traceback_location
}

/// Refuses a value that is no pipeline.
pub(crate) fn check(given: &Bound<'_, PyAny>) -> PyResult<()> {
    if given.is_callable() { Ok(()) } else { Err(refused_kind(given)?) }
}

fn refused_kind(given: &Bound<'_, PyAny>) -> PyResult<PyErr> {
    let kind = given.get_type().name()?;
    let expected = "None, the name of a built-in pipeline, `exec:COMMAND`, a callable of (frame, \
                    telemetry), or a class whose instances are such callables";
    Ok(refused("pipeline", format!("of type {kind}"), expected))
}

/// Returns true if the value is a class, from which a pipeline is made, rather than a pipeline.
pub(crate) fn is_class(given: &Bound<'_, PyAny>) -> bool {
    given.is_instance_of::<PyType>()
}

/// Name of a callable or a class.
pub(crate) fn name(given: &Bound<'_, PyAny>) -> String {
    given.getattr("__name__").and_then(|name| name.extract()).unwrap_or_else(|_| "python".to_owned())
}

impl PythonFactory for PythonPipeline {
    fn into_factory<I: PythonInterface>(self) -> Box<dyn PipelineFactory<I> + Send> {
        Box::new(self)
    }
}

impl<I: PythonInterface> PipelineFactory<I> for PythonPipeline {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn build(&self, setup: &I::Setup) -> Result<Box<dyn Pipeline<I>>, ContractError> {
        Ok(Box::new(RunningPipeline::<I> {
            callable: Python::attach(|py| self.clone_for_thread(py)),
            setup: setup.clone(),
        }))
    }
}

/// Callable that processes one sequence.
pub(crate) struct RunningPipeline<I: PythonInterface> {
    pub(crate) callable: PythonPipeline,
    pub(crate) setup: I::Setup,
}

impl<I: PythonInterface> Pipeline<I> for RunningPipeline<I> {
    fn process(&mut self, image: &I::Image, telemetry: &I::Telemetry) -> I::Outcome {
        let number = I::number(image);
        let question = |py: Python<'_>| {
            let frame = Py::new(py, I::frame(py, image.clone())?)?.into_any();
            Ok((frame, I::telemetry(py, telemetry)?))
        };
        let answer = self.callable.call((I::IMAGE, number), question);
        let outcome = answer.and_then(|line| I::outcome(line.as_bytes(), number, &self.setup));
        outcome.unwrap_or_else(I::failed)
    }
}
