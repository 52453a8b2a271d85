//! Blocks: stretches of a sequence that are long enough to be independent of one another.
use run::world_called;
use score::UnitTable;
use statistics::effective_size;

use super::identity::SourceKind;
use super::influence::influence;

/// Fewer blocks than this cannot show anything at a level of 5 %: 2⁻⁵ = 3 %.
pub const LEAST_BLOCKS: usize = 5;
/// Blocks are not made shorter than this, units: in a shorter sequence a memory cannot be seen, and it is one block.
const SHORTEST_BLOCK: usize = 30;
/// A block is so many autocorrelation times long. Of a sequence whose correlation falls off exponentially, neighbouring means are then
/// correlated by 2.5 %, and a test at 5 % rejects in 5.4 % (docs/gate.md).
const MEMORIES_A_BLOCK: f64 = 10.0;
/// Blocks are not made so long that there are fewer than these, if the sequence has a way to give them.
const ENOUGH_BLOCKS: usize = 20;

/// Which block each unit belongs to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocks {
    of_units: Vec<usize>,
    count: usize,
}

/// How long the figures of a run remember.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Memory {
    /// The longest autocorrelation time of its figures, units.
    pub(super) units: f64,
    /// The figure that has it.
    pub(super) figure: String,
}

impl Blocks {
    /// Blocks from the number of each unit's, as they stand in a file: whole numbers that ascend by one from 0.
    pub(super) fn from_numbers(numbers: Vec<usize>) -> Self {
        Self { count: numbers.last().map_or(0, |last| last + 1), of_units: numbers }
    }

    /// Cuts each sequence of neighbouring units into equal pieces of about `length` units. A draw of a study is one block, however many
    /// points its sweep has.
    pub(super) fn cut(kind: SourceKind, world: &str, table: &UnitTable, length: usize) -> Self {
        let sequences = sequences(kind, world, table);
        let mut of_units = Vec::with_capacity(table.units.len());
        let mut count = 0;
        for ends in sequences.windows(2) {
            let units = ends[1] - ends[0];
            let pieces = match kind {
                SourceKind::Study => 1,
                SourceKind::Run => ((units as f64 / length as f64).round() as usize).clamp(1, units),
            };
            of_units.extend((0..units).map(|unit| count + unit * pieces / units));
            count += pieces;
        }
        Self { of_units, count }
    }

    /// Blocks of so many units each, of one sequence.
    #[cfg(test)]
    pub(super) fn every(units: usize, length: usize) -> Self {
        let of_units: Vec<usize> = (0..units).map(|unit| unit / length).collect();
        Self { count: units.div_ceil(length), of_units }
    }

    /// Number of blocks.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The block of a unit.
    pub fn of(&self, unit: usize) -> usize {
        self.of_units[unit]
    }

    /// Units of a block in the mean; 0 without any.
    pub fn mean_length(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.of_units.len() as f64 / self.count as f64 }
    }
}

/// Where sequences of neighbouring units begin, and where the last one ends. Far range: where a group (day) or a gap begins. Docking: an
/// approach is one sequence, but for gaps; its groups are ranges. A study: the cases of a draw.
fn sequences(kind: SourceKind, world: &str, table: &UnitTable) -> Vec<usize> {
    let units = &table.units;
    let are_groups_apart = world_called(world).is_ok_and(|world| world.are_groups_apart());
    let mut begins = vec![0];
    for unit in 1..units.len() {
        let (before, this) = (&units[unit - 1], &units[unit]);
        let is_other_group = before.group != this.group;
        let is_apart = match kind {
            SourceKind::Study => is_other_group,
            SourceKind::Run => before.number + 1 != this.number || (are_groups_apart && is_other_group),
        };
        if is_apart {
            begins.push(unit);
        }
    }
    if !units.is_empty() {
        begins.push(units.len());
    }
    begins
}

/// The longest autocorrelation time of the figures of a run.
pub(super) fn memory(kind: SourceKind, world: &str, table: &UnitTable) -> Memory {
    let sequences = sequences(kind, world, table);
    let memory_of = |series: &[f64]| {
        let cut: Vec<Vec<f64>> = sequences.windows(2).map(|ends| series[ends[0]..ends[1]].to_vec()).collect();
        // Without any unit 0/0, which is longer than nothing.
        series.len() as f64 / effective_size(&cut)
    };
    let of_figures = table.figures.iter().map(|figure| (memory_of(&influence(figure)), &figure.name));
    of_figures.fold(Memory { units: 1.0, figure: String::new() }, |longest, (units, figure)| {
        if units > longest.units { Memory { units, figure: figure.clone() } } else { longest }
    })
}

/// A length of blocks for a run of this memory, units: ten times that, or shorter where that would leave fewer than twenty, but at least
/// thirty.
pub(super) fn length_for(memory: &Memory, units: usize) -> usize {
    let wanted = (MEMORIES_A_BLOCK * memory.units).ceil() as usize;
    wanted.min(units / ENOUGH_BLOCKS).max(SHORTEST_BLOCK)
}

#[cfg(test)]
mod tests {
    use super::*;
    use score::{FigureTerms, Reduction, Term, UnitVerdict};
    use sim::randomness::{Effect, Seed, normal};

