//! Scenario files.

mod attitude;
mod coverage;
mod published;
mod trajectory;

use contract::{
    AttitudeKnowledge, Calibration, Camera, OutOfRange, PsfCalibration, Readout, TargetCalibration, bounds,
};
use draws::Seed;
use files::Failure;
use flight_dynamics::Coverage;
use hifitime::Epoch;
use pipeline::far_range::FarRangeConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::Simulation;
use sim::catalog::{CatalogConfig, CatalogSource};
use sim::onboard::{RoiConfig, ShutterConfig};
use sim::optics::{OpticsConfig, PsfConfig, Radiometry, RadiometryConfig, SUN_B_MINUS_V, SUN_V_MAG_AT_1_AU};
use sim::scene::{BackgroundConfig, TargetConfig};
use sim::sensor::{SensorConfig, Switch};
use sim::truth::{
    Attitude, AttitudeConfig, GroupConfig, Guidance, KnowledgeConfig, ManoeuvreReportsConfig, MountingConfig,
    OrbitConfig, Schedule, Trajectory, TrajectorySource,
};

pub use self::published::is_argon;
pub use self::trajectory::TrajectoryConfig;

use scenario::{AttitudeChoice, scenario_file};

use self::attitude::{attitude_profile, attitude_remarks};
use self::coverage::{NeededTimes, Reach};

/// A far-range scenario, in the form of its TOML file. Units are in the names; unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FarRangeScenario {
    /// Code of the world, "far_range", which is the default.
    #[serde(default)]
    pub world: FarRangeWorld,
    /// Title of the scenario, one line.
    pub title: String,
    /// Seed of all random draws except the detector's fixed pattern.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Stars that are drawn.
    #[serde(default)]
    pub catalog: CatalogConfig,
    /// Stars in the list for the pipeline.
    pub star_list: StarListConfig,
    /// Orbits of target and chaser; absent when files of `[trajectory]` give the motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orbit: Option<OrbitConfig>,
    /// Origin of the motion of chaser and target; absent: the mean elements of `[orbit]`.
    #[serde(default)]
    pub trajectory: TrajectoryConfig,
    /// Times of the images, group by group.
    pub schedule: Vec<GroupConfig>,
    /// Pointing of the chaser, and its accuracy.
    pub attitude: AttitudeConfig,
    /// Attitude errors of the telemetry.
    pub knowledge: KnowledgeConfig,
    /// Mounting of the camera on the chaser, true and by calibration.
    pub mounting: MountingConfig,
    /// Geometry of the camera.
    pub camera: Camera,
    /// Point-spread function of the optics.
    pub psf: PsfConfig,
    /// Variation of the optics over the field: vignetting, sharpness; absent: none.
    #[serde(default)]
    pub optics: OpticsConfig,
    /// Conversion from magnitudes to photoelectrons.
    pub radiometry: RadiometryConfig,
    /// Background without a source in the field: zodiacal light, faint stars, stray light; absent: none.
    #[serde(default)]
    pub background: BackgroundConfig,
    /// Detector.
    pub sensor: SensorConfig,
    /// Control of the exposure time.
    pub shutter: ShutterConfig,
    /// Regions of interest kept on board; absent: whole images are transmitted.
    pub roi: Option<RoiConfig>,
    /// Zero suppression of whole images: pixels up to this digital number, 0 to 65535, are transmitted as 0,
    /// and only pixels above it are drawn; absent: every pixel is. A pipeline must not use values below it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zero_suppression_dn: Option<u16>,
    /// Target spacecraft as a light source.
    pub target: TargetConfig,
    /// Drawing of the Moon and the planets, "on" or "off" (the default). They are in no star list.
    #[serde(default = "off")]
    pub solar_system: Switch,
    /// Scoring of outcomes, without effect on the simulation.
    #[serde(default)]
    pub score: ScoreConfig,
    /// Calibration given to the pipeline, which overrides the values derived from the tables above; absent:
    /// all values are derived.
    #[serde(default)]
    pub calibration: Calibration,
    /// Parameters of the pipeline `far_range`.
    #[serde(default)]
    pub far_range: FarRangeConfig,
}

