//! Best estimator of the pipeline: the pose that reproduces the image of the known features, by maximum
//! likelihood on the pixels.
//!
//! Expected DN of a pixel = plate + level beyond the rim × its share + feature × blurred coverage at the
//! pose. The known features are the marks (y3 = 0), the cross's front face (y3 = b) and its side faces. Pose,
//! blur and brightness of the side faces are common to the field. The levels belong to patches (a mark, a
//! piece of an arm), so a shadow or a gradient of brightness causes no bias. Pixels and patches that
//! contradict the model are rejected and reported.

#![allow(
    clippy::needless_range_loop,
    reason = "the pixels of a chunk are counted through several arrays at once"
)]

mod blur;
mod chunk;
mod coverage;
mod edge;
mod equations;
mod first_guess;
mod gaussian;
mod groups;
mod line_response;
mod noise_correlation;
mod plate_map;
mod sampled;
mod sampled_marks;
mod samples;
mod scene;
mod shadow;
mod solve;
mod swelling;
mod uncertainty;
mod unknowns;
mod usual_residual;
mod warp;

#[cfg(test)]
mod tests;

use contract::docking::{Field, Mark, MarkUse, NoPose, PictureWarp, Pose, PoseEstimate, TargetModel};
use contract::{Frame, PixelPoint};
use nalgebra::{Matrix6, Vector3};

use self::blur::Blur;
use self::sampled::Tables;
use self::sampled_marks::SampledMarks;
use self::samples::{Feature, Samples};
use self::scene::Scene;
use self::shadow::ShadowFinder;
use self::solve::{Evaluation, Search, normals, residual, solve};
use self::uncertainty::{SharedErrors, VideoKnowledge, uncertainty};
use self::unknowns::{BLUR, GLOBALS, GRID, Globals, LOCALS, POSE};
use self::usual_residual::UsualResidual;
use crate::CameraModel;
use crate::docking::pose::geometry::{PoseProjection, project, to_pose, to_vector};

/// Initial variance of the blur for the first field, px².
const FIRST_BLUR_PX2: f64 = 0.5;

/// Tolerated error of the first guess, px: pixels are collected up to this distance beyond the edges' blur.
const SLACK_PX: f64 = 1.5;

/// Coarse stages: variance added to the blur, px², and number of globals held. If the lateral position is
/// free too early, the plate tilts to compensate a shift.
const COARSE: [(f64, usize); 4] = [(4.0, 2), (1.0, 2), (1.0, 0), (0.0, 0)];

/// Tolerated error and coarse stages for a rough initial pose, whose range error displaces the marks by up to
/// 3 px, and search radius for the arrangement as a share of the focal length.
const NEAR_SLACK_PX: f64 = 3.0;
const NEAR_COARSE: [(f64, usize); 5] = [(9.0, 0), (4.0, 2), (1.0, 2), (1.0, 0), (0.0, 0)];
const NEAR_REACH: f64 = 0.013;

/// Approximate maximum number of pixels collected, for the coarse stages and for the result. More pixels are
/// thinned evenly.
const MAX_COLLECTED_COARSE: f64 = 6_000.0;
const MAX_COLLECTED: f64 = 30_000.0;

/// Approximate number of pixels in the coarse stages, after thinning.
const COARSE_SAMPLES: usize = 1500;
/// Approximate number of pixels, after thinning, in the first fit of blur and brightness of the side faces.
const MIDDLE_SAMPLES: usize = 4000;

/// Largest residual that counts as noise, in σ.
const PIXEL_GATE: f64 = 4.5;

/// Excess of a patch's variance over that of the other patches above which the patch is rejected, in standard
/// deviations of a variance.
const PATCH_GATE: f64 = 5.0;

/// Share of rejected pixels above which a patch is rejected.
const MAX_REJECTED_SHARE: f64 = 0.15;

/// Model error that is tolerated before rejection, relative to the feature's level.
const MODEL_ERROR: f64 = 0.005;

/// Tolerated model error of a cross of a few pixels, which is a single patch: its side faces, its post and
/// its shadow are smaller than a line of a field.
const SMALL_CROSS_ERROR: f64 = 0.015;

/// Smallest level of a visible mark, relative to the median mark.
const FAINTEST_MARK: f64 = 0.15;

