//! Brightness and image of the sunlit and visible parts of a body of facets.

use std::f64::consts::PI;
use std::ops::Range;

use contract::PixelPoint;
use nalgebra::{Vector2, Vector3};
use optics::ImagePoint;

use super::facet::Facet;
use super::visible::{Piece, visible_pieces};
use crate::polygon::{Polygon, bounds, four_points, keep_above, signed_area, spread};

/// Maximum angle subtended by a cell of the brightness sum, as a share of the angular scale of the
/// reflectance. The sum is then accurate to 1e-6.
const CELL_ANGLE: f64 = 0.25;
/// Maximum number of cells along a side of a facet.
const CELLS: f64 = 512.0;
/// Side of a cell in the image, px; each cell is represented by four points.
const CELL_PX: f64 = 0.4;
/// Span below which an image is drawn as four points with its mean and its second moments, px: the neglected
/// skewness changes each pixel by less than 1e-3 of the peak for a Gaussian of 0.5 px or wider.
const FOUR_POINTS_PX: f64 = 0.2;
/// Span below which an image is drawn as one point, px: this reduces the variance of the image by up to 1e-4
/// px².
const ONE_POINT_PX: f64 = 0.02;

/// The illuminated body at one instant, in the target's body frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LitBody {
    pieces: Vec<Piece>,
    eye_m: Vector3<f64>,
    sun: Vector3<f64>,
}

impl LitBody {
    /// Returns the parts of `facets` that are lit from the direction `sun` (a unit vector) and visible from
    /// `eye_m`.
    pub(super) fn new(facets: &[Facet], eye_m: Vector3<f64>, sun: Vector3<f64>) -> Self {
        Self { pieces: visible_pieces(facets, eye_m, sun), eye_m, sun }
    }

