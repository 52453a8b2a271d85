//! Errors common to groups of pixels: a shift and a level of each line, a shift along and across lines of
//! each patch.
//!
//! The fit treats pixels as independent. However, a line that comes a little early or late shifts all its
//! edges at once, and a line that is a little brighter is so in all its pixels. Noise spread over neighbours
//! by a filter, the blocks of a codec, or a blur with another shape than the model's shift each mark and each
//! piece of the cross separately. The scatter of lines and patches beyond that of noise is measured from the
//! residuals and added to the covariance.

use nalgebra::SVector;

use super::samples::Patch;
use super::swelling::Swelling;
use super::unknowns::{GlobalMatrix, Globals, LOCALS, POSE};

/// Number of effects per group: shift and level for a line, two shifts for a patch.
pub(super) const EFFECTS: usize = 2;

/// Significance of a scatter of groups, in standard deviations of the sum of squares: chance exceeds it once
/// in 40 fields.
const MIN_SIGNIFICANCE: f64 = 2.0;

/// Sums over the pixels of a group, which is a line or a patch.
#[derive(Debug, Clone, Copy)]
struct Group {
    /// Σ e r per effect: e is the change of a pixel by a unit of the effect, r the residual.
    seen: [f64; EFFECTS],
    /// Σ e², minus the part absorbed by the patches' levels.
    squares: [f64; EFFECTS],
    /// Σ J e: change of the gradient by a unit of the effect.
    scores: [Globals; EFFECTS],
}

/// Sums over a group's pixels in one patch. The patch's levels absorb a part of them.
#[derive(Debug, Clone, Copy)]
struct Piece {
    group: usize,
    squares: [f64; EFFECTS],
    by_levels: [SVector<f64, LOCALS>; EFFECTS],
    by_globals: [Globals; EFFECTS],
}

impl Piece {
    fn from_group(group: usize) -> Self {
        let (by_levels, by_globals) = ([SVector::zeros(); EFFECTS], [Globals::zeros(); EFFECTS]);
        Self { group, squares: [0.0; EFFECTS], by_levels, by_globals }
    }
}

/// Sums for all groups, with reusable buffers.
#[derive(Debug, Default)]
pub(super) struct Groups {
    groups: Vec<Group>,
    pieces: Vec<Piece>,
    pixels: f64,
}

/// Pixel with the quantities that the sums need.
pub(super) struct GroupedPixel {
    /// Index of the pixel's line or patch.
    pub(super) group: usize,
    pub(super) residual: f64,
    /// Change of the pixel by a unit of each effect, DN.
    pub(super) effects: [f64; EFFECTS],
    /// Derivatives of the pixel's coverage with respect to the globals.
    pub(super) slopes: Globals,
    /// Regressors of the levels at the pixel.
    pub(super) levels: SVector<f64, LOCALS>,
}

impl Groups {
    pub(super) fn clear(&mut self) {
        self.groups.clear();
        self.pixels = 0.0;
    }

    /// Adds a pixel of the current patch.
    pub(super) fn add(&mut self, pixel: &GroupedPixel) {
        let GroupedPixel { group, residual, effects, slopes, levels } = pixel;
        if self.groups.len() <= *group {
            let zero = [Globals::zeros(); EFFECTS];
            self.groups
                .resize(group + 1, Group { seen: [0.0; EFFECTS], squares: [0.0; EFFECTS], scores: zero });
        }
        // A patch's pixels come line by line, so the piece is nearly always the last.
        let index = self.pieces.iter().rposition(|piece| piece.group == *group).unwrap_or_else(|| {
            self.pieces.push(Piece::from_group(*group));
            self.pieces.len() - 1
        });
        let (sums, piece) = (&mut self.groups[*group], &mut self.pieces[index]);
        for (k, effect) in effects.iter().enumerate() {
            sums.seen[k] += effect * residual;
            piece.squares[k] += effect * effect;
            piece.by_levels[k] += levels * *effect;
            piece.by_globals[k] += slopes * *effect;
        }
        self.pixels += 1.0;
    }

