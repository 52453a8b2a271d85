//! Warps of the picture that the camera file does not state: distortion by the lens, bent, sheared and
//! stretched scans, exposure line by line.
//!
//! A warp displaces the content of the picture by δ(u, v). A part of it looks like another pose; the rest
//! remains in the residuals and shows the size of the whole. Each warp is therefore tested as an additional
//! unknown at the solution (score test; Rao, *Linear Statistical Inference and Its Applications*, 1973,
//! section 6e). The warps of recent fields are averaged, and their scatter decides whether the average is
//! significant: lines that come early or late bend every field, each in another way. A significant warp
//! biases the pose; the square of this bias is added to the covariance. A bend or a shear of the lines may
//! also displace the picture as a whole, which no residual shows; this is assumed to be as large as the
//! displacement at the picture's upper and lower edge. A stretch may be of the rows or of the columns, which
//! have different ranges.

use contract::docking::PictureWarp;
use nalgebra::{SMatrix, SVector};

use super::groups::GroupedPixel;
use super::samples::Patch;
use super::unknowns::{GLOBALS, GlobalMatrix, Globals, LOCALS, POSE};
use crate::docking::portions::inverse;

/// Number of warps: radial distortion, bend, shear, stretch.
const WARPS: usize = 4;

/// Share of the information from previous fields that is kept per field. A lens and a scan change slowly.
const RETENTION: f64 = 0.97;

/// Prior of the scatter of a warp from field to field, in units of its variance by noise, and the number of
/// fields that it is worth. With these, a single field's warp counts from 9 σ on.
const PRIOR_SCATTER: f64 = 3.0;
const PRIOR_FIELDS: f64 = 3.0;

/// Smallest significance of an average, in its standard deviations.
const MIN_SIGNIFICANCE: f64 = 5.2;

/// Sizes of the warps: those of [`PictureWarp`], the first two for coordinates in units of the focal length.
type Sizes = SVector<f64, WARPS>;
type WarpMatrix = SMatrix<f64, WARPS, WARPS>;
type GlobalsByWarp = SMatrix<f64, GLOBALS, WARPS>;
type LevelsByWarp = SMatrix<f64, LOCALS, WARPS>;

/// Average of a warp over recent fields, each with its information 1/σ².
#[derive(Debug, Clone, Copy, Default)]
struct WarpAverage {
    /// Number of fields, each decayed by its age.
    fields: f64,
    /// Σ 1/σ², and the same sum with the square of the decay.
    information: f64,
    information_of_squares: f64,
    /// Σ w/σ² and Σ w²/σ², w being the warp of a field.
    weighted: f64,
    squares: f64,
}

impl WarpAverage {
    fn add(&mut self, size: f64, variance: f64) {
        self.fields = RETENTION * self.fields + 1.0;
        self.information = RETENTION * self.information + 1.0 / variance;
        self.information_of_squares = RETENTION * RETENTION * self.information_of_squares + 1.0 / variance;
        self.weighted = RETENTION * self.weighted + size / variance;
        self.squares = RETENTION * self.squares + size * size / variance;
    }

    /// Returns the average if it is significant.
    fn significant_mean(&self) -> Option<f64> {
        let mean = self.weighted / self.information;
        // χ² of the fields about their mean, and the scatter in units of the noise's variance, at least 1.
        let squares_about_mean = (self.squares - mean * self.weighted).max(0.0);
        let prior = PRIOR_FIELDS * PRIOR_SCATTER;
        let scatter = ((prior + squares_about_mean) / (PRIOR_FIELDS + self.fields - 1.0)).max(1.0);
        let variance = scatter * self.information_of_squares / (self.information * self.information);
        (mean * mean > MIN_SIGNIFICANCE * MIN_SIGNIFICANCE * variance).then_some(mean)
    }
}

/// Warps of recent fields of one camera.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WarpHistory {
    /// Focal length of the camera along columns and rows, px. Another lens begins anew.
    focal_px: (f64, f64),
    averages: [WarpAverage; WARPS],
}

impl WarpHistory {
    /// Returns the history with a field added.
    fn with_field(&self, focal_px: (f64, f64), size: &Sizes, covariance: &WarpMatrix) -> Self {
        let mut history = if self.focal_px == focal_px { *self } else { Self::default() };
        history.focal_px = focal_px;
        for k in 0..WARPS {
            if covariance[(k, k)] > 0.0 && size[k].is_finite() {
                history.averages[k].add(size[k], covariance[(k, k)]);
            }
        }
        history
    }
}

/// Sums over the pixels of a field.
#[derive(Debug, Clone)]
pub(super) struct WarpSums {
    /// Focal length along columns and rows, px.
    focal_px: (f64, f64),
    /// Σ e r: e is the change of a pixel by a unit of the warp, r the residual.
    seen: Sizes,
    /// Σ e eᵀ, minus the part absorbed by the patches' levels.
    squares: WarpMatrix,
    /// Σ J eᵀ: change of the gradient by a unit of the warp.
    scores: GlobalsByWarp,
    /// The same sums over the pixels of the current patch.
    patch_squares: WarpMatrix,
    patch_by_levels: LevelsByWarp,
    patch_by_globals: GlobalsByWarp,
}

/// Warp that recent fields show, and its effect on the pose.
pub(super) struct WarpEffect {
    /// Significant sizes; zero for the others.
    pub(super) warp: Option<PictureWarp>,
    /// Covariance of the globals by the warp.
    pub(super) covariance: GlobalMatrix,
    /// Warps of recent fields, including this one.
    pub(super) history: WarpHistory,
}

