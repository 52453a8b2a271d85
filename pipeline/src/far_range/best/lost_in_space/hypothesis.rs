//! Hypothesis of an attitude, and where they are free of the focal length and of a radial distortion, with
//! its odds by the sources of a frame.

use contract::{CameraFrame, Icrs, ListedStar, PixelPoint, Rotation};
use nalgebra::{Matrix2, Matrix2x5, Matrix3, Matrix4, Matrix5, Vector2, Vector3, Vector5};

use super::source::{ImageSource, SOURCE_SIGMA_PX};
use crate::CameraModel;
use crate::far_range::attitude::{StarPair, solve_q_method};
use crate::far_range::best::stars::turn_derivative;
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

/// Difference of a camera from the stated one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lens {
    /// Focal length over the stated one.
    pub(super) focal_ratio: f64,
    /// Share by which a radial distortion moves a point at half the diagonal of the detector outwards, in
    /// addition to the stated distortion.
    pub(super) corner_shift: f64,
}

impl Lens {
    /// The stated camera.
    pub(super) const STATED: Self = Self { focal_ratio: 1.0, corner_shift: 0.0 };

    /// Returns the added radial distortion k1, px⁻².
    pub(super) fn radial(&self, stated: &CameraModel) -> f64 {
        self.corner_shift / squared_half_diagonal(stated)
    }

    fn model(&self, stated: &CameraModel) -> CameraModel {
        stated.with_focal_ratio(self.focal_ratio).with_added_radial(self.radial(stated))
    }
}

/// Returns the square of half the diagonal of the detector, px².
fn squared_half_diagonal(model: &CameraModel) -> f64 {
    let (columns, rows) = model.size_px();
    0.25 * (columns as f64 * columns as f64 + rows as f64 * rows as f64)
}

/// Normal distribution of the corner shift of a lens before its stars are matched.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShiftPrior {
    pub(super) mean: f64,
    pub(super) sigma: f64,
}

/// Attitude from matched sources, for a known or a free lens.
#[derive(Debug, Clone)]
pub(super) struct Hypothesis {
    pub(super) camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// Camera with the lens of the hypothesis.
    pub(super) model: CameraModel,
    /// Lens; the stated one if it is known.
    pub(super) lens: Lens,
    /// Covariance of the errors: of the attitude as a rotation about the camera's axes, rad, of the natural
    /// logarithm of the focal length, and of the corner shift; 0 for those that are known.
    pub(super) covariance: Matrix5<f64>,
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
    /// Natural logarithm of the density at the centre of the distribution, px⁻².
    log_peak: f64,
    is_taken: bool,
}

/// Number of steps for attitude, focal length and distortion together, each of which squares the error.
const LENS_ROUNDS: usize = 3;

/// Number of rounds in which attitude and focal length are solved in turn. Each reduces the error of the
/// focal length by the share of the sources' scatter that a turn of the camera can take up, a hundredth or
/// less.
const FOCAL_ROUNDS: usize = 4;

