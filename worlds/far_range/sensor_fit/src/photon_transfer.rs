//! Photon transfer: means and variances of all stacks in one adjustment.
//!
//! With the light x = light · time of a level, its exposure time t and the signal u = a x + c t in DN of a
//! linear sensor, the model of a stack is
//!
//! ```text
//! mean     = b + u − k u (u + p) − l u³
//! variance = (1 − 2 k u − 3 l u²)² p u + r
//! ```
//!
//! with the bias b, the response a to light, the dark signal c per second, the curvatures k and l of the
//! response, the inverse gain p in DN per electron and the temporal variance r without charge. The variance
//! is that of Poisson's u/p electrons, seen through the slope of the response (EMVA 1288, photon transfer
//! method, for k = l = 0). k p u is the mean of the square of a Poisson number over its squared mean.

use libm::sqrt;
use nalgebra::{DMatrix, DVector};

/// Parameters of the model, by their positions in [`TransferFit::values`].
pub(crate) const BIAS: usize = 0;
pub(crate) const LIGHT: usize = 1;
pub(crate) const DARK: usize = 2;
pub(crate) const CURVATURE: usize = 3;
pub(crate) const CUBIC: usize = 4;
pub(crate) const INVERSE_GAIN: usize = 5;
pub(crate) const READ_VARIANCE: usize = 6;
const PARAMETERS: usize = 7;

/// Rounds of the adjustment, and of the scatter of the light.
const ROUNDS: usize = 25;
const SCATTER_ROUNDS: usize = 40;

/// Smallest number of levels of light with which the cubic term is adjusted.
const MIN_LEVELS_OF_CUBIC: usize = 5;

/// Moments of a stack as the adjustment takes them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TransferPoint {
    /// Light times seconds; 0 without light.
    pub(crate) exposure: f64,
    /// Exposure time, s.
    pub(crate) time_s: f64,
    /// Mean, DN, with its standard deviation apart from the light's.
    pub(crate) mean: [f64; 2],
    /// Temporal variance before rounding, DN², with its standard deviation.
    pub(crate) variance: Option<[f64; 2]>,
}

/// Result of the adjustment.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TransferFit {
    /// Values of the parameters; 0 for those that are not adjusted.
    pub(crate) values: [f64; PARAMETERS],
    /// True for each parameter that is adjusted.
    pub(crate) is_adjusted: [bool; PARAMETERS],
    /// Covariance of the adjusted parameters, with rows and columns of all.
    covariance: DMatrix<f64>,
    /// Relative standard deviation of the light of a level, with which the means fit.
    pub(crate) light_scatter: f64,
    /// Factor by which the errors of the variances were raised to fit; 1 if they fit.
    pub(crate) variance_factor: f64,
}

/// Signal of a linear sensor, DN.
pub(crate) fn linear_signal(values: &[f64; PARAMETERS], exposure: f64, time_s: f64) -> f64 {
    values[LIGHT] * exposure + values[DARK] * time_s
}

/// Mean for a linear signal, DN.
pub(crate) fn mean_at(values: &[f64; PARAMETERS], u: f64) -> f64 {
    values[BIAS] + u - values[CURVATURE] * u * (u + values[INVERSE_GAIN]) - values[CUBIC] * u * u * u
}

/// Slope of the response at a linear signal.
pub(crate) fn slope_at(values: &[f64; PARAMETERS], u: f64) -> f64 {
    1.0 - 2.0 * values[CURVATURE] * u - 3.0 * values[CUBIC] * u * u
}

/// Temporal variance at a linear signal, DN².
pub(crate) fn variance_at(values: &[f64; PARAMETERS], u: f64) -> f64 {
    let slope = slope_at(values, u);
    slope * slope * values[INVERSE_GAIN] * u + values[READ_VARIANCE]
}

/// Linear signal of a mean, DN, by Newton's method from the mean above the bias.
pub(crate) fn signal_of_mean(values: &[f64; PARAMETERS], mean: f64) -> Option<f64> {
    let mut u = (mean - values[BIAS]).max(0.0);
    for _ in 0..30 {
        let slope = slope_at(values, u);
        if slope < 0.05 {
            return None;
        }
        u = (u + (mean - mean_at(values, u)) / slope).max(0.0);
    }
    ((mean_at(values, u) - mean).abs() < 1e-6 * mean.abs().max(1.0)).then_some(u)
}

