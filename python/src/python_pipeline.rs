//! A pipeline that is written in Python. Its exceptions are outcomes with their message, as the faults of a program are
//! (`pipeline::external`), and its answers are read by the same code.

use std::sync::{Arc, Mutex, PoisonError};

use boresight::failure::Failure;
use contract::docking::{
    DockingOutcome, DockingPipeline, DockingPipelineFactory, DockingSetup, Field, FieldTelemetry as OfField,
    NoPose,
};
use contract::{ContractError, NoSolution, Outcome, Pipeline, PipelineFactory, Setup, Telemetry as OfFrame};
use pipeline::external::{docking_protocol, protocol};
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::errors::refused;
use crate::frame::{FieldTelemetry, Frame, Telemetry};
use crate::scenario::{Ready, World, setup};

/// Longest reason of an exception, in characters: it stands in a table.
const REASON: usize = 400;

/// Why a run is to end although all is well with it: Ctrl-C, or an exception like it.
#[derive(Default)]
pub(crate) struct Ended(Mutex<Option<PyErr>>);

impl Ended {
    fn set(&self, error: PyErr) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    /// The exception that ended the run.
    pub(crate) fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Whether the run may go on; hears of Ctrl-C.
    pub(crate) fn go_on(&self) -> Result<(), Failure> {
        if self.0.lock().unwrap_or_else(PoisonError::into_inner).is_some() {
            return Err(Failure::Interrupted);
        }
        Python::attach(|py| py.check_signals()).map_err(|error| {
            self.set(error);
            Failure::Interrupted
        })
    }
}

/// A callable of (frame, telemetry), ready to be asked.
pub(crate) struct PythonPipeline {
    name: String,
    callable: Py<PyAny>,
    /// Turns what it returns into a line of the protocol.
    line: Py<PyAny>,
    /// Columns and rows.
    size_px: (usize, usize),
    ended: Arc<Ended>,
}

impl PythonPipeline {
    /// A pipeline of a callable, or of a class, which is made with the setup. What a class raises when it is made is the caller's.
    pub(crate) fn new(given: &Bound<'_, PyAny>, ready: &Ready, ended: &Arc<Ended>) -> PyResult<Self> {
        let py = given.py();
        let callable =
            if given.is_instance_of::<PyType>() { given.call1((setup(py, ready)?,))? } else { given.clone() };
        if !callable.is_callable() {
            let kind = callable.get_type().name()?;
            let expected = "None, the name of a built-in pipeline, `exec:COMMAND`, a callable of (frame, telemetry), or a class whose \
                            instances are one";
            return Err(refused("pipeline", format!("of type {kind}"), expected));
        }
        let size_px = match &ready.world {
            World::FarRange(prepared) => {
                (prepared.scenario().camera.columns, prepared.scenario().camera.rows)
            }
            World::Docking(_) => (0, 0),
        };
        let name =
            given.getattr("__name__").and_then(|name| name.extract()).unwrap_or_else(|_| "python".to_owned());
        let line = py.import("boresight._values")?.getattr("answer_line")?.unbind();
        Ok(Self { name, callable: callable.unbind(), line, size_px, ended: Arc::clone(ended) })
    }

    fn again(&self, py: Python<'_>) -> Self {
        Self {
            name: self.name.clone(),
            callable: self.callable.clone_ref(py),
            line: self.line.clone_ref(py),
            size_px: self.size_px,
            ended: Arc::clone(&self.ended),
        }
    }

    /// The answer to a question as a line of the protocol, or why there is none; `key` says what `number` counts.
    fn ask(
        &self,
        (key, number): (&str, u64),
        question: impl FnOnce(Python<'_>) -> PyResult<(Py<PyAny>, Py<PyAny>)>,
    ) -> Result<String, String> {
        Python::attach(|py| {
            let asked =
                question(py).and_then(|(frame, telemetry)| self.callable.call1(py, (frame, telemetry)));
            let answer = asked.map_err(|error| {
                let reason = format!("{}{}", said(&error), place(py, &error));
                if !error.is_instance_of::<PyException>(py) {
                    self.ended.set(error);
                }
                reason
            })?;
            let line = self.line.call1(py, (answer, key, number)).and_then(|line| line.extract(py));
            line.map_err(|error| said(&error))
        })
    }
}

/// The beginning of what an exception says.
fn said(error: &PyErr) -> String {
    let text = error.to_string();
    match text.char_indices().nth(REASON) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// Where an exception was raised, as it follows on what it says.
fn place(py: Python<'_>, error: &PyErr) -> String {
    let mut place = String::new();
    let mut step = error.traceback(py).map(Bound::into_any);
    while let Some(at) = step {
        let line = at.getattr("tb_lineno").map(|line| line.to_string()).unwrap_or_default();
        let file = at.getattr("tb_frame").and_then(|frame| frame.getattr("f_code")?.getattr("co_filename"));
        place = file.map_or_else(|_| String::new(), |file| format!(" ({file}, line {line})"));
        step = at.getattr("tb_next").ok().filter(|next| !next.is_none());
    }
    place
}

impl PipelineFactory for PythonPipeline {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn build(&self, _: &Setup) -> Result<Box<dyn Pipeline>, ContractError> {
        Ok(Box::new(Python::attach(|py| self.again(py))))
    }
}

impl Pipeline for PythonPipeline {
    fn process(&mut self, frame: &contract::Frame, telemetry: &OfFrame) -> Outcome {
        let number = frame.number();
        let answer = self.ask(("frame", number), |py| {
            let frame = Py::new(py, Frame::of(py, frame.clone())?)?.into_any();
            Ok((frame, Py::new(py, Telemetry::of(telemetry))?.into_any()))
        });
        let outcome = answer.and_then(|line| protocol::outcome(line.as_bytes(), number, self.size_px));
        outcome.unwrap_or_else(|reason| Outcome::none(NoSolution::Failed(reason)))
    }
}

impl DockingPipelineFactory for PythonPipeline {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn build(&self, _: &DockingSetup) -> Result<Box<dyn DockingPipeline>, ContractError> {
        Ok(Box::new(Python::attach(|py| self.again(py))))
    }
}

impl DockingPipeline for PythonPipeline {
    fn process(&mut self, field: &Field, telemetry: &OfField) -> DockingOutcome {
        let number = field.number();
        let answer = self.ask(("field", number), |py| {
            let frame = Py::new(py, Frame::of_field(py, field.clone())?)?.into_any();
            Ok((frame, Py::new(py, FieldTelemetry::of(telemetry))?.into_any()))
        });
        let outcome = answer.and_then(|line| docking_protocol::outcome(line.as_bytes(), number));
        outcome.unwrap_or_else(|reason| DockingOutcome::none(NoPose::Failed(reason)))
    }
}
