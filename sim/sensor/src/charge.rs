//! Charge collected by a detector by the end of an exposure: photoelectrons, dark current, hot pixels,
//! cosmic-ray hits.

use draws::Seed;
use optics::Stamp;
use render::draw::ExpectedImage;

use super::detector::Sensor;
use super::hot_pixels::HotPixel;

/// One opening of the shutter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExposureInterval {
    /// Seed of the effects that switch with time.
    pub seed: Seed,
    /// Mid-exposure, s of TT since J2000.0; for an interlaced frame, the middle between its two fields.
    pub middle_s: f64,
    /// Exposure time, s.
    pub exposure_s: f64,
}

/// Expected charge of every pixel at the end of an exposure: photoelectrons, dark current, hot pixels and
/// cosmic-ray hits. Created only by [`Sensor::collect`].
#[derive(Debug)]
pub struct Charge<'a> {
    expected: &'a mut ExpectedImage,
    smear_e_per_px: f64,
}

impl Charge<'_> {
    /// Expected electrons, before saturation and noise.
    pub fn expected(&self) -> &ExpectedImage {
        self.expected
    }

    /// Adds the charge of a cosmic-ray hit, as collected by the pixels.
    pub fn add_cosmic_ray_hit(&mut self, hit: &Stamp) {
        self.expected.add_collected(hit);
    }

    /// Electrons per pixel that the frame transfer adds, for a uniform detector; mean over all pixels.
    pub fn smear_e_per_px(&self) -> f64 {
        self.smear_e_per_px
    }
}

