//! Facets of simple shapes: disks, annuli, prisms, tubes, cylinders, boxes, and circles as polygons.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::Facet;

/// Maximum deviation of the polygon from a circle that is measured in images, m.
pub(super) const FINE_SAGITTA_M: f64 = 1e-5;
/// Maximum deviation of the polygon from a circle that is measured only from afar, m.
pub(super) const COARSE_SAGITTA_M: f64 = 1e-4;

/// Circle in a plane parallel to the disk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Circle {
    /// Centre (y1, y2), m.
    pub(super) centre_m: [f64; 2],
    /// Radius, m.
    pub(super) radius_m: f64,
}

impl Circle {
    /// Returns a regular polygon with the circle's area, counter-clockwise seen from the front, its first
    /// corner towards +y1.
    pub(super) fn polygon(&self, sides: usize) -> Vec<[f64; 2]> {
        let corner_radius_m = corner_radius(self.radius_m, sides);
        (0..sides)
            .map(|i| {
                let (sin, cos) = libm::sincos(2.0 * PI * i as f64 / sides as f64);
                [self.centre_m[0] + corner_radius_m * cos, self.centre_m[1] + corner_radius_m * sin]
            })
            .collect()
    }

    /// Returns a polygon whose sides deviate from the circle by `sagitta_m` at most.
    pub(super) fn polygon_within(&self, sagitta_m: f64) -> Vec<[f64; 2]> {
        self.polygon(sides_within(self.radius_m, sagitta_m))
    }
}

/// Distance of the corners from the centre of a regular polygon of n sides with the area of a circle of
/// radius r: n/2 R² sin(2π/n) = π r².
fn corner_radius(radius_m: f64, sides: usize) -> f64 {
    let angle = 2.0 * PI / sides as f64;
    radius_m * (angle / libm::sin(angle)).sqrt()
}

/// Smallest multiple of four for which the sagitta of a side, r (1 − cos(π/n)), is at most `sagitta_m`.
fn sides_within(radius_m: f64, sagitta_m: f64) -> usize {
    let half_angle = libm::acos((1.0 - sagitta_m / radius_m).clamp(0.0, 1.0));
    // At least eight sides, and at most as many as a circle of kilometres needs.
    let quarter = (PI / half_angle / 4.0).ceil().clamp(2.0, 16_384.0);
    4 * quarter as usize
}

/// Returns a facet parallel to the disk at height `y3_m`, facing away from the station. Outline and holes are
/// counter-clockwise seen from the front.
pub(super) fn flat(outer: &[[f64; 2]], holes: &[&[[f64; 2]]], y3_m: f64, reflectance: f64) -> Facet {
    let lift = |p: &[f64; 2]| Vector3::new(p[0], p[1], y3_m);
    Facet {
        outer: outer.iter().map(lift).collect(),
        holes: holes.iter().map(|hole| hole.iter().rev().map(lift).collect()).collect(),
        normal: Vector3::z(),
        reflectance,
    }
}

/// Returns a facet without holes; its normal is Newell's sum over the corners.
pub(super) fn facet(outer: Vec<Vector3<f64>>, reflectance: f64) -> Facet {
    // Differences to the first corner are used because products of coordinates far from the origin would lose
    // digits.
    let first = outer.first().copied().unwrap_or_default();
    let mut area = Vector3::zeros();
    for (a, b) in outer.iter().zip(outer.iter().cycle().skip(1)) {
        area += (a - first).cross(&(b - first));
    }
    Facet { outer, holes: Vec::new(), normal: area.normalize(), reflectance }
}

/// Returns the wall of a prism along y3, from `back_m` to `front_m`, facing outwards: one rectangle per edge
/// of the outline, which is counter-clockwise seen from the front.
pub(super) fn wall(outline: &[[f64; 2]], back_m: f64, front_m: f64, reflectance: f64) -> Vec<Facet> {
    let edges = outline.iter().zip(outline.iter().cycle().skip(1));
    edges
        .map(|(a, b)| {
            let corner = |p: &[f64; 2], y3_m| Vector3::new(p[0], p[1], y3_m);
            let corners = vec![corner(a, back_m), corner(b, back_m), corner(b, front_m), corner(a, front_m)];
            facet(corners, reflectance)
        })
        .collect()
}

/// Returns the inner surface of a hollow that narrows from the front circle to the back circle: trapezia that
/// face the axis. The circles have a common centre and are divided into equally many sides.
pub(super) fn hollow(
    front: (Circle, f64),
    back: (Circle, f64),
    sides: usize,
    reflectance: f64,
) -> Vec<Facet> {
    let rim = |(circle, y3_m): (Circle, f64)| -> Vec<Vector3<f64>> {
        circle.polygon(sides).iter().map(|p| Vector3::new(p[0], p[1], y3_m)).collect()
    };
    let (front, back) = (rim(front), rim(back));
    (0..sides)
        .map(|i| {
            let next = (i + 1) % sides;
            facet(vec![front[i], front[next], back[next], back[i]], reflectance)
        })
        .collect()
}

/// Returns a closed cylinder from one point to another: its sides, then its two ends. `from_m` and `to_m`
/// must differ.
pub(super) fn cylinder(
    from_m: Vector3<f64>,
    to_m: Vector3<f64>,
    radius_m: f64,
    sides: usize,
    reflectance: f64,
) -> Vec<Facet> {
    let axis = (to_m - from_m).normalize();
    let across = axis.cross(&least_aligned(&axis)).normalize();
    let up = axis.cross(&across);
    let corner_radius_m = corner_radius(radius_m, sides);
    let ring = |centre: Vector3<f64>| -> Vec<Vector3<f64>> {
        (0..sides)
            .map(|i| {
                let (sin, cos) = libm::sincos(2.0 * PI * i as f64 / sides as f64);
                centre + (across * cos + up * sin) * corner_radius_m
            })
            .collect()
    };
    let (begin, end) = (ring(from_m), ring(to_m));
    let mut facets: Vec<Facet> = (0..sides)
        .map(|i| {
            let next = (i + 1) % sides;
            facet(vec![begin[i], begin[next], end[next], end[i]], reflectance)
        })
        .collect();
    facets.push(facet(end, reflectance));
    facets.push(facet(begin.into_iter().rev().collect(), reflectance));
    facets
}

/// Returns a box rotated about y3: its front and four sides. The back faces the station and is never visible.
pub(super) fn block(centre_m: [f64; 3], size_m: [f64; 3], turn_rad: f64, reflectance: f64) -> Vec<Facet> {
    let (sin, cos) = libm::sincos(turn_rad);
    let corner = |along: f64, across: f64| {
        let (x, y) = (along * size_m[0] / 2.0, across * size_m[1] / 2.0);
        [centre_m[0] + cos * x - sin * y, centre_m[1] + sin * x + cos * y]
    };
    let outline = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
    let (back_m, front_m) = (centre_m[2] - size_m[2] / 2.0, centre_m[2] + size_m[2] / 2.0);
    let mut facets = wall(&outline, back_m, front_m, reflectance);
    facets.push(flat(&outline, &[], front_m, reflectance));
    facets
}

/// Returns the unit vector of the axis least aligned with a direction; the first such axis on a tie.
fn least_aligned(direction: &Vector3<f64>) -> Vector3<f64> {
    let size = direction.abs();
    if size.x <= size.y && size.x <= size.z {
        Vector3::x()
    } else if size.y <= size.z {
        Vector3::y()
    } else {
        Vector3::z()
    }
}
