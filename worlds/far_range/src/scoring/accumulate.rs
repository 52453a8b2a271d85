//! Accumulation of frames into figures.

mod threshold_curve;

use std::sync::Arc;

use contract::{Angle, AttitudeSource, Outcome};
use indexmap::IndexMap;
use score::{
    Better, Definition, FigureSpec, FigureTerms, Reduction, ScoreError, UnitTable, UnitVerdict, WARM_UP,
    attitude_word, counts,
};
use sim::truth::{FrameTruth, ObjectKind, ObjectTruth};

use self::threshold_curve::threshold_curve;
use super::angles::{AnswerError, AttitudeUsed, GrantedAttitude, LineOfSightError, WithinLimits};
use super::argon_table2::Table2;
use super::cause::{Cause, Detector, is_absent};
use super::settling;
use super::verdict::{FrameVerdict, MistakenObject, Unproject, Verdict, judge};
use crate::scoring::covariance::consistency;
use crate::scoring::covariance::image_state::ImageState;
use crate::scoring::{GroupScore, Score, names};

/// Inputs of the score besides the frames.
pub struct ScoreContext<'a> {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of the scenario.
    pub seed: u64,
    /// Version of Boresight.
    pub version: String,
    /// Stage whose result was replaced by the truth, if any.
    pub inject: Option<String>,
    /// Number of columns of the detector.
    pub columns: usize,
    /// Number of rows of the detector.
    pub rows: usize,
    /// Angular limits of "within one pixel" and "within two".
    pub limits: WithinLimits,
    /// Number of frame numbers, from the first frame on, in which the pipeline starts up: their verdicts form
    /// a separate group ([`WARM_UP`]), and all other figures exclude them.
    pub warm_up_frames: u64,
    /// Inverse projection of the true camera.
    pub unproject: Box<Unproject<'a>>,
}

/// A score and the verdicts from which it was counted.
#[derive(Debug, Clone, PartialEq)]
pub struct FarRangeJudgement {
    /// Figures of the run.
    pub score: Score,
    /// One verdict per frame, in order.
    pub verdicts: Vec<FrameVerdict>,
    /// Angular limits of "within one pixel" and "within two".
    pub limits: WithinLimits,
    /// Published figures of the same scenario, if any.
    pub published: Option<&'static Table2>,
    /// Score of the pipeline's best mode on the same frames, if the run compares it with the paper's mode.
    pub best_mode: Option<Box<Score>>,
}

/// Refuses impossible values, from which figures could still be computed.
fn check_possible(truth: &FrameTruth, objects: &[ObjectTruth]) -> Result<(), ScoreError> {
    let check = |field, value: f64, expected, is_possible: bool| {
        let impossible =
            || ScoreError::Impossible { frame: truth.frame, field, value: value.to_string(), expected };
        if is_possible { Ok(()) } else { Err(impossible()) }
    };
    check("range_km", truth.range_km, "more than 0", truth.range_km > 0.0)?;
    let targets = objects.iter().filter(|object| object.kind == ObjectKind::Target).count();
    check("number of targets", targets as f64, "at most 1", targets <= 1)?;
    for object in objects {
        for (field, value) in [
            ("electrons", object.electrons),
            ("peak_electrons", object.peak_electrons),
            ("snr", object.snr),
            ("radius_px", object.radius_px),
            ("bloom_px", object.bloom_px),
            ("cut", object.cut),
        ] {
            check(field, value, "0 or more", value >= 0.0)?;
        }
    }
    Ok(())
}

/// Scores the frames of a far-range run one after the other.
///
/// ```
/// use boresight_far_range::scoring::{ScoreContext, Scorer, WithinLimits};
/// let context = ScoreContext {
///     scenario: "argon".to_owned(),
///     seed: 1,
///     version: "0.1.0".to_owned(),
///     inject: None,
///     columns: 752,
///     rows: 580,
///     limits: WithinLimits::from_degrees([0.024, 0.048]),
///     warm_up_frames: 0,
///     unproject: Box::new(|_| Some(contract::Direction::z())),
/// };
/// let scored = Scorer::new(context).finish();
/// assert_eq!(scored.score.figures["hit_rate"].value, None); // without frames: no value rather than NaN
/// ```
pub struct Scorer<'a> {
    context: ScoreContext<'a>,
    verdicts: Vec<FrameVerdict>,
}

impl<'a> Scorer<'a> {
    /// Creates a scorer without frames.
    pub fn new(context: ScoreContext<'a>) -> Self {
        Self { context, verdicts: Vec::new() }
    }

