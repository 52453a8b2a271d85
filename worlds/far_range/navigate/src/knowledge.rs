//! Knowledge of the chaser besides its measurements: its orbit, a prior, errors of its instruments.

use std::f64::consts::TAU;

use contract::navigation::{
    AngleErrors, ChaserOrbit, Covariance6, DifferentialDrag, LineOfSightErrors, NavigationSetup, PriorOrbit,
    RelativeElements, ReportedState, SlowDisplacement, SlowError,
};
use contract::{AttitudeKnowledge, CameraFrame, ContractError, Icrs, Rotation};
use draws::{Effect, Seed, Stream, normal};
use far_range::FarRangeScenario;
use files::Failure;
use hifitime::{Duration, Epoch};
use nalgebra::{Vector3, Vector6};
use sim::onboard::ScanOrder;
use sim::truth::{EARTH_GM_KM3_S2, State, Trajectory, clock, ephemeris};

use crate::truth::Truth;

/// Root mean squares of the parts of the offset of the centre of brightness from the centre of mass along R
/// and N of the orbit, relative to the radius of the target. They are those of spheres and boxes with an
/// attitude fixed in the orbital frame (`research/brightness_offset/run.py`) for an elevation β of the Sun
/// above the plane of the orbit: the constant part along N is the root of the sum of the squares of a fixed
/// value and one times sin β; the two harmonics of the orbit and the remainder are proportional to cos β, the
/// part of the Sun that turns. A navigator takes the first harmonic for a relative eccentricity or
/// inclination.
const BRIGHTNESS_CONSTANT: [f64; 2] = [0.15, 0.1];
const BRIGHTNESS_CONSTANT_BY_SIN: [f64; 2] = [0.0, 0.54];
const BRIGHTNESS_FIRST_BY_COS: [f64; 2] = [0.47, 0.24];
const BRIGHTNESS_SECOND_BY_COS: [f64; 2] = [0.14, 0.1];
const BRIGHTNESS_REMAINDER_BY_COS: [f64; 2] = [0.08, 0.06];

/// Memory of the constant and the periodic parts, s: the Sun moves by a radian in 58 days. As a Gauss–Markov
/// process a part changes by two fifths of its σ in five days, which covers the difference between the
/// osculating period and that of the illumination.
const BRIGHTNESS_MEMORY_S: f64 = 5e6;

/// Memory of the remainder, in periods of the orbit: harmonics from the third on.
const REMAINDER_MEMORY_PERIODS: f64 = 1.0 / 6.0;

/// Parts of the relative orbit that secular J2 and its first-order short-period terms omit (other zonal and
/// tesseral terms, J2², Sun and Moon), as an angle from the target, arcsec, and their memories, s. They move
/// a satellite of a low orbit by hundreds of metres within an orbit and within a day (Kaula 1966, chapter 3);
/// two satellites a distance d apart move relative to each other by this times d/a. 600 m gives 18″. It was
/// chosen by the scenario `argon-numerical`: with 6″ the batch has a NEES of 4.7 there, with 18″ of 1.1.
const OMITTED_FIELD_ARCSEC: f64 = 18.0;
const OMITTED_FIELD_MEMORY_S: [f64; 2] = [1_500.0, 20_000.0];

/// Standard deviation of the rate of aδa by differential drag, m per day: two satellites of unlike area and
/// mass at 750 km.
const DRAG_SIGMA_M_PER_DAY: f64 = 10.0;

/// Constant error of a line of sight with an attitude from stars, px: the camera of a simulated run is known.
/// The bias of such attitudes is below this on the 300 star fields of golden/README.md.
const STARS_CONSTANT_PX: f64 = 0.002;

/// Standard deviation of a centre that has no covariance of its own, px.
const CENTRE_SIGMA_PX: f64 = 0.1;

/// Shortest time over which states are reported, s: a navigator fits an orbit to them.
const MIN_STATES_S: f64 = 900.0;

/// Largest number of reported states.
const MAX_STATES: f64 = 1e6;

/// Memory of the error by regions that cut the target, s: the size of the target's image follows its
/// distance, which changes within days, and its illumination, which turns with the orbit. Each has a half of
/// the variance.
const TRUNCATION_MEMORY_S: f64 = 86_400.0;

/// Constant error of a line of sight with the attitude of telemetry and a mounting from stars, arcsec.
const MOUNTING_CONSTANT_ARCSEC: f64 = 5.0;

/// Largest number of periods of the drift of the attitude in telemetry.
const MAX_PERIODS: usize = 6;

/// Memory of that drift, in periods.
const DRIFT_MEMORY_PERIODS: f64 = 10.0;