/// Difference of a mark's level below the median of the marks at which it counts as darker, in standard
/// deviations of this level or of the scatter of the marks, whichever is larger. A part of such a mark is in
/// shadow, so the centroid of its lit part is off the mark's centre.
const DARKER_MARK: f64 = 4.0;

/// Smallest ratio of the median feature's level to the noise. Below it the target is invisible.
const FAINTEST_LEVEL: f64 = 4.0;

/// Reciprocal of the share of changed pixels up to which the effect of a change is invisible.
const INVISIBLE_SHARE_INVERSE: usize = 2000;

/// Largest number of rounds of rejection.
const ROUNDS: usize = 3;

/// Largest σ of range and of lateral position, relative to the range, and of an angle, rad. Beyond these
/// limits, the features in the field do not determine a pose.
const MAX_SIGMA: (f64, f64, f64) = (0.05, 0.15, 0.15);

/// Result of the fit to a field.
#[derive(Debug, Clone, PartialEq)]
pub struct FitResult {
    /// Pose and covariance. The covariance is the inverse information of the used pixels, with levels, blur
    /// and side faces as free parameters, times the variance of the residuals.
    pub estimate: PoseEstimate,
    /// Part of the covariance due to errors that are common to the fields of several seconds, m², m rad,
    /// rad².
    pub common: Matrix6<f64>,
    /// Usage of every mark, with its centre predicted from the pose.
    pub marks: Vec<Mark>,
    /// Warp of the picture that recent fields show and the camera file does not state.
    pub warp: Option<PictureWarp>,
    /// True if the cross is a single patch: its arms are shorter than 15 px.
    pub is_small_cross: bool,
    /// True if the residuals of a small cross and its marks are larger than in most earlier fields: the fit
    /// is probably not at the best minimum.
    pub is_poor: bool,
    /// Image of the centre of the cross's front face, predicted from the pose.
    pub cross_centre: PixelPoint,
    /// Image of the disk's centre, predicted from the pose: with perspective, not the centre of an ellipse.
    pub circle_centre: PixelPoint,
    /// Standard deviations of the blur by lens and video along columns and rows, without the pixel's box, px.
    pub blur_px: [f64; 2],
    /// Standard deviation of the residuals, DN.
    pub noise_dn: f64,
    /// Median level of the marks and parts of the cross over the plate, DN.
    pub level_dn: f64,
    /// Number of pixels used.
    pub pixels: u32,
}

/// Fit of successive fields of one camera, with reusable buffers. Begins with the blur of the previous field.
#[derive(Debug)]
pub struct ModelFit {
    tables: Tables,
    samples: Samples,
    shadows: ShadowFinder,
    marks: SampledMarks,
    shared: SharedErrors,
    video: VideoKnowledge,
    variances: Vec<f64>,
    blur: Blur,
    residual_of_small: UsualResidual,
}

impl Default for ModelFit {
    fn default() -> Self {
        Self::new()
    }
}

impl ModelFit {
    /// Creates a fit without any field.
    pub fn new() -> Self {
        Self {
            tables: Tables::new(),
            samples: Samples::default(),
            shadows: ShadowFinder::default(),
            marks: SampledMarks::default(),
            shared: SharedErrors::default(),
            video: VideoKnowledge::default(),
            variances: Vec::new(),
            blur: Blur::new(FIRST_BLUR_PX2, FIRST_BLUR_PX2),
            residual_of_small: UsualResidual::default(),
        }
    }

    /// Fits the pose of a field from a first guess with an error of at most 2 px in the image.
    ///
    /// # Errors
    /// [`NoPose::OutOfField`] when most marks are outside the image and the remaining ones do not determine a
    /// pose, [`NoPose::TooFewFeatures`] when too little is visible, [`NoPose::Inconsistent`] when the visible
    /// features are not the target's.
    pub fn fit(
        &mut self,
        field: &Field,
        camera: &CameraModel,
        target: &TargetModel,
        initial: &Pose,
    ) -> Result<FitResult, NoPose> {
        self.fit_from(field, camera, target, initial, SLACK_PX, &COARSE)
    }

