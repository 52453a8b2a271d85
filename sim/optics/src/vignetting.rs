//! Vignetting: the decrease of transmission away from the principal point.
//!
//! Natural vignetting is the cos⁴ law of the illuminance by a uniform sky (Reiss 1945, J. Opt. Soc. Am. 35,
//! 283). Three of the four factors are the solid angle of a pixel, which decreases as cos³ in a camera
//! without distortion. They concern light that fills pixels, and the background takes the solid angle of each
//! pixel from the camera model. The fourth is the aperture, foreshortened as cos: it is the only loss of a
//! star, and it is the factor applied here. Mechanical vignetting, the obstruction of slanted rays by the
//! barrel, is an even polynomial of the image radius (Goldman 2010, IEEE Trans. PAMI 32, 2276). Both leave
//! the principal point unchanged.

use contract::{Camera, PixelPoint};
use truth::{SimError, Switch};

use super::field::FieldRadius;
use super::{OpticsConfig, Projection};

/// Transmission over the field, relative to the principal point.
///
/// ```
/// use boresight_optics::{OpticsConfig, Vignetting};
/// use contract::{Camera, PixelPoint};
/// use truth::Switch;
/// let camera = Camera {
///     columns: 752, rows: 580, focal_length_mm: 20.187, pixel_width_um: 8.6, pixel_height_um: 8.3,
///     principal_x_px: 395.0, principal_y_px: 288.0, radial: [0.0; 3], tangential: [0.0; 2],
/// };
/// let config = OpticsConfig { cos_fourth: Switch::On, ..OpticsConfig::default() };
/// let vignetting = Vignetting::new(&config, &camera)?;
/// assert_eq!(vignetting.transmission(PixelPoint::new(395.0, 288.0)), 1.0);
/// // 395 · 8.6 µm from the axis of a lens of 20.187 mm are 9.55°: the cosine is 0.986.
/// assert!((vignetting.transmission(PixelPoint::new(0.0, 288.0)) - 0.986).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Vignetting {
    config: OpticsConfig,
    radius: FieldRadius,
    projection: Projection,
}

impl Vignetting {
    /// Creates the vignetting of a camera's optics.
    ///
    /// # Errors
    /// Those of [`OpticsConfig::check`] and [`Projection::new`].
    pub fn new(config: &OpticsConfig, camera: &Camera) -> Result<Self, SimError> {
        config.check()?;
        let projection = Projection::new(camera)?;
        Ok(Self { config: config.clone(), radius: FieldRadius::new(camera), projection })
    }

    /// Transmission at a point of the focal plane, in [0, 1]; 0 at points without a direction, which never
    /// occur on the detector.
    pub fn transmission(&self, point: PixelPoint) -> f64 {
        let natural = match self.config.cos_fourth {
            Switch::Off => 1.0,
            Switch::On => self.projection.unproject(point).map_or(0.0, |direction| direction.vector().z),
        };
        natural * self.config.mechanical_transmission(self.radius.normalised_radius_squared(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use contract::Direction;
    use nalgebra::Vector3;

    fn camera() -> Camera {
        Camera {
            columns: 752,
            rows: 580,
            focal_length_mm: 20.187,
            pixel_width_um: 8.6,
            pixel_height_um: 8.3,
            principal_x_px: 395.0,
            principal_y_px: 288.0,
            radial: [2.6e-8, 0.0, 0.0],
            tangential: [0.0, 0.0],
        }
    }

    fn vignetting(config: OpticsConfig) -> Vignetting {
        Vignetting::new(&config, &camera()).unwrap()
    }

    #[test]
    fn vignetting_is_off_by_default() {
        let vignetting = vignetting(OpticsConfig::default());
        for point in [PixelPoint::new(0.0, 0.0), PixelPoint::new(751.0, 579.0), PixelPoint::new(-30.0, 9.0)] {
            assert_eq!(vignetting.transmission(point), 1.0);
        }
    }

    #[test]
    fn a_star_ten_degrees_off_axis_loses_the_cosine_of_the_foreshortened_aperture() {
        let vignetting = vignetting(OpticsConfig { cos_fourth: Switch::On, ..OpticsConfig::default() });
        let angle = 10.0_f64.to_radians();
        let direction = Direction::from_vector(Vector3::new(
            libm::sin(angle) * 0.8,
            libm::sin(angle) * 0.6,
            libm::cos(angle),
        ));
        let direction = direction.unwrap();
        let there = vignetting.transmission(vignetting.projection.project(&direction).unwrap());
        assert!((there - 0.984_807_753).abs() < 1e-9);
    }

    #[test]
    fn the_polynomial_is_that_of_the_radius_on_the_focal_plane() {
        let config = OpticsConfig { vignetting: [0.1, 0.2, 0.05], ..OpticsConfig::default() };
        let vignetting = vignetting(config);
        // The farthest corner is (−0.5, 579.5) − the principal point: 395.5 · 8.6 µm and 291.5 · 8.3 µm.
        let corner = vignetting.transmission(PixelPoint::new(-0.5, 579.5));
        assert!((corner - 0.65).abs() < 1e-12, "{corner}");
        let half = PixelPoint::new(395.0 - 0.5 * 395.5, 288.0 + 0.5 * 291.5);
        let expected = 1.0 - 0.1 * 0.25 - 0.2 * 0.0625 - 0.05 * 0.015_625;
        assert!((vignetting.transmission(half) - expected).abs() < 1e-12);
        // Points off the detector have the transmission of the corner.
        assert_eq!(vignetting.transmission(PixelPoint::new(-50.0, 650.0)), corner);
    }

    #[test]
    fn a_transmission_outside_0_to_1_is_refused() {
        for bad in [[1.0, 0.0, 0.0], [-0.1, 0.2, 0.0], [2.5, 0.0, -1.6], [f64::NAN, 0.0, 0.0]] {
            let config = OpticsConfig { vignetting: bad, ..OpticsConfig::default() };
            let message = config.check().unwrap_err().to_string();
            assert!(message.contains("optics.vignetting"), "{message}");
        }
        let config = OpticsConfig { psf_growth: 6.0, ..OpticsConfig::default() };
        assert!(config.check().unwrap_err().to_string().contains("optics.psf_growth"));
    }
}
