//! Magnitude of the faintest star that a camera detects.

use contract::PixelPoint;
use optics::{Psf, Stamp};

use crate::Simulator;

/// Limits of the searched magnitudes.
const MAX_MAGNITUDE: f64 = 40.0;
const MIN_MAGNITUDE: f64 = -10.0;
/// Number of bisection steps within a magnitude, for an accuracy of 1e-3.
const HALVINGS: usize = 10;

impl Simulator {
    /// V magnitude of the faintest Sun-like star whose image, at rest in the middle of the detector, has a
    /// signal-to-noise ratio of `snr`, as defined in the truth table, in an exposure of `exposure_s`;
    /// accurate to 1e-3. `None` if no magnitude from −10 to 40 reaches it. Only the part of the background
    /// that is equal in all directions is included.
    pub fn limiting_magnitude(&self, exposure_s: f64, snr: f64) -> Option<f64> {
        let (columns, rows) = self.projection.detector();
        // At the centre of a pixel.
        let centre = PixelPoint::new((columns / 2) as f64, (rows / 2) as f64);
        let (sensor, transmission) = (&self.sensor, self.vignetting.transmission(centre));
        let background_e = sensor.sky_electrons(exposure_s) + sensor.dark_electrons(exposure_s);
        let (mut psf, mut stamp) = (self.psf.clone(), Stamp::new());
        let mut is_seen = |magnitude: f64| {
            let electrons = self.radiometry.sunlit(magnitude) * exposure_s * transmission;
            psf.stamp(centre, electrons, Psf::FLOOR_E, (columns, rows), &mut stamp);
            let truth = stamp.truth(background_e, sensor.readout_noise_e(), sensor.config().saturation_e());
            truth.snr >= snr
        };
        // Searched from the faint side: a bright star fills the detector, and its image takes long to draw.
        let steps = (MAX_MAGNITUDE - MIN_MAGNITUDE) as usize;
        let mut seen = (0..=steps).map(|step| MAX_MAGNITUDE - step as f64).find(|m| is_seen(*m))?;
        let mut step = 1.0;
        for _ in 0..HALVINGS {
            step *= 0.5;
            if is_seen(seen + step) {
                seen += step;
            }
        }
        Some(seen)
    }
}
