//! What `score.json` holds.
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use statistics::{
    Interval, below_median, effective_size, mean_interval, median, median_interval, rms_interval, wilson,
};

/// Names of the far-range figures. Rates are fractions from 0 to 1.
pub mod names {
    /// Detected, of all frames.
    pub const HIT_RATE: &str = "hit_rate";
    /// Missed, of all frames.
    pub const MISS_RATE: &str = "miss_rate";
    /// Correct, of all frames.
    pub const CORRECT_RATE: &str = "correct_rate";
    /// Wrong, of all frames.
    pub const WRONG_RATE: &str = "wrong_rate";
    /// Answers with a line of sight of their own, of the detected.
    pub const LINE_OF_SIGHT_RATE: &str = "line_of_sight_rate";
    /// |RA error| below the limit of one pixel, of the detected with a line of sight.
    pub const RA_WITHIN_1PX: &str = "ra_within_1px";
    /// |RA error| below the limit of two pixels, of the same.
    pub const RA_WITHIN_2PX: &str = "ra_within_2px";
    /// |Dec error| below the limit of one pixel, of the same.
    pub const DEC_WITHIN_1PX: &str = "dec_within_1px";
    /// |Dec error| below the limit of two pixels, of the same.
    pub const DEC_WITHIN_2PX: &str = "dec_within_2px";
    /// Root mean square of the RA error of the correct with a line of sight, degrees.
    pub const RA_RMS_DEG: &str = "ra_rms_deg";
    /// Root mean square of the Dec error of the correct with a line of sight, degrees.
    pub const DEC_RMS_DEG: &str = "dec_rms_deg";
    /// Mean RA error (bias) of the correct with a line of sight, degrees.
    pub const RA_MEAN_DEG: &str = "ra_mean_deg";
    /// Mean Dec error (bias) of the correct with a line of sight, degrees.
    pub const DEC_MEAN_DEG: &str = "dec_mean_deg";
    /// Median RA error of the correct with a line of sight, degrees.
    pub const RA_MEDIAN_DEG: &str = "ra_median_deg";
    /// Median Dec error of the correct with a line of sight, degrees.
    pub const DEC_MEDIAN_DEG: &str = "dec_median_deg";
    /// Root mean square of the centroid's error across columns, of the correct, px.
    pub const CENTROID_X_RMS_PX: &str = "centroid_x_rms_px";
    /// Root mean square of the centroid's error across rows, of the correct, px.
    pub const CENTROID_Y_RMS_PX: &str = "centroid_y_rms_px";
    /// Mean error of the centroid across columns (bias), of the correct, px.
    pub const CENTROID_X_MEAN_PX: &str = "centroid_x_mean_px";
    /// Mean error of the centroid across rows (bias), of the correct, px.
    pub const CENTROID_Y_MEAN_PX: &str = "centroid_y_mean_px";
    /// Median error of the centroid across columns, of the correct, px.
    pub const CENTROID_X_MEDIAN_PX: &str = "centroid_x_median_px";
    /// Median error of the centroid across rows, of the correct, px.
    pub const CENTROID_Y_MEDIAN_PX: &str = "centroid_y_median_px";
    /// Mean number of identified stars, over the frames whose answer tells it.
    pub const STARS_MEAN: &str = "stars_mean";
    /// Beginning of the figures of the centroid's covariance, `centroid_nees_mean`, `centroid_within_1sigma_rate`,
    /// `centroid_within_3sigma_rate`.
    pub const CENTROID: &str = "centroid";
    /// Beginning of the same figures of the covariance of the line of sight.
    pub const LINE_OF_SIGHT: &str = "line_of_sight";
    /// Mean of eᵀ C⁻¹ e / 2 of the centroid, of the correct with its covariance.
    pub const CENTROID_NEES_MEAN: &str = "centroid_nees_mean";
    /// Components of the centroid's error within one standard deviation, of the same.
    pub const CENTROID_WITHIN_1SIGMA_RATE: &str = "centroid_within_1sigma_rate";
    /// Components of the centroid's error within three standard deviations, of the same.
    pub const CENTROID_WITHIN_3SIGMA_RATE: &str = "centroid_within_3sigma_rate";
    /// Mean of eᵀ C⁻¹ e / 2 of the line of sight, of the correct with its covariance.
    pub const LINE_OF_SIGHT_NEES_MEAN: &str = "line_of_sight_nees_mean";
    /// Components of the error of the line of sight within one standard deviation, of the same.
    pub const LINE_OF_SIGHT_WITHIN_1SIGMA_RATE: &str = "line_of_sight_within_1sigma_rate";
    /// Components of the error of the line of sight within three standard deviations, of the same.
    pub const LINE_OF_SIGHT_WITHIN_3SIGMA_RATE: &str = "line_of_sight_within_3sigma_rate";
    /// Frames before the first 20 correct answers in a row.
    pub const FRAMES_UNTIL_SETTLED: &str = "frames_until_settled";
    /// Attitude solved from the stars of the frame itself, of all frames.
    pub const ATTITUDE_FROM_STARS_RATE: &str = "attitude_from_stars_rate";
}

