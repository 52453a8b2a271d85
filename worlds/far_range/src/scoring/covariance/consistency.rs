//! Consistency of the errors of correct measurements with their stated covariances.

use contract::AttitudeSource;
use score::{Better, Definition, NormalisedError, Reduction};

use super::image_state::ImageState;
use crate::scoring::angles::AnswerError;
use crate::scoring::verdict::{FrameVerdict, Verdict};
use crate::scoring::{ConsistencyRow, names};

/// Fractions of normally distributed errors within one and three standard deviations.
const NORMAL_SHARES: [(&str, f64, f64); 2] = [("1", 1.0, 0.6827), ("3", 3.0, 0.9973)];

/// Name for outcomes that state no source of their attitude.
const UNSTATED: &str = "unstated";

/// Returns the figures of consistency, in order: for the centroid and for the line of sight, the mean NEES
/// and the fractions of components within one and three standard deviations.
pub(crate) fn definitions() -> Vec<Definition<'static, FrameVerdict>> {
    let centroid = |frame: &FrameVerdict| right(frame)?.centroid_normalised;
    let line_of_sight = |frame: &FrameVerdict| right(frame)?.line_of_sight_normalised;
    let mut list = error_figures(names::CENTROID, "centroid", centroid);
    list.extend(error_figures(names::LINE_OF_SIGHT, "line of sight", line_of_sight));
    list
}

fn error_figures(
    key: &str,
    words: &str,
    pick: fn(&FrameVerdict) -> Option<NormalisedError>,
) -> Vec<Definition<'static, FrameVerdict>> {
    let nees = move |frame: &FrameVerdict| Some(pick(frame)?.nees);
    let mean = Definition::amount(
        format!("{key}_nees_mean"),
        format!("{words} NEES mean"),
        None,
        Reduction::Mean,
        nees,
    );
    let mut list = vec![mean.with_direction(Better::Near(1.0))];
    for (number, sigmas, share) in NORMAL_SHARES {
        let within = move |frame: &FrameVerdict, values: &mut Vec<f64>| {
            let components = pick(frame).into_iter().flat_map(|error| error.over_sigma);
            values.extend(components.map(|error| f64::from(u8::from(error.abs() <= sigmas))));
        };
        let rate = Definition::pooled(
            format!("{key}_within_{number}sigma_rate"),
            format!("{words} within {number} σ"),
            within,
        );
        list.push(rate.with_direction(Better::Near(share)));
    }
    list
}

/// Returns the error of a correct measurement.
fn right(frame: &FrameVerdict) -> Option<AnswerError> {
    match frame.verdict {
        Verdict::Correct { error } => Some(error),
        _ => None,
    }
}

/// Returns true if a frame has a correct measurement with a covariance.
fn has_covariance(frame: &FrameVerdict) -> bool {
    right(frame)
        .is_some_and(|error| error.centroid_normalised.is_some() || error.line_of_sight_normalised.is_some())
}

/// Returns the rows of `consistency`: by the state of the image, then by the source of the attitude, without
/// kinds that do not occur. Each sequence must be in order of time.
pub(crate) fn rows(sequences: &[&[&FrameVerdict]]) -> Vec<ConsistencyRow> {
    let image = |state: ImageState| move |frame: &FrameVerdict| frame.image == Some(state);
    let of_images =
        ImageState::ALL.into_iter().filter_map(|state| row("image", state.code(), sequences, image(state)));
    let sources = AttitudeSource::ALL.into_iter().map(Some).chain([None]);
    let of_attitudes = sources.filter_map(|source| {
        let value = source.map_or(UNSTATED, AttitudeSource::code);
        row("attitude", value, sequences, move |frame| frame.attitude_source == source)
    });
    of_images.chain(of_attitudes).collect()
}

fn row(
    by: &str,
    value: &str,
    sequences: &[&[&FrameVerdict]],
    is_of_kind: impl Fn(&FrameVerdict) -> bool,
) -> Option<ConsistencyRow> {
    let is_counted = |frame: &&FrameVerdict| has_covariance(frame) && is_of_kind(frame);
    let kept: Vec<Vec<&FrameVerdict>> =
        sequences.iter().map(|sequence| sequence.iter().copied().filter(is_counted).collect()).collect();
    let kept: Vec<&[&FrameVerdict]> = kept.iter().map(Vec::as_slice).collect();
    let frames = kept.iter().map(|sequence| sequence.len()).sum::<usize>() as u64;
    let figure = |definition: &Definition<'_, FrameVerdict>| {
        (definition.figure.name.clone(), definition.figure(&kept))
    };
    (frames > 0).then(|| ConsistencyRow {
        by: by.to_owned(),
        value: value.to_owned(),
        frames,
        figures: definitions().iter().map(figure).collect(),
    })
}
