//! Whether the errors of correct answers are as large as their covariances say.

use contract::{AttitudeSource, Covariance2, PixelPoint};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use sim::truth::ObjectTruth;

use super::belonging::{other_electrons, target, transmitted_electrons};
use super::definition::{Definition, Reduction};
use super::figure_spec::Better;
use super::report::{Figure, names};
use super::verdict::{FrameVerdict, Verdict};

/// What a larger NEES counts as: an error beyond all proportion is counted, and leaves the mean a number.
const LARGEST_NEES: f64 = 1e12;

/// What a larger error over its standard deviation counts as.
const LARGEST_OVER_SIGMA: f64 = 1e6;

/// Share of electrons up to which an image counts as the target's alone, and as whole.
const SMALL_SHARE: f64 = 0.02;

/// Shares of normal errors within one and three standard deviations.
const HONEST: [(&str, f64, f64); 2] = [("1", 1.0, 0.6827), ("3", 3.0, 0.9973)];

/// An error of two components in units of its covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalisedError {
    /// Each component over its own standard deviation; at most 1e6 in size.
    pub over_sigma: [f64; 2],
    /// Normalised estimation error squared per dimension, eᵀ C⁻¹ e / 2: 1 in the mean for an honest covariance C; at most 1e12.
    pub nees: f64,
}

impl NormalisedError {
    /// An error and its covariance, both in one unit.
    pub fn of(error: [f64; 2], covariance: &Covariance2) -> Self {
        let sigmas = [covariance.sigma_x(), covariance.sigma_y()];
        let over = |i: usize| match (error.get(i), sigmas.get(i)) {
            (Some(error), Some(sigma)) => (error / sigma).clamp(-LARGEST_OVER_SIGMA, LARGEST_OVER_SIGMA),
            _ => 0.0,
        };
        // `min` drops the NaN of errors so large that their squares are infinite.
        let nees = (covariance.mahalanobis_squared(error) / 2.0).min(LARGEST_NEES);
        Self { over_sigma: [over(0), over(1)], nees }
    }
}

/// What is left of the target's image in the cluster of a correct answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageState {
    /// All of it, and little else: less than 2 % of the target's electrons are cut away, at most 2 % of the electrons are of others.
    Whole,
    /// At least 2 % of the target's electrons lie outside the transmitted regions.
    Cut,
    /// More than 2 % of the transmitted electrons are of other objects that belong to the cluster or touch the target's image,
    /// whether the regions cut it or not.
    Merged,
}

impl ImageState {
    /// Every one, in the order of the tables.
    const ALL: [Self; 3] = [Self::Whole, Self::Cut, Self::Merged];

    /// The word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::Cut => "cut",
            Self::Merged => "merged",
        }
    }

    /// The state of the target in the cluster at `position`; `None` without a target.
    pub(super) fn of(position: PixelPoint, objects: &[ObjectTruth]) -> Option<Self> {
        let target = target(objects)?;
        let others = other_electrons(position, target, objects);
        Some(if others > SMALL_SHARE * (transmitted_electrons(target) + others) {
            Self::Merged
        } else if target.cut >= SMALL_SHARE {
            Self::Cut
        } else {
            Self::Whole
        })
    }
}

/// Honesty of the covariances in one kind of frames: a row of `consistency` in `score.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConsistencyRow {
    /// What the frames are told apart by: `image` or `attitude`.
    pub by: String,
    /// Of `image`: [`ImageState::code`]; of `attitude`: [`AttitudeSource::code`], or `unstated`.
    pub value: String,
    /// Correct answers of this kind with a covariance.
    pub frames: u64,
    /// The figures of consistency over them, by name.
    pub figures: IndexMap<String, Figure>,
}

/// Word for answers that state no source of their attitude.
const UNSTATED: &str = "unstated";

/// The figures of consistency, in their order: of the centroid and of the line of sight the mean NEES and the shares of
/// components within one and three standard deviations.
pub(super) fn definitions() -> Vec<Definition<'static, FrameVerdict>> {
    let centroid = |frame: &FrameVerdict| right(frame)?.centroid_normalised;
    let line_of_sight = |frame: &FrameVerdict| right(frame)?.line_of_sight_normalised;
    let mut list = of_errors(names::CENTROID, "centroid", centroid);
    list.extend(of_errors(names::LINE_OF_SIGHT, "line of sight", line_of_sight));
    list
}

