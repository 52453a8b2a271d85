//! Knowledge of the chaser besides its measurements: its orbit, a prior, errors of its instruments.

use std::f64::consts::TAU;

use contract::navigation::{
    AngleErrors, ChaserOrbit, Covariance6, DifferentialDrag, LineOfSightErrors, NavigationSetup, PriorOrbit,
    RelativeElements, ReportedState, SlowError,
};
use contract::{AttitudeKnowledge, ContractError};
use files::Failure;
use hifitime::{Duration, Epoch};
use nalgebra::{Vector3, Vector6};
use scenario::FarRangeScenario;
use sim::onboard::ScanOrder;
use sim::randomness::{Effect, Seed, Stream, normal};
use sim::truth::{EARTH_GM_KM3_S2, State, Trajectory};

use crate::truth::Truth;

/// Standard deviation of the centre of brightness about the centre of the target, relative to its radius:
/// that of a sphere at a phase angle of 90° is 0.4 to 0.6, that of a plate seen face on 0.
const BRIGHTNESS_OFFSET: f64 = 0.3;

/// Memory of that error, s: the side of the target that is seen and lit turns with the orbit.
const BRIGHTNESS_MEMORY_S: f64 = 5900.0;

/// Part of that error that repeats with every orbit, relative to the whole, and its memory, s: the Sun and
/// the attitude in the orbital frame change within weeks. A navigator takes it for a relative eccentricity.
const PERIODIC_SHARE: f64 = 0.3;
const PERIODIC_MEMORY_S: f64 = 1e6;

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

/// Constant error of a line of sight with an attitude from stars, arcsec: distortion and alignment that the
/// stars do not remove.
const STARS_CONSTANT_ARCSEC: f64 = 1.0;

/// Standard deviation of a centre that has no covariance of its own, px.
const CENTRE_SIGMA_PX: f64 = 0.1;

/// Shortest time over which states are reported, s: a navigator fits an orbit to them.
const MIN_STATES_S: f64 = 900.0;

/// Largest number of reported states.
const MAX_STATES: f64 = 1e6;

/// Memories of the error by regions that cut the target, s, each of a half of its variance: the size of the
/// target's image follows its illumination, which turns with the orbit, and its distance, which changes
/// within days.
const TRUNCATION_MEMORY_S: [f64; 2] = [BRIGHTNESS_MEMORY_S, 86_400.0];

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
    /// Builds the setup of a navigator for measurements at `times`, in order; the first is the epoch. States
    /// and prior are those of the truth with errors drawn from the scenario's seed.
    ///
    /// # Errors
    /// [`Failure::Usage`] if the true orbits have no elements at the first time.
    pub(crate) fn setup(
        &self,
        scenario: &FarRangeScenario,
        truth: &Truth,
        times: &[Epoch],
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
            errors: errors(scenario, truth, times, method),
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
/// calibration, of an attitude from stars those of the target's centre of brightness, as an angle at the
/// smallest distance.
fn errors(scenario: &FarRangeScenario, truth: &Truth, times: &[Epoch], method: Method) -> LineOfSightErrors {
    let calibration = scenario.calibration();
    let radius_m = calibration.target.map_or(0.0, |target| target.radius_m);
    let nearest_m = times
        .iter()
        .map(|time| truth.trajectory().states_at(*time).range_km() * 1000.0)
        .fold(f64::INFINITY, f64::min);
    let arcsec = (BRIGHTNESS_OFFSET * radius_m / nearest_m).to_degrees() * 3600.0;
    let brightness = (arcsec > 0.0).then_some(SlowError {
        sigma_arcsec: [arcsec.min(36_000.0); 2],
        memory_s: BRIGHTNESS_MEMORY_S,
        period_s: None,
    });
    let pixel_arcsec =
        (scenario.camera.pixel_width_um * 1e-3 / scenario.camera.focal_length_mm).to_degrees() * 3600.0;
    let centre_arcsec = (CENTRE_SIGMA_PX * pixel_arcsec).min(36_000.0);
    let omitted = OMITTED_FIELD_MEMORY_S.map(|memory_s| SlowError {
        sigma_arcsec: [OMITTED_FIELD_ARCSEC; 2],
        memory_s,
        period_s: None,
    });
    let omitted = omitted.into_iter().filter(|_| !truth.has_mean_elements());
    let periodic = brightness.zip(times.first()).map(|(irregular, first)| SlowError {
        sigma_arcsec: irregular.sigma_arcsec.map(|sigma| PERIODIC_SHARE * sigma),
        memory_s: PERIODIC_MEMORY_S,
        period_s: Some(orbital_period_s(&truth.trajectory().states_at(*first).target).clamp(1.0, 1e9)),
    });
    let slow: Vec<SlowError> = brightness.into_iter().chain(periodic).chain(omitted).collect();
    let solved = AngleErrors {
        white_arcsec: [centre_arcsec; 2],
        slow: slow.clone(),
        constant_arcsec: [STARS_CONSTANT_ARCSEC; 3],
    };
    let Some(attitude) = calibration.attitude else {
        return LineOfSightErrors { with_stars: solved.clone(), without_stars: solved };
    };
    let truncation = match method {
        Method::StarAttitude => Vec::new(),
        Method::StarMounting => truncation(scenario),
    };
    let slow = slow.into_iter().chain(truncation).collect();
    let without_stars = of_telemetry(scenario, &attitude, centre_arcsec, slow);
    let with_stars = match method {
        Method::StarAttitude => solved,
        Method::StarMounting => {
            AngleErrors { constant_arcsec: [MOUNTING_CONSTANT_ARCSEC; 3], ..without_stars.clone() }
        }
    };
    LineOfSightErrors { with_stars, without_stars }
}

/// Returns the error of a centroid in a region of interest that cuts the target, for a pipeline that states
/// no error of its own. A region of n rows below the first bright row keeps the upper n rows of a taller
/// target, up to twice as tall: then a second region begins. The centroid errs by 0 to n/2 rows, with equal
/// probability, and the root of the mean square is n/(2√3) (paper, section 4: the truncation by regions
/// is the largest error of the declination). A scan by columns cuts columns.
fn truncation(scenario: &FarRangeScenario) -> Vec<SlowError> {
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
    let part = |memory_s| SlowError { sigma_arcsec: halved, memory_s, period_s: None };
    TRUNCATION_MEMORY_S.map(part).into()
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
