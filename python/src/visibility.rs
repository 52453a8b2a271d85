//! Visibility: selection of the required camera.

use std::sync::Arc;

use boresight::failure::Failure;
use boresight::visibility::{BUILT_IN_REQUIREMENTS, Requirements, assess};
use pyo3::prelude::*;

use crate::arguments;
use crate::errors::{raised, refused};
use crate::json::text_to_python;
use crate::wait::{AfterCtrlC, interruptibly};

/// Names of the built-in requirement files.
#[pyfunction]
pub(crate) fn requirement_names() -> Vec<&'static str> {
    BUILT_IN_REQUIREMENTS.iter().map(|built_in| built_in.name).collect()
}

/// Returns the requirements that a camera meets, and the exposure (s), aperture (mm) or focal length (mm)
/// that would meet them, as the command `boresight visibility` does: the dictionary that it prints with
/// `--json` (docs/visibility.md).
///
/// `requirement` is the name of a built-in requirement file or the path of a requirement file; `frames` is
/// the number of frames simulated for each result, 0 (none) to 100000, instead of the file's number. `jobs`:
/// threads, 1 to 1024; default: all cores.
#[pyfunction]
#[pyo3(signature = (requirement, *, frames=None, jobs=None))]
pub(crate) fn visibility<'py>(
    py: Python<'py>,
    requirement: &Bound<'py, PyAny>,
    frames: Option<i64>,
    jobs: Option<i64>,
) -> PyResult<Bound<'py, PyAny>> {
    let word = arguments::word("requirement", requirement)?;
    let jobs = arguments::jobs(jobs)?;
    let mut requirements = Requirements::read(&word).map_err(raised)?;
    if let Some(frames) = frames {
        let allowed = u32::try_from(frames).ok().filter(|frames| *frames <= 100_000);
        requirements.file.confirm.frames = allowed.ok_or_else(|| refused("frames", frames, "0 to 100000"))?;
    }
    let report = interruptibly(
        py,
        AfterCtrlC::IsLeft,
        &Arc::default(),
        || Ok(()),
        move |_| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).build();
            let pool = pool.map_err(|error| Failure::Usage(format!("threads cannot be started: {error}")))?;
            let report = pool.install(|| assess(&requirements, |_| ()))?;
            serde_json::to_string(&report)
                .map_err(|error| Failure::Usage(format!("the report cannot be written as JSON: {error}")))
        },
    )?;
    text_to_python(py, &report)
}
