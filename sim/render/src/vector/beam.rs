//! Beam of light that reaches the visible part of a plane; objects outside the beam cast no visible shadow.

use nalgebra::Vector3;
use scene::shadow::{Plane, Source};

use super::bounds::Sphere;
use super::coverage::Window;
use super::loops::Loops;
use super::view::View;

/// Four planes parallel to the light rays, through the borders of an image window as projected onto a plane
/// of the scene.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beam {
    sides: [Side; 4],
}

/// Side plane of a beam; a point beyond it casts its shadow beyond one border of the window.
#[derive(Debug, Clone, Copy)]
struct Side {
    /// Unit normal, pointing outwards.
    normal: Vector3<f64>,
    offset: f64,
}

impl Side {
    /// Creates the side for the border of a window: a plane through the camera with outward normal m. The
    /// shadow y of a point x lies beyond the border when m · (y − d) > 0. After projecting x along the light
    /// to y, the condition is linear in x: (n · t) m · (x − d) − (m · t) x3 > 0, with n the normal of the
    /// receiver, t the direction towards the light (measured from the camera for a near light) and x3 the
    /// height of x above the receiver. For a near light, n · t is its height above the receiver.
    fn new(border: &Vector3<f64>, source: Source, receiver: &Plane, camera: &Vector3<f64>) -> Self {
        let (towards, climb) = match source {
            Source::Parallel(towards) => (towards, receiver.normal.dot(&towards)),
            Source::Point(position) => (position - camera, receiver.height(&position)),
        };
        let aside = border.dot(&towards);
        let normal = border * climb - receiver.normal * aside;
        let offset = climb * border.dot(camera) - aside * receiver.offset;
        let length = normal.norm();
        if length > 0.0 {
            Self { normal: normal / length, offset: offset / length }
        } else {
            Self { normal, offset: f64::INFINITY }
        }
    }

    /// Returns the distance of a point beyond the side, m; negative inside.
    fn signed_distance_m(&self, point: &Vector3<f64>) -> f64 {
        self.normal.dot(point) - self.offset
    }
}

impl Beam {
    /// Creates the beam from a light that shines on the plane's front to the part of the plane visible in a
    /// window.
    pub(super) fn new(source: Source, receiver: &Plane, view: &View<'_>, window: Window) -> Self {
        let sides = view.borders(window).map(|border| Side::new(&border, source, receiver, &view.position));
        Self { sides }
    }

    /// Returns true if no part of a sphere is inside, because all of it lies beyond one side.
    pub(super) fn misses(&self, sphere: &Sphere) -> bool {
        self.sides.iter().any(|side| side.signed_distance_m(&sphere.centre) > sphere.radius)
    }

    /// Returns true if the whole sphere is inside.
    fn contains(&self, sphere: &Sphere) -> bool {
        self.sides.iter().all(|side| side.signed_distance_m(&sphere.centre) <= -sphere.radius)
    }

    /// Returns the first side beyond which the whole sphere lies.
    fn separating_side(&self, centre: &Vector3<f64>, radius: f64) -> Option<&Side> {
        self.sides.iter().find(|side| side.signed_distance_m(centre) > radius)
    }

    /// Copies a polygon into `kept` without the corners that have no effect inside the beam: of consecutive
    /// corners that all lie beyond one side, only the first and the last are kept, because the straight line
    /// between them also lies beyond that side. A polygon left with fewer than three corners covers nothing
    /// inside.
    pub(super) fn trim(&self, loops: &Loops, index: usize, kept: &mut Vec<Vector3<f64>>) {
        kept.clear();
        if self.misses(loops.sphere(index)) {
            return;
        }
        // `row` is the side beyond which all corners since the last kept corner lie; `last` is the last of
        // those corners.
        let (mut row, mut last) = (None::<&Side>, None);
        for (sphere, points) in loops.stretches(index) {
            if row.is_some_and(|side| side.signed_distance_m(&sphere.centre) > sphere.radius) {
                last = points.last();
                continue;
            }
            if self.contains(sphere) {
                kept.extend(last.take());
                kept.extend(points);
                row = None;
                continue;
            }
            let side = self.separating_side(&sphere.centre, sphere.radius);
            if let ([first, .., end], Some(_)) = (points, side) {
                kept.extend(last.take());
                kept.push(*first);
                (row, last) = (side, Some(end));
                continue;
            }
            for point in points {
                if row.is_some_and(|side| side.signed_distance_m(point) > 0.0) {
                    last = Some(point);
                } else {
                    kept.extend(last.take());
                    kept.push(*point);
                    row = self.separating_side(point, 0.0);
                }
            }
        }
        kept.extend(last);
    }
}

#[cfg(test)]
mod tests {
    use contract::Camera;
    use contract::docking::Pose;

    use super::super::view::Lens;
    use super::*;
    use crate::vector::planes::PreparedScene;
    use scene::docking::{Assembly, DockingScene, Facet, Part};

    const WINDOW: Window = Window { left: 30, right: 60, top: 20, bottom: 45 };

