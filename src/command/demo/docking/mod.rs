//! Docking half of the demo: the best estimator of the pose, and the formulas of the paper.

#[cfg(feature = "report")]
mod section;

use std::path::{Path, PathBuf};

use docking::rows::FieldTruthRow;
use docking::scoring::{DockingScore, names};
use files::{Failure, TableReader};
use indexmap::IndexMap;
use run::ScenarioSource;
use score::Figure;
use serde_json::{Value, json};
use sim::docking::FieldTruth;

use super::part::Part;
use super::{percent_or_dash, root_sum_square, value};
use crate::command::output::Output;

/// Built-in scenario of the demo.
const SCENARIO: &str = "demo-docking";
/// Millimetres per metre.
const MM_PER_M: f64 = 1000.0;

/// An estimator of the pose: its name on the page, and the prefix of its figures.
struct Estimator {
    name: &'static str,
    prefix: &'static str,
}

/// Both estimators, which every field has.
const ESTIMATORS: [Estimator; 2] = [
    Estimator { name: "best method (the default)", prefix: "" },
    Estimator { name: "formulas of the paper", prefix: names::PAPER },
];

/// Results of the docking run.
pub(super) struct DockingResults {
    #[cfg_attr(not(feature = "report"), expect(dead_code, reason = "only the page leads to the directory"))]
    directory: PathBuf,
    score: DockingScore,
    /// Nearest and farthest range of the target, m.
    range_m: [f64; 2],
}

impl DockingResults {
    /// Runs the scenario.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    pub(super) fn run(parent: &Path, jobs: usize, output: &Output) -> Result<Self, Failure> {
        let source = ScenarioSource::read(SCENARIO)?;
        let finished = Part { folder: "docking", source }.run(parent, jobs, output)?;
        let score = serde_json::from_str(&finished.score)
            .map_err(|error| Failure::Usage(format!("the score of the demo cannot be read: {error}")))?;
        let range_m = range_m(&finished.directory.join("truth/fields.parquet"))?;
        Ok(Self { directory: finished.directory, score, range_m })
    }

    /// Returns the summary for a terminal.
    pub(super) fn text(&self) -> String {
        let [nearest, farthest] = self.range_m;
        let mut text = format!(
            "Docking: {} simulated television fields, with a docking target {farthest:.0} to {nearest:.0} m \
             ahead\n{:27}{:>9}   RMS error of its position and of its attitude\n",
            self.score.frames, "", "correct"
        );
        for estimator in &ESTIMATORS {
            let figures = &self.score.figures;
            let correct = value(figures, &estimator.key(names::SUCCESS_RATE));
            text += &format!(
                "  {:25}{:>9}   {}\n",
                estimator.name,
                percent_or_dash(correct),
                estimator.errors(figures)
            );
        }
        text
    }

    /// Returns the figures of the run.
    pub(super) fn document(&self) -> Value {
        json!({ "fields": self.score.frames, "figures": self.score.figures })
    }
}

impl Estimator {
    /// Returns the key of a figure of this estimator.
    fn key(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    /// Returns the root mean square of the distance between measured and true position, mm.
    fn position_rms_mm(&self, figures: &IndexMap<String, Figure>) -> Option<f64> {
        let parts = [self.key(names::LATERAL_RMS_M), self.key(names::RANGE_RMS_M)];
        let metres = root_sum_square(figures, [&parts[0], &parts[1]])?;
        Some(metres * MM_PER_M)
    }

    /// Formats the errors of position and attitude.
    fn errors(&self, figures: &IndexMap<String, Figure>) -> String {
        let attitude_deg = value(figures, &self.key(names::ATTITUDE_RMS_DEG));
        match (self.position_rms_mm(figures), attitude_deg) {
            (Some(position_mm), Some(attitude_deg)) => format!("{position_mm:.1} mm, {attitude_deg:.3}°"),
            _ => "–".to_owned(),
        }
    }
}

/// Returns the nearest and the farthest range of the target in a table of the truth, m.
fn range_m(table: &Path) -> Result<[f64; 2], Failure> {
    let mut ends = [f64::INFINITY, 0.0_f64];
    for group in TableReader::<FieldTruthRow>::open(table)? {
        for row in group?.1 {
            let truth = FieldTruth::from(row);
            ends = [ends[0].min(truth.range_m), ends[1].max(truth.range_m)];
        }
    }
    Ok(ends)
}
