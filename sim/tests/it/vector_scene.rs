//! Hand-made scenes for the tests of the fast renderer, and an independent projection.

use std::f64::consts::PI;

use boresight_sim::scene::docking::{Assembly, DockingScene, Facet, Lighting, Part, Sun};
use boresight_sim::vector::{Drawer, RadianceImage};
use contract::Camera;
use contract::docking::Pose;
use nalgebra::Vector3;
use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

pub(crate) type Point = Vector3<f64>;

/// Camera with 768 × 576 square pixels and the principal point in the middle.
pub(crate) fn camera(focal_px: f64) -> Camera {
    Camera {
        columns: 768,
        rows: 576,
        focal_length_mm: focal_px * 8.3e-3,
        pixel_width_um: 8.3,
        pixel_height_um: 8.3,
        principal_x_px: 383.5,
        principal_y_px: 287.5,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

pub(crate) fn pose(d: [f64; 3], phi: [f64; 3]) -> Pose {
    Pose { position_m: d.into(), phi_rad: phi.into() }
}

/// Facet with the given corners, anticlockwise as seen from outside.
pub(crate) fn facet(corners: &[[f64; 3]], reflectance: f64) -> Facet {
    let outer: Vec<Point> = corners.iter().map(|corner| Point::from(*corner)).collect();
    let normal = (outer[1] - outer[0]).cross(&(outer[2] - outer[1])).normalize();
    Facet { outer, holes: Vec::new(), normal, reflectance }
}

/// Facet that faces y3, with corners (y1, y2) anticlockwise.
pub(crate) fn flat(corners: &[[f64; 2]], height: f64, reflectance: f64) -> Facet {
    let corners: Vec<[f64; 3]> = corners.iter().map(|[x, y]| [*x, *y, height]).collect();
    facet(&corners, reflectance)
}

/// Regular polygon with the given number of sides around a centre.
pub(crate) fn circle(centre: [f64; 2], radius: f64, sides: usize) -> Vec<[f64; 2]> {
    (0..sides)
        .map(|i| {
            let (sin, cos) = libm::sincos(2.0 * PI * i as f64 / sides as f64);
            [centre[0] + radius * cos, centre[1] + radius * sin]
        })
        .collect()
}

/// Closed prism over an outline, with its front at `front` and its back `thickness` behind.
pub(crate) fn prism(outline: &[[f64; 2]], front: f64, thickness: f64, reflectance: f64) -> Vec<Facet> {
    let back = front - thickness;
    let reversed: Vec<[f64; 3]> = outline.iter().rev().map(|[x, y]| [*x, *y, back]).collect();
    let next = outline.iter().cycle().skip(1);
    let sides = outline.iter().zip(next).map(|(a, b)| {
        facet(
            &[[a[0], a[1], front], [a[0], a[1], back], [b[0], b[1], back], [b[0], b[1], front]],
            reflectance,
        )
    });
    // The normals are set explicitly: corners of a cross may be concave.
    let mut facets: Vec<Facet> = vec![flat(outline, front, reflectance), facet(&reversed, reflectance)];
    facets[0].normal = Point::z();
    facets[1].normal = -Point::z();
    facets.extend(sides);
    facets
}

/// Outline of an upright cross.
pub(crate) fn cross(half_length: f64, width: f64) -> Vec<[f64; 2]> {
    let (l, w) = (half_length, 0.5 * width);
    vec![
        [l, -w],
        [l, w],
        [w, w],
        [w, l],
        [-w, l],
        [-w, w],
        [-l, w],
        [-l, -w],
        [-w, -w],
        [-w, -l],
        [w, -l],
        [w, -w],
    ]
}

pub(crate) fn part(name: &str, facets: Vec<Facet>) -> Part {
    Part { name: name.to_owned(), assembly: Assembly::Station, facets, casts_shadow: true, visible: true }
}

pub(crate) fn scene(parts: Vec<Part>) -> DockingScene {
    DockingScene { parts }
}

/// Lighting in which every surface has a radiance equal to its reflectance.
pub(crate) fn plain() -> Lighting {
    Lighting { sun: None, floodlight: None, fill_radiance: 1.0, sky_radiance: 0.0 }
}

/// Lighting by the Sun only, with E/π = 1.
pub(crate) fn sunlit(towards: [f64; 3]) -> Lighting {
    let sun = Sun { towards: Point::from(towards).normalize(), irradiance: PI };
    Lighting { sun: Some(sun), floodlight: None, fill_radiance: 0.0, sky_radiance: 0.0 }
}

pub(crate) fn draw(camera: &Camera, scene: &DockingScene, lighting: &Lighting, pose: &Pose) -> RadianceImage {
    let mut image = RadianceImage::default();
    Drawer::new(camera).unwrap().draw(scene, lighting, pose, &mut image);
    image
}

/// Pixel position of a point in the camera without distortion, px, centre of the first pixel at 0: x = Aᵀ (y
/// − d) with A = diag(1, −1, −1) exp(\[φ\]×) by Rodrigues' formula.
pub(crate) fn seen(camera: &Camera, pose: &Pose, point: &Point) -> [f64; 2] {
    let ideal = point - pose.position_m;
    // exp(−[φ]×) diag(1, −1, −1) (y − d).
    let v = Point::new(ideal.x, -ideal.y, -ideal.z);
    let angle = pose.phi_rad.norm();
    let x = if angle == 0.0 {
        v
    } else {
        let k = -pose.phi_rad / angle;
        let (sin, cos) = libm::sincos(angle);
        v * cos + k.cross(&v) * sin + k * (k.dot(&v) * (1.0 - cos))
    };
    let (fx, fy) = camera.focal_length_px();
    [camera.principal_x_px + fx * x.x / x.z, camera.principal_y_px + fy * x.y / x.z]
}

/// Flux of a rectangle of pixels [columns, rows], and its centroid, px.
pub(crate) fn moments(image: &RadianceImage, columns: [usize; 2], rows: [usize; 2]) -> (f64, [f64; 2]) {
    let (mut flux, mut sums) = (0.0, [0.0; 2]);
    for row in rows[0]..rows[1] {
        for column in columns[0]..columns[1] {
            let value = f64::from(image.radiance[row * image.columns + column]);
            flux += value;
            sums[0] += value * column as f64;
            sums[1] += value * row as f64;
        }
    }
    (flux, sums.map(|sum| sum / flux))
}

/// Area of a convex polygon inside the pixel with centre (column, row), by clipping the polygon at the
/// pixel's four sides.
pub(crate) fn area_in_pixel(polygon: &[[f64; 2]], column: usize, row: usize) -> f64 {
    let (x, y) = (column as f64, row as f64);
    let sides = [(0, x - 0.5, 1.0), (0, x + 0.5, -1.0), (1, y - 0.5, 1.0), (1, y + 0.5, -1.0)];
    let mut corners = polygon.to_vec();
    for (axis, limit, sign) in sides {
        let inside = |point: &[f64; 2]| sign * (point[axis] - limit);
        let mut kept = Vec::new();
        for i in 0..corners.len() {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            let (at_a, at_b) = (inside(&a), inside(&b));
            if at_a >= 0.0 {
                kept.push(a);
            }
            if at_a * at_b < 0.0 {
                let t = at_a / (at_a - at_b);
                kept.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
            }
        }
        corners = kept;
    }
    shoelace(&corners).abs()
}

pub(crate) fn shoelace(polygon: &[[f64; 2]]) -> f64 {
    (0..polygon.len())
        .map(|i| {
            let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            0.5 * (a[0] * b[1] - b[0] * a[1])
        })
        .sum()
}

/// A small detector, for which the closed form of every pixel is computed quickly.
pub(crate) fn small() -> Camera {
    Camera { columns: 96, rows: 72, principal_x_px: 47.5, principal_y_px: 35.5, ..camera(130.0) }
}

pub(crate) fn random_pose(random: &mut Xoshiro256PlusPlus) -> Pose {
    let range = random.random_range(0.4..6.0);
    let mut within = |limit: f64| random.random_range(-limit..limit);
    let lateral = [within(0.3 * range), within(0.3 * range)];
    pose([lateral[0], lateral[1], range], [within(0.25), within(0.25), within(3.1)])
}
