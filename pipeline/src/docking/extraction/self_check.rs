//! Checks that the recognised features have the structure of the scene.

use contract::docking::{FailedCheck, MarkUse, NoPose, PoseEstimate, TargetModel};

use nalgebra::Vector3;

use super::contour::{self, StationOutline};
use super::docking_unit::{self, DiskEdge, Side};
use crate::docking::cross_and_circle::cross::CrossFit;
use crate::docking::cross_and_circle::marks::{MarksFit, Plane};
use crate::docking::pose::model_fit::FitResult;
use crate::docking::preprocessing::region::Prediction;
use crate::docking::preprocessing::view::{Lens, View};

/// Smallest number of good marks that distinguishes a target from another object in a field without prior
/// knowledge.
pub(crate) const MIN_MARKS_TO_FIND: usize = 5;

/// Smallest number of good marks that determines the disk's position and size.
pub(crate) const MIN_MARKS_TO_MEASURE: usize = 3;

/// Largest distance between cross and disk's centre, as a share of the radius of the marks' circle. More than
/// some 20° from the target's axis, the marks are hidden or too foreshortened to be recognised.
const MAX_PARALLAX: f64 = 0.5;

/// Checks cross and marks against each other.
///
/// # Errors
/// [`NoPose::Inconsistent`] when sizes, positions or angles contradict the target's model,
/// [`NoPose::TooFewFeatures`] and [`NoPose::OutOfField`] when too few marks are left.
pub(crate) fn cross_and_marks(
    model: &TargetModel,
    focal_px: f64,
    cross: &CrossFit,
    marks: &MarksFit,
) -> Result<(), NoPose> {
    if marks.count(MarkUse::Used) < MIN_MARKS_TO_MEASURE {
        return Err(if 2 * marks.count(MarkUse::OutOfField) > marks.marks.len() {
            NoPose::OutOfField
        } else {
            NoPose::TooFewFeatures
        });
    }
    let plane = &marks.plane;
    let d3 = focal_px / plane.scale_px_m;
    let depth = d3 - model.cross.height_m;
    let radius_px = model.mark_circle_radius_m * plane.scale_px_m;
    // The cross is inside the circle of the marks.
    let inside = (cross.seed.centre - plane.centre).norm() < MAX_PARALLAX * radius_px * d3 / depth;
    // The sizes of bars and circle are those of one target at one distance.
    let expected_px = focal_px * model.cross.half_length_m / depth;
    let error_px = (cross.seed.half_length_px - expected_px).abs();
    let sizes = depth > 0.0 && error_px < 0.08 * expected_px + 1.2;
    // The marks are at the angles that the direction of the bars predicts.
    let turn = (libm::atan(cross.seed.slope) - plane.roll_rad).abs();
    let angles = turn < 0.03 + 1.5 / radius_px;
    if inside && sizes && angles { Ok(()) } else { Err(NoPose::Inconsistent) }
}

/// Searches for the docking unit's disk on the given side of the target.
pub(crate) fn docking_unit(
    view: &View<'_>,
    lens: &Lens,
    model: &TargetModel,
    cross: &CrossFit,
    plane: &Plane,
    side: Side,
) -> DiskEdge {
    let predicted =
        docking_unit::predict(model, &model.docking_unit, lens.focal_px(), plane, cross.seed.centre, side);
    docking_unit::find(view, lens, predicted, (0.12 * cross.levels.contrast()).max(8.0))
}

/// Largest standard deviation of the range relative to the range: 3 σ are 5 %.
const MAX_RANGE_SIGMA: f64 = 1.0 / 60.0;

/// Checks that a small target is surrounded by the station. In a few pixels, a cross with marks can be found
/// in anything made of strokes: letters of an overlay, tiles of a thermal blanket.
///
/// # Errors
/// [`NoPose::NoTarget`] when the station's outline is not there, or mostly outside the image.
pub(crate) fn on_station(
    view: &View<'_>,
    lens: &Lens,
    model: &TargetModel,
    cross: &CrossFit,
    plane: &Plane,
) -> Result<(), NoPose> {
    if model.mark_circle_radius_m * plane.scale_px_m > SMALL_CIRCLE_PX {
        return Ok(());
    }
    let centre = cross.seed.centre;
    let predicted =
        docking_unit::predict(model, &model.station, lens.focal_px(), plane, centre, Side::Nominal);
    match contour::confirms(view, lens, predicted, MIN_OUTLINE_STEP) {
        Some(true) => Ok(()),
        _ => Err(NoPose::NoTarget),
    }
}

/// Measures the station's outline around a small target. Returns `None` unless most of the outline is in the
/// image.
pub(crate) fn outline(
    view: &View<'_>,
    lens: &Lens,
    model: &TargetModel,
    cross: &CrossFit,
    plane: &Plane,
) -> Option<StationOutline> {
    if model.mark_circle_radius_m * plane.scale_px_m > SMALL_CIRCLE_PX {
        return None;
    }
    let centre = cross.seed.centre;
    let predicted =
        docking_unit::predict(model, &model.station, lens.focal_px(), plane, centre, Side::Nominal);
    contour::measure_at(view, lens, predicted, MIN_OUTLINE_STEP)
}