impl TransferFit {
    /// Returns a function of the parameters with its standard deviation, by its partial derivatives.
    pub(crate) fn derived(&self, of: impl Fn(&[f64; PARAMETERS]) -> Option<f64>) -> Option<[f64; 2]> {
        let value = of(&self.values)?;
        let mut gradient = DVector::zeros(PARAMETERS);
        for parameter in (0..PARAMETERS).filter(|parameter| self.is_adjusted[*parameter]) {
            let step = 1e-3 * sqrt(self.covariance[(parameter, parameter)]).max(1e-300);
            let at = |sign: f64| {
                let mut values = self.values;
                values[parameter] += sign * step;
                of(&values)
            };
            gradient[parameter] = (at(1.0)? - at(-1.0)?) / (2.0 * step);
        }
        let variance = (gradient.transpose() * &self.covariance * &gradient)[(0, 0)];
        (value.is_finite() && variance.is_finite()).then_some([value, sqrt(variance.max(0.0))])
    }

    /// Value of a parameter with its standard deviation; `None` if it is not adjusted.
    pub(crate) fn parameter(&self, parameter: usize) -> Option<[f64; 2]> {
        if self.is_adjusted[parameter] { self.derived(|values| Some(values[parameter])) } else { None }
    }
}

/// Adjusts the model to the points. `light_scatter` is the known relative scatter of the light between
/// levels; `None` if the points do not determine bias and response.
pub(crate) fn fit_transfer(points: &[TransferPoint], light_scatter: f64) -> Option<TransferFit> {
    let mut is_adjusted = adjusted_parameters(points)?;
    let start = first_values(points)?;
    loop {
        if let Some(fit) = fit_with_scatter(points, &start, is_adjusted, light_scatter) {
            return Some(fit);
        }
        // A singular system: the highest term of the response is given up first.
        let term = [CUBIC, CURVATURE].into_iter().find(|term| is_adjusted[*term])?;
        is_adjusted[term] = false;
    }
}

/// Returns the parameters that the points can determine.
fn adjusted_parameters(points: &[TransferPoint]) -> Option<[bool; PARAMETERS]> {
    let distinct = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len()
    };
    let levels = distinct(points.iter().map(|point| point.exposure).filter(|x| *x > 0.0).collect());
    let dark_times =
        distinct(points.iter().filter(|point| point.exposure == 0.0).map(|point| point.time_s).collect());
    let anchors = levels + usize::from(dark_times > 0);
    let variances = points.iter().filter(|point| point.variance.is_some()).count();
    let mut adjusted = [false; PARAMETERS];
    adjusted[BIAS] = true;
    adjusted[LIGHT] = levels > 0 && anchors > 1;
    adjusted[DARK] = dark_times > 1;
    adjusted[CURVATURE] = levels > 1 && anchors > 2;
    adjusted[CUBIC] = levels >= MIN_LEVELS_OF_CUBIC;
    adjusted[READ_VARIANCE] = variances > 0;
    adjusted[INVERSE_GAIN] = variances > 1 && (adjusted[LIGHT] || adjusted[DARK]);
    (dark_times > 0 || levels > 1).then_some(adjusted)
}

/// Returns starting values: the line through the darkest and the next levels.
fn first_values(points: &[TransferPoint]) -> Option<[f64; PARAMETERS]> {
    let mut sorted: Vec<&TransferPoint> = points.iter().collect();
    sorted.sort_by(|a, b| a.exposure.total_cmp(&b.exposure).then(a.time_s.total_cmp(&b.time_s)));
    let dark = sorted.first()?;
    let lit = sorted.get(sorted.len() / 2..)?.iter().find(|point| point.exposure > dark.exposure);
    let mut values = [0.0; PARAMETERS];
    if let Some(lit) = lit {
        values[LIGHT] = (lit.mean[0] - dark.mean[0]) / (lit.exposure - dark.exposure);
        if let (Some([high, _]), Some([low, _])) = (lit.variance, dark.variance) {
            values[INVERSE_GAIN] = ((high - low) / (lit.mean[0] - dark.mean[0])).max(1e-6);
        }
    }
    values[BIAS] = dark.mean[0] - values[LIGHT] * dark.exposure;
    values[READ_VARIANCE] = dark.variance.map_or(0.0, |[variance, _]| variance);
    Some(values)
}

/// Adjusts with the scatter of the light raised, and the errors of variances raised, until both fit.
fn fit_with_scatter(
    points: &[TransferPoint],
    start: &[f64; PARAMETERS],
    is_adjusted: [bool; PARAMETERS],
    light_scatter: f64,
) -> Option<TransferFit> {
    let mut scatter = light_scatter;
    let mut fit = adjust(points, start, is_adjusted, scatter, 1.0)?;
    let [mean_degrees, variance_degrees] = degrees_of_freedom(points, &is_adjusted);
    for _ in 0..SCATTER_ROUNDS {
        let chi_square = chi_squares(points, &fit)[0];
        // Above the four-sigma limit of χ², the light of the levels is less steady than stated.
        if mean_degrees < 1.0 || chi_square < mean_degrees + 4.0 * sqrt(2.0 * mean_degrees) {
            break;
        }
        scatter = (1.3 * scatter).max(1e-5);
        fit = adjust(points, start, is_adjusted, scatter, 1.0)?;
        if chi_squares(points, &fit)[0] < mean_degrees {
            break;
        }
    }
    let chi_square = chi_squares(points, &fit)[1];
    if variance_degrees >= 1.0 && chi_square > variance_degrees + 4.0 * sqrt(2.0 * variance_degrees) {
        fit = adjust(points, start, is_adjusted, scatter, sqrt(chi_square / variance_degrees))?;
    }
    Some(fit)
}

