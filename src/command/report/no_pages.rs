//! Stand-ins for `pages.rs` in a build without the feature `report`.
use std::path::{Path, PathBuf};

use files::Failure;
use gate::GateReport;
use run::AnyJudgement;

use super::Headings;
use crate::command::missing_feature;
use crate::command::output::Output;

pub(super) fn write_report(_: &Path, _: &[PathBuf], _: &Path, _: &Output) -> Result<u64, Failure> {
    Err(missing_feature("report"))
}

pub(super) fn write_report_on_measurements(_: &Path, _: &Path, _: &Path) -> Result<u64, Failure> {
    Err(missing_feature("report"))
}

/// Reports that this build cannot write reports.
///
/// # Errors
/// Always.
pub fn write_page_of(_: &Path, _: Option<&Path>, _: &Path) -> Result<(), Failure> {
    Err(missing_feature("report"))
}

pub(super) fn check_path(_: &Path) -> Result<(), Failure> {
    Err(missing_feature("report"))
}

pub(in crate::command) fn write_beside_run(_: &Path, _: &mut dyn AnyJudgement, _: Headings, output: &Output) {
    note(output);
}

pub(in crate::command) fn write_beside_results(_: &Path, output: &Output) {
    note(output);
}

pub(in crate::command) fn write_gate(_: &GateReport, _: &Path, _: &Path) -> Result<(), Failure> {
    Err(missing_feature("report"))
}

fn note(output: &Output) {
    output.note(format!("the report was not written: {}", missing_feature("report")));
}
