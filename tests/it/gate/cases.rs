//! Synthetic and simulated runs as input of the gate, with faults of a stated size.

use boresight::far_range::scoring::{
    AnswerError, AttitudeUsed, Cause, FrameVerdict, LineOfSightError, MistakenObject, Verdict, WithinLimits,
    unit_table,
};
use boresight::gate::{Baseline, CompareOptions, Identity, Pairing, Sample, SourceKind, compare};
use boresight::score::UnitTable;
use contract::{Angle, AttitudeSource};
use draws::{Effect, Seed, Stream, normal, uniform};

/// Size of a pixel, degrees.
const PIXEL_DEG: f64 = 0.024;

/// A fault in a pipeline, of a stated size.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Fault {
    /// This fraction of the detections is missed.
    LostHits(f64),
    /// All measurements are shifted along the columns, px.
    Shift(f64),
    /// All errors are larger by this factor.
    LargerErrors(f64),
    /// All measurements are shifted along the rows, px, away from zero: in the direction of their existing
    /// bias.
    Bias(f64),
    /// The fraction of wrong frames increases by this amount.
    MoreWrong(f64),
    /// The attitude is no longer solved in this fraction of the frames.
    FewerAttitudes(f64),
    /// Nothing is detected in a contiguous part of the frames, given by its two ends as fractions of the run.
    Blackout(f64, f64),
}

/// Faults that a gate with 900 frames must catch.
pub(crate) const FAULTS: [Fault; 15] = [
    Fault::LostHits(0.03),
    Fault::Shift(0.5),
    Fault::LargerErrors(1.2),
    Fault::Bias(0.1),
    Fault::MoreWrong(0.025),
    Fault::FewerAttitudes(0.03),
    Fault::Blackout(0.0, 0.05),
    Fault::Blackout(0.5, 0.55),
    Fault::Blackout(0.95, 1.0),
    Fault::Blackout(0.0, 0.1),
    Fault::Blackout(0.45, 0.55),
    Fault::Blackout(0.9, 1.0),
    Fault::Blackout(0.0, 0.25),
    Fault::Blackout(0.4, 0.65),
    Fault::Blackout(0.75, 1.0),
];

impl Fault {
    /// Returns the run of a pipeline with the fault.
    pub(crate) fn plant(self, frames: &[FrameVerdict], seed: u64) -> Vec<FrameVerdict> {
        let random = &mut Seed { seed, case: 1 }.stream(0, Effect::CaseSeed, 0);
        let correct = frames.iter().filter(|frame| matches!(frame.verdict, Verdict::Correct { .. })).count();
        let correct = correct as f64 / frames.len() as f64;
        let dec_of = |frame: &FrameVerdict| match frame.verdict {
            Verdict::Correct { error } => dec_deg(error),
            _ => 0.0,
        };
        let away = frames.iter().map(dec_of).sum::<f64>().signum() * PIXEL_DEG;
        let mut faulty = frames.to_vec();
        let count = frames.len() as f64;
        for (place, frame) in faulty.iter_mut().enumerate() {
            let u = uniform(random);
            let place = place as f64 / count;
            frame.verdict = match (frame.verdict, self) {
                (Verdict::Correct { .. } | Verdict::Wrong { .. }, Self::LostHits(share)) if u < share => {
                    Verdict::Missed { cause: Cause::NotLinked }
                }
                (Verdict::Correct { error }, Self::MoreWrong(share)) if u < share / correct => {
                    Verdict::Wrong { error, taken: MistakenObject::Nothing, cause: Cause::LostMotionTest }
                }
                (_, Self::Blackout(begin, end)) if (begin..end).contains(&place) => {
                    Verdict::Missed { cause: Cause::BelowThreshold }
                }
                (verdict, Self::Shift(px)) => with_error(verdict, |ra, dec| (ra + px * PIXEL_DEG, dec)),
                (verdict, Self::Bias(px)) => with_error(verdict, |ra, dec| (ra, dec + px * away)),
                (verdict, Self::LargerErrors(factor)) => {
                    with_error(verdict, |ra, dec| (ra * factor, dec * factor))
                }
                (verdict, _) => verdict,
            };
            if let Self::FewerAttitudes(share) = self
                && u < share
            {
                frame.attitude_source = Some(AttitudeSource::NoStars);
            }
        }
        faulty
    }
}

fn dec_deg(error: AnswerError) -> f64 {
    error.line_of_sight.map_or(0.0, |error| error.dec.degrees())
}

/// Error, degrees, of a pipeline with its own attitude: the centroid causes all of it.
fn error_from_degrees(ra: f64, dec: f64) -> AnswerError {
    let line_of_sight = LineOfSightError {
        ra: Angle::from_degrees(ra),
        dec: Angle::from_degrees(dec),
        attitude: AttitudeUsed::Own,
    };
    AnswerError {
        centroid_px: Some([ra / PIXEL_DEG, dec / PIXEL_DEG]),
        line_of_sight: Some(line_of_sight),
        centroid_normalised: None,
        line_of_sight_normalised: None,
    }
}

/// Returns a verdict with a changed error, degrees.
fn with_error(verdict: Verdict, change: impl Fn(f64, f64) -> (f64, f64)) -> Verdict {
    let changed = |error: AnswerError| {
        let ra_deg = error.line_of_sight.map_or(0.0, |error| error.ra.degrees());
        let (ra, dec) = change(ra_deg, dec_deg(error));
        error_from_degrees(ra, dec)
    };
    match verdict {
        Verdict::Correct { error } => Verdict::Correct { error: changed(error) },
        Verdict::Wrong { error, taken, cause } => Verdict::Wrong { error: changed(error), taken, cause },
        missed => missed,
    }
}

