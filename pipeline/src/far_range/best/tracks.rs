//! Hypotheses for the target's cluster. Each hypothesis is a track in the image with the odds that it is the
//! target's.
//!
//! A track moves with constant velocity, disturbed by white acceleration, in the image of the camera. Its
//! odds increase by the ratio of the likelihoods of its clusters, in position and flux, to that of clutter
//! (Bar-Shalom & Li 1995, Multitarget-Multisensor Tracking, Sec. 7.3). They decrease when the track has no
//! cluster and when its cluster moves with the stars.

use std::collections::VecDeque;

use contract::{Direction, Icrs, PixelPoint};

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
    /// Natural logarithm of the odds that a cluster of this brightness and shape is the target, from this
    /// frame only.
    pub(super) log_odds: f64,
    /// Natural logarithm of the ratio of the likelihoods with and without the target, for a candidate
    /// searched for at the prediction of the best track.
    pub(super) evidence: Option<f64>,
    /// Direction along the axes of ICRS, by the attitude of this frame.
    pub(super) direction: Option<Direction<Icrs>>,
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
    pub(super) log_odds: f64,
    /// Number of frames with a cluster of this track.
    pub(super) hits: u32,
    misses: u32,
    /// Position of the last cluster in the image, and its direction among the stars.
    last: (PixelPoint, Option<Direction<Icrs>>),
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
const MAX_LOG_LIKELIHOOD_RATIO: f64 = 8.0;

/// Limits of the logarithm of the odds. Odds beyond the limits carry no further information, and a track must
/// remain able to lose.
const LOG_ODDS: (f64, f64) = (-20.0, 25.0);

/// Reduction of the logarithm of the odds for a cluster that moved with the stars, and gain for one that
/// moved neither with the stars nor with the detector.
const STAR_MOTION: f64 = 6.0;
const OWN_MOTION: f64 = 1.5;

/// Distance from the position that moved with the stars, px: below the first limit a cluster moved with them,
/// above the second it did not.
const WITH_STARS_PX: f64 = 0.8;
const APART_PX: f64 = 2.0;

/// Number of previous frames whose candidates are kept, to distinguish unlisted stars from the target.
const RECENT_FRAMES: usize = 3;

/// Largest squared normalised distance of a candidate that continues a track.
const GATE: f64 = 20.0;

/// Natural logarithm of the odds above which a track counts as settled.
const SETTLED_LOG_ODDS: f64 = 12.0;

/// Largest distance at which a track expects a cluster, px.
const MAX_REACH_PX: f64 = 10.0;

/// Largest number of tracks, and number of frames without a cluster after which a track ends.
const MAX_TRACKS: usize = 64;
const MAX_MISSES: u32 = 20;

impl Track {
    fn new(candidate: usize, c: &TargetCandidate, model: &TrackModel) -> Self {
        let speed = model.max_speed_px_per_s / 2.0;
        Self {
            position: c.position,
            velocity: [0.0; 2],
            covariance: [c.variance_px2, 0.0, speed * speed],
            log_flux: libm::log(c.flux_e_per_s.max(1e-9)),
            log_flux_variance: LOG_FLUX_STEP * LOG_FLUX_STEP,
            log_odds: c.log_odds.clamp(LOG_ODDS.0, LOG_ODDS.1),
            hits: 1,
            misses: 0,
            last: (c.position, c.direction),
            candidate: Some(candidate),
        }
    }

    /// Advances the track to the next frame.
    fn advance(&mut self, elapsed_s: f64) {
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
    fn likelihood(&self, c: &TargetCandidate, model: &TrackModel) -> Option<f64> {
        let variance = self.variance_px2() + c.variance_px2;
        let (dx, dy) = (c.position.x - self.position.x, c.position.y - self.position.y);
        let distance = (dx * dx + dy * dy) / variance;
        let log_flux = libm::log(c.flux_e_per_s.max(1e-9)) - self.log_flux;
        let flux_variance = self.log_flux_variance + LOG_FLUX_STEP * LOG_FLUX_STEP;
        // Truncation by a region and saturation hide at most some two thirds of the flux.
        let log_flux =
            if c.is_flux_bounded { (log_flux + MAX_LOG_TOTAL_OVER_VISIBLE).min(0.0) } else { log_flux };
        let flux_distance = log_flux * log_flux / flux_variance;
        if distance + flux_distance > GATE {
            return None;
        }
        let by_position =
            -0.5 * distance - libm::log(std::f64::consts::TAU * variance * model.clutter_per_px2);
        // The fluxes of clutter cover some four units of the natural logarithm.
        let by_flux =
            -0.5 * flux_distance - 0.5 * libm::log(std::f64::consts::TAU * flux_variance) + libm::log(4.0);
        Some(libm::log(DETECTION_PROBABILITY) + by_position.min(MAX_LOG_LIKELIHOOD_RATIO) + by_flux)
    }

    /// Returns the change of the logarithm of the odds by the motion since the last cluster. `position_of`
    /// returns the current image position of a direction among the stars.
    fn motion_odds(
        &self,
        c: &TargetCandidate,
        position_of: &dyn Fn(&Direction<Icrs>) -> Option<PixelPoint>,
    ) -> f64 {
        let (position, direction) = &self.last;
        let Some(with_stars) = direction.as_ref().and_then(position_of) else { return 0.0 };
        let star_step = with_stars.distance(*position);
        let from_stars = with_stars.distance(c.position);
        if from_stars < WITH_STARS_PX && star_step > APART_PX {
            -STAR_MOTION
        } else if self.hits > 1 && from_stars > APART_PX && position.distance(c.position) > APART_PX {
            OWN_MOTION
        } else {
            0.0
        }
    }

    fn update_with(&mut self, index: usize, c: &TargetCandidate, gain: f64) {
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
        self.log_odds = (self.log_odds + gain).clamp(LOG_ODDS.0, LOG_ODDS.1);
        self.last = (c.position, c.direction);
        self.hits += 1;
        self.misses = 0;
        self.candidate = Some(index);
    }

    fn register_miss(&mut self, model: &TrackModel) {
        let is_faint = libm::exp(self.log_flux) < 2.0 * model.threshold_e_per_s;
        let detected = if is_faint { FAINT_DETECTION_PROBABILITY } else { DETECTION_PROBABILITY };
        self.log_odds = (self.log_odds + libm::log(1.0 - detected)).max(LOG_ODDS.0);
        self.misses += 1;
    }
}

/// Hypotheses of a sequence.
#[derive(Debug, Clone, Default)]
pub(super) struct Tracks {
    tracks: Vec<Track>,
    /// Candidates of the last frames, latest frame first: position in the image and direction among the
    /// stars.
    recent: VecDeque<Vec<(PixelPoint, Direction<Icrs>)>>,
}

impl Tracks {
    /// Ends all tracks.
    pub(super) fn clear(&mut self) {
        self.tracks.clear();
        self.recent.clear();
    }

