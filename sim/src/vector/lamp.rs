//! The light of a lamp on a plane, pixel by pixel.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::coverage::Window;
use super::planes::Plane;
use super::view::View;
use crate::scene::docking::Floodlight;

/// A lamp's light on a plane that a camera sees.
pub(super) struct LampOnPlane<'a> {
    lamp: &'a Floodlight,
    view: &'a View<'a>,
    normal: Vector3<f64>,
    /// Heights of camera and lamp above the plane, m.
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

    /// Where the ray of a point of the image (px from the corner of the first pixel) meets the plane.
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

/// A cone that ends at once ends within this angle, rad.
const SHARPEST_RAD: f64 = 1e-6;

/// A lamp's light at a place.
#[derive(Debug, Clone, Copy, Default)]
struct Node {
    /// E/π without the cone: the intensity over the square of the distance, times the cosine at the plane, over π.
    radiance: f32,
    /// The share of the intensity of the axis, above 1 inside the inner cone and below 0 outside the outer one, so that it has no
    /// kink there.
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

/// A lamp's light on a window of the image, computed at the nodes of a grid; between them radiance and angle are bilinear.
#[derive(Debug, Clone, Default)]
pub(super) struct LampGrid {
    nodes: Vec<Node>,
    lights: Vec<f32>,
}

impl LampGrid {
    /// Pixels between nodes.
    const STEP: usize = 16;

    /// Computes the nodes: on the window's border and not beyond, where the plane may end at its horizon.
    pub(super) fn fill(&mut self, light: &LampOnPlane<'_>, window: Window) {
        self.nodes.clear();
        let positions = |from: usize, to: usize| {
            (0..=(to - from).div_ceil(Self::STEP)).map(move |i| (from + i * Self::STEP).min(to) as f64)
        };
        for y in positions(window.top, window.bottom) {
            self.nodes.extend(positions(window.left, window.right).map(|x| light.node_at([x, y])));
        }
    }

    /// Computes the light of a row of the window.
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

    /// E/π at the centres of the pixels of that row, from the window's left.
    pub(super) fn row_radiances(&self) -> &[f32] {
        &self.lights
    }
}