/// Returns the run of one of several equally good pipelines: every error has independent noise of a tenth of
/// a pixel, and one frame in fifty has the verdict of another frame.
pub(crate) fn harmless(frames: &[FrameVerdict], seed: u64, pipeline: u64) -> Vec<FrameVerdict> {
    let random = &mut Seed { seed, case: 2 + pipeline }.stream(0, Effect::CaseSeed, 0);
    let mut changed = frames.to_vec();
    for frame in &mut changed {
        if uniform(random) < 0.02 {
            let other = ((uniform(random) * frames.len() as f64) as usize).min(frames.len() - 1);
            frame.verdict = frames[other].verdict;
        }
        let [a, b] = [(); 2].map(|()| 0.1 * PIXEL_DEG * normal(random));
        frame.verdict = with_error(frame.verdict, |ra, dec| (ra + a, dec + b));
    }
    changed
}

/// Returns the run of one of several equally good pipelines that differ in episodes: an episode begins at one
/// frame in forty, lasts eight frames on average, and has the verdicts of another part of the run.
pub(crate) fn harmless_in_episodes(frames: &[FrameVerdict], seed: u64, pipeline: u64) -> Vec<FrameVerdict> {
    let random = &mut Seed { seed, case: 4 + pipeline }.stream(0, Effect::CaseSeed, 0);
    let mut changed = frames.to_vec();
    let mut from = None;
    for (place, frame) in changed.iter_mut().enumerate() {
        let begins = uniform(random) < 0.025;
        let ends = uniform(random) < 0.125;
        from = match from {
            None if begins => Some((uniform(random) * frames.len() as f64) as usize),
            Some(_) if ends => None,
            other => other,
        };
        if let Some(from) = from {
            frame.verdict = frames[(from + place) % frames.len()].verdict;
        }
    }
    changed
}

/// A synthetic far-range run with correlation in time: hits, wrong results and errors of a frame are
/// correlated with those of its neighbours.
pub(crate) struct Synthetic {
    pub(crate) stretches: u64,
    pub(crate) frames: u64,
}

impl Synthetic {
    pub(crate) fn run(&self, seed: u64) -> Vec<FrameVerdict> {
        let random = &mut Seed { seed, case: 0 }.stream(0, Effect::CaseSeed, 0);
        (0..self.stretches).flat_map(|stretch| self.stretch(stretch, random)).collect()
    }

    fn stretch(&self, stretch: u64, random: &mut Stream) -> Vec<FrameVerdict> {
        let group: std::sync::Arc<str> = format!("stretch {stretch}").into();
        let [mut hit, mut right, mut ra, mut dec] = [(); 4].map(|()| normal(random));
        let mut next = |x: &mut f64, rho: f64| {
            *x = rho * *x + (1.0 - rho * rho).sqrt() * normal(random);
            *x
        };
        (0..self.frames)
            .map(|frame| {
                let error = error_from_degrees(0.014 * next(&mut ra, 0.6), 0.014 * next(&mut dec, 0.6));
                // 95 % are detected, of which 7 % are wrong.
                let (is_hit, is_wrong) = (next(&mut hit, 0.7) < 1.645, next(&mut right, 0.7) > 1.476);
                let verdict = match (is_hit, is_wrong) {
                    (false, _) => Verdict::Missed { cause: Cause::BelowThreshold },
                    (true, true) => Verdict::Wrong {
                        error,
                        taken: MistakenObject::HotPixel(3),
                        cause: Cause::LostMotionTest,
                    },
                    (true, false) => Verdict::Correct { error },
                };
                FrameVerdict {
                    is_warm_up: false,
                    frame: stretch * self.frames + frame,
                    group: std::sync::Arc::clone(&group),
                    verdict,
                    image: None,
                    n_stars: Some((22.0 + 2.0 * ra).round() as u32),
                    attitude_source: Some(AttitudeSource::Stars),
                    is_absent: false,
                    log_odds: None,
                }
            })
            .collect()
    }
}

/// Sample of a run as the gate reads it; runs with the same seed have the same frames.
pub(crate) fn sample_of(seed: u64, frames: &[FrameVerdict]) -> Sample {
    // The direction in which a figure is better is registered with its world.
    boresight::register_worlds();
    Sample::new(
        identity("far_range", seed),
        unit_table(frames, &WithinLimits::from_degrees([PIXEL_DEG, 2.0 * PIXEL_DEG])),
    )
}

/// Sample of a docking run as the gate reads it; runs with the same seed have the same fields.
pub(crate) fn docking_sample(seed: u64, table: UnitTable) -> Sample {
    Sample::new(identity("docking", seed), table)
}

fn identity(world: &str, seed: u64) -> Identity {
    Identity {
        kind: SourceKind::Run,
        world: world.to_owned(),
        name: "test".to_owned(),
        seed,
        version: "0.1.0".to_owned(),
        catalog_sha256: None,
        inject: None,
        renderer: None,
        warm_up_frames: 0,
        scenario_sha256: String::new(),
        frames_sha256: seed.to_string(),
        pipeline: toml::Table::new(),
        scenario: toml::Table::new(),
    }
}

pub(crate) fn baseline_of(sample: Sample) -> Baseline {
    Baseline::new(sample, "a test", None).unwrap()
}

/// Returns true if the gate closes, for two samples with this kind of pairing.
pub(crate) fn rejects(baseline: &Baseline, result: &Sample, pairing: Pairing) -> bool {
    let report = compare(baseline, result, &CompareOptions::default()).unwrap();
    assert_eq!(report.pairing, pairing);
    report.is_shut()
}