impl Sensor {
    /// Converts the photoelectrons of every pixel to its charge: adds smear of the frame transfer, dark
    /// current and hot pixels; dead pixels stay empty. The input, an image of [`Sensor::new_expected`],
    /// already contains the pixels' response to light.
    pub fn collect<'a>(
        &self,
        photo_electrons: &'a mut ExpectedImage,
        interval: &ExposureInterval,
    ) -> Charge<'a> {
        let ExposureInterval { exposure_s, .. } = *interval;
        let (columns, rows) = photo_electrons.size();
        let smear_e_per_px = if self.config().frame_transfer_s > 0.0 && exposure_s > 0.0 {
            // Each row spends 1/rows of the transfer time at the position of each other row.
            photo_electrons.smear(self.config().frame_transfer_s / (rows as f64 * exposure_s))
        } else {
            0.0
        };
        let dark_e = self.dark_electrons(exposure_s);
        if self.pattern().dark.is_empty() {
            photo_electrons.add_flat(dark_e);
        } else {
            photo_electrons.add_pattern(dark_e, &self.pattern().dark);
        }
        for pixel in self.hot_pixels() {
            photo_electrons.add_pixel(pixel.x, pixel.y, self.hot_electrons(pixel, interval));
        }
        for &(x, y) in self.pattern().dead.iter().filter(|(x, y)| *x < columns && *y < rows) {
            photo_electrons.empty_pixel(x, y);
        }
        Charge { expected: photo_electrons, smear_e_per_px }
    }

    /// Removes the charge that dead pixels do not collect from the image of a cosmic-ray hit.
    pub fn mask_dead_pixels(&self, hit: &mut Stamp) {
        for &(x, y) in &self.pattern().dead {
            hit.empty(x, y);
        }
    }

    /// Expected electrons of a hot pixel in an exposure, above those of an ordinary pixel; 0 if the pixel is
    /// dead.
    pub fn hot_electrons(&self, pixel: &HotPixel, interval: &ExposureInterval) -> f64 {
        if self.pattern().is_dead(pixel.x, pixel.y) {
            return 0.0;
        }
        let electrons = pixel.rate_e_per_s * interval.exposure_s;
        match self.config().hot_pixels.telegraph.filter(|_| pixel.switches) {
            Some(telegraph) => {
                let stream_index = (pixel.y * self.size().0 + pixel.x) as u64;
                let half_s = 0.5 * interval.exposure_s;
                let middle_s = interval.middle_s + self.config().offset_s(pixel.y, self.size().1);
                let (from_s, to_s) = (middle_s - half_s, middle_s + half_s);
                electrons * telegraph.mean_level(&interval.seed, stream_index, from_s, to_s)
            }
            None => electrons,
        }
    }

    /// Sets `bloomed` to the image of a single object over a background after its overfull wells have spilt.
    /// `peak_e` is the number of electrons in its brightest pixel. Returns false if nothing spills, or if
    /// blooming is off.
    pub fn bloom_stamp(&self, stamp: &Stamp, peak_e: f64, background_e: f64, bloomed: &mut Stamp) -> bool {
        let full_well_e = self.config().full_well_e;
        let Some(blooming) = &self.config().blooming else { return false };
        let Some(window) = stamp.window() else { return false };
        if peak_e + background_e <= full_well_e {
            return false;
        }
        let rows = self.size().1;
        bloomed.reset(stamp.centre(), (window.x, window.x + window.columns), (0, rows));
        let mut column = vec![0.0; rows];
        for i in 0..window.columns {
            column.fill(background_e);
            for (_, y, row) in stamp.rows() {
                column[y] += row[i];
            }
            blooming.spill(&mut column, full_well_e);
            for (y, electrons) in column.iter().enumerate() {
                bloomed.add(window.x + i, y, (electrons - background_e).max(0.0));
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::tests::{interval, twelve_bit};
    use super::super::fixed_pattern::FixedPatternConfig;
    use super::super::{BloomingConfig, SensorConfig, TemperatureConfig};
    use super::*;
    use contract::PixelPoint;
    use optics::{Psf, PsfConfig};

    fn star(sensor: &Sensor, electrons: f64) -> Stamp {
        let mut stamp = Stamp::new();
        let mut psf = Psf::new(&PsfConfig::Gaussian { sigma_px: 0.8 }).unwrap();
        psf.stamp(PixelPoint::new(20.3, 30.1), electrons, Psf::FLOOR_E, sensor.size(), &mut stamp);
        stamp
    }

    fn patterned() -> SensorConfig {
        SensorConfig {
            fixed_pattern: FixedPatternConfig {
                seed: 2,
                prnu_fraction: 0.1,
                dsnu_fraction: 0.5,
                dead_pixels: 100,
                dead_columns: 1,
                ..FixedPatternConfig::default()
            },
            ..twelve_bit()
        }
    }

    fn sum(stamp: &Stamp) -> f64 {
        stamp.rows().flat_map(|(_, _, row)| row).sum()
    }

    #[test]
    fn light_dark_current_and_defects_add_up_pixel_by_pixel() {
        let sensor = Sensor::new(&patterned(), 65, 48).unwrap();
        let mut image = sensor.new_expected();
        image.clear(100.0);
        let object = star(&sensor, 1e5);
        let mut before = vec![100.0; 65 * 48];
        object.rows().for_each(|(x, y, row)| {
            before[y * 65 + x..][..row.len()].iter_mut().zip(row).for_each(|(e, s)| *e += s)
        });
        image.add(&object);
        let charge = sensor.collect(&mut image, &interval(2.0));
        for (index, electrons) in charge.expected().iter().enumerate() {
            let (x, y) = (index % 65, index / 65);
            let pattern = sensor.pattern();
            let (response, dark) =
                (pattern.response.factor_at(x, y).unwrap(), pattern.dark.factor_at(x, y).unwrap());
            let hot = sensor.hot_pixels().iter().find(|hot| (hot.x, hot.y) == (x, y));
            let expected = if sensor.pattern().is_dead(x, y) {
                0.0
            } else {
                before[index] * f64::from(response)
                    + 20.0 * f64::from(dark)
                    + hot.map_or(0.0, |hot| 2.0 * hot.rate_e_per_s)
            };
            assert!((electrons - expected).abs() < 1e-9 * (1.0 + expected), "{x}, {y}: {electrons}");
        }
        // The contribution of the object is the difference from a frame without it.
        let with: f64 = charge.expected().iter().sum();
        let object = sum(&charge.expected().objects()[0]);
        image.clear(100.0);
        let without: f64 = sensor.collect(&mut image, &interval(2.0)).expected().iter().sum();
        assert!((with - without - object).abs() < 1e-6);
        assert!((object - 1e5).abs() > 100.0);
    }

    #[test]
    fn a_transfer_smears_the_light_of_every_column_over_it_and_nothing_else() {
        let smeared = SensorConfig { frame_transfer_s: 0.0048, ..twelve_bit() };
        let (sensor, still) =
            (Sensor::new(&smeared, 65, 48).unwrap(), Sensor::new(&twelve_bit(), 65, 48).unwrap());
        let stamp = star(&sensor, 1e5);
        let charge = |sensor: &Sensor| {
            let mut image = sensor.new_expected();
            image.clear(0.0);
            image.add(&stamp);
            sensor.collect(&mut image, &interval(0.5)).expected().clone()
        };
        let (with, without) = (charge(&sensor), charge(&still));
        // 0.1 ms per row, of 0.5 s; 47 other rows. Dark current and hot pixels are not smeared.
        let gained = with.iter().sum::<f64>() - without.iter().sum::<f64>();
        assert!((gained - 1e5 * 2e-4 * 47.0).abs() < 0.1, "{gained}");
        let column: f64 = stamp.rows().map(|(x, _, row)| row[20 - x]).sum();
        assert!((with.electrons_at(20, 2) - without.electrons_at(20, 2) - 2e-4 * column).abs() < 1e-9);
        assert_eq!(with.electrons_at(60, 2), without.electrons_at(60, 2));
    }

    #[test]
    fn dark_current_and_hot_pixels_double_every_so_many_kelvin() {
        let warm = TemperatureConfig { temperature_c: 33.0, reference_c: 20.0, doubling_k: 6.5 };
        let warm = Sensor::new(&SensorConfig { temperature: warm, ..twelve_bit() }, 65, 48).unwrap();
        let cold = Sensor::new(&twelve_bit(), 65, 48).unwrap();
        assert!((warm.dark_electrons(1.0) / cold.dark_electrons(1.0) - 4.0).abs() < 1e-12);
        assert!(!warm.hot_pixels().is_empty() && warm.hot_pixels().len() == cold.hot_pixels().len());
        for (warm, cold) in warm.hot_pixels().iter().zip(cold.hot_pixels()) {
            assert!((warm.rate_e_per_s / cold.rate_e_per_s - 4.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_image_of_an_overfull_star_grows_along_its_column_and_keeps_its_electrons() {
        let bloom = Some(BloomingConfig { spill_fraction: 1.0 });
        let config = SensorConfig { blooming: bloom, full_well_e: 5000.0, ..twelve_bit() };
        let sensor = Sensor::new(&config, 65, 48).unwrap();
        let (stamp, mut bloomed) = (star(&sensor, 1e5), Stamp::new());
        let peak_e = |stamp: &Stamp| stamp.truth(20.0, 15.0, f64::INFINITY).peak_electrons;
        assert!(sensor.bloom_stamp(&stamp, peak_e(&stamp), 20.0, &mut bloomed));
        // About ten columns, each rounded to integer electrons at either end.
        assert!((sum(&bloomed) - sum(&stamp)).abs() < 20.0, "{}", sum(&bloomed) - sum(&stamp));
        // The star has 16 times the full well, spread over about ten columns; four of them hold most of it.
        let radius_px = stamp.truth(20.0, 15.0, f64::INFINITY).radius_px;
        assert!(stamp.height_px(15.7) <= radius_px && bloomed.height_px(15.7) > 1.5 * radius_px);
        let faint = star(&sensor, 1e3);
        assert!(!sensor.bloom_stamp(&faint, peak_e(&faint), 20.0, &mut bloomed));
    }
}
