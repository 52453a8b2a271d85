//! Shadow of the cross on the plate. The Sun's direction is determined from the pixels of the plate.
//!
//! A distant light source shifts the cross's outline along the plate by −y3 s, where s = (s1, s2) are the
//! tangents of its direction; the cross's thickness elongates the outline. On a dark plate the step is small
//! compared with a white edge, but it is beside the edges that determine the pose: if neglected, it shifts
//! them by a few hundredths of a pixel.

use std::f64::consts::TAU;

use contract::docking::{Field, TargetModel};
use nalgebra::{Matrix2, Vector2, Vector3};
use pulp::{Arch, Simd, WithSimd};

use super::blur::Blur;
use super::chunk::{CHUNK, IdealPositions};
use super::coverage::MarkImage;
use super::sampled::Tables;
use crate::CameraModel;
use crate::docking::pose::geometry::PoseProjection;

/// Number of cells of the plate's map per side.
const CELLS: usize = 64;

/// Approximate number of pixels of the plate that are used.
const PLATE_PIXELS: f64 = 6000.0;

/// Largest number of pixels near the shadow's edges that determine its position.
const EDGE_PIXELS: usize = 1200;

/// Smallest gain of a shadow, in variances of a pixel. By chance, the best of all positions has a gain of 2
/// ln(positions) ≈ 17.
const MIN_GAIN: f64 = 40.0;

/// Share of the evidence kept from field to field. The Sun's direction is constant over seconds, and a shadow
/// with few visible pixels is not distinct from chance in a single field.
const RETENTION: f64 = 0.9;

/// Smallest gain of the previous direction, relative to the best position's gain, for which the previous
/// direction is kept.
const MIN_RELATIVE_GAIN: f64 = 0.8;

/// Smallest number of pixels in shadow, and in light, with which a position is evaluated.
const MIN_PIXELS_PER_SIDE: f64 = 4.0;

/// Smallest depth of a shadow, relative to the cross's level. A shallower shadow shifts no edge, and is more
/// likely an error of the cross's blurred signal.
const MIN_DEPTH: f64 = 0.01;

/// Standard deviation of the direction, tangent, assumed in the damping of refinement steps. A shadow whose
/// bars are not on the plate determines only the azimuth.
const DAMPING_SIGMA: f64 = 0.1;

/// Largest number of refinement steps.
const STEPS: usize = 4;

/// Step of the numeric derivative, tangent of the Sun's direction: 0.3 mm on the plate.
const STEP: f64 = 1e-3;

/// Number of directions in the search.
const DIRECTIONS: u32 = 192;

/// Pixel of the plate, clear of marks, cross and rim, with the cross's blurred signal subtracted.
#[derive(Debug, Clone, Copy)]
struct PlatePixel {
    u: f64,
    v: f64,
    y1: f64,
    y2: f64,
    dn: f64,
}

/// Accumulated evidence at one position: Σ s w and Σ w, with s the plate's step there and w its weight, in
/// variances of a pixel.
#[derive(Debug, Clone, Copy, Default)]
struct Evidence {
    step: f64,
    weight: f64,
}

impl Evidence {
    /// Returns the gain of a darker plate there, in variances of a pixel.
    fn explained_variance(&self) -> f64 {
        if self.step > 0.0 { self.step * self.step / self.weight } else { 0.0 }
    }
}

/// Direction of the Sun from previous fields.
#[derive(Debug, Clone, Copy)]
struct SunEstimate {
    tangents: Vector2<f64>,
    information: Matrix2<f64>,
}

/// Search for shadows in successive fields, with reusable buffers and memory of the Sun's direction.
#[derive(Debug, Default)]
pub(super) struct ShadowFinder {
    pixels: Vec<PlatePixel>,
    /// Sums over the cells above and to the left: count and DN.
    sums: Vec<(f64, f64)>,
    /// Evidence for each position, direction by direction, from this field and from all fields.
    field: Vec<Evidence>,
    evidence: Vec<Evidence>,
    sun_estimate: Option<SunEstimate>,
}

/// Shadow on the plate as seen by a camera.
#[derive(Debug, Clone)]
pub(super) struct Shadow {
    images: [MarkImage; 3],
    /// Darkening of the plate by the full shadow, DN.
    pub(super) depth_dn: f64,
}