/// Scoring of outcomes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScoreConfig {
    /// Angular limits of "within one pixel" and "within two" on both axes, degrees, ascending, each 1e-6 to
    /// 180; absent: one and two pixels of the camera, each axis with its own scale.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = 1e-6, max = 180)))]
    pub within_deg: Option<[f64; 2]>,
    /// Attitude granted to measurements that have only a centroid; absent: none, and these measurements have
    /// no line of sight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude: Option<AttitudeChoice>,
    /// Number of first frames, in which the pipeline starts up. They form a separate group, `warm-up`; all
    /// other figures exclude them.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1_u64 << 40))]
    pub warm_up_frames: u64,
}

impl ScoreConfig {
    /// Checks all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first invalid value.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "score")?;
        let Some([one, two]) = self.within_deg else { return Ok(()) };
        bounds::require("score.within_deg[1]", two, format!("more than {one}"), |two| two > one)
    }
}

/// World of a [`FarRangeScenario`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FarRangeWorld {
    /// Star fields with a distant spacecraft.
    #[default]
    FarRange,
}

fn off() -> Switch {
    Switch::Off
}

/// Star list uploaded to the pipeline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StarListConfig {
    /// Faintest star of the list, V magnitude, −2 to 15.
    #[schemars(range(min = -2, max = 15))]
    pub magnitude_limit: f64,
}

/// Standard deviation of the nominal mounting about each axis, arcsec: calibration on ground followed by the
/// launch.
const MOUNTING_SIGMA_ARCSEC: f64 = 180.0;

/// Reflectance assumed for a spacecraft of unknown reflectance.
const GREY_REFLECTANCE: f64 = 0.25;

scenario_file!(FarRangeScenario, "far_range", crate::STARTING_POINT, paths_of_files);

impl FarRangeScenario {
    fn paths_of_files(&mut self) -> Vec<(&'static str, &mut String)> {
        let catalog = match &mut self.catalog.source {
            CatalogSource::File(path) => Some(("catalog.source", path)),
            CatalogSource::Hipparcos2 => None,
        };
        let psf = match &mut self.psf {
            PsfConfig::Sampled { path, .. } => Some(("psf.path", path)),
            _ => None,
        };
        let attitude = match &mut self.attitude.guidance {
            Guidance::Aem { file } => Some(("attitude.guidance.file", file)),
            _ => None,
        };
        let mesh = self.target.paths();
        catalog.into_iter().chain(psf).chain(attitude).chain(self.trajectory.paths()).chain(mesh).collect()
    }

    /// Returns the motion of chaser and target.
    ///
    /// # Errors
    /// A [`Failure`] for an invalid orbit or schedule, or a file that cannot be read.
    pub fn trajectory(&self) -> Result<Trajectory, Failure> {
        let schedule = Schedule::new(&self.schedule)?;
        Ok(Trajectory::from_source(&self.trajectory_source(Some(&schedule))?, self.seed, &schedule)?)
    }

    /// Returns the errors of the reports of manoeuvres.
    pub fn manoeuvre_reports(&self) -> ManoeuvreReportsConfig {
        let reports = match &self.trajectory {
            TrajectoryConfig::Opm { reports, .. } => *reports,
            _ => self.orbit.as_ref().and_then(|orbit| orbit.reports),
        };
        reports.unwrap_or_default()
    }

    /// Checks that `[orbit]` is present if and only if it gives the motion.
    ///
    /// # Errors
    /// [`OutOfRange`] for the table.
    pub fn check_orbit(&self) -> Result<(), OutOfRange> {
        self.trajectory.check_orbit(self.orbit.as_ref())
    }

