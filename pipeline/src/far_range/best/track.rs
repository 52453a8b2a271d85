//! Hypotheses for the target's cluster. Each hypothesis is a track in the image with the odds that it is the
//! target's.
//!
//! A track moves with constant velocity, disturbed by white acceleration, in the image of the camera. The
//! weight of the target increases by the ratio of the likelihoods of its clusters, in position and flux, to
//! that of clutter (Bar-Shalom & Li 1995, Multitarget-Multisensor Tracking, Sec. 7.3) and decreases when the
//! track has no cluster. An unlisted star at rest on the sky and a defective pixel at rest on the detector
//! compete with the target for the same clusters ([`Hypotheses`]).

use contract::{CameraFrame, Direction, Icrs, PixelPoint, Rotation};

use super::hypotheses::{Hypotheses, STARS};
use crate::CameraModel;

/// Cluster that may be the target.
#[derive(Debug, Clone, Copy)]
pub(super) struct TargetCandidate {
    pub(super) position: PixelPoint,
    /// Variance of the position along an axis, px².
    pub(super) variance_px2: f64,
    /// Flux, photoelectrons per second.
    pub(super) flux_e_per_s: f64,
    /// True if the flux is a lower bound, or only a part of the image was transmitted.
    pub(super) is_flux_bounded: bool,
    /// Weights of the hypotheses for a cluster of this brightness and shape, from this frame only.
    pub(super) weights: Hypotheses,
    /// Natural logarithm of the ratio of the likelihoods of the image of a point and of one or two bright
    /// pixels.
    pub(super) point_over_pixel: f64,
    /// Natural logarithm of the ratio of the likelihoods with and without the target, for a candidate
    /// searched for at the prediction of the best track.
    pub(super) evidence: Option<f64>,
    /// Variance of the position of a star here, along an axis, due to the error of the attitude, px².
    pub(super) attitude_variance_px2: f64,
}

/// Attitude of a frame and camera model, between directions among the stars and positions in the image.
#[derive(Clone, Copy)]
pub(super) struct Sky<'a> {
    /// Attitude; `None` if unknown.
    pub(super) camera_from_icrs: Option<Rotation<CameraFrame, Icrs>>,
    pub(super) model: &'a CameraModel,
}

impl Sky<'_> {
    /// Returns the position of a direction in the image; `None` without an attitude or outside the model.
    pub(super) fn position(&self, direction: &Direction<Icrs>) -> Option<PixelPoint> {
        self.model.project_vector(&self.camera_from_icrs?.rotate(direction.vector()))
    }

    /// Returns true if the image of a star at a position reaches the detector.
    fn is_near_detector(&self, position: PixelPoint) -> bool {
        let (columns, rows) = self.model.size_px();
        let is_near = |at: f64, size: usize| at >= -EDGE_PX && at <= size as f64 - 1.0 + EDGE_PX;
        is_near(position.x, columns) && is_near(position.y, rows)
    }

    /// Returns the direction at a position in the image; `None` without an attitude or outside the model.
    pub(super) fn direction(&self, position: PixelPoint) -> Option<Direction<Icrs>> {
        Some(self.camera_from_icrs?.inverse() * self.model.back_project(position)?)
    }
}

/// Candidates of a frame, and what their tracks depend on.
#[derive(Clone, Copy)]
pub(super) struct FrameCandidates<'a> {
    pub(super) candidates: &'a [TargetCandidate],
    pub(super) model: &'a TrackModel,
    pub(super) sky: Sky<'a>,
    /// Largest variance of the position of a star in the image, along an axis, due to the error of the
    /// attitude, px².
    pub(super) attitude_variance_px2: f64,
}

/// Evidence of a frame for the hypotheses of a track other than the target.
#[derive(Debug, Clone, Copy)]
pub(super) struct EvidenceOfOthers {
    /// `None` without the direction of the star or the attitude of the frame.
    stars: [Option<f64>; STARS],
    pixel: f64,
    /// Indices of the candidates that are the image of the star.
    pub(super) images: [Option<usize>; STARS],
}

