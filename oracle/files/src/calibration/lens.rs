//! Lens of a calibration, and its conversion from and to the camera of the contract.

use contract::{Camera, OutOfRange};

use super::distortion::{Detector, Distortion, Refit};

/// Pinhole camera with radial and tangential distortion in normalised coordinates: the model of OpenCV's
/// first five coefficients, of the `plumb_bob` of ROS and of the pinhole-radtan of Kalibr.
///
/// With x = X/Z, y = Y/Z and r² = x² + y², a point is seen at column cx + fx (x (1 + k1 r² + k2 r⁴ + k3 r⁶) +
/// 2 p1 x y + p2 (r² + 2 x²)) and row cy + fy (y (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 y²) + 2 p2 x y).
#[derive(Debug, Clone, PartialEq)]
pub struct LensCalibration {
    /// Number of columns and rows of the images; `None` if the file does not state it.
    pub size_px: Option<[usize; 2]>,
    /// Focal lengths fx, fy, px; finite and above 0.
    pub focal_px: [f64; 2],
    /// Principal point cx, cy, px; the centre of the first pixel is 0.
    pub principal_px: [f64; 2],
    /// Radial distortion k1, k2, k3.
    pub radial: [f64; 3],
    /// Tangential distortion p1, p2.
    pub tangential: [f64; 2],
}

/// Result of a conversion between the distortion of a calibration and that of the contract.
#[derive(Debug, Clone, PartialEq)]
pub struct Conversion<T> {
    /// The converted camera.
    pub value: T,
    /// Largest distance between the images of a point by the two models, over the image, px; 0 for an exact
    /// conversion.
    pub displacement_px: f64,
}

/// Returns the error of a distortion that cannot be converted.
fn not_convertible() -> OutOfRange {
    OutOfRange::new(
        "camera.radial",
        "of a distortion that no part of the image has",
        "coefficients and a principal point with which pixels have directions",
    )
}

/// Returns the coefficients k1, k2, k3, p1, p2 as one array.
fn joined([k1, k2, k3]: [f64; 3], [p1, p2]: [f64; 2]) -> [f64; 5] {
    [k1, k2, k3, p1, p2]
}

impl LensCalibration {
    /// Returns the camera of the contract for images of `size_px` columns and rows, and pixels of the width
    /// `pixel_um`, µm, 0.01 to 1e4. A calibration states only the ratio of focal length and pixel size.
    ///
    /// The distortion of the contract is in pixels: k1 / f², k2 / f⁴, k3 / f⁶, p1 / f, p2 / f are the same
    /// model where fx = fy = f. Where they differ, so do the models: r² is a sum of squares of pixels in one
    /// and of tangents in the other. Then the terms that are not 0 are fitted by least squares over the
    /// image.
    ///
    /// # Errors
    /// [`OutOfRange`] for a value that [`Camera::check`] refuses, and for a distortion that no part of the
    /// image has.
    pub fn to_camera(&self, size_px: [usize; 2], pixel_um: f64) -> Result<Conversion<Camera>, OutOfRange> {
        let ([columns, rows], [fx, fy]) = (size_px, self.focal_px);
        let mut camera = Camera {
            columns,
            rows,
            focal_length_mm: fx * pixel_um / 1000.0,
            pixel_width_um: pixel_um,
            pixel_height_um: if fx == fy { pixel_um } else { pixel_um * (fx / fy) },
            principal_x_px: self.principal_px[0],
            principal_y_px: self.principal_px[1],
            radial: [0.0; 3],
            tangential: [0.0; 2],
        };
        camera.check()?;
        let terms = joined(self.radial, self.tangential);
        let distortion = Distortion { unit_px: self.focal_px, terms };
        let detector = Detector { size_px, principal_px: self.principal_px };
        let Refit { distortion, displacement_px } =
            distortion.with_units([1.0; 2], &detector).ok_or_else(not_convertible)?;
        let [k1, k2, k3, p1, p2] = distortion.terms;
        (camera.radial, camera.tangential) = ([k1, k2, k3], [p1, p2]);
        camera.check()?;
        Ok(Conversion { value: camera, displacement_px })
    }

