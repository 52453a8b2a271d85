//! What a gate found.

pub(crate) mod junit;

use indexmap::IndexMap;
use serde::Serialize;

use crate::comparison::flips::Flips;
use crate::dependence::runs::LossRun;
use crate::identity::Pairing;

/// What is said of a figure, and of all of them together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FigureVerdict {
    /// It is worse, beyond chance and beyond its tolerance.
    Worse,
    /// The baseline has it and the result does not, in more blocks than chance would do: worse.
    Gone,
    /// Nothing says that it is worse.
    NoWorse,
    /// It is better, beyond chance and beyond its tolerance.
    Better,
    /// A figure with a best value differs from the baseline, beyond chance and beyond its tolerance, and is no farther from that value: a bias
    /// has another size or side.
    Changed,
    /// It has values in too few blocks to show anything, whatever they are.
    TooLittleData,
}

impl FigureVerdict {
    /// Whether the gate is shut by it.
    pub fn is_worse(self) -> bool {
        matches!(self, Self::Worse | Self::Gone)
    }

    /// As a person reads it.
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

/// One figure of baseline and result.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureReport {
    /// What is said of it.
    pub verdict: FigureVerdict,
    /// Which way is better: `more`, `less`, or `near X`.
    pub better: String,
    /// The value in the baseline; null when it is counted over nothing.
    pub baseline: Option<f64>,
    /// What it is counted over there.
    pub baseline_of: u64,
    /// The value in the result.
    pub result: Option<f64>,
    /// What it is counted over there.
    pub result_of: u64,
    /// Result minus baseline.
    pub difference: Option<f64>,
    /// Lower limit of the difference's interval of 95 %.
    pub low: Option<f64>,
    /// Upper limit.
    pub high: Option<f64>,
    /// By how much the result is worse; negative where it is better. Of what is best near a value it is the growth of the distance from it.
    pub worse_by: Option<f64>,
    /// By how much it may be worse and pass.
    pub tolerance: f64,
    /// Probability of as large a worsening if there is none, of this figure alone.
    pub p: f64,
    /// The same, adjusted for all figures together: worse when at most alpha.
    pub adjusted_p: f64,
    /// The same for an improvement.
    pub better_adjusted_p: f64,
    /// A worsening of this size is seen with a probability of 95 %, or more.
    pub smallest_visible: Option<f64>,
    /// Blocks in which it has a value.
    pub blocks: u64,
    /// Of a rate on the same frames: what was lost and won, and the longest run of losses.
    pub loss_run: Option<LossRun>,
}

/// What a gate found: the document of `--json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GateReport {
    /// `worse` when any figure is, otherwise `changed` when any figure is, otherwise `no_worse`.
    pub verdict: FigureVerdict,
    /// Why a change passes, where it was accepted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accepted: Option<String>,
    /// Name of the scenario or study.
    pub name: String,
    /// `far_range` or `docking`.
    pub world: String,
    /// Why the baseline is one.
    pub reason: String,
    /// What the units are: `frames`, `fields` or `cases`.
    pub units: String,
    /// How many there are.
    pub count: u64,
    /// Whether frames or only blocks of them go together.
    pub pairing: Pairing,
    /// Seed of the baseline.
    pub baseline_seed: u64,
    /// Seed of the result.
    pub result_seed: u64,
    /// Version that made the baseline's run.
    pub baseline_version: String,
    /// Version that made the result.
    pub result_version: String,
    /// Probability of shutting the gate when no figure is worse.
    pub alpha: f64,
    /// Number of blocks.
    pub blocks: u64,
    /// Units of a block, in the mean.
    pub block_length: f64,
    /// The largest correlation of the effects of neighbouring blocks, of any figure. Blocks that are long enough have little.
    pub neighbour_correlation: f64,
    /// What a reader must know of how far to trust it.
    pub notes: Vec<String>,
    /// Figures by name.
    pub figures: IndexMap<String, FigureReport>,
    /// Units that changed; null where the frames are not the same.
    pub flips: Option<Flips>,
}

impl GateReport {
    /// Whether the gate is shut: a figure is worse, or one with a best value changed and that was not accepted.
    pub fn is_shut(&self) -> bool {
        match self.verdict {
            FigureVerdict::Changed => self.accepted.is_none(),
            verdict => verdict.is_worse(),
        }
    }

    /// Names of the figures that changed.
    pub fn changed_figures(&self) -> impl Iterator<Item = &str> {
        let changed = self.figures.iter().filter(|(_, figure)| figure.verdict == FigureVerdict::Changed);
        changed.map(|(name, _)| name.as_str())
    }

    /// Names of the figures that are worse.
    pub fn worse_figures(&self) -> impl Iterator<Item = &str> {
        self.figures.iter().filter(|(_, figure)| figure.verdict.is_worse()).map(|(name, _)| name.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::report;

    #[test]
    fn the_gate_is_shut_by_what_is_worse_or_gone() {
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
