//! Stars: expected positions, matching with clusters, and the attitude from the matches.

use contract::{CameraFrame, Icrs, ListedStar, PixelPoint, Rotation};
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector2, Vector3};

use super::mounting::AttitudeError;
use crate::CameraModel;

/// Listed star at its expected position.
#[derive(Debug, Clone, Copy)]
pub(super) struct ExpectedStar {
    pub(super) star: ListedStar,
    /// Apparent direction along the axes of ICRS, with aberration applied.
    pub(super) apparent: Vector3<f64>,
    /// Position in the image, px.
    pub(super) position: PixelPoint,
    /// Expected flux, electrons; `None` while the brightness scale is unknown.
    pub(super) flux_e: Option<f64>,
}

/// Cluster that may be a star.
#[derive(Debug, Clone, Copy)]
pub(super) struct StarCandidate {
    pub(super) position: PixelPoint,
    pub(super) flux_e: f64,
    /// True if the flux is a lower bound.
    pub(super) is_saturated: bool,
}

/// Measured image of a star, with its expected direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct StarMeasurement {
    pub(super) position: PixelPoint,
    /// Variances of the position along columns and rows, px².
    pub(super) variance_px2: [f64; 2],
    pub(super) apparent: Vector3<f64>,
}

/// Range of the natural logarithm of the ratio of measured to expected flux. Colours not represented by V
/// make stars up to ten times as bright for silicon; variable stars may be a fifth as bright.
const LOG_FLUX_RATIO: (f64, f64) = (-1.6, 2.4);

/// Standard deviation of a centre of brightness in the search for the common offset, px.
const CENTRE_PX: f64 = 0.35;

/// Gain of a matched star in the search, in units of half a χ²: a chance match within the tolerance is rarer
/// by e⁻⁶.
const MATCH_GAIN: f64 = 6.0;

/// Search range of the offset, in standard deviations of the prior.
const SEARCH_SIGMAS: f64 = 3.5;

/// Brightness difference above which a star brighter than the matched stars counts as missing, mag. Smaller
/// differences do not count, because colours change the order of brightness.
const BRIGHTER_MAG: f64 = 0.5;

/// Returns true if the brightness of a candidate is compatible with the star's.
fn is_as_bright(candidate: &StarCandidate, star: &ExpectedStar) -> bool {
    let Some(flux_e) = star.flux_e else { return true };
    let ratio = libm::log(candidate.flux_e.max(1e-9) / flux_e.max(1e-9));
    ratio <= LOG_FLUX_RATIO.1 && (ratio >= LOG_FLUX_RATIO.0 || candidate.is_saturated)
}

/// Matches candidates with expected stars through the common offset of the image that explains most of them.
/// Returns pairs (candidate, star).
///
/// `sigma_px` is the standard deviation of the offset along each axis, `sigma_roll` that of the rotation
/// about the boresight, rad.
pub(super) fn matches_by_offset(
    candidates: &[StarCandidate],
    stars: &[ExpectedStar],
    sigma_px: [f64; 2],
    sigma_roll: f64,
) -> Vec<(usize, usize)> {
    let mut pairs = Vec::new();
    let radius_px =
        stars.iter().map(|star| star.position.x.abs().max(star.position.y.abs())).fold(0.0, f64::max);
    // The centre of the rotation is somewhere in the image.
    let tolerance_px = 3.0 * libm::hypot(CENTRE_PX, 0.25 * sigma_roll * radius_px);
    let reach = sigma_px.map(|sigma| SEARCH_SIGMAS * sigma + tolerance_px);
    for (c, candidate) in candidates.iter().enumerate() {
        for (s, star) in stars.iter().enumerate() {
            let (dx, dy) = (candidate.position.x - star.position.x, candidate.position.y - star.position.y);
            if dx.abs() <= reach[0] && dy.abs() <= reach[1] && is_as_bright(candidate, star) {
                pairs.push((c, s, dx, dy));
            }
        }
    }
    let mut best: (f64, Vec<(usize, usize)>) = (0.0, Vec::new());
    for &(_, _, dx, dy) in &pairs {
        let (zx, zy) = (dx / sigma_px[0], dy / sigma_px[1]);
        let mut near: Vec<_> = pairs
            .iter()
            .map(|&(c, s, x, y)| (libm::hypot(x - dx, y - dy), c, s))
            .filter(|(distance, ..)| *distance <= tolerance_px)
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let mut gain = -0.5 * (zx * zx + zy * zy);
        let mut matched: Vec<(usize, usize)> = Vec::new();
        for (distance, c, s) in near {
            if !matched.iter().any(|&(mc, ms)| mc == c || ms == s) {
                let z = 3.0 * distance / tolerance_px;
                gain += MATCH_GAIN - 0.5 * z * z;
                matched.push((c, s));
            }
        }
        if gain > best.0 {
            best = (gain, matched);
        }
    }
    best.1
}