    /// Closes a patch: subtracts the part of every sum that the patch's levels absorb.
    pub(super) fn close(&mut self, patch: &Patch) {
        let level = patch.levels[LOCALS - 1];
        let by_levels = patch.levels_by_globals.transpose();
        for piece in &self.pieces {
            let sums = &mut self.groups[piece.group];
            for k in 0..EFFECTS {
                let taken = piece.by_levels[k].dot(&(patch.levels_inverse * piece.by_levels[k]));
                sums.squares[k] += (piece.squares[k] - taken).max(0.0);
                sums.scores[k] += (piece.by_globals[k] - by_levels * piece.by_levels[k]) * level;
            }
        }
        self.pieces.clear();
    }

    /// Returns the covariance of the gradient from effects of variance 1 in one group.
    pub(super) fn group_covariance(&self, group: usize) -> GlobalMatrix {
        let scores = self.groups.get(group).into_iter().flat_map(|sums| &sums.scores);
        scores.map(|scores| scores * scores.transpose()).sum()
    }

    /// Returns the covariance of the gradient from effects of variance 1 that are shared by several groups.
    pub(super) fn common_covariance(&self, groups: impl Iterator<Item = usize> + Clone) -> GlobalMatrix {
        let sum = |k: usize| -> Globals {
            groups.clone().filter_map(|group| Some(self.groups.get(group)?.scores[k])).sum()
        };
        (0..EFFECTS).map(sum).map(|scores| scores * scores.transpose()).sum()
    }

    /// Treats the swelling as an unknown of the fit; its effect is that of the first group. Returns the
    /// change of the globals, their covariance due to the swelling, and the updated knowledge of the
    /// swelling. `inverse` is the inverse of the information, `variance` the variance of a pixel.
    pub(super) fn estimate_swelling(
        &self,
        inverse: &GlobalMatrix,
        variance: f64,
        known: &Swelling,
    ) -> Option<(Globals, GlobalMatrix, Swelling)> {
        let all = self.groups.first()?;
        let by_globals = inverse * all.scores[0];
        let alone = (all.squares[0] - all.scores[0].dot(&by_globals)).max(0.0);
        let now = known.add_information(alone / variance, all.seen[0] / variance);
        let change = by_globals * -(now.weighted / now.weight);
        let covariance = by_globals * by_globals.transpose() / now.weight;
        (change.iter().chain(&covariance).all(|v| v.is_finite())).then_some((change, covariance, now))
    }

    /// Returns the covariance of the gradient from the errors common to the pixels of a group, DN², and the
    /// part of a pixel's variance that they explain.
    ///
    /// With q = Σ e² of a group, its sum Σ e r has the variance σ² q + τ² q², and all pixels together have N
    /// σ² + τ² Σ q. Solving both gives τ², the variance of the effect.
    pub(super) fn scatter(&self, variance: f64) -> (GlobalMatrix, f64) {
        let (mut covariance, mut explained) = (GlobalMatrix::zeros(), 0.0);
        for k in 0..EFFECTS {
            let sum = |of: &dyn Fn(&Group) -> f64| self.groups.iter().map(of).sum::<f64>();
            let (once, twice) = (sum(&|l| l.squares[k]), sum(&|l| l.squares[k] * l.squares[k]));
            let above = sum(&|l| l.seen[k] * l.seen[k]) - variance * once;
            let weight = twice - once * once / self.pixels.max(1.0);
            if weight <= 0.0 || above <= MIN_SIGNIFICANCE * variance * (2.0 * twice).sqrt() {
                continue;
            }
            // The pose has absorbed a part of the groups' scatter: the equivalent number of groups of equal
            // weight is reduced by the pose's degrees of freedom.
            let groups = once * once / twice;
            let of_effect = above / weight * groups / (groups - POSE as f64).max(1.0);
            explained += of_effect * once / self.pixels;
            for group in &self.groups {
                covariance += group.scores[k] * group.scores[k].transpose() * of_effect;
            }
        }
        (covariance, explained)
    }
}

