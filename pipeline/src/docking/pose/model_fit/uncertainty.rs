//! Uncertainty of the pose: noise of pixels, errors that pixels share, and the response of the video.

use std::ops::AddAssign;

use contract::Frame;
use contract::docking::PictureWarp;
use nalgebra::{Matrix6, SMatrix, SVector, Vector2, Vector3};
use pulp::Arch;

use super::chunk::CHUNK;
use super::equations::{ChunkBuffers, CoverageKernel, FeatureModel, regressors};
use super::groups::{GroupedPixel, Groups, turns};
use super::line_response::{LineResponse, LineResponseSums};
use super::noise_correlation::{CorrelatedSums, NoiseCorrelation, PatchGrid};
use super::sampled::Tables;
use super::samples::{Feature, Patch, Sample, Samples};
use super::scene::Scene;
use super::solve::{Evaluation, Images, residual};
use super::swelling::{self, Swelling};
use super::unknowns::{GLOBALS, GRID, GlobalMatrix, Globals, LOCALS, POSE};
use super::warp::{WarpHistory, WarpSums};
use crate::docking::portions::inverse;
use crate::docking::pose::geometry::{PoseProjection, to_pose};

/// Uncertainty of the globals at a solution, and corrections to them.
pub(super) struct Uncertainty {
    /// Change of the globals by the swelling of the features and by the response of the lines.
    pub(super) change: Globals,
    pub(super) covariance: GlobalMatrix,
    /// Part of the covariance that is due to scene and video, and therefore common to the fields of several
    /// seconds.
    pub(super) common: GlobalMatrix,
    /// Significant warp of the picture in recent fields.
    pub(super) warp: Option<PictureWarp>,
    /// Knowledge of the video after this field.
    pub(super) video: VideoKnowledge,
}

/// Knowledge of the video from previous fields.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct VideoKnowledge {
    pub(super) swelling: Swelling,
    pub(super) response: LineResponse,
    pub(super) warps: WarpHistory,
}

impl VideoKnowledge {
    /// Returns the knowledge that remains for the next field.
    pub(super) fn decayed(&self) -> Self {
        Self { swelling: self.swelling.decayed(), response: self.response.decayed(), warps: self.warps }
    }
}

/// Sums over the pixels of a field for the errors that they share, with reusable buffers.
#[derive(Debug, Default)]
pub(super) struct SharedErrors {
    lines: Groups,
    patches: Groups,
    swellings: Groups,
    responses: LineResponseSums,
    grid: PatchGrid,
}

/// Position error of a cross of a few pixels, which is a single patch, px, one standard deviation. Lines of a
/// field are 2 px apart, and there is no other patch whose scatter shows the video's effect on the cross.
/// Assumed: 0.04 px, of which 0.02 px are ringing of the default video, which the response of the line
/// states.
const SMALL_CROSS_PX: f64 = 0.035;

/// Position error of a mark narrower than a pixel, px, one standard deviation. For wider marks it decreases
/// with the fourth power of the width.
const SMALL_MARK_PX: f64 = 0.02;

/// Lateral displacement of the cross relative to the swelling: its edges against a lit side face swell
/// differently from those against the plate.
const CROSS_SHIFT_PER_SWELLING: f64 = 0.5;

/// Smallest share of a pixel's variance that is independent noise. Variance explained by both lines and
/// patches is subtracted twice.
const MIN_NOISE_SHARE: f64 = 0.25;

