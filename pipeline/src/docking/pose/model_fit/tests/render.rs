//! Images of the target, rendered by a method independent of the model: polygons on 128 scan lines per pixel,
//! exact along a line, on cells of a quarter of a pixel; then discrete Gaussians and a pixel's box over the
//! cells; then noise and rounding.

use contract::docking::{Field, Lines, Pose, StandOffCross, TargetModel};
use contract::{Camera, Frame};
use nalgebra::{Rotation3, Vector3};

use crate::docking::portions::tests::normal;

/// Number of cells per pixel, along either axis.
const CELLS: usize = 4;
/// Number of scan lines per cell. Exactly horizontal edges are off by at most 1/256 px.
const LINES: usize = 32;
/// Margin around the plate that is rendered, pixels.
const MARGIN: i64 = 8;

/// Appearance of the target.
#[derive(Debug, Clone)]
pub(super) struct FeatureModel {
    pub(super) plate_dn: f64,
    pub(super) beyond_dn: f64,
    pub(super) mark_dn: f64,
    pub(super) cross_dn: f64,
    pub(super) side_dn: f64,
    /// Standard deviations of the blur along columns and rows, px.
    pub(super) blur_px: [f64; 2],
    /// Index of a mark of which only the half towards its first edge is lit.
    pub(super) half_shadowed: Option<usize>,
    /// Shadow of the cross on the plate: tangents of the light's direction, and its depth, DN.
    pub(super) shadow: Option<([f64; 2], f64)>,
}

impl Default for FeatureModel {
    fn default() -> Self {
        Self {
            plate_dn: 40.0,
            beyond_dn: 120.0,
            mark_dn: 190.0,
            cross_dn: 180.0,
            side_dn: 90.0,
            blur_px: [0.7, 0.7],
            half_shadowed: None,
            shadow: None,
        }
    }
}

/// Returns a camera with 768 × 576 square pixels.
pub(super) fn camera(focal_px: f64, radial: [f64; 3]) -> Camera {
    Camera {
        columns: 768,
        rows: 576,
        focal_length_mm: focal_px * 0.01,
        pixel_width_um: 10.0,
        pixel_height_um: 10.0,
        principal_x_px: 385.2,
        principal_y_px: 286.1,
        radial,
        tangential: [0.0; 2],
    }
}

/// Returns a target with twelve marks on a ring, and a cross.
pub(super) fn target() -> TargetModel {
    let marks = (0..12)
        .map(|k| {
            let (s, c) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 12.0);
            [(0.23, -0.006), (0.27, -0.006), (0.27, 0.006), (0.23, 0.006)]
                .map(|(x, y)| [c * x - s * y, s * x + c * y])
        })
        .collect();
    let outline = contract::docking::Outline { centre_m: [0.0, -1.25], radius_m: 0.66, depth_m: 0.1 };
    TargetModel {
        name: "test".to_owned(),
        plate_radius_m: 0.30,
        mark_circle_radius_m: 0.25,
        marks,
        cross: StandOffCross {
            height_m: 0.30,
            half_length_m: 0.15,
            width_m: 0.030,
            thickness_m: 0.010,
            post_width_m: 0.020,
        },
        docking_unit: outline,
        station: contract::docking::Outline { radius_m: 2.05, ..outline },
    }
}

