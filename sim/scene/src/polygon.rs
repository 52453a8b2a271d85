//! Polygons: clipping, subtraction, moments. The parts of a facet that remain after shadows and occlusions
//! are a set of convex polygons. The renderer of docking scenes clips with the same function.

use nalgebra::{SVector, Vector2};

/// Convex polygon in a plane, its corners in order; m.
pub(crate) type Polygon = Vec<Vector2<f64>>;

/// Writes the part of a closed polygon in which `height`, an affine function of position, is not negative
/// into `kept` (Sutherland & Hodgman 1974, Commun. ACM 17, 32). The part of a convex polygon is convex. Of
/// any other polygon, the pieces stay joined by edges along the cut, which cover no area. Nothing is left if
/// there is no such part.
pub fn keep_above<const D: usize>(
    polygon: &[SVector<f64, D>],
    kept: &mut Vec<SVector<f64, D>>,
    height: impl Fn(&SVector<f64, D>) -> f64,
) {
    kept.clear();
    let Some(mut from) = polygon.last() else { return };
    let mut from_height = height(from);
    for to in polygon {
        let to_height = height(to);
        if (from_height >= 0.0) != (to_height >= 0.0) {
            kept.push(from + (to - from) * (from_height / (from_height - to_height)));
        }
        if to_height >= 0.0 {
            kept.push(*to);
        }
        (from, from_height) = (to, to_height);
    }
}

/// Area, positive if the corners run counter-clockwise.
pub(crate) fn signed_area(corners: &[Vector2<f64>]) -> f64 {
    let Some(first) = corners.first() else { return 0.0 };
    corners.windows(2).map(|pair| 0.5 * (pair[0] - first).perp(&(pair[1] - first))).sum()
}

/// Rectangle along the axes that encloses a polygon: its lowest and its highest coordinates.
pub(crate) fn bounds(polygon: &[Vector2<f64>]) -> (Vector2<f64>, Vector2<f64>) {
    let nothing = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
    polygon.iter().fold(nothing, |(low, high), corner| (low.inf(corner), high.sup(corner)))
}

/// Convex polygon with its enclosing rectangle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bounded {
    pub outline: Polygon,
    low: Vector2<f64>,
    high: Vector2<f64>,
}

impl Bounded {
    /// Returns a polygon with its rectangle.
    pub(crate) fn new(outline: Polygon) -> Self {
        let (low, high) = bounds(&outline);
        Self { outline, low, high }
    }

    /// Returns true if the rectangles of two polygons have a point in common.
    fn may_meet(&self, (low, high): (Vector2<f64>, Vector2<f64>)) -> bool {
        self.low.x <= high.x && self.low.y <= high.y && self.high.x >= low.x && self.high.y >= low.y
    }
}

/// Subtraction of convex polygons, with buffers that every subtraction reuses.
#[derive(Debug, Default)]
pub(crate) struct Subtraction {
    /// Pieces that are left.
    left: Vec<Bounded>,
    /// Part of a piece inside the edges of the hole so far, and the buffer for the next edge.
    rest: Polygon,
    spare: Polygon,
    /// Corners of polygons that were removed, for reuse.
    empty: Vec<Polygon>,
}

impl Subtraction {
    /// Subtracts `hole`, a convex polygon of either orientation, from each of `pieces`; the result consists
    /// of convex polygons. Slivers smaller than `least_area` are dropped.
    pub(crate) fn subtract(&mut self, pieces: &mut Vec<Bounded>, hole: &mut Polygon, least_area: f64) {
        if signed_area(hole) < 0.0 {
            hole.reverse();
        }
        if !is_larger(hole, least_area) {
            return;
        }
        let rectangle = bounds(hole);
        if !pieces.iter().any(|piece| piece.may_meet(rectangle)) {
            return;
        }
        for piece in pieces.drain(..) {
            if piece.may_meet(rectangle) && self.meet(&piece.outline, hole, least_area) {
                self.cut(&piece.outline, hole, least_area);
                self.empty.push(piece.outline);
            } else {
                self.left.push(piece);
            }
        }
        std::mem::swap(pieces, &mut self.left);
    }

    /// Returns true if the common part of a piece and a hole is larger than `least_area`.
    fn meet(&mut self, piece: &Polygon, hole: &Polygon, least_area: f64) -> bool {
        self.rest.clone_from(piece);
        for (a, b) in edges(hole) {
            keep_above(&self.rest, &mut self.spare, left_of(a, b));
            std::mem::swap(&mut self.rest, &mut self.spare);
        }
        is_larger(&self.rest, least_area)
    }

    /// Appends the parts of a piece outside a hole. For each edge, the part outside is kept, and the part
    /// inside is passed to the next edge.
    fn cut(&mut self, piece: &Polygon, hole: &Polygon, least_area: f64) {
        self.rest.clone_from(piece);
        for (a, b) in edges(hole) {
            let height = left_of(a, b);
            let mut outside = self.empty.pop().unwrap_or_default();
            keep_above(&self.rest, &mut outside, |point| -height(point));
            if is_larger(&outside, least_area) {
                self.left.push(Bounded::new(outside));
            } else {
                self.empty.push(outside);
            }
            keep_above(&self.rest, &mut self.spare, height);
            std::mem::swap(&mut self.rest, &mut self.spare);
        }
    }
}

/// Returns true if the area of a polygon is larger than `least_area`.
fn is_larger(polygon: &Polygon, least_area: f64) -> bool {
    signed_area(polygon).abs() > least_area
}

/// Returns the edges of a closed polygon.
fn edges(polygon: &Polygon) -> impl Iterator<Item = (Vector2<f64>, Vector2<f64>)> + '_ {
    polygon.iter().zip(polygon.iter().cycle().skip(1)).map(|(from, to)| (*from, *to))
}

