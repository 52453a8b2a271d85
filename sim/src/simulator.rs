//! Simulation configuration, and the checked and prepared simulator.

use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;

use contract::{Body, Camera, CameraFrame, OutOfRange, Rotation};
use draws::Seed;
use hifitime::Unit;
use optics::{OpticsConfig, Projection, Psf, PsfConfig, Radiometry, RadiometryConfig, Vignetting};
use scene::{Background, BackgroundConfig, Spacecraft, StarField, TargetConfig, Vibration};
use sensor::onboard::{RoiConfig, Shutter, ShutterConfig};
use sensor::{CosmicRays, Sensor, SensorConfig};
use truth::catalog::{Catalog, CatalogConfig, CatalogSource};
use truth::memo::Memo;
use truth::{
    Attitude, AttitudeConfig, AttitudeProfile, GroupConfig, Knowledge, KnowledgeConfig, MountingConfig,
    Observer, Schedule, SimError, Switch, Trajectory, TrajectorySource,
};

/// Complete input of the simulator.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// Seed of every random draw except the detector's fixed pattern.
    pub seed: u64,
    /// Selection of the stars to draw.
    pub catalog: CatalogConfig,
    /// Origin of the motion of chaser and target.
    pub trajectory: TrajectorySource,
    /// Times of the images.
    pub schedule: Vec<GroupConfig>,
    /// Pointing of the chaser, and its accuracy.
    pub attitude: AttitudeConfig,
    /// Attitude from a file, which replaces guidance; `None`: that of guidance.
    pub attitude_profile: Option<AttitudeProfile>,
    /// Attitude knowledge in the telemetry.
    pub knowledge: KnowledgeConfig,
    /// Mounting of the camera on the chaser.
    pub mounting: MountingConfig,
    /// Geometry of the camera.
    pub camera: Camera,
    /// Point-spread function.
    pub psf: PsfConfig,
    /// Variation of the optics over the field of view.
    pub optics: OpticsConfig,
    /// Conversion from magnitudes to photoelectrons.
    pub radiometry: RadiometryConfig,
    /// Background light, which has no source in the field of view.
    pub background: BackgroundConfig,
    /// The detector.
    pub sensor: SensorConfig,
    /// Control of the exposure time.
    pub shutter: ShutterConfig,
    /// Regions kept on board; `None` for whole images.
    pub roi: Option<RoiConfig>,
    /// Threshold of zero suppression for whole images, DN: pixels up to this digital number are transmitted
    /// as 0. `None`: every pixel is transmitted unchanged.
    pub zero_suppression_dn: Option<u16>,
    /// The target as a light source.
    pub target: TargetConfig,
    /// Simulation of Moon and planets in the field of view.
    pub solar_system: Switch,
}

/// Checked and prepared simulation; shared by all threads.
#[derive(Debug)]
pub struct Simulator {
    catalog: Catalog,
    pub(crate) stars: Arc<StarField>,
    pub(crate) trajectory: Trajectory,
    pub(crate) schedule: Schedule,
    pub(crate) attitude: Attitude,
    pub(crate) knowledge: Knowledge,
    pub(crate) camera_from_body: Rotation<CameraFrame, Body>,
    pub(crate) projection: Projection,
    pub(crate) psf: Psf,
    pub(crate) vignetting: Vignetting,
    pub(crate) sensor: Sensor,
    pub(crate) cosmic_rays: Option<CosmicRays>,
    pub(crate) shutter: Shutter,
    pub(crate) roi: Option<RoiConfig>,
    pub(crate) zero_suppression_dn: Option<u16>,
    pub(crate) seed: Seed,
    pub(crate) target: Spacecraft,
    pub(crate) solar_system: Switch,
    pub(crate) radiometry: Radiometry,
    pub(crate) background: Option<Background>,
    pub(crate) vibration: Option<Vibration>,
}