/// Numbers of means and of variances above those of the parameters that they determine.
fn degrees_of_freedom(points: &[TransferPoint], is_adjusted: &[bool; PARAMETERS]) -> [f64; 2] {
    let count = |range: std::ops::RangeInclusive<usize>| {
        range.filter(|parameter| is_adjusted[*parameter]).count() as f64
    };
    let variances = points.iter().filter(|point| point.variance.is_some()).count() as f64;
    [points.len() as f64 - count(BIAS..=CUBIC), variances - count(INVERSE_GAIN..=READ_VARIANCE)]
}

/// Sums of the squared residuals of means and of variances in units of their errors.
fn chi_squares(points: &[TransferPoint], fit: &TransferFit) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for point in points {
        let u = linear_signal(&fit.values, point.exposure, point.time_s);
        let off =
            (point.mean[0] - mean_at(&fit.values, u)) / mean_error(point, &fit.values, fit.light_scatter);
        sums[0] += off * off;
        if let Some([variance, sigma]) = point.variance {
            let off = (variance - variance_at(&fit.values, u)) / sigma;
            sums[1] += off * off;
        }
    }
    sums
}

/// Standard deviation of a mean with the scatter of its light, DN.
fn mean_error(point: &TransferPoint, values: &[f64; PARAMETERS], light_scatter: f64) -> f64 {
    let of_light = light_scatter * values[LIGHT] * point.exposure;
    sqrt(point.mean[1] * point.mean[1] + of_light * of_light)
}

/// Least squares by Gauss and Newton, with columns scaled to equal length.
fn adjust(
    points: &[TransferPoint],
    start: &[f64; PARAMETERS],
    is_adjusted: [bool; PARAMETERS],
    light_scatter: f64,
    variance_factor: f64,
) -> Option<TransferFit> {
    let active: Vec<usize> = (0..PARAMETERS).filter(|parameter| is_adjusted[*parameter]).collect();
    let mut values = *start;
    for parameter in (0..PARAMETERS).filter(|parameter| !is_adjusted[*parameter]) {
        values[parameter] = 0.0;
    }
    let mut inverse = DMatrix::zeros(0, 0);
    for _ in 0..ROUNDS {
        let (jacobian, residuals) = equations(points, &values, &active, light_scatter, variance_factor);
        let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
        if lengths.iter().any(|length| *length == 0.0 || !length.is_finite()) {
            return None;
        }
        let scaled = DMatrix::from_fn(jacobian.nrows(), active.len(), |i, j| jacobian[(i, j)] / lengths[j]);
        let svd = scaled.svd(true, true);
        if svd.singular_values.min() < 1e-9 * svd.singular_values.max() {
            return None;
        }
        let step = svd.solve(&residuals, 0.0).ok()?;
        for (j, parameter) in active.iter().enumerate() {
            values[*parameter] += step[j] / lengths[j];
        }
        let v = svd.v_t?.transpose();
        let weights = DMatrix::from_diagonal(&svd.singular_values.map(|value| 1.0 / (value * value)));
        let scaled_inverse = &v * weights * v.transpose();
        inverse = DMatrix::from_fn(active.len(), active.len(), |i, j| {
            scaled_inverse[(i, j)] / (lengths[i] * lengths[j])
        });
    }
    let mut covariance = DMatrix::zeros(PARAMETERS, PARAMETERS);
    for (i, row) in active.iter().enumerate() {
        for (j, column) in active.iter().enumerate() {
            covariance[(*row, *column)] = inverse[(i, j)];
        }
    }
    values.iter().all(|value| value.is_finite()).then_some(TransferFit {
        values,
        is_adjusted,
        covariance,
        light_scatter,
        variance_factor,
    })
}

