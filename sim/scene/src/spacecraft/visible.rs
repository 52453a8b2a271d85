//! Parts of a body's facets that are sunlit and visible.
//!
//! Shadows and occlusions are exact: the shadow that a facet casts on another facet, and the part of it that
//! the facet hides, are convex polygons and are subtracted as polygons. Neglected: the angular width of the
//! Sun (a shadow cast over 1 m has a fringe of 9 mm; a glint is no narrower than `roughness`) and reflections
//! between facets.

use nalgebra::{Vector2, Vector3};

use super::facet::Facet;
use super::overlaps::Overlaps;
use crate::polygon::{Bounded, Polygon, Subtraction, bounds};
use crate::shadow::{Plane, Source};

/// Sine of the elevation above a facet below which Sun or camera count as lying in the facet's plane.
const MIN_ELEVATION_SINE: f64 = 1e-6;
/// Minimum height above a facet, m, from which a point of another facet counts as above it: a touching facet
/// casts no shadow.
const TOUCHING_M: f64 = 1e-9;
/// Share of a facet's area below which a sliver is dropped.
const SLIVER: f64 = 1e-12;

/// Convex, sunlit and visible part of a facet.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Piece {
    /// The facet, its front towards the camera.
    pub facet: Facet,
    /// Outline in the facet's plane.
    pub outline: Polygon,
}

impl Piece {
    /// Number of cells of the piece, of a facet with `across` × `along` cells; at least 1.
    pub(super) fn cell_count(&self, (across, along): (f64, f64)) -> f64 {
        let (low, high) = bounds(&self.outline);
        let share = 0.25
            * (high - low)
                .component_div(&Vector2::new(self.facet.half_width, self.facet.half_height))
                .product();
        (across * along * share).max(1.0)
    }
}

/// Returns the parts of `facets` that are lit from the direction `sun` (a unit vector) and visible from
/// `eye_m`.
pub(super) fn visible_pieces(facets: &[Facet], eye_m: Vector3<f64>, sun: Vector3<f64>) -> Vec<Piece> {
    let faces_sun = |facet: &Facet| !facet.is_of_mesh() || facet.normal.dot(&sun) > 0.0;
    let faces_eye = |facet: &Facet| !facet.is_of_mesh() || facet.normal.dot(&(eye_m - facet.centre)) > 0.0;
    let in_sunlight = Overlaps::new(facets, Source::Parallel(sun), faces_sun);
    let in_view = Overlaps::new(facets, Source::Point(eye_m), faces_eye);
    let mut cover = Cover::default();
    let mut pieces = Vec::new();
    let (mut shading, mut hiding, mut others) = (Vec::new(), Vec::new(), Vec::new());
    for (index, facet) in facets.iter().enumerate() {
        let Some(facet) = facing(facet, &eye_m, &sun) else { continue };
        in_sunlight.find(index, &mut shading);
        in_view.find(index, &mut hiding);
        others.clear();
        others.extend(shading.iter().chain(&hiding));
        others.sort_unstable();
        others.dedup();
        // Sun and camera in the axes of the facet, whose plane is z = 0.
        let sun = Vector3::new(sun.dot(&facet.right), sun.dot(&facet.up), sun.dot(&facet.normal));
        let sources = [Source::Parallel(sun), Source::Point(facet.local(&eye_m))];
        let mut left = vec![Bounded::new(facet.outline())];
        for number in &others {
            let Some(other) = facets.get(*number as usize).filter(|other| !facet.is_above(other)) else {
                continue;
            };
            for (source, found) in sources.iter().zip([&shading, &hiding]) {
                if found.binary_search(number).is_ok() {
                    cover.subtract(&facet, other, source, &mut left);
                }
            }
            if left.is_empty() {
                break;
            }
        }
        pieces.extend(left.into_iter().map(|piece| Piece { facet, outline: piece.outline }));
    }
    pieces
}

/// Returns the facet with its front towards the camera; `None` if that side is unlit or black.
fn facing(facet: &Facet, eye_m: &Vector3<f64>, sun: &Vector3<f64>) -> Option<Facet> {
    let eye = (eye_m - facet.centre).normalize().dot(&facet.normal);
    let sun = sun.dot(&facet.normal);
    let lit = eye * sun > 0.0 && eye.abs() > MIN_ELEVATION_SINE && sun.abs() > MIN_ELEVATION_SINE;
    let facet = if eye > 0.0 { *facet } else { facet.turned(facet.back?) };
    (lit && facet.front.diffuse + facet.front.specular > 0.0).then_some(facet)
}

/// Plane of a facet in the facet's axes.
const PLANE: Plane = Plane { normal: Vector3::new(0.0, 0.0, 1.0), offset: 0.0 };

/// Part of one facet that another facet shades or hides, with buffers that every pair of facets reuses.
#[derive(Debug, Default)]
struct Cover {
    corners: Vec<Vector3<f64>>,
    cut: Vec<Vector3<f64>>,
    shadow: Vec<Vector3<f64>>,
    hole: Polygon,
    subtraction: Subtraction,
}

impl Cover {
    /// Removes from the `pieces` of a facet the parts that `other` covers along the rays of a source, which
    /// is in the axes of the facet.
    ///
    /// A facet of a closed mesh covers others only with its front: whatever its back covers, a front of the
    /// same body covers as well, nearer to the Sun or to the camera.
    fn subtract(&mut self, facet: &Facet, other: &Facet, source: &Source, pieces: &mut Vec<Bounded>) {
        self.corners.clear();
        self.corners.extend(other.corners_m().map(|corner| facet.local(&corner)));
        source.cut_between(&mut self.corners, &PLANE, TOUCHING_M, &mut self.cut);
        if self.cut.len() < 3 {
            return;
        }
        source.cast(&self.cut, &PLANE, &mut self.shadow);
        self.hole.clear();
        self.hole.extend(self.shadow.iter().map(|corner| corner.xy()));
        let least_area = SLIVER * 4.0 * facet.half_width * facet.half_height;
        self.subtraction.subtract(pieces, &mut self.hole, least_area);
    }
}