impl Simulator {
    /// Checks and prepares a simulation; relative paths in it start from `folder`.
    ///
    /// # Errors
    /// [`SimError`] for the first value that is not allowed, or for a catalogue that cannot be read.
    pub fn new(simulation: &Simulation, folder: &Path) -> Result<Self, SimError> {
        let seed = Seed { seed: simulation.seed, case: 0 };
        let radiometry = Radiometry::new(&simulation.radiometry)?;
        let target = Spacecraft::load(&simulation.target, folder)?;
        // Before the shutter, which requires a checked saturation of the sensor.
        simulation.sensor.check()?;
        let cosmic_rays = simulation.sensor.cosmic_rays.as_ref();
        let cosmic_rays = cosmic_rays.map(|config| CosmicRays::new(config, &simulation.camera));
        let (trajectory, schedule, shutter) =
            flight(simulation, &simulation.sensor, cosmic_rays.as_ref(), &target)?;
        let projection = Projection::new(&simulation.camera)?;
        let vignetting = Vignetting::new(&simulation.optics, &simulation.camera)?;
        let (columns, rows) = projection.detector();
        if let Some(roi) = &simulation.roi {
            roi.check(columns, rows)?;
            if let Some(floor_dn) = simulation.zero_suppression_dn {
                return Err(OutOfRange::new(
                    "zero_suppression_dn",
                    floor_dn,
                    "no value with [roi]: the pixels of regions are transmitted unchanged",
                )
                .into());
            }
        }
        let attitude = Attitude::new(&simulation.attitude, &simulation.mounting, seed)?
            .with_profile(simulation.attitude_profile.clone(), trajectory.epoch())?;
        let camera_from_body = simulation.mounting.actual.camera_from_body();
        let vibration = Vibration::new(attitude.vibration_rad(), &camera_from_body, &projection)?;
        simulation.catalog.check()?;
        let catalog = Catalog::load(&simulation.catalog, folder)?;
        Ok(Self {
            background: Background::new(
                &simulation.background,
                &simulation.camera,
                &projection,
                &radiometry,
            )?
            .map(|background| background.vignetted(&vignetting)),
            stars: star_field(simulation, &catalog, &radiometry),
            catalog,
            attitude,
            trajectory,
            schedule,
            knowledge: Knowledge::new(&simulation.knowledge, seed)?,
            camera_from_body,
            vibration,
            projection,
            vignetting,
            psf: Psf::load(&simulation.psf, folder)?
                .with_growth(simulation.optics.psf_growth, &simulation.camera),
            sensor: Sensor::new(&simulation.sensor, columns, rows)?,
            cosmic_rays,
            shutter,
            roi: simulation.roi.clone(),
            zero_suppression_dn: simulation.zero_suppression_dn,
            seed,
            target,
            solar_system: simulation.solar_system,
            radiometry,
        })
    }

    /// Reuses the simulator for another flight: seed, orbit, schedule, attitude, knowledge, mounting, shutter
    /// and target become those of `simulation`, whose camera, detector, optics and catalogue are ignored. The
    /// result equals that of [`Simulator::new`] for the combined configuration, in a thousandth of the time.
    /// The path of a mesh starts from the working directory.
    ///
    /// # Errors
    /// [`SimError`] for the first value that is not allowed; the simulator is then unchanged.
    pub fn fly(&mut self, simulation: &Simulation) -> Result<(), SimError> {
        let seed = Seed { seed: simulation.seed, case: 0 };
        let target = Spacecraft::new(&simulation.target)?;
        let (trajectory, schedule, shutter) =
            flight(simulation, self.sensor.config(), self.cosmic_rays.as_ref(), &target)?;
        let attitude = Attitude::new(&simulation.attitude, &simulation.mounting, seed)?
            .with_profile(simulation.attitude_profile.clone(), trajectory.epoch())?;
        let knowledge = Knowledge::new(&simulation.knowledge, seed)?;
        let camera_from_body = simulation.mounting.actual.camera_from_body();
        self.vibration = Vibration::new(attitude.vibration_rad(), &camera_from_body, &self.projection)?;
        (self.seed, self.target, self.camera_from_body) = (seed, target, camera_from_body);
        (self.trajectory, self.schedule, self.shutter) = (trajectory, schedule, shutter);
        (self.attitude, self.knowledge) = (attitude, knowledge);
        Ok(())
    }

    /// The stars that are drawn.
    pub fn catalog(&self) -> &Catalog {
        &self.catalog
    }

    /// The target as a source of light and an obstacle.
    pub fn target(&self) -> &Spacecraft {
        &self.target
    }

    /// Times of the images.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// The motion of chaser and target.
    pub fn trajectory(&self) -> &Trajectory {
        &self.trajectory
    }

