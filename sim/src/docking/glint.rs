//! Glints: small shiny fittings that reflect the Sun into the camera.

use std::f64::consts::PI;

use contract::bounds::require;
use contract::docking::Lines;
use contract::{OutOfRange, PixelPoint};
use nalgebra::Vector3;
use scene::docking::Sun;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shiny fitting too small to be resolved. Seen from the distance D, its signal is (irradiance) ×
/// `strength_m2` × exp(−δ²/2w²)/D², with δ the angle from its normal to the bisector of the directions to Sun
/// and camera, and w its `lobe_deg`. A glint is never hidden or shaded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GlintConfig {
    /// Position, target frame, m, each coordinate −100 to 100.
    #[schemars(inner(range(min = -100, max = 100)))]
    pub position_m: [f64; 3],
    /// Normal, target frame, of any length but 0.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub normal: [f64; 3],
    /// Reflecting area × concentration, m², 0 to 1: a flat mirror of area A and reflectance ρ whose waviness
    /// fills the lobe has ρ A/(8π w²), w in radians.
    #[schemars(range(min = 0, max = 1))]
    pub strength_m2: f64,
    /// w: standard deviation of the normals, degrees, 0.05 to 45.
    #[schemars(range(min = 0.05, max = 45))]
    pub lobe_deg: f64,
}

/// Image of a glint in a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlintImage {
    /// Index in `lighting.glints`, 0-based.
    pub index: usize,
    /// Pixel position of the centre.
    pub centre: PixelPoint,
    /// Signal of the glint: radiance × px².
    pub light: f64,
}

impl GlintConfig {
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        let length = Vector3::from(self.normal).norm();
        require("lighting.glints[].normal (length)", length, "1e-6 to 1e6", |n| (1e-6..=1e6).contains(&n))
    }

    /// Signal in a camera at `camera_m`, for a focal length of 1 px: irradiance × m²/m².
    pub(super) fn intensity_at(&self, sun: &Sun, camera_m: &Vector3<f64>) -> f64 {
        let to_camera = camera_m - Vector3::from(self.position_m);
        let distance2 = to_camera.norm_squared();
        let normal = Vector3::from(self.normal).normalize();
        let bisector = sun.towards + to_camera / distance2.sqrt();
        // Sun or camera is behind the glint, which the bisector does not show.
        if !(sun.towards.dot(&normal) > 0.0 && to_camera.dot(&normal) > 0.0) {
            return 0.0;
        }
        let off_rad = libm::atan2(bisector.cross(&normal).norm(), bisector.dot(&normal));
        let ratio = off_rad / self.lobe_deg.to_radians();
        sun.irradiance * self.strength_m2 * libm::exp(-0.5 * ratio * ratio) / distance2
    }
}

/// Adds a glint to the rows of a field, behind a lens of the blur `sigma_px`: a Gaussian with the combined
/// variance of lens and pixel, 1/12 px² for the pixel.
pub(super) fn add(glint: &GlintImage, sigma_px: f64, signal: &mut [f32], columns: usize, lines: Lines) {
    let variance = sigma_px * sigma_px + 1.0 / 12.0;
    let peak = glint.light / (2.0 * PI * variance);
    let reach = 6.0 * variance.sqrt();
    for (k, row) in signal.chunks_exact_mut(columns.max(1)).enumerate() {
        let dy = lines.camera_row(k) as f64 - glint.centre.y;
        if dy.abs() > reach {
            continue;
        }
        let first = (glint.centre.x - reach).max(0.0) as usize;
        let last = (glint.centre.x + reach + 1.0).max(0.0) as usize;
        for (x, value) in row.iter_mut().enumerate().take(last).skip(first) {
            let dx = x as f64 - glint.centre.x;
            *value += (peak * libm::exp(-0.5 * (dx * dx + dy * dy) / variance)) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_glint_shines_in_the_mirror_direction_and_fades_with_the_square_of_the_distance() {
        let glint =
            GlintConfig { position_m: [0.0; 3], normal: [0.0, 0.0, 2.0], strength_m2: 1e-3, lobe_deg: 2.0 };
        let sun = Sun { towards: Vector3::new(0.6, 0.0, 0.8), irradiance: 3.0 };
        let mirror = Vector3::new(-0.6, 0.0, 0.8);
        assert!((glint.intensity_at(&sun, &(mirror * 5.0)) - 3e-3 / 25.0).abs() < 1e-15);
        assert!((glint.intensity_at(&sun, &(mirror * 10.0)) - 3e-3 / 100.0).abs() < 1e-15);
        // A camera 4° off the mirror direction: the bisector is 2° off, one standard deviation.
        let (sin, cos) = libm::sincos(4.0_f64.to_radians());
        let aside = Vector3::new(-0.6 * cos - 0.8 * sin, 0.0, 0.8 * cos - 0.6 * sin);
        assert!((glint.intensity_at(&sun, &aside) / 3e-3 - libm::exp(-0.5)).abs() < 1e-12);
        assert_eq!(glint.intensity_at(&sun, &-mirror), 0.0);
        assert_eq!(glint.intensity_at(&Sun { towards: -sun.towards, ..sun }, &mirror), 0.0);
    }

    #[test]
    fn its_image_has_its_flux_at_its_position() {
        let glint = GlintImage { index: 0, centre: PixelPoint::new(20.3, 14.6), light: 50.0 };
        let mut signal = vec![0.0_f32; 40 * 30];
        add(&glint, 0.7, &mut signal, 40, Lines::All);
        let mut sums = [0.0; 3];
        for (i, value) in signal.iter().enumerate() {
            for (sum, weight) in sums.iter_mut().zip([1.0, (i % 40) as f64, (i / 40) as f64]) {
                *sum += weight * f64::from(*value);
            }
        }
        // A sampled Gaussian of σ = 0.76 px: 1e-5 by Poisson's summation; f32.
        assert!((sums[0] / 50.0 - 1.0).abs() < 1e-4, "{}", sums[0]);
        assert!((sums[1] / sums[0] - 20.3).abs() < 1e-3 && (sums[2] / sums[0] - 14.6).abs() < 1e-3);
    }
}
