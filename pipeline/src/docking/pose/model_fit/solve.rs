//! Least squares with separate levels for each patch; the levels are eliminated patch by patch.

use std::ops::Range;

use nalgebra::{SMatrix, SVector};
use pulp::Arch;

use super::blur::Blur;
use super::chunk::{FIRST_GLOBAL, Gram};
use super::coverage::{CrossImage, MarkImage};
use super::equations::{ChunkBuffers, FeatureModel, Image, NormalEquations, regressors};
use super::samples::{Feature, Patch, Sample, Samples};
use super::scene::Scene;
use super::unknowns::{BLUR, ByGlobals, GLOBALS, GRID, GlobalMatrix, Globals, LOCALS, POSE, SIDES};
use crate::docking::portions::inverse;
use crate::docking::pose::geometry::{PoseProjection, to_pose};

/// Priors of blur, and of its share on pixels and the side faces: mean and standard deviation. Weak priors,
/// which are decisive only where the image is not.
const BLUR_PRIOR_PX2: (f64, f64) = (0.5, 1.0);
const SHARE_PRIOR: (f64, f64) = (0.5, 0.5);

/// Ranges of blur, and of its share on pixels and the side faces.
const BLUR_RANGE_PX2: (f64, f64) = (0.02, 25.0);
const SHARE_RANGE: (f64, f64) = (-0.5, 2.0);

/// Largest displacement of an edge in one step, px.
const MAX_STEP_PX: f64 = 1.5;

/// Smallest number of pixels of a patch that remain after thinning.
const MIN_PATCH_PIXELS: usize = 3 * LOCALS;

/// Predicted reduction, relative to the noise's variance, below which a step that fails to reduce the
/// objective is the last.
const UNSEEN_STEP: f64 = 0.5;

/// Parameters of a solution.
#[derive(Debug, Clone)]
pub(super) struct Search {
    /// Variance added to the blur, px². A blurred model converges from larger errors.
    pub(super) extra_blur_px2: f64,
    /// Range of the free globals.
    pub(super) free: Range<usize>,
    /// Thinning: every `stride`-th pixel is used.
    pub(super) stride: usize,
    pub(super) steps: usize,
    /// Predicted reduction by a step, relative to the noise's variance, below which the solution has
    /// converged.
    pub(super) decrement: f64,
}

/// Equations at given globals.
#[derive(Debug, Clone)]
pub(super) struct Evaluation {
    pub(super) information: GlobalMatrix,
    gradient: Globals,
    objective: f64,
    /// Sum of squares, and its degrees of freedom.
    squares: f64,
    freedom: f64,
}

impl Evaluation {
    /// Returns the variance of a pixel, DN².
    pub(super) fn variance(&self) -> f64 {
        (self.squares / self.freedom.max(1.0)).max(1e-9)
    }
}

/// Images of the features at given globals.
pub(super) struct Images {
    marks: Vec<Option<MarkImage>>,
    cross: CrossImage,
}

impl Images {
    pub(super) fn new(scene: &Scene, globals: &Globals, extra_blur_px2: f64) -> Option<Self> {
        let pose = to_pose(globals);
        let view = PoseProjection::new(scene.camera, &pose);
        let (x, y) = (globals[BLUR] + extra_blur_px2, globals[BLUR + 1] + extra_blur_px2);
        let blur = Blur::on_grid(x, y, globals[GRID]);
        let sides = [0, 1, 2, 3].map(|k| globals[SIDES + k]);
        Some(Self {
            marks: scene
                .target
                .marks
                .iter()
                .map(|corners| MarkImage::new(corners, &view, blur, scene.tables))
                .collect(),
            cross: CrossImage::new(scene.target, &view, &pose.position_m, blur, sides, scene.tables)?,
        })
    }

    pub(super) fn feature_image(&self, feature: Feature) -> Option<Image<'_>> {
        match feature {
            Feature::Mark(index) => self.marks[index].as_ref().map(Image::Mark),
            Feature::Cross => Some(Image::Cross(&self.cross)),
        }
    }

    fn shift(&self, by: &ByGlobals) -> f64 {
        self.marks.iter().flatten().map(|mark| mark.shift(by)).fold(self.cross.shift(by), f64::max)
    }
}

