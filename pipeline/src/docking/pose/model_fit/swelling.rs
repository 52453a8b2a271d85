//! Swelling: outward displacement of the edges of bright features from the target's dimensions. A nonlinear
//! video signal moves the edges towards the darker side.

use contract::docking::TargetModel;
use nalgebra::Vector2;

/// Step in the numeric derivative with respect to the swelling, px.
pub(super) const STEP_PX: f64 = 0.05;

/// Prior standard deviation of the swelling, px.
const PRIOR_PX: f64 = 0.05;

/// Share of the information from previous fields that is kept per field.
const RETENTION: f64 = 0.9;

/// Knowledge of the swelling: its information, 1/px², and the product of information and mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Swelling {
    pub(super) weight: f64,
    pub(super) weighted: f64,
}

impl Default for Swelling {
    /// Returns the prior.
    fn default() -> Self {
        Self { weight: 1.0 / (PRIOR_PX * PRIOR_PX), weighted: 0.0 }
    }
}

impl Swelling {
    /// Returns the knowledge after adding the information of one field.
    pub(super) fn add_information(&self, weight: f64, weighted: f64) -> Self {
        Self { weight: self.weight + weight, weighted: self.weighted + weighted }
    }

    /// Returns the knowledge that remains for the next field. The response of a video changes slowly, and
    /// only by external causes.
    pub(super) fn decayed(&self) -> Self {
        let prior = Self::default();
        Self {
            weight: prior.weight + RETENTION * (self.weight - prior.weight),
            weighted: RETENTION * self.weighted,
        }
    }
}

/// Returns the target with all edges of its features moved outwards by [`STEP_PX`] in the image. `scale` is
/// that on the plate, px/m.
pub(super) fn enlarged_target(target: &TargetModel, scale: f64) -> TargetModel {
    let by_m = STEP_PX / scale;
    let mut swollen = target.clone();
    swollen.cross.width_m += 2.0 * by_m;
    swollen.cross.half_length_m += by_m;
    for (corners, new) in target.marks.iter().zip(&mut swollen.marks) {
        for k in 0..4 {
            let at = Vector2::from(corners[k]);
            let outwards = |other: usize| (at - Vector2::from(corners[other % 4])).normalize();
            new[k] = (at + (outwards(k + 1) + outwards(k + 3)) * by_m).into();
        }
    }
    swollen
}
