//! Candidates for the target in a frame, and their images.

use contract::{Direction, Icrs, PixelPoint};

use super::faint_points::FaintPoint;
use super::frame_attitude::FrameAttitude;
use super::hypotheses::{Hypotheses, STARS};
use super::photometry::{FittedSource, KnownSource, PhotometryContext, Source, TargetStart};
use super::stars::image_covariance;
use super::state::BestPipeline;
use super::track::{Sky, TargetCandidate};
use super::unlisted_stars::{STAR_EXPONENT, UnlistedStars};
use crate::far_range::overrides::{Identity, Overrides};

/// Inputs to the search for the target in a frame.
#[derive(Clone, Copy)]
pub(super) struct TargetContext<'a> {
    pub(super) context: PhotometryContext<'a>,
    pub(super) sources: &'a [Source],
    pub(super) attitude: &'a FrameAttitude,
    /// Listed stars of known flux.
    pub(super) known: &'a [KnownSource],
    pub(super) exposure_s: f64,
    pub(super) unlisted_stars: UnlistedStars,
}

/// Candidate with its fit and cluster.
pub(super) struct CandidateImage {
    pub(super) candidate: TargetCandidate,
    /// Fitted image; `None` if not fitted.
    pub(super) fit: Option<FittedSource>,
    /// Index of the candidate's cluster; `None` without one.
    pub(super) cluster: Option<usize>,
}

/// Number of brightest candidates whose images are fitted while no track is settled. Candidates near the
/// prediction of the best track are always fitted.
const MAX_FITTED: usize = 2;

/// Expected number of targets per frame and unit of ln F: one, of any brightness between noise and
/// saturation of the sky, ten units.
const TARGETS_PER_LOG_FLUX: f64 = 0.1;

/// Expected number of chance clusters, and of clusters of unknown defective pixels, per frame and unit of
/// ln F at the detection threshold. Both decrease with flux like the stars.
const CHANCE_PER_LOG_FLUX: f64 = 0.7;
const PIXELS_PER_LOG_FLUX: f64 = 0.3;

/// Expected number of noise maxima that are faint points, per frame and unit of ln F.
const FAINT_CHANCE_PER_LOG_FLUX: f64 = 40.0;

/// Fractions of unlisted stars that are single, close pairs, and wide pairs whose images merge in some
/// frames.
const STAR_FRACTIONS: [f64; STARS] = [0.7, 0.2, 0.1];

/// Misfit above which an unsaturated cluster is unlikely to be a point or a small body, and smallest width of
/// its image relative to that of a point.
const CLUTTER_MISFIT: f64 = 4.0;
const CLUTTER_WIDTH: f64 = 0.6;

/// Logarithms of the likelihood ratios of the image of a point against chance (particle hits, groups of
/// pixels) for a fit that agrees with a point, for one that does not, and for an image with more than
/// `FILLED_WELLS` saturated pixels, which a particle does not fill.
const POINT_LOG_RATIO: f64 = 3.5;
const MISFIT_LOG_RATIO: f64 = -5.0;
const FILLED_LOG_RATIO: f64 = 8.0;
const FILLED_WELLS: usize = 4;

/// Largest logarithm of the likelihood ratio of a point and of bright pixels: the model of the image
/// is not valid beyond it.
const MAX_POINT_OVER_PIXEL: f64 = 8.0;

/// Number of saturated pixels above which an image is not that of defective pixels.
const MAX_SATURATED_PIXELS: usize = 2;

/// Fraction of a cluster's flux in a hot pixel, its brightest, above which the cluster belongs to the pixel.
/// A point has a smaller one, unless it is very sharp.
const HOT_FRACTION: f64 = 0.35;

/// Distance from a cluster within which expected stars are fitted with it, px.
const KNOWN_REACH_PX: f64 = 24.0;

/// Limits for the search for a track's target without a cluster: smallest logarithm of the track's odds,
/// largest standard deviation of the prediction, px, and smallest signal-to-noise ratio.
const PREDICTED_LOG_ODDS: f64 = 4.0;
const PREDICTED_REACH_PX: f64 = 4.0;
const PREDICTED_SNR: f64 = 2.0;