impl WarpSums {
    pub(super) fn new(focal_px: (f64, f64)) -> Self {
        Self {
            focal_px,
            seen: Sizes::zeros(),
            squares: WarpMatrix::zeros(),
            scores: GlobalsByWarp::zeros(),
            patch_squares: WarpMatrix::zeros(),
            patch_by_levels: LevelsByWarp::zeros(),
            patch_by_globals: GlobalsByWarp::zeros(),
        }
    }

    /// Adds a pixel at (`u`, `v`) of the current patch; `along` and `across` are its changes by a
    /// displacement of one pixel along and across the lines, DN.
    pub(super) fn add(&mut self, u: f64, v: f64, along: f64, across: f64, pixel: &GroupedPixel) {
        let (x, y) = (u / self.focal_px.0, v / self.focal_px.1);
        let radial = x * x + y * y;
        let effects = Sizes::new(
            (along * u + across * v) * radial,
            along * self.focal_px.0 * y * y,
            along * v,
            across * v,
        );
        self.seen += effects * pixel.residual;
        self.patch_squares += effects * effects.transpose();
        self.patch_by_levels += pixel.levels * effects.transpose();
        self.patch_by_globals += pixel.slopes * effects.transpose();
    }

    /// Closes a patch: subtracts the part of every sum that the patch's levels absorb.
    pub(super) fn close(&mut self, patch: &Patch) {
        let level = patch.levels[LOCALS - 1];
        let taken = self.patch_by_levels.tr_mul(&(patch.levels_inverse * self.patch_by_levels));
        self.squares += self.patch_squares - taken;
        self.scores +=
            (self.patch_by_globals - patch.levels_by_globals.tr_mul(&self.patch_by_levels)) * level;
        self.patch_squares.fill(0.0);
        self.patch_by_levels.fill(0.0);
        self.patch_by_globals.fill(0.0);
    }

    /// Estimates the warp of the field and averages it with those of recent fields.
    ///
    /// With H the information on the globals, C the change of the gradient by a unit of the warps and S the
    /// squares of their effects, the warps have the information S − Cᵀ H⁻¹ C and change the globals by
    /// −H⁻¹ C w. `along` is the change of the pose that displaces the picture by one pixel along the lines,
    /// `rows` the number of rows of the camera, `range_m` the range of the target. Returns `None` when the
    /// pixels do not determine the warps.
    pub(super) fn effect(
        &self,
        inverse_information: &GlobalMatrix,
        variance: f64,
        along: &SVector<f64, POSE>,
        rows: usize,
        range_m: f64,
        known: &WarpHistory,
    ) -> Option<WarpEffect> {
        let by_warp = inverse_information * self.scores;
        let of_unit_noise = inverse(&(self.squares - self.scores.tr_mul(&by_warp)))?;
        let size = of_unit_noise * self.seen;
        let history = known.with_field(self.focal_px, &size, &(of_unit_noise * variance));
        let significant = history.averages.map(|average| average.significant_mean());
        let [radial, bend, shear, stretch] = significant.map(Option::unwrap_or_default);
        let bias = by_warp * Sizes::new(radial, bend, shear, stretch);
        let mut covariance = bias * bias.transpose();
        // Displacement of the first and the last row by bend and shear, px.
        let half_rows = 0.5 * rows as f64;
        let edge_y = half_rows / self.focal_px.1;
        let edge_px = libm::hypot(bend * self.focal_px.0 * edge_y * edge_y, shear * half_rows);
        let mut shifted = Globals::zeros();
        shifted.fixed_rows_mut::<POSE>(0).copy_from(&(along * edge_px));
        covariance += shifted * shifted.transpose();
        // A stretch of the columns by 1 + s instead of the rows is a range shorter by s.
        let mut scaled = Globals::zeros();
        scaled[2] = stretch * range_m;
        covariance += scaled * scaled.transpose();
        let is_any = significant.iter().any(Option::is_some);
        let warp = is_any.then_some(PictureWarp {
            radial: radial / (self.focal_px.0 * self.focal_px.1),
            bend: bend * self.focal_px.0 / (self.focal_px.1 * self.focal_px.1),
            shear,
            stretch,
        });
        Some(WarpEffect { warp, covariance, history })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Average of `sizes`, each with a standard deviation of 1.
    fn average(sizes: impl IntoIterator<Item = f64>) -> WarpAverage {
        let mut average = WarpAverage::default();
        for size in sizes {
            average.add(size, 1.0);
        }
        average
    }

    #[test]
    fn a_single_field_counts_from_nine_standard_deviations_on() {
        assert_eq!(average([8.9]).significant_mean(), None);
        assert_eq!(average([9.1]).significant_mean(), Some(9.1));
    }

    #[test]
    fn a_constant_warp_is_found_below_the_noise_of_a_field() {
        let mean = average([1.5; 60]).significant_mean().unwrap();
        assert!((mean - 1.5).abs() < 1e-12, "{mean}");
        assert_eq!(average([0.5; 60]).significant_mean(), None);
    }

    /// Lines that come early or late bend every field by several standard deviations, in both directions.
    #[test]
    fn bends_that_change_from_field_to_field_are_no_warp() {
        let sizes = [6.0, -7.0, 5.0, 8.0, -4.0, -6.0, 7.0, -5.0];
        for fields in 1..200 {
            let sizes = sizes.iter().cycle().take(fields).copied();
            assert_eq!(average(sizes).significant_mean(), None, "{fields} fields");
        }
    }

    #[test]
    fn another_lens_begins_anew() {
        let sizes = Sizes::repeat(20.0);
        let history = WarpHistory::default().with_field((2900.0, 2900.0), &sizes, &WarpMatrix::identity());
        assert_eq!(history.averages[0].significant_mean(), Some(20.0));
        let of_wide = history.with_field((1055.0, 1055.0), &Sizes::zeros(), &WarpMatrix::identity());
        assert_eq!(of_wide.averages[0].significant_mean(), None);
    }
}
