//! All tracks of a sequence: assignment of clusters to tracks, new and lost tracks.

use std::collections::VecDeque;

use contract::{Direction, Icrs, PixelPoint};

use super::hypotheses::{Hypotheses, STARS};
use super::track::{
    EvidenceOfOthers, FrameCandidates, GATE, MAX_LOG_LIKELIHOOD_RATIO, MAX_TRACKS, Sky, TargetCandidate,
    Track,
};

/// Gain of the logarithm of a star's weight for a new cluster that moved with the stars since one of the last
/// frames.
const STAR_MOTION: f64 = 6.0;

/// Distance from the position that moved with the stars below which a cluster moved with them, and motion of
/// the stars above which it is distinguished from rest on the detector, px.
const WITH_STARS_PX: f64 = 0.8;
const APART_PX: f64 = 2.0;

/// Number of previous frames whose candidates are kept, to distinguish unlisted stars from the target.
const RECENT_FRAMES: usize = 3;

/// Natural logarithm of the odds above which a track counts as settled.
const SETTLED_LOG_ODDS: f64 = 12.0;

/// Largest number of tracks besides the best one that expect clusters.
const MAX_EXPECTED: usize = 8;

/// Largest distance at which a track expects a cluster, px.
const MAX_REACH_PX: f64 = 10.0;

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
        self.tracks.first().is_some_and(|track| track.log_odds() > SETTLED_LOG_ODDS && track.misses < 2)
    }

    /// Returns true if the track with the best odds, or one that is no star, is expected near a position. The
    /// shape of a cluster there tells a target at rest on the detector from a pixel.
    pub(super) fn is_expected(&self, position: PixelPoint) -> bool {
        let others = self.tracks.iter().skip(1).filter(|track| track.hypotheses.is_no_star());
        self.tracks.first().into_iter().chain(others.take(MAX_EXPECTED)).any(|track| {
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
    pub(super) fn update(&mut self, frame: &FrameCandidates<'_>) {
        let candidates = frame.candidates;
        let seen_stars = self.seen_stars(frame.sky);
        let of_others: Vec<EvidenceOfOthers> =
            self.tracks.iter_mut().map(|track| track.follow_objects_at_rest(frame)).collect();
        let mut is_taken = vec![false; candidates.len()];
        let mut gains: Vec<Option<f64>> = vec![None; self.tracks.len()];
        for pair in self.pairs(frame, &of_others, &seen_stars) {
            if !is_taken[pair.candidate] && gains[pair.track].is_none() {
                is_taken[pair.candidate] = true;
                gains[pair.track] = Some(pair.gain);
                self.tracks[pair.track].update_with(pair.candidate, &candidates[pair.candidate]);
            }
        }
        for (i, track) in self.tracks.iter_mut().enumerate() {
            let target = gains[i].unwrap_or_else(|| track.log_miss(frame.model));
            track.hypotheses.add(of_others[i].with_target(target));
            track.misses += u32::from(gains[i].is_none());
            let candidate = track.candidate.and_then(|c| candidates.get(c));
            if let Some(c) = candidate.filter(|c| c.evidence.is_none()) {
                track.begin_objects_at_rest(c, frame.sky);
            }
        }
        self.begin(frame, &is_taken, &seen_stars);
        let seen = candidates.iter().filter_map(|c| Some((c.position, frame.sky.direction(c.position)?)));
        self.recent.push_front(seen.collect());
        self.recent.truncate(RECENT_FRAMES);
        self.tracks.retain(Track::is_kept);
        self.tracks.sort_by(|a, b| b.log_odds().total_cmp(&a.log_odds()).then(b.hits.cmp(&a.hits)));
        self.tracks.truncate(MAX_TRACKS);
    }

    /// Returns the possible continuations of tracks by candidates, best resulting odds first. `of_others` is
    /// the evidence for the hypotheses of each track other than the target.
    ///
    /// A candidate at the position of a star that was seen before is that star. If it is not the star that
    /// the track's own hypothesis follows, it is evidence against the target: a track that one star after the
    /// other continues is not the target's.
    fn pairs(
        &self,
        frame: &FrameCandidates<'_>,
        of_others: &[EvidenceOfOthers],
        seen_stars: &[PixelPoint],
    ) -> Vec<Pair> {
        let mut pairs = Vec::new();
        for (t, track) in self.tracks.iter().enumerate() {
            for (c, candidate) in frame.candidates.iter().enumerate() {
                let gain = match candidate.evidence {
                    Some(evidence) => (t == 0).then_some(evidence.min(MAX_LOG_LIKELIHOOD_RATIO)),
                    None => track.likelihood(candidate, frame.model),
                };
                if let Some(mut gain) = gain {
                    let is_own = of_others[t].images.contains(&Some(c));
                    if !is_own && is_star(candidate, seen_stars) {
                        gain -= STAR_MOTION;
                    }
                    let mut hypotheses = track.hypotheses;
                    hypotheses.add(of_others[t].with_target(gain));
                    pairs.push(Pair { log_odds: hypotheses.log_odds(), gain, track: t, candidate: c });
                }
            }
        }
        pairs.sort_by(|a, b| {
            let by_place = (a.track, a.candidate).cmp(&(b.track, b.candidate));
            b.log_odds.total_cmp(&a.log_odds).then(by_place)
        });
        pairs
    }

    /// Begins a track with every candidate that continues none.
    fn begin(&mut self, frame: &FrameCandidates<'_>, is_taken: &[bool], seen_stars: &[PixelPoint]) {
        for (c, candidate) in frame.candidates.iter().enumerate() {
            if is_taken[c] || candidate.evidence.is_some() {
                continue;
            }
            let mut track = Track::new(c, candidate, frame.model, frame.sky);
            let gain = if is_star(candidate, seen_stars) { STAR_MOTION } else { 0.0 };
            track.hypotheses.add(Hypotheses { target: 0.0, stars: [gain; STARS], pixel: 0.0 });
            self.tracks.push(track);
        }
    }

    /// Returns the current image positions of the last frames' candidates, assuming that they are stars,
    /// where the stars have moved far enough since.
    fn seen_stars(&self, sky: Sky<'_>) -> Vec<PixelPoint> {
        let mut seen = Vec::new();
        for (before, direction) in self.recent.iter().flatten() {
            let Some(position) = sky.position(direction) else { continue };
            if position.distance(*before) > APART_PX {
                seen.push(position);
            }
        }
        seen
    }
}

/// Returns true if a candidate is at the position of a star seen before.
fn is_star(candidate: &TargetCandidate, seen_stars: &[PixelPoint]) -> bool {
    let reach_px = WITH_STARS_PX + 2.0 * candidate.variance_px2.sqrt();
    seen_stars.iter().any(|seen| seen.distance(candidate.position) < reach_px)
}

/// Possible continuation of a track by a candidate.
struct Pair {
    /// Natural logarithm of the odds of the track with the candidate.
    log_odds: f64,
    /// Evidence of the candidate for the target.
    gain: f64,
    track: usize,
    candidate: usize,
}
