//! Residuals of stars that the adjustment did not use: how well a camera predicts.

use contract::{CameraFrame, Icrs, Rotation};

use crate::adjustment::{AdjustedCamera, Observation, Term, adjust};

/// Number of parts of the stars, each left out once.
const FOLDS: usize = 5;

/// Largest squared residual of a star, standard deviations: a wrong star must not decide.
pub(crate) const MAX_SQUARE: f64 = 25.0;

/// Returns the root mean square along an axis, px, of the distances of stars from their places by adjustments
/// without them and a fifth of the others; `None` if a part cannot be adjusted.
pub(crate) fn left_out_rms_px(
    camera: &AdjustedCamera,
    free: &[Term],
    attitudes: &[Rotation<CameraFrame, Icrs>],
    observations: &[Observation],
) -> Option<f64> {
    let mut squares_px2 = 0.0;
    for fold in 0..FOLDS {
        let (mut used, mut left_out) = (Vec::new(), Vec::new());
        for (index, observation) in observations.iter().enumerate() {
            if index % FOLDS == fold { left_out.push(*observation) } else { used.push(*observation) }
        }
        let adjusted = adjust(camera, free, attitudes, &used)?;
        let fitted = camera.model(&adjusted.terms)?;
        for observation in left_out {
            let direction = adjusted.attitudes[observation.frame].rotate(&observation.direction);
            let sigma_px = adjusted.errors.sigma_px(observation.sigma_px);
            let largest_px2 = MAX_SQUARE * sigma_px * sigma_px;
            squares_px2 += fitted.project_vector(&direction).map_or(largest_px2, |at| {
                let distance = at.distance(observation.position);
                (distance * distance).min(largest_px2)
            });
        }
    }
    (!observations.is_empty()).then(|| (squares_px2 / (2.0 * observations.len() as f64)).sqrt())
}
