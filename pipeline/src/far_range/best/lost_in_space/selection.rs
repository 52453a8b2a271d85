//! Selection of the stars that a camera is likely to see from a list: the brightest of each field.

use contract::{ListedStar, PixelPoint};
use nalgebra::Vector3;

use crate::CameraModel;

/// Number of stars kept in a circle of the size of the field. The stars of an image of ten stars are the
/// brightest ten of the field; where the list has more stars than this number, the brightest sources of an
/// image are still mostly among those kept.
const STARS_IN_FIELD: u32 = 24;

/// Returns the stars of `stars` up to `max_magnitude`, in order of magnitude, except those with
/// [`STARS_IN_FIELD`] brighter ones around them in a circle as large as the field of the camera. The density
/// of stars is therefore equal in rich and poor parts of the sky (as in Tetra3's star catalogues).
pub(super) fn brightest_of_each_field(
    stars: &[ListedStar],
    model: &CameraModel,
    max_magnitude: f64,
) -> Vec<ListedStar> {
    let mut stars: Vec<ListedStar> = stars
        .iter()
        .filter(|star| {
            star.magnitude <= max_magnitude && star.direction.vector().iter().all(|c| c.is_finite())
        })
        .copied()
        .collect();
    stars.sort_by(|a, b| a.magnitude.total_cmp(&b.magnitude).then(a.id.cmp(&b.id)));
    // A cap of the chord c has the solid angle π c².
    let radius = (solid_angle(model) / std::f64::consts::PI).sqrt();
    let mut grid = Grid::new(radius);
    stars.retain(|star| {
        let mut brighter = 0;
        grid.near(star.direction.vector(), radius, |_, _| {
            brighter += 1;
            brighter < STARS_IN_FIELD
        });
        let is_kept = brighter < STARS_IN_FIELD;
        if is_kept {
            grid.push(*star.direction.vector());
        }
        is_kept
    });
    stars
}

/// Returns the directions of the corners of the detector, in order around it; `None` when a corner has no
/// direction.
fn corners(model: &CameraModel) -> Option<[Vector3<f64>; 4]> {
    let (columns, rows) = model.size_px();
    let (right, bottom) = (columns as f64 - 0.5, rows as f64 - 0.5);
    let at = |x: f64, y: f64| Some(*model.back_project(PixelPoint::new(x, y))?.vector());
    Some([at(-0.5, -0.5)?, at(right, -0.5)?, at(right, bottom)?, at(-0.5, bottom)?])
}

/// Returns the solid angle of the field between great circles through its corners, sr; that of a hemisphere
/// when a corner has no direction.
fn solid_angle(model: &CameraModel) -> f64 {
    let Some([a, b, c, d]) = corners(model) else { return std::f64::consts::TAU };
    triangle_solid_angle(&a, &b, &c) + triangle_solid_angle(&a, &c, &d)
}

/// Returns the solid angle of the triangle of three unit vectors (van Oosterom & Strackee 1983, IEEE Trans.
/// Biomed. Eng. 30, 125, Eq. 8), sr.
fn triangle_solid_angle(a: &Vector3<f64>, b: &Vector3<f64>, c: &Vector3<f64>) -> f64 {
    2.0 * libm::atan2(a.dot(&b.cross(c)).abs(), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

/// Returns the chord between the most distant corners, 0 to 2.
pub(super) fn largest_chord(model: &CameraModel) -> f64 {
    corners(model).map_or(2.0, |[a, b, c, d]| (a - c).norm().max((b - d).norm()))
}

/// Directions in cubic cells, for the search for neighbours of a direction.
#[derive(Debug)]
pub(super) struct Grid {
    cells: usize,
    /// Index of the last direction added to each cell.
    last: Vec<u32>,
    /// Index of the previous direction in the same cell, for each direction.
    before: Vec<u32>,
    directions: Vec<Vector3<f64>>,
}

/// Largest number of cells along an axis: 64³ of 4 bytes are a megabyte.
const MAX_CELLS: f64 = 64.0;

const NONE: u32 = u32::MAX;

impl Grid {
    /// Creates an empty grid for searches up to the chord `reach`.
    pub(super) fn new(reach: f64) -> Self {
        let cells = (2.0 / reach).clamp(1.0, MAX_CELLS) as usize;
        Self { cells, last: vec![NONE; cells * cells * cells], before: Vec::new(), directions: Vec::new() }
    }

    /// Adds a unit vector. Its index is the number of vectors added before.
    pub(super) fn push(&mut self, direction: Vector3<f64>) {
        let [x, y, z] = [direction.x, direction.y, direction.z].map(|c| self.cell(c));
        let last = &mut self.last[(x * self.cells + y) * self.cells + z];
        self.before.push(*last);
        *last = self.directions.len() as u32;
        self.directions.push(direction);
    }

    /// Calls `visit` with index and chord of each vector within the chord `reach` of a direction, until it
    /// returns false. `reach` is at most that of the grid.
    pub(super) fn near(&self, direction: &Vector3<f64>, reach: f64, mut visit: impl FnMut(u32, f64) -> bool) {
        let range = |c: f64| self.cell(c).saturating_sub(1)..=(self.cell(c) + 1).min(self.cells - 1);
        for x in range(direction.x) {
            for y in range(direction.y) {
                for z in range(direction.z) {
                    let mut number = self.last[(x * self.cells + y) * self.cells + z];
                    while number != NONE {
                        let squared = (self.directions[number as usize] - direction).norm_squared();
                        if squared <= reach * reach && !visit(number, squared.sqrt()) {
                            return;
                        }
                        number = self.before[number as usize];
                    }
                }
            }
        }
    }

    /// Returns the cell of a coordinate, −1 to 1.
    fn cell(&self, coordinate: f64) -> usize {
        // The conversion saturates at 0.
        ((0.5 * (coordinate + 1.0) * self.cells as f64) as usize).min(self.cells - 1)
    }
}
