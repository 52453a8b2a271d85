//! The target as the camera observes it: brightness, size, detection probability, and longest exposure
//! without over-exposure.
use contract::{CameraFrame, Direction, Icrs, OutOfRange, PixelPoint, Rotation, Target};
use far_range::FarRangeScenario;
use hifitime::{Epoch, Unit};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rayon::prelude::*;
use sim::SimError;
use sim::optics::ImagePoint;
use sim::scene::{Appearance, Lighting, Spacecraft, TargetConfig};
use sim::truth::{Observer, OrbitConfig, RelativeElements, Schedule, States, Trajectory, shadow};

use crate::camera::{CameraModel, moving_point};
use crate::detection_model::detection::{ImageShares, background_e, is_flooded};
use crate::requirement::{DetectionRule, ExposureTable, MotionGuidance, MotionTable, TargetLight};

/// Astronomical unit, km (IAU 2012 Resolution B2).
const AU_KM: f64 = 149_597_870.7;
/// Largest number of points that a body's image consists of; limited because the image is computed many
/// times.
const POINTS: usize = 1 << 10;

/// Illumination and attitude of the body at one time, independent of the range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aspect {
    /// Unit vector from the camera to the body.
    line_of_sight: Vector3<f64>,
    /// Vector from the body to the Sun, km.
    sun_km: Vector3<f64>,
    sunlit_fraction: f64,
    target_from_icrs: Option<Rotation<Target, Icrs>>,
    /// Angle Sun–target–camera, degrees.
    pub phase_deg: f64,
    /// Conditions under which a simulation has this aspect.
    pub setting: Setting,
}

/// Conditions under which a simulation has a given aspect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setting {
    /// A phase angle, with the body rotated by Euler angles 123 from the axes R, T, N of its orbit, degrees.
    Phase {
        /// Euler angles φ, θ, ψ, degrees.
        turn_deg: [f64; 3],
    },
    /// A time on the scenario's orbit.
    Moment {
        /// Time of the aspect.
        time: Epoch,
    },
}

/// The target body, with all its aspects.
#[derive(Debug, Clone)]
pub struct TargetModel {
    body: Spacecraft,
    aspects: Vec<Aspect>,
}

impl TargetModel {
    /// Prepares the body under a given illumination.
    ///
    /// # Errors
    /// [`SimError`] for a body, an orbit or a time that is not allowed, and for an orbit that is never
    /// sunlit.
    pub fn new(
        body: &TargetConfig,
        light: &TargetLight,
        scenario: Option<&FarRangeScenario>,
    ) -> Result<Self, SimError> {
        let prepared = Spacecraft::new(body)?;
        let aspects = match (light, scenario) {
            (TargetLight::Phases { phases_deg, attitudes }, _) => {
                let turns = if body.attitude().is_some() { *attitudes } else { 1 };
                phases_deg.iter().flat_map(|phase| (0..turns).map(|i| at_phase(*phase, i, turns))).collect()
            }
            (TargetLight::Orbit { moments }, Some(scenario)) => along_orbit(&prepared, scenario, *moments)?,
            (TargetLight::Orbit { .. }, None) => Vec::new(),
        };
        if aspects.is_empty() {
            let expected = "an orbit on which the target is lit";
            return Err(OutOfRange::new("target.light", "never sunlit", expected).into());
        }
        Ok(Self { body: prepared, aspects })
    }

    /// Returns the aspects up to a phase angle; all aspects without one.
    pub fn aspects(&self, phase_max_deg: Option<f64>) -> Vec<Aspect> {
        let within = |aspect: &&Aspect| phase_max_deg.is_none_or(|most| aspect.phase_deg <= most + 1e-9);
        self.aspects.iter().filter(within).copied().collect()
    }

    /// Returns the appearance of the target to the camera from `range_km`.
    pub fn signal(&self, camera: &CameraModel, aspect: &Aspect, range_km: f64) -> TargetSignal {
        let chaser_km = -aspect.line_of_sight * range_km;
        let sun_km = aspect.sun_km;
        let lighting = Lighting { chaser_km, sun_km, sunlit_fraction: aspect.sunlit_fraction };
        let appearance = self.body.appearance(&lighting, aspect.target_from_icrs);
        let centre = camera.projection.project(&Direction::z()).unwrap_or_default();
        let e_per_s = appearance
            .magnitude()
            .map_or(0.0, |m| camera.radiometry.sunlit(m) * camera.vignetting.transmission(centre));
        let projector = aspect.projector(camera, range_km);
        let peak_e_per_s = e_per_s * appearance.peak_share(&projector, camera.psf.peak_share());
        TargetSignal { e_per_s, peak_e_per_s, centre, magnitude: appearance.magnitude(), appearance }
    }
}