/// Use of stars by the pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Method {
    /// The attitude of the camera in each image.
    StarAttitude,
    /// The mounting of the camera, filtered over images; the attitude is that of telemetry.
    StarMounting,
}

/// Knowledge of the chaser about its orbit and the relative orbit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct KnowledgeConfig {
    /// Interval of the reported states of the chaser, s.
    pub state_interval_s: f64,
    /// Standard deviation of each component of a reported position, m.
    pub state_position_sigma_m: f64,
    /// Standard deviation of each component of a reported velocity, m/s.
    pub state_velocity_sigma_m_s: f64,
    /// Standard deviations of the relative elements of the prior, in order, m; `None`: no prior.
    pub prior_sigma_m: Option<[f64; 6]>,
}

impl Default for KnowledgeConfig {
    /// Values of a receiver of satellite navigation, and of a relative orbit from radar on the ground.
    fn default() -> Self {
        Self {
            state_interval_s: 120.0,
            state_position_sigma_m: 10.0,
            state_velocity_sigma_m_s: 0.05,
            prior_sigma_m: Some([2.0, 500.0, 30.0, 30.0, 30.0, 30.0]),
        }
    }
}

impl KnowledgeConfig {
    /// Builds the setup of a navigator for measurements at `times`, in order; the first is the epoch, with
    /// the attitude `camera`. States and prior are those of the truth with errors drawn from the scenario's
    /// seed.
    ///
    /// # Errors
    /// [`Failure::Usage`] if the true orbits have no elements at the first time.
    pub(crate) fn setup(
        &self,
        scenario: &FarRangeScenario,
        truth: &Truth,
        times: &[Epoch],
        camera: Rotation<CameraFrame, Icrs>,
        method: Method,
    ) -> Result<NavigationSetup, Failure> {
        let seed = Seed { seed: scenario.seed, case: 0 };
        let epoch = times.first().copied().unwrap_or_else(|| truth.trajectory().epoch());
        let last = times.last().copied().unwrap_or(epoch);
        let prior = match self.prior_sigma_m {
            None => None,
            Some(sigmas) => Some(prior(sigmas, &truth.elements(epoch)?, seed)?),
        };
        Ok(NavigationSetup {
            epoch,
            chaser_orbit: ChaserOrbit::States(self.states(truth.trajectory(), seed, [epoch, last])?),
            camera_from_body: scenario.mounting.nominal.camera_from_body(),
            prior,
            errors: errors(scenario, truth, times, camera, method),
            drag: DifferentialDrag {
                a_da_rate_m_per_day: 0.0,
                sigma_m_per_day: if truth.has_mean_elements() { 0.0 } else { DRAG_SIGMA_M_PER_DAY },
            },
        })
    }

    fn states(
        &self,
        trajectory: &Trajectory,
        seed: Seed,
        [first, last]: [Epoch; 2],
    ) -> Result<Vec<ReportedState>, Failure> {
        let coverage = trajectory.coverage_s();
        let interval_s = self.state_interval_s;
        let span_s = (last - first).to_seconds().max(MIN_STATES_S);
        let intervals = (span_s / interval_s).ceil() + 1.0;
        if !intervals.is_finite() || intervals > MAX_STATES {
            return Err(Failure::Usage(format!(
                "the chaser reports {intervals:.0} states, expected at most {MAX_STATES:.0}"
            )));
        }
        let (position_sigma_m, velocity_sigma_m_s) =
            (self.state_position_sigma_m, self.state_velocity_sigma_m_s);
        let report = |number: u64| {
            let time = first + Duration::from_seconds(interval_s * number as f64);
            if !coverage.contains(&trajectory.seconds(time)) {
                return None;
            }
            let state = trajectory.states_at(time).chaser;
            let streams = seed.streams(number, Effect::ReportedOrbit);
            let draw = |index: u64| normal(&mut streams.stream_at(index));
            let error = |from: u64| Vector3::new(draw(from), draw(from + 1), draw(from + 2));
            Some(ReportedState {
                time,
                position_km: state.position_km + error(0) * (position_sigma_m * 1e-3),
                velocity_km_s: state.velocity_km_s + error(3) * (velocity_sigma_m_s * 1e-3),
                position_sigma_m,
                velocity_sigma_m_s,
            })
        };
        Ok((0..=intervals as u64).filter_map(report).collect())
    }
}

