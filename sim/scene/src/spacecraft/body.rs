//! Sunlit and visible parts of a body of plates, and their brightness.
//!
//! Shadows and occlusions are exact: the shadow that a plate casts on another plate, and the part of it that
//! the plate hides, are convex polygons and are subtracted as polygons. Neglected: the angular width of the
//! Sun (a shadow cast over 1 m has a fringe of 9 mm; a glint is no narrower than `roughness`) and reflections
//! between plates.

use std::f64::consts::PI;

use contract::PixelPoint;
use nalgebra::{Vector2, Vector3};
use optics::ImagePoint;

use super::plate::Plate;
use super::polygon::{Polygon, clip, four_points, signed_area, spread, subtract};

/// Sine of the elevation above a plate below which Sun or camera count as lying in the plate's plane.
const MIN_ELEVATION_SINE: f64 = 1e-6;
/// Minimum height above a plate, m, from which a point of another plate counts as above it: a touching plate
/// casts no shadow.
const TOUCHING_M: f64 = 1e-9;
/// Share of a plate's area below which a sliver is dropped.
const SLIVER: f64 = 1e-12;
/// Maximum angle subtended by a cell of the brightness sum, as a share of the angular scale of the
/// reflectance. The sum is then accurate to 1e-6.
const CELL_ANGLE: f64 = 0.25;
/// Maximum number of cells along a side of a plate.
const CELLS: f64 = 512.0;
/// Side of a cell in the image, px; each cell is represented by four points.
const CELL_PX: f64 = 0.4;
/// Span below which an image is drawn as four points with its mean and its second moments, px: the neglected
/// skewness changes each pixel by less than 1e-3 of the peak for a Gaussian of 0.5 px or wider.
const FOUR_POINTS_PX: f64 = 0.2;
/// Span below which an image is drawn as one point, px: this reduces the variance of the image by up to 1e-4
/// px².
const ONE_POINT_PX: f64 = 0.02;

/// Convex, sunlit and visible part of a plate.
#[derive(Debug, Clone, PartialEq)]
struct Facet {
    /// The plate, its front towards the camera.
    plate: Plate,
    outline: Polygon,
}

/// The illuminated body at one instant, in the target's body frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LitBody {
    facets: Vec<Facet>,
    eye_m: Vector3<f64>,
    sun: Vector3<f64>,
}

impl LitBody {
    /// Returns the parts of `plates` that are lit from the direction `sun` (a unit vector) and visible from
    /// `eye_m`.
    pub(super) fn new(plates: &[Plate], eye_m: Vector3<f64>, sun: Vector3<f64>) -> Self {
        let mut facets = Vec::new();
        for (i, plate) in plates.iter().enumerate() {
            let Some(plate) = facing(plate, &eye_m, &sun) else { continue };
            let mut pieces = vec![plate.outline()];
            for (_, other) in plates.iter().enumerate().filter(|(j, _)| *j != i) {
                subtract_shadow_and_occlusion(&plate, other, &eye_m, &sun, &mut pieces);
            }
            facets.extend(pieces.into_iter().map(|outline| Facet { plate, outline }));
        }
        Self { facets, eye_m, sun }
    }

    /// Irradiance at the camera over the Sun's irradiance at the body: Σ f_r cos θᵢ cos θₒ A/r².
    pub(super) fn flux_ratio(&self) -> f64 {
        self.facets.iter().map(|facet| self.facet_flux(facet)).sum()
    }

    /// Appends the points of the undistorted image. Their shares add up to 1. There are about `count_limit`
    /// points at most: cells larger than 0.4 px are used if more would be needed, and every facet has at
    /// least four points. `project` maps a point of the body frame to the image. Appends nothing if no flux
    /// reaches the camera.
    pub(super) fn image(
        &self,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
        count_limit: usize,
        points: &mut Vec<ImagePoint>,
    ) {
        let first = points.len();
        let mut total = 0.0;
        self.for_each_cell(project, count_limit, |point, flux| {
            total += flux;
            if let Some(position) = project(&point) {
                points.push(ImagePoint { position, share: flux });
            }
        });
        if total > 0.0 {
            points[first..].iter_mut().for_each(|point| point.share /= total);
        }
        gather(points, first);
    }

    /// Sum of the flux of all cells that [`LitBody::image`] draws.
    #[cfg(test)]
    pub(super) fn cells_flux(&self, project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>) -> f64 {
        let mut total = 0.0;
        self.for_each_cell(project, 1 << 18, |_, flux| total += flux);
        total
    }