impl BestPipeline {
    /// Returns the candidates of a frame: clusters, brightest first; points below the threshold of clusters
    /// while no track is settled; and the target at the position predicted by the best track.
    pub(super) fn candidates(
        &mut self,
        inputs: TargetContext<'_>,
        overrides: &Overrides<'_>,
    ) -> Vec<CandidateImage> {
        let mut images: Vec<CandidateImage> = Vec::new();
        let max_fitted = if self.tracks.is_settled() { 0 } else { MAX_FITTED };
        for i in target_clusters(inputs, overrides) {
            let source = &inputs.sources[i];
            let is_fitted = images.len() < max_fitted || self.tracks.is_expected(source.centre);
            let fit = is_fitted.then(|| self.fit_cluster(inputs, i)).flatten();
            let candidate = self.cluster_candidate(inputs, source, fit.as_ref());
            images.push(CandidateImage { candidate, fit, cluster: Some(i) });
        }
        if !self.tracks.is_settled() && overrides.identity.is_none() {
            images.extend(self.faint_candidates(inputs));
        }
        images.extend(self.predicted_candidate(inputs, &images));
        images
    }

    /// Returns the points below the threshold of clusters that are not at listed stars.
    fn faint_candidates(&mut self, inputs: TargetContext<'_>) -> Vec<CandidateImage> {
        let image = self.psf.image([0.0; 2]);
        let stars: Vec<PixelPoint> = inputs.attitude.expected.iter().map(|star| star.position).collect();
        let points = self.faint_points.find(inputs.context, &image, &stars);
        let candidate = |point: &FaintPoint| TargetCandidate {
            position: point.position,
            variance_px2: point.variance_px2,
            flux_e_per_s: point.flux_e / inputs.exposure_s,
            is_flux_bounded: false,
            weights: faint_weights(point, inputs.unlisted_stars, inputs.context.threshold_e),
            point_over_pixel: limited_shape(point.point_over_pixel),
            evidence: None,
            attitude_variance_px2: self.attitude_variance_px2(point.position, inputs.attitude),
        };
        points
            .iter()
            .map(|point| CandidateImage { candidate: candidate(point), fit: None, cluster: None })
            .collect()
    }

    /// Fits the image of a candidate that has not been fitted yet, if possible.
    pub(super) fn fit_candidate(&mut self, inputs: TargetContext<'_>, image: &mut CandidateImage) {
        if image.fit.is_some() {
            return;
        }
        let candidate = &mut image.candidate;
        image.fit = match image.cluster {
            Some(i) => self.fit_cluster(inputs, i),
            None => self.fit_point(
                inputs,
                candidate.position,
                f64::INFINITY,
                candidate.flux_e_per_s * inputs.exposure_s,
            ),
        };
        if let Some(fit) = &image.fit {
            candidate.position = fit.position;
        }
    }

    /// Fits the image of a cluster as the target's.
    fn fit_cluster(&mut self, inputs: TargetContext<'_>, cluster: usize) -> Option<FittedSource> {
        let source = &inputs.sources[cluster];
        let start = TargetStart {
            position: source.centre,
            position_sigma_px: f64::INFINITY,
            flux_e: source.flux_e,
            body_log_width: self.body_log_width(source.flux_e, inputs.exposure_s),
            members: inputs.context.detector.members(cluster),
            is_saturated: source.saturated > 0,
            is_cut: source.is_cut,
        };
        self.fit_target(inputs, &start)
    }

    /// Fits the image of the target at a position without a cluster.
    fn fit_point(
        &mut self,
        inputs: TargetContext<'_>,
        position: PixelPoint,
        position_sigma_px: f64,
        flux_e: f64,
    ) -> Option<FittedSource> {
        let start = TargetStart {
            position,
            position_sigma_px,
            flux_e,
            body_log_width: self.body_log_width(flux_e, inputs.exposure_s),
            members: &[],
            is_saturated: false,
            is_cut: false,
        };
        self.fit_target(inputs, &start)
    }

    fn fit_target(&mut self, inputs: TargetContext<'_>, start: &TargetStart<'_>) -> Option<FittedSource> {
        let is_near = |star: &&KnownSource| {
            star.position.distance(start.position) <= KNOWN_REACH_PX && star.flux_e > 1e-3 * start.flux_e
        };
        let near: Vec<KnownSource> = inputs.known.iter().filter(is_near).copied().collect();
        self.fitter.target(inputs.context, start, &self.psf, &near)
    }