/// Returns the expected DN of every pixel of the camera, row by row, without noise.
pub(super) fn expected(
    camera: &Camera,
    target: &TargetModel,
    feature_model: &FeatureModel,
    pose: &Pose,
) -> Vec<f64> {
    let plate: Vec<[f64; 2]> = (0..96)
        .map(|k| {
            let (s, c) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 96.0);
            [target.plate_radius_m * c, target.plate_radius_m * s]
        })
        .collect();
    let plate = image(camera, pose, &plate, 0.0);
    let mut marks = Vec::new();
    for (index, [a, b, c, d]) in target.marks.iter().enumerate() {
        let middle = |p: &[f64; 2], q: &[f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
        let quad = match feature_model.half_shadowed {
            Some(shadowed) if shadowed == index => [middle(a, b), middle(a, b), middle(c, d), middle(c, d)],
            _ => [*a, *b, *c, *d],
        };
        let quad = if feature_model.half_shadowed == Some(index) { [*a, quad[0], quad[2], *d] } else { quad };
        marks.push(image(camera, pose, &quad, 0.0));
    }
    let cross = &target.cross;
    let (h, l) = (0.5 * cross.width_m, cross.half_length_m);
    let outline = [
        [h, h],
        [h, l],
        [-h, l],
        [-h, h],
        [-l, h],
        [-l, -h],
        [-h, -h],
        [-h, -l],
        [h, -l],
        [h, -h],
        [l, -h],
        [l, h],
    ];
    let front = image(camera, pose, &outline, cross.height_m);
    let back = image(camera, pose, &outline, cross.height_m - cross.thickness_m);
    // All side faces, visible or not: hidden ones are covered by the front face.
    let n = front.len() / outline.len();
    let mut solid = vec![front.clone(), back.clone()];
    for k in 0..outline.len() {
        let piece = |ring: &[(f64, f64)]| -> Vec<(f64, f64)> {
            (0..=n).map(|i| ring[(k * n + i) % ring.len()]).collect()
        };
        let mut face = piece(&front);
        face.extend(piece(&back).into_iter().rev());
        solid.push(face);
    }

    let all = plate.iter().chain(&front);
    let low = |get: fn(&(f64, f64)) -> f64| {
        all.clone().map(get).fold(f64::INFINITY, f64::min).floor() as i64 - MARGIN
    };
    let high = |get: fn(&(f64, f64)) -> f64| {
        all.clone().map(get).fold(f64::NEG_INFINITY, f64::max).ceil() as i64 + MARGIN
    };
    let (x0, y0) = (low(|p| p.0).max(-MARGIN), low(|p| p.1).max(-MARGIN));
    let x1 = high(|p| p.0).min(camera.columns as i64 + MARGIN);
    let y1 = high(|p| p.1).min(camera.rows as i64 + MARGIN);
    let (columns, rows) = ((x1 - x0) as usize, (y1 - y0) as usize);
    let width = columns * CELLS;

    // Each group is a union; each group adds its step to the levels below.
    let mut groups = vec![
        (vec![plate], feature_model.plate_dn - feature_model.beyond_dn),
        (marks, feature_model.mark_dn - feature_model.plate_dn),
        (solid.clone(), feature_model.side_dn - feature_model.plate_dn),
        (vec![front], feature_model.cross_dn - feature_model.side_dn),
    ];
    if let Some(([s1, s2], depth_dn)) = feature_model.shadow {
        let cast = |height: f64| {
            image(camera, pose, &outline.map(|[y1, y2]| [y1 - height * s1, y2 - height * s2]), 0.0)
        };
        // The part of the shadow hidden by the cross is not darkened.
        let hidden = solid.clone();
        solid.extend([cast(cross.height_m), cast(cross.height_m - cross.thickness_m)]);
        groups.extend([(solid, -depth_dn), (hidden, depth_dn)]);
    }
    let kernels = feature_model.blur_px.map(kernel);
    // The box covers a pixel's cells; the Gaussian has the same reach before and after.
    let half = |axis: usize| (kernels[axis].len() - CELLS) / 2;
    let mut across = vec![0.0; columns * rows * CELLS];
    let mut cells = vec![0.0; width + 1];
    for cell_row in 0..rows * CELLS {
        cells.fill(0.0);
        for line in 0..LINES {
            let y = y0 as f64 - 0.5 + (cell_row as f64 + (line as f64 + 0.5) / LINES as f64) / CELLS as f64;
            for (polygons, level) in &groups {
                for (from, to) in union(polygons, y) {
                    let to_cells = |x: f64| ((x - x0 as f64 + 0.5) * CELLS as f64).clamp(0.0, width as f64);
                    add_span(&mut cells, to_cells(from), to_cells(to), level / LINES as f64);
                }
            }
        }
        for column in 0..columns {
            let first = (column * CELLS) as i64 - half(0) as i64;
            across[cell_row * columns + column] = kernels[0]
                .iter()
                .enumerate()
                .map(|(i, weight)| weight * cells[(first + i as i64).clamp(0, width as i64 - 1) as usize])
                .sum();
        }
    }
    let mut dn = vec![feature_model.beyond_dn; camera.columns * camera.rows];
    for row in 0..rows {
        let y = y0 + row as i64;
        for column in 0..columns {
            let x = x0 + column as i64;
            if !(0..camera.columns as i64).contains(&x) || !(0..camera.rows as i64).contains(&y) {
                continue;
            }
            let first = (row * CELLS) as i64 - half(1) as i64;
            dn[y as usize * camera.columns + x as usize] += kernels[1]
                .iter()
                .enumerate()
                .map(|(i, weight)| {
                    let cell = (first + i as i64).clamp(0, (rows * CELLS) as i64 - 1) as usize;
                    weight * across[cell * columns + column]
                })
                .sum::<f64>();
        }
    }
    dn
}

