//! Simply rendered target for the tests of this module: seen head on, area by area, point by point.

use contract::docking::{
    Digitiser, DockingSetup, Field, FieldTelemetry, Lines, Outline, StandOffCross, TargetModel,
};
use contract::{Camera, Frame};
use nalgebra::Vector2;

use super::cross_and_circle::cross::CrossSeed;
use super::cross_and_circle::marks::Plane;
use super::preprocessing::view::Lens;

pub(crate) const COLUMNS: usize = 768;
pub(crate) const ROWS: usize = 576;

/// Returns a camera of 40° across 768 px, without distortion.
pub(crate) fn camera() -> Camera {
    Camera {
        columns: COLUMNS,
        rows: ROWS,
        focal_length_mm: 10.55,
        pixel_width_um: 10.0,
        pixel_height_um: 10.0,
        principal_x_px: 383.5,
        principal_y_px: 287.5,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

pub(crate) fn lens() -> Lens {
    Lens::new(&camera()).unwrap()
}

/// Returns a target with twelve radial marks, a cross, and a docking unit below.
pub(crate) fn target() -> TargetModel {
    let marks = (0..12)
        .map(|i| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / 12.0);
            [(0.23, -0.006), (0.27, -0.006), (0.27, 0.006), (0.23, 0.006)]
                .map(|(along, across)| [along * cos - across * sin, along * sin + across * cos])
        })
        .collect();
    TargetModel {
        name: "test".to_owned(),
        plate_radius_m: 0.30,
        mark_circle_radius_m: 0.25,
        marks,
        cross: StandOffCross {
            height_m: 0.30,
            half_length_m: 0.15,
            width_m: 0.030,
            thickness_m: 0.010,
            post_width_m: 0.020,
        },
        docking_unit: Outline { centre_m: [0.0, -1.25], radius_m: 0.66, depth_m: 0.10 },
        station: Outline { centre_m: [0.0, -1.25], radius_m: 2.05, depth_m: 0.45 },
    }
}

pub(crate) fn setup() -> DockingSetup {
    DockingSetup { cameras: vec![camera()], bit_depth: 8, target: target() }
}

pub(crate) fn telemetry(time_s: f64) -> FieldTelemetry {
    FieldTelemetry { time_s, camera: 0, digitiser: Digitiser::default() }
}

/// Target in front of a station in front of the sky. Grey values are 8-bit.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    /// Distance d3, m.
    pub(crate) range_m: f64,
    /// Rotation of the image towards increasing rows, rad.
    pub(crate) roll_rad: f64,
    /// Position of the disk's centre in the ideal image, px.
    pub(crate) disk_px: Vector2<f64>,
    /// Offset of the cross from the disk's centre, px.
    pub(crate) parallax_px: Vector2<f64>,
    /// True if there is a cross.
    pub(crate) cross: bool,
    /// Position of a second target, px.
    pub(crate) second_px: Option<Vector2<f64>>,
    /// Position (y1, m) to the right of which everything on the plate is in shadow.
    pub(crate) shadow_from_m: f64,
    /// Approximate standard deviation of the noise, DN.
    pub(crate) noise_dn: f64,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            range_m: 5.0,
            roll_rad: 0.0,
            disk_px: Vector2::new(20.3, -60.6),
            parallax_px: Vector2::new(1.7, -1.2),
            cross: true,
            second_px: None,
            shadow_from_m: f64::INFINITY,
            noise_dn: 0.0,
        }
    }
}

impl Scene {
    pub(crate) fn plane(&self) -> Plane {
        Plane { centre: self.disk_px, scale_px_m: lens().focal_px() / self.range_m, roll_rad: self.roll_rad }
    }

    pub(crate) fn cross(&self) -> CrossSeed {
        let model = target().cross;
        CrossSeed {
            centre: self.disk_px + self.parallax_px,
            half_length_px: lens().focal_px() * model.half_length_m / (self.range_m - model.height_m),
            slope: libm::tan(self.roll_rad),
        }
    }

