//! Blooming: the pixels of a frame after its full wells have spilt.

use std::ops::Range;

use super::detector::Sensor;
use super::pixels::LineOffsets;
use super::spill::BloomingConfig;
use crate::draw::ExpectedImage;
use crate::randomness::{Stream, Streams};

/// What the wells of a frame are filled from.
pub(super) struct Overflow<'a> {
    pub(super) blooming: &'a BloomingConfig,
    pub(super) expected: &'a ExpectedImage,
    /// What the readout adds to rows and columns.
    pub(super) offsets: Option<&'a LineOffsets>,
    /// Of the pixels' noise.
    pub(super) streams: &'a Streams,
}

impl Sensor {
    /// Draws anew the columns that have pixels above the full well, and tells `put` the index and the digital number of each
    /// pixel that differs.
    ///
    /// Electrons are drawn first, then they spill, then they are read. A pixel is drawn at its own address, place =
    /// rows + index, where a pixel with signal was drawn already: what neither overflows nor receives is left as it is.
    pub(super) fn bloom(&self, overflow: &Overflow<'_>, mut put: impl FnMut(usize, u16)) {
        let Overflow { blooming, expected, offsets, streams } = *overflow;
        let threshold_e = self.distribution.may_overflow_from_e();
        let above = expected.rows_above(threshold_e);
        let mut part = ColumnPart::default();
        for (x, above) in above.into_iter().enumerate().filter(|(_, above)| above.start < above.end) {
            let stream = |y: usize| streams.stream_at((self.rows + y * self.columns + x) as u64);
            let mut margin = MARGIN;
            loop {
                part.rows = above.start.saturating_sub(margin)..(above.end + margin).min(self.rows);
                part.fill(self, x, expected, stream);
                blooming.spill(&mut part.held, self.distribution.full_well_e());
                if !part.leaves(self) {
                    break;
                }
                margin *= 4;
            }
            for (i, y) in part.rows.clone().enumerate() {
                // Those that may overflow were drawn before with a well of their own, perhaps from a table.
                if part.held[i] != part.collected[i] || part.means_e[i] > threshold_e {
                    let mut stream = stream(y);
                    // What was collected is drawn again only to leave the stream where the read noise begins.
                    self.distribution.collect(part.means_e[i], &mut stream);
                    let offset_e = offsets.map_or(0.0, |offsets| offsets.offset_at(x, y));
                    put(y * self.columns + x, self.distribution.convert(part.held[i], offset_e, &mut stream));
                }
            }
        }
    }
}

/// Rows beyond the pixels that may overflow that are looked at first: most of what spills stays within.
const MARGIN: usize = 16;

/// Some rows of a column: what its pixels are expected to collect, what they collect and what they hold. Pixels farther from those
/// that may overflow overflow themselves once in 2^40, and neither give nor receive.
#[derive(Default)]
struct ColumnPart {
    rows: Range<usize>,
    means_e: Vec<f64>,
    collected: Vec<f64>,
    held: Vec<f64>,
}

impl ColumnPart {
    /// Draws what the pixels of column `x` collect, before anything spills.
    fn fill(
        &mut self,
        sensor: &Sensor,
        x: usize,
        expected: &ExpectedImage,
        stream: impl Fn(usize) -> Stream,
    ) {
        let Self { rows, means_e, collected, held } = self;
        means_e.clear();
        means_e.extend(rows.clone().map(|y| expected.electrons_at(x, y).max(0.0)));
        collected.clear();
        let drawn = rows
            .clone()
            .zip(&*means_e)
            .map(|(y, &mean_e)| sensor.distribution.collect(mean_e, &mut stream(y)));
        collected.extend(drawn);
        held.clone_from(collected);
    }

    /// Whether anything spills to an end of the rows that is no end of the column.
    fn leaves(&self, sensor: &Sensor) -> bool {
        let reached =
            |i: usize| self.held[i] != self.collected[i] || self.held[i] >= sensor.distribution.full_well_e();
        (self.rows.start > 0 && reached(0))
            || (self.rows.end < sensor.rows && reached(self.rows.len().saturating_sub(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::tests::{interval, twelve_bit};
    use super::super::{FlatSamplers, SensorConfig};
    use super::*;
    use crate::randomness::Seed;

    /// Of a column only the rows about what overflows are looked at, and more of them as far as it spills.
    #[test]
    fn a_long_bleed_is_followed_to_both_its_ends() {
        for (row, first, last) in [(300, 101, Some(499)), (30, 0, None)] {
            let config = SensorConfig {
                blooming: Some(BloomingConfig { spill_fraction: 1.0 }),
                full_well_e: 5000.0,
                background_e_per_s: 0.0,
                dark_current_e_per_s: 0.0,
                hot_pixels: Default::default(),
                ..twelve_bit()
            };
            let sensor = Sensor::new(&config, 5, 600).unwrap();
            let (mut image, mut raw) = (sensor.new_expected(), sensor.new_raw());
            // Half of it goes up and half down, a full well a pixel; what leaves at an end is lost.
            image.add_pixel(2, row, 5000.0 * 399.0);
            let charge = sensor.collect(&mut image, &interval(1.0));
            let seed = Seed { seed: 61, case: 0 };
            sensor.read_out(&charge, &seed, 0, &mut FlatSamplers::new(), &mut raw).unwrap();
            let full: Vec<usize> = (0..600).filter(|y| raw.dn()[y * 5 + 2] > 400).collect();
            assert!(full.first().unwrap().abs_diff(first) <= 1, "{full:?}");
            assert!(full.is_sorted_by(|a, b| a + 1 == *b), "{full:?}");
            assert!(last.is_none_or(|last: usize| full.last().unwrap().abs_diff(last) <= 1), "{full:?}");
        }
    }
}