/// Computes the uncertainty of the globals at a solution, due to noise that is independent from pixel to
/// pixel and to errors common to lines and patches. `image` is the image of the field.
///
/// The error of the estimate is H⁻¹ Jᵀ n, H being the information. With noise of σ² its covariance is σ² H⁻¹.
/// With additional line errors s_l e_l of variance τ² it is H⁻¹ (σ² H + τ² Σ_l (Jᵀ e_l)(Jᵀ e_l)ᵀ) H⁻¹. The
/// swelling of all features and the response of the lines are additional unknowns with information from
/// previous fields. Noise that is correlated across lines raises the covariance
/// ([`super::noise_correlation`]). Returns `None` when nothing is determined.
pub(super) fn uncertainty(
    scene: &Scene,
    samples: &Samples,
    image: &Frame,
    shared: &mut SharedErrors,
    known: &VideoKnowledge,
    globals: &Globals,
    evaluation: &Evaluation,
) -> Option<Uncertainty> {
    let inverse = inverse(&evaluation.information)?;
    let variance = evaluation.variance();
    let pose = to_pose(globals);
    let scale = scene.camera.focal_px().0 / pose.position_m.z;

    // The sums over all pixels, for each of the errors that pixels share.
    let models = FeatureModels::new(scene, globals, scale)?;
    let centre = PoseProjection::new(scene.camera, &pose).project_with_derivatives(&Vector3::zeros())?;
    let turns = turns(&centre.by_pose)?;
    let correlation = NoiseCorrelation::measure(samples, &mut shared.grid);
    let pixels = PixelContext {
        image,
        noise_dn: variance.sqrt(),
        turns,
        to_pose_change: inverse.fixed_rows::<POSE>(0).into(),
        is_small_cross: samples.is_small_cross(),
    };
    let mut sums = PixelSums::new(shared, scene, correlation);
    let mut work = ChunkBuffers::NEW;
    for (index, patch) in used_patches(samples) {
        sums.add_patch(index, patch, samples, &models, &pixels, &mut work)?;
    }
    let PixelSums { lines, patches, swellings, responses, warps, correlated, .. } = sums;

    // The video: response of the lines, swelling of the features, warp of the picture.
    let correlated_lines = correlation.map_or(1.0, |correlation| correlation.correlated_lines());
    let by_response = responses.estimate(&inverse, variance, correlated_lines, &known.response)?;
    let (change, by_swelling, swelling) = swellings.estimate_swelling(&inverse, variance, &known.swelling)?;
    let rows = scene.camera.size_px().1;
    let [along, _] = turns;
    let by_warp = warps.effect(&inverse, variance, &along, rows, pose.position_m.z, &known.warps);
    let warp_covariance = by_warp.as_ref().map_or_else(GlobalMatrix::zeros, |effect| effect.covariance);

    // Scatter of lines and patches, and errors of features that show no scatter.
    let (by_lines, explained_by_lines) = lines.scatter(variance);
    let (mut by_patches, explained_by_patches) = patches.scatter(variance);
    for (index, patch) in used_patches(samples) {
        if let Some(off_px) = small_feature_px(patch.feature, scene, scale, pixels.is_small_cross) {
            by_patches += patches.group_covariance(index) * (off_px * off_px);
        }
    }
    let crosses =
        used_patches(samples).filter(|(_, patch)| patch.feature == Feature::Cross).map(|(index, _)| index);
    let aside_px = CROSS_SHIFT_PER_SWELLING * swelling.weighted / swelling.weight;
    by_patches += patches.common_covariance(crosses) * (aside_px * aside_px);

    // H⁻¹ (σ² H + Σ τ² …) H⁻¹, where σ² is the variance that no shared error explains.
    let noise = (variance - explained_by_lines - explained_by_patches).max(MIN_NOISE_SHARE * variance);
    let common = inverse * by_patches * inverse + by_swelling + by_response.covariance + warp_covariance;
    let mut covariance = inverse * noise + inverse * by_lines * inverse + common;
    if let Some(correlated) = correlated {
        let increase = correlated.increase(&pose_block(&covariance), &pose_block(&inverse))?;
        covariance.fixed_view_mut::<POSE, POSE>(0, 0).add_assign(increase);
    }
    Some(Uncertainty {
        change: change + by_response.change,
        covariance,
        common,
        warp: by_warp.as_ref().and_then(|effect| effect.warp),
        video: VideoKnowledge {
            swelling,
            response: by_response.response,
            warps: by_warp.map_or(known.warps, |effect| effect.history),
        },
    })
}

