//! Content of `score.json`.
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use statistics::{
    Interval, below_median, effective_size, mean_interval, median, median_interval, rms_interval, wilson,
};

/// Names of the far-range figures. Rates are fractions from 0 to 1.
pub mod names {
    /// Detected frames, as a fraction of all frames.
    pub const HIT_RATE: &str = "hit_rate";
    /// Missed frames, as a fraction of all frames.
    pub const MISS_RATE: &str = "miss_rate";
    /// Correct frames, as a fraction of all frames.
    pub const CORRECT_RATE: &str = "correct_rate";
    /// Wrong frames, as a fraction of all frames.
    pub const WRONG_RATE: &str = "wrong_rate";
    /// Wrong measurements in frames without a visible target, as a fraction of these frames.
    pub const FALSE_ALARM_RATE: &str = "false_alarm_rate";
    /// Frames whose measurement states a line of sight, as a fraction of the detected frames.
    pub const LINE_OF_SIGHT_RATE: &str = "line_of_sight_rate";
    /// Frames with an |RA error| below the limit of one pixel, as a fraction of the detected frames with a
    /// line of sight.
    pub const RA_WITHIN_1PX: &str = "ra_within_1px";
    /// Frames with an |RA error| below the limit of two pixels, as a fraction of the detected frames with a
    /// line of sight.
    pub const RA_WITHIN_2PX: &str = "ra_within_2px";
    /// Frames with a |Dec error| below the limit of one pixel, as a fraction of the detected frames with a
    /// line of sight.
    pub const DEC_WITHIN_1PX: &str = "dec_within_1px";
    /// Frames with a |Dec error| below the limit of two pixels, as a fraction of the detected frames with a
    /// line of sight.
    pub const DEC_WITHIN_2PX: &str = "dec_within_2px";
    /// Root mean square of the RA error over correct measurements with a line of sight, degrees.
    pub const RA_RMS_DEG: &str = "ra_rms_deg";
    /// Root mean square of the Dec error over correct measurements with a line of sight, degrees.
    pub const DEC_RMS_DEG: &str = "dec_rms_deg";
    /// Mean RA error (bias) over correct measurements with a line of sight, degrees.
    pub const RA_MEAN_DEG: &str = "ra_mean_deg";
    /// Mean Dec error (bias) over correct measurements with a line of sight, degrees.
    pub const DEC_MEAN_DEG: &str = "dec_mean_deg";
    /// Median RA error over correct measurements with a line of sight, degrees.
    pub const RA_MEDIAN_DEG: &str = "ra_median_deg";
    /// Median Dec error over correct measurements with a line of sight, degrees.
    pub const DEC_MEDIAN_DEG: &str = "dec_median_deg";
    /// Root mean square of the centroid error across columns over correct measurements, px.
    pub const CENTROID_X_RMS_PX: &str = "centroid_x_rms_px";
    /// Root mean square of the centroid error across rows over correct measurements, px.
    pub const CENTROID_Y_RMS_PX: &str = "centroid_y_rms_px";
    /// Mean centroid error across columns (bias) over correct measurements, px.
    pub const CENTROID_X_MEAN_PX: &str = "centroid_x_mean_px";
    /// Mean centroid error across rows (bias) over correct measurements, px.
    pub const CENTROID_Y_MEAN_PX: &str = "centroid_y_mean_px";
    /// Median centroid error across columns over correct measurements, px.
    pub const CENTROID_X_MEDIAN_PX: &str = "centroid_x_median_px";
    /// Median centroid error across rows over correct measurements, px.
    pub const CENTROID_Y_MEDIAN_PX: &str = "centroid_y_median_px";
    /// Mean number of identified stars, over the frames whose outcome states this number.
    pub const STARS_MEAN: &str = "stars_mean";
    /// Prefix of the figures about the centroid's covariance: `centroid_nees_mean`,
    /// `centroid_within_1sigma_rate`, `centroid_within_3sigma_rate`.
    pub const CENTROID: &str = "centroid";
    /// Prefix of the corresponding figures about the covariance of the line of sight.
    pub const LINE_OF_SIGHT: &str = "line_of_sight";
    /// Mean NEES of the centroid, eᵀ C⁻¹ e / 2, over correct measurements with a centroid covariance.
    pub const CENTROID_NEES_MEAN: &str = "centroid_nees_mean";
    /// Fraction of the centroid's error components within one standard deviation, over correct measurements
    /// with a centroid covariance.
    pub const CENTROID_WITHIN_1SIGMA_RATE: &str = "centroid_within_1sigma_rate";
    /// Fraction of the centroid's error components within three standard deviations, over correct
    /// measurements with a centroid covariance.
    pub const CENTROID_WITHIN_3SIGMA_RATE: &str = "centroid_within_3sigma_rate";
    /// Mean NEES of the line of sight, eᵀ C⁻¹ e / 2, over correct measurements with a covariance of the line
    /// of sight.
    pub const LINE_OF_SIGHT_NEES_MEAN: &str = "line_of_sight_nees_mean";
    /// Fraction of the error components of the line of sight within one standard deviation, over correct
    /// measurements with a covariance of the line of sight.
    pub const LINE_OF_SIGHT_WITHIN_1SIGMA_RATE: &str = "line_of_sight_within_1sigma_rate";
    /// Fraction of the error components of the line of sight within three standard deviations, over correct
    /// measurements with a covariance of the line of sight.
    pub const LINE_OF_SIGHT_WITHIN_3SIGMA_RATE: &str = "line_of_sight_within_3sigma_rate";
    /// Number of frames before the first 20 consecutive correct measurements.
    pub const FRAMES_UNTIL_SETTLED: &str = "frames_until_settled";
    /// Frames whose attitude was solved from their stars, as a fraction of all frames.
    pub const ATTITUDE_FROM_STARS_RATE: &str = "attitude_from_stars_rate";
}

