//! Hypotheses about which cluster is the target: each is a track in the image with the odds that it is the target's.
//!
//! A track moves with constant velocity, disturbed by white acceleration, in the image of the camera. Its odds grow by the likelihood of its
//! clusters, in position and flux, against that of clutter (Bar-Shalom & Li 1995, Multitarget-Multisensor Tracking, Sec. 7.3), and fall
//! when it is not seen and when its cluster moves as the stars do.

use std::collections::VecDeque;

use contract::{Direction, Icrs, PixelPoint};

/// A cluster that may be the target.
#[derive(Debug, Clone, Copy)]
pub(super) struct TargetCandidate {
    pub(super) position: PixelPoint,
    /// Variance of the position along an axis, px².
    pub(super) variance_px2: f64,
    /// Photoelectrons per second.
    pub(super) flux_e_per_s: f64,
    /// Whether the flux is a lower bound, or only a part of the image was transmitted.
    pub(super) is_flux_bounded: bool,
    /// Natural logarithm of the odds that a cluster of this brightness and shape is the target, from this frame alone.
    pub(super) log_odds: f64,
    /// Natural logarithm of the likelihood with over that without the target, of a candidate that was looked for where the best track predicts it.
    pub(super) evidence: Option<f64>,
    /// Direction along the axes of ICRS, by the attitude of this frame.
    pub(super) direction: Option<Direction<Icrs>>,
}

/// A hypothesis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Track {
    pub(super) position: PixelPoint,
    velocity: [f64; 2],
    /// Covariance of position and velocity along either axis: px², px²/s, px²/s².
    covariance: [f64; 3],
    log_flux: f64,
    log_flux_variance: f64,
    pub(super) log_odds: f64,
    /// Frames in which it was seen.
    pub(super) hits: u32,
    misses: u32,
    /// Where its last cluster was, in the image and among the stars.
    last: (PixelPoint, Option<Direction<Icrs>>),
    /// Candidate of the last frame that continues it.
    pub(super) candidate: Option<usize>,
}

/// How tracks move and what clutter there is.
#[derive(Debug, Clone, Copy)]
pub(super) struct TrackModel {
    /// Greatest speed, px/s.
    pub(super) max_speed_px_per_s: f64,
    /// Clutter per px², with any flux.
    pub(super) clutter_per_px2: f64,
    /// Flux of a point at the threshold of clusters, photoelectrons per second.
    pub(super) threshold_e_per_s: f64,
}

/// Disturbance of the position that does not grow with time (jitter of the pointing), px.
const JITTER_PX: f64 = 0.4;

/// Spectral density of the acceleration, px²/s³: half a pixel after 15 s of slow control errors.
const ACCELERATION: f64 = 2e-4;

/// Relative change of the flux from frame to frame, and its growth per root second: a body that turns.
const LOG_FLUX_STEP: f64 = 0.25;
const LOG_FLUX_PER_ROOT_S: f64 = 0.03;

/// Natural logarithm of the flux over that of the visible part of an image.
const LARGEST_HIDDEN: f64 = 1.2;

/// Part of the target's images that are detected, and of those that are not twice as bright as the threshold.
const DETECTED: f64 = 0.95;
const DETECTED_FAINT: f64 = 0.6;

/// Largest likelihood ratio of one frame, natural logarithm: its model of errors holds no further.
const MOST_EVIDENCE: f64 = 8.0;

/// Odds beyond these say nothing more: a track must be able to lose.
const LOG_ODDS: (f64, f64) = (-20.0, 25.0);

/// Loss of odds for a cluster that moved as the stars do, and gain for one that moved as neither stars nor detector do.
const STAR_MOTION: f64 = 6.0;
const OWN_MOTION: f64 = 1.5;

/// Distance from where the stars went within which a cluster moved with them, and beyond which it did not, px.
const WITH_STARS_PX: f64 = 0.8;
const APART_PX: f64 = 2.0;

/// Frames whose candidates are remembered, to tell stars that no list has from the target.
const RECENT_FRAMES: usize = 3;

/// Normalised distance, squared, within which a candidate continues a track.
const GATE: f64 = 20.0;

/// Odds, natural logarithm, from which on a track counts as settled.
const SETTLED: f64 = 12.0;

/// Farthest that a cluster counts as expected by a track, px.
const LARGEST_REACH_PX: f64 = 10.0;

