//! Features recognised in a field, in the camera's pixels.

use contract::PixelPoint;
use contract::docking::{Circle, Cross, Features, MarkUse, TargetModel};
use nalgebra::Vector2;

use super::docking_unit::{self, DiskEdge, Side};
use super::recognise::TargetFeatures;
use crate::docking::cross_and_circle::marks::Plane;
use crate::docking::pose::model_fit::FitResult;
use crate::docking::preprocessing::region::Rectangle;
use crate::docking::preprocessing::view::{Lens, View};

/// Returns the square around the plate, in which brightness and contrast are judged.
pub(crate) fn plate(lens: &Lens, plane: &Plane, target: &TargetModel) -> Rectangle {
    let half_side = target.plate_radius_m * plane.scale_px_m;
    lens.to_camera(plane.centre).map_or(Rectangle::ALL, |centre| Rectangle::square(centre, half_side))
}

/// Returns the centre and mean radius, in the camera's pixels, of a circle of the ideal image.
pub(crate) fn camera_circle(lens: &Lens, centre: Vector2<f64>, radius: f64) -> Option<(PixelPoint, f64)> {
    const POINTS: usize = 8;
    let rim: Vec<PixelPoint> = (0..POINTS)
        .map(|i| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / POINTS as f64);
            lens.to_camera(centre + radius * Vector2::new(cos, sin))
        })
        .collect::<Option<_>>()?;
    let n = POINTS as f64;
    let middle =
        PixelPoint::new(rim.iter().map(|p| p.x).sum::<f64>() / n, rim.iter().map(|p| p.y).sum::<f64>() / n);
    Some((middle, rim.iter().map(|p| p.distance(middle)).sum::<f64>() / n))
}

/// Returns the recognised features, in the camera's pixels.
pub(crate) fn evidence(lens: &Lens, target_features: &TargetFeatures, unit: &DiskEdge) -> Features {
    let seed = &target_features.cross.seed;
    let half = 0.5 * seed.half_length_px;
    let cross = (|| {
        let (left, right) =
            (lens.to_camera(seed.point_at(-half, 0.0))?, lens.to_camera(seed.point_at(half, 0.0))?);
        Some(Cross {
            centre: lens.to_camera(seed.centre)?,
            raw_centre: lens.to_camera(target_features.cross.raw_centre)?,
            slope: (right.y - left.y) / (right.x - left.x),
            horizontal_pairs: target_features.cross.pairs.0 as u32,
            vertical_pairs: target_features.cross.pairs.1 as u32,
        })
    })();
    let circle = (|| {
        let (centre, radius_px) =
            camera_circle(lens, target_features.circle.centre, target_features.circle.radius_px)?;
        let (raw_centre, _) =
            camera_circle(lens, target_features.circle.raw_centre, target_features.circle.radius_px)?;
        Some(Circle { centre, raw_centre, radius_px, points: target_features.circle.points })
    })();
    Features {
        cross,
        circle,
        station: None,
        docking_unit: disk(lens, unit, 0.4),
        marks: target_features.marks.marks.iter().map(|seen| seen.mark).collect(),
        warp: None,
    }
}

/// Updates the features with the result of the best estimator: centres with perspective, rejected marks, and
/// the warp.
pub(crate) fn refine(features: &mut Features, fitted: &FitResult) {
    features.warp = fitted.warp;
    if let Some(cross) = &mut features.cross {
        cross.centre = fitted.cross_centre;
    }
    if let Some(circle) = &mut features.circle {
        circle.centre = fitted.circle_centre;
    }
    for mark in &mut features.marks {
        let rejected =
            fitted.marks.iter().any(|other| other.index == mark.index && other.usage == MarkUse::Rejected);
        if rejected && mark.usage == MarkUse::Used {
            mark.usage = MarkUse::Rejected;
        }
    }
}

/// Returns the circle of a disk whose edge is seen in at least `share` of its directions.
fn disk(lens: &Lens, edge: &DiskEdge, share: f64) -> Option<Circle> {
    let fit = edge.circle.filter(|_| edge.share >= share)?;
    let (centre, radius_px) = camera_circle(lens, fit.centre, fit.radius)?;
    Some(Circle { centre, raw_centre: centre, radius_px, points: edge.points })
}

/// Finds the station's outline at the position predicted by cross and marks.
pub(crate) fn station(
    view: &View<'_>,
    lens: &Lens,
    target: &TargetModel,
    target_features: &TargetFeatures,
) -> Option<Circle> {
    let (plane, cross) = (&target_features.marks.plane, target_features.cross.seed.centre);
    let predicted =
        docking_unit::predict(target, &target.station, lens.focal_px(), plane, cross, Side::Nominal);
    let edge =
        docking_unit::find(view, lens, predicted, (0.12 * target_features.cross.levels.contrast()).max(8.0));
    disk(lens, &edge, 0.5)
}