/// Appearance of the target to a camera that points at it.
#[derive(Debug, Clone)]
pub struct TargetSignal {
    /// Photoelectrons per second.
    pub e_per_s: f64,
    /// Photoelectrons per second of the brightest pixel, as the shutter control computes them.
    pub peak_e_per_s: f64,
    /// V magnitude; `None` when the target reflects no light.
    pub magnitude: Option<f64>,
    centre: PixelPoint,
    appearance: Appearance,
}

impl TargetSignal {
    /// Returns the longest exposure that does not over-expose the target, s; practically unlimited when the
    /// target reflects no light.
    pub fn longest_s(&self, camera: &CameraModel, exposure: &ExposureTable) -> f64 {
        exposure.target_level * camera.config.sensor.saturation_e() / self.peak_e_per_s.max(1e-30)
    }
}

impl Aspect {
    /// Returns the map from a point of the body frame, m, to the image of a camera that points at its origin
    /// from `range_km`.
    fn projector<'a>(
        &'a self,
        camera: &'a CameraModel,
        range_km: f64,
    ) -> impl Fn(&Vector3<f64>) -> Option<PixelPoint> + 'a {
        let camera_from_icrs = looking_along(&self.line_of_sight);
        move |point_m: &Vector3<f64>| {
            let turned_m = self.target_from_icrs.map_or(*point_m, |turn| turn.inverse().rotate(point_m));
            let from_camera_km = self.line_of_sight * range_km + turned_m / 1000.0;
            camera.projection.project(&(camera_from_icrs * Direction::from_vector(from_camera_km).ok()?))
        }
    }

    /// Returns the probability that the target is detected in one exposure, over a background of
    /// `background_e_per_s`.
    pub fn chance(
        &self,
        signal: &TargetSignal,
        watch: &TargetObservation<'_>,
        range_km: f64,
        exposure_s: f64,
        background_e_per_s: f64,
    ) -> f64 {
        let camera = watch.camera;
        let background_e = background_e(camera, exposure_s, background_e_per_s);
        if is_flooded(camera, watch.rule, background_e) {
            return 0.0;
        }
        let threshold = camera.threshold(watch.rule.thresholds(camera, background_e).high_dn);
        let electrons = signal.e_per_s * exposure_s;
        let mut body = Vec::new();
        signal.appearance.image(&self.projector(camera, range_km), POINTS, &mut body);
        let trail_px = match watch.motion.guidance {
            MotionGuidance::Inertial => camera.trail_px(watch.motion, exposure_s),
            MotionGuidance::LocalOrbital => 0.0,
        };
        let mut points = Vec::new();
        for along in moving_point(signal.centre, trail_px) {
            points.extend(body.iter().map(|point| {
                let (dx, dy) = (along.position.x - signal.centre.x, along.position.y - signal.centre.y);
                let position = PixelPoint::new(point.position.x + dx, point.position.y + dy);
                ImagePoint { position, share: point.share * along.share }
            }));
        }
        ImageShares::from_points(camera, &points).chance(&threshold, electrons, background_e)
    }
}

/// Observation conditions of a target: camera, detection rule, motion and background.
#[derive(Debug, Clone, Copy)]
pub struct TargetObservation<'a> {
    /// Camera that observes the target.
    pub camera: &'a CameraModel,
    /// Rule for counting an object as detected.
    pub rule: &'a DetectionRule,
    /// Motion of the camera, which smears the image.
    pub motion: &'a MotionTable,
    /// Background, electrons per second and pixel.
    pub background_e_per_s: f64,
}

impl TargetObservation<'_> {
    /// Returns the probability that the target is detected from a range, with all aspects equally likely; 0
    /// without aspects.
    pub fn chance(&self, target: &TargetModel, aspects: &[Aspect], range_km: f64, exposure_s: f64) -> f64 {
        let of = |aspect: &Aspect| {
            let signal = target.signal(self.camera, aspect, range_km);
            aspect.chance(&signal, self, range_km, exposure_s, self.background_e_per_s)
        };
        let chances: Vec<f64> = aspects.par_iter().map(of).collect();
        chances.iter().sum::<f64>() / chances.len().max(1) as f64
    }
}

