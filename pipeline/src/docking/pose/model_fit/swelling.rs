//! How far the edges of bright features lie farther out than the target's dimensions have them: a video that is not linear in light moves
//! them towards the darker side.

use contract::docking::TargetModel;
use nalgebra::Vector2;

/// The step by which the effect of a swelling is formed, px.
pub(super) const STEP_PX: f64 = 0.05;

/// Standard deviation of the swelling before anything is seen, px.
const PRIOR_PX: f64 = 0.05;

/// What is kept from field to field of what the fields before told.
const RETENTION: f64 = 0.9;

/// What is known of the swelling: its information, 1/px², and that times its mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Swelling {
    pub(super) weight: f64,
    pub(super) weighted: f64,
}

impl Default for Swelling {
    /// Nothing seen yet.
    fn default() -> Self {
        Self { weight: 1.0 / (PRIOR_PX * PRIOR_PX), weighted: 0.0 }
    }
}

impl Swelling {
    /// After a field that tells so much by itself.
    pub(super) fn add_information(&self, weight: f64, weighted: f64) -> Self {
        Self { weight: self.weight + weight, weighted: self.weighted + weighted }
    }

    /// What is left of it for the next field: a video's law changes slowly, and not at all by itself.
    pub(super) fn decayed(&self) -> Self {
        let prior = Self::default();
        Self {
            weight: prior.weight + RETENTION * (self.weight - prior.weight),
            weighted: RETENTION * self.weighted,
        }
    }
}

/// The target with all edges of its features so far outside that they lie [`STEP_PX`] farther out in the image; `scale`: px/m on the
/// plate.
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
