//! Spilling of charge that exceeds the full wells of a column.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Blooming of a CCD: charge above the full well spills to the neighbours up and down the column. Channel
/// stops separate the columns, so no charge moves sideways.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BloomingConfig {
    /// Share of the charge above the full well that spills, 0 to 1; anti-blooming drains remove the remainder
    /// immediately. 1: a detector without drains; 0: all the excess is lost.
    #[schemars(range(min = 0, max = 1))]
    pub spill_fraction: f64,
}

impl BloomingConfig {
    /// Spills the charge of one column until no pixel holds more than `full_well_e`. `column` has the
    /// electrons of the pixels, top to bottom; integer numbers stay integers. Charge that leaves at either
    /// end is lost.
    ///
    /// A pixel above the full well passes its excess on, half up and half down, and so on until all pixels
    /// hold their charge. The result does not depend on the order of the steps (the divisible sandpile:
    /// Levine & Peres, "Strong spherical asymptotics for rotor-router aggregation and the divisible
    /// sandpile", Potential Analysis 30, 2009, Sec. 3), and every step conserves the column's charge and its
    /// centre. A run of full pixels therefore passes to its two adjacent pixels the charges that conserve
    /// charge and centre; if an adjacent pixel cannot hold its charge, the run grows.
    pub(super) fn spill(&self, column: &mut [f64], full_well_e: f64) {
        for electrons in column.iter_mut().filter(|electrons| **electrons > full_well_e) {
            *electrons -= ((1.0 - self.spill_fraction) * (*electrons - full_well_e)).round();
        }
        let mut runs: Vec<Run> = Vec::new();
        let mut next = 0;
        while let Some(offset) = column[next..].iter().position(|&electrons| electrons > full_well_e) {
            let mut run = Run::new(next + offset, column[next + offset] - full_well_e);
            loop {
                let (up_e, down_e) = run.gives();
                // The run above may have passed charge to the pixel between the two runs.
                let (above_end, above_e) = runs.last().map_or((0, 0.0), |above| (above.end, above.gives().1));
                let shared_e = if run.start == above_end + 1 { above_e } else { 0.0 };
                if let Some(above) = runs.pop_if(|above| above.end == run.start) {
                    run = above.joined(&run);
                } else if run.start > 0 && column[run.start - 1] + shared_e + up_e > full_well_e {
                    run.grow_up(column[run.start - 1] - full_well_e);
                } else if run.end < column.len() && column[run.end] + down_e > full_well_e {
                    run.grow_down(column[run.end] - full_well_e);
                } else {
                    break;
                }
            }
            next = run.end;
            runs.push(run);
        }
        for run in runs {
            let (up_e, down_e) = run.gives();
            column[run.start..run.end].fill(full_well_e);
            if run.start > 0 {
                column[run.start - 1] += up_e;
            }
            if run.end < column.len() {
                column[run.end] += down_e;
            }
        }
    }
}

/// Run of full pixels in a column: rows `start..end`.
#[derive(Debug, Clone, Copy)]
struct Run {
    start: usize,
    end: usize,
    /// Electrons above the full well, summed over the pixels of the run.
    excess_e: f64,
    /// Electrons above the full well, summed with each pixel's distance from the row before `start` as
    /// weight.
    moment_e: f64,
}

impl Run {
    fn new(row: usize, excess_e: f64) -> Self {
        Self { start: row, end: row + 1, excess_e, moment_e: excess_e }
    }

    fn length(&self) -> f64 {
        (self.end - self.start) as f64
    }

    /// Electrons passed to the pixel before the run and to the pixel after it: they conserve sum and centre,
    /// rounded to integer electrons.
    fn gives(&self) -> (f64, f64) {
        let down_e = (self.moment_e / (self.length() + 1.0)).round().clamp(0.0, self.excess_e.max(0.0));
        (self.excess_e - down_e, down_e)
    }

    fn grow_up(&mut self, excess_e: f64) {
        self.start -= 1;
        self.excess_e += excess_e;
        self.moment_e += self.excess_e;
    }

    fn grow_down(&mut self, excess_e: f64) {
        self.end += 1;
        self.excess_e += excess_e;
        self.moment_e += excess_e * self.length();
    }

