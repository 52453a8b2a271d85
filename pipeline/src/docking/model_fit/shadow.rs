//! The shadow that the cross casts on the plate: where the Sun stands is found from the plate's own pixels.
//!
//! A distant light shifts the cross's outline along the plate by −y3 s, s = (s1, s2) being the tangents of its direction; the
//! thickness draws the outline out. On a dark plate the step is small against a white edge, but it lies beside the edges that
//! the pose hangs on: left out, it moves them by a few hundredths of a pixel.

use contract::docking::{Field, TargetModel};
use nalgebra::{Matrix2, Vector2};
use pulp::{Arch, Simd, WithSimd};

use super::chunk::{CHUNK, Places};
use super::coverage::MarkImage;
use super::edge::Blur;
use super::sampled::Tables;
use crate::CameraModel;
use crate::docking::geometry::View;

/// Cells of the plate's map along a side.
const CELLS: usize = 64;

/// Pixels of the plate that are looked at, about.
const PLATE_PIXELS: f64 = 6000.0;

/// Pixels about the shadow's edges that place it, at most, and how far from the edges they lie, px.
const EDGE_PIXELS: usize = 1200;

/// What a shadow must explain to be one, in variances of a pixel: the best of all places explains 2 ln(places) ≈ 17 by chance.
const LEAST_GAIN: f64 = 40.0;

/// Steps of refinement.
const STEPS: usize = 4;

/// Step of the numeric derivative, tangent of the Sun's direction: 0.3 mm on the plate.
const STEP: f64 = 1e-3;

/// A pixel of the plate, clear of marks, cross and rim.
#[derive(Debug, Clone, Copy)]
struct PlatePixel {
    u: f64,
    v: f64,
    y1: f64,
    y2: f64,
    dn: f64,
}

/// Finds shadows; owns its buffers.
#[derive(Debug, Default)]
pub(super) struct ShadowFinder {
    pixels: Vec<PlatePixel>,
    /// Sums over the cells above and to the left: count and DN.
    sums: Vec<(f64, f64)>,
}

/// A shadow on the plate as a camera sees it.
#[derive(Debug, Clone)]
pub(super) struct Shadow {
    images: [MarkImage; 3],
    /// How much darker it is than the plate, DN.
    pub(super) depth_dn: f64,
}

impl Shadow {
    fn new(
        target: &TargetModel,
        view: &View,
        blur: Blur,
        tables: &Tables,
        tangents: Vector2<f64>,
    ) -> Option<Self> {
        let quads = outline(target, tangents);
        let [Some(a), Some(b), Some(c)] = quads.map(|quad| MarkImage::new(&quad, view, blur, tables)) else {
            return None;
        };
        Some(Self { images: [a, b, c], depth_dn: 0.0 })
    }

    /// Blurred share of the shadow at an ideal image point.
    pub(super) fn at(&self, tables: &Tables, u: f64, v: f64) -> f64 {
        let [share] = self.shares_at(tables, &Places { u: [u], v: [v] });
        share
    }

    /// The same at many points, into `shares`.
    pub(super) fn shares(
        &self,
        tables: &Tables,
        points: impl Iterator<Item = (f64, f64)>,
        shares: &mut Vec<f64>,
    ) {
        shares.clear();
        let mut points = points.peekable();
        let mut at = Places { u: [0.0; CHUNK], v: [0.0; CHUNK] };
        while points.peek().is_some() {
            let (mut count, mut last) = (0, (0.0, 0.0));
            for l in 0..CHUNK {
                if let Some(point) = points.next() {
                    (count, last) = (l + 1, point);
                }
                (at.u[l], at.v[l]) = last;
            }
            let found = Arch::new().dispatch(Shares { shadow: self, tables, at: &at });
            shares.extend_from_slice(&found[..count]);
        }
    }

    #[inline(always)]
    fn shares_at<const N: usize>(&self, tables: &Tables, at: &Places<N>) -> [f64; N] {
        let mut lit = [1.0; N];
        for image in &self.images {
            let covered = image.values(tables, at);
            for l in 0..N {
                lit[l] *= 1.0 - covered[l];
            }
        }
        lit.map(|lit| 1.0 - lit)
    }
}

/// The shares of a shadow at a chunk of points.
struct Shares<'a> {
    shadow: &'a Shadow,
    tables: &'a Tables,
    at: &'a Places<CHUNK>,
}

impl WithSimd for Shares<'_> {
    type Output = [f64; CHUNK];

    // Inline, all of it: only so is it compiled for the registers of the machine.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.shadow.shares_at(self.tables, self.at)
    }
}