impl Shadow {
    fn new(
        target: &TargetModel,
        view: &PoseProjection,
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

    /// Returns the blurred share of the shadow at an ideal image point.
    pub(super) fn share_at(&self, tables: &Tables, u: f64, v: f64) -> f64 {
        let [share] = self.shares_at(tables, &IdealPositions { u: [u], v: [v] });
        share
    }

    /// Writes the blurred shares of the shadow at many points to `shares`.
    pub(super) fn shares(
        &self,
        tables: &Tables,
        points: impl Iterator<Item = (f64, f64)>,
        shares: &mut Vec<f64>,
    ) {
        shares.clear();
        let mut points = points.peekable();
        let mut at = IdealPositions { u: [0.0; CHUNK], v: [0.0; CHUNK] };
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
    fn shares_at<const N: usize>(&self, tables: &Tables, at: &IdealPositions<N>) -> [f64; N] {
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

/// Computation of the shares of a shadow at a chunk of points.
struct Shares<'a> {
    shadow: &'a Shadow,
    tables: &'a Tables,
    at: &'a IdealPositions<CHUNK>,
}

impl WithSimd for Shares<'_> {
    type Output = [f64; CHUNK];

    // Only fully inlined code is compiled for the registers of the machine.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.shadow.shares_at(self.tables, self.at)
    }
}

/// Returns the shadows of the two bars and of the post, as corners in the plate's plane. The hull formed by a
/// bar's thickness is approximated by a rectangle, which adds corners of a few millimetres.
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
    /// Returns the shadow on the plate, if one is found. `lit_dn` returns the brightening of the bare plate
    /// by the cross's blurred edge at a point (image and plate), DN, or `None` where the point is not bare
    /// plate.
    #[allow(clippy::too_many_arguments, reason = "the parts of the scene and the unshadowed pixels")]
    pub(super) fn find(
        &mut self,
        field: &Field,
        camera: &CameraModel,
        target: &TargetModel,
        tables: &Tables,
        view: &PoseProjection,
        blur: Blur,
        cross_dn: f64,
        lit_dn: impl Fn(f64, f64, f64, f64) -> Option<f64>,
    ) -> Option<Shadow> {
        self.collect(field, camera, target, view, lit_dn)?;
        let (before, variance) = self.search(target)?;
        let mut tangents = before.tangents;
        if before.information == Matrix2::zeros() {
            // Starting from a position on the map: the blur is increased to the coarseness of the map's
            // cells, if this exceeds the blur.
            let cell = 2.0 * target.plate_radius_m / CELLS as f64;
            let (a, b) = (
                view.project_with_derivatives(&Vector3::zeros())?,
                view.project_with_derivatives(&Vector3::new(cell, 0.0, 0.0))?,
            );
            let cell_px = libm::hypot(a.u - b.u, a.v - b.v);
            let extra = 0.25 * cell_px * cell_px;
            if extra > blur.x.max(blur.y) {
                let blurred = Blur::new(blur.x + extra, blur.y + extra);
                tangents = self.refine(target, view, blurred, tables, &before, tangents, variance)?.0;
            }
        }
        let (tangents, seen, depth_dn) =
            self.refine(target, view, blur, tables, &before, tangents, variance)?;
        self.sun_estimate =
            Some(SunEstimate { tangents, information: (before.information + seen) * RETENTION });
        let mut shadow = Shadow::new(target, view, blur, tables, tangents)?;
        shadow.depth_dn = depth_dn;
        (depth_dn > MIN_DEPTH * cross_dn).then_some(shadow)
    }