fn prior(sigmas: [f64; 6], truth: &RelativeElements, seed: Seed) -> Result<PriorOrbit, Failure> {
    let draw = |index: u64| -> f64 {
        let mut stream: Stream = seed.stream(0, Effect::RelativePrior, index);
        normal(&mut stream)
    };
    let errors = Vector6::from_fn(|index, _| draw(index as u64));
    let elements =
        RelativeElements::from_vector(&(truth.vector() + errors.component_mul(&Vector6::from(sigmas))));
    let covariance = Covariance6::from_sigmas(sigmas).map_err(ContractError::OutOfRange)?;
    Ok(PriorOrbit { elements, covariance })
}

/// Returns the errors of the lines of sight: of the attitude in telemetry those of the scenario's
/// calibration; displacements of the target's centre of brightness.
fn errors(
    scenario: &FarRangeScenario,
    truth: &Truth,
    times: &[Epoch],
    camera: Rotation<CameraFrame, Icrs>,
    method: Method,
) -> LineOfSightErrors {
    let calibration = scenario.calibration();
    let radius_m = calibration.target.map_or(0.0, |target| target.radius_m);
    // The chaser's orbit is reported, the Sun is in an almanac; the target's plane is nearly the same.
    let illumination = times.first().map(|first| {
        let orbit = truth.trajectory().states_at(*first).chaser;
        Illumination {
            period_s: orbital_period_s(&orbit),
            sun_elevation_rad: sun_elevation_rad(&orbit, *first),
            columns_to_normal: columns_to_normal(&orbit, camera),
        }
    });
    let displacements = illumination.map_or(Vec::new(), |illumination| illumination.displacements(radius_m));
    let pixel_arcsec =
        (scenario.camera.pixel_width_um * 1e-3 / scenario.camera.focal_length_mm).to_degrees() * 3600.0;
    let centre_arcsec = (CENTRE_SIGMA_PX * pixel_arcsec).min(36_000.0);
    let omitted = OMITTED_FIELD_MEMORY_S.map(|memory_s| SlowError {
        sigma_arcsec: [OMITTED_FIELD_ARCSEC; 2],
        memory_s,
        period_s: None,
    });
    let slow: Vec<SlowError> = omitted.into_iter().filter(|_| !truth.has_mean_elements()).collect();
    let solved = AngleErrors {
        white_arcsec: [centre_arcsec; 2],
        slow: slow.clone(),
        constant_arcsec: [(STARS_CONSTANT_PX * pixel_arcsec).min(36_000.0); 3],
    };
    let Some(attitude) = calibration.attitude else {
        return LineOfSightErrors { with_stars: solved.clone(), without_stars: solved, displacements };
    };
    let truncation = match method {
        Method::StarAttitude => Vec::new(),
        Method::StarMounting => truncation(scenario, illumination.map(|illumination| illumination.period_s)),
    };
    let slow = slow.into_iter().chain(truncation).collect();
    let without_stars = of_telemetry(scenario, &attitude, centre_arcsec, slow);
    let with_stars = match method {
        Method::StarAttitude => solved,
        Method::StarMounting => {
            AngleErrors { constant_arcsec: [MOUNTING_CONSTANT_ARCSEC; 3], ..without_stars.clone() }
        }
    };
    LineOfSightErrors { with_stars, without_stars, displacements }
}

/// Illumination of a target during a campaign.
#[derive(Debug, Clone, Copy)]
struct Illumination {
    /// Period of the orbit, s.
    period_s: f64,
    /// Elevation of the Sun above the plane of the orbit, rad.
    sun_elevation_rad: f64,
    /// Square of the cosine of the angle between the camera's columns and N, in the plane of N and R.
    columns_to_normal: f64,
}

impl Illumination {
    /// Returns the displacements of the centre of brightness of a target with a radius, which is 0 for a
    /// point.
    fn displacements(&self, radius_m: f64) -> Vec<SlowDisplacement> {
        if radius_m <= 0.0 || !self.period_s.is_finite() {
            return Vec::new();
        }
        let part = |relative: [f64; 2], memory_s: f64, period_s: Option<f64>| {
            let [r, n] = relative.map(|relative| relative * relative);
            let of_columns = self.columns_to_normal;
            let variances =
                [of_columns * n + (1.0 - of_columns) * r, of_columns * r + (1.0 - of_columns) * n];
            SlowDisplacement {
                sigma_m: variances.map(|variance| (variance.sqrt() * radius_m).min(1e4)),
                memory_s: memory_s.clamp(1.0, 1e9),
                period_s: period_s.map(|period| period.clamp(1.0, 1e9)),
            }
        };
        let (sin, cos) = libm::sincos(self.sun_elevation_rad);
        let [r, n] = BRIGHTNESS_CONSTANT_BY_SIN.map(|by_sin| by_sin * sin);
        let constant = [libm::hypot(BRIGHTNESS_CONSTANT[0], r), libm::hypot(BRIGHTNESS_CONSTANT[1], n)];
        let by_cos = |parts: [f64; 2]| parts.map(|part| part * cos);
        let period_s = self.period_s;
        vec![
            part(constant, BRIGHTNESS_MEMORY_S, None),
            part(by_cos(BRIGHTNESS_FIRST_BY_COS), BRIGHTNESS_MEMORY_S, Some(period_s)),
            part(by_cos(BRIGHTNESS_SECOND_BY_COS), BRIGHTNESS_MEMORY_S, Some(0.5 * period_s)),
            part(by_cos(BRIGHTNESS_REMAINDER_BY_COS), REMAINDER_MEMORY_PERIODS * period_s, None),
        ]
    }
}