impl EvidenceOfOthers {
    /// Returns the evidence for all hypotheses from that for the target. Without a direction the motion of a
    /// star is as unknown as that of the target, and does not distinguish them.
    pub(super) fn with_target(&self, target: f64) -> Hypotheses {
        Hypotheses { target, stars: self.stars.map(|evidence| evidence.unwrap_or(target)), pixel: self.pixel }
    }
}

/// Star at its mean direction.
type Star = AtRest<Direction<Icrs>>;

/// Object at rest, with its mean position over the frames of a track.
#[derive(Debug, Clone, Copy)]
struct AtRest<P> {
    at: P,
    /// Variance along an axis, px².
    variance_px2: f64,
}

/// Hypothesis for the target.
#[derive(Debug, Clone, Copy)]
pub(super) struct Track {
    pub(super) position: PixelPoint,
    velocity: [f64; 2],
    /// Covariance of position and velocity along either axis: px², px²/s, px²/s².
    covariance: [f64; 3],
    log_flux: f64,
    log_flux_variance: f64,
    pub(super) hypotheses: Hypotheses,
    /// Number of frames with a cluster of this track.
    pub(super) hits: u32,
    pub(super) misses: u32,
    /// Mean directions of the track's object if it is a star, by the scatter of its centroid; `None` without
    /// an attitude.
    stars: [Option<Star>; STARS],
    /// Its direction in the last frame.
    last: Option<Star>,
    /// Position of the track's object if it is a pixel.
    pixel: AtRest<PixelPoint>,
    /// Index of the candidate in the last frame that continues the track.
    pub(super) candidate: Option<usize>,
}

/// Parameters of the tracks' motion and of clutter.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrackModel {
    /// Largest speed, px/s.
    pub(super) max_speed_px_per_s: f64,
    /// Density of clutter of any flux, px⁻².
    pub(super) clutter_per_px2: f64,
    /// Flux of a point at the threshold of clusters, photoelectrons per second.
    pub(super) threshold_e_per_s: f64,
}

/// Position disturbance that does not grow with time (pointing jitter), px.
const JITTER_PX: f64 = 0.4;

/// Spectral density of the acceleration, px²/s³: half a pixel after 15 s of slow control errors.
const ACCELERATION: f64 = 2e-4;

/// Relative change of the flux from frame to frame, and its growth per root second: a rotating body.
const LOG_FLUX_STEP: f64 = 0.25;
const LOG_FLUX_PER_ROOT_S: f64 = 0.03;

/// Natural logarithm of the largest ratio of the total flux to that of the visible part of an image.
const MAX_LOG_TOTAL_OVER_VISIBLE: f64 = 1.2;

/// Detection probability of the target's image, and that of an image less than twice as bright as the
/// threshold.
const DETECTION_PROBABILITY: f64 = 0.95;
const FAINT_DETECTION_PROBABILITY: f64 = 0.6;

/// Largest likelihood ratio of one frame, natural logarithm: the error model is not valid beyond it.
pub(super) const MAX_LOG_LIKELIHOOD_RATIO: f64 = 8.0;

/// The same limit for the position of an object at rest, which is predicted better than that of the target.
const MAX_AT_REST: f64 = 11.0;

/// Error of the position of an object at rest on the sky or on the detector in addition to those of centroid
/// and attitude (distortion, aberration, response of the pixels), px.
const AT_REST_PX: f64 = 0.1;

/// Standard deviations of the centroid of a star besides those of fit and attitude, px: a single star, a
/// close pair, a wide pair whose images are separated in some frames.
const STAR_SCATTER_PX: [f64; STARS] = [AT_REST_PX, 0.5, 1.5];

/// Distance of a star outside the detector whose image still reaches it, px.
const EDGE_PX: f64 = 4.0;

/// Largest squared normalised distance of a candidate that continues a track.
pub(super) const GATE: f64 = 20.0;

