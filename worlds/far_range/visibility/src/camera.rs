//! Camera that requirements are about: its description, and the simulator models prepared from it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use contract::{Camera, PixelPoint};
use far_range::{CameraPreset, FarRangeScenario};
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

/// Description of a camera for the simulator.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraConfig {
    /// Geometry of the camera.
    pub camera: Camera,
    /// Detector of the camera.
    pub sensor: SensorConfig,
    /// Point-spread function, px.
    pub psf: PsfConfig,
    /// Optical effects that vary over the field.
    pub optics: OpticsConfig,
    /// Conversion of magnitudes to photoelectrons.
    pub radiometry: RadiometryConfig,
    /// Background without a source in the field.
    pub background: BackgroundConfig,
    /// Star catalogue.
    pub catalog: CatalogConfig,
}

impl CameraConfig {
    /// Returns the camera of a scenario.
    pub(crate) fn from_scenario(scenario: &FarRangeScenario) -> Self {
        Self {
            camera: scenario.camera.clone(),
            sensor: scenario.sensor.clone(),
            psf: scenario.psf.clone(),
            optics: scenario.optics.clone(),
            radiometry: scenario.radiometry.clone(),
            background: scenario.background.clone(),
            catalog: scenario.catalog.clone(),
        }
    }

    /// Returns a built-in camera, without background, and with the built-in catalogue.
    pub(crate) fn from_preset(preset: &CameraPreset) -> Self {
        Self {
            camera: preset.camera.clone(),
            sensor: preset.sensor.clone(),
            psf: preset.psf.clone(),
            optics: preset.optics.clone(),
            radiometry: preset.radiometry.clone(),
            background: BackgroundConfig::default(),
            catalog: CatalogConfig::default(),
        }
    }

    /// Returns the value of a parameter; `None` for a parameter that the camera does not have.
    pub fn value(&self, parameter: Parameter) -> Option<f64> {
        match (parameter, &self.radiometry) {
            (Parameter::FocalLengthMm, _) => Some(self.camera.focal_length_mm),
            (Parameter::ApertureDiameterMm, RadiometryConfig::Spectral { aperture_diameter_mm, .. }) => {
                Some(*aperture_diameter_mm)
            }
            _ => None,
        }
    }

    /// Returns the camera with another value of a parameter. An exposure changes nothing, nor does an
    /// aperture if the aperture of the camera is unknown.
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

/// A camera, prepared by the models of the simulator.
#[derive(Debug)]
pub struct CameraModel {
    /// Description of the camera.
    pub config: CameraConfig,
    /// Projection of directions to the detector.
    pub projection: Projection,
    /// Point-spread function.
    pub psf: Psf,
    /// Losses of the optics over the field.
    pub vignetting: Vignetting,
    /// Conversion of magnitudes to photoelectrons per second.
    pub radiometry: Radiometry,
    /// Smooth background; `None` when all its parts are off.
    pub background: Option<Background>,
    /// Dark current of an ordinary pixel, electrons per second.
    pub dark_e_per_s: f64,
    /// Cache of pixel detection models by threshold, DN: computing a model takes longer than evaluating it.
    thresholds: Mutex<BTreeMap<u32, Arc<PixelThreshold>>>,
}

impl CameraModel {
    /// Checks and prepares a camera. Its paths are relative to the current directory.
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
        // The dark current depends on the detector's temperature; a sensor of one pixel suffices.
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

    /// Returns the detection model of the camera's pixels for a threshold, DN, a non-negative integer.
    pub fn threshold(&self, threshold_dn: f64) -> Arc<PixelThreshold> {
        // A thread that panicked while computing one model leaves the other models intact.
        let mut known = self.thresholds.lock().unwrap_or_else(PoisonError::into_inner);
        let threshold = || Arc::new(PixelThreshold::new(&self.config.sensor, threshold_dn));
        Arc::clone(known.entry(threshold_dn.max(0.0) as u32).or_insert_with(threshold))
    }

    /// Returns the length of the trail, px along x, that the orbital motion causes for an object that is not
    /// at rest during an exposure. It applies at the boresight and grows towards the edge of a wide field.
    pub fn trail_px(&self, motion: &MotionTable, exposure_s: f64) -> f64 {
        let (x_px_per_rad, _) = self.projection.plate_scale_px_per_rad();
        mean_motion_rad_s(motion.semi_major_axis_km) * exposure_s * x_px_per_rad
    }
}

/// Returns the mean motion of a circular orbit without the Earth's oblateness, rad/s.
pub fn mean_motion_rad_s(semi_major_axis_km: f64) -> f64 {
    let a = semi_major_axis_km;
    (EARTH_GM_KM3_S2 / (a * a * a)).sqrt()
}

/// Returns the points of an image that is at `centre` in the middle of an exposure and moves by `trail_px`
/// along x during the exposure.
pub(super) fn moving_point(centre: PixelPoint, trail_px: f64) -> Vec<ImagePoint> {
    let mut points = Vec::new();
    let at = |side: f64| PixelPoint::new(centre.x + side * trail_px, centre.y);
    trail(at(-0.5), centre, at(0.5), &mut points);
    points
}
