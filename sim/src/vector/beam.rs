//! The space through which light comes to what is seen of a plane: what is outside of it casts no shadow that is seen.

use nalgebra::Vector3;

use super::coverage::Window;
use super::loops::Loops;
use super::planes::{Plane, Sphere};
use super::shadow::Source;
use super::view::View;

/// Four planes along the light, through the borders of a window of the image as seen on a plane of the scene.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beam {
    sides: [Side; 4],
}

/// What lies beyond it casts its shadow beyond one border.
#[derive(Debug, Clone, Copy)]
struct Side {
    /// A unit vector outwards.
    normal: Vector3<f64>,
    offset: f64,
}

impl Side {
    /// For the border of a window, a plane through the camera with the normal m outwards. The shadow y of a point x lies beyond
    /// it when m · (y − d) > 0. With y put in, along the light, this is linear in x: with n the normal of the receiver, t towards
    /// the light (from the camera, for a light that is near) and x3 the height of x above the receiver
    /// (n · t) m · (x − d) − (m · t) x3 > 0, where n · t of a near light is its height above the receiver.
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

    /// How far a point lies beyond, m.
    fn beyond(&self, point: &Vector3<f64>) -> f64 {
        self.normal.dot(point) - self.offset
    }
}

impl Beam {
    /// From a light that shines on the plane's front to what a window shows of the plane.
    pub(super) fn new(source: Source, receiver: &Plane, view: &View<'_>, window: Window) -> Self {
        let sides = view.borders(window).map(|border| Side::new(&border, source, receiver, &view.position));
        Self { sides }
    }

    /// Whether nothing of a sphere is inside.
    pub(super) fn misses(&self, sphere: &Sphere) -> bool {
        self.sides.iter().any(|side| side.beyond(&sphere.centre) > sphere.radius)
    }

    /// The first side beyond which all of a sphere lies.
    fn side_before(&self, centre: &Vector3<f64>, radius: f64) -> Option<&Side> {
        self.sides.iter().find(|side| side.beyond(centre) > radius)
    }

    /// Puts a polygon into `kept` without the corners that do not matter inside: of corners in a row that are all beyond one
    /// side the first and the last, since the straight way between these is beyond it too. Left with fewer than three corners
    /// the polygon covers nothing inside.
    pub(super) fn trim(&self, loops: &Loops, index: usize, kept: &mut Vec<Vector3<f64>>) {
        kept.clear();
        if self.misses(loops.sphere(index)) {
            return;
        }
        // The side beyond which all corners since the last one kept lie, and the last of them.
        let (mut row, mut last) = (None::<&Side>, None);
        for (sphere, points) in loops.stretches(index) {
            if row.is_some_and(|side| side.beyond(&sphere.centre) > sphere.radius) {
                last = points.last();
                continue;
            }
            let side = self.side_before(&sphere.centre, sphere.radius);
            if let ([first, .., end], Some(_)) = (points, side) {
                kept.extend(last.take());
                kept.push(*first);
                (row, last) = (side, Some(end));
                continue;
            }
            for point in points {
                if row.is_some_and(|side| side.beyond(point) > 0.0) {
                    last = Some(point);
                } else {
                    kept.extend(last.take());
                    kept.push(*point);
                    row = self.side_before(point, 0.0);
                }
            }
        }
        kept.extend(last);
    }
}
