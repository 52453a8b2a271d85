//! Stand-in for `page.rs` in a build without the feature `report`.

use std::path::{Path, PathBuf};

use files::Failure;

use super::DemoResults;
use crate::command::missing_feature;
use crate::command::output::Output;

pub(super) fn write(_: &DemoResults, _: &Path, output: &Output) -> Result<Option<PathBuf>, Failure> {
    output.note(format!("no page was written: {}", missing_feature("report")));
    Ok(None)
}
