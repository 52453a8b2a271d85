//! Blooming: the pixels of a frame after its overfull wells have spilt.

use std::ops::Range;

use draws::{Stream, Streams};
use render::draw::ExpectedImage;

use super::detector::Sensor;
use super::pixels::LineOffsets;
use super::spill::BloomingConfig;

/// Inputs for filling the wells of a frame.
pub(super) struct Overflow<'a> {
    pub(super) blooming: &'a BloomingConfig,
    pub(super) expected: &'a ExpectedImage,
    /// Readout offsets of rows and columns.
    pub(super) offsets: Option<&'a LineOffsets>,
    /// Random streams of the pixel noise.
    pub(super) streams: &'a Streams,
}

impl Sensor {
    /// Redraws the columns with pixels that may exceed the full well, and passes the index and the digital
    /// number of each pixel that differs to `put`.
    ///
    /// Electrons are drawn, then they spill, then they are read out. Each pixel is drawn at the address
    /// rows + index, the address of the earlier draw of a pixel with signal. Pixels that neither overflow nor
    /// receive electrons keep their value.
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
                // Pixels that may overflow were drawn earlier without spilling, perhaps from a table.
                if part.held[i] != part.collected[i] || part.means_e[i] > threshold_e {
                    let mut stream = stream(y);
                    // The collected electrons are redrawn only to advance the stream to the draw of the read
                    // noise.
                    self.distribution.collect(part.means_e[i], &mut stream);
                    let offset_e = offsets.map_or(0.0, |offsets| offsets.offset_at(x, y));
                    put(y * self.columns + x, self.distribution.convert(part.held[i], offset_e, &mut stream));
                }
            }
        }
    }
}

/// Initial number of rows examined beyond the pixels that may overflow: most spilt electrons stay within
/// them.
const MARGIN: usize = 16;

/// Some rows of a column: expected electrons, collected electrons and electrons held after spilling. Each
/// pixel farther from those that may overflow overflows with a probability of 2^-40, and neither gives nor
/// receives electrons.
#[derive(Default)]
struct ColumnPart {
    rows: Range<usize>,
    means_e: Vec<f64>,
    collected: Vec<f64>,
    held: Vec<f64>,
}

impl ColumnPart {
    /// Draws the electrons collected by the pixels of column `x`, before spilling.
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

    /// Returns true if electrons spill to an end of the rows that is not an end of the column.
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
    use draws::Seed;

    /// Only the rows near overflowing pixels are examined, extended as far as the electrons spill.
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
            // Half of the electrons spill upwards and half downwards, one full well per pixel; electrons that
            // leave at an end are lost.
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