/// Returns the rotations of the camera that shift the image by one pixel along the lines and across them,
/// from the derivatives of an image point with respect to the pose. Returns `None` when no rotation does.
pub(super) fn turns(by_pose: &nalgebra::SMatrix<f64, 2, POSE>) -> Option<[SVector<f64, POSE>; 2]> {
    let (a, b, c, d) = (by_pose[(0, 3)], by_pose[(0, 4)], by_pose[(1, 3)], by_pose[(1, 4)]);
    let determinant = a * d - b * c;
    (determinant.abs() > 1e-9).then(|| {
        let (mut along, mut across) = (SVector::zeros(), SVector::zeros());
        (along[3], along[4]) = (d / determinant, -c / determinant);
        (across[3], across[4]) = (-b / determinant, a / determinant);
        [along, across]
    })
}

#[cfg(test)]
mod tests {
    use super::super::samples::Feature;
    use super::*;

    /// Returns a random number that is normal to a few percent: the sum of twelve uniform numbers of a
    /// multiplicative congruential sequence (Park and Miller 1988).
    fn normal(state: &mut u64) -> f64 {
        let mut uniform = || {
            *state = *state * 48_271 % 2_147_483_647;
            *state as f64 / 2_147_483_647.0
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }

    /// Returns 200 lines of 20 pixels with noise of 1 DN, shifted by `shift_px` and brighter by `level_dn`,
    /// each times a normal number per line.
    fn lines(shift_px: f64, level_dn: f64) -> Groups {
        let (mut lines, mut state) = (Groups::default(), 12_345);
        lines.clear();
        for group in 0..200 {
            let (shift, level) = (shift_px * normal(&mut state), level_dn * normal(&mut state));
            for x in 0..20 {
                // Edges of both signs.
                let slope = if x % 2 == 0 { 50.0 } else { -40.0 };
                let mut slopes = Globals::zeros();
                (slopes[0], slopes[1]) = (slope, 1.0);
                lines.add(&GroupedPixel {
                    group,
                    residual: slope * shift + level + normal(&mut state),
                    effects: [slope, 1.0],
                    slopes,
                    levels: SVector::zeros(),
                });
            }
        }
        let mut patch = Patch::new(Feature::Cross, 0..1, (0.0, 0.0));
        patch.levels[LOCALS - 1] = 1.0;
        lines.close(&patch);
        lines
    }

    #[test]
    fn noise_alone_is_no_scatter_of_lines() {
        let (covariance, explained) = lines(0.0, 0.0).scatter(1.0);
        assert_eq!((covariance.abs().max(), explained), (0.0, 0.0));
    }

    #[test]
    fn shifts_of_lines_are_found_in_their_size() {
        let shift_px = 0.1;
        // Mean of the squares of 50 and 40.
        let square = 2050.0;
        let variance = 1.0 + shift_px * shift_px * square;
        let (covariance, explained) = lines(shift_px, 0.0).scatter(variance);
        // 200 lines determine a variance to √(2/200) = 10 %; the tolerance is three times that.
        assert!((explained / (shift_px * shift_px * square) - 1.0).abs() < 0.3, "{explained}");
        let of_line = 20.0 * square * shift_px;
        let expected = 200.0 * of_line * of_line;
        assert!((covariance[(0, 0)] / expected - 1.0).abs() < 0.3, "{}", covariance[(0, 0)]);
    }

    #[test]
    fn levels_of_lines_are_found_in_their_size() {
        let (covariance, explained) = lines(0.0, 1.0).scatter(2.0);
        assert!((explained - 1.0).abs() < 0.3, "{explained}");
        assert!((covariance[(1, 1)] / (200.0 * 400.0) - 1.0).abs() < 0.3, "{}", covariance[(1, 1)]);
    }
}