/// Jacobian and residuals of all means and variances, in units of their errors.
fn equations(
    points: &[TransferPoint],
    values: &[f64; PARAMETERS],
    active: &[usize],
    light_scatter: f64,
    variance_factor: f64,
) -> (DMatrix<f64>, DVector<f64>) {
    let mut rows: Vec<[f64; PARAMETERS]> = Vec::new();
    let mut residuals = Vec::new();
    for point in points {
        let u = linear_signal(values, point.exposure, point.time_s);
        let (k, l, p) = (values[CURVATURE], values[CUBIC], values[INVERSE_GAIN]);
        let slope = slope_at(values, u);
        let sigma = mean_error(point, values, light_scatter);
        let mean_slope = slope - k * p;
        let (by_light, by_dark) = (mean_slope * point.exposure, mean_slope * point.time_s);
        let row = [1.0, by_light, by_dark, -u * (u + p), -u * u * u, -k * u, 0.0];
        rows.push(row.map(|value| value / sigma));
        residuals.push((point.mean[0] - mean_at(values, u)) / sigma);
        let Some([variance, sigma]) = point.variance else { continue };
        let sigma = variance_factor * sigma;
        // d/du of slope² p u, and of slope by k and l.
        let by_u = slope * slope * p + 2.0 * slope * (-2.0 * k - 6.0 * l * u) * p * u;
        let (by_k, by_l) = (-4.0 * slope * p * u * u, -6.0 * slope * p * u * u * u);
        let row = [0.0, by_u * point.exposure, by_u * point.time_s, by_k, by_l, slope * slope * u, 1.0];
        rows.push(row.map(|value| value / sigma));
        residuals.push((variance - variance_at(values, u)) / sigma);
    }
    let jacobian = DMatrix::from_fn(rows.len(), active.len(), |i, j| rows[i][active[j]]);
    (jacobian, DVector::from_vec(residuals))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRUTH: [f64; PARAMETERS] = [100.0, 800.0, 4.0, 1e-5, 1e-10, 0.4, 9.0];

    /// Points of a bias, two darks and seven levels without errors, with the errors of 1e5 pixels.
    fn points() -> Vec<TransferPoint> {
        let darks = [(0.0, 0.0), (0.0, 2.0), (0.0, 10.0)];
        let flats = [0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 4.0].map(|t| (t, t));
        let point = |(exposure, time_s)| {
            let u = linear_signal(&TRUTH, exposure, time_s);
            let (mean, variance) = (mean_at(&TRUTH, u), variance_at(&TRUTH, u));
            let mean = [mean, sqrt(variance / 2e5)];
            TransferPoint { exposure, time_s, mean, variance: Some([variance, variance * sqrt(2e-5)]) }
        };
        darks.into_iter().chain(flats).map(point).collect()
    }

    #[test]
    fn exact_moments_give_every_parameter() {
        let fit = fit_transfer(&points(), 0.0).unwrap();
        for (parameter, truth) in TRUTH.iter().enumerate() {
            let [value, sigma] = fit.parameter(parameter).unwrap();
            assert!((value - truth).abs() < 1e-3 * sigma, "{parameter}: {value} ± {sigma}");
        }
        let [gain, sigma] = fit.derived(|values| Some(1.0 / values[INVERSE_GAIN])).unwrap();
        assert!((gain - 2.5).abs() < 1e-4 && sigma < 0.01, "{gain} ± {sigma}");
    }

    #[test]
    fn the_signal_of_a_mean_is_the_inverse_of_the_response() {
        for u in [0.0, 10.0, 3000.0, 10_000.0] {
            let found = signal_of_mean(&TRUTH, mean_at(&TRUTH, u)).unwrap();
            assert!((found - u).abs() < 1e-4, "{found} {u}");
        }
        assert_eq!(signal_of_mean(&TRUTH, 1e9), None);
    }

    #[test]
    fn light_that_scatters_between_levels_widens_the_errors() {
        let mut points = points();
        for (number, point) in points.iter_mut().filter(|point| point.exposure > 0.0).enumerate() {
            point.mean[0] *= 1.0 + 0.01 * [1.0, -0.7, 0.2, -1.1, 0.9, 0.4, -0.6][number];
        }
        let fit = fit_transfer(&points, 0.0).unwrap();
        assert!((0.003..0.05).contains(&fit.light_scatter), "{}", fit.light_scatter);
        let [k, sigma] = fit.parameter(CURVATURE).unwrap();
        assert!((k - 1e-5).abs() < 4.0 * sigma && sigma > 1e-6, "{k} ± {sigma}");
        let [p, sigma] = fit.parameter(INVERSE_GAIN).unwrap();
        assert!((p - 0.4).abs() < 4.0 * sigma, "{p} ± {sigma}");
    }

    #[test]
    fn one_level_gives_a_gain_without_curvature_and_none_gives_no_gain() {
        let points = points();
        let one: Vec<TransferPoint> = [points[0], points[5]].to_vec();
        let fit = fit_transfer(&one, 0.0).unwrap();
        assert!(fit.is_adjusted[INVERSE_GAIN] && !fit.is_adjusted[CURVATURE] && !fit.is_adjusted[DARK]);
        let fit = fit_transfer(&points[..1], 0.0).unwrap();
        assert!(!fit.is_adjusted[INVERSE_GAIN] && fit.is_adjusted[READ_VARIANCE]);
        assert!(fit_transfer(&points[5..6], 0.0).is_none());
    }
}