/// Returns the normals of all edges at given globals, and their blur. Returns `None` when the features are
/// not in front of the camera.
pub(super) fn normals(scene: &Scene, globals: &Globals) -> Option<(Vec<(f64, f64)>, Blur)> {
    let images = Images::new(scene, globals, 0.0)?;
    let marks = images.marks.iter().flatten().flat_map(MarkImage::normals);
    let blur = Blur::on_grid(globals[BLUR], globals[BLUR + 1], globals[GRID]);
    Some((marks.chain(images.cross.normals()).collect(), blur))
}

/// Minimises the sum of squares from `globals` on by the Levenberg–Marquardt method. `noise` is the variance
/// of a pixel, which weights the priors. Returns `None` when the features are no longer in front of the
/// camera or nothing is determined.
pub(super) fn solve(
    scene: &Scene,
    samples: &mut Samples,
    globals: &mut Globals,
    search: &Search,
    noise: f64,
) -> Option<Evaluation> {
    let mut images = Images::new(scene, globals, search.extra_blur_px2)?;
    let mut now = evaluate(scene, samples, &images, globals, search, noise)?;
    let (mut damping, mut is_last_better) = (0.0, true);
    for _ in 0..search.steps {
        let (mut damped, mut gradient) = (now.information, now.gradient);
        for i in 0..GLOBALS {
            damped[(i, i)] *= 1.0 + damping;
            if is_at_bound(i, globals[i], gradient[i]) {
                fix_parameter(i, &mut damped, &mut gradient);
            }
        }
        let mut step = inverse(&damped)? * gradient;
        let promised = step.dot(&gradient);
        if promised <= search.decrement * now.variance() {
            // The last step is applied without evaluation: its effect on the residuals is negligible.
            *globals = bounded(&(*globals + step));
            break;
        }
        let shift = images.shift(&step.into());
        if !shift.is_finite() {
            return None;
        }
        if shift > MAX_STEP_PX {
            step *= MAX_STEP_PX / shift;
        }
        let trial = bounded(&(*globals + step));
        let trial_images = Images::new(scene, &trial, search.extra_blur_px2)?;
        let next = evaluate(scene, samples, &trial_images, &trial, search, noise)?;
        let is_better = next.objective <= now.objective * (1.0 + 1e-9);
        is_last_better = is_better;
        if is_better {
            *globals = trial;
            images = trial_images;
            now = next;
            damping *= 0.1;
        } else if promised <= UNSEEN_STEP * now.variance() || damping > 1e6 {
            // The derivatives are those of an approximate model, and predict a reduction that does not exist.
            break;
        } else {
            damping = (damping * 10.0f64).max(1e-3);
        }
    }
    if !is_last_better {
        // The samples contain the coverages of a rejected trial.
        evaluate(scene, samples, &images, globals, search, noise)?;
    }
    Some(now)
}

/// Returns true if a global is at the end of its range and would leave it.
fn is_at_bound(i: usize, value: f64, gradient: f64) -> bool {
    let (low, high) = match i {
        0..BLUR => return false,
        BLUR..GRID => BLUR_RANGE_PX2,
        _ => SHARE_RANGE,
    };
    (value <= low && gradient < 0.0) || (value >= high && gradient > 0.0)
}

/// Removes a global from the equations: no step, and no coupling.
fn fix_parameter(i: usize, information: &mut GlobalMatrix, gradient: &mut Globals) {
    information.row_mut(i).fill(0.0);
    information.column_mut(i).fill(0.0);
    information[(i, i)] = 1.0;
    gradient[i] = 0.0;
}

fn bounded(globals: &Globals) -> Globals {
    let mut bounded = *globals;
    for i in BLUR..GRID {
        bounded[i] = bounded[i].clamp(BLUR_RANGE_PX2.0, BLUR_RANGE_PX2.1);
    }
    for i in GRID..GLOBALS {
        bounded[i] = bounded[i].clamp(SHARE_RANGE.0, SHARE_RANGE.1);
    }
    bounded
}