impl Hypothesis {
    /// Returns the attitude that best rotates the stars onto their sources, with equal weights; `None` when
    /// they do not determine it.
    pub(super) fn with_known_focal_length(matched: &[Match], model: &CameraModel) -> Option<Self> {
        let camera_from_icrs = attitude(matched, 1.0)?;
        let information: Matrix3<f64> =
            matched.iter().map(|pair| turn_information(&derivatives(pair, model, 1.0))).sum();
        let mut covariance = Matrix5::zeros();
        covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&information.try_inverse()?);
        Some(Self { camera_from_icrs, model: model.clone(), lens: Lens::STATED, covariance })
    }

    /// Returns the attitude and the focal length that best map the stars onto their sources, with equal
    /// weights; `None` when they do not determine both. `stated` is the camera as stated, `ratio` a first
    /// value of the focal length over the stated one.
    pub(super) fn with_free_focal_length(
        matched: &[Match],
        stated: &CameraModel,
        mut ratio: f64,
    ) -> Option<Self> {
        let mut camera_from_icrs = attitude(matched, ratio)?;
        for _ in 0..FOCAL_ROUNDS {
            ratio = focal_ratio(matched, &camera_from_icrs, stated)?;
            camera_from_icrs = attitude(matched, ratio)?;
        }
        let information: Matrix4<f64> = matched
            .iter()
            .map(|pair| {
                let by = derivatives(pair, stated, ratio) / SOURCE_SIGMA_PX;
                let by = by.fixed_view::<2, 4>(0, 0);
                by.transpose() * by
            })
            .sum();
        let mut covariance = Matrix5::zeros();
        covariance.fixed_view_mut::<4, 4>(0, 0).copy_from(&information.try_inverse()?);
        Some(Self {
            camera_from_icrs,
            model: stated.with_focal_ratio(ratio),
            lens: Lens { focal_ratio: ratio, corner_shift: 0.0 },
            covariance,
        })
    }

    /// Returns the attitude, the focal length and the radial distortion that best map the stars onto their
    /// sources, with equal weights and a prior of the distortion, from first values; `None` when they do not
    /// determine them. Steps of Gauss and Newton.
    pub(super) fn with_free_lens(
        matched: &[Match],
        stated: &CameraModel,
        first: Lens,
        prior: ShiftPrior,
    ) -> Option<Self> {
        let mut lens = first;
        let undistorted = stated.with_added_radial(lens.radial(stated));
        let mut pairs = Vec::with_capacity(matched.len());
        for pair in matched {
            let direction = undistorted.back_project(pair.source.position)?;
            let camera = ImageSource { direction, ..pair.source }.direction_at(lens.focal_ratio)?;
            pairs.push(StarPair { camera, icrs: pair.star.direction, weight: 1.0 });
        }
        let mut camera_from_icrs = solve_q_method(&pairs)?;
        let squared = squared_half_diagonal(stated);
        let mut inverse = Matrix5::zeros();
        for _ in 0..LENS_ROUNDS {
            let model = lens.model(stated);
            let (mut information, mut gradient) = (Matrix5::zeros(), Vector5::zeros());
            information[(4, 4)] = 1.0 / (prior.sigma * prior.sigma);
            gradient[4] = (prior.mean - lens.corner_shift) * information[(4, 4)];
            for pair in matched {
                let r = camera_from_icrs.rotate(pair.star.direction.vector());
                let computed = model.project_vector(&r)?;
                let source = pair.source.position;
                let by = lens_derivatives(&r, &model, squared) / SOURCE_SIGMA_PX;
                let rest = Vector2::new(source.x - computed.x, source.y - computed.y) / SOURCE_SIGMA_PX;
                information += by.transpose() * by;
                gradient += by.transpose() * rest;
            }
            inverse = information.try_inverse()?;
            let step = inverse * gradient;
            let turn = Vector3::new(step[0], step[1], step[2]);
            camera_from_icrs =
                Rotation::<CameraFrame, CameraFrame>::from_rotation_vector(turn) * camera_from_icrs;
            lens.focal_ratio *= libm::exp(step[3].clamp(-0.3, 0.3));
            lens.corner_shift += step[4].clamp(-0.3, 0.3);
        }
        Some(Self { camera_from_icrs, model: lens.model(stated), lens, covariance: inverse })
    }

    /// Compares sources, in order of flux, with all predicted stars. The matches in `given`, from which the
    /// attitude was derived, are excluded from the odds.
    ///
    /// A source has the density d/A + (1 − d) N(x; star)/n over an image of A px² with n predicted stars, and
    /// 1/A by chance (Lang et al. 2010, Eqs. 6 to 13 with one variance for each star: that of the source and
    /// of the attitude). N is that of the likeliest star instead of the sum over stars, which is a lower
    /// bound. Each star matches at most one source.
    pub(super) fn support(&self, sources: &[ImageSource], given: &[Match], list: &StarList) -> Support {
        let mut predictions = self.predictions(list);
        for pair in given {
            predictions.retain(|prediction| prediction.star != pair.star);
        }
        let (columns, rows) = self.model.size_px();
        let gain = (1.0 - DISTRACTORS) * columns as f64 * rows as f64 / predictions.len().max(1) as f64;
        let mut support = Support { log_odds: 0.0, matched: given.to_vec() };
        for source in sources {
            if given.iter().any(|pair| pair.source.index == source.index) {
                continue;
            }
            let Some((prediction, distance)) = likeliest(&mut predictions, source.position) else {
                support.log_odds += libm::log(DISTRACTORS);
                continue;
            };
            let density = libm::exp(prediction.log_peak - 0.5 * distance);
            support.log_odds += libm::log(DISTRACTORS + gain * density);
            if distance <= MATCH_GATE {
                prediction.is_taken = true;
                support.matched.push(Match { source: *source, star: prediction.star });
            }
        }
        support
    }

    fn predictions(&self, list: &StarList) -> Vec<Prediction> {
        let (focal_px, squared) = (self.model.focal_px(), squared_half_diagonal(&self.model));
        let is_lens_free = self.covariance[(4, 4)] > 0.0;
        list.predict(&self.camera_from_icrs, &self.model)
            .into_iter()
            .filter_map(|predicted| {
                let r = self.camera_from_icrs.rotate(predicted.star.direction.vector());
                let by = match is_lens_free {
                    true => lens_derivatives(&r, &self.model, squared),
                    false => derivatives_at(r.x / r.z, r.y / r.z, focal_px),
                };
                let of_hypothesis = by * self.covariance * by.transpose();
                let covariance = of_hypothesis + Matrix2::identity() * (SOURCE_SIGMA_PX * SOURCE_SIGMA_PX);
                Some(Prediction {
                    star: predicted.star,
                    position: predicted.position,
                    information: covariance.try_inverse()?,
                    log_peak: -libm::log(std::f64::consts::TAU * covariance.determinant().sqrt()),
                    is_taken: false,
                })
            })
            .collect()
    }
}

