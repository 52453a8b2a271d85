//! Outlines as the camera sees them: pose, pinhole projection, distortion.

use contract::docking::Pose;
use contract::{Camera, PixelPoint};
use nalgebra::{Matrix3, Rotation3, Vector3};
use optics::Projection;
use truth::SimError;

use super::bounds::Sphere;
use super::coverage::Window;
use scene::polygon::keep_above;

/// Camera without its pose.
#[derive(Debug, Clone)]
pub(super) struct Lens {
    projection: Projection,
    focal_px: [f64; 2],
    /// Principal point, px from the corner of the first pixel.
    principal: [f64; 2],
    /// Bounds of the undistorted offsets from the principal point that can reach the image, px; `None`
    /// without distortion.
    reach: Option<Reach>,
    /// Map from distorted positions back to undistorted offsets; `None` without distortion.
    offsets: Option<OffsetGrid>,
}

#[derive(Debug, Clone, Copy)]
struct Reach {
    low: [f64; 2],
    high: [f64; 2],
}

impl Lens {
    /// Distance along the optical axis, m; nearer objects are not drawn.
    const NEAR_M: f64 = 1e-3;
    /// Largest distance between a curved edge and the chords that approximate it, px.
    const SAGITTA_PX: f64 = 1e-3;
    const MAX_CHORDS: f64 = 256.0;

    pub(super) fn new(camera: &Camera) -> Result<Self, SimError> {
        let projection = Projection::new(camera)?;
        let (fx, fy) = camera.focal_length_px();
        let mut lens = Self {
            projection,
            focal_px: [fx, fy],
            principal: [camera.principal_x_px + 0.5, camera.principal_y_px + 0.5],
            reach: None,
            offsets: None,
        };
        if lens.projection.is_distorted() {
            lens.reach = Some(lens.reach_of(camera));
            lens.offsets = Some(OffsetGrid::new(&lens, camera));
        }
        Ok(lens)
    }

    /// Creates the lens for outlines that reach beyond the picture by up to its size on each side. Where the
    /// distortion is not one-to-one it is continued in proportion ([`Projection::pixel_position`]).
    pub(super) fn beyond_picture(camera: &Camera) -> Result<Self, SimError> {
        const TIMES: f64 = 4.0;
        let mut lens = Self::new(camera)?;
        if let Some(reach) = &mut lens.reach {
            reach.low = reach.low.map(|offset| TIMES * offset);
            reach.high = reach.high.map(|offset| TIMES * offset);
        }
        Ok(lens)
    }

    /// Returns the bounds of the detector's border after removal of the distortion, with a margin.
    fn reach_of(&self, camera: &Camera) -> Reach {
        const POINTS: usize = 129;
        const MARGIN_PX: f64 = 8.0;
        let (width, height) = (camera.columns as f64, camera.rows as f64);
        let mut reach = Reach { low: [0.0; 2], high: [0.0; 2] };
        for i in 0..POINTS {
            let t = i as f64 / (POINTS - 1) as f64;
            for (across, down) in [(t, 0.0), (t, 1.0), (0.0, t), (1.0, t)] {
                let offset = self.offset_of([across * width, down * height]);
                for (axis, along) in offset.into_iter().enumerate() {
                    reach.low[axis] = reach.low[axis].min(along - MARGIN_PX);
                    reach.high[axis] = reach.high[axis].max(along + MARGIN_PX);
                }
            }
        }
        reach
    }

    /// Returns the undistorted offset of a detector point from the principal point, px.
    fn offset_of(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        if !self.projection.is_distorted() {
            return [x - self.principal[0], y - self.principal[1]];
        }
        // Every point on the detector has a direction.
        self.projection.unproject(PixelPoint::new(x - 0.5, y - 0.5)).map_or([0.0; 2], |direction| {
            let ray = direction.vector();
            [self.focal_px[0] * ray.x / ray.z, self.focal_px[1] * ray.y / ray.z]
        })
    }

    /// Returns the direction (camera frame, third component 1) that projects to a point of the detector, px
    /// from the corner of the first pixel.
    pub(super) fn ray(&self, point: [f64; 2]) -> Vector3<f64> {
        let [u, v] = match &self.offsets {
            Some(grid) => grid.offset_at(point),
            None => self.offset_of(point),
        };
        Vector3::new(u / self.focal_px[0], v / self.focal_px[1], 1.0)
    }

    /// Returns the smallest and the largest undistorted offsets from the principal point in a window, px;
    /// with distortion, bounds that enclose them.
    fn offsets_of(&self, window: Window) -> ([f64; 2], [f64; 2]) {
        let low = [window.left as f64, window.top as f64];
        let high = [window.right as f64, window.bottom as f64];
        let Some(grid) = &self.offsets else {
            return (self.offset_of(low), self.offset_of(high));
        };
        grid.reach(low, high)
    }

