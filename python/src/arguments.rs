//! Arguments shared by several functions.

use std::ops::Range;
use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyRange;
use pyo3::types::PyRangeMethods;

use crate::errors::refused;

/// Reads a range of frames of a scenario with `count` frames; all frames if none is given.
pub(crate) fn frames(given: Option<&Bound<'_, PyAny>>, count: u64) -> PyResult<Range<u64>> {
    let Some(given) = given else { return Ok(0..count) };
    let expected =
        format!("a non-empty range of step 1 within range(0, {count}), such as range(0, {})", count.min(40));
    let refuse = || refused("frames", given.to_string(), &expected);
    let range = given.cast::<PyRange>().map_err(|_| refuse())?;
    let (start, stop) = (range.start()?, range.stop()?);
    let bounds = u64::try_from(start).ok().zip(u64::try_from(stop).ok());
    let bounds = bounds.filter(|(start, stop)| start < stop && *stop <= count);
    match (range.step()?, bounds) {
        (1, Some((start, stop))) => Ok(start..stop),
        _ => Err(refuse()),
    }
}

/// Reads a number of threads; one per core if none is given.
pub(crate) fn jobs(given: Option<i64>) -> PyResult<usize> {
    let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    match given {
        None => Ok(cores()),
        Some(jobs @ 1..=1024) => Ok(jobs as usize),
        Some(jobs) => Err(refused("jobs", jobs, "1 to 1024")),
    }
}

/// Reads an argument that is a path, or text that may be a path.
pub(crate) fn word(what: &str, given: &Bound<'_, PyAny>) -> PyResult<String> {
    let path: PathBuf = given.extract().map_err(|_| {
        let kind = given.get_type().name().map_or_else(|_| "?".to_owned(), |name| name.to_string());
        refused(what, format!("of type {kind}"), "text or a path")
    })?;
    path.into_os_string().into_string().map_err(|path| refused(what, format!("{path:?}"), "a path in UTF-8"))
}