    /// Returns the calibration of a camera of the contract: the inverse of [`LensCalibration::to_camera`].
    ///
    /// # Errors
    /// [`OutOfRange`] for a value that [`Camera::check`] refuses, and for a distortion that no part of the
    /// image has.
    pub fn from_camera(camera: &Camera) -> Result<Conversion<Self>, OutOfRange> {
        camera.check()?;
        let size_px = [camera.columns, camera.rows];
        let principal_px = [camera.principal_x_px, camera.principal_y_px];
        let (fx, fy) = camera.focal_length_px();
        let terms = joined(camera.radial, camera.tangential);
        let Refit { distortion, displacement_px } = Distortion { unit_px: [1.0; 2], terms }
            .with_units([fx, fy], &Detector { size_px, principal_px })
            .ok_or_else(not_convertible)?;
        let [k1, k2, k3, p1, p2] = distortion.terms;
        let value = Self {
            size_px: Some(size_px),
            focal_px: [fx, fy],
            principal_px,
            radial: [k1, k2, k3],
            tangential: [p1, p2],
        };
        Ok(Conversion { value, displacement_px })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lens() -> LensCalibration {
        LensCalibration {
            size_px: Some([640, 480]),
            focal_px: [657.5, 657.5],
            principal_px: [322.1, 241.7],
            radial: [-0.25, 0.11, 0.02],
            tangential: [1e-3, -2e-3],
        }
    }

    #[test]
    fn a_camera_has_the_coefficients_in_pixels() {
        let Conversion { value: camera, displacement_px } = lens().to_camera([640, 480], 4.8).unwrap();
        assert_eq!(displacement_px, 0.0);
        assert_eq!((camera.columns, camera.rows, camera.pixel_height_um), (640, 480, 4.8));
        assert!((camera.focal_length_mm - 3.156).abs() < 1e-12);
        assert_eq!((camera.principal_x_px, camera.principal_y_px), (322.1, 241.7));
        // −0.25 / 657.5² px⁻² and −2e-3 / 657.5 px⁻¹.
        assert!((camera.radial[0] / -5.782_937_4e-7 - 1.0).abs() < 1e-7, "{:e}", camera.radial[0]);
        assert!((camera.tangential[1] / -3.041_825_1e-6 - 1.0).abs() < 1e-7, "{:e}", camera.tangential[1]);
    }

    #[test]
    fn a_calibration_survives_the_way_there_and_back() {
        let camera = lens().to_camera([640, 480], 4.8).unwrap().value;
        let again = LensCalibration::from_camera(&camera).unwrap().value;
        let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-14 * a.abs(), "{a} {b}");
        near(again.focal_px[0], 657.5);
        near(again.focal_px[1], 657.5);
        for (one, other) in again.radial.iter().zip(lens().radial) {
            near(*one, other);
        }
        for (one, other) in again.tangential.iter().zip(lens().tangential) {
            near(*one, other);
        }
        assert_eq!((again.size_px, again.principal_px), (lens().size_px, lens().principal_px));
    }

    #[test]
    fn values_outside_the_range_of_a_camera_are_named() {
        let refused = |lens: LensCalibration, size: [usize; 2], field: &str| {
            assert_eq!(lens.to_camera(size, 5.0).unwrap_err().path, field);
        };
        refused(lens(), [0, 480], "camera.columns");
        refused(LensCalibration { focal_px: [1e-9, 1e-9], ..lens() }, [640, 480], "camera.focal_length_mm");
        refused(LensCalibration { focal_px: [657.5, 1e-9], ..lens() }, [640, 480], "camera.pixel_height_um");
        refused(LensCalibration { principal_px: [1e7, 0.0], ..lens() }, [640, 480], "camera.principal_x_px");
        refused(LensCalibration { radial: [1e9, 0.0, 0.0], ..lens() }, [640, 480], "camera.radial[0]");
        let folded = LensCalibration {
            focal_px: [657.0, 658.0],
            principal_px: [9e4, 0.0],
            radial: [-0.5, 0.0, 0.0],
            ..lens()
        };
        refused(folded, [640, 480], "camera.radial");
    }
}