    fn cluster_candidate(
        &self,
        inputs: TargetContext<'_>,
        source: &Source,
        fit: Option<&FittedSource>,
    ) -> TargetCandidate {
        let point_over_pixel = self.point_over_pixel(inputs, source, fit);
        let position = fit.map_or(source.centre, |fit| fit.position);
        let fitted_flux_e = fit.map(|fit| fit.image.flux_e).filter(|flux_e| *flux_e > 0.0);
        let variance_px2 = fit.map_or(0.1, |fit| {
            let [xx, _, yy] = fit.image.covariance_px2;
            xx.max(yy).min(4.0)
        });
        TargetCandidate {
            position,
            variance_px2,
            flux_e_per_s: fitted_flux_e.unwrap_or(source.flux_e) / inputs.exposure_s,
            is_flux_bounded: fitted_flux_e.is_none() && (source.saturated > 0 || source.is_cut),
            weights: cluster_weights(
                source,
                fit,
                point_over_pixel,
                inputs.unlisted_stars,
                inputs.context.threshold_e,
            ),
            point_over_pixel,
            evidence: None,
            attitude_variance_px2: self.attitude_variance_px2(position, inputs.attitude),
        }
    }

    /// Returns the logarithm of the ratio of the likelihoods of the image of a point and of one or two bright
    /// pixels for a cluster: half the difference of the reductions of χ² by either; 0 where the cluster is
    /// not fitted or has few saturated pixels.
    fn point_over_pixel(
        &self,
        inputs: TargetContext<'_>,
        source: &Source,
        fit: Option<&FittedSource>,
    ) -> f64 {
        if source.saturated > MAX_SATURATED_PIXELS {
            return MAX_POINT_OVER_PIXEL;
        }
        let Some(fit) = fit.filter(|_| source.saturated == 0) else { return 0.0 };
        let sigma_e = inputs.context.model.pixel_sigma_e;
        let variance_e2 = sigma_e * sigma_e + source.peak.1.max(0.0);
        let by_point = fit.image.flux_e * fit.image.flux_e * self.psf.image([0.0; 2]).sum_of_squares();
        limited_shape(0.5 * (by_point - source.pair_e2) / variance_e2)
    }

    /// Returns the variance of the position of a star due to the error of the attitude, along the axis with
    /// the larger one, px²; infinite where the camera has no direction.
    fn attitude_variance_px2(&self, position: PixelPoint, attitude: &FrameAttitude) -> f64 {
        let Some((u, v)) = self.model.to_ideal(position) else { return f64::INFINITY };
        let (fx, fy) = self.model.focal_px();
        let covariance = image_covariance(&attitude.error.covariance, u / fx, v / fy, (fx, fy));
        covariance[(0, 0)].max(covariance[(1, 1)])
    }

    pub(super) fn direction(
        &self,
        position: PixelPoint,
        attitude: &FrameAttitude,
    ) -> Option<Direction<Icrs>> {
        Sky { camera_from_icrs: attitude.camera_from_icrs, model: &self.model }.direction(position)
    }

    /// Returns the target at the position predicted by the best track, if no candidate is there: it is too
    /// faint for a cluster, or merged with a star. The evidence of its flux is added to the odds of the
    /// track. Frames in which the target is too faint for detection are thus accumulated along the predicted
    /// motion.
    fn predicted_candidate(
        &mut self,
        inputs: TargetContext<'_>,
        others: &[CandidateImage],
    ) -> Option<CandidateImage> {
        let track = *self.tracks.by_odds().next()?;
        let sigma_px = track.variance_px2().sqrt();
        if track.log_odds() < PREDICTED_LOG_ODDS || sigma_px > PREDICTED_REACH_PX {
            return None;
        }
        let reach_px = 4.0 * sigma_px + 1.0;
        if others.iter().any(|other| other.candidate.position.distance(track.position) <= reach_px) {
            return None;
        }
        let (rate, rate_sigma) = track.flux_e_per_s();
        let expected_e = rate * inputs.exposure_s;
        let fit = self.fit_point(inputs, track.position, sigma_px, expected_e)?;
        let (flux_e, sigma_e) = (fit.image.flux_e, fit.image.flux_sigma_e);
        let log_flux = libm::log((flux_e / expected_e).max(1e-9));
        let evidence = evidence(flux_e, sigma_e, expected_e, rate_sigma * expected_e);
        let is_seen = evidence > 0.0
            && flux_e > PREDICTED_SNR * sigma_e
            && log_flux.abs() < 3.0 * rate_sigma.max(0.3)
            && fit.image.misfit() < CLUTTER_MISFIT;
        let [xx, _, yy] = fit.image.covariance_px2;
        is_seen.then(|| CandidateImage {
            candidate: TargetCandidate {
                position: fit.position,
                variance_px2: xx.max(yy),
                flux_e_per_s: flux_e / inputs.exposure_s,
                is_flux_bounded: false,
                // The candidate continues the track or is dropped: it begins none.
                weights: Hypotheses::of_any_object(0.0),
                point_over_pixel: 0.0,
                evidence: Some(evidence),
                attitude_variance_px2: self.attitude_variance_px2(fit.position, inputs.attitude),
            },
            fit: Some(fit),
            cluster: None,
        })
    }
}