    /// Determines the Sun's direction by the Gauss–Newton method, starting from `tangents`. Returns the
    /// direction, the information on it in this field, and the shadow's depth, DN.
    #[allow(clippy::too_many_arguments, reason = "the parts of the scene and the start")]
    fn refine(
        &self,
        target: &TargetModel,
        view: &PoseProjection,
        blur: Blur,
        tables: &Tables,
        before: &SunEstimate,
        mut tangents: Vector2<f64>,
        variance: f64,
    ) -> Option<(Vector2<f64>, Matrix2<f64>, f64)> {
        let mut seen = Matrix2::zeros();
        let shadow = Shadow::new(target, view, blur, tables, tangents)?;
        let [mut shares, mut to_first, mut to_second] = [const { Vec::new() }; 3];
        // Only pixels near the shadow's edges determine its position; the other pixels determine the light
        // and dark levels.
        let near: Vec<PlatePixel> = {
            shadow.shares(tables, image_points(&self.pixels), &mut shares);
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
            here.shares(tables, image_points(&near), &mut shares);
            first.shares(tables, image_points(&near), &mut to_first);
            second.shares(tables, image_points(&near), &mut to_second);
            let (light, depth) = levels(&near, &shares)?;
            let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
            for (pixel, ((share, first), second)) in
                near.iter().zip(shares.iter().zip(&to_first).zip(&to_second))
            {
                let slope = Vector2::new(first - share, second - share) * (-depth / STEP);
                normal += slope * slope.transpose();
                right += slope * (pixel.dn - light + depth * share);
            }
            seen = normal / variance;
            let damping = Matrix2::identity() * (variance / (DAMPING_SIGMA * DAMPING_SIGMA));
            right += before.information * (before.tangents - tangents) * variance;
            normal += before.information * variance + damping;
            let step: Vector2<f64> = normal.try_inverse()? * right;
            // Steps are limited to half a bar; beyond that, the next position of the search would be a better
            // start.
            let longest = 0.5 * target.cross.width_m / target.cross.height_m;
            tangents += step * (longest / step.norm().max(longest));
            if step.norm() < 1e-4 {
                break;
            }
        }
        let shadow = Shadow::new(target, view, blur, tables, tangents)?;
        shadow.shares(tables, image_points(&near), &mut shares);
        Some((tangents, seen, levels(&near, &shares)?.1))
    }