    /// Returns the true attitude of the chaser; `epoch` is that of the trajectory.
    ///
    /// # Errors
    /// A [`Failure`] for an invalid attitude or mounting, or a file that cannot be read.
    pub fn true_attitude(&self, epoch: Epoch) -> Result<Attitude, Failure> {
        let schedule = Schedule::new(&self.schedule)?;
        let profile = attitude_profile(&self.attitude, Some(&schedule), self.reach())?;
        let seed = Seed { seed: self.seed, case: 0 };
        Ok(Attitude::new(&self.attitude, &self.mounting, seed)?.with_profile(profile, epoch)?)
    }

    /// Returns the span about the middle of an exposure in which motion and attitude have an effect.
    pub fn needed_about(&self, time: Epoch) -> Coverage {
        self.reach().about(time)
    }

    /// Returns remarks on unusual motion and attitudes in the files of the scenario, each with file and line.
    pub fn motion_remarks(&self) -> Vec<String> {
        let schedule = Schedule::new(&self.schedule).ok();
        let needed = schedule.and_then(|schedule| NeededTimes::of_schedule(&schedule, self.reach()));
        let mut remarks = self.trajectory.remarks(needed);
        remarks.extend(attitude_remarks(&self.attitude));
        remarks
    }

    fn trajectory_source(&self, schedule: Option<&Schedule>) -> Result<TrajectorySource, Failure> {
        let needed = schedule.and_then(|schedule| NeededTimes::of_schedule(schedule, self.reach()));
        self.trajectory.source(self.orbit.as_ref(), needed)
    }

    fn reach(&self) -> Reach {
        Reach::new(&self.shutter, &self.sensor, &self.knowledge)
    }

    /// Returns the input of the simulator.
    ///
    /// # Errors
    /// A [`Failure`] for a file of the trajectory that cannot be read.
    pub fn simulation(&self) -> Result<Simulation, Failure> {
        Ok(Simulation {
            seed: self.seed,
            catalog: self.catalog.clone(),
            // An invalid schedule is reported by the simulator, with its location.
            trajectory: self.trajectory_source(Schedule::new(&self.schedule).ok().as_ref())?,
            schedule: self.schedule.clone(),
            attitude: self.attitude.clone(),
            attitude_profile: attitude_profile(
                &self.attitude,
                Schedule::new(&self.schedule).ok().as_ref(),
                self.reach(),
            )?,
            knowledge: self.knowledge.clone(),
            mounting: self.mounting,
            camera: self.camera.clone(),
            psf: self.psf.clone(),
            optics: self.optics.clone(),
            radiometry: self.radiometry.clone(),
            background: self.background.clone(),
            sensor: self.sensor.clone(),
            shutter: self.shutter.clone(),
            roi: self.roi.clone(),
            zero_suppression_dn: self.zero_suppression_dn,
            target: self.target.clone(),
            solar_system: self.solar_system,
        })
    }

