//! Convex polygons: clipping, subtraction, moments. The parts of a plate that remain after shadows and
//! occlusions are a set of convex polygons.

use nalgebra::{SVector, Vector2};

/// Convex polygon in a plane, its corners in order; m.
pub(super) type Polygon = Vec<Vector2<f64>>;

/// Returns the part of a convex polygon in which `height`, a linear function of position, is not negative
/// (Sutherland & Hodgman 1974, Commun. ACM 17, 32). Empty if there is no such part.
pub(super) fn clip<const D: usize>(
    corners: &[SVector<f64, D>],
    height: impl Fn(&SVector<f64, D>) -> f64,
) -> Vec<SVector<f64, D>> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    let Some(mut from) = corners.last() else { return kept };
    let mut from_height = height(from);
    for to in corners {
        let to_height = height(to);
        if (from_height < 0.0) != (to_height < 0.0) {
            kept.push(from + (to - from) * (from_height / (from_height - to_height)));
        }
        if to_height >= 0.0 {
            kept.push(*to);
        }
        (from, from_height) = (to, to_height);
    }
    kept
}

/// Area, positive if the corners run counter-clockwise.
pub(super) fn signed_area(corners: &[Vector2<f64>]) -> f64 {
    let Some(first) = corners.first() else { return 0.0 };
    corners.windows(2).map(|pair| 0.5 * (pair[0] - first).perp(&(pair[1] - first))).sum()
}

/// Subtracts `hole`, a convex polygon of either orientation, from each of `pieces`; the result consists of
/// convex polygons. Slivers smaller than `least_area` are dropped.
pub(super) fn subtract(pieces: &mut Vec<Polygon>, hole: &mut Polygon, least_area: f64) {
    if signed_area(hole) < 0.0 {
        hole.reverse();
    }
    let is_one = |piece: &Polygon| signed_area(piece).abs() > least_area;
    if !is_one(hole) {
        return;
    }
    let inside = |a: Vector2<f64>, b: Vector2<f64>| move |p: &Vector2<f64>| (b - a).perp(&(p - a));
    let edges = || hole.iter().zip(hole.iter().cycle().skip(1));
    let mut left = Vec::with_capacity(pieces.len());
    for piece in pieces.drain(..) {
        let common = edges().fold(piece.clone(), |rest, (a, b)| clip(&rest, inside(*a, *b)));
        if !is_one(&common) {
            left.push(piece);
            continue;
        }
        // For each edge, the part outside is kept, and the part inside is passed to the next edge.
        let mut rest = piece;
        for (a, b) in edges() {
            let height = inside(*a, *b);
            let outside = clip(&rest, |p| -height(p));
            if is_one(&outside) {
                left.push(outside);
            }
            rest = clip(&rest, height);
        }
    }
    *pieces = left;
}

/// Area of a polygon, and four points that represent it: equal weights, with the polygon's centroid and
/// second moments. For a rectangle they are the points of Gauss's two-point rule along each side, so the
/// error is of fourth order.
pub(super) fn four_points(corners: &[Vector2<f64>]) -> Option<(f64, [Vector2<f64>; 4])> {
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
pub(super) fn spread(mean: Vector2<f64>, [xx, xy, yy]: [f64; 3]) -> [Vector2<f64>; 4] {
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

    fn area(pieces: &[Polygon]) -> f64 {
        pieces.iter().map(|piece| signed_area(piece)).sum()
    }

    #[test]
    fn a_hole_removes_its_area_in_either_orientation() {
        for reversed in [false, true] {
            let mut pieces = vec![rectangle((0.0, 3.0), (0.0, 3.0))];
            let mut hole = rectangle((1.0, 2.0), (1.0, 2.0));
            if reversed {
                hole.reverse();
            }
            subtract(&mut pieces, &mut hole, 1e-12);
            assert!((area(&pieces) - 8.0).abs() < 1e-12);
            // A second hole that overlaps the first removes only the remaining part.
            subtract(&mut pieces, &mut rectangle((0.0, 2.0), (1.5, 4.0)), 1e-12);
            assert!((area(&pieces) - (8.0 - 3.0 + 0.5)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_hole_elsewhere_removes_nothing_and_one_over_all_removes_all() {
        let mut pieces = vec![rectangle((0.0, 1.0), (0.0, 1.0))];
        subtract(&mut pieces, &mut rectangle((1.0, 2.0), (0.0, 1.0)), 1e-12);
        assert_eq!(pieces, [rectangle((0.0, 1.0), (0.0, 1.0))]);
        subtract(&mut pieces, &mut rectangle((-1.0, 2.0), (-1.0, 2.0)), 1e-12);
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