    /// Fits the pose of a field from a rough pose: position within about 1 % of the range, angles within
    /// about a degree.
    ///
    /// The target's arrangement of bright and dark is searched for near the rough pose. The shift found is
    /// attributed once to the position and once to the attitude, and the better of the two fits is returned.
    ///
    /// # Errors
    /// Those of [`ModelFit::fit`]; [`NoPose::NoTarget`] when the target is not seen near the rough pose.
    pub fn fit_near(
        &mut self,
        field: &Field,
        camera: &CameraModel,
        target: &TargetModel,
        rough: &Pose,
    ) -> Result<FitResult, NoPose> {
        let is_finite = to_vector(rough).iter().all(|v| v.is_finite());
        if !(is_finite && rough.position_m.z > target.cross.height_m) {
            return Err(NoPose::Inconsistent);
        }
        let reach_px = NEAR_REACH * camera.focal_px().0 + SLACK_PX;
        let by = first_guess::shift(field, camera, target, rough, reach_px).ok_or(NoPose::NoTarget)?;
        let [moved, turned] = first_guess::shifted(camera, rough, by);
        let moved = self.fit_from(field, camera, target, &moved, NEAR_SLACK_PX, &NEAR_COARSE);
        let turned = self.fit_from(field, camera, target, &turned, NEAR_SLACK_PX, &NEAR_COARSE);
        match (moved, turned) {
            (Ok(a), Ok(b)) => Ok(if b.noise_dn < a.noise_dn { b } else { a }),
            (a, b) => a.or(b),
        }
    }

    fn fit_from(
        &mut self,
        field: &Field,
        camera: &CameraModel,
        target: &TargetModel,
        initial: &Pose,
        slack_px: f64,
        coarse: &[(f64, usize)],
    ) -> Result<FitResult, NoPose> {
        let pose = to_vector(initial);
        if !(pose.iter().all(|v| v.is_finite()) && initial.position_m.z > target.cross.height_m) {
            return Err(NoPose::Inconsistent);
        }
        let mut globals = Globals::zeros();
        globals.fixed_rows_mut::<POSE>(0).copy_from(&pose);
        globals[BLUR] = self.blur.x;
        globals[BLUR + 1] = self.blur.y;
        globals.fixed_rows_mut::<{ GLOBALS - GRID }>(GRID).fill(0.5);

        let scene = Scene { camera, target, tables: &self.tables };
        let samples = &mut self.samples;
        let wide = Blur::new(self.blur.x + 0.5, self.blur.y + 0.5);
        collect(samples, field, &scene, &globals, wide, slack_px, MAX_COLLECTED_COARSE)?;
        let stride = samples.pixels.len().div_ceil(COARSE_SAMPLES);
        let mut noise = 4.0;
        for (extra_blur_px2, held) in coarse.iter().copied() {
            let search = Search { extra_blur_px2, free: held..POSE, stride, steps: 6, decrement: 1.0 };
            noise = solve(&scene, samples, &mut globals, &search, noise)
                .ok_or(NoPose::TooFewFeatures)?
                .variance();
        }

        prepare(&mut self.tables, camera, target, &globals)?;
        let scene = Scene { camera, target, tables: &self.tables };
        let blur = Blur::new(globals[BLUR], globals[BLUR + 1]);
        let cross_dn = samples.cross_dn();
        collect(samples, field, &scene, &globals, blur, 0.0, MAX_COLLECTED)?;
        samples.shade(&mut self.shadows, field, &scene, &globals, cross_dn);
        let search = Search { extra_blur_px2: 0.0, free: 0..GLOBALS, stride: 1, steps: 12, decrement: 2e-2 };
        let stride = samples.pixels.len().div_ceil(MIDDLE_SAMPLES);
        if stride > 1 {
            noise = solve(&scene, samples, &mut globals, &Search { stride, ..search.clone() }, noise)
                .ok_or(NoPose::TooFewFeatures)?
                .variance();
        }
        let mut evaluation =
            solve(&scene, samples, &mut globals, &search, noise).ok_or(NoPose::TooFewFeatures)?;
        // In the first field of a video the blur is only determined here, and the correction at the marks'
        // corners needs the pose to a hundredth of a pixel.
        let is_renewed = prepare(&mut self.tables, camera, target, &globals)?;
        let scene = Scene { camera, target, tables: &self.tables };
        let blur = Blur::new(globals[BLUR], globals[BLUR + 1]);
        let is_corrected = self.marks.correct(samples, field, &scene, &to_pose(&globals), blur);
        if is_renewed || is_corrected {
            evaluation = solve(&scene, samples, &mut globals, &search, evaluation.variance())
                .ok_or(NoPose::TooFewFeatures)?;
        }
        for _ in 0..ROUNDS {
            let is_changed = reject(samples, &mut self.variances)?;
            if !is_changed {
                break;
            }
            evaluation = solve(&scene, samples, &mut globals, &search, evaluation.variance())
                .ok_or(NoPose::TooFewFeatures)?;
        }
        let mut fitted =
            judge(samples, field.image(), &mut self.shared, &mut self.video, &scene, &globals, &evaluation)?;
        fitted.is_poor =
            fitted.is_small_cross && self.residual_of_small.add(fitted.noise_dn / fitted.level_dn);
        self.blur = Blur::new(globals[BLUR], globals[BLUR + 1]);
        Ok(fitted)
    }
}