    /// Returns the calibration given to a pipeline: values derived from optics, detector, radiometry and
    /// attitude knowledge, overridden by the stated values.
    ///
    /// The point-spread function is derived only for Gaussian ones, the brightness scale only for a valid
    /// radiometry. The nominal mounting is assumed to be known to 180″ about each axis.
    pub fn calibration(&self) -> Calibration {
        let psf = match self.psf {
            PsfConfig::Gaussian { sigma_px } => {
                Some(PsfCalibration { sigma_px, halo_sigma_px: 4.0, halo_fraction: 0.0 })
            }
            PsfConfig::GaussianHalo { sigma_px, halo_sigma_px, halo_fraction } => {
                Some(PsfCalibration { sigma_px, halo_sigma_px, halo_fraction })
            }
            _ => None,
        };
        let knowledge = &self.knowledge;
        let slow_period_s = knowledge.drift.periods_s.iter().copied().fold(f64::INFINITY, f64::min);
        let derived = Calibration {
            // The ranges of a calibration are narrower than those of a scenario: a point-spread function
            // outside them is left out, other values are clamped.
            psf: psf.filter(|psf| bounds::check(psf, "psf").is_ok()),
            full_well_e: Some(self.sensor.full_well_e.clamp(1.0, 1e9)),
            spill_fraction: Some(self.sensor.blooming.map_or(0.0, |blooming| blooming.spill_fraction)),
            response_sigma: Some(self.sensor.fixed_pattern.prnu_fraction),
            zero_magnitude_e_per_s: Radiometry::new(&self.radiometry)
                .ok()
                .map(|radiometry| radiometry.zero_point_e_per_s(Some(SUN_B_MINUS_V), None)),
            target: self.target_calibration(),
            attitude: Some(AttitudeKnowledge {
                white_arcsec: knowledge.noise_arcsec,
                slow_arcsec: knowledge.drift.rms_arcsec,
                slow_period_s: if slow_period_s.is_finite() { slow_period_s } else { 1e9 },
                constant_arcsec: knowledge.bias_arcsec.map(|bias| {
                    (bias * bias + MOUNTING_SIGMA_ARCSEC * MOUNTING_SIGMA_ARCSEC).sqrt().min(36_000.0)
                }),
            }),
        };
        derived.replaced_by(self.calibration)
    }

    /// Returns size and brightness of the target, to a factor of two: those of a Lambert sphere of the same
    /// size at a phase angle of 90° (for plates and meshes, with a reflectance of 0.25).
    fn target_calibration(&self) -> Option<TargetCalibration> {
        let radiometry = Radiometry::new(&self.radiometry).ok()?;
        let sunlit = |radius_m: f64, reflectance: f64| {
            // 2/3 of the reflectance at full phase, 1/π of that at 90°.
            let share =
                2.0 / 3.0 * reflectance / std::f64::consts::PI * (radius_m * 1e-3) * (radius_m * 1e-3);
            let e_per_s_at_1_km = radiometry.sunlit(SUN_V_MAG_AT_1_AU) * share;
            TargetCalibration { radius_m, e_per_s_at_1_km: e_per_s_at_1_km.clamp(1e-3, 1e18) }
        };
        Some(match &self.target {
            TargetConfig::Beacon { magnitude_at_1_km } => TargetCalibration {
                radius_m: 0.0,
                e_per_s_at_1_km: radiometry.sunlit(*magnitude_at_1_km).clamp(1e-3, 1e18),
            },
            TargetConfig::LambertSphere { radius_m, albedo } => sunlit(*radius_m, *albedo),
            TargetConfig::Plates { boxes, plates, .. } => {
                let sides = boxes.iter().flat_map(|cuboid| cuboid.size_m);
                let sides = sides.chain(plates.iter().flat_map(|plate| [plate.width_m, plate.height_m]));
                sunlit(0.5 * sides.fold(0.0, f64::max), GREY_REFLECTANCE)
            }
            TargetConfig::Mesh(mesh) => sunlit(mesh.radius_m, GREY_REFLECTANCE),
        })
    }

    /// Returns the conversion of the detector's electrons to digital numbers, in the form of the calibration
    /// for a pipeline.
    pub fn readout(&self) -> Readout {
        let sensor = &self.sensor;
        // Read noise can lower a pixel at full well: a pixel counts as full from five standard deviations
        // below.
        let full_dn =
            sensor.bias_dn + (sensor.full_well_e - 5.0 * sensor.read_noise_e) / sensor.gain_e_per_dn;
        Readout {
            gain_e_per_dn: sensor.gain_e_per_dn,
            bias_dn: sensor.bias_dn,
            read_noise_e: sensor.read_noise_e,
            saturation_dn: full_dn.floor().clamp(1.0, f64::from(sensor.full_scale_dn())) as u16,
        }
    }
}