    fn grey(&self, model: &TargetModel, plane: Plane, seed: &CrossSeed, ideal: Vector2<f64>) -> f64 {
        let shaded = |y1: f64, value: f64| if y1 > self.shadow_from_m { 0.25 * value } else { value };
        let on_target = |centre: Vector2<f64>| -> Option<f64> {
            let local = Plane { centre, ..plane }.locate(ideal);
            let cross = Plane {
                centre: centre + self.parallax_px,
                scale_px_m: seed.half_length_px / model.cross.half_length_m,
                ..plane
            }
            .locate(ideal);
            let bar = |along: f64, across: f64| {
                along.abs() <= model.cross.half_length_m && across.abs() <= model.cross.width_m / 2.0
            };
            if self.cross && (bar(cross[0], cross[1]) || bar(cross[1], cross[0])) {
                return Some(shaded(cross[0], 200.0));
            }
            if libm::hypot(local[0], local[1]) > model.plate_radius_m {
                return None;
            }
            let inside = |corners: &[[f64; 2]; 4]| {
                (0..4).all(|i| {
                    let (a, b) = (corners[i], corners[(i + 1) % 4]);
                    (b[0] - a[0]) * (local[1] - a[1]) - (b[1] - a[1]) * (local[0] - a[0]) >= 0.0
                })
            };
            Some(shaded(local[0], if model.marks.iter().any(inside) { 200.0 } else { 25.0 }))
        };
        if let Some(value) = on_target(self.disk_px).or_else(|| self.second_px.and_then(on_target)) {
            return value;
        }
        let local = plane.locate(ideal);
        let from_port = libm::hypot(local[0], local[1] + 1.25);
        match from_port {
            r if r < 0.52 => 40.0,
            r if r < 0.66 => 160.0,
            r if r < 2.05 => 95.0,
            _ => 10.0,
        }
    }

    /// Returns every row of the camera, blurred with a standard deviation of 0.7 px.
    fn rows(&self) -> Vec<f64> {
        const FINE: usize = 3;
        let (model, plane, cross, camera) = (target(), self.plane(), self.cross(), camera());
        let sharp: Vec<f64> = (0..COLUMNS * ROWS)
            .map(|i| {
                let (x, y) = ((i % COLUMNS) as f64, (i / COLUMNS) as f64);
                let mut sum = 0.0;
                for k in 0..FINE * FINE {
                    let offset = |j: usize| (j as f64 + 0.5) / FINE as f64 - 0.5;
                    let point = Vector2::new(
                        x + offset(k % FINE) - camera.principal_x_px,
                        y + offset(k / FINE) - camera.principal_y_px,
                    );
                    sum += self.grey(&model, plane, &cross, point);
                }
                sum / (FINE * FINE) as f64
            })
            .collect();
        // The binomial kernel (1, 2, 1)/4 has variance 1/2.
        let blur = |image: &[f64], stride: usize| -> Vec<f64> {
            (0..image.len())
                .map(|i| {
                    let before = image[i.saturating_sub(stride)];
                    let after = image.get(i + stride).copied().unwrap_or(image[i]);
                    0.25 * before + 0.5 * image[i] + 0.25 * after
                })
                .collect()
        };
        blur(&blur(&sharp, 1), COLUMNS)
    }

    /// Returns the digitised field.
    pub(crate) fn field(&self, lines: Lines) -> Field {
        let rows = self.rows();
        let mut state = 0x2545_f491_4f6c_dd1d_u64;
        let mut uniform = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        let dn = (0..lines.rows(ROWS))
            .flat_map(|row| (0..COLUMNS).map(move |column| (lines.camera_row(row), column)))
            .map(|(row, column)| {
                // Four uniform numbers: variance 1/3.
                let noise = ((0..4).map(|_| uniform()).sum::<f64>() - 2.0) * 3f64.sqrt() * self.noise_dn;
                (rows[row * COLUMNS + column] + noise).round().clamp(0.0, 255.0) as u16
            })
            .collect();
        plain(dn, lines)
    }
}

/// Creates a field from its digital numbers.
pub(crate) fn plain(dn: Vec<u16>, lines: Lines) -> Field {
    Field::new(Frame::new(0, COLUMNS, lines.rows(ROWS), 8, dn, None).unwrap(), lines, ROWS).unwrap()
}

/// Creates a field from a function that returns the grey value of a pixel.
pub(crate) fn drawn(lines: Lines, grey: impl Fn(usize, usize) -> u16) -> Field {
    let dn =
        (0..lines.rows(ROWS) * COLUMNS).map(|i| grey(i % COLUMNS, lines.camera_row(i / COLUMNS))).collect();
    plain(dn, lines)
}