/// The shadows of the two bars and of the post, corners in the plate's plane. The hull that a bar's thickness draws out is
/// taken for a rectangle: what that adds are corners of a few millimetres.
fn outline(target: &TargetModel, tangents: Vector2<f64>) -> [[[f64; 2]; 4]; 3] {
    let cross = &target.cross;
    let centre = tangents * -(cross.height_m - 0.5 * cross.thickness_m);
    let grown = tangents.abs() * (0.5 * cross.thickness_m);
    let bar = |half_1: f64, half_2: f64| {
        let (a, b) = (half_1 + grown.x, half_2 + grown.y);
        [[-a, -b], [a, -b], [a, b], [-a, b]].map(|[y1, y2]| [centre.x + y1, centre.y + y2])
    };
    let (half, length) = (0.5 * cross.width_m, cross.half_length_m);
    let towards = tangents.try_normalize(1e-9).unwrap_or(Vector2::x());
    let side = Vector2::new(-towards.y, towards.x) * (0.5 * cross.post_width_m);
    let foot = Vector2::zeros();
    let head = centre - towards * 1e-6;
    let post = [foot - side, foot + side, head + side, head - side].map(|p| [p.x, p.y]);
    [bar(half, length), bar(length, half), post]
}

impl ShadowFinder {
    /// The shadow on the plate, if one is seen. `is_clear` says which points (image and plate) show the bare plate.
    #[allow(clippy::too_many_arguments, reason = "the scene, and which pixels of it are bare")]
    pub(super) fn find(
        &mut self,
        field: &Field,
        camera: &CameraModel,
        target: &TargetModel,
        tables: &Tables,
        view: &View,
        blur: Blur,
        is_clear: impl Fn(f64, f64, f64, f64) -> bool,
    ) -> Option<Shadow> {
        self.collect(field, camera, target, view, is_clear)?;
        let mut tangents = self.search(target)?;
        let shadow = Shadow::new(target, view, blur, tables, tangents)?;
        let [mut shares, mut to_first, mut to_second] = [const { Vec::new() }; 3];
        // Only pixels about the shadow's edges place it; the others say what is light and dark.
        let near: Vec<PlatePixel> = {
            shadow.shares(tables, places(&self.pixels), &mut shares);
            let is_edge = |share: &f64| (0.002..0.998).contains(share);
            let edges: Vec<PlatePixel> =
                self.pixels.iter().zip(&shares).filter(|(_, s)| is_edge(s)).map(|(p, _)| *p).collect();
            let stride = edges.len().div_ceil(EDGE_PIXELS).max(1);
            let others = self.pixels.len().div_ceil(EDGE_PIXELS / 2).max(1);
            edges.iter().step_by(stride).chain(self.pixels.iter().step_by(others)).copied().collect()
        };
        for _ in 0..STEPS {
            let here = Shadow::new(target, view, blur, tables, tangents)?;
            let along = [Vector2::x(), Vector2::y()]
                .map(|axis| Shadow::new(target, view, blur, tables, tangents + axis * STEP));
            let [Some(first), Some(second)] = along else { return None };
            here.shares(tables, places(&near), &mut shares);
            first.shares(tables, places(&near), &mut to_first);
            second.shares(tables, places(&near), &mut to_second);
            let (light, depth) = levels(&near, &shares)?;
            let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
            for (pixel, ((share, first), second)) in
                near.iter().zip(shares.iter().zip(&to_first).zip(&to_second))
            {
                let slope = Vector2::new(first - share, second - share) * (-depth / STEP);
                normal += slope * slope.transpose();
                right += slope * (pixel.dn - light + depth * share);
            }
            let step: Vector2<f64> = normal.try_inverse()? * right;
            // Not farther than half a bar, where the next place of the search would be better.
            let longest = 0.5 * target.cross.width_m / target.cross.height_m;
            tangents += step * (longest / step.norm().max(longest));
            if step.norm() < 1e-4 {
                break;
            }
        }
        let mut shadow = Shadow::new(target, view, blur, tables, tangents)?;
        shadow.shares(tables, places(&near), &mut shares);
        shadow.depth_dn = levels(&near, &shares)?.1;
        (shadow.depth_dn > 0.0).then_some(shadow)
    }

    fn collect(
        &mut self,
        field: &Field,
        camera: &CameraModel,
        target: &TargetModel,
        view: &View,
        is_clear: impl Fn(f64, f64, f64, f64) -> bool,
    ) -> Option<()> {
        let (image, lines) = (field.image(), field.lines());
        let radius = target.plate_radius_m;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (y1, y2) in [(-radius, -radius), (radius, -radius), (radius, radius), (-radius, radius)] {
            let corner = camera.project_vector(&view.to_camera(&nalgebra::Vector3::new(y1, y2, 0.0)))?;
            low = [low[0].min(corner.x), low[1].min(corner.y)];
            high = [high[0].max(corner.x), high[1].max(corner.y)];
        }
        let (step, first_row) = (lines.step() as f64, lines.camera_row(0) as f64);
        let rows = (
            ((low[1] - first_row) / step).ceil().clamp(0.0, image.rows() as f64) as usize,
            (((high[1] - first_row) / step).floor() + 1.0).clamp(0.0, image.rows() as f64) as usize,
        );
        let columns = (
            low[0].ceil().clamp(0.0, image.columns() as f64) as usize,
            (high[0].floor() + 1.0).clamp(0.0, image.columns() as f64) as usize,
        );
        let area = rows.1.saturating_sub(rows.0) as f64 * columns.1.saturating_sub(columns.0) as f64;
        // Every n-th pixel, another one in every row.
        let thin = ((area / PLATE_PIXELS).ceil() as usize).max(1);
        self.pixels.clear();
        for row in rows.0..rows.1 {
            let y = lines.camera_row(row) as f64;
            let begin = columns.0 + (row * 7) % thin;
            for column in (begin..columns.1).step_by(thin) {
                let at = contract::PixelPoint::new(column as f64, y);
                let Some((u, v)) = camera.to_ideal(at) else { continue };
                let Some((y1, y2)) = view.on_plane(u, v, 0.0) else { continue };
                if is_clear(u, v, y1, y2) {
                    self.pixels.push(PlatePixel { u, v, y1, y2, dn: f64::from(image.at(column, row)) });
                }
            }
        }
        (self.pixels.len() >= 50).then_some(())
    }