    fn camera(radial: f64) -> Camera {
        Camera {
            columns: 96,
            rows: 72,
            focal_length_mm: 1.3,
            pixel_width_um: 10.0,
            pixel_height_um: 10.0,
            principal_x_px: 47.5,
            principal_y_px: 35.5,
            radial: [radial, 0.0, 0.0],
            tangential: [0.0; 2],
        }
    }

    /// The plane y3 = 0, facing up.
    fn ground() -> Plane {
        let corners = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]];
        let outer = corners.map(|[x, y]| Vector3::new(x, y, 0.0)).to_vec();
        let facet = Facet { outer, holes: Vec::new(), normal: Vector3::z(), reflectance: 0.5 };
        let part = Part {
            name: "ground".into(),
            assembly: Assembly::Station,
            facets: vec![facet],
            casts_shadow: false,
            visible: true,
        };
        PreparedScene::new(&DockingScene { parts: vec![part] }).planes.remove(0).surface
    }

    /// Position of a point's shadow on the ground.
    fn shadow(source: Source, point: &Vector3<f64>) -> Vector3<f64> {
        match source {
            Source::Parallel(towards) => point - towards * (point.z / towards.z),
            Source::Point(lamp) => lamp + (point - lamp) * (lamp.z / (lamp.z - point.z)),
        }
    }

    /// Winding number of a polygon's shadow about a point on the ground.
    fn turns(source: Source, polygon: &[Vector3<f64>], window_point: &Vector3<f64>) -> i32 {
        let next = polygon.iter().cycle().skip(1);
        polygon.iter().zip(next).fold(0, |turns, (from, to)| {
            let (a, b) = (shadow(source, from) - window_point, shadow(source, to) - window_point);
            let is_right_of_place = (a.x * b.y - b.x * a.y) * (b.y - a.y) > 0.0;
            match (a.y < 0.0, b.y < 0.0) {
                (true, false) if is_right_of_place => turns + 1,
                (false, true) if is_right_of_place => turns - 1,
                _ => turns,
            }
        })
    }

    /// A tilted star-shaped polygon with 400 corners, which leaves the beam and re-enters it.
    fn star(x: f64, y: f64, radius: f64) -> Vec<Vector3<f64>> {
        let corner = |i: i32| {
            let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::PI / 200.0);
            let r = if i % 40 < 20 { radius } else { 0.4 * radius };
            Vector3::new(x + r * cos, y + r * sin, 0.7 + 0.2 * cos)
        };
        (0..400).map(corner).collect()
    }

    #[test]
    fn a_trimmed_shadow_keeps_its_winding_number_at_every_point_of_the_window() {
        let sources = [
            Source::Parallel(Vector3::new(0.3, -0.4, 0.8).normalize()),
            Source::Parallel(Vector3::z()),
            Source::Point(Vector3::new(0.4, 0.2, 3.0)),
        ];
        let pose = Pose { position_m: Vector3::new(0.2, -0.1, 5.0), phi_rad: Vector3::new(0.1, -0.15, 0.6) };
        let stars = [(0.0, 0.0, 3.0), (1.0, 0.3, 0.9), (-0.6, 0.8, 0.7), (0.0, 0.0, 0.5), (0.3, -0.3, 1.5)];
        let mut left = [0, 0];
        for radial in [0.0, -1e-6] {
            let lens = Lens::new(&camera(radial)).unwrap();
            let view = View::new(&lens, &pose);
            let ground = ground();
            let pixels =
                (0..=10).flat_map(|i| (0..=10).map(move |j| (f64::from(i) / 10.0, f64::from(j) / 10.0)));
            let window_points: Vec<Vector3<f64>> = pixels
                .map(|(s, t)| {
                    // The points lie a thousandth of a pixel inside: on the border itself rounding would
                    // decide.
                    let x = WINDOW.left as f64 + 1e-3 + s * ((WINDOW.right - WINDOW.left) as f64 - 2e-3);
                    let y = WINDOW.top as f64 + 1e-3 + t * ((WINDOW.bottom - WINDOW.top) as f64 - 2e-3);
                    let ray = view.attitude * lens.ray([x, y]);
                    view.position - ray * (view.position.z / ray.z)
                })
                .collect();
            for source in sources {
                let beam = Beam::new(source, &ground, &view, WINDOW);
                for (x, y, radius) in stars {
                    let star = star(x, y, radius);
                    let (mut loops, mut kept) = (Loops::default(), Vec::new());
                    loops.push(star.iter().copied());
                    beam.trim(&loops, 0, &mut kept);
                    left = [left[0] + kept.len(), left[1] + star.len()];
                    for window_point in &window_points {
                        let (before, after) =
                            (turns(source, &star, window_point), turns(source, &kept, window_point));
                        assert_eq!(before, after, "{radial} {source:?} {x} {y} {radius} {window_point}");
                    }
                }
            }
        }
        assert!(2 * left[0] < left[1], "{left:?} corners are left");
    }
}