/// Checks that the range of a small target is determined and agrees with the range by the station's outline.
/// A pose from few pixels may be that of noise around a cross.
///
/// # Errors
/// [`NoPose::TooFewFeatures`] when the range's standard deviation is larger than a sixtieth of the range,
/// [`NoPose::Inconsistent`] when the two ranges differ by more than three times the standard deviation of
/// their difference.
pub(crate) fn range(
    lens: &Lens,
    model: &TargetModel,
    plane: &Plane,
    outline: Option<&StationOutline>,
    best: &PoseEstimate,
) -> Result<(), NoPose> {
    if model.mark_circle_radius_m * plane.scale_px_m > SMALL_CIRCLE_PX {
        return Ok(());
    }
    let best_sigma_m = best.covariance[(2, 2)].max(0.0).sqrt();
    if best_sigma_m > MAX_RANGE_SIGMA * best.pose.position_m.z {
        return Err(NoPose::TooFewFeatures);
    }
    let measured = outline.and_then(|outline| {
        contour::range(&model.station, lens.focal_px(), outline.circle.radius, outline.sigma_px())
    });
    let Some((range_m, sigma_m)) = measured else { return Ok(()) };
    let agrees = (best.pose.position_m.z - range_m).abs() <= 3.0 * libm::hypot(sigma_m, best_sigma_m);
    if agrees { Ok(()) } else { Err(NoPose::Inconsistent) }
}

/// Limits beyond which two results are of different scenes: relative difference of range, and difference of
/// the cross's parallax over the disk, px.
const OTHER_RANGE: f64 = 0.08;
const OTHER_PARALLAX_PX: f64 = 2.5;

/// Blur near the upper limit of the best estimator, px.
const MAX_BLUR_PX: f64 = 4.9;

/// Returns a doubt if the best estimator's pose needs a blur beyond its limit or leaves unusual residuals, or
/// contradicts the pose from cross and circle only. The range by a circle of a few pixels has a σ of a few
/// per cent, so the limit of the range is at least three σ.
pub(crate) fn fit(
    model: &TargetModel,
    focal_px: f64,
    fitted: &FitResult,
    by_features: &PoseEstimate,
) -> Option<FailedCheck> {
    if fitted.is_poor || fitted.blur_px.iter().any(|blur| *blur >= MAX_BLUR_PX) {
        return Some(FailedCheck::Residuals);
    }
    let (best, other) = (&fitted.estimate.pose.position_m, &by_features.pose.position_m);
    let parallax =
        |d: &Vector3<f64>| focal_px * model.cross.height_m / (d.z * (d.z - model.cross.height_m)) * d.xy();
    let sigma = by_features.covariance[(2, 2)].max(0.0).sqrt() / best.z;
    let range = (other.z / best.z - 1.0).abs() <= OTHER_RANGE.max(3.0 * sigma);
    let cross = (parallax(best) - parallax(other)).norm() <= OTHER_PARALLAX_PX;
    (!(range && cross)).then_some(FailedCheck::Features)
}

/// Largest standard deviation of pitch and yaw, rad: 2.5 σ are 5°. A larger difference means a pose of
/// another object.
const MAX_TILT_SIGMA: f64 = 2.0 / 180.0 * std::f64::consts::PI;

/// Returns a doubt if a pose may be wrong by its own covariance.
pub(crate) fn tilt(best: &PoseEstimate) -> Option<FailedCheck> {
    let variance = best.covariance[(3, 3)].max(best.covariance[(4, 4)]);
    (variance > MAX_TILT_SIGMA * MAX_TILT_SIGMA).then_some(FailedCheck::Residuals)
}

/// Radius of the circle of the marks, px, up to which a target must be surrounded by its station.
const SMALL_CIRCLE_PX: f64 = 18.0;

/// Smallest height of the station's edge, grey values.
const MIN_OUTLINE_STEP: f64 = 8.0;

/// Returns true if too much of the predicted target is outside the image to measure cross and circle: most of
/// the marks, or one end of a bar.
pub(crate) fn leaves_field(
    view: &View<'_>,
    lens: &Lens,
    model: &TargetModel,
    prediction: &Prediction,
) -> bool {
    let is_inside = |ideal| lens.to_camera(ideal).is_some_and(|point| view.contains(point, 1.0));
    let half = prediction.cross.half_length_px;
    let ends = [(half, 0.0), (-half, 0.0), (0.0, half), (0.0, -half)];
    let middle = |corners: &[[f64; 2]; 4]| [0, 1].map(|k| corners.iter().map(|c| c[k]).sum::<f64>() / 4.0);
    let outside = model.marks.iter().filter(|c| !is_inside(prediction.plane.project(middle(c)))).count();
    2 * outside > model.marks.len() || ends.iter().any(|(x, y)| !is_inside(prediction.cross.point_at(*x, *y)))
}