/// Smallest natural logarithm of the odds of a track that is kept without a cluster.
const MIN_KEPT_LOG_ODDS: f64 = -10.0;

/// Largest number of tracks, and numbers of frames without a cluster after which a track ends: one of several
/// clusters, and one of a single cluster, whose speed is unknown.
pub(super) const MAX_TRACKS: usize = 1000;
const MAX_MISSES: u32 = 20;
const MAX_MISSES_OF_NEW: u32 = 2;

impl Track {
    pub(super) fn new(candidate: usize, c: &TargetCandidate, model: &TrackModel, sky: Sky<'_>) -> Self {
        let speed = model.max_speed_px_per_s / 2.0;
        Self {
            position: c.position,
            velocity: [0.0; 2],
            covariance: [c.variance_px2, 0.0, speed * speed],
            log_flux: libm::log(c.flux_e_per_s.max(1e-9)),
            log_flux_variance: LOG_FLUX_STEP * LOG_FLUX_STEP,
            hypotheses: c.weights,
            hits: 1,
            misses: 0,
            stars: STAR_SCATTER_PX.map(|scatter_px| star_at(c, scatter_px, sky)),
            last: star_at(c, AT_REST_PX, sky),
            pixel: AtRest { at: c.position, variance_px2: c.variance_px2 },
            candidate: Some(candidate),
        }
    }

    /// Advances the track to the next frame.
    pub(super) fn advance(&mut self, elapsed_s: f64) {
        let dt = elapsed_s;
        self.position =
            PixelPoint::new(self.position.x + self.velocity[0] * dt, self.position.y + self.velocity[1] * dt);
        let [pp, pv, vv] = self.covariance;
        self.covariance = [
            pp + 2.0 * dt * pv + dt * dt * vv + ACCELERATION * dt * dt * dt / 3.0,
            pv + dt * vv + ACCELERATION * dt * dt / 2.0,
            vv + ACCELERATION * dt,
        ];
        self.log_flux_variance +=
            LOG_FLUX_STEP * LOG_FLUX_STEP + LOG_FLUX_PER_ROOT_S * LOG_FLUX_PER_ROOT_S * dt;
        self.candidate = None;
    }

    /// Returns the variance of the predicted position along an axis, including jitter, px².
    pub(super) fn variance_px2(&self) -> f64 {
        self.covariance[0] + JITTER_PX * JITTER_PX
    }

    /// Returns the predicted photoelectrons per second, and their relative standard deviation.
    pub(super) fn flux_e_per_s(&self) -> (f64, f64) {
        (libm::exp(self.log_flux), self.log_flux_variance.sqrt())
    }

    /// Returns the logarithm of the likelihood ratio of a candidate against clutter; `None` outside the gate.
    pub(super) fn likelihood(&self, c: &TargetCandidate, model: &TrackModel) -> Option<f64> {
        let variance = self.variance_px2() + c.variance_px2;
        let distance = squared_distance(self.position, c.position) / variance;
        if distance > GATE {
            return None;
        }
        let flux_distance = self.flux_distance(c);
        if distance + flux_distance > GATE {
            return None;
        }
        let log_density = if self.hits == 1 {
            self.log_density_of_unknown_speed(c)
        } else {
            log_normal_density(distance, variance)
        };
        Some(self.log_likelihood_ratio(log_density, flux_distance, model, MAX_LOG_LIKELIHOOD_RATIO))
    }

    /// Returns the natural logarithm of the density of the position of a candidate, px⁻², for a track of a
    /// single cluster. Slow targets are more frequent than fast ones: the logarithm of the speed is uniform
    /// up to the largest speed. With the distance r, the largest distance R and the error s of a position,
    /// the density is 1/[π (r² + s²) ln(1 + R²/s²)].
    fn log_density_of_unknown_speed(&self, c: &TargetCandidate) -> f64 {
        let error_px2 = 2.0 * (c.variance_px2 + JITTER_PX * JITTER_PX);
        // The standard deviation of the predicted position is half of the largest distance.
        let largest_px2 = 4.0 * self.covariance[0];
        let squares_px2 = squared_distance(self.position, c.position) + error_px2;
        -libm::log(std::f64::consts::PI * squares_px2 * libm::log1p(largest_px2 / error_px2))
    }

