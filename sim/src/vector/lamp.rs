//! The light of a lamp on a plane, pixel by pixel.

use std::f64::consts::PI;

use nalgebra::Vector3;

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
    cos_inner: f64,
    cos_outer: f64,
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
            cos_inner: libm::cos(lamp.inner_half_angle_rad),
            cos_outer: libm::cos(lamp.outer_half_angle_rad),
        }
    }

    /// E/π along a row from the centre of one column to that of another, linear between.
    pub(super) fn along(&self, row: usize, from: usize, to: usize) -> Slope {
        let at = |column: usize| self.radiance_at([column as f64 + 0.5, row as f64 + 0.5]);
        let start = at(from);
        let step = (at(to) - start) / (to - from).max(1) as f64;
        Slope { from, start: start as f32, step: step as f32 }
    }

    /// E/π where the ray of a point of the image (px from the corner of the first pixel) meets the plane: the intensity over the
    /// square of the distance, times the cosine at the plane, over π.
    fn radiance_at(&self, point: [f64; 2]) -> f64 {
        let ray = self.view.attitude * self.view.lens.ray(point);
        let descent = -self.normal.dot(&ray);
        if descent <= 0.0 {
            return 0.0;
        }
        let from_lamp = self.camera_from_lamp + ray * (self.camera_height / descent);
        let square = from_lamp.norm_squared();
        let distance = square.sqrt();
        let cos_axis = from_lamp.dot(&self.lamp.axis) / distance;
        let share = self.share(cos_axis);
        self.lamp.intensity * share * self.lamp_height / (PI * square * distance)
    }

    /// The share of the intensity of the axis.
    fn share(&self, cos_axis: f64) -> f64 {
        if cos_axis >= self.cos_inner {
            1.0
        } else if cos_axis > self.cos_outer {
            let (inner, outer) = (self.lamp.inner_half_angle_rad, self.lamp.outer_half_angle_rad);
            (outer - libm::acos(cos_axis)) / (outer - inner)
        } else {
            0.0
        }
    }
}

/// A radiance that goes linearly along a row.
pub(super) struct Slope {
    from: usize,
    start: f32,
    step: f32,
}

impl Slope {
    pub(super) fn at(&self, column: usize) -> f32 {
        self.start + self.step * (column - self.from) as f32
    }
}