    /// Scores the next frame. `objects` are the objects of this frame, including the target; `outcome` is
    /// `None` when the measurements have no row for the frame; `granted` is the attitude for a measurement
    /// that has only a centroid.
    ///
    /// # Errors
    /// [`ScoreError::Order`] unless the frame number is larger than the previous one,
    /// [`ScoreError::ForeignObject`] when an object belongs to another frame, [`ScoreError::Impossible`] for
    /// an impossible value. The frame is then not counted.
    pub fn add(
        &mut self,
        truth: &FrameTruth,
        objects: &[ObjectTruth],
        outcome: Option<&Outcome>,
        granted: GrantedAttitude,
    ) -> Result<&FrameVerdict, ScoreError> {
        let frame = truth.frame;
        if let Some(last) = self.verdicts.last()
            && last.frame >= frame
        {
            return Err(ScoreError::Order { previous: last.frame, frame });
        }
        if let Some(foreign) = objects.iter().find(|object| object.frame != frame) {
            return Err(ScoreError::ForeignObject { frame, object: foreign.frame });
        }
        check_possible(truth, objects)?;
        let detector = Detector { columns: self.context.columns, rows: self.context.rows };
        let first = self.verdicts.first().map_or(frame, |first| first.frame);
        let is_warm_up = frame - first < self.context.warm_up_frames;
        let name = if is_warm_up { WARM_UP } else { &truth.group };
        let group = match self.verdicts.last() {
            Some(last) if *last.group == *name => Arc::clone(&last.group),
            _ => Arc::from(name),
        };
        let verdict = judge(truth, objects, outcome, detector, &self.context.unproject, granted);
        let position = outcome.and_then(Outcome::measurement).map(|measurement| measurement.position);
        let image = match verdict {
            Verdict::Correct { .. } => {
                position.and_then(|position| ImageState::from_objects(position, objects))
            }
            _ => None,
        };
        let verdict = FrameVerdict {
            frame,
            group,
            is_warm_up,
            verdict,
            image,
            n_stars: outcome.and_then(|outcome| outcome.n_stars),
            attitude_source: outcome.and_then(|outcome| outcome.attitude_source),
            is_absent: is_absent(truth, detector),
            log_odds: outcome
                .and_then(|outcome| outcome.measurement()?.log_odds)
                .filter(|log_odds| log_odds.is_finite()),
        };
        Ok(self.verdicts.push_mut(verdict))
    }

    /// Returns the figures over all frames. For the statistics each group is one sequence, even if another
    /// group interrupts it.
    pub fn finish(self) -> FarRangeJudgement {
        let mut groups: IndexMap<&str, Vec<&FrameVerdict>> = IndexMap::new();
        for verdict in &self.verdicts {
            groups.entry(&verdict.group).or_default().push(verdict);
        }
        let counted = |sequence: &&Vec<&FrameVerdict>| !sequence.iter().any(|frame| frame.is_warm_up);
        let sequences: Vec<&[&FrameVerdict]> = groups.values().filter(counted).map(Vec::as_slice).collect();
        let limits = self.context.limits;
        let starts = from_the_start(&self.verdicts);
        let every_start: Vec<&[&FrameVerdict]> = starts.values().map(Vec::as_slice).collect();
        let all = group_score(&sequences, &every_start, &limits);
        let of_group = |(group, sequence): (&&str, &Vec<&FrameVerdict>)| {
            let start: Vec<&[&FrameVerdict]> = starts.get(group).map(Vec::as_slice).into_iter().collect();
            ((*group).to_owned(), group_score(&[sequence], &start, &limits))
        };
        let groups = groups.iter().map(of_group).collect();
        let score = Score {
            scenario: self.context.scenario,
            seed: self.context.seed,
            version: self.context.version,
            inject: self.context.inject,
            attitude: attitude_of(&self.verdicts),
            warm_up_frames: self.context.warm_up_frames,
            frames: all.frames,
            figures: all.figures,
            groups,
            misses: all.misses,
            wrong: all.wrong,
            wrong_taken: all.wrong_taken,
            consistency: consistency::rows(&sequences),
            threshold_curve: threshold_curve(&sequences.concat()),
        };
        FarRangeJudgement { score, verdicts: self.verdicts, limits, published: None, best_mode: None }
    }
}

/// Returns the figures of every score, in order.
pub fn figures() -> Vec<FigureSpec> {
    let limits = WithinLimits::from_degrees([0.0; 2]);
    definitions(&limits).into_iter().map(|definition| definition.figure).chain([settling::spec()]).collect()
}

