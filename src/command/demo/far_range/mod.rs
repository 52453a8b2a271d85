//! Far-range half of the demo: the same images by the best method and by the method of the paper of 2012.

#[cfg(feature = "report")]
mod section;

use std::path::{Path, PathBuf};

use far_range::FarRangeScenario;
use far_range::rows::FrameTruthRow;
use far_range::scoring::{Score, names};
use files::{Failure, TableReader};
use indexmap::IndexMap;
use pipeline::far_range::Mode;
use run::ScenarioSource;
use score::Figure;
use serde_json::{Value, json};

use super::part::{FinishedPart, Part};
use super::{percent_or_dash, root_sum_square, value};
use crate::command::output::Output;

/// Built-in scenario of the demo.
const SCENARIO: &str = "demo-far-range";
/// Name of the best method in the summary and on the page.
const BEST: &str = "best method (the default)";
/// Name of the paper's method in the summary and on the page.
const PAPER: &str = "method of the 2012 paper";
/// Arcseconds per degree.
const ARCSEC_PER_DEG: f64 = 3600.0;

/// Results of both methods on the same images.
pub(super) struct FarRangeResults {
    best: MethodResult,
    paper: MethodResult,
    /// Nearest and farthest range of the target, km.
    range_km: [f64; 2],
}

/// Result of one method.
struct MethodResult {
    name: &'static str,
    #[cfg_attr(not(feature = "report"), expect(dead_code, reason = "only the page leads to the directory"))]
    directory: PathBuf,
    score: Score,
}

impl FarRangeResults {
    /// Runs both methods.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be written.
    pub(super) fn run(parent: &Path, jobs: usize, output: &Output) -> Result<Self, Failure> {
        let best = part("far-range", Mode::Best)?.run(parent, jobs, output)?;
        let paper = part("far-range-2012", Mode::Paper)?.run(parent, jobs, output)?;
        Ok(Self {
            range_km: range_km(&best.directory.join("truth/frames.parquet"))?,
            best: MethodResult::new(BEST, best)?,
            paper: MethodResult::new(PAPER, paper)?,
        })
    }

    /// Returns the summary for a terminal.
    pub(super) fn text(&self) -> String {
        let [nearest, farthest] = self.range_km;
        let mut text = format!(
            "Far range: {} simulated images of a star camera, with a spacecraft {farthest:.0} to {nearest:.0} \
             km ahead\n{:27}{:>9}{:>9}{:>9}   RMS error of its direction\n",
            self.best.score.frames, "", "correct", "wrong", "missed"
        );
        for method in [&self.best, &self.paper] {
            let rate = |name| percent_or_dash(value(&method.score.figures, name));
            text += &format!(
                "  {:25}{:>9}{:>9}{:>9}   {}\n",
                method.name,
                rate(names::CORRECT_RATE),
                rate(names::WRONG_RATE),
                rate(names::MISS_RATE),
                direction_error(&method.score.figures)
            );
        }
        text
    }

    /// Returns the figures of both methods.
    pub(super) fn document(&self) -> Value {
        json!({
            "best": { "frames": self.best.score.frames, "figures": self.best.score.figures },
            "paper": { "frames": self.paper.score.frames, "figures": self.paper.score.figures },
        })
    }
}

impl MethodResult {
    fn new(name: &'static str, part: FinishedPart) -> Result<Self, Failure> {
        let score = serde_json::from_str(&part.score)
            .map_err(|error| Failure::Usage(format!("the score of the demo cannot be read: {error}")))?;
        Ok(Self { name, directory: part.directory, score })
    }
}

/// Returns the run of one method.
fn part(folder: &'static str, mode: Mode) -> Result<Part, Failure> {
    let mut source = ScenarioSource::read(SCENARIO)?;
    if let Some(scenario) = source.scenario.values_mut::<FarRangeScenario>() {
        scenario.far_range.mode = mode;
    }
    Ok(Part { folder, source })
}

/// Returns the nearest and the farthest range of the target in a table of the truth, km.
fn range_km(table: &Path) -> Result<[f64; 2], Failure> {
    let mut ends = [f64::INFINITY, 0.0_f64];
    for group in TableReader::<FrameTruthRow>::open(table)? {
        for row in group?.1 {
            ends = [ends[0].min(row.0.range_km), ends[1].max(row.0.range_km)];
        }
    }
    Ok(ends)
}

/// Returns the root mean square of the angle between measured and true direction, arcsec: √(RA² + Dec²).
fn direction_rms_arcsec(figures: &IndexMap<String, Figure>) -> Option<f64> {
    let degrees = root_sum_square(figures, [names::RA_RMS_DEG, names::DEC_RMS_DEG])?;
    Some(degrees * ARCSEC_PER_DEG)
}

/// Formats the error of the direction.
fn direction_error(figures: &IndexMap<String, Figure>) -> String {
    direction_rms_arcsec(figures).map_or_else(|| "–".to_owned(), |arcsec| format!("{arcsec:.0}″"))
}
