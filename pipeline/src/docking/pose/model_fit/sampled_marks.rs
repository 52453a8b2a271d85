//! Exact coverage of a mark under a blur that acts on pixel values: its share of every pixel's square, summed
//! with the filter's weights.
//!
//! The product of profiles across a mark's sides (`coverage.rs`) is exact along the sides, but not at the
//! corners of an oblique mark, because the profile of such a blur depends on the direction: the error is 0.5
//! % for a mark of 2 × 8 px. The error repeats with every pixel that the mark moves, so it is the same in all
//! fields of a slow approach: a few thousandths of a pixel between cross and marks. It changes little while a
//! solution is refined, so it is computed once and added.

use contract::PixelPoint;
use contract::docking::{Field, Pose};
use nalgebra::Vector3;

use super::blur::{Blur, TAPS};
use super::coverage::MarkImage;
use super::sampled::{SMOOTH_PX2, covered};
use super::samples::{Feature, Samples};
use super::scene::Scene;
use crate::docking::pose::geometry::PoseProjection;

/// Reach of the filter to each side, pixels.
const REACH: usize = TAPS - 1;

/// Smallest width of a mark for a correction, px. For narrower marks, the share of the blur that acts on
/// pixels is too uncertain.
const MIN_WIDTH_PX: f64 = 1.0;

/// Exact shares of pixels, with reusable buffers.
#[derive(Debug, Default)]
pub(super) struct SampledMarks {
    squares: Vec<f64>,
    across: Vec<f64>,
}

/// Line a u + b v + c = 0 with a unit normal, positive inside.
type Line = (f64, f64, f64);

impl SampledMarks {
    /// Stores at every pixel of the marks the exact coverage minus the product of profiles, for a blur that
    /// acts on pixels only. Returns true if any pixel has a correction.
    pub(super) fn correct(
        &mut self,
        samples: &mut Samples,
        field: &Field,
        scene: &Scene,
        pose: &Pose,
        blur: Blur,
    ) -> bool {
        let Scene { camera, target, tables } = *scene;
        let is_smooth = blur.x.min(blur.y) > SMOOTH_PX2;
        if is_smooth {
            return false;
        }
        let view = PoseProjection::new(camera, pose);
        let mut is_corrected = false;
        let blur = Blur::on_grid(blur.x, blur.y, 1.0);
        let lines = field.lines();
        let Samples { pixels, patches, .. } = samples;
        for patch in patches.iter().filter(|patch| patch.is_used) {
            let Feature::Mark(index) = patch.feature else { continue };
            let corners = &target.marks[index];
            let Some(image) = MarkImage::new(corners, &view, blur, tables) else { continue };
            let Some(sides) = sides(corners, &view) else { continue };
            let across = |k: usize| {
                // Normals point inwards, so the sum of opposite offsets is the distance, for nearly parallel
                // sides.
                sides[k].2 + sides[k + 2].2
            };
            if across(0).min(across(1)) < MIN_WIDTH_PX {
                continue;
            }
            let pixels = &mut pixels[patch.first..patch.end];
            let positions = || pixels.iter().map(|pixel| (pixel.column, lines.camera_row(pixel.row)));
            let ends = |of: &dyn Fn((usize, usize)) -> usize| {
                positions().map(of).fold((usize::MAX, 0), |(low, high), at| (low.min(at), high.max(at)))
            };
            let (columns, rows) = (ends(&|at| at.0), ends(&|at| at.1));
            let (width, height) = (columns.1 - columns.0 + 1, rows.1 - rows.0 + 1);
            let (wide, high) = (width + 2 * REACH, height + 2 * REACH);
            self.squares.clear();
            for y in 0..high {
                for x in 0..wide {
                    let at = PixelPoint::new(
                        (columns.0 + x) as f64 - REACH as f64,
                        (rows.0 + y) as f64 - REACH as f64,
                    );
                    self.squares.push(camera.to_ideal(at).map_or(0.0, |(u, v)| share(&sides, u, v)));
                }
            }
            let [along_row, along_column] = blur.taps;
            self.across.clear();
            for row in self.squares.chunks_exact(wide) {
                self.across.extend((0..width).map(|x| filtered(&along_row, |k| row[x + k])));
            }
            for pixel in pixels {
                let (x, y) = (pixel.column - columns.0, lines.camera_row(pixel.row) - rows.0);
                let exact = filtered(&along_column, |k| self.across[(y + k) * width + x]);
                pixel.corner = exact - image.value_at(tables, pixel.u, pixel.v);
            }
            is_corrected = true;
        }
        is_corrected
    }
}

/// Returns Σ weight × value over the filter. Index 0 is the first value within its reach.
fn filtered(weights: &[f64; TAPS], value: impl Fn(usize) -> f64) -> f64 {
    (0..=2 * REACH).map(|k| weights[k.abs_diff(REACH)] * value(k)).sum()
}

