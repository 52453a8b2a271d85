//! Built-in navigators, driven through the events of a campaign.

use std::collections::BTreeMap;
use std::path::Path;

use contract::navigation::{Answer, Mode, Navigator, NavigatorFactory};
use files::Failure;
use hifitime::{Duration, Epoch};
use nalgebra::{SMatrix, SVector, Vector6};
use navigation::{BatchConfig, BatchFactory, ModelErrors, SequentialConfig, SequentialFactory};

use crate::campaign::Campaign;
use crate::result::NavigationResult;
use crate::row::NavigationRow;
use crate::score::NavigationScore;
use crate::truth::Truth;

/// Interval of the estimates, s, if none is given.
pub const EVERY_S: f64 = 600.0;

/// Largest number of estimation times.
const MAX_ESTIMATES: f64 = 1e5;

/// A built-in navigator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Estimator {
    /// Least squares over all measurements.
    #[default]
    Batch,
    /// Filter: each answer from the measurements until then.
    Sequential,
}

/// Relative accelerations that secular J2 with a constant differential drag omits, as impulses of the batch
/// and as noise of the filter: the density of the air varies along the orbit and with the Sun, and radiation
/// pressure differs between the satellites by 1e-8 m/s², which adds up to 5e-5 m/s within an orbit.
const MODEL_ERRORS: ModelErrors = ModelErrors { interval_s: 5_400.0, sigma_rtn_m_s: [5e-5; 3] };
const VELOCITY_NOISE_M_S: [f64; 3] = [4e-5; 3];

impl Estimator {
    /// Returns the name used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Batch => "batch",
            Self::Sequential => "sequential",
        }
    }

    /// Returns the built-in navigator of this name.
    pub fn parse(code: &str) -> Option<Self> {
        [Self::Batch, Self::Sequential].into_iter().find(|estimator| estimator.code() == code)
    }

    /// Returns the factory of the navigator for a campaign.
    pub fn factory(self, campaign: &Campaign) -> Box<dyn NavigatorFactory> {
        let truth = &campaign.truth;
        let osculation = truth.osculation();
        let is_exact = truth.has_mean_elements();
        match self {
            Self::Batch => {
                let model_errors = (!is_exact).then_some(MODEL_ERRORS);
                let config = BatchConfig { osculation, model_errors, ..BatchConfig::default() };
                Box::new(BatchFactory { config })
            }
            Self::Sequential => {
                let velocity_noise_m_s_per_hour = if is_exact { [0.0; 3] } else { VELOCITY_NOISE_M_S };
                let config = SequentialConfig {
                    osculation,
                    velocity_noise_m_s_per_hour,
                    ..SequentialConfig::default()
                };
                Box::new(SequentialFactory { config })
            }
        }
    }
}

/// Runs a built-in navigator on a campaign, and scores its answers as [`navigate_with`] does.
///
/// # Errors
/// Those of [`navigate_with`].
pub fn navigate(
    campaign: &Campaign,
    estimator: Estimator,
    every_s: f64,
) -> Result<NavigationResult, Failure> {
    navigate_with(campaign, estimator.factory(campaign).as_ref(), estimator.code(), every_s)
}

/// Runs a navigator called `name` on a campaign, and scores its answers from the first to the last line of
/// sight, every `every_s` seconds and at the last one.
///
/// # Errors
/// [`Failure::Usage`] for an interval that is not positive or results in more than 100000 times;
/// [`Failure::Contract`] for a setup outside its ranges, or a navigator that cannot be built or started.
pub fn navigate_with(
    campaign: &Campaign,
    factory: &dyn NavigatorFactory,
    name: &str,
    every_s: f64,
) -> Result<NavigationResult, Failure> {
    let times = times(campaign, every_s)?;
    let mut navigator = factory.build(&campaign.setup)?;
    let answers = answers(campaign, navigator.as_mut(), factory.mode(), &times);
    let rows = times
        .iter()
        .zip(answers)
        .map(|(time, answer)| row(&campaign.truth, *time, answer))
        .collect::<Result<Vec<_>, Failure>>()?;
    let before_report: Vec<bool> = match factory.mode() {
        Mode::Batch => Vec::new(),
        Mode::Sequential => times.iter().map(|time| campaign.awaits_report(*time)).collect(),
    };
    let mut uses = BTreeMap::new();
    for disposition in navigator.dispositions() {
        *uses.entry(disposition.used.code().to_owned()).or_insert(0) += 1;
    }
    Ok(NavigationResult {
        scenario: campaign.name.clone(),
        hash: campaign.hash.clone(),
        estimator: name.to_owned(),
        measurements_file: campaign.measurements_file.as_ref().map(|path| path.display().to_string()),
        every_s,
        lines_of_sight: campaign.lines_of_sight,
        manoeuvres: campaign.manoeuvres,
        score: NavigationScore::new(&rows, &before_report, uses),
        rows,
    })
}

