//! The worlds with reports of their own. A run of another world has its figures and verdicts.

use std::path::Path;

use files::Failure;
use run::{AnyJudgement, DockingMission, FarRangeMission, World};

use crate::page::Page;
use crate::page::picture::RenderedPictures;
use crate::{docking, far_range};

/// What the report of a world has of its own.
pub(crate) struct WorldReport {
    code: &'static str,
    /// Makes the page of a run directory and checks that what it read is what was written; of a run of this process from its verdicts, which it may take.
    pub(crate) page: fn(&Path, Option<&mut dyn AnyJudgement>) -> Result<Page, Failure>,
    /// Renders frames of a run directory anew.
    pub(crate) pictures: fn(&Path, &[u64]) -> Result<RenderedPictures, Failure>,
}

/// One line each.
const WORLDS: [WorldReport; 2] = [
    WorldReport { code: FarRangeMission::CODE, page: far_range::page, pictures: far_range::pictures },
    WorldReport { code: DockingMission::CODE, page: docking::page, pictures: docking::pictures },
];

/// What the report of a world has of its own, by the world's word; `None` for a world that has nothing.
pub(crate) fn world_report(code: &str) -> Option<WorldReport> {
    WORLDS.into_iter().find(|world| world.code == code)
}