/// Returns the equations of all used patches. Updates levels and squares of all patches.
fn evaluate(
    scene: &Scene,
    samples: &mut Samples,
    images: &Images,
    globals: &Globals,
    search: &Search,
    noise: f64,
) -> Option<Evaluation> {
    let mut sum = Evaluation {
        information: GlobalMatrix::zeros(),
        gradient: Globals::zeros(),
        objective: 0.0,
        squares: 0.0,
        freedom: -(POSE as f64),
    };
    let Samples { pixels, patches, .. } = samples;
    let mut work = ChunkBuffers::NEW;
    for patch in patches.iter_mut() {
        let origin = pixels[patch.first].dn;
        let feature_model = FeatureModel {
            image: images.feature_image(patch.feature)?,
            tables: scene.tables,
            share: globals[GRID],
        };
        // A small patch keeps enough pixels to determine its levels.
        let stride = search.stride.min((patch.end - patch.first) / MIN_PATCH_PIXELS).max(1);
        let pixels = &mut pixels[patch.first..patch.end];
        let (centre, level) = (patch.centre, patch.levels[LOCALS - 1]);
        let equations =
            NormalEquations { feature_model, centre, level, pixels, origin, stride, work: &mut work };
        let (gram, used) = Arch::new().dispatch(equations);
        patch.used_samples = used;
        add_patch(patch, gram, origin, &mut sum);
    }
    for i in 0..GLOBALS {
        if !search.free.contains(&i) {
            fix_parameter(i, &mut sum.information, &mut sum.gradient);
        } else if i >= BLUR {
            let (mean, sigma) = if i < GRID { BLUR_PRIOR_PX2 } else { SHARE_PRIOR };
            let weight = noise / (sigma * sigma);
            let off = mean - globals[i];
            sum.information[(i, i)] += weight;
            sum.gradient[i] += weight * off;
            sum.objective += weight * off * off;
        }
    }
    Some(sum)
}

/// Returns the difference between a pixel and its expected value by the patch's levels and the pixel's last
/// coverage, DN.
pub(super) fn residual(patch: &Patch, pixel: &Sample) -> f64 {
    let regressors = regressors(patch, pixel, pixel.coverage);
    let model: f64 = regressors.iter().zip(&patch.levels).map(|(x, level)| x * level).sum();
    pixel.dn + pixel.shadow_dn * (1.0 - pixel.coverage) - model
}

/// Solves for a patch's levels and adds its reduced equations (their Schur complement) to the sum.
///
/// With L the regressors of the levels ℓ, A = Lᵀ L and D the derivatives of the coverage, the feature's level
/// a being one of ℓ: information a² (DᵀD − DᵀL A⁻¹ LᵀD), gradient a Dᵀ(y − L ℓ).
fn add_patch(patch: &mut Patch, gram: &Gram, origin: f64, sum: &mut Evaluation) {
    let mut normal =
        SMatrix::<f64, LOCALS, LOCALS>::from_fn(|i, j| gram.column_product(1 + i.min(j), 1 + i.max(j)));
    for i in 0..LOCALS {
        // A level without any pixel in the patch becomes zero; other levels change negligibly.
        normal[(i, i)] = if normal[(i, i)] > 1e-9 { normal[(i, i)] * (1.0 + 1e-9) } else { 1.0 };
    }
    let Some(normal) = inverse(&normal) else {
        patch.is_used = false;
        return;
    };
    let right = SVector::<f64, LOCALS>::from_fn(|i, _| gram.column_product(0, 1 + i));
    let levels = normal * right;
    patch.squares = (gram.column_product(0, 0) - right.dot(&levels)).max(0.0);
    patch.levels = levels.into();
    patch.levels[0] += origin;
    if !patch.is_used {
        return;
    }
    sum.objective += patch.squares;
    sum.squares += patch.squares;
    sum.freedom += patch.used_samples as f64 - LOCALS as f64;
    let feature = levels[LOCALS - 1];
    if feature <= 0.0 {
        // Darker than the plate: the feature is not at the patch's position.
        return;
    }
    let mixed = SMatrix::<f64, LOCALS, GLOBALS>::from_fn(|i, j| gram.column_product(1 + i, FIRST_GLOBAL + j));
    patch.levels_inverse = normal;
    patch.levels_by_globals = normal * mixed;
    for i in 0..GLOBALS {
        for j in i..GLOBALS {
            let eliminated = mixed.column(i).dot(&patch.levels_by_globals.column(j));
            let term =
                feature * feature * (gram.column_product(FIRST_GLOBAL + i, FIRST_GLOBAL + j) - eliminated);
            sum.information[(i, j)] += term;
            if i != j {
                sum.information[(j, i)] += term;
            }
        }
    }
    let residual = mixed.transpose() * levels;
    for i in 0..GLOBALS {
        sum.gradient[i] += feature * (gram.column_product(0, FIRST_GLOBAL + i) - residual[i]);
    }
}
