//! Sampling of a discrete distribution in constant time: Walker's alias method with integers.

/// Discrete distribution over digital numbers, sampled with one 32-bit word per draw (Walker 1977; built by
/// Vose's algorithm, 1991).
///
/// Each probability is rounded to an integer multiple of 2^-32, the resolution of the word; the rounded
/// probabilities add up to exactly 1. A number with a probability below 2^-32 may never occur.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AliasTable {
    cells: Vec<Cell>,
    /// The highest bits of the word select the cell, the remaining bits its side.
    shift: u32,
    side_mask: u32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Cell {
    /// A random word below the threshold gives `primary`, any other word gives `other`.
    threshold: u32,
    primary: u16,
    other: u16,
}

impl AliasTable {
    /// Builds the table that gives `first` + i with probability `probabilities[i]`. The probabilities need
    /// not add up to 1. There may be at most 65,536; if there are none, or all are zero, the table always
    /// gives `first`.
    pub(super) fn new(first: u16, probabilities: &[f64]) -> Self {
        Self::with_cells(2, first, probabilities)
    }

    /// Builds the table of [`AliasTable::new`] with at least `cells` cells, a power of two greater than one:
    /// the size of a single cell, 2^32, would not fit its threshold.
    pub(super) fn with_cells(cells: usize, first: u16, probabilities: &[f64]) -> Self {
        let mut weights = whole_weights(probabilities);
        let count = weights.len().next_power_of_two().max(cells);
        weights.resize(count, 0);
        let cell_weight = (1_u64 << 32) / count as u64;
        let number = |i: usize| first.saturating_add(u16::try_from(i).unwrap_or(u16::MAX));
        // A full cell needs no other side. The weights are integers and add up to an integer number of cells,
        // so every cell that is not paired below is exactly full.
        let mut cells: Vec<Cell> = (0..count)
            .map(|i| Cell { threshold: cell_weight as u32, primary: number(i), other: number(i) })
            .collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) =
            (0..count).partition(|&i| weights[i] < cell_weight);
        while let (Some(&giver), Some(taker)) = (large.last(), small.pop()) {
            cells[taker].threshold = weights[taker] as u32;
            cells[taker].other = number(giver);
            weights[giver] -= cell_weight - weights[taker];
            if weights[giver] < cell_weight {
                large.pop();
                small.push(giver);
            }
        }
        Self { cells, shift: 32 - count.trailing_zeros(), side_mask: cell_weight as u32 - 1 }
    }

    /// Returns the cells as words, lowest bits first: 32 bits of the threshold, 16 bits of the number below
    /// it, 16 bits of the other number. No word is 0: a cell with threshold 0 is encoded with its sides
    /// exchanged.
    pub(super) fn packed(&self) -> impl ExactSizeIterator<Item = u64> {
        self.cells.iter().map(|cell| {
            let (threshold, primary) = if cell.threshold > 0 {
                (cell.threshold, cell.primary)
            } else {
                (self.side_mask, cell.other)
            };
            u64::from(threshold) | u64::from(primary) << 32 | u64::from(cell.other) << 48
        })
    }

    /// Returns the digital number for a uniformly distributed word.
    #[inline(always)]
    pub(super) fn draw(&self, word: u32) -> u16 {
        let cell = self.cells[(word >> self.shift) as usize];
        if word & self.side_mask < cell.threshold { cell.primary } else { cell.other }
    }
}

/// Converts probabilities to integer multiples of 2^-32 that add up to 1: differences of the rounded
/// cumulative distribution, so each error is at most one multiple.
fn whole_weights(probabilities: &[f64]) -> Vec<u64> {
    let whole = (1_u64 << 32) as f64;
    let total: f64 = probabilities.iter().sum();
    if total <= 0.0 || total.is_nan() {
        return vec![1 << 32];
    }
    let (mut cumulative, mut before) = (0.0, 0);
    let mut weights: Vec<u64> = probabilities
        .iter()
        .map(|probability| {
            cumulative += probability;
            let up_to = ((cumulative / total).min(1.0) * whole).round() as u64;
            let weight = up_to - before;
            before = up_to;
            weight
        })
        .collect();
    if let Some(last) = weights.last_mut() {
        *last += (1 << 32) - before;
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exact probability of each number in a table, in multiples of 2^-32.
    fn exact_probabilities(table: &AliasTable, numbers: usize) -> Vec<u64> {
        let mut distribution = vec![0; numbers];
        for cell in &table.cells {
            distribution[usize::from(cell.primary)] += u64::from(cell.threshold);
            distribution[usize::from(cell.other)] +=
                u64::from(table.side_mask) + 1 - u64::from(cell.threshold);
        }
        distribution
    }

    #[test]
    fn the_table_reproduces_its_distribution() {
        for count in [1_usize, 2, 3, 7, 8, 100, 1000] {
            let probabilities: Vec<f64> = (0..count).map(|i| libm::exp(-((i * i) as f64) / 50.0)).collect();
            let total: f64 = probabilities.iter().sum();
            let table = AliasTable::new(5, &probabilities);
            let distribution = exact_probabilities(&table, 5 + count.next_power_of_two().max(2));
            assert_eq!(distribution.iter().sum::<u64>(), 1 << 32);
            for (i, probability) in probabilities.iter().enumerate() {
                let expected = probability / total * libm::pow(2.0, 32.0);
                assert!((distribution[5 + i] as f64 - expected).abs() <= 1.0, "{count}, {i}");
            }
        }
    }

    #[test]
    fn a_word_picks_its_cell_and_its_side() {
        let table = AliasTable::new(7, &[0.25, 0.75]);
        let share = |from: u64, to: u64| {
            let step = 1 << 16;
            let words = (from..to).step_by(step);
            words.clone().filter(|&word| table.draw(word as u32) == 7).count() as f64 / words.count() as f64
        };
        assert!((share(0, 1 << 32) - 0.25).abs() < 1e-4);
        // The number 8 has the upper half of the words.
        assert_eq!(share(1 << 31, 1 << 32), 0.0);
    }

    #[test]
    fn a_distribution_without_probabilities_is_certain() {
        for table in [AliasTable::new(9, &[]), AliasTable::new(9, &[0.0, 0.0]), AliasTable::new(9, &[1.0])] {
            assert!([0, 1 << 31, u32::MAX].iter().all(|&word| table.draw(word) == 9));
        }
    }

    #[test]
    fn the_largest_digital_number_is_reached() {
        let table = AliasTable::new(u16::MAX - 2, &[0.2, 0.3, 0.5]);
        assert!((0..1000).all(|i| table.draw(i * 4_294_967) >= u16::MAX - 2));
        assert_eq!(table.draw(u32::MAX), u16::MAX);
    }
}
