//! Section of the demo's page on docking.

use docking::scoring::DockingGroup;
use docking_views::report::findings;
use files::Failure;
use report::charts::chart::{BESIDE, Chart, MEASURED, axes, bars, rounded};
use report::page::data_table::DataTable;
use report::verdict::Finding;
use report::{Link, Section, pictures_of_run};

use super::{DockingResults, ESTIMATORS};

/// Fields that are shown: at the start, in the middle, and at the end through the wide lens.
const SHOWN_FIELDS: [u64; 3] = [0, 300, 600];
/// Number of fields below which a group is left out of the chart.
const FEW_FIELDS: u64 = 10;

impl DockingResults {
    /// Returns the properties of the run for the head of the page.
    pub(in crate::command::demo) fn facts(&self) -> Vec<(&'static str, String)> {
        let [nearest, farthest] = self.range_m;
        vec![
            ("Docking", format!("{} fields", self.score.frames)),
            ("Distance", format!("{farthest:.1} to {nearest:.1} m")),
        ]
    }

    /// Returns the findings on the run.
    pub(in crate::command::demo) fn findings(&self) -> Vec<Finding> {
        let of_part =
            |finding: Finding| Finding { subject: format!("docking, {}", finding.subject), ..finding };
        findings(&self.score).into_iter().map(of_part).collect()
    }

    /// Returns the section: errors of both estimators, fields, link.
    ///
    /// # Errors
    /// A [`Failure`] when a field cannot be drawn.
    pub(in crate::command::demo) fn section(&self) -> Result<Section, Failure> {
        let pictures = pictures_of_run(&self.directory, &SHOWN_FIELDS)?;
        Ok(Section::new("video", "Docking: a target on television")
            .text(
                "A television camera shows the cross and the disk of a docking target; noise, lost lines and \
                 overlays disturb the video. Position and attitude of the camera are measured in each field.",
            )
            .chart(self.errors_by_range())
            .text("Three of the fields, with the recognised features and the pose:")
            .pictures(pictures)
            .links(vec![Link::new("docking/report.html", "Report of the docking run")]))
    }

    /// Returns the chart of the errors of the position by range and lens.
    fn errors_by_range(&self) -> Chart {
        let is_shown = |group: &&DockingGroup| group.frames >= FEW_FIELDS;
        let groups = self.score.groups.iter().filter(|(_, group)| is_shown(group));
        let names: Vec<String> = groups.clone().map(|(name, _)| name.clone()).collect();
        let mut table = DataTable::new([vec!["method".to_owned()], names.clone()].concat());
        let mut traces = Vec::new();
        for (estimator, colour) in ESTIMATORS.iter().zip([MEASURED, BESIDE]) {
            let error_mm = |(_, group): (_, &DockingGroup)| estimator.position_rms_mm(&group.figures);
            let errors: Vec<f64> =
                groups.clone().map(|group| rounded(error_mm(group).unwrap_or(0.0), 3)).collect();
            let cells = errors.iter().map(|error| format!("{error:.2} mm")).collect();
            table.push([vec![estimator.name.to_owned()], cells].concat());
            traces.push(bars(estimator.name, &names, errors, colour));
        }
        let caption = "RMS error of the measured position, by range and field of view of the lens: the best \
            method, and beside it the formulas of the docking paper on the same fields, which neglect some terms \
            of the geometry.";
        Chart::new(caption, 340, table, traces, axes("range, lens", "error, mm"))
    }
}