    fn table(groups: &[(&str, u64)]) -> UnitTable {
        let mut number = 0;
        let mut units = Vec::new();
        for (group, count) in groups {
            for _ in 0..*count {
                let (verdict, group) = ("correct".to_owned(), (*group).to_owned());
                units.push(UnitVerdict { number, group, verdict, cause: None });
                number += 1;
            }
        }
        UnitTable { units, figures: Vec::new() }
    }

    #[test]
    fn blocks_never_cross_a_day_and_are_about_as_long_as_asked() {
        let table = table(&[("day 1", 95), ("day 2", 31), ("day 3", 4)]);
        let blocks = Blocks::cut(SourceKind::Run, "far_range", &table, 30);
        assert_eq!((blocks.count(), blocks.of(94), blocks.of(95), blocks.of(126)), (5, 2, 3, 4));
        let approach = Blocks::cut(SourceKind::Run, "docking", &table, 30);
        assert_eq!((approach.count(), approach.of(0), approach.of(129)), (4, 0, 3));
        assert_eq!(Blocks::cut(SourceKind::Study, "docking", &table, 30).count(), 3, "of three draws");
        let numbers: Vec<usize> = (0..130).map(|unit| blocks.of(unit)).collect();
        assert_eq!(Blocks::from_numbers(numbers), blocks);
    }

    #[test]
    fn the_memory_is_that_of_the_figure_that_remembers_longest() {
        let random = &mut Seed { seed: 8, case: 0 }.stream(0, Effect::PixelNoise, 0);
        let mut table = table(&[("day 1", 20_000)]);
        let mut slow = 0.0;
        let mut figure = |name: &str, rho: f64| {
            let mut term = || {
                slow = rho * slow + (1.0 - rho * rho).sqrt() * normal(random);
                Term { sum: slow, of: 1 }
            };
            let terms = (0..20_000).map(|_| term()).collect();
            FigureTerms::counted(name, Reduction::Mean, terms)
        };
        table.figures = vec![figure("white", 0.0), figure("slow", 0.9)];
        let memory = memory(SourceKind::Run, "far_range", &table);
        // (1 + ρ)/(1 − ρ) = 19; its estimate scatters by some 5 %.
        assert!(memory.figure == "slow" && (15.0..24.0).contains(&memory.units), "{memory:?}");
        assert!((150..240).contains(&length_for(&memory, 20_000)));
        assert_eq!((length_for(&memory, 1000), length_for(&memory, 100)), (50, 30));
    }

    #[test]
    fn a_gap_and_in_far_range_a_day_part_sequences() {
        let mut table = table(&[("day 1", 3), ("day 2", 2), ("day 3", 2)]);
        // A frame is missing between days 2 and 3.
        table.units[5..].iter_mut().for_each(|unit| unit.number += 1);
        assert_eq!(sequences(SourceKind::Run, "far_range", &table), [0, 3, 5, 7]);
        assert_eq!(sequences(SourceKind::Run, "docking", &table), [0, 5, 7]);
        assert_eq!(sequences(SourceKind::Study, "docking", &table), [0, 3, 5, 7]);
        assert_eq!(sequences(SourceKind::Run, "far_range", &UnitTable::default()), [0]);
    }

    /// 7 units in two pieces are 4 and 3, 5 in two 3 and 2, and none is without a unit.
    #[test]
    fn a_sequence_is_cut_into_pieces_that_differ_by_a_unit_at_most() {
        let table = table(&[("day 1", 7), ("day 2", 5), ("day 3", 1)]);
        let blocks = Blocks::cut(SourceKind::Run, "far_range", &table, 3);
        let of: Vec<usize> = (0..13).map(|unit| blocks.of(unit)).collect();
        assert_eq!(of, [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 4]);
        assert_eq!((blocks.count(), blocks.mean_length()), (5, 2.6));
        let single = Blocks::cut(SourceKind::Run, "docking", &table, 1);
        assert_eq!((single.count(), single.of(12), single.mean_length()), (13, 12, 1.0));
        let none = Blocks::cut(SourceKind::Run, "docking", &UnitTable::default(), 30);
        assert_eq!((none.count(), none.mean_length()), (0, 0.0));
        assert_eq!(Blocks::from_numbers(vec![]), none);
    }

    /// Values that alternate are worth as much as independent ones, and so are those that never vary.
    #[test]
    fn of_figures_that_remember_nothing_none_has_the_memory() {
        let mut table = table(&[("day 1", 100)]);
        let figure = |name: &str, value: fn(u8) -> f64| {
            let terms = (0..100).map(|i| Term { sum: value(i), of: 1 }).collect();
            FigureTerms::counted(name, Reduction::Mean, terms)
        };
        table.figures = vec![figure("constant", |_| 0.3), figure("alternating", |i| f64::from(i % 2))];
        let memory = memory(SourceKind::Run, "far_range", &table);
        assert_eq!(memory, Memory { units: 1.0, figure: String::new() });
        assert_eq!(super::memory(SourceKind::Run, "far_range", &UnitTable::default()), memory);
    }

    #[test]
    fn blocks_are_ten_memories_long_but_leave_twenty_and_are_not_shorter_than_thirty() {
        let length = |memory: f64, units| length_for(&Memory { units: memory, figure: String::new() }, units);
        assert_eq!(length(4.01, 100_000), 41);
        assert_eq!(length(4.01, 790), 39);
        assert_eq!(length(1.0, 100_000), 30);
        assert_eq!(length(40.0, 100), 30);
    }
}