    /// Calls `visit` with each point that represents a cell of the image, and its flux.
    fn for_each_cell(
        &self,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
        count_limit: usize,
        mut visit: impl FnMut(Vector3<f64>, f64),
    ) {
        let sizes: Vec<_> = self.facets.iter().map(|facet| cells_px(&facet.plate, project)).collect();
        let count: f64 = sizes.iter().map(|(across, along)| (across * along).max(1.0)).sum();
        let shrink = (0.25 * count_limit as f64 / count).min(1.0).sqrt();
        for (facet, (across, along)) in self.facets.iter().zip(sizes) {
            let cells = (cell_count(across * shrink), cell_count(along * shrink));
            for_each_point(facet, cells, |point, area| {
                visit(point, self.flux(&facet.plate, &point, area));
            });
        }
    }

    /// Estimates the share of the flux in the brightest pixel, where a point source has the share `psf_share`
    /// in its brightest pixel. Each facet contributes its flux per pixel, limited by its area, and adds to
    /// its neighbours a Gaussian of that peak.
    pub(super) fn peak_share(
        &self,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
        psf_share: f64,
    ) -> Option<f64> {
        let total = self.flux_ratio();
        let peaks: Vec<(Vector2<f64>, f64)> = self
            .facets
            .iter()
            .filter_map(|facet| {
                let corners: Option<Polygon> = facet
                    .outline
                    .iter()
                    .map(|corner| {
                        project(&facet.plate.point_in_body_frame(corner)).map(|at| Vector2::new(at.x, at.y))
                    })
                    .collect();
                let corners = corners?;
                let middle = corners.iter().sum::<Vector2<f64>>() / corners.len() as f64;
                let density = (1.0 / signed_area(&corners).abs()).min(psf_share);
                Some((middle, self.facet_flux(facet) / total * density))
            })
            .collect();
        let around = |at: &Vector2<f64>| {
            peaks
                .iter()
                .map(|(other, peak)| peak * libm::exp(-PI * psf_share * (other - at).norm_squared()))
                .sum::<f64>()
        };
        peaks.iter().map(|(at, _)| around(at)).reduce(f64::max)
    }

    fn facet_flux(&self, facet: &Facet) -> f64 {
        let distance = (facet.plate.centre - self.eye_m).norm();
        let cell_m = CELL_ANGLE * facet.plate.front.angular_scale() * distance;
        let cells = (
            cell_count(2.0 * facet.plate.half_width / cell_m),
            cell_count(2.0 * facet.plate.half_height / cell_m),
        );
        let mut sum = 0.0;
        for_each_point(facet, cells, |point, area| sum += self.flux(&facet.plate, &point, area));
        sum
    }

    /// Irradiance at the camera from an area of a plate at a point, divided by the Sun's irradiance at the
    /// body.
    fn flux(&self, plate: &Plate, point: &Vector3<f64>, area: f64) -> f64 {
        let to_eye = self.eye_m - point;
        let distance2 = to_eye.norm_squared();
        let eye = to_eye / distance2.sqrt();
        let cosines = plate.normal.dot(&self.sun) * plate.normal.dot(&eye);
        plate.front.reflectance(&self.sun, &eye, &plate.normal) * cosines * area / distance2
    }
}

/// Returns the plate with its front towards the camera; `None` if that side is unlit or black.
fn facing(plate: &Plate, eye_m: &Vector3<f64>, sun: &Vector3<f64>) -> Option<Plate> {
    let eye = (eye_m - plate.centre).normalize().dot(&plate.normal);
    let sun = sun.dot(&plate.normal);
    let lit = eye * sun > 0.0 && eye.abs() > MIN_ELEVATION_SINE && sun.abs() > MIN_ELEVATION_SINE;
    let plate = if eye > 0.0 { *plate } else { plate.turned(plate.back?) };
    (lit && plate.front.diffuse + plate.front.specular > 0.0).then_some(plate)
}

