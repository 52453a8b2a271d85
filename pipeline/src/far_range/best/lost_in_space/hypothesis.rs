//! Attitude hypothesis, and its odds by the sources of a frame.

use contract::{CameraFrame, Icrs, ListedStar, PixelPoint, Rotation};
use nalgebra::{Matrix2, Matrix3, Vector2};

use super::source::{ImageSource, SOURCE_SIGMA_PX};
use crate::CameraModel;
use crate::far_range::attitude::{StarPair, solve_q_method};
use crate::far_range::best::stars::{image_covariance, turn_derivative};
use crate::far_range::identify::StarList;

/// Source matched with a star.
#[derive(Debug, Clone, Copy)]
pub(super) struct Match {
    pub(super) source: ImageSource,
    pub(super) star: ListedStar,
}

impl Match {
    pub(super) fn is_same_as(&self, other: &Self) -> bool {
        self.source.index == other.source.index && self.star == other.star
    }
}

/// Attitude from matched sources, with the covariance, rad², of its error as a rotation about the camera's
/// axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hypothesis {
    pub(super) camera_from_icrs: Rotation<CameraFrame, Icrs>,
    pub(super) covariance: Matrix3<f64>,
}

/// Support of an attitude by the sources of a frame.
#[derive(Debug)]
pub(super) struct Support {
    /// Natural logarithm of the ratio of the sources' likelihoods by the attitude and by chance.
    pub(super) log_odds: f64,
    /// Matches: the given ones first, then those found.
    pub(super) matched: Vec<Match>,
}

/// Share of the sources that are not listed stars: hot pixels, the target, stars beyond the list. With 0.7, a
/// source without a star lowers the logarithm of the odds by 0.36, and a source with a star raises it by
/// about 7.
const DISTRACTORS: f64 = 0.7;

/// Largest squared normalised distance of a match between source and star: χ² with two degrees of freedom
/// exceeds it once in 90.
const MATCH_GATE: f64 = 9.0;

/// Predicted star with the distribution of its source.
struct Prediction {
    star: ListedStar,
    position: PixelPoint,
    information: Matrix2<f64>,
    /// Density at the centre of the distribution, px⁻².
    peak: f64,
    is_taken: bool,
}

impl Hypothesis {
    /// Returns the attitude that best rotates the stars onto their sources, with equal weights; `None` when
    /// they do not determine it.
    pub(super) fn new(matched: &[Match], model: &CameraModel) -> Option<Self> {
        let pairs: Vec<StarPair> = matched
            .iter()
            .map(|pair| StarPair { camera: pair.source.direction, icrs: pair.star.direction, weight: 1.0 })
            .collect();
        let camera_from_icrs = solve_q_method(&pairs)?;
        let information: Matrix3<f64> = matched.iter().map(|pair| information(pair, model)).sum();
        Some(Self { camera_from_icrs, covariance: information.try_inverse()? })
    }

    /// Compares sources, in order of flux, with all predicted stars. The matches in `given`, from which the
    /// attitude was derived, are excluded from the odds.
    ///
    /// A source has the density d/A + (1 − d) N(x; star)/n over an image of A px² with n predicted stars, and
    /// 1/A by chance (Lang et al. 2010, Eqs. 6 to 13 with one variance for each star: that of the source and
    /// of the attitude). N is that of the likeliest star instead of the sum over stars, which is a lower
    /// bound. Each star matches at most one source.
    pub(super) fn support(
        &self,
        sources: &[ImageSource],
        given: &[Match],
        list: &StarList,
        model: &CameraModel,
    ) -> Support {
        let mut predictions = self.predictions(list, model);
        for pair in given {
            predictions.retain(|prediction| prediction.star != pair.star);
        }
        let (columns, rows) = model.size_px();
        let gain = (1.0 - DISTRACTORS) * columns as f64 * rows as f64 / predictions.len().max(1) as f64;
        let mut support = Support { log_odds: 0.0, matched: given.to_vec() };
        for source in sources {
            if given.iter().any(|pair| pair.source.index == source.index) {
                continue;
            }
            let likeliest = predictions
                .iter_mut()
                .filter(|prediction| !prediction.is_taken)
                .map(|prediction| {
                    let distance = prediction.squared_distance(source.position);
                    (prediction.peak * libm::exp(-0.5 * distance), distance, prediction)
                })
                .max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((density, distance, prediction)) = likeliest else {
                support.log_odds += libm::log(DISTRACTORS);
                continue;
            };
            support.log_odds += libm::log(DISTRACTORS + gain * density);
            if distance <= MATCH_GATE {
                prediction.is_taken = true;
                support.matched.push(Match { source: *source, star: prediction.star });
            }
        }
        support
    }

    fn predictions(&self, list: &StarList, model: &CameraModel) -> Vec<Prediction> {
        let (fx, fy) = model.focal_px();
        list.predict(&self.camera_from_icrs, model)
            .into_iter()
            .filter_map(|predicted| {
                let r = self.camera_from_icrs.rotate(predicted.star.direction.vector());
                let of_attitude = image_covariance(&self.covariance, r.x / r.z, r.y / r.z, (fx, fy));
                let covariance = of_attitude + Matrix2::identity() * (SOURCE_SIGMA_PX * SOURCE_SIGMA_PX);
                Some(Prediction {
                    star: predicted.star,
                    position: predicted.position,
                    information: covariance.try_inverse()?,
                    peak: 1.0 / (std::f64::consts::TAU * covariance.determinant().sqrt()),
                    is_taken: false,
                })
            })
            .collect()
    }
}

/// Returns the information of a matched source on a rotation of the camera about its axes, rad⁻².
fn information(pair: &Match, model: &CameraModel) -> Matrix3<f64> {
    let r = pair.source.direction.vector();
    let (fx, fy) = model.focal_px();
    let by = turn_derivative(r.x / r.z, r.y / r.z, fx, fy) / SOURCE_SIGMA_PX;
    by.transpose() * by
}

impl Prediction {
    /// Returns the squared distance of a position from the predicted one, in standard deviations.
    fn squared_distance(&self, position: PixelPoint) -> f64 {
        let d = Vector2::new(position.x - self.position.x, position.y - self.position.y);
        (d.transpose() * self.information * d).x
    }
}