/// Returns the square of the cosine of the angle between the camera's columns and N of the orbit of a state,
/// in the plane of N and R; 0.5 for columns along T.
fn columns_to_normal(state: &State, camera: Rotation<CameraFrame, Icrs>) -> f64 {
    let radial = camera.rotate(&state.position_km.normalize());
    let normal = camera.rotate(&state.position_km.cross(&state.velocity_km_s).normalize());
    let across = normal.x * normal.x + radial.x * radial.x;
    if across > 1e-6 { normal.x * normal.x / across } else { 0.5 }
}

/// Returns the elevation of the Sun above the plane of the orbit of a state, rad; 0, the largest harmonics,
/// outside the years of the ephemeris.
fn sun_elevation_rad(state: &State, time: Epoch) -> f64 {
    ephemeris::earth(clock::tdb_j2000_s(time)).map_or(0.0, |earth| {
        let sun = earth.sun_geocentric_km();
        let normal = state.position_km.cross(&state.velocity_km_s);
        libm::asin((sun.dot(&normal) / (sun.norm() * normal.norm())).clamp(-1.0, 1.0))
    })
}

/// Returns the error of a centroid in a region of interest that cuts the target, for a pipeline that states
/// no error of its own. A region of n rows below the first bright row keeps the upper n rows of a taller
/// target, up to twice as tall: then a second region begins. The centroid errs by 0 to n/2 rows, with equal
/// probability, and the root of the mean square is n/(2√3) (paper, section 4: the truncation by regions
/// is the largest error of the declination). A scan by columns cuts columns.
fn truncation(scenario: &FarRangeScenario, period_s: Option<f64>) -> Vec<SlowError> {
    let Some(roi) = &scenario.roi else { return Vec::new() };
    let rms_arcsec = |side: usize, anchor: usize, pitch_um: f64| {
        let pixel_rad = pitch_um * 1e-3 / scenario.camera.focal_length_mm;
        let pixels = side.saturating_sub(anchor) as f64 / 12.0_f64.sqrt();
        ((pixels * pixel_rad).to_degrees() * 3600.0).min(36_000.0)
    };
    let sigma_arcsec = match roi.scan {
        ScanOrder::Rows => [0.0, rms_arcsec(roi.rows, roi.anchor_row, scenario.camera.pixel_height_um)],
        ScanOrder::Columns => {
            [rms_arcsec(roi.columns, roi.anchor_column, scenario.camera.pixel_width_um), 0.0]
        }
    };
    let halved = sigma_arcsec.map(|sigma| sigma * 0.5_f64.sqrt());
    let period_s = period_s.filter(|period| period.is_finite()).map(|period| period.clamp(1.0, 1e9));
    let part = |period_s| SlowError { sigma_arcsec: halved, memory_s: TRUNCATION_MEMORY_S, period_s };
    vec![part(None), part(period_s)]
}

/// Returns the period of the osculating orbit of a state, s (vis-viva equation).
pub(crate) fn orbital_period_s(state: &State) -> f64 {
    let inverse_axis = 2.0 / state.position_km.norm() - state.velocity_km_s.norm_squared() / EARTH_GM_KM3_S2;
    TAU / (EARTH_GM_KM3_S2 * inverse_axis * inverse_axis * inverse_axis).sqrt()
}