/// Returns the attitude that best rotates the stars onto the directions of their sources at a focal length.
fn attitude(matched: &[Match], focal_ratio: f64) -> Option<Rotation<CameraFrame, Icrs>> {
    let mut pairs = Vec::with_capacity(matched.len());
    for pair in matched {
        let camera = pair.source.direction_at(focal_ratio)?;
        pairs.push(StarPair { camera, icrs: pair.star.direction, weight: 1.0 });
    }
    solve_q_method(&pairs)
}

/// Returns the focal length over the stated one that best maps the stars, rotated by an attitude, onto their
/// sources: Σ u·p/Σ |p|², for the sources' offsets u from the principal point, px, without distortion, and
/// the stars' offsets p at the stated focal length.
fn focal_ratio(
    matched: &[Match],
    camera_from_icrs: &Rotation<CameraFrame, Icrs>,
    stated: &CameraModel,
) -> Option<f64> {
    let (fx, fy) = stated.focal_px();
    let (mut products, mut squares) = (0.0, 0.0);
    for pair in matched {
        let source = pair.source.direction.vector();
        let star = camera_from_icrs.rotate(pair.star.direction.vector());
        let measured = Vector2::new(fx * source.x / source.z, fy * source.y / source.z);
        let expected = Vector2::new(fx * star.x / star.z, fy * star.y / star.z);
        products += measured.dot(&expected);
        squares += expected.norm_squared();
    }
    Some(products / squares).filter(|ratio| ratio.is_finite() && *ratio > 0.0)
}

/// Returns the derivatives of the position of a matched source, px, by a turn of the camera about its axes,
/// rad, and by the natural logarithm of the focal length.
fn derivatives(pair: &Match, stated: &CameraModel, focal_ratio: f64) -> Matrix2x5<f64> {
    let r = pair.source.direction.vector();
    let (fx, fy) = stated.focal_px();
    derivatives_at(r.x / r.z / focal_ratio, r.y / r.z / focal_ratio, (fx * focal_ratio, fy * focal_ratio))
}

/// Returns the derivatives of [`derivatives`] at a direction (x, y, 1) of the camera; 0 by a distortion.
fn derivatives_at(x: f64, y: f64, (fx, fy): (f64, f64)) -> Matrix2x5<f64> {
    let mut by = Matrix2x5::zeros();
    by.fixed_view_mut::<2, 3>(0, 0).copy_from(&turn_derivative(x, y, fx, fy));
    by[(0, 3)] = fx * x;
    by[(1, 3)] = fy * y;
    by
}

/// Returns the derivatives of the position of a star, px, by a turn of the camera about its axes, rad, by the
/// natural logarithm of the focal length, and by the corner shift. `r` is the star's direction in the camera,
/// `squared` the square of half the diagonal of the detector, px².
fn lens_derivatives(r: &Vector3<f64>, model: &CameraModel, squared: f64) -> Matrix2x5<f64> {
    let (fx, fy) = model.focal_px();
    let (x, y) = (r.x / r.z, r.y / r.z);
    let (u, v) = (fx * x, fy * y);
    let (uu, uv, vv) = model.slopes(u, v);
    let mut by = Matrix2::new(uu, uv, uv, vv) * derivatives_at(x, y, (fx, fy));
    let shift = (u * u + v * v) / squared;
    by[(0, 4)] = u * shift;
    by[(1, 4)] = v * shift;
    by
}

/// Returns the information of a matched source on a turn of the camera about its axes, rad⁻².
fn turn_information(derivatives: &Matrix2x5<f64>) -> Matrix3<f64> {
    let by = derivatives.fixed_view::<2, 3>(0, 0) / SOURCE_SIGMA_PX;
    by.transpose() * by
}

impl Prediction {
    /// Returns the squared distance of a position from the predicted one, in standard deviations.
    fn squared_distance(&self, position: PixelPoint) -> f64 {
        let (dx, dy) = (position.x - self.position.x, position.y - self.position.y);
        let information = &self.information;
        (dx * information.m11 + dy * information.m21) * dx
            + (dx * information.m12 + dy * information.m22) * dy
    }
}

/// Returns the prediction without a source whose distribution has the largest density at a position, and its
/// squared distance; `None` if all have a source.
fn likeliest(predictions: &mut [Prediction], position: PixelPoint) -> Option<(&mut Prediction, f64)> {
    let mut best = None;
    let mut highest = f64::NEG_INFINITY;
    for prediction in predictions.iter_mut().filter(|prediction| !prediction.is_taken) {
        let distance = prediction.squared_distance(position);
        let log_density = prediction.log_peak - 0.5 * distance;
        if log_density >= highest {
            highest = log_density;
            best = Some((prediction, distance));
        }
    }
    best
}