    /// Merges this run with the run that begins at its end.
    fn joined(&self, below: &Self) -> Self {
        Self {
            start: self.start,
            end: below.end,
            excess_e: self.excess_e + below.excess_e,
            moment_e: self.moment_e + below.moment_e + below.excess_e * self.length(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use draws::{Effect, Seed, uniform};
    use rand::Rng;

    const ALL: BloomingConfig = BloomingConfig { spill_fraction: 1.0 };

    fn spilt(column: &[f64], full_well_e: f64) -> Vec<f64> {
        let mut column = column.to_vec();
        ALL.spill(&mut column, full_well_e);
        column
    }

    #[test]
    fn a_single_excess_spreads_evenly_up_and_down() {
        let mut column = [10.0; 21];
        column[10] = 100.0 + 4.0 * 90.0 + 60.0;
        let mut expected = [10.0; 21];
        expected[8..=12].fill(100.0);
        (expected[7], expected[13]) = (40.0, 40.0);
        assert_eq!(spilt(&column, 100.0), expected);
    }

    #[test]
    fn an_empty_column_and_one_that_nothing_overflows_stay_as_they_are() {
        assert_eq!(spilt(&[], 100.0), [0.0; 0]);
        assert_eq!(spilt(&[100.0, 0.0, 99.0], 100.0), [100.0, 0.0, 99.0]);
    }

    #[test]
    fn drains_take_their_share_of_the_excess() {
        let mut column = [0.0, 0.0, 500.0, 0.0, 0.0];
        BloomingConfig { spill_fraction: 0.25 }.spill(&mut column, 100.0);
        assert_eq!(column, [0.0, 50.0, 100.0, 50.0, 0.0]);
        let mut column = [0.0, 500.0, 0.0];
        BloomingConfig { spill_fraction: 0.0 }.spill(&mut column, 100.0);
        assert_eq!(column, [0.0, 100.0, 0.0]);
    }

    #[test]
    fn charge_that_reaches_an_end_is_lost() {
        // Gambler's ruin: with three full rows, half of the excess of the second leaves at either end.
        assert_eq!(spilt(&[100.0, 1000.0, 100.0], 100.0), [100.0; 3]);
        // Near the upper end more charge is lost at that end than moves down: 660 of 900.
        assert_eq!(spilt(&[1000.0, 100.0, 0.0, 0.0, 0.0], 100.0), [100.0, 100.0, 100.0, 100.0, 40.0]);
    }

    /// Columns of random charge with some bright rows, with integer electrons and an integer full well.
    fn columns() -> impl Iterator<Item = Vec<f64>> {
        (0..300).map(|index| {
            let mut stream = Seed { seed: 9, case: 0 }.stream(0, Effect::PixelNoise, index);
            let mut column: Vec<f64> = (0..400).map(|_| (60.0 * uniform(&mut stream)).floor()).collect();
            for _ in 0..1 + stream.next_u32() % 6 {
                let row = 150 + (stream.next_u32() % 100) as usize;
                column[row] += (1500.0 * uniform(&mut stream)).floor();
            }
            column
        })
    }

    #[test]
    fn charge_is_kept_to_the_electron_and_its_centre_to_the_rounding() {
        for column in columns() {
            let after = spilt(&column, 100.0);
            assert_eq!(after.iter().sum::<f64>(), column.iter().sum::<f64>());
            assert!(
                after.iter().all(|&electrons| (0.0..=100.0).contains(&electrons) && electrons.fract() == 0.0)
            );
            let moment = |column: &[f64]| column.iter().enumerate().map(|(y, e)| y as f64 * e).sum::<f64>();
            // Each of at most six runs rounds half an electron over its length.
            let rounding = 6.0 * 0.5 * 150.0;
            assert!((moment(&after) - moment(&column)).abs() <= rounding);
        }
    }

    /// The definition, step by step: every pixel above the full well passes half of its excess to either
    /// side.
    #[test]
    fn the_end_is_that_of_spilling_step_by_step() {
        for column in columns().take(30) {
            let mut slow = column.clone();
            for _ in 0..200_000 {
                let mut largest = 0.0_f64;
                for y in 1..slow.len() - 1 {
                    let excess = slow[y] - 100.0;
                    if excess > 0.0 {
                        largest = largest.max(excess);
                        slow[y] = 100.0;
                        slow[y - 1] += 0.5 * excess;
                        slow[y + 1] += 0.5 * excess;
                    }
                }
                if largest < 1e-6 {
                    break;
                }
            }
            for (y, (fast, slow)) in spilt(&column, 100.0).iter().zip(&slow).enumerate() {
                // Rounding to integer electrons: half an electron from either side, and one more where
                // rounding decides which pixel is full.
                assert!((fast - slow).abs() < 2.0, "row {y}: {fast} and {slow}");
            }
        }
    }
}