/// Returns the number of estimation times of a run with a line of sight in its first and in its last frame.
///
/// # Errors
/// A [`Failure`] for a `telemetry.csv` that cannot be read.
pub(crate) fn requested_estimates(directory: &Path, every_s: f64) -> Result<u64, Failure> {
    let telemetry = far_range::rows::read_telemetry(&directory.join("telemetry.csv"))?;
    let (Some(first), Some(last)) = (telemetry.first(), telemetry.last()) else { return Ok(0) };
    let intervals = (last.telemetry.time - first.telemetry.time).to_seconds() / every_s;
    // The last line of sight has an estimate of its own.
    Ok(intervals.ceil().clamp(0.0, MAX_ESTIMATES) as u64 + 1)
}

/// Returns the estimation times of a campaign.
pub(crate) fn times(campaign: &Campaign, every_s: f64) -> Result<Vec<Epoch>, Failure> {
    let (first, last) = (campaign.epoch(), campaign.last);
    let span_s = (last - first).to_seconds();
    if !(every_s > 0.0 && every_s.is_finite() && span_s / every_s <= MAX_ESTIMATES) {
        return Err(Failure::Usage(format!(
            "--every is {every_s}, expected a positive interval with at most {MAX_ESTIMATES:.0} times in {span_s:.0} s"
        )));
    }
    let count = (span_s / every_s).floor() as u64;
    let mut times: Vec<Epoch> =
        (0..=count).map(|k| first + Duration::from_seconds(every_s * k as f64)).collect();
    if times.last().is_some_and(|time| *time < last) {
        times.push(last);
    }
    Ok(times)
}

fn answers(campaign: &Campaign, navigator: &mut dyn Navigator, mode: Mode, times: &[Epoch]) -> Vec<Answer> {
    let mut arrivals = campaign.arrivals.iter().peekable();
    match mode {
        Mode::Batch => {
            arrivals.for_each(|arrival| navigator.receive(&arrival.event));
            navigator.estimates(times)
        }
        Mode::Sequential => {
            let mut answers = Vec::with_capacity(times.len());
            for time in times {
                while let Some(arrival) = arrivals.next_if(|arrival| arrival.arrives <= *time) {
                    navigator.receive(&arrival.event);
                }
                answers.extend(navigator.estimates(&[*time]));
            }
            answers
        }
    }
}

/// Returns the normalised squared error; `None` if the covariance is numerically singular.
fn nees<const N: usize>(error: &SVector<f64, N>, covariance: &SMatrix<f64, N, N>) -> Option<f64> {
    // Scaled to correlations, because the units differ by orders of magnitude.
    let sigmas = covariance.diagonal().map(f64::sqrt);
    let correlations = covariance.component_div(&(sigmas * sigmas.transpose()));
    let scaled = error.component_div(&sigmas);
    let squared = scaled.dot(&correlations.cholesky()?.solve(&scaled));
    squared.is_finite().then_some(squared)
}

fn row(truth: &Truth, time: Epoch, answer: Answer) -> Result<NavigationRow, Failure> {
    let (state, elements) = (truth.state(time), truth.elements(time)?.vector());
    let three = |v: &Vector6<f64>, from: usize| -> [f64; 3] { v.fixed_rows::<3>(from).into_owned().into() };
    let mut row = NavigationRow {
        time_utc: files::format_utc(time),
        status: NavigationRow::ESTIMATED.to_owned(),
        true_position_m: three(&state, 0),
        position_error_m: None,
        position_sigma_m: None,
        velocity_error_m_s: None,
        velocity_sigma_m_s: None,
        state_correlations: None,
        true_elements_m: elements.into(),
        elements_error_m: None,
        elements_sigma_m: None,
        nees_state: None,
        nees_position: None,
        nees_elements: None,
    };
    let estimate = match answer {
        Ok(estimate) => estimate,
        Err(reason) => {
            row.status = reason.to_string();
            return Ok(row);
        }
    };
    let (p, v) = (&estimate.position_m, &estimate.velocity_m_s);
    let error = Vector6::new(p.x, p.y, p.z, v.x, v.y, v.z) - state;
    let elements_error = estimate.elements.vector() - elements;
    let (covariance, sigmas) = (estimate.covariance.matrix(), estimate.covariance.sigmas());
    row.position_error_m = Some(three(&error, 0));
    row.velocity_error_m_s = Some(three(&error, 3));
    row.position_sigma_m = Some(three(&sigmas, 0));
    row.velocity_sigma_m_s = Some(three(&sigmas, 3));
    row.state_correlations = Some(NavigationRow::correlations(covariance));
    row.elements_error_m = Some(elements_error.into());
    row.elements_sigma_m = Some(estimate.elements_covariance.sigmas().into());
    row.nees_state = nees(&error, covariance);
    row.nees_position =
        nees(&error.fixed_rows::<3>(0).into_owned(), &covariance.fixed_view::<3, 3>(0, 0).into_owned());
    row.nees_elements = nees(&elements_error, estimate.elements_covariance.matrix());
    Ok(row)
}