/// One figure, with the number of values it was computed from and its 95 % interval. No number is ever NaN:
/// an undefined one is `None` (null).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Value; `None` if there is nothing to count.
    pub value: Option<f64>,
    /// Numerator of a rate, whose value is `count`/`of`; equal to `of` in other figures.
    pub count: u64,
    /// Number of values that the figure is computed from.
    pub of: u64,
    /// Effective number of independent values (see [`effective_size`]); 0 when `of` is 0.
    pub effective: f64,
    /// Lower limit of the 95 % interval.
    pub low: Option<f64>,
    /// Upper limit of the 95 % interval.
    pub high: Option<f64>,
    /// Limit, degrees, of a rate of errors "within" a limit; absent in other figures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit_deg: Option<f64>,
}

impl Figure {
    /// Computes a rate. Each inner list is one sequence in order of time.
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

    /// Computes a mean. Each inner list is one sequence of finite values in order of time.
    pub fn mean(sequences: &[Vec<f64>]) -> Self {
        Self::location(sequences, effective_size(sequences), mean, mean_interval)
    }

    /// Computes a root mean square of sequences as in [`Figure::mean`].
    pub fn rms(sequences: &[Vec<f64>]) -> Self {
        let squares: Vec<Vec<f64>> =
            sequences.iter().map(|sequence| sequence.iter().map(|x| x * x).collect()).collect();
        let rms = |_: &[Vec<f64>]| mean(&squares).map(f64::sqrt);
        Self::location(sequences, effective_size(&squares), rms, rms_interval)
    }