    /// The tangents that explain the plate's pixels best, by sums over rectangles of a map of the plate.
    fn search(&mut self, target: &TargetModel) -> Option<Vector2<f64>> {
        let radius = target.plate_radius_m;
        let cell = 2.0 * radius / CELLS as f64;
        let width = CELLS + 1;
        self.sums.clear();
        self.sums.resize(width * width, (0.0, 0.0));
        let place = |y: f64| (((y + radius) / cell) as usize).min(CELLS - 1) + 1;
        for pixel in &self.pixels {
            let sum = &mut self.sums[place(pixel.y2) * width + place(pixel.y1)];
            *sum = (sum.0 + 1.0, sum.1 + pixel.dn);
        }
        for row in 1..width {
            let mut along = (0.0, 0.0);
            for column in 1..width {
                let here = self.sums[row * width + column];
                along = (along.0 + here.0, along.1 + here.1);
                let above = self.sums[(row - 1) * width + column];
                self.sums[row * width + column] = (along.0 + above.0, along.1 + above.1);
            }
        }
        let n = self.pixels.len() as f64;
        let sum: f64 = self.pixels.iter().map(|p| p.dn).sum();
        let squares: f64 = self.pixels.iter().map(|p| p.dn * p.dn).sum();
        let variance = (squares - sum * sum / n) / n;
        let edge = |y: f64| ((y + radius) / cell).round().clamp(0.0, CELLS as f64) as usize;
        let within = |centre: Vector2<f64>, half_1: f64, half_2: f64| {
            let (left, right) = (edge(centre.x - half_1), edge(centre.x + half_1));
            let (bottom, top) = (edge(centre.y - half_2), edge(centre.y + half_2));
            let at = |row: usize, column: usize| self.sums[row * width + column];
            let (a, b, c, d) = (at(top, right), at(bottom, right), at(top, left), at(bottom, left));
            (a.0 - b.0 - c.0 + d.0, a.1 - b.1 - c.1 + d.1)
        };
        let (half, length) = (0.5 * target.cross.width_m, target.cross.half_length_m);
        let reach = ((radius + length) / cell) as i32;
        let mut best = (0.0, None);
        for i in -reach..=reach {
            for j in -reach..=reach {
                let centre = Vector2::new(f64::from(i), f64::from(j)) * cell;
                let (v, h, both) =
                    (within(centre, half, length), within(centre, length, half), within(centre, half, half));
                let inside = (v.0 + h.0 - both.0, v.1 + h.1 - both.1);
                let outside = (n - inside.0, sum - inside.1);
                if inside.0 < 10.0 || outside.0 < 10.0 {
                    continue;
                }
                let step = outside.1 / outside.0 - inside.1 / inside.0;
                let gain = step * step * inside.0 * outside.0 / n;
                if step > 0.0 && gain > best.0 {
                    best = (gain, Some(centre));
                }
            }
        }
        let left = (variance - best.0 / n).max(1e-3);
        let height = target.cross.height_m - 0.5 * target.cross.thickness_m;
        best.1.filter(|_| best.0 > LEAST_GAIN * left).map(|centre| centre / -height)
    }
}

/// Image points of pixels.
fn places(pixels: &[PlatePixel]) -> impl Iterator<Item = (f64, f64)> {
    pixels.iter().map(|pixel| (pixel.u, pixel.v))
}

/// Light plate and depth of the shadow by least squares, DN.
fn levels(pixels: &[PlatePixel], shares: &[f64]) -> Option<(f64, f64)> {
    let n = pixels.len() as f64;
    let (mut s, mut ss, mut d, mut sd) = (0.0, 0.0, 0.0, 0.0);
    for (pixel, share) in pixels.iter().zip(shares) {
        s += share;
        ss += share * share;
        d += pixel.dn;
        sd += share * pixel.dn;
    }
    let determinant = n * ss - s * s;
    if determinant <= 1e-9 * n {
        return None;
    }
    let slope = (n * sd - s * d) / determinant;
    Some(((d - slope * s) / n, -slope))
}
