//! A single picture of the sky: a camera, a direction and a time, without a target.

mod star_names;

use std::path::Path;

use contract::{Camera, Frame};
use files::{Failure, ImageFormat, format_utc};
use hifitime::Epoch;
use scenario::run_file::{FileDigests, RunFile, ScenarioFile as _};
use sim::catalog::CatalogConfig;
use sim::onboard::ShutterConfig;
use sim::scene::{BackgroundConfig, TargetConfig};
use sim::sensor::Switch;
use sim::truth::{
    AttitudeConfig, ControlConfig, GroupConfig, Guidance, KnowledgeConfig, MountingConfig, ObjectTruth,
};
use sim::{Exposure, Simulator};

use crate::camera_preset::CameraSource;
use crate::scenario::FarRangeScenario;
use crate::world::write_image;

pub use star_names::star_name;

/// Magnitude of the target at 1 km: the far-range world has one, and at 10 km this one gives no electron.
const UNSEEN_MAGNITUDE: f64 = 30.0;
/// Name of the picture in the header of its file.
const NAME: &str = "sky";

/// A view of the sky, ICRS.
#[derive(Debug, Clone)]
pub struct SkyView {
    /// Camera.
    pub camera: CameraSource,
    /// Right ascension of the boresight, degrees, 0 to 360.
    pub ra_deg: f64,
    /// Declination of the boresight, degrees, −90 to 90.
    pub dec_deg: f64,
    /// Rotation of the camera about its boresight from x towards y, degrees, −360 to 360; at 0 north is up
    /// and east to the left.
    pub roll_deg: f64,
    /// Exposure time, s, 1e-6 to 1000.
    pub exposure_s: f64,
    /// Middle of the exposure.
    pub time: Epoch,
    /// Seed of the noise.
    pub seed: u64,
}

/// A simulated picture of the sky with its truth.
pub struct SkyPicture {
    simulator: Simulator,
    run_file: RunFile<FarRangeScenario>,
    exposure: Exposure,
}

impl SkyView {
    /// Simulates the picture. The observer is on the orbit of the built-in scenario `starting-point`, which
    /// sets the aberration; zodiacal light, planets and Moon are drawn, the Earth covers no star, and the
    /// camera is at rest.
    ///
    /// # Errors
    /// A [`Failure`] with the location of an invalid value in the file of the camera, or for a time outside
    /// of the ephemerides.
    pub fn expose(&self) -> Result<SkyPicture, Failure> {
        let scenario = self.scenario()?;
        let simulation = scenario.simulation()?;
        let simulator =
            Simulator::new(&simulation, &self.camera.folder).map_err(|error| self.camera.explain(error))?;
        let exposure = simulator.camera().and_then(|mut camera| camera.expose(0));
        let exposure = exposure.map_err(|error| self.camera.explain(error))?;
        let catalog = simulator.catalog().sha256().to_owned();
        let run_file = RunFile::new(NAME, &scenario, FileDigests::new(), Some(&catalog), None)?;
        Ok(SkyPicture { simulator, run_file, exposure })
    }

    /// Returns the scenario of the picture: the starting point with this camera, direction and time.
    fn scenario(&self) -> Result<FarRangeScenario, Failure> {
        let mut scenario = FarRangeScenario::parse(Path::new(NAME), crate::STARTING_POINT)?;
        let time = format_utc(self.time);
        let preset = self.camera.preset.clone();
        scenario.title = format!("The sky by the camera {}", self.camera.name);
        scenario.seed = self.seed;
        scenario.catalog = CatalogConfig::default();
        scenario.solar_system = Switch::On;
        scenario.camera = preset.camera;
        scenario.sensor = preset.sensor;
        scenario.psf = preset.psf;
        scenario.optics = preset.optics;
        scenario.radiometry = preset.radiometry;
        scenario.background = BackgroundConfig { zodiacal: Switch::On, ..BackgroundConfig::default() };
        scenario.shutter = ShutterConfig::Fixed { exposure_s: self.exposure_s };
        scenario.mounting = MountingConfig::default();
        let Self { ra_deg, dec_deg, roll_deg, .. } = *self;
        scenario.attitude = AttitudeConfig {
            guidance: Guidance::Inertial { ra_deg, dec_deg, roll_deg },
            control: ControlConfig::default(),
            motion_smear: Switch::Off,
        };
        scenario.knowledge = KnowledgeConfig::default();
        scenario.target = TargetConfig::Beacon { magnitude_at_1_km: UNSEEN_MAGNITUDE };
        if let Some(orbit) = &mut scenario.orbit {
            orbit.epoch_utc = time.clone();
        }
        scenario.schedule =
            vec![GroupConfig { name: NAME.to_owned(), start_utc: time, cadence_s: 1.0, count: 1 }];
        Ok(scenario)
    }
}

impl SkyPicture {
    /// Returns the pixels.
    pub fn frame(&self) -> &Frame {
        &self.exposure.frame
    }

    /// Returns the truth of all objects in the picture.
    pub fn objects(&self) -> &[ObjectTruth] {
        &self.exposure.objects
    }

    /// Returns the geometry of the camera.
    pub fn camera(&self) -> &Camera {
        &self.run_file.scenario.camera
    }

    /// Returns the angles across and along the picture, degrees; `None` if the camera's distortion cannot be
    /// inverted at its edge.
    pub fn field_deg(&self) -> Option<[f64; 2]> {
        self.simulator.projection().field().map(|field| field.map(contract::Angle::degrees))
    }

    /// Writes the digital numbers to a new file: FITS with world coordinates as those of a rendered dataset,
    /// PNG of 16 bits, or OpenEXR.
    ///
    /// # Errors
    /// A [`Failure`] when the file exists or cannot be written.
    pub fn write(&self, path: &Path, format: ImageFormat) -> Result<(), Failure> {
        write_image(path, format, &self.simulator, &self.run_file, &self.exposure)
    }
}