    /// Irradiance at the camera over the Sun's irradiance at the body: Σ f_r cos θᵢ cos θₒ A/r².
    pub(super) fn flux_ratio(&self) -> f64 {
        self.pieces.iter().map(|piece| self.piece_flux(piece)).sum()
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
        if self.is_of_mesh() {
            gather_by_cell(points, first);
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

    /// Flux-weighted mean of the image of all cells that [`LitBody::image`] draws.
    #[cfg(test)]
    pub(super) fn centre(&self, project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>) -> Vector2<f64> {
        let (mut total, mut sum) = (0.0, Vector2::zeros());
        self.for_each_cell(project, 1 << 18, |point, flux| {
            let at = project(&point).unwrap();
            total += flux;
            sum += Vector2::new(at.x, at.y) * flux;
        });
        sum / total
    }

    /// Calls `visit` with each point that represents a cell of the image, and its flux.
    fn for_each_cell(
        &self,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
        count_limit: usize,
        mut visit: impl FnMut(Vector3<f64>, f64),
    ) {
        let sizes: Vec<_> = self.pieces.iter().map(|piece| cells_px(&piece.facet, project)).collect();
        let cells = self.pieces.iter().zip(&sizes).map(|(piece, cells)| piece.cell_count(*cells));
        let shrink = (0.25 * count_limit as f64 / cells.sum::<f64>()).min(1.0).sqrt();
        for (piece, (across, along)) in self.pieces.iter().zip(sizes) {
            let cells = (cell_count(across * shrink), cell_count(along * shrink));
            for_each_point(piece, cells, |point, area| {
                visit(point, self.flux(&piece.facet, &point, area));
            });
        }
    }

    /// Estimates the share of the flux in the brightest pixel, where a point source has the share `psf_share`
    /// in its brightest pixel. Each piece contributes its flux per pixel, limited by its area, and adds to
    /// its neighbours a Gaussian of that peak. The small pieces of a mesh are first joined.
    pub(super) fn peak_share(
        &self,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
        psf_share: f64,
    ) -> Option<f64> {
        let total = self.flux_ratio();
        let mut spots: Vec<Spot> =
            self.pieces.iter().filter_map(|piece| self.spot(piece, total, project)).collect();
        if self.is_of_mesh() {
            spots = joined_spots(spots);
        }
        let peaks: Vec<(Vector2<f64>, f64)> = spots
            .iter()
            .map(|spot| (spot.middle, spot.share * (1.0 / spot.area_px).min(psf_share)))
            .collect();
        let around = |at: &Vector2<f64>| {
            peaks
                .iter()
                .map(|(other, peak)| peak * libm::exp(-PI * psf_share * (other - at).norm_squared()))
                .sum::<f64>()
        };
        peaks.iter().map(|(at, _)| around(at)).reduce(f64::max)
    }

    /// Returns the image of a piece as a spot; `None` if a corner has no image. `total` is the flux of all
    /// pieces.
    fn spot(
        &self,
        piece: &Piece,
        total: f64,
        project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>,
    ) -> Option<Spot> {
        let image_of = |corner: &Vector2<f64>| {
            project(&piece.facet.point_in_body_frame(corner)).map(|at| Vector2::new(at.x, at.y))
        };
        let corners: Polygon = piece.outline.iter().map(image_of).collect::<Option<_>>()?;
        Some(Spot {
            middle: corners.iter().sum::<Vector2<f64>>() / corners.len() as f64,
            area_px: signed_area(&corners).abs(),
            share: self.piece_flux(piece) / total,
        })
    }

    /// Returns true if the body is a mesh.
    fn is_of_mesh(&self) -> bool {
        self.pieces.first().is_some_and(|piece| piece.facet.is_of_mesh())
    }

    fn piece_flux(&self, piece: &Piece) -> f64 {
        let distance = (piece.facet.centre - self.eye_m).norm();
        let cell_m = CELL_ANGLE * piece.facet.front.angular_scale() * distance;
        let cells = (
            cell_count(2.0 * piece.facet.half_width / cell_m),
            cell_count(2.0 * piece.facet.half_height / cell_m),
        );
        let mut sum = 0.0;
        for_each_point(piece, cells, |point, area| sum += self.flux(&piece.facet, &point, area));
        sum
    }

    /// Irradiance at the camera from an area of a facet at a point, divided by the Sun's irradiance at the
    /// body.
    fn flux(&self, facet: &Facet, point: &Vector3<f64>, area: f64) -> f64 {
        let to_eye = self.eye_m - point;
        let distance2 = to_eye.norm_squared();
        let eye = to_eye / distance2.sqrt();
        let cosines = facet.normal.dot(&self.sun) * facet.normal.dot(&eye);
        facet.front.reflectance(&self.sun, &eye, &facet.normal) * cosines * area / distance2
    }
}

/// Calls `visit` with each point that represents a cell of a piece, and the area of that point. The cells
/// form a grid over the facet, with `cells` cells across and along, clipped to the piece.
fn for_each_point(piece: &Piece, cells: (usize, usize), mut visit: impl FnMut(Vector3<f64>, f64)) {
    let facet = &piece.facet;
    let mut visit_cell = |cell: &Polygon| {
        if let Some((area, points)) = four_points(cell) {
            points.iter().for_each(|point| visit(facet.point_in_body_frame(point), 0.25 * area));
        }
    };
    // Most pieces of a mesh are a cell.
    if cells == (1, 1) && facet.is_of_mesh() {
        visit_cell(&piece.outline);
        return;
    }
    let edge = |half: f64, i: usize, n: usize| half * (2.0 * i as f64 / n as f64 - 1.0);
    let (low, high) = bounds(&piece.outline);
    let (mut spare, mut strip, mut cell) = (Polygon::new(), Polygon::new(), Polygon::new());
    for i in cells_between(low.x, high.x, facet.half_width, cells.0) {
        let (left, right) = (edge(facet.half_width, i, cells.0), edge(facet.half_width, i + 1, cells.0));
        keep_above(&piece.outline, &mut spare, |p| p.x - left);
        keep_above(&spare, &mut strip, |p| right - p.x);
        if strip.len() < 3 {
            continue;
        }
        let (low, high) = bounds(&strip);
        for j in cells_between(low.y, high.y, facet.half_height, cells.1) {
            let (low, high) = (edge(facet.half_height, j, cells.1), edge(facet.half_height, j + 1, cells.1));
            keep_above(&strip, &mut spare, |p| p.y - low);
            keep_above(&spare, &mut cell, |p| high - p.y);
            visit_cell(&cell);
        }
    }
}

/// Returns the cells of a side of length 2 `half`, of `count` cells, that a piece from `low` to `high` may
/// touch.
fn cells_between(low: f64, high: f64, half: f64, count: usize) -> Range<usize> {
    // One cell more on either side, for rounding. A negative number becomes 0.
    let position = |at: f64| (at / half + 1.0) * 0.5 * count as f64;
    let first = (position(low) - 1.0).floor() as usize;
    let end = (position(high) + 1.0).ceil() as usize;
    first.min(count)..end.min(count)
}

/// Number of cells of 0.4 px that a facet needs across and along.
fn cells_px(facet: &Facet, project: &impl Fn(&Vector3<f64>) -> Option<PixelPoint>) -> (f64, f64) {
    let side = |from: Vector2<f64>, to: Vector2<f64>| {
        project(&facet.point_in_body_frame(&from))
            .zip(project(&facet.point_in_body_frame(&to)))
            .map_or(CELLS, |(a, b)| a.distance(b) / CELL_PX)
    };
    let (x, y) = (facet.half_width, facet.half_height);
    (
        side(Vector2::new(-x, 0.0), Vector2::new(x, 0.0)).min(CELLS),
        side(Vector2::new(0.0, -y), Vector2::new(0.0, y)).min(CELLS),
    )
}

fn cell_count(cells: f64) -> usize {
    cells.ceil().clamp(1.0, CELLS) as usize
}

/// Side of a cell of joined spots, px, and the maximum number of cells along a side.
const SPOT_PX: f64 = 1.0;
const SPOTS: f64 = 32.0;

/// Image of a piece, or of several: its middle, px, its area, px², and its share of the flux.
#[derive(Debug, Clone, Copy)]
struct Spot {
    middle: Vector2<f64>,
    area_px: f64,
    share: f64,
}

/// Joins the spots in each cell of a grid. The cells are small beside the point-spread function, or no more
/// than a few per cent of the body.
fn joined_spots(mut spots: Vec<Spot>) -> Vec<Spot> {
    let (low, high) = bounds(&spots.iter().map(|spot| spot.middle).collect::<Polygon>());
    let side = ((high - low).amax() / SPOTS).max(SPOT_PX);
    let cell = |spot: &Spot| ((spot.middle - low) / side).map(|position| position as u64);
    spots.sort_by_key(|spot| (cell(spot).y, cell(spot).x));
    let join = |spots: &[Spot]| {
        let share: f64 = spots.iter().map(|spot| spot.share).sum();
        let moment: Vector2<f64> = spots.iter().map(|spot| spot.middle * spot.share).sum();
        Spot { middle: moment / share, area_px: spots.iter().map(|spot| spot.area_px).sum(), share }
    };
    spots.chunk_by(|one, other| cell(one) == cell(other)).map(join).filter(|spot| spot.share > 0.0).collect()
}

/// Maximum number of cells of the image along a side, and over the body; the cells grow if more would be
/// needed.
const MAX_CELLS_ACROSS: f64 = 4096.0;
const MAX_CELLS: f64 = (1 << 18) as f64;

/// Replaces the points from `first` on, in each cell of the image, by four points: many facets of a mesh may
/// share a cell.
fn gather_by_cell(points: &mut Vec<ImagePoint>, first: usize) {
    let all = points.split_off(first);
    let (low, high) = bounds(&all.iter().map(|point| at(point.position)).collect::<Polygon>());
    let size = high - low;
    let side = (size.amax() / MAX_CELLS_ACROSS).max((size.product() / MAX_CELLS).sqrt()).max(CELL_PX);
    let columns = (size.x / side) as usize + 1;
    let rows = (size.y / side) as usize + 1;
    let cell = |point: &ImagePoint| {
        let place = (at(point.position) - low) / side;
        (place.y as usize).min(rows - 1) * columns + (place.x as usize).min(columns - 1)
    };
    // Counting sort: first the start of each cell's part, which becomes its end as the part is filled.
    let cells: Vec<usize> = all.iter().map(cell).collect();
    let mut ends = vec![0_usize; rows * columns + 1];
    for cell in &cells {
        ends[cell + 1] += 1;
    }
    for cell in 1..ends.len() {
        ends[cell] += ends[cell - 1];
    }
    let mut sorted = all.clone();
    for (point, cell) in all.iter().zip(cells) {
        sorted[ends[cell]] = *point;
        ends[cell] += 1;
    }
    let mut start = 0;
    for end in ends {
        let part = &sorted[start..end];
        if part.len() > 4 {
            points.extend(Moments::of(part).four_points());
        } else {
            points.extend(part);
        }
        start = end;
    }
}

/// Returns a position of the image as a vector, px.
fn at(position: PixelPoint) -> Vector2<f64> {
    Vector2::new(position.x, position.y)
}

/// Replaces the points from `first` on by one or four points if they span little.
pub(super) fn gather(points: &mut Vec<ImagePoint>, first: usize) {
    let Some(origin) = points.get(first).map(|point| point.position) else { return };
    let span = points[first..].iter().fold(0.0_f64, |span, point| {
        span.max(Vector2::new(point.position.x - origin.x, point.position.y - origin.y).amax())
    });
    if span >= FOUR_POINTS_PX {
        return;
    }
    let moments = Moments::of(&points[first..]);
    points.truncate(first);
    if span < ONE_POINT_PX {
        points.push(ImagePoint { position: moments.position(moments.mean), share: moments.share });
    } else {
        points.extend(moments.four_points());
    }
}

/// Sum of the shares of some points, their mean from an origin, px, and their second moments [xx, xy, yy]
/// about the mean, px².
#[derive(Debug, Clone, Copy)]
struct Moments {
    share: f64,
    origin: PixelPoint,
    mean: Vector2<f64>,
    squares: [f64; 3],
}

impl Moments {
    /// Returns the moments of points; the first one is the origin.
    fn of(points: &[ImagePoint]) -> Self {
        let origin = points.first().map_or_else(PixelPoint::default, |point| point.position);
        let (mut share, mut sum, mut squares) = (0.0, Vector2::zeros(), [0.0; 3]);
        for point in points {
            let d = Vector2::new(point.position.x - origin.x, point.position.y - origin.y);
            share += point.share;
            sum += d * point.share;
            for (square, product) in squares.iter_mut().zip([d.x * d.x, d.x * d.y, d.y * d.y]) {
                *square += point.share * product;
            }
        }
        let mean = sum / share;
        let products = [mean.x * mean.x, mean.x * mean.y, mean.y * mean.y];
        Self { share, origin, mean, squares: [0, 1, 2].map(|i| squares[i] / share - products[i]) }
    }

    /// Returns the position in the image at an offset from the origin.
    fn position(&self, offset: Vector2<f64>) -> PixelPoint {
        PixelPoint::new(self.origin.x + offset.x, self.origin.y + offset.y)
    }

    /// Returns four points with these moments.
    fn four_points(&self) -> [ImagePoint; 4] {
        spread(self.mean, self.squares)
            .map(|at| ImagePoint { position: self.position(at), share: 0.25 * self.share })
    }
}