fn of_telemetry(
    scenario: &FarRangeScenario,
    attitude: &AttitudeKnowledge,
    centre_arcsec: f64,
    others: Vec<SlowError>,
) -> AngleErrors {
    let camera_from_body = scenario.mounting.nominal.camera_from_body().matrix();
    // Variances about the body's axes become variances about the camera's. A rotation about x moves the
    // direction along rows, one about y along columns.
    let in_camera = |sigmas: [f64; 3]| {
        let variances = Vector3::from(sigmas).map(|sigma| sigma * sigma);
        (camera_from_body.component_mul(&camera_from_body) * variances).map(f64::sqrt)
    };
    let (white, slow) = (in_camera(attitude.white_arcsec), in_camera(attitude.slow_arcsec));
    let constant = in_camera(attitude.constant_arcsec).map(|sigma| sigma.min(36_000.0));
    let with_centre = |sigma: f64| libm::hypot(sigma, centre_arcsec).min(36_000.0);
    let periods =
        scenario.knowledge.drift.periods_s.iter().filter(|period| **period >= 1.0).take(MAX_PERIODS);
    let share = 1.0 / (periods.clone().count().max(1) as f64).sqrt();
    // Sinusoids of constant amplitude, as far as a few periods are concerned.
    let drift = periods.filter(|_| slow.x.max(slow.y) > 0.0).map(|period| SlowError {
        sigma_arcsec: [slow.y, slow.x].map(|sigma| (share * sigma).min(36_000.0)),
        memory_s: (DRIFT_MEMORY_PERIODS * period).min(1e9),
        period_s: Some(period.min(1e9)),
    });
    AngleErrors {
        white_arcsec: [with_centre(white.y), with_centre(white.x)],
        slow: drift.chain(others).collect(),
        constant_arcsec: constant.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sigmas(elevation_deg: f64, columns_to_normal: f64) -> Vec<[f64; 2]> {
        let sun_elevation_rad = elevation_deg.to_radians();
        let illumination = Illumination { period_s: 6000.0, sun_elevation_rad, columns_to_normal };
        illumination.displacements(0.5).iter().map(|part| part.sigma_m).collect()
    }

    /// The Sun along the normal of the orbit lights the same sides all the time; in its plane, harmonics are
    /// the largest parts.
    #[test]
    fn a_sun_in_the_plane_of_the_orbit_makes_the_centre_of_brightness_wander() {
        let (inside, normal) = (sigmas(0.0, 1.0), sigmas(90.0, 1.0));
        assert!((inside[0][1] - 0.075).abs() < 1e-12 && (inside[1][1] - 0.235).abs() < 1e-12, "{inside:?}");
        assert!(normal[0][0] > 0.27 && normal[0][1] < 0.08, "{normal:?}");
        assert!(normal[1..].iter().flatten().all(|sigma| *sigma < 1e-12), "{normal:?}");
        assert_eq!(sigmas(-60.0, 0.3), sigmas(60.0, 0.3));
        // Columns along R.
        let turned: Vec<[f64; 2]> = sigmas(50.0, 0.0).into_iter().map(|[x, y]| [y, x]).collect();
        assert_eq!(turned, sigmas(50.0, 1.0));
    }

    #[test]
    fn the_columns_of_the_camera_are_compared_with_the_normal_of_the_orbit() {
        // R along y, T along −x, N along z.
        let state = State {
            position_km: Vector3::new(0.0, 7000.0, 0.0),
            velocity_km_s: Vector3::new(-7.5, 0.0, 0.0),
        };
        let camera = |x: Vector3<f64>, z: Vector3<f64>| Rotation::from_axes(&x, &z.cross(&x), &z);
        let forward = Vector3::new(-1.0, 0.0, 0.0);
        assert!((columns_to_normal(&state, camera(Vector3::z(), forward)) - 1.0).abs() < 1e-12);
        assert!(columns_to_normal(&state, camera(Vector3::y(), forward)).abs() < 1e-12);
        let between = Vector3::new(0.0, 3.0_f64.sqrt() / 2.0, 0.5);
        assert!((columns_to_normal(&state, camera(between, forward)) - 0.25).abs() < 1e-12);
        assert!((columns_to_normal(&state, camera(forward, Vector3::z())) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_elevation_of_the_sun_is_its_angle_from_the_plane_of_the_orbit() {
        // On 20 March the Sun is along x; an orbit about x has it at 90°, one about z at 0°.
        let time = Epoch::from_gregorian_utc_hms(2012, 3, 20, 5, 14, 0);
        let state = |velocity_km_s| State { position_km: Vector3::new(0.0, 7000.0, 0.0), velocity_km_s };
        let about_x = sun_elevation_rad(&state(Vector3::new(0.0, 0.0, 7.5)), time).to_degrees();
        assert!((about_x - 90.0).abs() < 0.3, "{about_x}");
        let about_z = sun_elevation_rad(&state(Vector3::new(-7.5, 0.0, 0.0)), time).to_degrees();
        assert!(about_z.abs() < 0.3, "{about_z}");
    }
}
