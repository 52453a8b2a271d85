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
use super::plate_map::{CELLS, PixelSum, PlateMap, PlatePixel};
use super::sampled::Tables;
use crate::CameraModel;
use crate::docking::pose::geometry::PoseProjection;

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
    map: PlateMap,
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

    /// Finds the direction that best explains the plate's pixels in this field and previous ones. Also
    /// returns the remaining variance of a pixel, DN².
    fn search(&mut self, target: &TargetModel) -> Option<(SunEstimate, f64)> {
        self.map.fill(target.plate_radius_m, &self.pixels);
        let positions = Positions::new(target, &self.map);
        let best_of_field = self.evaluate(target, &positions);
        let remaining = (self.map.variance() - best_of_field / self.map.total().count).max(1e-3);
        let best = self.accumulate(remaining)?;
        let placed = match self.sun_estimate {
            Some(estimate) if self.is_as_good(&estimate, &positions, best.gain) => estimate,
            _ => positions.sun_at(best.position),
        };
        Some((placed, remaining))
    }

    /// Computes the evidence of this field for a shadow at each position. Returns the largest variance that
    /// one position explains, DN².
    fn evaluate(&mut self, target: &TargetModel, positions: &Positions) -> f64 {
        let (map, total) = (&self.map, self.map.total());
        let mut best: f64 = 0.0;
        let mut post = Vec::with_capacity(CELLS / 2 + 1);
        self.field.clear();
        for direction in 0..DIRECTIONS as usize {
            let (sine, cosine) = Positions::direction(direction);
            sum_post(target, map, sine, cosine, &mut post);
            let hidden = hidden_cells(target, map, sine, cosine);
            for distance in 0..=positions.reach {
                let along_m = distance as f64 * map.cell_m();
                let (x_m, y_m) = (cosine * along_m, sine * along_m);
                let post = post[distance.saturating_sub(hidden).min(CELLS / 2)];
                let shadowed = sum_bars(target, map, x_m, y_m) + post;
                let lit = total - shadowed;
                let mut here = Evidence::default();
                if shadowed.count >= MIN_PIXELS_PER_SIDE && lit.count >= MIN_PIXELS_PER_SIDE {
                    here.weight = shadowed.count * lit.count / total.count;
                    here.step = (lit.dn / lit.count - shadowed.dn / shadowed.count) * here.weight;
                    best = best.max(here.explained_variance());
                }
                self.field.push(here);
            }
        }
        best
    }

    /// Adds the evidence of this field, in variances of a pixel, to that of previous ones. Returns the best
    /// position; `None` if a lit plate explains the pixels as well.
    fn accumulate(&mut self, variance: f64) -> Option<BestPosition> {
        self.evidence.resize(self.field.len(), Evidence::default());
        let mut best = BestPosition { gain: 0.0, position: 0 };
        for (position, sum) in self.evidence.iter_mut().enumerate() {
            let here = self.field[position];
            sum.step = RETENTION * sum.step + here.step / variance;
            sum.weight = RETENTION * sum.weight + here.weight / variance;
            // Takes the farthest of equivalent positions: invisible bars are not on the plate.
            if sum.explained_variance() >= best.gain {
                best = BestPosition { gain: sum.explained_variance(), position };
            }
        }
        (best.gain >= MIN_GAIN).then_some(best)
    }

    /// Returns true if a previous direction explains the pixels about as well as the best position.
    fn is_as_good(&self, estimate: &SunEstimate, positions: &Positions, best_gain: f64) -> bool {
        let gain = self.evidence[positions.nearest(estimate)].explained_variance();
        gain >= MIN_RELATIVE_GAIN * best_gain
    }
}

/// Best position of a search.
struct BestPosition {
    /// Gain of the shadow there, in variances of a pixel.
    gain: f64,
    position: usize,
}

/// Positions of the shadow's centre on the plate: [`DIRECTIONS`] directions from the cross's foot, each with
/// distances of whole cells.
struct Positions {
    /// Largest distance, cells.
    reach: usize,
    cell_m: f64,
    /// Height of the cross's underside over the plate, m.
    height_m: f64,
}

impl Positions {
    fn new(target: &TargetModel, map: &PlateMap) -> Self {
        let cell_m = map.cell_m();
        Self {
            reach: ((target.plate_radius_m + target.cross.half_length_m) / cell_m) as usize,
            cell_m,
            height_m: target.cross.height_m - 0.5 * target.cross.thickness_m,
        }
    }

    /// Returns sine and cosine of a direction.
    fn direction(direction: usize) -> (f64, f64) {
        libm::sincos(direction as f64 * TAU / f64::from(DIRECTIONS))
    }

    /// Returns the direction of the Sun that puts the shadow at a position.
    fn sun_at(&self, position: usize) -> SunEstimate {
        let (direction, distance) = (position / (self.reach + 1), position % (self.reach + 1));
        let (sine, cosine) = Self::direction(direction);
        let centre = Vector2::new(cosine, sine) * (distance as f64 * self.cell_m);
        SunEstimate { tangents: centre / -self.height_m, information: Matrix2::zeros() }
    }

    /// Returns the position nearest to the shadow by the Sun in a direction.
    fn nearest(&self, estimate: &SunEstimate) -> usize {
        let centre = estimate.tangents * -self.height_m;
        let turns = libm::atan2(centre.y, centre.x) / TAU;
        let directions = f64::from(DIRECTIONS);
        let direction = (turns * directions).round().rem_euclid(directions) as usize;
        let distance = ((centre.norm() / self.cell_m).round() as usize).min(self.reach);
        direction * (self.reach + 1) + distance
    }
}

/// Sums the pixels in the shadow of the post, from its foot up to each distance in cells.
fn sum_post(target: &TargetModel, map: &PlateMap, sine: f64, cosine: f64, post: &mut Vec<PixelSum>) {
    let side_m = 0.25 * target.cross.post_width_m;
    post.clear();
    post.push(PixelSum::default());
    let mut sum = PixelSum::default();
    for step in 0..CELLS / 2 {
        let along_m = (step as f64 + 0.5) * map.cell_m();
        // The two halves of its width.
        for half_m in [-side_m, side_m] {
            let (x_m, y_m) = (cosine * along_m - sine * half_m, sine * along_m + cosine * half_m);
            sum = sum + map.cell_at(x_m, y_m);
        }
        post.push(sum);
    }
}

/// Returns the length of the post's shadow that the bars' shadow hides in a direction, cells.
fn hidden_cells(target: &TargetModel, map: &PlateMap, sine: f64, cosine: f64) -> usize {
    let (half_m, length_m) = (0.5 * target.cross.width_m, target.cross.half_length_m);
    let by_vertical_m = (half_m / cosine.abs()).min(length_m / sine.abs());
    let by_horizontal_m = (length_m / cosine.abs()).min(half_m / sine.abs());
    (by_vertical_m.max(by_horizontal_m) / map.cell_m()) as usize
}

/// Sums the pixels in the shadow of the two bars, whose centre is at (`x_m`, `y_m`).
fn sum_bars(target: &TargetModel, map: &PlateMap, x_m: f64, y_m: f64) -> PixelSum {
    let (half_m, length_m) = (0.5 * target.cross.width_m, target.cross.half_length_m);
    let narrow_x = map.span(x_m, half_m);
    let narrow_y = map.span(y_m, half_m);
    let vertical = map.within(narrow_x, map.span(y_m, length_m));
    let horizontal = map.within(map.span(x_m, length_m), narrow_y);
    vertical + horizontal - map.within(narrow_x, narrow_y)
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