    /// Shortest and longest exposure that the shutter control may choose, s.
    pub fn exposures_s(&self) -> [f64; 2] {
        [self.shutter.shortest_s(), self.shutter.longest_s()]
    }

    /// The true camera model.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }
}

/// Cache of the stars of embedded catalogues, prepared with a camera's radiometry.
static STAR_FIELDS: Memo<(CatalogConfig, RadiometryConfig), StarField> = Memo::new();

fn star_field(simulation: &Simulation, catalog: &Catalog, radiometry: &Radiometry) -> Arc<StarField> {
    let field = || StarField::new(catalog, radiometry);
    match simulation.catalog.source {
        CatalogSource::Hipparcos2 => {
            let key = (simulation.catalog.clone(), simulation.radiometry.clone());
            let Ok(shared) = STAR_FIELDS.get(key, |_| Ok::<_, Infallible>(field()));
            shared
        }
        // Not cached, because the file may have changed.
        CatalogSource::File(_) => Arc::new(field()),
    }
}

/// Returns trajectory, schedule and shutter, after checking them individually and against each other.
fn flight(
    simulation: &Simulation,
    sensor: &SensorConfig,
    cosmic_rays: Option<&CosmicRays>,
    target: &Spacecraft,
) -> Result<(Trajectory, Schedule, Shutter), SimError> {
    let schedule = Schedule::new(&simulation.schedule)?;
    let trajectory = Trajectory::from_source(&simulation.trajectory, simulation.seed, &schedule)?;
    let shutter = Shutter::new(&simulation.shutter, sensor.saturation_e())?;
    let half_interval_s = sensor.half_interval_s(simulation.camera.rows);
    shutter.check_interval(schedule.shortest_interval_s())?;
    cosmic_rays.map_or(Ok(()), |rays| rays.check_hits(shutter.longest_s()))?;
    check_times(&schedule, &trajectory, shutter.lag_s(), half_interval_s)?;
    if let TargetConfig::Mesh(_) = simulation.target {
        // Not cached, because the file may have changed.
        check_separation(&schedule, &trajectory, target)?;
    } else {
        let key = (simulation.trajectory.clone(), simulation.schedule.clone(), simulation.target.clone());
        APART.get(key, |_| check_separation(&schedule, &trajectory, target))?;
    }
    Ok((trajectory, schedule, shutter))
}

/// Checks that the chaser's position and velocity allow observations at the extreme times: at the time that
/// the shutter control uses for the first frame, and at the first and last frame, whose fields or rows are
/// exposed up to `half_interval_s` before and after. All other times lie between.
fn check_times(
    schedule: &Schedule,
    trajectory: &Trajectory,
    lag_s: f64,
    half_interval_s: f64,
) -> Result<(), SimError> {
    let last = schedule.frame_count().saturating_sub(1);
    for (number, earlier_s) in [(0, lag_s), (0, half_interval_s), (last, -half_interval_s)] {
        let Some((_, time)) = schedule.frame(number) else { continue };
        let states = trajectory.states_at(time - earlier_s * Unit::Second);
        let chaser = states.chaser;
        Observer::new(time - earlier_s * Unit::Second, chaser.position_km, chaser.velocity_km_s)
            .map_err(|error| OutOfRange { path: "schedule".to_owned(), ..error })?;
    }
    Ok(())
}

/// Cache of flights whose frames passed the check of separation.
static APART: Memo<(TrajectorySource, Vec<GroupConfig>, TargetConfig), ()> = Memo::new();

/// Maximum number of frames of a schedule at which the separation is checked; longer schedules are sampled at
/// equal steps.
const SEPARATIONS: usize = 100_000;

/// Checks that the camera is separated from the target, and outside it, in the frames. Frames that are
/// skipped here are checked when they are made.
fn check_separation(
    schedule: &Schedule,
    trajectory: &Trajectory,
    target: &Spacecraft,
) -> Result<(), SimError> {
    let last = schedule.frame_count().saturating_sub(1);
    let step = (schedule.frame_count() / SEPARATIONS as u64) as usize + 1;
    for frame in (0..last).step_by(step).chain([last]) {
        let Some((_, time)) = schedule.frame(frame) else { continue };
        target.check_separation(trajectory.relative_path(), &trajectory.states_at(time), frame)?;
    }
    Ok(())
}