    fn collect(
        &mut self,
        field: &Field,
        camera: &CameraModel,
        target: &TargetModel,
        view: &PoseProjection,
        lit_dn: impl Fn(f64, f64, f64, f64) -> Option<f64>,
    ) -> Option<()> {
        let (image, lines) = (field.image(), field.lines());
        let radius = target.plate_radius_m;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (y1, y2) in [(-radius, -radius), (radius, -radius), (radius, radius), (-radius, radius)] {
            let corner = camera.project_vector(&view.to_camera(&Vector3::new(y1, y2, 0.0)))?;
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
        // Every n-th pixel, with a different offset in every row.
        let thin = ((area / PLATE_PIXELS).ceil() as usize).max(1);
        self.pixels.clear();
        for row in rows.0..rows.1 {
            let y = lines.camera_row(row) as f64;
            let begin = columns.0 + (row * 7) % thin;
            for column in (begin..columns.1).step_by(thin) {
                let at = contract::PixelPoint::new(column as f64, y);
                let Some((u, v)) = camera.to_ideal(at) else { continue };
                let Some((y1, y2)) = view.on_plane(u, v, 0.0) else { continue };
                if let Some(lit_dn) = lit_dn(u, v, y1, y2) {
                    let dn = f64::from(image.dn_at(column, row)) - lit_dn;
                    self.pixels.push(PlatePixel { u, v, y1, y2, dn });
                }
            }
        }
        (self.pixels.len() >= 50).then_some(())
    }

    /// Finds the direction that best explains the plate's pixels in this field and previous ones, by sums
    /// over rectangles of a map of the plate. Also returns the remaining variance of a pixel, DN².
    fn search(&mut self, target: &TargetModel) -> Option<(SunEstimate, f64)> {
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
        let edge = |y: f64| ((y + radius) / cell + 0.5).clamp(0.0, CELLS as f64) as usize;
        let sums = &self.sums;
        let within = |(left, right): (usize, usize), (bottom, top): (usize, usize)| {
            let at = |row: usize, column: usize| sums[row * width + column];
            let (a, b, c, d) = (at(top, right), at(bottom, right), at(top, left), at(bottom, left));
            (a.0 - b.0 - c.0 + d.0, a.1 - b.1 - c.1 + d.1)
        };
        let (half, length) = (0.5 * target.cross.width_m, target.cross.half_length_m);
        let side = 0.25 * target.cross.post_width_m;
        let reach = ((radius + length) / cell) as usize;
        let mut best_of_field = 0.0f64;
        let mut along = Vec::with_capacity(CELLS / 2 + 1);
        self.field.clear();
        for direction in 0..DIRECTIONS {
            let (s, c) = libm::sincos(f64::from(direction) * TAU / f64::from(DIRECTIONS));
            // Sums of the post's shadow from its foot up to each distance, by its two halves.
            along.clear();
            along.push((0.0, 0.0));
            let mut of_post = (0.0, 0.0);
            for step in 0..CELLS / 2 {
                let distance = (step as f64 + 0.5) * cell;
                for half_post in [-side, side] {
                    let column = place(c * distance - s * half_post);
                    let row = place(s * distance + c * half_post);
                    let sum = within((column - 1, column), (row - 1, row));
                    of_post = (of_post.0 + sum.0, of_post.1 + sum.1);
                }
                along.push(of_post);
            }
            // The bars hide its end.
            let end = |a: f64, b: f64| (a / c.abs()).min(b / s.abs());
            let hidden = (end(half, length).max(end(length, half)) / cell) as usize;
            for distance in 0..=reach {
                let (x, y) = (c * distance as f64 * cell, s * distance as f64 * cell);
                let span = |at: f64, half: f64| (edge(at - half), edge(at + half));
                let (across, down) = (span(x, half), span(y, half));
                let (v, h) = (within(across, span(y, length)), within(span(x, length), down));
                let both = within(across, down);
                let post = along[distance.saturating_sub(hidden).min(CELLS / 2)];
                let inside = (v.0 + h.0 - both.0 + post.0, v.1 + h.1 - both.1 + post.1);
                let outside = (n - inside.0, sum - inside.1);
                let mut here = Evidence::default();
                if inside.0 >= MIN_PIXELS_PER_SIDE && outside.0 >= MIN_PIXELS_PER_SIDE {
                    here.weight = inside.0 * outside.0 / n;
                    here.step = (outside.1 / outside.0 - inside.1 / inside.0) * here.weight;
                    best_of_field = best_of_field.max(here.explained_variance());
                }
                self.field.push(here);
            }
        }
        let left = (variance - best_of_field / n).max(1e-3);
        self.evidence.resize(self.field.len(), Evidence::default());
        let mut best = (0.0, 0);
        for (place, (sum, here)) in self.evidence.iter_mut().zip(&self.field).enumerate() {
            sum.step = RETENTION * sum.step + here.step / left;
            sum.weight = RETENTION * sum.weight + here.weight / left;
            // Takes the farthest of equivalent positions: invisible bars are not on the plate.
            if sum.explained_variance() >= best.0 {
                best = (sum.explained_variance(), place);
            }
        }
        if best.0 < MIN_GAIN {
            return None;
        }
        let height = target.cross.height_m - 0.5 * target.cross.thickness_m;
        let is_as_good = |placed: &SunEstimate| {
            let centre = placed.tangents * -height;
            let turns = libm::atan2(centre.y, centre.x) / TAU;
            let direction =
                (turns * f64::from(DIRECTIONS)).round().rem_euclid(f64::from(DIRECTIONS)) as usize;
            let distance = ((centre.norm() / cell).round() as usize).min(reach);
            self.evidence[direction * (reach + 1) + distance].explained_variance()
                >= MIN_RELATIVE_GAIN * best.0
        };
        let placed = self.sun_estimate.filter(is_as_good).unwrap_or_else(|| {
            let (direction, distance) = (best.1 / (reach + 1), best.1 % (reach + 1));
            let (s, c) = libm::sincos(direction as f64 * TAU / f64::from(DIRECTIONS));
            let centre = Vector2::new(c, s) * (distance as f64 * cell);
            SunEstimate { tangents: centre / -height, information: Matrix2::zeros() }
        });
        Some((placed, left))
    }
}

/// Returns the image points of pixels.
fn image_points(pixels: &[PlatePixel]) -> impl Iterator<Item = (f64, f64)> {
    pixels.iter().map(|pixel| (pixel.u, pixel.v))
}

/// Returns the level of the lit plate and the depth of the shadow by least squares, DN.
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
