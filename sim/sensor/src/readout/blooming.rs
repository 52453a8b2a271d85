//! Blooming: the pixels of a frame after its overfull wells have spilt.

use std::ops::Range;

use super::PixelInputs;
use super::sparse_image::Pixel;
use crate::detector::Sensor;
use crate::pixel::sampler::PixelSampler;
use crate::spill::BloomingConfig;

/// Inputs for filling the wells of a frame.
pub(super) struct Overflow<'a> {
    pub(super) blooming: &'a BloomingConfig,
    pub(super) inputs: &'a PixelInputs<'a>,
    pub(super) sampler: &'a mut PixelSampler,
}

impl Sensor {
    /// Redraws the columns with pixels that may exceed the full well, and passes each pixel that differs to
    /// `put`.
    ///
    /// Electrons are drawn, then they spill, then they are read out. Each pixel is drawn with the words at
    /// its own address. Pixels that neither overflow nor receive electrons keep their number.
    pub(super) fn bloom(&self, overflow: &mut Overflow<'_>, mut put: impl FnMut(Pixel)) {
        let PixelInputs { expected, offsets, streams, .. } = overflow.inputs;
        let threshold_e = self.distribution.may_overflow_from_e();
        let above = expected.rows_above(threshold_e);
        let mut part = ColumnPart::default();
        for (x, above) in above.into_iter().enumerate().filter(|(_, above)| above.start < above.end) {
            let mut margin = MARGIN;
            loop {
                part.rows = above.start.saturating_sub(margin)..(above.end + margin).min(self.rows);
                part.fill(self, x, overflow);
                overflow.blooming.spill(&mut part.held, self.distribution.full_well_e());
                if !part.leaves(self) {
                    break;
                }
                margin *= 4;
            }
            for (i, y) in part.rows.clone().enumerate() {
                // Pixels that may overflow were drawn earlier without spilling, perhaps from a table.
                if part.held[i] != part.collected[i] || part.means_e[i] > threshold_e {
                    let index = y * self.columns + x;
                    let offset_e = offsets.as_ref().map_or(0.0, |offsets| offsets.offset_at(x, y));
                    let words = streams.pixel_words(index);
                    put(Pixel { index, dn: overflow.sampler.convert(part.held[i], offset_e, &words) });
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
    fn fill(&mut self, sensor: &Sensor, x: usize, overflow: &mut Overflow<'_>) {
        let PixelInputs { expected, streams, .. } = overflow.inputs;
        self.means_e.clear();
        self.collected.clear();
        for y in self.rows.clone() {
            let mean_e = expected.electrons_at(x, y).max(0.0);
            let words = streams.pixel_words(y * sensor.columns + x);
            self.means_e.push(mean_e);
            self.collected.push(overflow.sampler.collect(mean_e, &words));
        }
        self.held.clone_from(&self.collected);
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
    use super::*;
    use crate::config::tests::{interval, twelve_bit};
    use crate::{FrameCharge, SensorConfig};
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
            let collected = FrameCharge { charge: &charge, seed, frame: 0 };
            sensor.read_out(&collected, &mut sensor.new_sampler(), &mut raw).unwrap();
            let full: Vec<usize> = (0..600).filter(|y| raw.dn()[y * 5 + 2] > 400).collect();
            assert!(full.first().unwrap().abs_diff(first) <= 1, "{full:?}");
            assert!(full.is_sorted_by(|a, b| a + 1 == *b), "{full:?}");
            assert!(last.is_none_or(|last: usize| full.last().unwrap().abs_diff(last) <= 1), "{full:?}");
        }
    }
}