/// Most tracks, and frames without a cluster after which one ends.
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

    /// Moves the track to the next frame.
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

    /// Variance of the predicted position along an axis, px², jitter included.
    pub(super) fn variance_px2(&self) -> f64 {
        self.covariance[0] + JITTER_PX * JITTER_PX
    }

    /// Predicted photoelectrons per second, and their relative standard deviation.
    pub(super) fn flux_e_per_s(&self) -> (f64, f64) {
        (libm::exp(self.log_flux), self.log_flux_variance.sqrt())
    }

    /// Logarithm of the likelihood ratio of a candidate, against clutter; `None` outside the gate.
    fn likelihood(&self, c: &TargetCandidate, model: &TrackModel) -> Option<f64> {
        let variance = self.variance_px2() + c.variance_px2;
        let (dx, dy) = (c.position.x - self.position.x, c.position.y - self.position.y);
        let distance = (dx * dx + dy * dy) / variance;
        let log_flux = libm::log(c.flux_e_per_s.max(1e-9)) - self.log_flux;
        let flux_variance = self.log_flux_variance + LOG_FLUX_STEP * LOG_FLUX_STEP;
        // What a region cuts off and saturation hides is at most some two thirds of the flux.
        let log_flux = if c.is_flux_bounded { (log_flux + LARGEST_HIDDEN).min(0.0) } else { log_flux };
        let flux_distance = log_flux * log_flux / flux_variance;
        if distance + flux_distance > GATE {
            return None;
        }
        let by_position =
            -0.5 * distance - libm::log(std::f64::consts::TAU * variance * model.clutter_per_px2);
        // Clutter has fluxes over some four units of the natural logarithm.
        let by_flux =
            -0.5 * flux_distance - 0.5 * libm::log(std::f64::consts::TAU * flux_variance) + libm::log(4.0);
        Some(libm::log(DETECTED) + by_position.min(MOST_EVIDENCE) + by_flux)
    }

    /// Odds by the motion since the last cluster: `position_of` gives where a direction among the stars is in the image now.
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
        let detected = if is_faint { DETECTED_FAINT } else { DETECTED };
        self.log_odds = (self.log_odds + libm::log(1.0 - detected)).max(LOG_ODDS.0);
        self.misses += 1;
    }
}

/// The hypotheses of a sequence.
#[derive(Debug, Clone, Default)]
pub(super) struct Tracks {
    tracks: Vec<Track>,
    /// Candidates of the last frames, the latest frame first: where they were in the image and among the stars.
    recent: VecDeque<Vec<(PixelPoint, Direction<Icrs>)>>,
}

impl Tracks {
    /// Ends all tracks.
    pub(super) fn clear(&mut self) {
        self.tracks.clear();
        self.recent.clear();
    }

    /// Moves all tracks to the next frame.
    pub(super) fn advance(&mut self, elapsed_s: f64) {
        for track in &mut self.tracks {
            track.advance(elapsed_s);
        }
    }

    /// Returns true if one track has such odds that its target was found.
    pub(super) fn is_settled(&self) -> bool {
        self.tracks.first().is_some_and(|track| track.log_odds > SETTLED && track.misses < 2)
    }

    /// Returns true if the track with the best odds is expected near a position.
    pub(super) fn is_expected(&self, position: PixelPoint) -> bool {
        self.tracks.first().is_some_and(|track| {
            let reach_px = GATE.sqrt() * track.variance_px2().sqrt();
            track.position.distance(position) <= reach_px.min(LARGEST_REACH_PX)
        })
    }

    /// The tracks with the best odds, the best first.
    pub(super) fn by_odds(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter()
    }

    /// Continues tracks with the candidates of a frame, begins new ones and ends those that are lost. A candidate continues the track of the
    /// best odds alone.
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
                    Some(evidence) => (t == 0).then_some(evidence.min(MOST_EVIDENCE)),
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

    /// Where the candidates of the last frames are in the image now if they are stars, as far as the stars have moved since.
    fn moved_with_the_stars(
        &self,
        position_of: &dyn Fn(&Direction<Icrs>) -> Option<PixelPoint>,
    ) -> Vec<PixelPoint> {
        let recent = self.recent.iter().flatten();
        let now = recent.filter_map(|(before, direction)| Some((before, position_of(direction)?)));
        now.filter(|(before, now)| now.distance(**before) > APART_PX).map(|(_, now)| now).collect()
    }
}
