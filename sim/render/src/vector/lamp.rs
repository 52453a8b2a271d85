//! Illumination of a plane by a lamp, pixel by pixel.

use std::f64::consts::PI;

use nalgebra::Vector3;
use scene::docking::Floodlight;
use scene::shadow::Plane;

use super::coverage::Window;
use super::view::View;

/// Illumination by a lamp of a plane that a camera sees.
pub(super) struct LampOnPlane<'a> {
    lamp: &'a Floodlight,
    view: &'a View<'a>,
    normal: Vector3<f64>,
    /// Height of the camera above the plane, m; `lamp_height` is that of the lamp.
    camera_height: f64,
    lamp_height: f64,
    camera_from_lamp: Vector3<f64>,
}

impl<'a> LampOnPlane<'a> {
    pub(super) fn new(lamp: &'a Floodlight, view: &'a View<'a>, plane: &Plane) -> Self {
        Self {
            lamp,
            view,
            normal: plane.normal,
            camera_height: plane.height(&view.position),
            lamp_height: plane.height(&lamp.position_m),
            camera_from_lamp: view.position - lamp.position_m,
        }
    }

    /// Returns the illumination at the point where the ray of an image point (px from the corner of the first
    /// pixel) meets the plane.
    fn node_at(&self, point: [f64; 2]) -> Node {
        let ray = self.view.attitude * self.view.lens.ray(point);
        let descent = -self.normal.dot(&ray);
        let meets_plane = descent > 0.0;
        if !meets_plane {
            return Node::default();
        }
        let from_lamp = self.camera_from_lamp + ray * (self.camera_height / descent);
        let square = from_lamp.norm_squared();
        let distance = square.sqrt();
        let angle = libm::acos((from_lamp.dot(&self.lamp.axis) / distance).clamp(-1.0, 1.0));
        let (inner, outer) = (self.lamp.inner_half_angle_rad, self.lamp.outer_half_angle_rad);
        Node {
            radiance: (self.lamp.intensity * self.lamp_height / (PI * square * distance)) as f32,
            share: ((outer - angle) / (outer - inner).max(SHARPEST_RAD)) as f32,
        }
    }
}

/// Smallest angle between the inner and outer cone, rad; a cone with a sharp edge fades over this angle.
const SHARPEST_RAD: f64 = 1e-6;

/// Illumination of a point by a lamp.
#[derive(Debug, Clone, Copy, Default)]
struct Node {
    /// E/π without the cone: the intensity divided by the squared distance, times the cosine of the angle of
    /// incidence on the plane, divided by π.
    radiance: f32,
    /// Fraction of the on-axis intensity, not clamped: above 1 inside the inner cone and below 0 outside the
    /// outer cone, to avoid a kink at either cone.
    share: f32,
}

impl Node {
    fn interpolate(self, other: Self, part: f32) -> Self {
        Self {
            radiance: self.radiance + part * (other.radiance - self.radiance),
            share: self.share + part * (other.share - self.share),
        }
    }

    fn shaded_radiance(self) -> f32 {
        self.radiance * self.share.clamp(0.0, 1.0)
    }
}

/// Illumination by a lamp in a window of the image, computed at the nodes of a grid; radiance and angle are
/// interpolated bilinearly between the nodes.
#[derive(Debug, Clone, Default)]
pub(super) struct LampGrid {
    nodes: Vec<Node>,
    lights: Vec<f32>,
}

impl LampGrid {
    /// Pixels between nodes.
    const STEP: usize = 16;

    /// Computes the nodes. The outermost nodes lie on the border of the window and not beyond it, where the
    /// plane may end at its horizon.
    pub(super) fn fill(&mut self, light: &LampOnPlane<'_>, window: Window) {
        self.nodes.clear();
        let positions = |from: usize, to: usize| {
            (0..=(to - from).div_ceil(Self::STEP)).map(move |i| (from + i * Self::STEP).min(to) as f64)
        };
        for y in positions(window.top, window.bottom) {
            self.nodes.extend(positions(window.left, window.right).map(|x| light.node_at([x, y])));
        }
    }

    /// Computes the illumination of a row of the window.
    pub(super) fn compute_row(&mut self, window: Window, row: usize) {
        let along = (window.right - window.left).div_ceil(Self::STEP) + 1;
        let cell = (row - window.top) / Self::STEP;
        let start = window.top + cell * Self::STEP;
        let part = ((row - start) as f32 + 0.5) / Self::STEP.min(window.bottom - start) as f32;
        let upper = &self.nodes[cell * along..][..along];
        let lower = &self.nodes[(cell + 1) * along..][..along];
        let node = |i: usize| upper[i].interpolate(lower[i], part);
        self.lights.clear();
        let mut left = node(0);
        for i in 0..along - 1 {
            let right = node(i + 1);
            let length = Self::STEP.min(window.right - window.left - i * Self::STEP);
            let pixel = 1.0 / length as f32;
            let lights =
                (0..length).map(|j| left.interpolate(right, (j as f32 + 0.5) * pixel).shaded_radiance());
            self.lights.extend(lights);
            left = right;
        }
    }

    /// Returns E/π at the pixel centres of the row computed last, from the left edge of the window.
    pub(super) fn row_radiances(&self) -> &[f32] {
        &self.lights
    }
}