    fn pixel_position(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        if self.reach.is_none() {
            return [self.principal[0] + u, self.principal[1] + v];
        }
        let point = self.projection.pixel_position(u, v);
        [point.x + 0.5, point.y + 0.5]
    }
}

/// Undistorted offsets at the nodes of a grid over the detector, interpolated bilinearly between the nodes.
/// Accurate to 1e-2 px where the distortion over the whole field is some percent: enough for the illumination
/// by a lamp, which changes over many pixels.
#[derive(Debug, Clone)]
struct OffsetGrid {
    step: [f64; 2],
    cells: [usize; 2],
    nodes: Vec<[f64; 2]>,
}

impl OffsetGrid {
    const CELL_PX: usize = 16;
    /// Margin added to the offsets of a rectangle, px: larger than the error of the grid, and than the
    /// curvature of a border within a cell.
    const MARGIN_PX: f64 = 2.0;

    fn new(lens: &Lens, camera: &Camera) -> Self {
        let cells = [camera.columns, camera.rows].map(|side| side.div_ceil(Self::CELL_PX));
        let step = [camera.columns as f64 / cells[0] as f64, camera.rows as f64 / cells[1] as f64];
        let nodes = (0..=cells[1])
            .flat_map(|j| (0..=cells[0]).map(move |i| [i as f64 * step[0], j as f64 * step[1]]))
            .map(|point| lens.offset_of(point))
            .collect();
        Self { step, cells, nodes }
    }

    /// Returns bounds of the offsets in a rectangle, from points on its border at the grid's spacing.
    fn reach(&self, low: [f64; 2], high: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let coordinates = |axis: usize| {
            let steps = ((high[axis] - low[axis]) / self.step[axis]).ceil().max(1.0);
            (0..=steps as usize).map(move |i| low[axis] + (high[axis] - low[axis]) * i as f64 / steps)
        };
        let across = coordinates(0).flat_map(|x| [[x, low[1]], [x, high[1]]]);
        let down = coordinates(1).flat_map(|y| [[low[0], y], [high[0], y]]);
        let nothing = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        across.chain(down).map(|point| self.offset_at(point)).fold(nothing, |(low, high), offset| {
            (
                [0, 1].map(|axis| low[axis].min(offset[axis] - Self::MARGIN_PX)),
                [0, 1].map(|axis| high[axis].max(offset[axis] + Self::MARGIN_PX)),
            )
        })
    }

    fn offset_at(&self, point: [f64; 2]) -> [f64; 2] {
        let grid_position = [0, 1].map(|axis| {
            let along = point[axis] / self.step[axis];
            let cell = (along.max(0.0) as usize).min(self.cells[axis] - 1);
            (cell, along - cell as f64)
        });
        let [(i, s), (j, t)] = grid_position;
        let node = |i: usize, j: usize| self.nodes[j * (self.cells[0] + 1) + i];
        [0, 1].map(|axis| {
            let upper = node(i, j)[axis] + s * (node(i + 1, j)[axis] - node(i, j)[axis]);
            let lower = node(i, j + 1)[axis] + s * (node(i + 1, j + 1)[axis] - node(i, j + 1)[axis]);
            upper + t * (lower - upper)
        })
    }
}

/// A camera with its pose.
#[derive(Debug, Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) lens: &'a Lens,
    /// Position d of the camera, m, target frame.
    pub(super) position: Vector3<f64>,
    /// Attitude A of the camera: target frame from camera frame.
    pub(super) attitude: Matrix3<f64>,
    camera_from_target: Matrix3<f64>,
}

impl<'a> View<'a> {
    pub(super) fn new(lens: &'a Lens, pose: &Pose) -> Self {
        let ideal = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        let attitude = ideal * Rotation3::new(pose.phi_rad).into_inner();
        Self { lens, position: pose.position_m, attitude, camera_from_target: attitude.transpose() }
    }

    /// Creates the view of points that are given in the camera frame.
    pub(super) fn in_camera_frame(lens: &'a Lens) -> Self {
        let (attitude, camera_from_target) = (Matrix3::identity(), Matrix3::identity());
        Self { lens, position: Vector3::zeros(), attitude, camera_from_target }
    }

    /// Returns the borders of a window of the image as planes through the camera: their outward normals,
    /// target frame. With distortion they enclose the window with a margin of some pixels.
    pub(super) fn borders(&self, window: Window) -> [Vector3<f64>; 4] {
        let ([left, top], [right, bottom]) = self.lens.offsets_of(window);
        let [fx, fy] = self.lens.focal_px;
        [
            Vector3::new(-fx, 0.0, left),
            Vector3::new(fx, 0.0, -right),
            Vector3::new(0.0, -fy, top),
            Vector3::new(0.0, fy, -bottom),
        ]
        .map(|normal| self.attitude * normal)
    }