/// Prepares the sampled profiles for the edges at the given globals. Returns true if any profile is new.
fn prepare(
    tables: &mut Tables,
    camera: &CameraModel,
    target: &TargetModel,
    globals: &Globals,
) -> Result<bool, NoPose> {
    let scene = Scene { camera, target, tables };
    let (normals, blur) = normals(&scene, globals).ok_or(NoPose::TooFewFeatures)?;
    Ok(tables.prepare(&normals, &blur))
}

fn collect(
    samples: &mut Samples,
    field: &Field,
    scene: &Scene,
    globals: &Globals,
    blur: Blur,
    slack_px: f64,
    most: f64,
) -> Result<(), NoPose> {
    let view = PoseProjection::new(scene.camera, &to_pose(globals));
    samples
        .collect(field, scene.camera, scene.target, scene.tables, &view, blur, slack_px, most)
        .ok_or(NoPose::Inconsistent)?;
    if samples.patches.is_empty() { Err(too_few(samples)) } else { Ok(()) }
}

/// Rejects pixels, then patches, by the residuals of the last evaluation. Returns true if the change is
/// significant.
fn reject(samples: &mut Samples, variances: &mut Vec<f64>) -> Result<bool, NoPose> {
    let freedom = |used: usize| (used as f64 - LOCALS as f64 - 1.0).max(1.0);
    variances.clear();
    variances.extend(samples.patches.iter().map(|patch| patch.squares / freedom(patch.used_samples)));
    let typical = median(variances).ok_or(NoPose::TooFewFeatures)?;
    let Samples { pixels, patches, .. } = samples;
    let mark_levels: &mut Vec<f64> = variances;
    mark_levels.clear();
    mark_levels.extend(patches.iter().filter(|p| p.feature != Feature::Cross).map(|p| p.levels[LOCALS - 1]));
    let usual_mark = median(mark_levels).unwrap_or(0.0);
    mark_levels.iter_mut().for_each(|level| *level = (*level - usual_mark).abs());
    // The median absolute deviation of a normal distribution is 0.6745 σ.
    let scatter_of_marks = median(mark_levels).unwrap_or(0.0) / 0.6745;

    let crosses = patches.iter().filter(|patch| patch.feature == Feature::Cross).count();
    let (mut is_changed, mut changed) = (false, 0);
    for patch in patches.iter_mut() {
        let level = patch.levels[LOCALS - 1];
        let model_error =
            if patch.feature == Feature::Cross && crosses == 1 { SMALL_CROSS_ERROR } else { MODEL_ERROR };
        let tolerated = typical + model_error * model_error * level * level;
        let gate = PIXEL_GATE * PIXEL_GATE * tolerated;
        let (mut squares, mut used) = (0.0, 0);
        let all = patch.end - patch.first;
        for pixel in &mut pixels[patch.first..patch.end] {
            let residual = residual(patch, pixel);
            let square = residual * residual;
            let is_used = square <= gate;
            changed += usize::from(is_used != pixel.is_used);
            pixel.is_used = is_used;
            if is_used {
                squares += square;
                used += 1;
            }
        }
        let variance = squares / freedom(used);
        let is_like_the_others = variance <= tolerated * (1.0 + PATCH_GATE * (2.0 / all as f64).sqrt())
            && used as f64 >= (1.0 - MAX_REJECTED_SHARE) * all as f64;
        let is_seen = match patch.feature {
            Feature::Mark(_) => {
                let sigma = (typical * patch.levels_inverse[(LOCALS - 1, LOCALS - 1)]).sqrt();
                let is_darker = level < usual_mark - DARKER_MARK * sigma.max(scatter_of_marks);
                level > FAINTEST_MARK * usual_mark && level > 0.0 && !is_darker
            }
            Feature::Cross => level > 0.0,
        };
        // Rejected pixels make the remaining ones appear consistent, so a rejected patch returns only when
        // all its pixels are used.
        let is_used = is_like_the_others && is_seen && !patch.is_shaded && (patch.is_used || used == all);
        is_changed |= is_used != patch.is_used;
        patch.is_used = is_used;
    }
    Ok(is_changed || changed > pixels.len() / INVISIBLE_SHARE_INVERSE)
}

