//! Reports: one HTML file of a directory of results.

use std::path::PathBuf;

use boresight::command::write_page_of;
use pyo3::prelude::*;

use crate::arguments;
use crate::errors::raised;
use crate::run::Run;
use crate::study::StudyResult;

/// Writes the report of results as one HTML file, as the command `boresight report` does, and returns its
/// path.
///
/// `results` is a `Run`, a `StudyResult`, or the directory of a run, of a study, of a processed dataset or of
/// `boresight visibility --out`. `out` is the file, which replaces an earlier report and no other file;
/// default: `report.html` in the directory. `measurements` is a file of measurements on the frames of the
/// directory, in place of its `measurements.csv`; it needs `out`.
#[pyfunction]
#[pyo3(signature = (results, out=None, *, measurements=None))]
pub(crate) fn report(
    py: Python<'_>,
    results: &Bound<'_, PyAny>,
    out: Option<PathBuf>,
    measurements: Option<PathBuf>,
) -> PyResult<PathBuf> {
    let directory = if let Ok(run) = results.cast::<Run>() {
        run.get().path().to_owned()
    } else if let Ok(study) = results.cast::<StudyResult>() {
        study.get().path().to_owned()
    } else {
        PathBuf::from(arguments::word("results", results)?)
    };
    if measurements.is_some() && out.is_none() {
        return Err(crate::errors::refused(
            "out",
            "None".to_owned(),
            "a path, with measurements of another file",
        ));
    }
    let path = out.unwrap_or_else(|| directory.join("report.html"));
    py.detach(|| write_page_of(&directory, measurements.as_deref(), &path)).map_err(raised)?;
    Ok(path)
}