/// Returns the frames of each group in order of time, including the warm-up frames that precede the group,
/// regardless of the frames that other figures exclude. The figure of the start-up is computed from them.
fn from_the_start(verdicts: &[FrameVerdict]) -> IndexMap<&str, Vec<&FrameVerdict>> {
    let mut starts: IndexMap<&str, Vec<&FrameVerdict>> = IndexMap::new();
    let mut warm_up = Vec::new();
    for verdict in verdicts {
        if verdict.is_warm_up {
            warm_up.push(verdict);
        } else {
            let start = starts.entry(&verdict.group).or_default();
            start.append(&mut warm_up);
            start.push(verdict);
        }
    }
    starts
}

/// Returns the attitude that the lines of sight of some frames are based on.
fn attitude_of(frames: &[FrameVerdict]) -> Option<String> {
    let of = |frame: &FrameVerdict| Some(frame.verdict.error()?.line_of_sight.map(|error| error.attitude));
    let is_own = |used: &Option<AttitudeUsed>| *used == Some(AttitudeUsed::Own);
    let granted = frames.iter().filter_map(of).flatten().find(|used| *used != AttitudeUsed::Own);
    let [own, centroids] =
        [true, false].map(|own| frames.iter().filter_map(of).any(|used| is_own(&used) == own));
    attitude_word(own, centroids, granted.map(AttitudeUsed::code))
}

/// Returns the score of several sequences of frames taken together; `starts` are these sequences including
/// the warm-up.
fn group_score(
    sequences: &[&[&FrameVerdict]],
    starts: &[&[&FrameVerdict]],
    limits: &WithinLimits,
) -> GroupScore {
    let frames = || sequences.iter().copied().flatten();
    let causes = |of: &dyn Fn(&Verdict) -> Option<Cause>| {
        let codes = Cause::ALL.map(Cause::code);
        counts(&codes, frames().filter_map(|frame| of(&frame.verdict)).map(Cause::code))
    };
    GroupScore {
        frames: frames().count() as u64,
        figures: definitions(limits)
            .iter()
            .map(|definition| (definition.figure.name.clone(), definition.figure(sequences)))
            .chain([(settling::spec().name, settling::figure(starts))])
            .collect(),
        misses: causes(&|verdict| match verdict {
            Verdict::Missed { cause } => Some(*cause),
            _ => None,
        }),
        wrong: causes(&|verdict| match verdict {
            Verdict::Wrong { cause, .. } => Some(*cause),
            _ => None,
        }),
        wrong_taken: counts(
            &[
                MistakenObject::Star(0),
                MistakenObject::Planet(0),
                MistakenObject::Moon,
                MistakenObject::HotPixel(0),
                MistakenObject::CosmicRay(0),
                MistakenObject::Nothing,
            ]
            .map(MistakenObject::code),
            frames().filter_map(|frame| match frame.verdict {
                Verdict::Wrong { taken, .. } => Some(taken.code()),
                _ => None,
            }),
        ),
    }
}