/// One figure, with what it was counted over and its 95 % interval. Nothing in it is ever NaN: what cannot be said
/// is `None` (null).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// The value; `None` when it is counted over nothing.
    pub value: Option<f64>,
    /// How many count: the value of a rate is `count`/`of`. For a mean, the same as `of`.
    pub count: u64,
    /// How many it is counted over.
    pub of: u64,
    /// How many independent frames these are worth (see [`effective_size`]); 0 when `of` is 0.
    pub effective: f64,
    /// Lower limit of the 95 % interval.
    pub low: Option<f64>,
    /// Upper limit of the 95 % interval.
    pub high: Option<f64>,
    /// Of a rate of errors "within" something: the limit, degrees. Absent in other figures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit_deg: Option<f64>,
}

impl Figure {
    /// A rate. Each inner list is one sequence in order of time.
    pub fn rate(sequences: &[Vec<bool>]) -> Self {
        let numbers: Vec<Vec<f64>> = sequences
            .iter()
            .map(|sequence| sequence.iter().map(|&b| f64::from(u8::from(b))).collect())
            .collect();
        let of = sequences.iter().map(Vec::len).sum::<usize>() as u64;
        let count = sequences.iter().flatten().filter(|&&b| b).count() as u64;
        let value = (of > 0).then(|| count as f64 / of as f64);
        let effective = effective_size(&numbers);
        Self::new(value, count, of, effective, value.and_then(|rate| wilson(rate, effective)))
    }

    /// A mean. Each inner list is one sequence of finite values in order of time.
    pub fn mean(sequences: &[Vec<f64>]) -> Self {
        Self::location(sequences, effective_size(sequences), mean, mean_interval)
    }

    /// A root mean square.
    pub fn rms(sequences: &[Vec<f64>]) -> Self {
        let squares: Vec<Vec<f64>> =
            sequences.iter().map(|sequence| sequence.iter().map(|x| x * x).collect()).collect();
        let rms = |_: &[Vec<f64>]| mean(&squares).map(f64::sqrt);
        Self::location(sequences, effective_size(&squares), rms, rms_interval)
    }

    /// A median.
    pub fn median(sequences: &[Vec<f64>]) -> Self {
        Self::location(sequences, effective_size(&below_median(sequences)), median, median_interval)
    }

    fn location(
        sequences: &[Vec<f64>],
        effective: f64,
        value: impl Fn(&[Vec<f64>]) -> Option<f64>,
        interval: impl Fn(&[Vec<f64>]) -> Option<Interval>,
    ) -> Self {
        let of = sequences.iter().map(Vec::len).sum::<usize>() as u64;
        Self::new(value(sequences), of, of, effective, interval(sequences))
    }

    fn new(value: Option<f64>, count: u64, of: u64, effective: f64, interval: Option<Interval>) -> Self {
        Self {
            value,
            count,
            of,
            effective,
            low: interval.map(|interval| interval.low),
            high: interval.map(|interval| interval.high),
            limit_deg: None,
        }
    }
}

fn mean(sequences: &[Vec<f64>]) -> Option<f64> {
    let n = sequences.iter().map(Vec::len).sum::<usize>();
    (n > 0).then(|| sequences.iter().flatten().sum::<f64>() / n as f64)
}

/// What a reader must know of frames that are left out of the figures; nothing where there are none. `images`: frames or fields.
pub fn warm_up_note(frames: u64, images: &str) -> Option<String> {
    (frames > 0).then(|| {
        format!("The first {frames} {images}, the pipeline's start-up, are the group `warm-up` and count in no other figure.")
    })
}

/// Whether a number need not be written: files are as they were before there was such a number.
pub fn is_zero(number: &u64) -> bool {
    *number == 0
}

/// The score of a run: the content of `score.json`. Figures and groups keep their order in the file; groups are in
/// the order of their first frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Name of the scenario.
    pub scenario: String,
    /// Its seed.
    pub seed: u64,
    /// Version of Boresight that made the score.
    pub version: String,
    /// The stage whose result was replaced by the truth: with one, this is no score of the pipeline. Absent without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inject: Option<String>,
    /// The attitude that the lines of sight rest on: `own`, `telemetry` or `true`, `own and …` where answers differ, `none` where no
    /// answer has one ([`crate::attitude_word`]). Absent when nothing is detected.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude: Option<String>,
    /// The first frames, in which the pipeline starts up: they are in the group `warm-up` and in no other number. Absent when 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub warm_up_frames: u64,
    /// Number of frames: detected and missed, each counted once.
    pub frames: u64,
    /// Figures over all frames, by name (see [`names`] for far range).
    pub figures: IndexMap<String, Figure>,
    /// The same for each group (day, portion).
    pub groups: IndexMap<String, GroupScore>,
    /// Misses by [`crate::Cause::code`]; causes that did not occur are left out.
    pub misses: IndexMap<String, u64>,
    /// Wrong answers, by the cause that kept the target itself from being taken.
    pub wrong: IndexMap<String, u64>,
    /// Wrong answers, by what was taken: `star`, `planet`, `moon`, `hot_pixel`, `cosmic_ray`, `nothing`.
    pub wrong_taken: IndexMap<String, u64>,
    /// Honesty of the covariances by the state of the image and by the source of the attitude. Absent where no correct answer has a
    /// covariance.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub consistency: Vec<ConsistencyRow>,
}

