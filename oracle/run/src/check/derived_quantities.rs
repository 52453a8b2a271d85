//! Quantities derived from the values of a scenario, with which the user can check the intended meaning.

use sim::optics::Projection;

/// Field of view and pixel size of a camera.
pub struct FieldOfView {
    /// Width and height of the field of view through the principal point, degrees; `None` if the principal
    /// point is far off the detector.
    pub field_deg: Option<[f64; 2]>,
    /// Width and height of a pixel at the principal point, arcseconds.
    pub pixel_arcsec: [f64; 2],
}

impl FieldOfView {
    /// Computes the field of a camera.
    pub fn from_projection(projection: &Projection) -> Self {
        let (across, along) = projection.plate_scale_px_per_rad();
        Self {
            field_deg: projection.field().map(|field| field.map(contract::Angle::degrees)),
            pixel_arcsec: [across, along].map(|scale| contract::Angle::from_radians(1.0 / scale).arcsec()),
        }
    }

    /// Formats the field of view and the pixel size.
    pub fn text(&self) -> String {
        let [x, y] = self.pixel_arcsec;
        let field = self.field_deg.map_or_else(String::new, |[width, height]| {
            format!("field of view {width:.3}° × {height:.3}°, ")
        });
        format!("{field}a pixel {x:.4}″ × {y:.4}″")
    }
}

/// Formats a size: 872 kB, 5.6 GB.
pub fn size(bytes: u64) -> String {
    let size = bytes as f64;
    match bytes {
        0..1_000 => format!("{bytes} bytes"),
        1_000..1_000_000 => format!("{:.0} kB", size / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", size / 1e6),
        _ => format!("{:.1} GB", size / 1e9),
    }
}
