//! Figures of a relative orbit determination.

use std::collections::BTreeMap;

use contract::navigation::RelativeElements;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::row::NavigationRow;

/// Error of the distance, relative to the distance, below which an estimation counts as converged.
const CONVERGED: f64 = 0.01;

/// Error of one component over the estimates, in the unit of the component.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Root mean square of the error.
    pub rms: f64,
    /// Mean of the error.
    pub mean: f64,
    /// Largest size of the error.
    pub largest: f64,
    /// Root mean square of the reported standard deviation.
    pub sigma_rms: f64,
    /// Fraction of the errors within three standard deviations, 0 to 1.
    pub within_3_sigma: f64,
}

impl Axis {
    /// Returns the figures of pairs of error and standard deviation; `None` without a pair.
    fn new(pairs: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let (mut count, mut within) = (0_u64, 0_u64);
        let (mut sum, mut squares, mut variances, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
        for (error, sigma) in pairs {
            count += 1;
            within += u64::from(error.abs() <= 3.0 * sigma);
            sum += error;
            squares += error * error;
            variances += sigma * sigma;
            largest = largest.max(error.abs());
        }
        let of = count as f64;
        (count > 0).then(|| Self {
            rms: (squares / of).sqrt(),
            mean: sum / of,
            largest,
            sigma_rms: (variances / of).sqrt(),
            within_3_sigma: within as f64 / of,
        })
    }
}

/// Number of measurements by their use.
pub type MeasurementUse = BTreeMap<String, u64>;

/// Estimates at times when a manoeuvre had been flown and its report had not arrived. The navigator does not
/// receive it, so that neither error nor σ of these estimates measures the navigator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BeforeReport {
    /// Number of these estimates.
    pub estimates: u64,
    /// Mean normalised squared error of position and velocity per dimension, over the other estimates.
    pub others_nees_state_per_dimension: Option<f64>,
    /// Mean normalised squared error of the position per dimension, over the other estimates.
    pub others_nees_position_per_dimension: Option<f64>,
}

impl BeforeReport {
    /// Computes the figures of rows, each with a mark if it is before a report; `None` without a mark.
    fn new(rows: &[NavigationRow], marks: &[bool]) -> Option<Self> {
        let has_estimate = |row: &&NavigationRow| row.position_error_m.is_some();
        let (mut marked, mut others) = (0, Vec::new());
        for (row, mark) in rows.iter().zip(marks).filter(|(row, _)| has_estimate(row)) {
            if *mark {
                marked += 1;
            } else {
                others.push(row);
            }
        }
        (marked > 0).then(|| Self {
            estimates: marked,
            others_nees_state_per_dimension: mean(&others, |row| Some(row.nees_state? / 6.0)),
            others_nees_position_per_dimension: mean(&others, |row| Some(row.nees_position? / 3.0)),
        })
    }
}

/// Figures of a relative orbit determination. A figure without data is absent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NavigationScore {
    /// Number of requested times.
    pub requested: u64,
    /// Number of times with an estimate.
    pub estimates: u64,
    /// Number of times without an estimate, by reason.
    pub unanswered: BTreeMap<String, u64>,
    /// Number of measurements by their use.
    pub measurements: MeasurementUse,
    /// Errors of the position along the target's R, T, N, m.
    pub position_m: IndexMap<String, Axis>,
    /// Errors of the velocity along R, T, N in the rotating frame, m/s.
    pub velocity_m_s: IndexMap<String, Axis>,
    /// Errors of the mean relative elements, m.
    pub elements_m: IndexMap<String, Axis>,
    /// Root mean square of the error of the position along R, T, N, m, by UTC day.
    pub position_rms_by_day_m: IndexMap<String, [f64; 3]>,
    /// Mean normalised squared error of position and velocity per dimension; 1 for a consistent covariance.
    pub nees_state_per_dimension: Option<f64>,
    /// Mean normalised squared error of the position per dimension.
    pub nees_position_per_dimension: Option<f64>,
    /// Mean normalised squared error of the elements per dimension.
    pub nees_elements_per_dimension: Option<f64>,
    /// Estimates of a sequential navigator between a manoeuvre and its report; absent if there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub before_report: Option<BeforeReport>,
    /// Root mean square of the error of the distance, percent of the distance.
    pub range_error_rms_percent: Option<f64>,
    /// Size of the error of the distance at the last estimate, percent of the distance.
    pub range_error_end_percent: Option<f64>,
    /// Time from the first requested time until the error of the distance stays below 1 % of the distance at
    /// all later estimates, s; absent if it does not at the last one.
    pub convergence_s: Option<f64>,
}

