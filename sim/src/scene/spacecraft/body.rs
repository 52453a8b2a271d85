//! Which parts of a body of plates are lit by the Sun and seen by the camera, and how bright they are.
//!
//! Shadows and occlusions are exact: the shadow that a plate casts on another, and the part of it that it hides, are convex
//! polygons, and are subtracted as such. Neglected: the width of the Sun (a shadow cast over 1 m has a fringe of 9 mm; a
//! glint is no narrower than `roughness`), and light that goes from plate to plate.

use std::f64::consts::PI;

use nalgebra::{Vector2, Vector3};

use super::plate::Plate;
use super::polygon::{Polygon, clip, four_points, signed_area, spread, subtract};
use crate::optics::ImagePoint;
use contract::PixelPoint;

/// Sine of the angle above a plate below which Sun and camera are taken to be in its plane.
const GRAZING: f64 = 1e-6;
/// A point of another plate is above a plate from this height on, m: what touches casts no shadow.
const TOUCHING_M: f64 = 1e-9;
/// Slivers below this share of a plate's area are dropped.
const SLIVER: f64 = 1e-12;
/// A cell of the sum for the brightness is seen under an angle of at most this share of the angular scale of the
/// reflectance: the sum is then good to 1e-6.
const CELL_ANGLE: f64 = 0.25;
/// Cells along a side of a plate, at most.
const CELLS: f64 = 512.0;
/// Sides of a cell in the image, px; four points stand for it.
const CELL_PX: f64 = 0.4;
/// An image that spans less is drawn as four points with its mean and its second moments: its skewness changes no pixel of
/// a Gaussian of 0.5 px or wider by 1e-3 of the peak.
const FOUR_POINTS_PX: f64 = 0.2;
/// One that spans less is drawn as one point: that takes up to 1e-4 px² from the variance of its image.
const ONE_POINT_PX: f64 = 0.02;

/// A convex part of a plate that is lit and seen.
#[derive(Debug, Clone, PartialEq)]
struct Facet {
    /// With its front towards the camera.
    plate: Plate,
    outline: Polygon,
}

/// The body in the light of one moment, in the target's body frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LitBody {
    facets: Vec<Facet>,
    eye_m: Vector3<f64>,
    sun: Vector3<f64>,
}

impl LitBody {
    /// The parts of `plates` that are lit from the direction `sun` (a unit vector) and seen from `eye_m`.
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

    /// The undisturbed image: points whose shares add up to 1, `count_limit` or so at most (cells grow beyond
    /// 0.4 px when they would be more; every facet has four). `project` gives the place of a point of the body frame.
    /// Nothing when no light comes from it.
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

    /// The sum of the light of the cells that [`LitBody::image`] draws.
    #[cfg(test)]
    pub(super) fn cells_flux(&self, project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>) -> f64 {
        let mut total = 0.0;
        self.for_each_cell(project, 1 << 18, |_, flux| total += flux);
        total
    }

    /// Calls `visit` with the points that stand for the cells of the image, and the light of each.
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

    /// An estimate of the share of the light that falls in the brightest pixel, when `psf_share` of a point's does: each facet
    /// adds what it sends into a pixel, not more than its area allows, to its neighbours as a Gaussian of that peak
    /// would.
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

    /// Irradiance at the camera from an area of a plate at a point, over the Sun's at the body.
    fn flux(&self, plate: &Plate, point: &Vector3<f64>, area: f64) -> f64 {
        let to_eye = self.eye_m - point;
        let distance2 = to_eye.norm_squared();
        let eye = to_eye / distance2.sqrt();
        let cosines = plate.normal.dot(&self.sun) * plate.normal.dot(&eye);
        plate.front.reflectance(&self.sun, &eye, &plate.normal) * cosines * area / distance2
    }
}

/// The plate with its front towards the camera; `None` when that side is dark, or black.
fn facing(plate: &Plate, eye_m: &Vector3<f64>, sun: &Vector3<f64>) -> Option<Plate> {
    let eye = (eye_m - plate.centre).normalize().dot(&plate.normal);
    let sun = sun.dot(&plate.normal);
    let lit = eye * sun > 0.0 && eye.abs() > GRAZING && sun.abs() > GRAZING;
    let plate = if eye > 0.0 { *plate } else { plate.turned(plate.back?) };
    (lit && plate.front.diffuse + plate.front.specular > 0.0).then_some(plate)
}

/// Takes from the `pieces` of a plate what `other` shades and what it hides.
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
    // What is as high as the camera hides nothing.
    let eye = plate.local(eye_m);
    let below = clip(&above, |corner| 0.999 * eye.z - corner.z);
    let mut hidden: Polygon = below
        .iter()
        .map(|corner| eye.xy() + (corner.xy() - eye.xy()) * (eye.z / (eye.z - corner.z)))
        .collect();
    subtract(pieces, &mut hidden, least_area);
}

/// Calls `visit` with the points that stand for the cells of a facet, and the area that each stands for. The cells
/// are those of a grid over the plate, so many across and along, as far as the facet covers them.
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

/// Cells that a plate needs across and along for cells of 0.4 px.
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

/// Replaces the points from `first` on by fewer when they span little.
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
