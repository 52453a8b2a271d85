//! First guess from a roughly known pose: the arrangement of features is shifted over the image until bright
//! and dark points of the target match bright and dark pixels.

use contract::PixelPoint;
use contract::docking::{Field, Pose, TargetModel};
use nalgebra::Vector3;

use crate::CameraModel;
use crate::docking::pose::geometry::project;

/// Smallest distance of dark points beside a feature, px: beyond its blur.
const BESIDE_PX: f64 = 1.5;

/// Correlation below which the target counts as not found.
const MIN_CORRELATION: f64 = 0.3;

/// Point of the target in the image at the rough pose: column, camera row, and brightness class.
struct Point {
    at: PixelPoint,
    is_bright: bool,
}

/// Returns the shift of the target in the image against `rough`, px along columns and rows, within
/// `reach_px`. Returns `None` when the target is not seen there.
pub(super) fn shift(
    field: &Field,
    camera: &CameraModel,
    target: &TargetModel,
    rough: &Pose,
    reach_px: f64,
) -> Option<[f64; 2]> {
    let points = points(camera, target, rough);
    let reach = reach_px.ceil() as i32;
    let mut best = (MIN_CORRELATION, None);
    for down in -reach..=reach {
        for across in -reach..=reach {
            let by = [f64::from(across), f64::from(down)];
            let correlation = correlation(field, &points, by);
            if correlation > best.0 {
                best = (correlation, Some(by));
            }
        }
    }
    best.1
}

/// Returns two poses that shift the target in the image by `by`: `rough` with its position moved, and `rough`
/// rotated.
pub(super) fn shifted(camera: &CameraModel, rough: &Pose, by: [f64; 2]) -> [Pose; 2] {
    let (fx, fy) = camera.focal_px();
    // Assumes an upright image: the effect of roll is small enough for a second round of fitting to correct.
    let (right, down) = (by[0] / fx, by[1] / fy);
    let d3 = rough.position_m.z;
    [
        Pose { position_m: rough.position_m + Vector3::new(-right * d3, down * d3, 0.0), ..*rough },
        Pose { phi_rad: rough.phi_rad + Vector3::new(down, -right, 0.0), ..*rough },
    ]
}

fn points(camera: &CameraModel, target: &TargetModel, rough: &Pose) -> Vec<Point> {
    let focal_px = camera.focal_px().0;
    let mut points = Vec::new();
    let mut add = |y1: f64, y2: f64, y3: f64, is_bright: bool| {
        if let Some(at) = project(camera, rough, &Vector3::new(y1, y2, y3)) {
            points.push(Point { at, is_bright });
        }
    };
    // Adds a point on a feature's axis and points on both sides of the feature. `half` is the distance from
    // the axis to the edge along (c, s).
    let mut pair = |centre: [f64; 2], (c, s): (f64, f64), half: f64, y3: f64| {
        let beside = half + half.max(BESIDE_PX * (rough.position_m.z - y3) / focal_px);
        add(centre[0], centre[1], y3, true);
        add(centre[0] + beside * c, centre[1] + beside * s, y3, false);
        add(centre[0] - beside * c, centre[1] - beside * s, y3, false);
    };
    for [a, b, c, d] in &target.marks {
        let centre = [0.25 * (a[0] + b[0] + c[0] + d[0]), 0.25 * (a[1] + b[1] + c[1] + d[1])];
        let half_axis =
            |p: &[f64; 2], q: &[f64; 2]| [0.5 * (p[0] + q[0]) - centre[0], 0.5 * (p[1] + q[1]) - centre[1]];
        let (first, second) = (half_axis(a, b), half_axis(b, c));
        let length = |v: &[f64; 2]| libm::hypot(v[0], v[1]);
        let (short, long) = if length(&first) < length(&second) { (first, second) } else { (second, first) };
        let half = length(&short).max(f64::MIN_POSITIVE);
        for along in [-0.5, 0.0, 0.5] {
            let position = [centre[0] + along * long[0], centre[1] + along * long[1]];
            pair(position, (short[0] / half, short[1] / half), half, 0.0);
        }
    }
    let cross = &target.cross;
    for along in [-0.85, -0.6, -0.35, 0.35, 0.6, 0.85] {
        let along = along * cross.half_length_m;
        pair([along, 0.0], (0.0, 1.0), 0.5 * cross.width_m, cross.height_m);
        pair([0.0, along], (1.0, 0.0), 0.5 * cross.width_m, cross.height_m);
    }
    points
}

/// Returns the correlation coefficient of the pixels with bright and dark. Returns 0 when more than a quarter
/// of the points are outside the image.
fn correlation(field: &Field, points: &[Point], by: [f64; 2]) -> f64 {
    let (image, lines) = (field.image(), field.lines());
    let (step, first_row) = (lines.step() as f64, lines.camera_row(0) as f64);
    let (mut n, mut bright, mut sum, mut squares, mut mixed) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for point in points {
        let column = (point.at.x + by[0]).round();
        let row = ((point.at.y + by[1] - first_row) / step).round();
        let is_inside =
            column >= 0.0 && row >= 0.0 && column < image.columns() as f64 && row < image.rows() as f64;
        if !is_inside {
            continue;
        }
        let dn = f64::from(image.dn_at(column as usize, row as usize));
        n += 1.0;
        sum += dn;
        squares += dn * dn;
        if point.is_bright {
            bright += 1.0;
            mixed += dn;
        }
    }
    if n < 0.75 * points.len() as f64 {
        return 0.0;
    }
    let covariance = mixed - bright * sum / n;
    let variances = (squares - sum * sum / n) * (bright - bright * bright / n);
    if variances > 0.0 { covariance / variances.sqrt() } else { 0.0 }
}