    /// Advances all tracks to the next frame.
    pub(super) fn advance(&mut self, elapsed_s: f64) {
        for track in &mut self.tracks {
            track.advance(elapsed_s);
        }
    }

    /// Returns true if the odds of the best track suffice to regard its target as found.
    pub(super) fn is_settled(&self) -> bool {
        self.tracks.first().is_some_and(|track| track.log_odds > SETTLED_LOG_ODDS && track.misses < 2)
    }

    /// Returns true if the track with the best odds is expected near a position.
    pub(super) fn is_expected(&self, position: PixelPoint) -> bool {
        self.tracks.first().is_some_and(|track| {
            let reach_px = GATE.sqrt() * track.variance_px2().sqrt();
            track.position.distance(position) <= reach_px.min(MAX_REACH_PX)
        })
    }

    /// Returns the tracks in order of their odds, best first.
    pub(super) fn by_odds(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter()
    }

    /// Continues tracks with the candidates of a frame, begins new tracks and ends lost ones. A candidate
    /// continues only the track with the best odds.
    pub(super) fn update(
        &mut self,
        candidates: &[TargetCandidate],
        model: &TrackModel,
        position_of: &dyn Fn(&Direction<Icrs>) -> Option<PixelPoint>,
    ) {
        let mut pairs: Vec<(f64, f64, usize, usize)> = Vec::new();
        for (t, track) in self.tracks.iter().enumerate() {
            for (c, candidate) in candidates.iter().enumerate() {
                let gain = match candidate.evidence {
                    Some(evidence) => (t == 0).then_some(evidence.min(MAX_LOG_LIKELIHOOD_RATIO)),
                    None => track.likelihood(candidate, model),
                };
                if let Some(gain) = gain {
                    let gain = gain + track.motion_odds(candidate, position_of);
                    pairs.push((track.log_odds + gain, gain, t, c));
                }
            }
        }
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.2.cmp(&b.2)).then(a.3.cmp(&b.3)));
        let mut is_taken = vec![false; candidates.len()];
        for (_, gain, t, c) in pairs {
            if !is_taken[c] && self.tracks[t].candidate.is_none() {
                is_taken[c] = true;
                self.tracks[t].update_with(c, &candidates[c], gain);
            }
        }
        for track in self.tracks.iter_mut().filter(|track| track.candidate.is_none()) {
            track.register_miss(model);
        }
        let with_stars = self.moved_with_the_stars(position_of);
        for (c, candidate) in candidates.iter().enumerate() {
            if is_taken[c] || candidate.evidence.is_some() {
                continue;
            }
            let reach_px = WITH_STARS_PX + 2.0 * candidate.variance_px2.sqrt();
            let is_star = with_stars.iter().any(|at| at.distance(candidate.position) < reach_px);
            let mut track = Track::new(c, candidate, model);
            track.log_odds -= if is_star { STAR_MOTION } else { 0.0 };
            self.tracks.push(track);
        }
        self.recent.push_front(candidates.iter().filter_map(|c| Some((c.position, c.direction?))).collect());
        self.recent.truncate(RECENT_FRAMES);
        self.tracks
            .retain(|track| track.misses <= MAX_MISSES && (track.misses == 0 || track.log_odds > -10.0));
        self.tracks.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds).then(b.hits.cmp(&a.hits)));
        self.tracks.truncate(MAX_TRACKS);
    }

    /// Returns the current image positions of the last frames' candidates, assuming that they are stars,
    /// where the stars have moved far enough since.
    fn moved_with_the_stars(
        &self,
        position_of: &dyn Fn(&Direction<Icrs>) -> Option<PixelPoint>,
    ) -> Vec<PixelPoint> {
        let recent = self.recent.iter().flatten();
        let now = recent.filter_map(|(before, direction)| Some((before, position_of(direction)?)));
        now.filter(|(before, now)| now.distance(**before) > APART_PX).map(|(_, now)| now).collect()
    }
}
