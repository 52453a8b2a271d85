//! Blocks: sections of a sequence that are long enough to be independent of one another.
use std::ops::Range;

use run::world_by_name;
use score::{UnitTable, UnitVerdict};

use crate::identity::SourceKind;

/// Smallest number of blocks that can show a change at a level of 5 %: 2⁻⁵ = 3 %.
pub const MIN_BLOCKS: usize = 5;
/// Length of the shortest block, units: in a shorter sequence a correlation is not visible, and the sequence
/// is one block.
const SHORTEST_BLOCK: usize = 30;
/// Length of a block in autocorrelation times. In a sequence with exponential autocorrelation, neighbouring
/// means are then correlated by 2.5 %, and a test at 5 % rejects in 5.4 % (docs/evidence/gate.md).
const MEMORIES_A_BLOCK: f64 = 10.0;
/// Smallest number of blocks that a longer block length must leave, if the sequence is long enough.
const ENOUGH_BLOCKS: usize = 20;
/// Smallest number of blocks that a longer block length must leave in comparisons with other frames.
const ENOUGH_OF_OTHER_FRAMES: usize = 8;

/// Assignment of units to blocks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocks {
    of_units: Vec<usize>,
    count: usize,
}

impl Blocks {
    /// Creates blocks from the block number of each unit as stored in a file: integers that ascend by one
    /// from 0.
    pub(crate) fn from_numbers(numbers: Vec<usize>) -> Self {
        Self { count: numbers.last().map_or(0, |last| last + 1), of_units: numbers }
    }

    /// Divides each sequence of neighbouring units into equal blocks of about `length` units. A draw of a
    /// study is one block, for any number of points in its sweep.
    pub(crate) fn cut(kind: SourceKind, world: &str, table: &UnitTable, length: usize) -> Self {
        let sequences = sequences(kind, world, table);
        let mut of_units = Vec::with_capacity(table.units.len());
        let mut count = 0;
        for sequence in sequences {
            let units = sequence.len();
            let pieces = match kind {
                SourceKind::Study => 1,
                SourceKind::Run => ((units as f64 / length as f64).round() as usize).clamp(1, units),
            };
            of_units.extend((0..units).map(|unit| count + unit * pieces / units));
            count += pieces;
        }
        Self { of_units, count }
    }

    /// Divides one sequence into blocks of `length` units.
    #[cfg(test)]
    pub(crate) fn every(units: usize, length: usize) -> Self {
        let of_units: Vec<usize> = (0..units).map(|unit| unit / length).collect();
        Self { count: units.div_ceil(length), of_units }
    }

    /// Returns the number of blocks.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the block of a unit.
    pub fn block_of(&self, unit: usize) -> usize {
        self.of_units[unit]
    }

    /// Returns the mean number of units per block; 0 if there are no blocks.
    pub fn mean_length(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.of_units.len() as f64 / self.count as f64 }
    }
}

/// Returns the sequences of neighbouring units. In the far range, a new group (day) or a gap begins a
/// sequence. In docking, only a gap does: an approach is one sequence, and its groups are ranges. In a study,
/// the cases of a draw are a sequence.
pub(crate) fn sequences(kind: SourceKind, world: &str, table: &UnitTable) -> Vec<Range<usize>> {
    let are_groups_apart = world_by_name(world).is_ok_and(|world| world.facts().are_groups_apart);
    let go_together = |before: &UnitVerdict, this: &UnitVerdict| {
        let is_same_group = before.group == this.group;
        match kind {
            SourceKind::Study => is_same_group,
            SourceKind::Run => before.number + 1 == this.number && (!are_groups_apart || is_same_group),
        }
    };
    let mut begin = 0;
    let mut next = |sequence: &[UnitVerdict]| {
        begin += sequence.len();
        begin - sequence.len()..begin
    };
    table.units.chunk_by(go_together).map(&mut next).collect()
}