/// Removes from the `pieces` of a plate the parts that `other` shades or hides.
fn subtract_shadow_and_occlusion(
    plate: &Plate,
    other: &Plate,
    eye_m: &Vector3<f64>,
    sun: &Vector3<f64>,
    pieces: &mut Vec<Polygon>,
) {
    let corners: Vec<_> =
        other.outline().iter().map(|corner| plate.local(&other.point_in_body_frame(corner))).collect();
    let above = clip(&corners, |corner| corner.z - TOUCHING_M);
    if above.len() < 3 {
        return;
    }
    let least_area = SLIVER * 4.0 * plate.half_width * plate.half_height;
    let ray = Vector3::new(sun.dot(&plate.right), sun.dot(&plate.up), sun.dot(&plate.normal));
    let mut shadow: Polygon =
        above.iter().map(|corner| corner.xy() - ray.xy() * (corner.z / ray.z)).collect();
    subtract(pieces, &mut shadow, least_area);
    // Points at the camera's height above the plate hide nothing.
    let eye = plate.local(eye_m);
    let below = clip(&above, |corner| 0.999 * eye.z - corner.z);
    let mut hidden: Polygon = below
        .iter()
        .map(|corner| eye.xy() + (corner.xy() - eye.xy()) * (eye.z / (eye.z - corner.z)))
        .collect();
    subtract(pieces, &mut hidden, least_area);
}

/// Calls `visit` with each point that represents a cell of a facet, and the area of that point. The cells
/// form a grid over the plate, with `cells` cells across and along, clipped to the facet.
fn for_each_point(facet: &Facet, cells: (usize, usize), mut visit: impl FnMut(Vector3<f64>, f64)) {
    let plate = &facet.plate;
    let edge = |half: f64, i: usize, n: usize| half * (2.0 * i as f64 / n as f64 - 1.0);
    for i in 0..cells.0 {
        let (left, right) = (edge(plate.half_width, i, cells.0), edge(plate.half_width, i + 1, cells.0));
        let strip = clip(&clip(&facet.outline, |p| p.x - left), |p| right - p.x);
        if strip.len() < 3 {
            continue;
        }
        for j in 0..cells.1 {
            let (low, high) = (edge(plate.half_height, j, cells.1), edge(plate.half_height, j + 1, cells.1));
            let cell = clip(&clip(&strip, |p| p.y - low), |p| high - p.y);
            if let Some((area, points)) = four_points(&cell) {
                points.iter().for_each(|point| visit(plate.point_in_body_frame(point), 0.25 * area));
            }
        }
    }
}

/// Number of cells of 0.4 px that a plate needs across and along.
fn cells_px(plate: &Plate, project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>) -> (f64, f64) {
    let side = |from: Vector2<f64>, to: Vector2<f64>| {
        project(&plate.point_in_body_frame(&from))
            .zip(project(&plate.point_in_body_frame(&to)))
            .map_or(CELLS, |(a, b)| a.distance(b) / CELL_PX)
    };
    let (x, y) = (plate.half_width, plate.half_height);
    (
        side(Vector2::new(-x, 0.0), Vector2::new(x, 0.0)).min(CELLS),
        side(Vector2::new(0.0, -y), Vector2::new(0.0, y)).min(CELLS),
    )
}

fn cell_count(cells: f64) -> usize {
    cells.ceil().clamp(1.0, CELLS) as usize
}

/// Replaces the points from `first` on by one or four points if they span little.
pub(super) fn gather(points: &mut Vec<ImagePoint>, first: usize) {
    let Some(origin) = points.get(first).map(|point| point.position) else { return };
    let from_origin =
        |point: &ImagePoint| Vector2::new(point.position.x - origin.x, point.position.y - origin.y);
    let span = points[first..].iter().fold(0.0_f64, |span, point| span.max(from_origin(point).amax()));
    if span >= FOUR_POINTS_PX {
        return;
    }
    let (mut share, mut sum, mut squares) = (0.0, Vector2::zeros(), [0.0; 3]);
    for point in points.drain(first..) {
        let d = from_origin(&point);
        share += point.share;
        sum += d * point.share;
        for (square, product) in squares.iter_mut().zip([d.x * d.x, d.x * d.y, d.y * d.y]) {
            *square += point.share * product;
        }
    }
    let mean = sum / share;
    let products = [mean.x * mean.x, mean.x * mean.y, mean.y * mean.y];
    let pixel = |d: Vector2<f64>| PixelPoint::new(origin.x + d.x, origin.y + d.y);
    if span < ONE_POINT_PX {
        points.push(ImagePoint { position: pixel(mean), share });
    } else {
        let moments = [0, 1, 2].map(|i| squares[i] / share - products[i]);
        points
            .extend(spread(mean, moments).map(|at| ImagePoint { position: pixel(at), share: 0.25 * share }));
    }
}