    /// Returns the squared normalised difference of the natural logarithms of measured and predicted flux.
    fn flux_distance(&self, c: &TargetCandidate) -> f64 {
        let log_flux = libm::log(c.flux_e_per_s.max(1e-9)) - self.log_flux;
        // Truncation by a region and saturation hide at most some two thirds of the flux.
        let log_flux =
            if c.is_flux_bounded { (log_flux + MAX_LOG_TOTAL_OVER_VISIBLE).min(0.0) } else { log_flux };
        log_flux * log_flux / self.flux_variance()
    }

    fn flux_variance(&self) -> f64 {
        self.log_flux_variance + LOG_FLUX_STEP * LOG_FLUX_STEP
    }

    /// Returns ln [P_D p(position) N(ln F)/(clutter density)] for the natural logarithm of the density of the
    /// position, px⁻², and the squared normalised distance of the flux. The part of the position is at most
    /// `limit`.
    fn log_likelihood_ratio(
        &self,
        log_density: f64,
        flux_distance: f64,
        model: &TrackModel,
        limit: f64,
    ) -> f64 {
        let by_position = log_density - libm::log(model.clutter_per_px2);
        // The fluxes of clutter cover some four units of the natural logarithm.
        let by_flux = -0.5 * flux_distance - 0.5 * libm::log(std::f64::consts::TAU * self.flux_variance())
            + libm::log(4.0);
        libm::log(DETECTION_PROBABILITY) + by_position.min(limit) + by_flux
    }

    /// Returns the evidence of a frame for an object that is expected at `position` with the variance
    /// `variance_px2` along an axis besides that of the candidates, and the candidate that is most likely the
    /// object, by its index. The sum of both cases, that the object has an image and that it has none, is the
    /// likelihood.
    fn evidence_at(
        &self,
        position: PixelPoint,
        variance_px2: f64,
        frame: &FrameCandidates<'_>,
        of_shape: fn(&TargetCandidate) -> f64,
    ) -> (f64, Option<usize>) {
        if !frame.sky.is_near_detector(position) {
            return (0.0, None);
        }
        let mut best: Option<(f64, usize)> = None;
        for (index, c) in frame.candidates.iter().enumerate() {
            let variance = variance_px2 + c.variance_px2;
            let distance = squared_distance(position, c.position) / variance;
            if distance > GATE {
                continue;
            }
            let flux_distance = self.flux_distance(c);
            if distance + flux_distance > GATE {
                continue;
            }
            let log_density = log_normal_density(distance, variance);
            let gain =
                self.log_likelihood_ratio(log_density, flux_distance, frame.model, MAX_AT_REST) + of_shape(c);
            if best.is_none_or(|(other, _)| gain > other) {
                best = Some((gain, index));
            }
        }
        let missed = self.log_miss(frame.model);
        match best {
            None => (missed, None),
            Some((gain, index)) => (log_sum(gain, missed), (gain > missed).then_some(index)),
        }
    }