/// Returns a block length, units, for a run with the autocorrelation time `memory`: ten times that, or less
/// if this would leave fewer than `least` blocks, but at least thirty.
fn length_leaving(least: usize, memory: f64, units: usize) -> usize {
    let wanted = (MEMORIES_A_BLOCK * memory).ceil() as usize;
    wanted.min(units / least).max(SHORTEST_BLOCK)
}

/// Returns a block length, units, for a run with the autocorrelation time `memory`, which leaves twenty
/// blocks.
pub(crate) fn length_for(memory: f64, units: usize) -> usize {
    length_leaving(ENOUGH_BLOCKS, memory, units)
}

/// Returns a block length, units, for comparison with other frames, where slow variations are part of the
/// difference; it leaves eight blocks.
pub(crate) fn length_for_other_frames(memory: f64, units: usize) -> usize {
    length_leaving(ENOUGH_OF_OTHER_FRAMES, memory, units)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::days as table;

    #[test]
    fn blocks_never_cross_a_day_and_are_about_as_long_as_requested() {
        let table = table(&[("day 1", 95), ("day 2", 31), ("day 3", 4)]);
        let blocks = Blocks::cut(SourceKind::Run, "far_range", &table, 30);
        assert_eq!(
            (blocks.count(), blocks.block_of(94), blocks.block_of(95), blocks.block_of(126)),
            (5, 2, 3, 4)
        );
        let approach = Blocks::cut(SourceKind::Run, "docking", &table, 30);
        assert_eq!((approach.count(), approach.block_of(0), approach.block_of(129)), (4, 0, 3));
        assert_eq!(Blocks::cut(SourceKind::Study, "docking", &table, 30).count(), 3, "of three draws");
        let numbers: Vec<usize> = (0..130).map(|unit| blocks.block_of(unit)).collect();
        assert_eq!(Blocks::from_numbers(numbers), blocks);
    }

    #[test]
    fn a_gap_and_in_far_range_a_day_part_sequences() {
        let mut table = table(&[("day 1", 3), ("day 2", 2), ("day 3", 2)]);
        // One frame is missing between days 2 and 3.
        table.units[5..].iter_mut().for_each(|unit| unit.number += 1);
        assert_eq!(sequences(SourceKind::Run, "far_range", &table), [0..3, 3..5, 5..7]);
        assert_eq!(sequences(SourceKind::Run, "docking", &table), [0..5, 5..7]);
        assert_eq!(sequences(SourceKind::Study, "docking", &table), [0..3, 3..5, 5..7]);
        assert_eq!(sequences(SourceKind::Run, "far_range", &UnitTable::default()), []);
    }

    /// Two pieces of 7 units have 4 and 3 units, two pieces of 5 have 3 and 2, and no piece is empty.
    #[test]
    fn a_sequence_is_cut_into_pieces_that_differ_by_a_unit_at_most() {
        let table = table(&[("day 1", 7), ("day 2", 5), ("day 3", 1)]);
        let blocks = Blocks::cut(SourceKind::Run, "far_range", &table, 3);
        let of: Vec<usize> = (0..13).map(|unit| blocks.block_of(unit)).collect();
        assert_eq!(of, [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 4]);
        assert_eq!((blocks.count(), blocks.mean_length()), (5, 2.6));
        let single = Blocks::cut(SourceKind::Run, "docking", &table, 1);
        assert_eq!((single.count(), single.block_of(12), single.mean_length()), (13, 12, 1.0));
        let none = Blocks::cut(SourceKind::Run, "docking", &UnitTable::default(), 30);
        assert_eq!((none.count(), none.mean_length()), (0, 0.0));
        assert_eq!(Blocks::from_numbers(vec![]), none);
    }

    #[test]
    fn blocks_are_ten_memories_long_but_leave_twenty_and_are_not_shorter_than_thirty() {
        assert_eq!(length_for(4.01, 100_000), 41);
        assert_eq!(length_for(4.01, 790), 39);
        assert_eq!(length_for(1.0, 100_000), 30);
        assert_eq!(length_for(40.0, 100), 30);
    }
}