impl NavigationScore {
    /// Computes the figures of all rows, each with a mark if it is between a manoeuvre and its report.
    pub(crate) fn new(rows: &[NavigationRow], before_report: &[bool], measurements: MeasurementUse) -> Self {
        let estimated: Vec<&NavigationRow> =
            rows.iter().filter(|row| row.position_error_m.is_some()).collect();
        let mut unanswered = BTreeMap::new();
        for row in rows.iter().filter(|row| row.position_error_m.is_none()) {
            *unanswered.entry(row.status.clone()).or_insert(0) += 1;
        }
        let relative: Vec<f64> = estimated
            .iter()
            .filter_map(|row| Some(row.range_error_m()?.abs() / row.true_range_m()))
            .collect();
        let squares: f64 = relative.iter().map(|x| x * x).sum();
        let rms = (!relative.is_empty()).then(|| 100.0 * (squares / relative.len() as f64).sqrt());
        Self {
            requested: rows.len() as u64,
            estimates: estimated.len() as u64,
            unanswered,
            measurements,
            position_m: components(&estimated, &RTN, |row| row.position_error_m.zip(row.position_sigma_m)),
            velocity_m_s: components(&estimated, &RTN, |row| {
                row.velocity_error_m_s.zip(row.velocity_sigma_m_s)
            }),
            elements_m: components(&estimated, &RelativeElements::NAMES, |row| {
                row.elements_error_m.zip(row.elements_sigma_m)
            }),
            position_rms_by_day_m: position_rms_by_day_m(&estimated),
            nees_state_per_dimension: mean(&estimated, |row| Some(row.nees_state? / 6.0)),
            nees_position_per_dimension: mean(&estimated, |row| Some(row.nees_position? / 3.0)),
            nees_elements_per_dimension: mean(&estimated, |row| Some(row.nees_elements? / 6.0)),
            before_report: BeforeReport::new(rows, before_report),
            range_error_rms_percent: rms,
            range_error_end_percent: relative.last().map(|last| 100.0 * last),
            convergence_s: convergence_s(rows),
        }
    }
}

/// Names of the axes.
const RTN: [&str; 3] = ["r", "t", "n"];

fn components<const N: usize>(
    rows: &[&NavigationRow],
    names: &[&str; N],
    of: impl Fn(&NavigationRow) -> Option<([f64; N], [f64; N])>,
) -> IndexMap<String, Axis> {
    let pairs: Vec<Vec<(f64, f64)>> = rows
        .iter()
        .filter_map(|row| of(row))
        .map(|(errors, sigmas)| errors.into_iter().zip(sigmas).collect())
        .collect();
    let axis = |(index, name): (usize, &&str)| {
        let component = pairs.iter().filter_map(|row| row.get(index).copied());
        Some(((*name).to_owned(), Axis::new(component)?))
    };
    names.iter().enumerate().filter_map(axis).collect()
}

/// Returns the RMS of the position error along R, T and N, m, by day (the date of UTC).
fn position_rms_by_day_m(rows: &[&NavigationRow]) -> IndexMap<String, [f64; 3]> {
    let mut days: IndexMap<String, (f64, [f64; 3])> = IndexMap::new();
    for row in rows {
        let Some(errors) = row.position_error_m else { continue };
        let day: String = row.time_utc.chars().take(10).collect();
        let (count, squares) = days.entry(day).or_insert((0.0, [0.0; 3]));
        *count += 1.0;
        squares.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error);
    }
    days.into_iter().map(|(day, (count, squares))| (day, squares.map(|sum| (sum / count).sqrt()))).collect()
}