fn of_errors(
    key: &str,
    words: &str,
    pick: fn(&FrameVerdict) -> Option<NormalisedError>,
) -> Vec<Definition<'static, FrameVerdict>> {
    let nees = move |frame: &FrameVerdict| Some(pick(frame)?.nees);
    let mean =
        Definition::of(format!("{key}_nees_mean"), format!("{words} NEES mean"), None, Reduction::Mean, nees);
    let mut list = vec![mean.best(Better::Near(1.0))];
    for (number, sigmas, honest) in HONEST {
        let within = move |frame: &FrameVerdict, values: &mut Vec<f64>| {
            let components = pick(frame).into_iter().flat_map(|error| error.over_sigma);
            values.extend(components.map(|error| f64::from(u8::from(error.abs() <= sigmas))));
        };
        let rate = Definition::pooled(
            format!("{key}_within_{number}sigma_rate"),
            format!("{words} within {number} σ"),
            within,
        );
        list.push(rate.best(Better::Near(honest)));
    }
    list
}

/// The error of a correct answer.
fn right(frame: &FrameVerdict) -> Option<super::angles::AnswerError> {
    match frame.verdict {
        Verdict::Correct { error } => Some(error),
        _ => None,
    }
}

/// Whether a frame has a correct answer with a covariance.
fn has_covariance(frame: &FrameVerdict) -> bool {
    right(frame)
        .is_some_and(|error| error.centroid_normalised.is_some() || error.line_of_sight_normalised.is_some())
}

/// The rows of `consistency`: by the state of the image, then by the source of the attitude; kinds that do not occur are left out.
/// Each sequence is in order of time.
pub(super) fn rows(sequences: &[&[&FrameVerdict]]) -> Vec<ConsistencyRow> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::{CENTRE, hot_pixel_at, star_at, target_with};

    fn sigmas(x: f64, y: f64, correlation: f64) -> Covariance2 {
        Covariance2::from_sigmas(x, y, correlation).unwrap()
    }

    /// (x² − 2 ρ x y + y²)/(1 − ρ²)/2 in units of σ: (4 − 2 + 1)/0.75/2 and (4 + 2 + 1)/0.75/2.
    #[test]
    fn the_nees_of_a_correlated_error_is_its_closed_form() {
        for (correlation, nees) in [(0.5, 2.0), (-0.5, 14.0 / 3.0)] {
            let error = NormalisedError::of([1.0, 0.25], &sigmas(0.5, 0.25, correlation));
            assert_eq!(error.over_sigma, [2.0, 1.0]);
            assert!((error.nees - nees).abs() < 1e-14, "{error:?}");
        }
    }

    #[test]
    fn an_error_beyond_all_proportion_is_a_number() {
        for sigma in [1e-9, 1e-200, 1e-310] {
            let error = NormalisedError::of([1.0, -1.0], &sigmas(sigma, sigma, 0.5));
            assert_eq!((error.over_sigma, error.nees), ([1e6, -1e6], LARGEST_NEES), "{sigma}");
        }
        assert_eq!(NormalisedError::of([0.0; 2], &sigmas(1e-310, 1e-310, 0.0)).nees, 0.0);
    }

    fn state(cut: f64, others: &[ObjectTruth]) -> &'static str {
        let mut objects = others.to_vec();
        objects.push(ObjectTruth { cut, ..target_with(1000.0) });
        ImageState::of(CENTRE, &objects).unwrap().code()
    }

    #[test]
    fn an_image_is_cut_from_two_percent_on() {
        assert_eq!((state(0.0199, &[]), state(0.02, &[]), state(0.9, &[])), ("whole", "cut", "cut"));
        assert_eq!(ImageState::of(CENTRE, &[]), None);
    }

    /// Reaches of 1.5 px each touch up to 3 px; 20.4/1020.4 is 2 %.
    #[test]
    fn an_image_is_merged_when_others_have_more_than_two_percent_of_its_electrons() {
        let star = |x_px: f64, electrons| star_at(7, PixelPoint::new(CENTRE.x + x_px, CENTRE.y), electrons);
        assert_eq!((state(0.0, &[star(2.9, 20.0)]), state(0.0, &[star(2.9, 21.0)])), ("whole", "merged"));
        assert_eq!(state(0.0, &[star(3.1, 5000.0)]), "whole");
        assert_eq!(state(0.0, &[star(2.9, 15.0), hot_pixel_at(3, CENTRE, 15.0)]), "merged");
        // What the regions cut away disturbs nothing, and what they leave of the target is disturbed the more.
        assert_eq!(state(0.0, &[ObjectTruth { cut: 1.0, ..star(1.0, 500.0) }]), "whole");
        assert_eq!(state(0.5, &[star(2.9, 15.0)]), "merged");
    }
}
