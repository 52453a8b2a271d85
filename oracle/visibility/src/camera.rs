//! The camera that requirements are about: its description, and what the simulator prepares of it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use contract::{Camera, PixelPoint};
use sim::SimError;
use sim::catalog::CatalogConfig;
use sim::optics::{
    ImagePoint, OpticsConfig, Projection, Psf, PsfConfig, Radiometry, RadiometryConfig, Vignetting, trail,
};
use sim::scene::{Background, BackgroundConfig};
use sim::sensor::{Sensor, SensorConfig};
use sim::truth::EARTH_GM_KM3_S2;

use crate::detection_model::pixel::PixelThreshold;
use crate::requirement::{MotionTable, Parameter};

/// A camera as the simulator is told of it.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraConfig {
    /// Geometry.
    pub camera: Camera,
    /// The detector.
    pub sensor: SensorConfig,
    /// Point-spread function, in pixels.
    pub psf: PsfConfig,
    /// What of the optics changes over the field.
    pub optics: OpticsConfig,
    /// From magnitudes to photoelectrons.
    pub radiometry: RadiometryConfig,
    /// Light without a source in the field.
    pub background: BackgroundConfig,
    /// The stars that there are.
    pub catalog: CatalogConfig,
}

impl CameraConfig {
    /// The value of a parameter; `None` of what it does not have.
    pub fn value(&self, parameter: Parameter) -> Option<f64> {
        match (parameter, &self.radiometry) {
            (Parameter::FocalLengthMm, _) => Some(self.camera.focal_length_mm),
            (Parameter::ApertureDiameterMm, RadiometryConfig::Spectral { aperture_diameter_mm, .. }) => {
                Some(*aperture_diameter_mm)
            }
            _ => None,
        }
    }

    /// The same camera with another value of a parameter; an exposure, or the aperture of one whose aperture is not known, changes
    /// nothing.
    #[must_use]
    pub fn with(&self, parameter: Parameter, value: f64) -> Self {
        let mut changed = self.clone();
        match (parameter, &mut changed.radiometry) {
            (Parameter::FocalLengthMm, _) => changed.camera.focal_length_mm = value,
            (Parameter::ApertureDiameterMm, RadiometryConfig::Spectral { aperture_diameter_mm, .. }) => {
                *aperture_diameter_mm = value;
            }
            _ => {}
        }
        changed
    }
}

/// A camera, prepared by the simulator's own models.
#[derive(Debug)]
pub struct CameraModel {
    /// As it was described.
    pub config: CameraConfig,
    /// Where directions fall.
    pub projection: Projection,
    /// How light spreads over pixels.
    pub psf: Psf,
    /// What the optics lose over the field.
    pub vignetting: Vignetting,
    /// From magnitudes to photoelectrons a second.
    pub radiometry: Radiometry,
    /// Smooth light; `None` when all of it is off.
    pub background: Option<Background>,
    /// Dark current of an ordinary pixel, electrons a second.
    pub dark_e_per_s: f64,
    /// Laws of its pixels against the thresholds that were asked for: each takes longer than what is then made of it.
    thresholds: Mutex<BTreeMap<u32, Arc<PixelThreshold>>>,
}

impl CameraModel {
    /// Checks and prepares a camera. Paths in it start at the current folder.
    ///
    /// # Errors
    /// [`SimError`] for the first value that is not allowed.
    pub fn new(config: &CameraConfig) -> Result<Self, SimError> {
        let projection = Projection::new(&config.camera)?;
        let vignetting = Vignetting::new(&config.optics, &config.camera)?;
        let radiometry = Radiometry::new(&config.radiometry)?;
        let background = Background::new(&config.background, &config.camera, &projection, &radiometry)?
            .map(|background| background.vignetted(&vignetting));
        config.sensor.check()?;
        // The dark current is a matter of the detector's temperature, which a sensor of one pixel has as well.
        let dark_e_per_s = Sensor::new(
            &SensorConfig {
                hot_pixels: Default::default(),
                fixed_pattern: Default::default(),
                ..config.sensor.clone()
            },
            1,
            1,
        )?
        .dark_electrons(1.0);
        Ok(Self {
            projection,
            psf: Psf::new(&config.psf)?.with_growth(config.optics.psf_growth, &config.camera),
            vignetting,
            radiometry,
            background,
            dark_e_per_s,
            thresholds: Mutex::default(),
            config: config.clone(),
        })
    }

    /// The detection model of its pixels against a threshold, DN, whole and not negative.
    pub fn threshold(&self, threshold_dn: f64) -> Arc<PixelThreshold> {
        // Whoever panicked while making a law has left the others whole.
        let mut known = self.thresholds.lock().unwrap_or_else(PoisonError::into_inner);
        let threshold = || Arc::new(PixelThreshold::new(&self.config.sensor, threshold_dn));
        Arc::clone(known.entry(threshold_dn.max(0.0) as u32).or_insert_with(threshold))
    }

    /// The trail, px along x, that the orbital motion draws of what is not at rest in an exposure: at the boresight, from where it
    /// grows towards the edge of a wide field.
    pub fn trail_px(&self, motion: &MotionTable, exposure_s: f64) -> f64 {
        let (x_px_per_rad, _) = self.projection.plate_scale_px_per_rad();
        mean_motion_rad_s(motion.semi_major_axis_km) * exposure_s * x_px_per_rad
    }
}

/// Mean motion of a circular orbit without the Earth's oblateness, rad/s.
pub fn mean_motion_rad_s(semi_major_axis_km: f64) -> f64 {
    let a = semi_major_axis_km;
    (EARTH_GM_KM3_S2 / (a * a * a)).sqrt()
}

/// The points of an image that stands at `centre` in the middle of an exposure and moves by `trail_px` along x meanwhile.
pub(super) fn moving_point(centre: PixelPoint, trail_px: f64) -> Vec<ImagePoint> {
    let mut points = Vec::new();
    let at = |side: f64| PixelPoint::new(centre.x + side * trail_px, centre.y);
    trail(at(-0.5), centre, at(0.5), &mut points);
    points
}