/// Returns the figures of a far-range score, in order.
fn definitions(limits: &WithinLimits) -> Vec<Definition<'static, FrameVerdict>> {
    let of_all = |name: &str, words: &str, holds: fn(&FrameVerdict) -> bool| {
        Definition::rate(name, words, move |frame: &FrameVerdict| Some(holds(frame)))
    };
    let within = |name: &str, words: &str, component: fn(LineOfSightError) -> Angle, limit_deg: f64| {
        let limit = Angle::from_degrees(limit_deg);
        let holds = move |frame: &FrameVerdict| {
            frame.verdict.line_of_sight_error().map(|error| component(error).abs() < limit)
        };
        Definition::rate(name, words, holds).with_limit_deg(limit_deg).resting_on_attitude()
    };
    let px = |name: &str, words: &str, reduction: Reduction, component: fn(AnswerError) -> Option<f64>| {
        Definition::amount(name, words, "px", reduction, move |frame: &FrameVerdict| match frame.verdict {
            Verdict::Correct { error } => component(error),
            _ => None,
        })
    };
    let deg = |name: &str, words: &str, reduction: Reduction, component: fn(LineOfSightError) -> Angle| {
        let value = move |frame: &FrameVerdict| match frame.verdict {
            Verdict::Correct { error } => Some(component(error.line_of_sight?).degrees()),
            _ => None,
        };
        Definition::amount(name, words, "°", reduction, value).resting_on_attitude()
    };
    let ra = |error: LineOfSightError| error.ra;
    let dec = |error: LineOfSightError| error.dec;
    let x_px = |error: AnswerError| error.centroid_px.map(|[x, _]| x);
    let y_px = |error: AnswerError| error.centroid_px.map(|[_, y]| y);
    let has_own = |frame: &FrameVerdict| {
        let error = frame.verdict.error()?.line_of_sight;
        Some(error.is_some_and(|error| error.attitude == AttitudeUsed::Own))
    };
    let ([ra_1px, ra_2px], [dec_1px, dec_2px]) = (limits.ra_deg, limits.dec_deg);
    let stars = |frame: &FrameVerdict| frame.n_stars.map(f64::from);
    let mut list = vec![
        of_all(names::HIT_RATE, "hit rate", |frame| frame.verdict.is_detected()),
        within(names::RA_WITHIN_1PX, "within 1 px across columns", ra, ra_1px),
        within(names::RA_WITHIN_2PX, "within 2 px across columns", ra, ra_2px),
        within(names::DEC_WITHIN_1PX, "within 1 px across rows", dec, dec_1px),
        within(names::DEC_WITHIN_2PX, "within 2 px across rows", dec, dec_2px),
        of_all(names::CORRECT_RATE, "correct rate", |frame| matches!(frame.verdict, Verdict::Correct { .. })),
        of_all(names::WRONG_RATE, "wrong rate", |frame| matches!(frame.verdict, Verdict::Wrong { .. }))
            .with_direction(Better::Less),
        Definition::rate(names::FALSE_ALARM_RATE, "false alarm rate", |frame: &FrameVerdict| {
            frame.is_absent.then_some(matches!(frame.verdict, Verdict::Wrong { .. }))
        })
        .with_direction(Better::Less),
        of_all(names::MISS_RATE, "miss rate", |frame| matches!(frame.verdict, Verdict::Missed { .. }))
            .with_direction(Better::Less),
        deg(names::RA_RMS_DEG, "RMS across columns", Reduction::Rms, ra),
        deg(names::DEC_RMS_DEG, "RMS across rows", Reduction::Rms, dec),
        deg(names::RA_MEAN_DEG, "mean across columns", Reduction::Mean, ra),
        deg(names::DEC_MEAN_DEG, "mean across rows", Reduction::Mean, dec),
        deg(names::RA_MEDIAN_DEG, "median across columns", Reduction::Median, ra),
        deg(names::DEC_MEDIAN_DEG, "median across rows", Reduction::Median, dec),
        px(names::CENTROID_X_RMS_PX, "centroid x RMS", Reduction::Rms, x_px),
        px(names::CENTROID_Y_RMS_PX, "centroid y RMS", Reduction::Rms, y_px),
        px(names::CENTROID_X_MEAN_PX, "centroid x mean", Reduction::Mean, x_px),
        px(names::CENTROID_Y_MEAN_PX, "centroid y mean", Reduction::Mean, y_px),
        px(names::CENTROID_X_MEDIAN_PX, "centroid x median", Reduction::Median, x_px),
        px(names::CENTROID_Y_MEDIAN_PX, "centroid y median", Reduction::Median, y_px),
        Definition::rate(names::LINE_OF_SIGHT_RATE, "line of sight rate", has_own),
        Definition::amount(names::STARS_MEAN, "stars mean", None, Reduction::Mean, stars)
            .with_direction(Better::More),
        of_all(names::ATTITUDE_FROM_STARS_RATE, "attitude from stars rate", |frame| {
            frame.attitude_source.is_some_and(AttitudeSource::is_by_stars)
        }),
    ];
    list.extend(consistency::definitions());
    list
}

/// Converts the verdicts of a far-range run to units with their contributions to every figure, except the
/// number of frames until settled, which is defined only for a complete sequence.
pub fn unit_table(frames: &[FrameVerdict], limits: &WithinLimits) -> UnitTable {
    let unit = |frame: &FrameVerdict| {
        let row = frame.row();
        UnitVerdict {
            number: frame.frame,
            group: frame.group.to_string(),
            verdict: row.verdict.to_owned(),
            cause: row.cause.map(str::to_owned),
        }
    };
    let attitude = attitude_of(frames);
    UnitTable {
        units: frames.iter().map(unit).collect(),
        figures: definitions(limits)
            .iter()
            .map(|definition| {
                FigureTerms::from_counted_units(definition, frames, |frame| !frame.is_warm_up)
                    .with_attitude(&definition.figure, attitude.as_ref())
            })
            .collect(),
    }
}

#[cfg(test)]
mod tests;