/// Honesty of the covariances in one kind of frames: a row of `consistency` in `score.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConsistencyRow {
    /// What the frames are told apart by: `image` or `attitude`.
    pub by: String,
    /// Of `image`: [`crate::ImageState::code`]; of `attitude`: [`contract::AttitudeSource::code`], or `unstated`.
    pub value: String,
    /// Correct answers of this kind with a covariance.
    pub frames: u64,
    /// The figures of consistency over them, by name.
    pub figures: IndexMap<String, Figure>,
}

/// The score of one group of frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupScore {
    /// Number of frames.
    pub frames: u64,
    /// Figures by name.
    pub figures: IndexMap<String, Figure>,
    /// Misses by cause.
    pub misses: IndexMap<String, u64>,
    /// Wrong answers by cause.
    pub wrong: IndexMap<String, u64>,
    /// Wrong answers by what was taken.
    pub wrong_taken: IndexMap<String, u64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_sane(figure: &Figure) {
        let finite = |v: Option<f64>| v.is_none_or(f64::is_finite);
        assert!(
            finite(figure.value) && finite(figure.low) && finite(figure.high) && figure.effective.is_finite()
        );
        if let (Some(value), Some(low), Some(high)) = (figure.value, figure.low, figure.high) {
            assert!(low <= value && value <= high, "{figure:?}");
        }
        assert!(figure.effective <= figure.of as f64);
    }

    #[test]
    fn a_figure_over_nothing_is_null_and_not_nan() {
        for figure in [
            Figure::rate(&[]),
            Figure::rate(&[vec![], vec![]]),
            Figure::mean(&[]),
            Figure::rms(&[vec![]]),
            Figure::median(&[]),
        ] {
            is_sane(&figure);
            assert_eq!((figure.value, figure.count, figure.of, figure.low), (None, 0, 0, None));
        }
        assert_eq!(
            serde_json::to_string(&Figure::rate(&[])).unwrap(),
            r#"{"value":null,"count":0,"of":0,"effective":0.0,"low":null,"high":null}"#
        );
    }

    #[test]
    fn all_hits_and_all_misses_have_one_sided_doubt() {
        let hits = Figure::rate(&[vec![true; 10]]);
        assert_eq!((hits.value, hits.high), (Some(1.0), Some(1.0)));
        assert!((hits.low.unwrap() - 0.7225).abs() < 1e-4);
        let misses = Figure::rate(&[vec![false; 10]]);
        assert_eq!((misses.value, misses.low), (Some(0.0), Some(0.0)));
        assert!((misses.high.unwrap() - 0.2775).abs() < 1e-4);
    }

    #[test]
    fn figures_of_short_series_are_sane() {
        for n in 1..6 {
            for bits in 0..1u32 << n {
                let series: Vec<bool> = (0..n).map(|i| bits >> i & 1 == 1).collect();
                let numbers: Vec<f64> = series.iter().map(|&b| if b { -0.02 } else { 0.5 }).collect();
                is_sane(&Figure::rate(&[series]));
                for figure in
                    [Figure::mean, Figure::rms, Figure::median].map(|f| f(std::slice::from_ref(&numbers)))
                {
                    is_sane(&figure);
                }
            }
        }
    }

    /// What is summed up decides what the values are worth: of a median whether they are below it, not how far.
    #[test]
    fn a_median_has_an_effective_number_of_its_own() {
        let series = [vec![0.0, 1.0, 2.0, 3.0, 4.0, 3.0, 5.0, 5.0, 5.0, 3.0, 9.0, 5.0, 5.0, 6.0, 8.0, 5.0]];
        let figure = Figure::median(&series);
        // Worked out apart from this code: see `values_at_the_median_are_not_below_it`.
        assert!((figure.effective - 4.287).abs() < 5e-4, "{figure:?}");
        assert!((figure.effective - Figure::mean(&series).effective).abs() > 0.1);
    }

    #[test]
    fn root_mean_square_of_three_four_is_its_own_definition() {
        let figure = Figure::rms(&[vec![3.0], vec![-4.0]]);
        assert!((figure.value.unwrap() - 12.5f64.sqrt()).abs() < 1e-15);
        assert_eq!(figure.of, 2);
    }
}