/// Returns the sides of a mark in the image, or `None` when a corner is behind the camera.
fn sides(corners: &[[f64; 2]; 4], view: &PoseProjection) -> Option<[Line; 4]> {
    let [Some(a), Some(b), Some(c), Some(d)] =
        corners.map(|[y1, y2]| view.project_with_derivatives(&Vector3::new(y1, y2, 0.0)))
    else {
        return None;
    };
    let middle = (0.25 * (a.u + b.u + c.u + d.u), 0.25 * (a.v + b.v + c.v + d.v));
    Some([(&a, &b), (&b, &c), (&c, &d), (&d, &a)].map(|(p, q)| {
        let (du, dv) = (q.u - p.u, q.v - p.v);
        let length = libm::hypot(du, dv).max(f64::MIN_POSITIVE);
        let (nu, nv) = (-dv / length, du / length);
        let offset = -nu * p.u - nv * p.v;
        if nu * middle.0 + nv * middle.1 + offset < 0.0 { (-nu, -nv, -offset) } else { (nu, nv, offset) }
    }))
}

/// Returns the share of the unit square around a point that lies inside a quadrilateral.
fn share(sides: &[Line; 4], u: f64, v: f64) -> f64 {
    let inside = sides.map(|(a, b, c)| a * u + b * v + c);
    let reach = sides.map(|(a, b, _)| 0.5 * (a.abs() + b.abs()));
    if (0..4).any(|k| inside[k] <= -reach[k]) {
        return 0.0;
    }
    let is_cut = [0, 1, 2, 3].map(|k: usize| inside[k] < reach[k]);
    let of_side = |k: usize| covered(sides[k].0.abs(), sides[k].1.abs(), inside[k]);
    match is_cut {
        [false, false, false, false] => 1.0,
        // Opposite sides exclude disjoint parts.
        [first, false, third, false] => {
            let left_out = |is_cut: bool, k: usize| if is_cut { 1.0 - of_side(k) } else { 0.0 };
            (1.0 - left_out(first, 0) - left_out(third, 2)).max(0.0)
        }
        [false, second, false, fourth] => {
            let left_out = |is_cut: bool, k: usize| if is_cut { 1.0 - of_side(k) } else { 0.0 };
            (1.0 - left_out(second, 1) - left_out(fourth, 3)).max(0.0)
        }
        _ => clipped(sides, u, v),
    }
}

/// Returns the same share by clipping the square with one side after the other (Sutherland and Hodgman 1974).
fn clipped(sides: &[Line; 4], u: f64, v: f64) -> f64 {
    // A convex polygon gains at most one corner per side.
    let mut polygon = [(0.0, 0.0); 8];
    polygon[..4].copy_from_slice(&[
        (u - 0.5, v - 0.5),
        (u + 0.5, v - 0.5),
        (u + 0.5, v + 0.5),
        (u - 0.5, v + 0.5),
    ]);
    let mut corners = 4;
    for (a, b, c) in sides {
        let mut kept = [(0.0, 0.0); 8];
        let mut count = 0;
        for k in 0..corners {
            let (p, q) = (polygon[k], polygon[(k + 1) % corners]);
            let (at_p, at_q) = (a * p.0 + b * p.1 + c, a * q.0 + b * q.1 + c);
            if at_p >= 0.0 && count < kept.len() {
                kept[count] = p;
                count += 1;
            }
            if (at_p >= 0.0) != (at_q >= 0.0) && count < kept.len() {
                let part = at_p / (at_p - at_q);
                kept[count] = (p.0 + part * (q.0 - p.0), p.1 + part * (q.1 - p.1));
                count += 1;
            }
        }
        (polygon, corners) = (kept, count);
        if corners < 3 {
            return 0.0;
        }
    }
    let twice: f64 = (0..corners)
        .map(|k| {
            let (p, q) = (polygon[k], polygon[(k + 1) % corners]);
            (p.0 - u) * (q.1 - v) - (q.0 - u) * (p.1 - v)
        })
        .sum();
    0.5 * twice.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a mark of 2.3 × 7.6 px about (0.2, −0.1), rotated by `degrees`.
    fn turned(degrees: f64) -> [Line; 4] {
        let (s, c) = libm::sincos(degrees.to_radians());
        [(c, s, 1.15), (-s, c, 3.8), (-c, -s, 1.15), (s, -c, 3.8)]
            .map(|(a, b, half)| (a, b, half - 0.2 * a + 0.1 * b))
    }

    #[test]
    fn a_pixel_shows_the_area_that_a_count_of_points_shows() {
        for degrees in [0.0, 4.0, 30.0, 45.0, 120.0] {
            let sides = turned(degrees);
            let mut sum = 0.0;
            for k in 0..144 {
                let (u, v) = (f64::from(k % 12) - 5.7, f64::from(k / 12) - 5.4);
                let coordinate = |i: u32| (f64::from(i) + 0.5) / 200.0 - 0.5;
                let is_inside = |i: &u32| {
                    let (x, y) = (u + coordinate(i % 200), v + coordinate(i / 200));
                    sides.iter().all(|(a, b, c)| a * x + b * y + c > 0.0)
                };
                let counted = (0..40_000).filter(is_inside).count() as f64 / 40_000.0;
                let exact = share(&sides, u, v);
                // At most two sides cross 283 cells of the counted points each; half of each cell is
                // uncertain.
                assert!((exact - counted).abs() < 283.0 / 40_000.0, "{degrees} {u} {v}: {exact} {counted}");
                sum += exact;
            }
            assert!((sum - 2.3 * 7.6).abs() < 1e-3, "{degrees}: {sum}");
        }
    }
}
