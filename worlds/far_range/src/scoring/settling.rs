//! Number of frames that a pipeline takes to settle.

use score::{Better, Figure, FigureSpec};

use super::verdict::{FrameVerdict, Verdict};
use crate::scoring::names;

/// Number of consecutive correct measurements that show that a pipeline has settled. A pipeline that is right
/// by chance in 80 % of the frames starts with such a run once in a hundred times, one that is right in 99 %
/// four times in five.
const SETTLED_FRAMES: usize = 20;

/// Returns the description of the figure.
pub(super) fn spec() -> FigureSpec {
    FigureSpec::amount(names::FRAMES_UNTIL_SETTLED, "frames until settled", Better::Less)
}

/// Computes the mean number of frames before the first [`SETTLED_FRAMES`] consecutive correct measurements,
/// over the sequences that have at least this many frames. The figure has no value when one of these
/// sequences never settles: the mean of the remaining ones would be too good.
///
/// Frames without a measurement in which no pipeline could have found the target (outside the field, in
/// eclipse, too faint, cut away) are left out: they neither count nor interrupt a run.
pub(super) fn figure(sequences: &[&[&FrameVerdict]]) -> Figure {
    let starts = sequences.iter().map(|frames| answers(frames)).filter(|start| start.len() >= SETTLED_FRAMES);
    let waits: Option<Vec<Vec<f64>>> =
        starts.map(|start| wait(&start).map(|frames| vec![frames as f64])).collect();
    Figure::mean(&waits.unwrap_or_default())
}

/// Returns true for each correct frame and false for each other one; frames that do not count are left out.
fn answers(frames: &[&FrameVerdict]) -> Vec<bool> {
    let is_correct = |frame: &&FrameVerdict| match frame.verdict {
        Verdict::Missed { cause } if cause.is_undetectable() => None,
        Verdict::Correct { .. } => Some(true),
        Verdict::Missed { .. } | Verdict::Wrong { .. } => Some(false),
    };
    frames.iter().filter_map(is_correct).collect()
}

/// Returns the number of frames before the first [`SETTLED_FRAMES`] consecutive correct ones; `None` if there
/// is no such run.
fn wait(correct: &[bool]) -> Option<usize> {
    correct.windows(SETTLED_FRAMES).position(|run| run.iter().all(|correct| *correct))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::angles::AnswerError;
    use crate::scoring::cause::Cause;
    use crate::scoring::hand_made::verdict_of;

    const CORRECT: Verdict = Verdict::Correct {
        error: AnswerError {
            centroid_px: None,
            line_of_sight: None,
            centroid_normalised: None,
            line_of_sight_normalised: None,
        },
    };
    const LOST: Verdict = Verdict::Missed { cause: Cause::LostMotionTest };
    const ECLIPSE: Verdict = Verdict::Missed { cause: Cause::InEclipse };

    /// Returns the figure's value for sequences that are given as pairs of a number of frames and their
    /// verdict.
    fn value(sequences: &[&[(usize, Verdict)]]) -> Option<f64> {
        let frames = |stretches: &&[(usize, Verdict)]| -> Vec<FrameVerdict> {
            let verdicts =
                stretches.iter().flat_map(|(count, verdict)| std::iter::repeat_n(*verdict, *count));
            let frame = |(frame, verdict)| FrameVerdict { frame, ..verdict_of(verdict) };
            (0..).zip(verdicts).map(frame).collect()
        };
        let frames: Vec<Vec<FrameVerdict>> = sequences.iter().map(frames).collect();
        let borrowed: Vec<Vec<&FrameVerdict>> = frames.iter().map(|frames| frames.iter().collect()).collect();
        let sequences: Vec<&[&FrameVerdict]> = borrowed.iter().map(Vec::as_slice).collect();
        let figure = figure(&sequences);
        assert_eq!(figure.value.is_some(), figure.of > 0);
        figure.value
    }

    #[test]
    fn the_wait_ends_where_twenty_correct_answers_begin() {
        assert_eq!(value(&[&[(20, CORRECT)]]), Some(0.0));
        assert_eq!(value(&[&[(66, LOST), (20, CORRECT), (9, LOST)]]), Some(66.0));
        assert_eq!(value(&[&[(19, CORRECT), (1, LOST), (20, CORRECT)]]), Some(20.0));
        assert_eq!(value(&[&[(19, CORRECT), (1, LOST), (19, CORRECT)]]), None);
    }

    #[test]
    fn frames_without_a_detectable_target_neither_count_nor_interrupt() {
        assert_eq!(
            value(&[&[(30, ECLIPSE), (3, LOST), (10, CORRECT), (30, ECLIPSE), (10, CORRECT)]]),
            Some(3.0)
        );
        // Frames in eclipse do not count towards the required length of a sequence either.
        assert_eq!(value(&[&[(30, ECLIPSE), (19, CORRECT)]]), None);
    }

    #[test]
    fn the_mean_is_over_sequences_and_there_is_none_when_one_never_settles() {
        let settling: &[(usize, Verdict)] = &[(10, LOST), (40, CORRECT)];
        let at_once: &[(usize, Verdict)] = &[(40, CORRECT)];
        let never: &[(usize, Verdict)] = &[(40, LOST)];
        let short: &[(usize, Verdict)] = &[(5, LOST)];
        assert_eq!(value(&[settling, at_once, short]), Some(5.0));
        assert_eq!(value(&[settling, at_once, never]), None);
        assert_eq!(value(&[]), None);
    }
}
