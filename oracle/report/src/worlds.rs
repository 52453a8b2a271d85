//! Worlds with a specific report. The report of any other world shows only figures and verdicts.

use std::path::Path;

use files::Failure;
use run::{AnyJudgement, DockingMission, FarRangeMission, World};

use crate::page::Page;
use crate::page::picture::RenderedPictures;
use crate::{docking, far_range};

/// World-specific parts of a report.
pub(crate) struct WorldReport {
    code: &'static str,
    /// Makes the page of a run directory and verifies the checksums of the files that it read. For a run of
    /// this process, the page uses the run's verdicts, which it may move out.
    pub(crate) page: fn(&Path, Option<&mut dyn AnyJudgement>) -> Result<Page, Failure>,
    /// Renders frames of a run directory anew.
    pub(crate) pictures: fn(&Path, &[u64]) -> Result<RenderedPictures, Failure>,
}

/// Worlds with a specific report, one line each.
const WORLDS: [WorldReport; 2] = [
    WorldReport { code: FarRangeMission::CODE, page: far_range::page, pictures: far_range::pictures },
    WorldReport { code: DockingMission::CODE, page: docking::page, pictures: docking::pictures },
];

/// Returns the world-specific parts of a report, by the code of the world; `None` for a world without any.
pub(crate) fn world_report(code: &str) -> Option<WorldReport> {
    WORLDS.into_iter().find(|world| world.code == code)
}
