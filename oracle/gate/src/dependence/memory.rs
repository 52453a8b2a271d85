//! Memory of figures: their autocorrelation times.
use std::ops::Range;

use score::{FigureTerms, UnitTable, is_of_navigation};
use statistics::effective_size;

use super::blocks::{Blocks, sequences};
use super::influence::influence;
use crate::identity::SourceKind;

/// Longest autocorrelation time of a run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Memory {
    /// Longest autocorrelation time of the run's figures, units.
    pub(crate) units: f64,
    /// Figure with the longest autocorrelation time.
    pub(crate) figure: String,
}

/// Longest autocorrelation time of the thirds of blocks, in thirds, for which blocks may be exchanged. At
/// this time, with an exponential autocorrelation, the means of neighbouring blocks are correlated by 0.18.
/// With eight independent blocks, one figure in thirty appears to exceed it.
const MAX_THIRDS: f64 = 2.2;

/// Returns the autocorrelation time of a series over some of its sequences, units; at least 1.
fn autocorrelation_time(series: &[f64], sequences: &[Range<usize>]) -> f64 {
    let cut: Vec<Vec<f64>> = sequences.iter().map(|sequence| series[sequence.clone()].to_vec()).collect();
    let count: usize = cut.iter().map(Vec::len).sum();
    if count == 0 { 1.0 } else { count as f64 / effective_size(&cut) }
}

/// Returns the autocorrelation time of a figure of one run over its sequences, units; at least 1.
pub(crate) fn memory_of(figure: &FigureTerms, sequences: &[Range<usize>]) -> f64 {
    autocorrelation_time(&influence(figure), sequences)
}

/// Returns the longest autocorrelation time of the figures of a run, without those of its navigation: the
/// errors of an orbit are correlated over the whole run, and would leave few blocks to all other figures.
pub(crate) fn memory(kind: SourceKind, world: &str, table: &UnitTable) -> Memory {
    let sequences = sequences(kind, world, table);
    let of_frames =
        table.figures.iter().filter(|figure| !is_of_navigation(&figure.name) || kind == SourceKind::Study);
    let of_figures = of_frames.map(|figure| (memory_of(figure, &sequences), &figure.name));
    of_figures.fold(Memory { units: 1.0, figure: String::new() }, |longest, (units, figure)| {
        if units > longest.units { Memory { units, figure: figure.clone() } } else { longest }
    })
}

/// Thirds of the blocks in every sequence that is cut into several blocks. A sequence that is a single block
/// may have any autocorrelation time.
pub(crate) struct Thirds {
    sequences: Vec<Vec<Range<usize>>>,
}

impl Thirds {
    pub(crate) fn from_table(kind: SourceKind, world: &str, table: &UnitTable, blocks: &Blocks) -> Self {
        let thirds_of = |sequence: Range<usize>| {
            let units: Vec<usize> = sequence.collect();
            let of_blocks: Vec<&[usize]> =
                units.chunk_by(|a, b| blocks.block_of(*a) == blocks.block_of(*b)).collect();
            let is_cut = of_blocks.len() > 1;
            let thirds = of_blocks.into_iter().flat_map(|block| {
                let (begin, count) = (block[0], block.len());
                let at = move |third: usize| begin + third * count / 3;
                (0..3).map(move |third| at(third)..at(third + 1)).filter(|third| !third.is_empty())
            });
            is_cut.then(|| thirds.collect())
        };
        Self { sequences: sequences(kind, world, table).into_iter().filter_map(thirds_of).collect() }
    }

    /// Returns true if the difference of a figure between two runs of other frames is correlated over too
    /// many thirds of blocks.
    ///
    /// The relevant autocorrelation is that of the difference, in which effects of the scene on both runs
    /// cancel. A weak but long correlation, such as a drift under white noise, is not visible between single
    /// units, but is visible between thirds of blocks. A lasting fault has an autocorrelation of its own,
    /// which does not belong to the null hypothesis: the autocorrelation time is therefore limited to that of
    /// the baseline.
    pub(crate) fn are_remembered(&self, before: &FigureTerms, after: &FigureTerms) -> bool {
        let before = influence(before);
        let difference: Vec<f64> =
            influence(after).iter().zip(&before).map(|(after, before)| after - before).collect();
        self.memory_of(&difference).min(self.memory_of(&before)) > MAX_THIRDS
    }

