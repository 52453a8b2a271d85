//! Variation of the optics over the field of view.

use contract::{Camera, OutOfRange, PixelPoint, bounds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use truth::Switch;

/// Decrease of transmission and sharpness towards the corners. By default the optics are uniform.
///
/// ρ is the distance from the principal point on the focal plane, over that of the detector's farthest
/// corner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OpticsConfig {
    /// Natural vignetting, `on` or `off`: a uniform sky decreases with the fourth power of the cosine of the
    /// field angle, a star with the cosine.
    pub cos_fourth: Switch,
    /// Mechanical vignetting: v₁, v₂, v₃ of the relative transmission 1 − v₁ρ² − v₂ρ⁴ − v₃ρ⁶, which is above
    /// 0 and at most 1 up to ρ = 1.
    #[schemars(inner(range(min = -100, max = 100)))]
    pub vignetting: [f64; 3],
    /// Growth a of the point-spread function: at ρ its width is 1 + aρ² times that at the principal point;
    /// −0.5 to 5.
    #[schemars(range(min = -0.5, max = 5))]
    pub psf_growth: f64,
}

impl Default for OpticsConfig {
    fn default() -> Self {
        Self { cos_fourth: Switch::Off, vignetting: [0.0; 3], psf_growth: 0.0 }
    }
}

impl OpticsConfig {
    /// Number of steps of ρ at which the transmission is checked.
    const STEPS: u32 = 1000;

    /// Checks the ranges of all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first value outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "optics")?;
        let transmission = |i: u32| {
            let rho = f64::from(i) / f64::from(Self::STEPS);
            self.mechanical_transmission(rho * rho)
        };
        if (0..=Self::STEPS).map(transmission).all(|transmission| transmission > 0.0 && transmission <= 1.0) {
            return Ok(());
        }
        let expected = "a transmission above 0 and at most 1 from the principal point to the corner";
        Err(OutOfRange::new("optics.vignetting", format!("{:?}", self.vignetting), expected))
    }

    /// Transmission of mechanical vignetting at ρ².
    pub(super) fn mechanical_transmission(&self, rho2: f64) -> f64 {
        let [v1, v2, v3] = self.vignetting;
        1.0 - rho2 * (v1 + rho2 * (v2 + rho2 * v3))
    }
}

/// Distance from the principal point, over that of the farthest corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FieldRadius {
    principal: PixelPoint,
    pixel_um: [f64; 2],
    corner2_um2: f64,
}

impl FieldRadius {
    pub(super) fn new(camera: &Camera) -> Self {
        let farthest = |principal: f64, count: usize| {
            (principal + 0.5).abs().max((count as f64 - 0.5 - principal).abs())
        };
        let x_um = farthest(camera.principal_x_px, camera.columns) * camera.pixel_width_um;
        let y_um = farthest(camera.principal_y_px, camera.rows) * camera.pixel_height_um;
        Self {
            principal: PixelPoint::new(camera.principal_x_px, camera.principal_y_px),
            pixel_um: [camera.pixel_width_um, camera.pixel_height_um],
            corner2_um2: x_um * x_um + y_um * y_um,
        }
    }

    /// ρ² of a point, limited to that of the corner: there are no pixels farther out.
    pub(super) fn normalised_radius_squared(&self, point: PixelPoint) -> f64 {
        let x_um = (point.x - self.principal.x) * self.pixel_um[0];
        let y_um = (point.y - self.principal.y) * self.pixel_um[1];
        ((x_um * x_um + y_um * y_um) / self.corner2_um2).min(1.0)
    }
}