/// Returns the patches that are used, each with its index among them.
fn used_patches(samples: &Samples) -> impl Iterator<Item = (usize, &Patch)> + Clone {
    samples.patches.iter().filter(|patch| patch.is_used).enumerate()
}

/// Returns the part of a matrix of the globals that belongs to the pose.
fn pose_block(matrix: &GlobalMatrix) -> Matrix6<f64> {
    matrix.fixed_view::<POSE, POSE>(0, 0).into()
}

/// Returns the position error of a feature that is too small to show it by scatter, px, one standard
/// deviation; `None` for a large cross, whose patches show it. `scale` is the size of a metre in the image,
/// px.
fn small_feature_px(feature: Feature, scene: &Scene, scale: f64, is_small_cross: bool) -> Option<f64> {
    match feature {
        Feature::Mark(mark) => {
            let width_px = (scale * width_m(&scene.target.marks[mark])).max(1.0);
            Some(SMALL_MARK_PX / (width_px * width_px * width_px * width_px))
        }
        Feature::Cross => is_small_cross.then_some(SMALL_CROSS_PX),
    }
}

/// Models of the features at a solution: of their size, and swollen by [`swelling::STEP_PX`].
struct FeatureModels<'a> {
    images: Images,
    swollen: Images,
    tables: &'a Tables,
    grid_share: f64,
}

impl<'a> FeatureModels<'a> {
    /// Creates the models; `scale` is the size of a metre in the image, px.
    fn new(scene: &Scene<'a>, globals: &Globals, scale: f64) -> Option<Self> {
        let enlarged = swelling::enlarged_target(scene.target, scale);
        Some(Self {
            images: Images::new(scene, globals, 0.0)?,
            swollen: Images::new(&Scene { target: &enlarged, ..*scene }, globals, 0.0)?,
            tables: scene.tables,
            grid_share: globals[GRID],
        })
    }

    /// Returns the model of a feature in one of the two sizes.
    fn model<'b>(&'b self, images: &'b Images, feature: Feature) -> Option<FeatureModel<'b>> {
        let image = images.feature_image(feature)?;
        Some(FeatureModel { image, tables: self.tables, share: self.grid_share })
    }
}

/// Sums over the pixels of a field for the errors that they share.
struct PixelSums<'a> {
    lines: &'a mut Groups,
    patches: &'a mut Groups,
    swellings: &'a mut Groups,
    responses: &'a mut LineResponseSums,
    warps: WarpSums,
    /// Sums for correlated noise; `None` if the noise is not correlated.
    correlated: Option<CorrelatedSums<'a>>,
}

/// Quantities that all pixels of a field share.
struct PixelContext<'a> {
    image: &'a Frame,
    /// Noise of a pixel, DN, one standard deviation.
    noise_dn: f64,
    /// Rotations of the camera that shift the image by one pixel along the lines and across them.
    turns: [SVector<f64, POSE>; 2],
    /// Rows of the inverse information that belong to the pose.
    to_pose_change: SMatrix<f64, POSE, GLOBALS>,
    is_small_cross: bool,
}

impl<'a> PixelSums<'a> {
    /// Creates empty sums, with the buffers of `shared`.
    fn new(shared: &'a mut SharedErrors, scene: &Scene, correlation: Option<NoiseCorrelation>) -> Self {
        let SharedErrors { lines, patches, swellings, responses, grid } = shared;
        lines.clear();
        patches.clear();
        swellings.clear();
        responses.clear();
        Self {
            lines,
            patches,
            swellings,
            responses,
            warps: WarpSums::new(scene.camera.focal_px()),
            correlated: correlation.map(|correlation| CorrelatedSums::new(correlation, grid)),
        }
    }