    /// Returns the autocorrelation time of the sums over thirds, in thirds.
    fn memory_of(&self, series: &[f64]) -> f64 {
        let sum_of = |third: &Range<usize>| series[third.clone()].iter().sum::<f64>();
        let sums: Vec<Vec<f64>> =
            self.sequences.iter().map(|thirds| thirds.iter().map(sum_of).collect()).collect();
        let count: usize = sums.iter().map(Vec::len).sum();
        if count == 0 { 1.0 } else { count as f64 / effective_size(&sums) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dependence::blocks::length_for;
    use crate::hand_made::days as table;
    use draws::{Effect, Seed, normal};
    use score::{Reduction, Term};

    #[test]
    fn the_memory_is_that_of_the_figure_that_remembers_longest() {
        let random = &mut Seed { seed: 8, case: 0 }.stream(0, Effect::PixelNoise, 0);
        let mut table = table(&[("day 1", 20_000)]);
        let mut slow = 0.0;
        let mut figure = |name: &str, rho: f64| {
            let mut term = || {
                slow = rho * slow + (1.0 - rho * rho).sqrt() * normal(random);
                Term { sum: slow, count: 1 }
            };
            let terms = (0..20_000).map(|_| term()).collect();
            FigureTerms::from_terms(name, Reduction::Mean, terms)
        };
        table.figures = vec![figure("white", 0.0), figure("slow", 0.9)];
        let memory = memory(SourceKind::Run, "far_range", &table);
        // (1 + ρ)/(1 − ρ) = 19; its estimate scatters by some 5 %.
        assert!(memory.figure == "slow" && (15.0..24.0).contains(&memory.units), "{memory:?}");
        assert!((150..240).contains(&length_for(memory.units, 20_000)));
        assert_eq!((length_for(memory.units, 1000), length_for(memory.units, 100)), (50, 30));
    }

    /// Alternating values count as much as independent ones, and so do constant values.
    #[test]
    fn uncorrelated_figures_have_no_memory() {
        let mut table = table(&[("day 1", 100)]);
        let figure = |name: &str, value: fn(u8) -> f64| {
            let terms = (0..100).map(|i| Term { sum: value(i), count: 1 }).collect();
            FigureTerms::from_terms(name, Reduction::Mean, terms)
        };
        table.figures = vec![figure("constant", |_| 0.3), figure("alternating", |i| f64::from(i % 2))];
        let memory = memory(SourceKind::Run, "far_range", &table);
        assert_eq!(memory, Memory { units: 1.0, figure: String::new() });
        assert_eq!(super::memory(SourceKind::Run, "far_range", &UnitTable::default()), memory);
    }

    /// Differences that are white, that drift for half the run, and that last because of a fault while the
    /// baseline is white.
    #[test]
    fn a_drift_common_to_both_runs_is_detected_as_memory() {
        let random = &mut Seed { seed: 9, case: 0 }.stream(0, Effect::PixelNoise, 0);
        let table = table(&[("day 1", 400)]);
        let blocks = Blocks::cut(SourceKind::Run, "far_range", &table, 50);
        let thirds = Thirds::from_table(SourceKind::Run, "far_range", &table, &blocks);
        assert_eq!(thirds.sequences.iter().map(Vec::len).collect::<Vec<_>>(), [24]);
        let mut figure = |drift: f64, phase: f64| {
            let mut term = |unit: u32| {
                let slow = drift * libm::sin(std::f64::consts::TAU * f64::from(unit) / 400.0 + phase);
                Term { sum: slow + normal(random), count: 1 }
            };
            FigureTerms::from_terms("ra_mean_deg", Reduction::Mean, (0..400).map(&mut term).collect())
        };
        let [white, other, drifting, lasting] =
            [(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 2.0)].map(|(drift, phase)| figure(drift, phase));
        assert!(!thirds.are_remembered(&white, &other));
        assert!(thirds.are_remembered(&drifting, &lasting));
        assert!(!thirds.are_remembered(&white, &lasting), "a fault is not chance");
        // Blocks that are whole sequences are separate, independently of their autocorrelation.
        let days = Blocks::cut(SourceKind::Run, "far_range", &table, 400);
        let thirds = Thirds::from_table(SourceKind::Run, "far_range", &table, &days);
        assert!(!thirds.are_remembered(&drifting, &lasting));
    }
}