    /// Computes a median of sequences as in [`Figure::mean`].
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

/// Returns a note for the reader about the frames that the figures leave out; `None` if there are none.
/// `images` is "frames" or "fields".
pub fn warm_up_note(frames: u64, images: &str) -> Option<String> {
    (frames > 0).then(|| {
        format!(
            "The first {frames} {images} are the warm-up: group `warm-up`, excluded from all other figures."
        )
    })
}

/// Returns true for 0, which is left out of files; files in which the number is 0 are thus the same as before
/// the number was introduced.
pub fn is_zero(number: &u64) -> bool {
    *number == 0
}

/// Score of a run: the content of `score.json`. Figures and groups keep their order in the file; groups are
/// in the order of their first frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of the scenario.
    pub seed: u64,
    /// Version of Boresight that computed the score.
    pub version: String,
    /// Stage of the pipeline whose result was replaced by the truth; absent if none was. A score with an
    /// injected stage is not a score of the pipeline.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inject: Option<String>,
    /// Attitude that the lines of sight depend on: `own`, `telemetry` or `true`, `own and …` where
    /// measurements differ, `none` where no measurement has a line of sight ([`crate::attitude_word`]).
    /// Absent when no frame is detected.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude: Option<String>,
    /// Number of first frames, during which the pipeline starts up; they count only in the group `warm-up`.
    /// Absent when 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub warm_up_frames: u64,
    /// Number of frames, detected and missed, each counted once.
    pub frames: u64,
    /// Figures over all frames, by name (see [`names`] for far range).
    pub figures: IndexMap<String, Figure>,
    /// Scores of each group (day, portion).
    pub groups: IndexMap<String, GroupScore>,
    /// Number of misses by [`crate::Cause::code`]; causes that did not occur are left out.
    pub misses: IndexMap<String, u64>,
    /// Number of wrong measurements, by the cause that kept the target from being chosen.
    pub wrong: IndexMap<String, u64>,
    /// Number of wrong measurements, by the object chosen instead: `star`, `planet`, `moon`, `hot_pixel`,
    /// `cosmic_ray`, `nothing`.
    pub wrong_taken: IndexMap<String, u64>,
    /// Consistency of the covariances by the state of the target's image and by the source of the attitude.
    /// Absent where no correct measurement has a covariance.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub consistency: Vec<ConsistencyRow>,
    /// Rates by a threshold on the odds that measurements state. Absent where a measurement states none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub threshold_curve: Vec<ThresholdPoint>,
}

/// Consistency of the covariances in one class of frames: a row of `consistency` in `score.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConsistencyRow {
    /// Criterion that divides the frames into classes: `image` or `attitude`.
    pub by: String,
    /// Class: [`crate::ImageState::code`] for `image`; [`contract::AttitudeSource::code`] or `unstated` for
    /// `attitude`.
    pub value: String,
    /// Number of correct measurements of this class with a covariance.
    pub frames: u64,
    /// Figures of consistency over these measurements, by name.
    pub figures: IndexMap<String, Figure>,
}

/// Rates if only measurements count whose stated odds reach a threshold: a row of `threshold_curve` in
/// `score.json`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ThresholdPoint {
    /// Threshold: natural logarithm of the odds.
    pub min_log_odds: f64,
    /// Correct measurements above the threshold, as a fraction of the frames with a visible target; `None`
    /// without such frames.
    pub correct_rate: Option<f64>,
    /// Wrong measurements above the threshold in frames with a visible target, as a fraction of these;
    /// `None` without such frames.
    pub wrong_rate: Option<f64>,
    /// Wrong measurements above the threshold in frames without a visible target, as a fraction of these;
    /// `None` without such frames.
    pub false_alarm_rate: Option<f64>,
}

/// Score of one group of frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupScore {
    /// Number of frames.
    pub frames: u64,
    /// Figures by name.
    pub figures: IndexMap<String, Figure>,
    /// Number of misses by cause.
    pub misses: IndexMap<String, u64>,
    /// Number of wrong measurements by cause.
    pub wrong: IndexMap<String, u64>,
    /// Number of wrong measurements by the object chosen instead.
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

    /// The effective size of a median follows from whether each value is below the median, not from its
    /// distance to the median.
    #[test]
    fn a_median_has_an_effective_number_of_its_own() {
        let series = [vec![0.0, 1.0, 2.0, 3.0, 4.0, 3.0, 5.0, 5.0, 5.0, 3.0, 9.0, 5.0, 5.0, 6.0, 8.0, 5.0]];
        let figure = Figure::median(&series);
        // Computed independently of this code: see `values_at_the_median_are_not_below_it`.
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