/// Returns twice the area of the triangle of an edge and a point, positive to the left of the edge.
fn left_of(a: Vector2<f64>, b: Vector2<f64>) -> impl Fn(&Vector2<f64>) -> f64 + Copy {
    move |point| (b - a).perp(&(point - a))
}

/// Area of a polygon, and four points that represent it: equal weights, with the polygon's centroid and
/// second moments. For a rectangle they are the points of Gauss's two-point rule along each side, so the
/// error is of fourth order.
pub(crate) fn four_points(corners: &[Vector2<f64>]) -> Option<(f64, [Vector2<f64>; 4])> {
    let first = corners.first()?;
    let triangles = || {
        corners.windows(2).map(move |pair| {
            let corners = [*first, pair[0], pair[1]];
            (0.5 * (pair[0] - first).perp(&(pair[1] - first)), (first + pair[0] + pair[1]) / 3.0, corners)
        })
    };
    let area: f64 = triangles().map(|(area, ..)| area).sum();
    if area == 0.0 {
        return None;
    }
    let centroid = triangles().fold(Vector2::zeros(), |sum, (part, centre, _)| sum + centre * part) / area;
    // A triangle's second moment about its centroid is a twelfth of the sum over its corners.
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (part, centre, corners) in triangles() {
        let share = part / area;
        let mut add = |d: Vector2<f64>, weight: f64| {
            xx += weight * d.x * d.x;
            xy += weight * d.x * d.y;
            yy += weight * d.y * d.y;
        };
        add(centre - centroid, share);
        for corner in corners {
            add(corner - centre, share / 12.0);
        }
    }
    Some((area.abs(), spread(centroid, [xx, xy, yy])))
}

/// Returns four points about a mean with the second moments [xx, xy, yy] about it: the points (±1, ±1)
/// multiplied by the triangular root of the covariance.
pub(crate) fn spread(mean: Vector2<f64>, [xx, xy, yy]: [f64; 3]) -> [Vector2<f64>; 4] {
    // The moments of a sliver may round below zero.
    let x = xx.max(0.0).sqrt();
    let along = if x > 0.0 { xy / x } else { 0.0 };
    let y = (yy - along * along).max(0.0).sqrt();
    [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)]
        .map(|(i, j)| mean + Vector2::new(i * x, i * along + j * y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(x: (f64, f64), y: (f64, f64)) -> Polygon {
        [(x.0, y.0), (x.1, y.0), (x.1, y.1), (x.0, y.1)].map(|(x, y)| Vector2::new(x, y)).to_vec()
    }

    fn area(pieces: &[Bounded]) -> f64 {
        pieces.iter().map(|piece| signed_area(&piece.outline)).sum()
    }

    #[test]
    fn a_hole_removes_its_area_in_either_orientation() {
        for reversed in [false, true] {
            let mut pieces = vec![Bounded::new(rectangle((0.0, 3.0), (0.0, 3.0)))];
            let mut hole = rectangle((1.0, 2.0), (1.0, 2.0));
            if reversed {
                hole.reverse();
            }
            Subtraction::default().subtract(&mut pieces, &mut hole, 1e-12);
            assert!((area(&pieces) - 8.0).abs() < 1e-12);
            // A second hole that overlaps the first removes only the remaining part.
            Subtraction::default().subtract(&mut pieces, &mut rectangle((0.0, 2.0), (1.5, 4.0)), 1e-12);
            assert!((area(&pieces) - (8.0 - 3.0 + 0.5)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_hole_elsewhere_removes_nothing_and_one_over_all_removes_all() {
        let mut pieces = vec![Bounded::new(rectangle((0.0, 1.0), (0.0, 1.0)))];
        Subtraction::default().subtract(&mut pieces, &mut rectangle((1.0, 2.0), (0.0, 1.0)), 1e-12);
        assert_eq!(pieces, [Bounded::new(rectangle((0.0, 1.0), (0.0, 1.0)))]);
        Subtraction::default().subtract(&mut pieces, &mut rectangle((-1.0, 2.0), (-1.0, 2.0)), 1e-12);
        assert!(pieces.is_empty());
    }

    #[test]
    fn the_four_points_of_a_rectangle_are_those_of_gauss() {
        let (area, points) = four_points(&rectangle((1.0, 3.0), (2.0, 6.0))).unwrap();
        let (dx, dy) = (1.0 / 3.0_f64.sqrt(), 2.0 / 3.0_f64.sqrt());
        assert!((area - 8.0).abs() < 1e-12);
        for (point, (i, j)) in points.iter().zip([(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)]) {
            assert!((point - Vector2::new(2.0 + i * dx, 4.0 + j * dy)).norm() < 1e-12);
        }
    }

    #[test]
    fn the_four_points_of_a_triangle_have_its_moments() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Vector2::new(x, y));
        let (area, points) = four_points(&corners).unwrap();
        let mean = |f: &dyn Fn(&Vector2<f64>) -> f64| points.iter().map(f).sum::<f64>() / 4.0;
        assert!((area - 0.5).abs() < 1e-15);
        // Uniform distribution over the triangle: ⟨x⟩ = 1/3, ⟨x²⟩ = 1/6, ⟨xy⟩ = 1/12.
        assert!((mean(&|p| p.x) - 1.0 / 3.0).abs() < 1e-15 && (mean(&|p| p.y) - 1.0 / 3.0).abs() < 1e-15);
        assert!((mean(&|p| p.x * p.x) - 1.0 / 6.0).abs() < 1e-15);
        assert!((mean(&|p| p.x * p.y) - 1.0 / 12.0).abs() < 1e-15);
    }
}