/// Returns the longest exposure that does not over-expose the target, s, for each aspect, in ascending order;
/// not limited to the exposures that the camera can command.
pub(super) fn longest_unsaturated_exposures_s(
    camera: &CameraModel,
    target: &TargetModel,
    aspects: &[Aspect],
    range_km: f64,
    exposure: &ExposureTable,
) -> Vec<f64> {
    let longest = |aspect| target.signal(camera, aspect, range_km).longest_s(camera, exposure);
    let mut all: Vec<f64> = aspects.iter().map(longest).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// Returns the longest exposure, s, that does not over-expose the target with a given probability, from
/// sorted exposures.
pub(super) fn longest_with_probability(sorted_s: &[f64], probability: f64) -> f64 {
    // Number of aspects that may be over-exposed.
    let spared = ((1.0 - probability) * sorted_s.len() as f64 + 1e-9).floor() as usize;
    sorted_s.get(spared.min(sorted_s.len().saturating_sub(1))).copied().unwrap_or(0.0)
}

/// Returns the attitude of a camera that points along a direction, at an arbitrary roll.
fn looking_along(line_of_sight: &Vector3<f64>) -> Rotation<CameraFrame, Icrs> {
    let axis = if line_of_sight.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let x = line_of_sight.cross(&axis).normalize();
    Rotation::from_axes(&x, &line_of_sight.cross(&x), line_of_sight)
}

/// Returns attitude `i` of `count` at a phase angle, from super-Fibonacci spirals, which spread rotations
/// evenly (Alexa 2022, Proc. CVPR, 8291). The line of sight is along T of the body's orbit, the Sun is on the
/// side of R.
fn at_phase(phase_deg: f64, i: u32, count: u32) -> Aspect {
    let (sin, cos) = libm::sincos(phase_deg.to_radians());
    let (s, n) = (f64::from(i) + 0.5, f64::from(count));
    let (near, far) = ((s / n).sqrt(), (1.0 - s / n).sqrt());
    let (sin_a, cos_a) = libm::sincos(std::f64::consts::TAU * s / std::f64::consts::SQRT_2);
    let (sin_b, cos_b) = libm::sincos(std::f64::consts::TAU * s / 1.533_751_168_755_204_3);
    let quaternion = Quaternion::new(far * cos_b, near * sin_a, near * cos_a, far * sin_b);
    let turn: Rotation<Target, Icrs> =
        Rotation::from_unit_quaternion(UnitQuaternion::from_quaternion(quaternion));
    let (phi, theta, psi) = turn.euler_123();
    Aspect {
        line_of_sight: Vector3::y(),
        sun_km: Vector3::new(sin, -cos, 0.0) * AU_KM,
        sunlit_fraction: 1.0,
        target_from_icrs: Some(turn),
        phase_deg,
        setting: Setting::Phase { turn_deg: [phi, theta, psi].map(|angle| angle.degrees()) },
    }
}

/// Returns the scenario's orbit with the camera purely along the track, `range_km` behind or ahead as in the
/// scenario, without manoeuvres.
pub(super) fn along_track(orbit: &OrbitConfig, range_km: f64) -> OrbitConfig {
    let side = if orbit.relative.a_dlambda_m > 0.0 { 1.0 } else { -1.0 };
    let relative = RelativeElements { a_dlambda_m: side * range_km * 1000.0, ..RelativeElements::default() };
    OrbitConfig { relative, manoeuvres: Vec::new(), ..orbit.clone() }
}

/// Returns the aspects at times of the scenario, evenly spread over its frames, at which the target is fully
/// sunlit.
fn along_orbit(
    body: &Spacecraft,
    scenario: &FarRangeScenario,
    moments: u32,
) -> Result<Vec<Aspect>, SimError> {
    /// Range at which the geometry is computed, km: the camera and the target are at most a degree of the
    /// orbit apart.
    const RANGE_KM: f64 = 10.0;
    let orbit = scenario.orbit.as_ref().ok_or_else(|| {
        let expected = "a table [orbit] in camera.scenario for target.light.kind \"orbit\"";
        OutOfRange::new("orbit", "missing", expected)
    })?;
    let trajectory = Trajectory::new(&along_track(orbit, RANGE_KM))?;
    let schedule = Schedule::new(&scenario.schedule)?;
    let frames = schedule.frame_count();
    let mut aspects = Vec::new();
    for i in 0..u64::from(moments) {
        let number = u128::from(frames) * (2 * u128::from(i) + 1) / (2 * u128::from(moments));
        let Some((_, time)) = schedule.frame(number as u64) else { continue };
        let states: States = trajectory.states_at(time + 0.0 * Unit::Second);
        let observer = Observer::new(time, states.chaser.position_km, states.chaser.velocity_km_s)?;
        let earth_to_sun_km = states.chaser.position_km + observer.sun_km();
        let sunlit_fraction = shadow::sunlit_fraction(&states.target.position_km, &earth_to_sun_km);
        if sunlit_fraction < 1.0 {
            continue;
        }
        let line_of_sight = states.line_of_sight_km().normalize();
        let sun_km = earth_to_sun_km - states.target.position_km;
        let lighting = Lighting { chaser_km: -line_of_sight, sun_km, sunlit_fraction };
        aspects.push(Aspect {
            line_of_sight,
            sun_km,
            sunlit_fraction,
            target_from_icrs: body.attitude(&states),
            phase_deg: lighting.phase_rad().to_degrees(),
            setting: Setting::Moment { time },
        });
    }
    Ok(aspects)
}
