//! The terms of the distortion that the stars carry, by stars left out.

use contract::{CameraFrame, Icrs, Rotation};

use crate::adjustment::{AdjustedCamera, Observation, Term, adjust, project};

/// Sets of free terms, from the simplest: each is tried against the best before it.
pub const SETS: [&[Term]; 4] = [
    &[Term::FocalLength, Term::PrincipalX, Term::PrincipalY, Term::Radial1],
    &[
        Term::FocalLength,
        Term::PrincipalX,
        Term::PrincipalY,
        Term::Radial1,
        Term::Tangential1,
        Term::Tangential2,
    ],
    &[
        Term::FocalLength,
        Term::PrincipalX,
        Term::PrincipalY,
        Term::Radial1,
        Term::Radial2,
        Term::Tangential1,
        Term::Tangential2,
    ],
    &[
        Term::FocalLength,
        Term::PrincipalX,
        Term::PrincipalY,
        Term::Radial1,
        Term::Radial2,
        Term::Radial3,
        Term::Tangential1,
        Term::Tangential2,
    ],
];

/// Number of parts of the stars, each left out once.
const FOLDS: usize = 5;

/// Largest squared residual of a star left out, standard deviations: a wrong star must not decide.
pub(crate) const MAX_SQUARE: f64 = 25.0;

/// Number of standard errors by which a larger set must predict the stars better.
const NEEDED_STANDARD_ERRORS: f64 = 2.0;

/// A chosen set of terms.
#[derive(Debug, Clone, Copy)]
pub struct ChosenTerms {
    /// Free terms.
    pub free: &'static [Term],
    /// Root mean square of the residuals of stars left out, along an axis, px; NaN if too few stars for
    /// parts.
    pub left_out_rms_px: f64,
}

/// Chooses the terms with which a camera predicts stars best that its adjustment did not use. A larger set is
/// taken if it predicts better by more than twice the standard error of the difference.
pub fn choose_terms(
    camera: &AdjustedCamera,
    attitudes: &[Rotation<CameraFrame, Icrs>],
    observations: &[Observation],
) -> ChosenTerms {
    let [simplest, larger @ ..] = SETS;
    let Some(mut best) = left_out_residuals(camera, simplest, attitudes, observations) else {
        return ChosenTerms { free: simplest, left_out_rms_px: f64::NAN };
    };
    let mut chosen = simplest;
    for set in larger {
        let Some(residuals) = left_out_residuals(camera, set, attitudes, observations) else { continue };
        if predicts_better(&residuals, &best) {
            (chosen, best) = (set, residuals);
        }
    }
    let squares: f64 = best.iter().sum();
    ChosenTerms { free: chosen, left_out_rms_px: (squares / (2.0 * best.len() as f64)).sqrt() }
}

/// Returns the squared distance, px², of each observation from its place by an adjustment without it and a
/// fifth of the others; `None` if a part cannot be adjusted.
fn left_out_residuals(
    camera: &AdjustedCamera,
    free: &[Term],
    attitudes: &[Rotation<CameraFrame, Icrs>],
    observations: &[Observation],
) -> Option<Vec<f64>> {
    let mut squares_px2 = Vec::with_capacity(observations.len());
    for fold in 0..FOLDS {
        let (mut used, mut left_out) = (Vec::new(), Vec::new());
        for (index, observation) in observations.iter().enumerate() {
            if index % FOLDS == fold { left_out.push(*observation) } else { used.push(*observation) }
        }
        let adjusted = adjust(camera, free, attitudes, &used)?;
        let fitted = camera.camera(&adjusted.terms);
        for observation in left_out {
            let direction = adjusted.attitudes[observation.frame].rotate(&observation.direction);
            let sigma_px = adjusted.errors.sigma_px(observation.sigma_px);
            let largest_px2 = MAX_SQUARE * sigma_px * sigma_px;
            let square_px2 = project(&fitted, &direction).map_or(largest_px2, |at| {
                let distance = at.distance(observation.position);
                (distance * distance).min(largest_px2)
            });
            squares_px2.push(square_px2);
        }
    }
    (!squares_px2.is_empty()).then_some(squares_px2)
}

/// Returns true if the squares `new` are smaller than `old` by more than chance, star by star.
fn predicts_better(new: &[f64], old: &[f64]) -> bool {
    let count = new.len().min(old.len()) as f64;
    let gains: Vec<f64> = old.iter().zip(new).map(|(old, new)| old - new).collect();
    let mean = gains.iter().sum::<f64>() / count;
    let variance =
        gains.iter().map(|gain| (gain - mean) * (gain - mean)).sum::<f64>() / (count - 1.0).max(1.0);
    mean > NEEDED_STANDARD_ERRORS * (variance / count).sqrt()
}