/// Returns a field of such an image with noise of `noise_dn`, rounded to eight bits.
pub(super) fn field(camera: &Camera, expected: &[f64], lines: Lines, noise_dn: f64, seed: u64) -> Field {
    let rows = lines.rows(camera.rows);
    let mut dn = Vec::with_capacity(rows * camera.columns);
    for row in 0..rows {
        for x in 0..camera.columns {
            let pixel_index = lines.camera_row(row) * camera.columns + x;
            let noise = noise_dn * normal(seed * 1_000_003 + pixel_index as u64);
            dn.push((expected[pixel_index] + noise).round().clamp(0.0, 255.0) as u16);
        }
    }
    Field::new(Frame::new(0, camera.columns, rows, 8, dn, None).unwrap(), lines, camera.rows).unwrap()
}

/// Projects a polygon. With a distorting camera, each edge is divided into 24 pieces.
fn image(camera: &Camera, pose: &Pose, polygon: &[[f64; 2]], height_m: f64) -> Vec<(f64, f64)> {
    let a = nalgebra::Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0))
        * Rotation3::new(pose.phi_rad).matrix();
    let (f, _) = camera.focal_length_px();
    let pieces = if camera.radial == [0.0; 3] { 1 } else { 24 };
    let mut points = Vec::new();
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        for i in 0..pieces {
            let s = f64::from(i) / f64::from(pieces);
            let y = Vector3::new(p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1]), height_m);
            let x = a.transpose() * (y - pose.position_m);
            let (u, v) = (f * x.x / x.z, f * x.y / x.z);
            let scale = 1.0 + camera.radial[0] * (u * u + v * v);
            points.push((camera.principal_x_px + u * scale, camera.principal_y_px + v * scale));
        }
    }
    points
}

/// Returns the disjoint intervals in which a horizontal line crosses a union of polygons (even-odd each).
fn union(polygons: &[Vec<(f64, f64)>], y: f64) -> Vec<(f64, f64)> {
    let mut intervals = Vec::new();
    for polygon in polygons {
        let mut crossings: Vec<f64> = polygon
            .iter()
            .zip(polygon.iter().cycle().skip(1))
            .filter(|(p, q)| (p.1 <= y) != (q.1 <= y))
            .map(|(p, q)| p.0 + (q.0 - p.0) * (y - p.1) / (q.1 - p.1))
            .collect();
        crossings.sort_by(f64::total_cmp);
        intervals.extend(crossings.chunks_exact(2).map(|pair| (pair[0], pair[1])));
    }
    intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut merged: Vec<(f64, f64)> = Vec::new();
    for (from, to) in intervals {
        match merged.last_mut() {
            Some(last) if from <= last.1 => last.1 = last.1.max(to),
            _ => merged.push((from, to)),
        }
    }
    merged
}

fn add_span(cells: &mut [f64], from: f64, to: f64, level: f64) {
    let (first, last) = (from as usize, to as usize);
    if first == last {
        cells[first] += level * (to - from);
        return;
    }
    cells[first] += level * (first as f64 + 1.0 - from);
    cells[first + 1..last].iter_mut().for_each(|cell| *cell += level);
    cells[last] += level * (to - last as f64);
}

/// Returns the kernel of a Gaussian, sampled at cells, with a pixel's box. Its sum is 1, and it begins half
/// its length before a pixel's first cell.
fn kernel(sigma_px: f64) -> Vec<f64> {
    let sigma = sigma_px * CELLS as f64;
    let reach = (6.0 * sigma).ceil() as i64;
    let gaussian: Vec<f64> =
        (-reach..=reach).map(|i| libm::exp(-0.5 * (i * i) as f64 / (sigma * sigma))).collect();
    let total: f64 = gaussian.iter().sum::<f64>() * CELLS as f64;
    let mut kernel = vec![0.0; gaussian.len() + CELLS - 1];
    for (i, weight) in gaussian.iter().enumerate() {
        kernel[i..i + CELLS].iter_mut().for_each(|k| *k += weight / total);
    }
    kernel
}