fn mean(rows: &[&NavigationRow], of: impl Fn(&NavigationRow) -> Option<f64>) -> Option<f64> {
    let values: Vec<f64> = rows.iter().filter_map(|row| of(row)).collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

fn convergence_s(rows: &[NavigationRow]) -> Option<f64> {
    let first = rows.first()?.time()?;
    let is_converged = |row: &NavigationRow| {
        row.range_error_m().is_some_and(|error| error.abs() < CONVERGED * row.true_range_m())
    };
    let from = rows.iter().rposition(|row| !is_converged(row)).map_or(0, |place| place + 1);
    Some((rows.get(from)?.time()? - first).to_seconds())
}

#[cfg(test)]
mod tests {
    use super::*;
    use hifitime::{Epoch, Unit};

    fn row(minute: f64, error: Option<[f64; 3]>) -> NavigationRow {
        NavigationRow {
            time_utc: files::format_utc(
                Epoch::from_gregorian_utc_at_midnight(2012, 4, 26) + Unit::Minute * minute,
            ),
            status: if error.is_some() { "estimated" } else { "no_initial_orbit" }.to_owned(),
            true_position_m: [0.0, -1000.0, 0.0],
            position_error_m: error,
            position_sigma_m: error.map(|_| [1.0, 10.0, 1.0]),
            velocity_error_m_s: error.map(|_| [0.0; 3]),
            velocity_sigma_m_s: error.map(|_| [1.0; 3]),
            state_correlations: None,
            true_elements_m: [0.0; 6],
            elements_error_m: error.map(|_| [0.0; 6]),
            elements_sigma_m: error.map(|_| [1.0; 6]),
            nees_state: error.map(|_| 6.0),
            nees_position: error.map(|_| 1.5),
            nees_elements: None,
        }
    }

    #[test]
    fn figures_follow_from_errors_by_hand() {
        let rows = [
            row(0.0, None),
            row(1.0, Some([0.0, -40.0, 0.0])),
            row(2.0, Some([3.0, 5.0, 0.0])),
            row(1440.0, Some([-4.0, -9.0, 0.0])),
        ];
        let score = NavigationScore::new(&rows, &[false; 4], MeasurementUse::new());
        assert_eq!(score.before_report, None);
        assert_eq!((score.requested, score.estimates), (4, 3));
        assert_eq!(score.unanswered["no_initial_orbit"], 1);
        let [r, t] = ["r", "t"].map(|axis| score.position_m[axis]);
        assert!((r.rms - (25.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!((r.mean + 1.0 / 3.0).abs() < 1e-12);
        assert_eq!((r.largest, r.sigma_rms), (4.0, 1.0));
        assert!((r.within_3_sigma - 2.0 / 3.0).abs() < 1e-12);
        assert!((t.within_3_sigma - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(score.nees_state_per_dimension, Some(1.0));
        assert_eq!(score.nees_position_per_dimension, Some(0.5));
        assert_eq!(score.nees_elements_per_dimension, None);
        // A negative error of T is a longer distance: 4 % at first, then −0.5 % and 0.9 %.
        assert!((score.range_error_end_percent.unwrap() - 0.9).abs() < 1e-3);
        assert_eq!(score.convergence_s, Some(120.0));
        assert_eq!(score.position_rms_by_day_m["2012-04-27"], [4.0, 9.0, 0.0]);
    }

    #[test]
    fn estimates_before_a_report_are_counted_apart() {
        let mut rows = [row(0.0, None), row(1.0, Some([0.0; 3])), row(2.0, Some([9.0; 3]))];
        rows[2].nees_state = Some(600.0);
        rows[2].nees_position = Some(300.0);
        let score = NavigationScore::new(&rows, &[true, false, true], MeasurementUse::new());
        assert_eq!(score.nees_state_per_dimension, Some(50.5));
        let expected = BeforeReport {
            estimates: 1,
            others_nees_state_per_dimension: Some(1.0),
            others_nees_position_per_dimension: Some(0.5),
        };
        assert_eq!(score.before_report, Some(expected));
    }

    #[test]
    fn without_an_estimate_there_is_no_figure() {
        let score = NavigationScore::new(&[row(0.0, None)], &[true], MeasurementUse::new());
        assert!(score.position_m.is_empty() && score.convergence_s.is_none());
        assert_eq!(score.range_error_rms_percent, None);
    }

    #[test]
    fn an_estimation_that_diverges_has_no_convergence_time() {
        let rows = [row(0.0, Some([0.0; 3])), row(1.0, Some([0.0, 30.0, 0.0]))];
        assert_eq!(NavigationScore::new(&rows, &[], MeasurementUse::new()).convergence_s, None);
    }
}
