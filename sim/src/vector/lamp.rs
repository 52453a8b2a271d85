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
    fn at(&self, point: [f64; 2]) -> Node {
        let ray = self.view.attitude * self.view.lens.ray(point);
        let descent = -self.normal.dot(&ray);
        if !(descent > 0.0) {
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
    fn towards(self, other: Self, part: f32) -> Self {
        Self {
            radiance: self.radiance + part * (other.radiance - self.radiance),
            share: self.share + part * (other.share - self.share),
        }
    }

    fn light(self) -> f32 {
        self.radiance * self.share.clamp(0.0, 1.0)
    }
}

/// A lamp's light on a window of the image, computed at the nodes of a grid; between them radiance and angle are bilinear.
#[derive(Debug, Clone, Default)]
pub(super) struct LampGrid {
    nodes: Vec<Node>,
    row: Vec<Node>,
}

impl LampGrid {
    /// Pixels between nodes.
    const STEP: usize = 16;

    /// Computes the nodes: on the window's border and not beyond, where the plane may end at its horizon.
    pub(super) fn fill(&mut self, light: &LampOnPlane<'_>, window: Window) {
        self.nodes.clear();
        let places = |from: usize, to: usize| {
            (0..=(to - from).div_ceil(Self::STEP)).map(move |i| (from + i * Self::STEP).min(to) as f64)
        };
        for y in places(window.top, window.bottom) {
            self.nodes.extend(places(window.left, window.right).map(|x| light.at([x, y])));
        }
    }

    /// Makes a row of the window the one that [`LampGrid::light`] tells.
    pub(super) fn open_row(&mut self, window: Window, row: usize) {
        let along = (window.right - window.left).div_ceil(Self::STEP) + 1;
        let (cell, part) = Self::place(window.top, window.bottom, row);
        let upper = &self.nodes[cell * along..][..along];
        let lower = &self.nodes[(cell + 1) * along..][..along];
        self.row.clear();
        self.row.extend(upper.iter().zip(lower).map(|(upper, lower)| upper.towards(*lower, part)));
    }

    /// E/π at the centre of a pixel of the row.
    pub(super) fn light(&self, window: Window, column: usize) -> f32 {
        let (cell, part) = Self::place(window.left, window.right, column);
        self.row[cell].towards(self.row[cell + 1], part).light()
    }

    /// The cell that holds a pixel's centre, and how far through the cell it is.
    fn place(from: usize, to: usize, pixel: usize) -> (usize, f32) {
        let cell = (pixel - from) / Self::STEP;
        let start = from + cell * Self::STEP;
        let length = Self::STEP.min(to - start);
        (cell, ((pixel - start) as f32 + 0.5) / length as f32)
    }
}