/// Returns the natural logarithm of the ratio of the likelihoods of a measured flux with and without an
/// expected flux.
fn evidence(flux: f64, sigma: f64, expected: f64, expected_sigma: f64) -> f64 {
    let variance = sigma * sigma + expected_sigma * expected_sigma;
    let (with, without) = (flux - expected, flux / sigma);
    0.5 * (without * without - with * with / variance + libm::log(sigma * sigma / variance))
}

/// Returns the clusters that may be the target, brightest first.
fn target_clusters(inputs: TargetContext<'_>, overrides: &Overrides<'_>) -> Vec<usize> {
    let is_hot = |source: &Source| {
        source.spike.is_some()
            || (source.peak.1 > HOT_FRACTION * source.flux_e
                && inputs.context.hot_pixels.contains(source.peak.0))
    };
    let mut clusters: Vec<usize> = (0..inputs.sources.len())
        .filter(|&i| match overrides.identity {
            Some(identity) => identity(inputs.sources[i].centre) == Identity::Neither,
            None => inputs.attitude.star_of[i].is_none() && !is_hot(&inputs.sources[i]),
        })
        .collect();
    clusters.sort_by(|&a, &b| inputs.sources[b].flux_e.total_cmp(&inputs.sources[a].flux_e).then(a.cmp(&b)));
    clusters
}

/// Returns the weights of the hypotheses for a cluster by its brightness and shape only.
fn cluster_weights(
    source: &Source,
    fit: Option<&FittedSource>,
    point_over_pixel: f64,
    unlisted_stars: UnlistedStars,
    threshold_e: f64,
) -> Hypotheses {
    let decrease = -STAR_EXPONENT * libm::log((source.flux_e / threshold_e).max(1e-3));
    let log_chance = libm::log(CHANCE_PER_LOG_FLUX) + decrease;
    let log_pixels = libm::log(PIXELS_PER_LOG_FLUX) + decrease;
    let point = point_log_ratio(source, fit);
    let star = libm::log(unlisted_stars.per_log_flux(source.flux_e)) - log_chance;
    let mut weights = Hypotheses {
        target: libm::log(TARGETS_PER_LOG_FLUX) - log_chance,
        stars: STAR_FRACTIONS.map(|fraction| star + libm::log(fraction)),
        pixel: log_pixels - log_chance,
    };
    weights.add(Hypotheses { pixel: point - point_over_pixel, ..Hypotheses::of_any_object(point) });
    weights
}

/// Returns the weights of the hypotheses for a point below the threshold of clusters.
fn faint_weights(point: &FaintPoint, unlisted_stars: UnlistedStars, threshold_e: f64) -> Hypotheses {
    let log_chance = libm::log(FAINT_CHANCE_PER_LOG_FLUX);
    let decrease = -STAR_EXPONENT * libm::log((point.flux_e / threshold_e).max(1e-3));
    let star = libm::log(unlisted_stars.per_log_flux(point.flux_e)) - log_chance;
    Hypotheses {
        target: libm::log(TARGETS_PER_LOG_FLUX) - log_chance,
        stars: STAR_FRACTIONS.map(|fraction| star + libm::log(fraction)),
        pixel: libm::log(PIXELS_PER_LOG_FLUX) + decrease - log_chance - limited_shape(point.point_over_pixel),
    }
}

/// Returns the logarithm of the likelihood ratio of the image of a point against chance for a cluster; 0 for
/// a cluster whose shape is not known.
fn point_log_ratio(source: &Source, fit: Option<&FittedSource>) -> f64 {
    if source.saturated > FILLED_WELLS {
        return FILLED_LOG_RATIO;
    }
    match fit.filter(|_| source.saturated == 0) {
        None => 0.0,
        Some(fit) if fit.image.misfit() > CLUTTER_MISFIT || fit.image.width < CLUTTER_WIDTH => {
            MISFIT_LOG_RATIO
        }
        Some(_) => POINT_LOG_RATIO,
    }
}

fn limited_shape(log_ratio: f64) -> f64 {
    log_ratio.clamp(-MAX_POINT_OVER_PIXEL, MAX_POINT_OVER_PIXEL)
}
