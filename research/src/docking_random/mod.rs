//! Random poses of the docking target: the camera, the Sun, visibility in the field and single fields.

pub mod in_field;
pub mod still;

use contract::Camera;
use draws::{Stream, uniform};
use nalgebra::Vector3;
use sim::docking::SunConfig;

/// Side of a pixel, µm, and size of the image: the television camera of `scenarios/docking.toml`.
const PIXEL_UM: f64 = 8.3;
const COLUMNS: usize = 768;
const ROWS: usize = 576;

/// Camera of this focal length without distortion, with its axis through the image centre.
pub fn camera(focal_px: f64) -> Camera {
    Camera {
        columns: COLUMNS,
        rows: ROWS,
        focal_length_mm: focal_px * (PIXEL_UM * 1e-3),
        pixel_width_um: PIXEL_UM,
        pixel_height_um: PIXEL_UM,
        principal_x_px: 0.5 * (COLUMNS - 1) as f64,
        principal_y_px: 0.5 * (ROWS - 1) as f64,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

/// Draws a fixed Sun direction, uniform over the cap within 60° of the target's normal, with two draws of the
/// stream.
pub fn random_sun(stream: &mut Stream) -> SunConfig {
    // Uniform over the cap: uniform in the cosine, from cos 60° on.
    let cosine = 0.5 + 0.5 * uniform(stream);
    let around = 2.0 * std::f64::consts::PI * uniform(stream);
    let sine = (1.0 - cosine * cosine).sqrt();
    let sun = Vector3::new(sine * libm::cos(around), sine * libm::sin(around), cosine);
    SunConfig {
        azimuth_deg: libm::atan2(sun.x, sun.z).to_degrees(),
        elevation_deg: libm::asin(sun.y).to_degrees(),
        rate_deg_s: 0.0,
        rate_axis: [0.0, 1.0, 0.0],
        irradiance: std::f64::consts::PI,
    }
}