/// Returns the result, if the used patches determine a pose and enough of the patches agree with the target.
fn judge(
    samples: &Samples,
    image: &Frame,
    shared: &mut SharedErrors,
    video: &mut VideoKnowledge,
    scene: &Scene,
    globals: &Globals,
    evaluation: &Evaluation,
) -> Result<FitResult, NoPose> {
    let used = samples.patches.iter().filter(|patch| patch.is_used);
    let used_pixels: usize = used.clone().map(|patch| patch.used_samples).sum();
    if 2 * used.count() < samples.patches.len() {
        return Err(NoPose::Inconsistent);
    }
    let variance = evaluation.variance();
    let mut levels: Vec<f64> =
        samples.patches.iter().filter(|patch| patch.is_used).map(|p| p.levels[LOCALS - 1]).collect();
    let level_dn = median(&mut levels).ok_or_else(|| too_few(samples))?;
    if level_dn < FAINTEST_LEVEL * variance.sqrt() {
        return Err(too_few(samples));
    }
    let known = uncertainty(scene, samples, image, shared, video, globals, evaluation)
        .ok_or_else(|| too_few(samples))?;
    let covariance: Matrix6<f64> = known.covariance.fixed_view::<POSE, POSE>(0, 0).into();
    let common: Matrix6<f64> = known.common.fixed_view::<POSE, POSE>(0, 0).into();
    let pose = to_pose(&(globals + known.change));
    let range = pose.position_m.norm();
    let sigma = covariance.diagonal().map(f64::sqrt);
    let is_determined = sigma[2] <= MAX_SIGMA.0 * range
        && sigma[0].max(sigma[1]) <= MAX_SIGMA.1 * range
        && sigma[3].max(sigma[4]).max(sigma[5]) <= MAX_SIGMA.2;
    if !is_determined {
        return Err(too_few(samples));
    }
    *video = known.video.decayed();
    let see = |point: Vector3<f64>| project(scene.camera, &pose, &point).ok_or(NoPose::Inconsistent);
    Ok(FitResult {
        estimate: PoseEstimate { pose, covariance },
        common,
        warp: known.warp,
        marks: marks(samples, scene, &pose),
        is_small_cross: samples.is_small_cross(),
        is_poor: false,
        cross_centre: see(Vector3::new(0.0, 0.0, scene.target.cross.height_m))?,
        circle_centre: see(Vector3::zeros())?,
        blur_px: [globals[BLUR].sqrt(), globals[BLUR + 1].sqrt()],
        noise_dn: variance.sqrt(),
        level_dn,
        pixels: used_pixels as u32,
    })
}

fn marks(samples: &Samples, scene: &Scene, pose: &Pose) -> Vec<Mark> {
    // A mark without any remaining pixel, in shadow or beside it, has no patch.
    let is_used = |index: usize| {
        samples.patches.iter().any(|patch| patch.feature == Feature::Mark(index) && patch.is_used)
    };
    scene
        .target
        .marks
        .iter()
        .zip(&samples.marks)
        .enumerate()
        .filter_map(|(index, (corners, usage))| {
            let middle = |i: usize| 0.25 * corners.iter().map(|corner| corner[i]).sum::<f64>();
            Some(Mark {
                index: index as u32,
                position: project(scene.camera, pose, &Vector3::new(middle(0), middle(1), 0.0))?,
                usage: if *usage == MarkUse::Used && !is_used(index) { MarkUse::Rejected } else { *usage },
            })
        })
        .collect()
}

fn too_few(samples: &Samples) -> NoPose {
    let outside = samples.marks.iter().filter(|usage| **usage == MarkUse::OutOfField).count();
    if 2 * outside > samples.marks.len() { NoPose::OutOfField } else { NoPose::TooFewFeatures }
}

/// Returns the median (the lower of two middle values). Sorts in place.
fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied()
}
