//! The library `boresight._boresight`, which Python loads: scenarios, frames, runs, scores, studies and
//! visibility over the same engine as the command `boresight`, and pipelines written in Python.
//!
//! This crate computes nothing; it only converts values. Every number equals that of the command, bit for bit
//! (python/tests).

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]
#![allow(
    clippy::result_large_err,
    reason = "errors of the engine are large, and at most one is created per call"
)]

mod arguments;
mod arrow;
mod command;
mod errors;
mod frame;
mod json;
mod navigation;
mod prepared_scenario;
mod progress;
mod python_pipeline;
mod report;
mod run;
mod scenario;
mod score;
mod simulated_frame;
mod stream;
mod study;
mod study_pipeline;
mod table;
mod visibility;
mod wait;
mod worlds;

/// Scenarios, frames, runs, scores, studies and visibility, over the engine of the command `boresight`.
#[pyo3::pymodule]
mod _boresight {
    #[pymodule_export]
    use crate::command::command;
    #[pymodule_export]
    use crate::frame::{FieldTelemetry, Frame, Telemetry};
    #[pymodule_export]
    use crate::navigation::{Navigation, navigate};
    #[pymodule_export]
    use crate::report::report;
    #[pymodule_export]
    use crate::run::{Run, run};
    #[pymodule_export]
    use crate::scenario::Scenario;
    #[pymodule_export]
    use crate::score::score;
    #[pymodule_export]
    use crate::simulated_frame::SimulatedFrame;
    #[pymodule_export]
    use crate::stream::FrameStream;
    #[pymodule_export]
    use crate::study::{StudyResult, study};
    #[pymodule_export]
    use crate::table::Table;
    #[pymodule_export]
    use crate::visibility::{requirement_names, visibility};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn with_version_and_worlds(module: &Bound<'_, PyModule>) -> PyResult<()> {
        boresight::register_worlds();
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