    /// Returns the evidence of a frame for the hypotheses other than the target, and moves their objects
    /// towards their candidates. Each object has its own candidate.
    pub(super) fn follow_objects_at_rest(&mut self, frame: &FrameCandidates<'_>) -> EvidenceOfOthers {
        let pixel = self.follow_pixel(frame);
        let mut evidence = EvidenceOfOthers { stars: [None; STARS], pixel, images: [None; STARS] };
        let mut about_mean = None;
        for (i, scatter_px) in STAR_SCATTER_PX.into_iter().enumerate() {
            about_mean = self.star_evidence(&self.stars[i], scatter_px, frame);
            evidence.stars[i] = about_mean.map(|(evidence, _)| evidence);
            evidence.images[i] = about_mean.and_then(|(_, image)| image);
            if let Some(c) = evidence.images[i].and_then(|image| frame.candidates.get(image)) {
                self.stars[i] = updated_star(self.stars[i], c, scatter_px, frame.sky);
            }
        }
        // The images of a wide pair are separated or not: the centroid is that of the last frame, or anywhere
        // about the mean.
        let at_last = self.star_evidence(&self.last, AT_REST_PX, frame);
        if let (Some((by_mean, of_mean)), Some((by_last, of_last))) = (about_mean, at_last) {
            evidence.stars[STARS - 1] = Some(log_sum(by_mean, by_last) - std::f64::consts::LN_2);
            let image = if by_last > by_mean { of_last } else { of_mean };
            evidence.images[STARS - 1] = image;
            if let Some(c) = image.and_then(|image| frame.candidates.get(image)) {
                self.last = star_at(c, AT_REST_PX, frame.sky);
            }
        }
        evidence
    }

    /// Begins the objects at rest anew with a candidate where that has the larger weight (the clusters before
    /// were chance, and this one is a star or a pixel that is seen for the first time), and the stars where
    /// no direction was known before.
    pub(super) fn begin_objects_at_rest(&mut self, c: &TargetCandidate, sky: Sky<'_>) {
        for (i, scatter_px) in STAR_SCATTER_PX.into_iter().enumerate() {
            let is_first = self.stars[i].is_none();
            if c.weights.stars[i] > self.hypotheses.stars[i] {
                self.hypotheses.stars[i] = c.weights.stars[i];
            } else if !is_first {
                continue;
            }
            self.stars[i] = star_at(c, scatter_px, sky);
            self.last = star_at(c, AT_REST_PX, sky);
        }
        if c.weights.pixel > self.hypotheses.pixel {
            self.hypotheses.pixel = c.weights.pixel;
            self.pixel = AtRest { at: c.position, variance_px2: c.variance_px2 };
        }
    }

    /// Returns the evidence of a frame for a pixel, and moves the mean position of the pixel.
    fn follow_pixel(&mut self, frame: &FrameCandidates<'_>) -> f64 {
        let variance_px2 = self.pixel.variance_px2 + AT_REST_PX * AT_REST_PX;
        let (evidence, candidate) =
            self.evidence_at(self.pixel.at, variance_px2, frame, |c| -c.point_over_pixel);
        if let Some(c) = candidate.and_then(|index| frame.candidates.get(index)) {
            let k = self.pixel.variance_px2 / (self.pixel.variance_px2 + c.variance_px2);
            let at = weighted_mean(self.pixel.at, c.position, k);
            self.pixel = AtRest { at, variance_px2: (1.0 - k) * self.pixel.variance_px2 };
        }
        evidence
    }

    /// Returns the evidence for a star whose centroid has the standard deviation `scatter_px`, and its
    /// candidate, by its index; `None` without its direction or the attitude of the frame.
    fn star_evidence(
        &self,
        star: &Option<Star>,
        scatter_px: f64,
        frame: &FrameCandidates<'_>,
    ) -> Option<(f64, Option<usize>)> {
        let star = star.as_ref()?;
        frame.sky.camera_from_icrs?;
        // A star outside the camera's model has no image.
        let Some(position) = frame.sky.position(&star.at) else { return Some((0.0, None)) };
        let variance_px2 = star.variance_px2 + frame.attitude_variance_px2 + scatter_px * scatter_px;
        Some(self.evidence_at(position, variance_px2, frame, |_| 0.0))
    }

    /// Returns the natural logarithm of the probability that an object of the track's flux has no image.
    pub(super) fn log_miss(&self, model: &TrackModel) -> f64 {
        let is_faint = libm::exp(self.log_flux) < 2.0 * model.threshold_e_per_s;
        let detected = if is_faint { FAINT_DETECTION_PROBABILITY } else { DETECTION_PROBABILITY };
        libm::log(1.0 - detected)
    }

