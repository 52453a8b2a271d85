//! Plain frame that every simulator of the comparison can make: 160 stars on a flat background, shot, dark
//! and read noise, 12 bit.

use draws::{Effect, Seed, uniform};
use std::error::Error;

use contract::PixelPoint;
use serde_json::{Value, json};
use sim::draw::ExpectedImage;
use sim::optics::{Psf, PsfConfig, Stamp};
use sim::sensor::{
    ExposureInterval, FixedPatternConfig, FrameCharge, PixelSampler, RawImage, Sensor, SensorConfig,
};

pub(crate) const COLUMNS: usize = 752;
pub(crate) const ROWS: usize = 580;
const STARS: usize = 160;
const SIGMA_PX: f64 = 0.8;
const EXPOSURE_S: f64 = 0.25;
const SEED: Seed = Seed { seed: 5, case: 0 };

/// Star of the plain frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Star {
    pub(crate) centre: PixelPoint,
    pub(crate) electrons: f64,
}

/// Parameters of the plain frame.
#[derive(Debug, Clone)]
pub(crate) struct PlainScene {
    pub(crate) stars: Vec<Star>,
    pub(crate) sensor: SensorConfig,
}

impl PlainScene {
    /// Returns the detector of the scenario `argon` without its defects, with dark current and sky of 10 e⁻
    /// each, and stars distributed as on the sky: ten times as many per two magnitudes, from 600 e⁻ (V = 7 in
    /// the scenario `argon`) up to the range of the converter.
    pub(crate) fn new() -> Self {
        let mut stream = SEED.stream(0, Effect::HotPixels, 0);
        let stars = (0..STARS)
            .map(|_| {
                let x = uniform(&mut stream) * COLUMNS as f64 - 0.5;
                let y = uniform(&mut stream) * ROWS as f64 - 0.5;
                // The number of stars brighter than f falls as f^−1.25.
                let electrons = 600.0 * libm::pow(uniform(&mut stream), -0.8);
                Star { centre: PixelPoint::new(x, y), electrons: electrons.min(100_000.0) }
            })
            .collect();
        let sensor = SensorConfig {
            bit_depth: 12,
            gain_e_per_dn: 10.0,
            bias_dn: 40.0,
            full_well_e: 60_000.0,
            read_noise_e: 15.0,
            dark_current_e_per_s: 40.0,
            background_e_per_s: 40.0,
            ..SensorConfig::default()
        };
        Self { stars, sensor }
    }

    /// Returns this scene on a detector whose pixels differ in response and dark current.
    pub(crate) fn uneven(&self) -> Self {
        let fixed_pattern = FixedPatternConfig {
            seed: 7,
            prnu_fraction: 0.01,
            dsnu_fraction: 0.1,
            ..FixedPatternConfig::default()
        };
        Self { sensor: SensorConfig { fixed_pattern, ..self.sensor.clone() }, ..self.clone() }
    }

    /// Returns the parameters of the scene that other simulators need.
    pub(crate) fn to_json(&self) -> Value {
        let stars: Vec<[f64; 3]> =
            self.stars.iter().map(|star| [star.centre.x, star.centre.y, star.electrons]).collect();
        json!({
            "columns": COLUMNS,
            "rows": ROWS,
            "sigma_px": SIGMA_PX,
            "exposure_s": EXPOSURE_S,
            "sensor": self.sensor,
            "stars_x_px_y_px_electrons": stars,
        })
    }

    /// Creates a painter for frames of this scene.
    pub(crate) fn painter(&self) -> Result<PlainPainter, Box<dyn Error>> {
        let sensor = Sensor::new(&self.sensor, COLUMNS, ROWS)?;
        Ok(PlainPainter {
            stars: self.stars.clone(),
            psf: Psf::new(&PsfConfig::Gaussian { sigma_px: SIGMA_PX })?,
            image: sensor.new_expected(),
            stamp: Stamp::new(),
            sampler: sensor.new_sampler(),
            raw: sensor.new_raw(),
            sensor,
        })
    }
}

/// Painter of plain frames; its buffers are reused for the next frame.
pub(crate) struct PlainPainter {
    stars: Vec<Star>,
    sensor: Sensor,
    psf: Psf,
    image: ExpectedImage,
    stamp: Stamp,
    sampler: PixelSampler,
    raw: RawImage,
}

impl PlainPainter {
    /// Returns the digital numbers of a frame. The stars are drawn again for each frame: only buffers and
    /// tables of the noise are kept from the previous frame.
    pub(crate) fn frame(&mut self, number: u64) -> Result<&[u16], Box<dyn Error>> {
        self.image.clear(self.sensor.sky_electrons(EXPOSURE_S));
        for star in &self.stars {
            self.psf.stamp(star.centre, star.electrons, Psf::FLOOR_E, (COLUMNS, ROWS), &mut self.stamp);
            self.image.add(&self.stamp);
        }
        let opening = ExposureInterval { seed: SEED, middle_s: 0.0, exposure_s: EXPOSURE_S };
        let charge = self.sensor.collect(&mut self.image, &opening);
        let collected = FrameCharge { charge: &charge, seed: SEED, frame: number };
        self.sensor.read_out(&collected, &mut self.sampler, &mut self.raw)?;
        Ok(self.raw.dn())
    }
}
