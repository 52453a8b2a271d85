//! Report of a gate.

pub(crate) mod junit;

use indexmap::IndexMap;
use serde::Serialize;

use crate::comparison::flips::Flips;
use crate::dependence::runs::LossRun;
use crate::identity::Pairing;

/// Verdict on one figure, or on all figures together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FigureVerdict {
    /// Worse, beyond chance and beyond the tolerance.
    Worse,
    /// Present in the baseline and absent from the result, in more blocks than by chance: counts as worse.
    Gone,
    /// There is no evidence that the figure is worse.
    NoWorse,
    /// Better, beyond chance and beyond the tolerance.
    Better,
    /// For a figure with a best value: different from the baseline, beyond chance and beyond the tolerance,
    /// but not farther from the best value. An example is a bias of another size or sign.
    Changed,
    /// Present in too few blocks for any significant result, regardless of the values.
    TooLittleData,
}

impl FigureVerdict {
    /// Returns true if this verdict makes the gate fail.
    pub fn is_worse(self) -> bool {
        matches!(self, Self::Worse | Self::Gone)
    }

    /// Returns the verdict as text for the user.
    pub fn words(self) -> &'static str {
        match self {
            Self::Worse => "worse",
            Self::Gone => "gone",
            Self::NoWorse => "no worse",
            Self::Better => "better",
            Self::Changed => "changed",
            Self::TooLittleData => "too little data",
        }
    }
}

/// One figure of a baseline and of a result.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureReport {
    /// Verdict on the figure.
    pub verdict: FigureVerdict,
    /// Direction that is better: `more`, `less`, or `near X`.
    pub better: String,
    /// Value in the baseline; null when its denominator is 0.
    pub baseline: Option<f64>,
    /// Denominator of the baseline's value.
    pub baseline_of: u64,
    /// Value in the result; null when its denominator is 0.
    pub result: Option<f64>,
    /// Denominator of the result's value.
    pub result_of: u64,
    /// Value of the result minus value of the baseline.
    pub difference: Option<f64>,
    /// Lower limit of the 95 % interval of the difference.
    pub low: Option<f64>,
    /// Upper limit of the 95 % interval of the difference.
    pub high: Option<f64>,
    /// Amount by which the result is worse; negative where it is better. For a figure with a best value:
    /// increase of the distance from that value.
    pub worse_by: Option<f64>,
    /// Amount by which the result may be worse and still pass.
    pub tolerance: f64,
    /// Probability of at least this worsening if there is none, for this figure considered separately.
    pub p: f64,
    /// Probability `p` adjusted for all figures together; the figure is worse when it is at most alpha.
    pub adjusted_p: f64,
    /// Smallest adjusted probability that any values in the blocks of this figure could have; above alpha,
    /// the figure has too little data.
    pub attainable_p: f64,
    /// Adjusted probability of at least this improvement if there is none.
    pub better_adjusted_p: f64,
    /// Smallest worsening that is detected with a probability of at least 95 %; null if none is, because of
    /// too little data.
    pub smallest_visible: Option<f64>,
    /// Number of blocks in which the figure has a value.
    pub blocks: u64,
    /// Lost and won units and the longest run of losses, for a rate on the same frames.
    pub loss_run: Option<LossRun>,
}

impl FigureReport {
    /// Returns true if the figure has values in both results, but in too few blocks to be found worse.
    pub(crate) fn is_out_of_reach(&self, alpha: f64) -> bool {
        self.difference.is_some() && self.verdict == FigureVerdict::TooLittleData && self.attainable_p > alpha
    }

    /// Returns the smallest number of blocks in which the figure could be found worse: each block halves the
    /// smallest p. `None` if the figure has no value.
    pub(crate) fn blocks_needed(&self, alpha: f64) -> Option<u64> {
        self.difference?;
        let sides = if self.better.starts_with("near") { 2.0 } else { 1.0 };
        Some(libm::ceil(libm::log2(sides / alpha) - 1e-9) as u64)
    }
}

/// Report of a gate: the document of `--json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GateReport {
    /// `worse` when any figure is worse, otherwise `changed` when any figure changed, otherwise `no_worse`.
    pub verdict: FigureVerdict,
    /// Reason for accepting a change; absent if none was accepted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accepted: Option<String>,
    /// Name of the scenario or study.
    pub name: String,
    /// `far_range` or `docking`.
    pub world: String,
    /// Reason why this result became the baseline.
    pub reason: String,
    /// Name of the units: `frames`, `fields` or `cases`.
    pub units: String,
    /// Number of units.
    pub count: u64,
    /// Pairing: by frames, or only by blocks of frames.
    pub pairing: Pairing,
    /// Seed of the baseline.
    pub baseline_seed: u64,
    /// Seed of the result.
    pub result_seed: u64,
    /// Version of Boresight that made the baseline's run.
    pub baseline_version: String,
    /// Version of Boresight that made the result.
    pub result_version: String,
    /// Probability that the gate fails when no figure is worse.
    pub alpha: f64,
    /// Number of blocks.
    pub blocks: u64,
    /// Mean number of units per block.
    pub block_length: f64,
    /// Largest correlation, over all figures, between the effects of neighbouring blocks. It is small for
    /// blocks that are long enough.
    pub neighbour_correlation: f64,
    /// Notes on the limits of the comparison.
    pub notes: Vec<String>,
    /// Figures, keyed by name.
    pub figures: IndexMap<String, FigureReport>,
    /// Units that changed; null if the frames differ.
    pub flips: Option<Flips>,
}

impl GateReport {
    /// Returns true if the gate fails: a figure is worse, or a figure with a best value changed and the
    /// change was not accepted.
    pub fn is_shut(&self) -> bool {
        match self.verdict {
            FigureVerdict::Changed => self.accepted.is_none(),
            verdict => verdict.is_worse(),
        }
    }

    /// Returns the names of the figures that changed.
    pub fn changed_figures(&self) -> impl Iterator<Item = &str> {
        let changed = self.figures.iter().filter(|(_, figure)| figure.verdict == FigureVerdict::Changed);
        changed.map(|(name, _)| name.as_str())
    }

    /// Returns the names of the figures that are worse.
    pub fn worse_figures(&self) -> impl Iterator<Item = &str> {
        self.figures.iter().filter(|(_, figure)| figure.verdict.is_worse()).map(|(name, _)| name.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::report;

    #[test]
    fn the_gate_fails_on_worse_or_missing_figures() {
        let all = [
            (FigureVerdict::Worse, "worse", true),
            (FigureVerdict::Gone, "gone", true),
            (FigureVerdict::NoWorse, "no worse", false),
            (FigureVerdict::Better, "better", false),
            (FigureVerdict::Changed, "changed", false),
            (FigureVerdict::TooLittleData, "too little data", false),
        ];
        for (verdict, words, is_worse) in all {
            assert_eq!((verdict.words(), verdict.is_worse()), (words, is_worse));
        }
        let mut report = report(&all.map(|(verdict, name, _)| (name, verdict)));
        assert!(report.is_shut());
        report.verdict = FigureVerdict::Changed;
        assert!(report.is_shut() && report.changed_figures().eq(["changed"]));
        report.accepted = Some("a new centroider".to_owned());
        assert!(!report.is_shut());
        assert_eq!(report.worse_figures().collect::<Vec<_>>(), ["worse", "gone"]);
    }
}