/// Matches candidates with stars at their expected positions, nearest first, each within `gate_px` of its
/// star. Returns pairs (candidate, star).
pub(super) fn matches_at_positions(
    candidates: &[StarCandidate],
    stars: &[ExpectedStar],
    gate_px: impl Fn(&ExpectedStar) -> f64,
) -> Vec<(usize, usize)> {
    let mut pairs = Vec::new();
    for (s, star) in stars.iter().enumerate() {
        let gate_px = gate_px(star);
        for (c, candidate) in candidates.iter().enumerate() {
            if (candidate.position.x - star.position.x).abs() <= gate_px {
                let distance = candidate.position.distance(star.position);
                if distance <= gate_px && is_as_bright(candidate, star) {
                    pairs.push((distance, c, s));
                }
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut matched: Vec<(usize, usize)> = Vec::new();
    for (_, c, s) in pairs {
        if !matched.iter().any(|&(mc, ms)| mc == c || ms == s) {
            matched.push((c, s));
        }
    }
    matched
}

/// Returns true if matched stars are unlikely to be a coincidence: among the listed stars that must have an
/// image, at most as many lack one as are matched. A variable star or a stain on a lens causes one missing
/// star, a wrong offset nearly all. `is_in_image` returns true if the position of a star was transmitted.
///
/// A star must have an image within `gate_px` if its expected flux, reduced by the largest error of its
/// prediction from V, is above the threshold. While the brightness scale is unknown, it must have one if it
/// is half a magnitude brighter than the median of the matched stars.
pub(super) fn are_confirmed(
    matched: &[(usize, usize)],
    candidates: &[StarCandidate],
    stars: &[ExpectedStar],
    gate_px: f64,
    threshold_e: f64,
    is_in_image: impl Fn(PixelPoint) -> bool,
) -> bool {
    let mut magnitudes: Vec<f64> = matched.iter().map(|&(_, s)| stars[s].star.magnitude).collect();
    magnitudes.sort_by(f64::total_cmp);
    let Some(&median) = magnitudes.get(magnitudes.len() / 2) else { return false };
    let is_missing = |star: &&ExpectedStar| {
        let is_bright = match star.flux_e {
            Some(flux_e) => libm::log(flux_e / threshold_e) + LOG_FLUX_RATIO.0 > 0.0,
            None => star.star.magnitude < median - BRIGHTER_MAG,
        };
        is_bright
            && is_in_image(star.position)
            && !candidates.iter().any(|candidate| candidate.position.distance(star.position) <= gate_px)
    };
    stars.iter().filter(is_missing).count() <= matched.len()
}

/// Smallest number of listed stars without an image that contradicts an attitude.
const CONTRADICTING_STARS: usize = 5;

/// Returns true if a frame without matched stars contradicts its attitude: at least five listed stars must
/// have an image. While the brightness scale is unknown, they must have one if the frame has as many
/// clusters. `is_in_image` returns true if the position of a star was transmitted.
pub(super) fn is_contradicted(
    stars: &[ExpectedStar],
    clusters: usize,
    threshold_e: f64,
    is_in_image: impl Fn(PixelPoint) -> bool,
) -> bool {
    let must_appear = |star: &&ExpectedStar| {
        is_in_image(star.position)
            && star.flux_e.map_or(clusters >= CONTRADICTING_STARS, |flux_e| {
                libm::log(flux_e / threshold_e) + LOG_FLUX_RATIO.0 > 0.0
            })
    };
    stars.iter().filter(must_appear).count() >= CONTRADICTING_STARS
}

/// Returns the residual of a star, px, and its derivative with respect to a small rotation of the camera
/// about its axes, for an attitude; `None` if the star has no image.
fn residual(
    star: &StarMeasurement,
    camera_from_icrs: &Rotation<CameraFrame, Icrs>,
    model: &CameraModel,
) -> Option<(Vector2<f64>, Matrix2x3<f64>)> {
    let (u, v) = model.to_ideal(star.position)?;
    let r = camera_from_icrs.rotate(&star.apparent);
    if r.z <= 0.0 {
        return None;
    }
    let (fx, fy) = model.focal_px();
    let (x, y) = (r.x / r.z, r.y / r.z);
    Some((Vector2::new(u - fx * x, v - fy * y), turn_derivative(x, y, fx, fy)))
}

/// Returns the derivative of (fx X/Z, fy Y/Z) with respect to a small rotation θ of the camera axes, which
/// moves a direction by θ × r.
pub(super) fn turn_derivative(x: f64, y: f64, fx: f64, fy: f64) -> Matrix2x3<f64> {
    Matrix2x3::new(-fx * x * y, fx * (1.0 + x * x), -fx * y, -fy * (1.0 + y * y), fy * x * y, fy * x)
}

/// Attitude from a prior and stars.
#[derive(Debug, Clone)]
pub(super) struct StarAttitude {
    /// Posterior of the error of the telemetry's attitude, in axes of the camera.
    pub(super) error: AttitudeError,
    /// True for each star that was used, false for outliers.
    pub(super) used: Vec<bool>,
}

/// Squared normalised residual above which a star is an outlier: χ² with two degrees of freedom exceeds it
/// once in 3000.
const OUTLIER: f64 = 16.0;

/// Number of linearisations of the attitude; a rotation of one degree needs three.
const ITERATIONS: usize = 4;

/// Returns the posterior error of the attitude from the prior and the stars, by least squares. While the star
/// with the largest residual is an outlier, it is dropped. `attitude` returns the camera's attitude for an
/// error in camera axes.
pub(super) fn solve_attitude(
    stars: &[StarMeasurement],
    prior: &AttitudeError,
    attitude: impl Fn(Vector3<f64>) -> Rotation<CameraFrame, Icrs>,
    model: &CameraModel,
) -> Option<StarAttitude> {
    let prior_information = prior.covariance.try_inverse()?;
    let mut used = vec![true; stars.len()];
    loop {
        let mut e = prior.mean;
        let mut covariance = prior.covariance;
        for _ in 0..ITERATIONS {
            let camera_from_icrs = attitude(e);
            let mut information = prior_information;
            let mut score = prior_information * (prior.mean - e);
            for (star, _) in stars.iter().zip(&used).filter(|(_, used)| **used) {
                let Some((residual, by)) = residual(star, &camera_from_icrs, model) else { continue };
                let weight = weight(star);
                information += by.transpose() * weight * by;
                score += by.transpose() * (weight * residual);
            }
            covariance = information.try_inverse()?;
            let step = covariance * score;
            e += step;
            if step.norm() < 1e-10 {
                break;
            }
        }
        let camera_from_icrs = attitude(e);
        let worst = stars
            .iter()
            .enumerate()
            .filter(|(i, _)| used.get(*i) == Some(&true))
            .filter_map(|(i, star)| {
                let (residual, by) = residual(star, &camera_from_icrs, model)?;
                // The residual of a fitted star has the variance of its position minus that of the fit.
                let [vx, vy] = star.variance_px2;
                let expected = Matrix2::new(vx, 0.0, 0.0, vy) - by * covariance * by.transpose();
                let least = 0.1 * vx.min(vy);
                let normalised = residual.x * residual.x / expected[(0, 0)].max(least)
                    + residual.y * residual.y / expected[(1, 1)].max(least);
                Some((normalised, i))
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match worst {
            Some((normalised, i)) if normalised > OUTLIER => used[i] = false,
            _ => return Some(StarAttitude { error: AttitudeError { mean: e, covariance }, used }),
        }
    }
}

fn weight(star: &StarMeasurement) -> Matrix2<f64> {
    let [vx, vy] = star.variance_px2;
    Matrix2::new(1.0 / vx, 0.0, 0.0, 1.0 / vy)
}

/// Returns the covariance in the image, px², of a direction at the ideal coordinates (x, y) = (X/Z, Y/Z) due
/// to the attitude's covariance.
pub(super) fn image_covariance(
    covariance: &Matrix3<f64>,
    x: f64,
    y: f64,
    (fx, fy): (f64, f64),
) -> Matrix2<f64> {
    let by = turn_derivative(x, y, fx, fy);
    by * covariance * by.transpose()
}