    /// Adds the pixels of a patch, the used one with this index, and closes its sums.
    fn add_patch(
        &mut self,
        index: usize,
        patch: &Patch,
        samples: &Samples,
        models: &FeatureModels<'_>,
        context: &PixelContext<'_>,
        work: &mut ChunkBuffers,
    ) -> Option<()> {
        let feature_model = models.model(&models.images, patch.feature)?;
        let swollen_model = models.model(&models.swollen, patch.feature)?;
        let pixels = &samples.pixels[patch.first..patch.end];
        if let Some(correlated) = &mut self.correlated {
            correlated.begin(pixels);
        }
        for chunk in pixels.chunks(CHUNK) {
            let swollen_kernel = CoverageKernel { feature_model: swollen_model, pixels: chunk, work };
            let swollen = Arch::new().dispatch(swollen_kernel).value;
            let coverage = Arch::new().dispatch(CoverageKernel { feature_model, pixels: chunk, work });
            for (lane, pixel) in chunk.iter().enumerate().filter(|(_, pixel)| pixel.is_used) {
                let slopes = Globals::from_fn(|i, _| coverage.by[i][lane]);
                let more = swollen[lane] - coverage.value[lane];
                let seen = CoveredPixel { coverage: coverage.value[lane], slopes, more };
                self.add_pixel(index, patch, pixel, &seen, context);
            }
        }
        self.close(patch);
        Some(())
    }

    /// Adds a pixel of a patch to all sums.
    #[inline]
    fn add_pixel(
        &mut self,
        index: usize,
        patch: &Patch,
        pixel: &Sample,
        seen: &CoveredPixel,
        context: &PixelContext<'_>,
    ) {
        let level = patch.levels[LOCALS - 1];
        let levels = SVector::from(regressors(patch, pixel, seen.coverage));
        let shift = context.turns.map(|turn| level * seen.slopes.fixed_rows::<POSE>(0).dot(&turn));
        let of_line = GroupedPixel {
            group: pixel.row,
            residual: residual(patch, pixel),
            effects: [shift[0], 1.0],
            slopes: seen.slopes,
            levels,
        };
        self.lines.add(&of_line);
        self.warps.add(pixel.u, pixel.v, shift[0], shift[1], &of_line);
        if let Some(correlated) = &mut self.correlated {
            let score = (seen.slopes - patch.levels_by_globals.tr_mul(&levels)) * level;
            correlated.add(pixel, context.to_pose_change * score);
        }
        // The edges of a small target are all blurred into each other: its pixels show no response.
        if !context.is_small_cross {
            self.responses.add(context.image, pixel, &of_line, context.noise_dn);
        }
        self.patches.add(&GroupedPixel { group: index, effects: shift, ..of_line });
        self.swellings.add(&GroupedPixel {
            group: 0,
            effects: [level * seen.more / swelling::STEP_PX, 0.0],
            ..of_line
        });
    }

    /// Closes the sums of a patch.
    fn close(&mut self, patch: &Patch) {
        self.lines.close(patch);
        self.patches.close(patch);
        self.swellings.close(patch);
        self.responses.close(patch);
        self.warps.close(patch);
        if let Some(correlated) = &mut self.correlated {
            correlated.close();
        }
    }
}

/// Model of a pixel.
struct CoveredPixel {
    /// Share of the pixel that the feature covers.
    coverage: f64,
    /// Derivatives of the share with respect to the globals.
    slopes: Globals,
    /// Increase of the share by a swelling of [`swelling::STEP_PX`].
    more: f64,
}

/// Returns the shorter side of a mark, m.
fn width_m(corners: &[[f64; 2]; 4]) -> f64 {
    let side = |k: usize| (Vector2::from(corners[k]) - Vector2::from(corners[(k + 1) % 4])).norm();
    (0..4).map(side).fold(f64::INFINITY, f64::min)
}