    /// Returns the natural logarithm of the odds that the track is the target's.
    pub(super) fn log_odds(&self) -> f64 {
        self.hypotheses.log_odds()
    }

    /// Returns true if the track may still become the target's.
    pub(super) fn is_kept(&self) -> bool {
        let most = if self.hits > 1 { MAX_MISSES } else { MAX_MISSES_OF_NEW };
        self.misses <= most && (self.misses == 0 || self.log_odds() > MIN_KEPT_LOG_ODDS)
    }

    pub(super) fn update_with(&mut self, index: usize, c: &TargetCandidate) {
        let [pp, pv, vv] = self.covariance;
        let measured = c.variance_px2 + JITTER_PX * JITTER_PX;
        let (kp, kv) = (pp / (pp + measured), pv / (pp + measured));
        let (dx, dy) = (c.position.x - self.position.x, c.position.y - self.position.y);
        self.position = PixelPoint::new(self.position.x + kp * dx, self.position.y + kp * dy);
        self.velocity = [self.velocity[0] + kv * dx, self.velocity[1] + kv * dy];
        self.covariance = [(1.0 - kp) * pp, (1.0 - kp) * pv, vv - kv * pv];
        let flux_noise = LOG_FLUX_STEP * LOG_FLUX_STEP * if c.is_flux_bounded { 16.0 } else { 1.0 };
        let k = self.log_flux_variance / (self.log_flux_variance + flux_noise);
        self.log_flux += k * (libm::log(c.flux_e_per_s.max(1e-9)) - self.log_flux);
        self.log_flux_variance *= 1.0 - k;
        self.hits += 1;
        self.misses = 0;
        self.candidate = Some(index);
    }
}

/// Returns the star that a candidate would be. `scatter_px` is the standard deviation of its centroid besides
/// that of the candidate.
fn star_at(c: &TargetCandidate, scatter_px: f64, sky: Sky<'_>) -> Option<Star> {
    let variance_px2 = c.variance_px2 + c.attitude_variance_px2 + scatter_px * scatter_px;
    sky.direction(c.position).map(|at| AtRest { at, variance_px2 })
}

/// Returns a star moved towards a candidate; a new one at the candidate if it was not known.
fn updated_star(star: Option<Star>, c: &TargetCandidate, scatter_px: f64, sky: Sky<'_>) -> Option<Star> {
    let predicted = star.and_then(|star| Some((star, sky.position(&star.at)?)));
    let Some((star, position)) = predicted else { return star_at(c, scatter_px, sky) };
    let measured = c.variance_px2 + c.attitude_variance_px2 + scatter_px * scatter_px;
    let k = star.variance_px2 / (star.variance_px2 + measured);
    let variance_px2 = (1.0 - k) * star.variance_px2 + AT_REST_PX * AT_REST_PX;
    sky.direction(weighted_mean(position, c.position, k)).map(|at| AtRest { at, variance_px2 })
}

/// Returns the natural logarithm of the density of a normal distribution in the image, px⁻², at a squared
/// normalised distance. `variance_px2` is its variance along an axis.
fn log_normal_density(distance: f64, variance_px2: f64) -> f64 {
    -0.5 * distance - libm::log(std::f64::consts::TAU * variance_px2)
}

/// Returns ln (eᵃ + eᵇ).
fn log_sum(a: f64, b: f64) -> f64 {
    a.max(b) + libm::log1p(libm::exp(-(a - b).abs()))
}

/// Returns the squared distance of two positions, px².
fn squared_distance(a: PixelPoint, b: PixelPoint) -> f64 {
    let (dx, dy) = (a.x - b.x, a.y - b.y);
    dx * dx + dy * dy
}

/// Returns (1 − k) a + k b.
fn weighted_mean(a: PixelPoint, b: PixelPoint, k: f64) -> PixelPoint {
    PixelPoint::new(a.x + k * (b.x - a.x), a.y + k * (b.y - a.y))
}
