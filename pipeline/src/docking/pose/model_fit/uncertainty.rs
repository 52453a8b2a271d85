//! Uncertainty of the pose: noise of pixels, errors that pixels share, and the response of the video.

use std::ops::AddAssign;

use contract::Frame;
use contract::docking::PictureWarp;
use nalgebra::{Matrix6, SVector, Vector2, Vector3};
use pulp::Arch;

use super::chunk::CHUNK;
use super::equations::{ChunkBuffers, CoverageKernel, FeatureModel, regressors};
use super::groups::{GroupedPixel, Groups, turns};
use super::line_response::{LineResponse, LineResponseSums};
use super::noise_correlation::{CorrelatedSums, NoiseCorrelation, PatchGrid};
use super::samples::{Feature, Samples};
use super::scene::Scene;
use super::solve::{Evaluation, Images, residual};
use super::swelling::{self, Swelling};
use super::unknowns::{GRID, GlobalMatrix, Globals, LOCALS, POSE};
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
    let noise_dn = variance.sqrt();
    let images = Images::new(scene, globals, 0.0)?;
    let pose = to_pose(globals);
    let swollen = swelling::enlarged_target(scene.target, scene.camera.focal_px().0 / pose.position_m.z);
    let swollen = Images::new(&Scene { target: &swollen, ..*scene }, globals, 0.0)?;
    let centre = PoseProjection::new(scene.camera, &pose).project_with_derivatives(&Vector3::zeros())?;
    let [along, across] = turns(&centre.by_pose)?;
    let SharedErrors { lines, patches: of_patches, swellings, responses, grid } = shared;
    for groups in [&mut *lines, &mut *of_patches, &mut *swellings] {
        groups.clear();
    }
    responses.clear();
    let mut warps = WarpSums::new(scene.camera.focal_px());
    let correlation = NoiseCorrelation::measure(samples, grid);
    let mut correlated = correlation.map(|correlation| CorrelatedSums::new(correlation, grid));
    let to_pose_change = inverse.fixed_rows::<POSE>(0);
    let mut work = ChunkBuffers::NEW;
    let used = || samples.patches.iter().filter(|patch| patch.is_used).enumerate();
    let is_small = samples.is_small_cross();
    for (index, patch) in used() {
        let level = patch.levels[LOCALS - 1];
        let feature_model = FeatureModel {
            image: images.feature_image(patch.feature)?,
            tables: scene.tables,
            share: globals[GRID],
        };
        let wide = FeatureModel { image: swollen.feature_image(patch.feature)?, ..feature_model };
        if let Some(correlated) = &mut correlated {
            correlated.begin(&samples.pixels[patch.first..patch.end]);
        }
        for pixels in samples.pixels[patch.first..patch.end].chunks(CHUNK) {
            let wider =
                Arch::new().dispatch(CoverageKernel { feature_model: wide, pixels, work: &mut work }).value;
            let coverage = Arch::new().dispatch(CoverageKernel { feature_model, pixels, work: &mut work });
            for (l, pixel) in pixels.iter().enumerate().filter(|(_, pixel)| pixel.is_used) {
                let levels = SVector::from(regressors(patch, pixel, coverage.value[l]));
                let slopes = Globals::from_fn(|i, _| coverage.by[i][l]);
                let shift = [along, across].map(|turn| level * slopes.fixed_rows::<POSE>(0).dot(&turn));
                let of_line = GroupedPixel {
                    group: pixel.row,
                    residual: residual(patch, pixel),
                    effects: [shift[0], 1.0],
                    slopes,
                    levels,
                };
                lines.add(&of_line);
                warps.add(pixel.u, pixel.v, shift[0], shift[1], &of_line);
                if let Some(correlated) = &mut correlated {
                    let score = (slopes - patch.levels_by_globals.tr_mul(&levels)) * level;
                    correlated.add(pixel, to_pose_change * score);
                }
                // The edges of a small target are all blurred into each other: its pixels show no response.
                if !is_small {
                    responses.add(image, pixel, &of_line, noise_dn);
                }
                of_patches.add(&GroupedPixel { group: index, effects: shift, ..of_line });
                let swell = level * (wider[l] - coverage.value[l]) / swelling::STEP_PX;
                swellings.add(&GroupedPixel { group: 0, effects: [swell, 0.0], ..of_line });
            }
        }
        lines.close(patch);
        of_patches.close(patch);
        swellings.close(patch);
        responses.close(patch);
        warps.close(patch);
        if let Some(correlated) = &mut correlated {
            correlated.close();
        }
    }
    let correlated_lines = correlation.map_or(1.0, |correlation| correlation.correlated_lines());
    let by_response = responses.estimate(&inverse, variance, correlated_lines, &known.response)?;
    let (by_lines, explained_by_lines) = lines.scatter(variance);
    let (mut by_patches, explained_by_patches) = of_patches.scatter(variance);
    let scale = scene.camera.focal_px().0 / pose.position_m.z;
    for (index, patch) in used() {
        let off_px = match patch.feature {
            Feature::Mark(mark) => {
                let width_px = (scale * width_m(&scene.target.marks[mark])).max(1.0);
                SMALL_MARK_PX / (width_px * width_px * width_px * width_px)
            }
            Feature::Cross if is_small => SMALL_CROSS_PX,
            Feature::Cross => continue,
        };
        by_patches += of_patches.group_covariance(index) * (off_px * off_px);
    }
    let (change, by_swelling, swelling) = swellings.estimate_swelling(&inverse, variance, &known.swelling)?;
    let crosses = used().filter(|(_, patch)| patch.feature == Feature::Cross).map(|(index, _)| index);
    let aside_px = CROSS_SHIFT_PER_SWELLING * swelling.weighted / swelling.weight;
    by_patches += of_patches.common_covariance(crosses) * (aside_px * aside_px);
    let noise = (variance - explained_by_lines - explained_by_patches).max(MIN_NOISE_SHARE * variance);
    let rows = scene.camera.size_px().1;
    let by_warp = warps.effect(&inverse, variance, &along, rows, pose.position_m.z, &known.warps);
    let warp_covariance = by_warp.as_ref().map_or_else(GlobalMatrix::zeros, |effect| effect.covariance);
    let common = inverse * by_patches * inverse + by_swelling + by_response.covariance + warp_covariance;
    let mut covariance = inverse * noise + inverse * by_lines * inverse + common;
    if let Some(correlated) = correlated {
        let pose = |matrix: &GlobalMatrix| Matrix6::from(matrix.fixed_view::<POSE, POSE>(0, 0));
        let increase = correlated.increase(&pose(&covariance), &pose(&inverse))?;
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

/// Returns the shorter side of a mark, m.
fn width_m(corners: &[[f64; 2]; 4]) -> f64 {
    let side = |k: usize| (Vector2::from(corners[k]) - Vector2::from(corners[(k + 1) % 4])).norm();
    (0..4).map(side).fold(f64::INFINITY, f64::min)
}
