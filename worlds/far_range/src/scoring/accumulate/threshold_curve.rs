//! Rates as functions of a threshold on the odds that measurements state.

use crate::scoring::report::ThresholdPoint;
use crate::scoring::verdict::{FrameVerdict, Verdict};

/// Largest number of thresholds of a curve.
const MAX_POINTS: usize = 41;

/// Returns the curve from the smallest stated odds to the largest, at thresholds with equal distances of a
/// whole number; empty unless every measurement states its odds.
pub(super) fn threshold_curve(frames: &[&FrameVerdict]) -> Vec<ThresholdPoint> {
    let measured: Vec<&FrameVerdict> =
        frames.iter().copied().filter(|frame| frame.verdict.is_detected()).collect();
    let odds: Vec<f64> = measured.iter().filter_map(|frame| frame.log_odds).collect();
    if odds.is_empty() || odds.len() < measured.len() {
        return Vec::new();
    }
    let first = odds.iter().copied().fold(f64::INFINITY, f64::min).floor();
    let last = odds.iter().copied().fold(f64::NEG_INFINITY, f64::max).floor();
    let step = ((last - first) / (MAX_POINTS - 1) as f64).ceil().max(1.0);
    (0..MAX_POINTS)
        .map(|i| first + i as f64 * step)
        .take_while(|threshold| *threshold <= last)
        .map(|threshold| point(frames, threshold))
        .collect()
}

fn point(frames: &[&FrameVerdict], min_log_odds: f64) -> ThresholdPoint {
    let is_counted = |frame: &FrameVerdict| frame.log_odds.is_some_and(|odds| odds >= min_log_odds);
    let is_correct =
        |frame: &FrameVerdict| is_counted(frame) && matches!(frame.verdict, Verdict::Correct { .. });
    let is_wrong = |frame: &FrameVerdict| is_counted(frame) && matches!(frame.verdict, Verdict::Wrong { .. });
    ThresholdPoint {
        min_log_odds,
        correct_rate: rate(frames, false, is_correct),
        wrong_rate: rate(frames, false, is_wrong),
        false_alarm_rate: rate(frames, true, is_wrong),
    }
}

/// Returns the fraction of the frames without (`is_absent`) or with a visible target for which `holds` is
/// true.
fn rate(frames: &[&FrameVerdict], is_absent: bool, holds: impl Fn(&FrameVerdict) -> bool) -> Option<f64> {
    let (mut count, mut of) = (0_u32, 0_u32);
    for frame in frames.iter().filter(|frame| frame.is_absent == is_absent) {
        of += 1;
        count += u32::from(holds(frame));
    }
    (of > 0).then(|| f64::from(count) / f64::from(of))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::cause::Cause;
    use crate::scoring::hand_made::{correct_verdict, verdict_of, wrong_verdict};

    fn stated(verdict: Verdict, is_absent: bool, log_odds: Option<f64>) -> FrameVerdict {
        FrameVerdict { is_absent, log_odds, ..verdict_of(verdict) }
    }

    #[test]
    fn each_threshold_counts_the_measurements_above_it() {
        let missed = Verdict::Missed { cause: Cause::TooFaint };
        let frames = [
            stated(correct_verdict(), false, Some(5.5)),
            stated(wrong_verdict(), false, Some(3.2)),
            stated(wrong_verdict(), true, Some(4.1)),
            stated(missed, true, None),
        ];
        let curve = threshold_curve(&frames.iter().collect::<Vec<_>>());
        let row = |point: &ThresholdPoint| {
            (point.min_log_odds, point.correct_rate, point.wrong_rate, point.false_alarm_rate)
        };
        assert_eq!(
            curve.iter().map(row).collect::<Vec<_>>(),
            [
                (3.0, Some(0.5), Some(0.5), Some(0.5)),
                (4.0, Some(0.5), Some(0.0), Some(0.5)),
                (5.0, Some(0.5), Some(0.0), Some(0.0)),
            ]
        );
    }

    #[test]
    fn measurements_without_odds_have_no_curve() {
        let frames = [stated(correct_verdict(), false, Some(5.5)), stated(correct_verdict(), false, None)];
        assert!(threshold_curve(&frames.iter().collect::<Vec<_>>()).is_empty());
    }

    #[test]
    fn a_wide_range_of_odds_has_a_limited_number_of_thresholds() {
        let frames: Vec<FrameVerdict> =
            (-100..=100).map(|odds| stated(correct_verdict(), false, Some(f64::from(odds)))).collect();
        let curve = threshold_curve(&frames.iter().collect::<Vec<_>>());
        assert!(curve.len() <= MAX_POINTS && curve.len() > 20);
        assert_eq!(curve[0].correct_rate, Some(1.0));
    }
}