    /// Returns true if part of a sphere may lie in front of the camera.
    pub(super) fn may_see(&self, sphere: &Sphere) -> bool {
        (sphere.centre - self.position).dot(&self.attitude.column(2)) + sphere.radius > Lens::NEAR_M
    }
}

/// Smallest axis-aligned rectangle that contains some points of the image, px.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    low: [f64; 2],
    high: [f64; 2],
}

impl Bounds {
    pub(super) const EMPTY: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    pub(super) fn with(self, other: Self) -> Self {
        Self {
            low: [self.low[0].min(other.low[0]), self.low[1].min(other.low[1])],
            high: [self.high[0].max(other.high[0]), self.high[1].max(other.high[1])],
        }
    }

    /// Returns the pixels of the rectangle inside another window; `None` if there are none.
    pub(super) fn window(self, within: Window) -> Option<Window> {
        let window = Window {
            left: within.left.max(self.low[0].max(0.0) as usize),
            right: within.right.min(self.high[0].max(0.0).ceil() as usize),
            top: within.top.max(self.low[1].max(0.0) as usize),
            bottom: within.bottom.min(self.high[1].max(0.0).ceil() as usize),
        };
        (window.left < window.right && window.top < window.bottom).then_some(window)
    }
}

/// Polygons in the image, px from the corner of the first pixel.
#[derive(Debug, Clone, Default)]
pub(super) struct Outlines {
    points: Vec<[f64; 2]>,
    /// End index of each polygon in the points.
    ends: Vec<usize>,
    cut: [Vec<Vector3<f64>>; 2],
    offsets: Vec<[f64; 2]>,
}

impl Outlines {
    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.ends.clear();
    }

    /// Returns the number of polygons.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// Removes all polygons after the first `len`.
    pub(super) fn truncate(&mut self, len: usize) {
        self.ends.truncate(len);
        self.points.truncate(self.ends.last().copied().unwrap_or(0));
    }

    pub(super) fn polygon(&self, index: usize) -> &[[f64; 2]] {
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        &self.points[start..self.ends[index]]
    }

    /// Adds the image of a polygon of the target frame, and returns its bounds.
    pub(super) fn push(&mut self, view: &View<'_>, polygon: &[Vector3<f64>]) -> Bounds {
        let [seen, spare] = &mut self.cut;
        seen.clear();
        seen.extend(polygon.iter().map(|point| view.camera_from_target * (point - view.position)));
        if seen.iter().any(|point| point.z < Lens::NEAR_M) {
            keep_above(seen, spare, |point| point.z - Lens::NEAR_M);
            std::mem::swap(seen, spare);
        }
        let lens = view.lens;
        let [fx, fy] = lens.focal_px;
        if let Some(Reach { low, high }) = lens.reach {
            for (focal, axis) in [(fx, 0), (fy, 1)] {
                keep_above(seen, spare, |point| focal * point[axis] - low[axis] * point.z);
                keep_above(spare, seen, |point| high[axis] * point.z - focal * point[axis]);
            }
        }
        let offset = |point: &Vector3<f64>| [fx * (point.x / point.z), fy * (point.y / point.z)];
        let start = self.points.len();
        if lens.reach.is_none() {
            self.points.extend(seen.iter().map(|point| lens.pixel_position(offset(point))));
        } else {
            self.offsets.clear();
            self.offsets.extend(seen.iter().map(offset));
            let ends = self.offsets.iter().zip(self.offsets.iter().cycle().skip(1));
            ends.for_each(|(from, to)| bend(lens, *from, *to, &mut self.points));
        }
        self.ends.push(self.points.len());
        let points = self.points[start..].iter();
        points.fold(Bounds::EMPTY, |bounds, point| bounds.with(Bounds { low: *point, high: *point }))
    }
}

/// Appends the image of a straight edge, without its last point, as chords. The sagitta of a chord is
/// proportional to the square of its length.
fn bend(lens: &Lens, from: [f64; 2], to: [f64; 2], points: &mut Vec<[f64; 2]>) {
    let between =
        |t: f64| lens.pixel_position([from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])]);
    let (start, end) = (lens.pixel_position(from), lens.pixel_position(to));
    let chord = [end[0] - start[0], end[1] - start[1]];
    let length = libm::hypot(chord[0], chord[1]).max(f64::MIN_POSITIVE);
    let sagitta = [0.25, 0.5, 0.75]
        .map(|t| {
            let [x, y] = between(t);
            (chord[0] * (y - start[1]) - chord[1] * (x - start[0])).abs() / length
        })
        .into_iter()
        .fold(0.0, f64::max);
    let chords = (sagitta / Lens::SAGITTA_PX).sqrt().ceil().clamp(1.0, Lens::MAX_CHORDS);
    points.push(start);
    points.extend((1..chords as usize).map(|i| between(i as f64 / chords)));
}
