//! Raw mosaics: images in which each pixel has a colour filter of its own.
//!
//! The camera is fitted to the mean of the two green pixels of each square of two by two. Their centre is
//! that of the square in every pattern, so that the pixel (i, j) of the mean is at (2i + 1/2, 2j + 1/2) of
//! the mosaic.

use camera_fit::CameraFit;
use camera_fit::adjustment::Term;
use clap::ValueEnum;
use contract::PixelPoint;
use files::{GreyImage, PixelConversion};

/// Colours of the first two rows of a mosaic, row by row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Mosaic {
    Rggb,
    Bggr,
    Grbg,
    Gbrg,
}

impl Mosaic {
    /// Returns true if the first pixel is green.
    fn begins_with_green(self) -> bool {
        matches!(self, Self::Grbg | Self::Gbrg)
    }

    /// Returns the mean of the green pixels of each square of a mosaic. A last odd column or row is left out.
    pub(super) fn green(self, image: &GreyImage) -> GreyImage {
        let (columns, rows) = (image.columns / 2, image.rows / 2);
        let mut values = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                let (x, y) = (2 * column, 2 * row);
                let (first, second) = match self.begins_with_green() {
                    true => (image.at(x, y), image.at(x + 1, y + 1)),
                    false => (image.at(x + 1, y), image.at(x, y + 1)),
                };
                values.push((0.5 * (first + second)) as f32);
            }
        }
        GreyImage { columns, rows, values, conversion: PixelConversion::None, ..*image }
    }
}

/// Converts a camera that was fitted to squares of two by two pixels to the pixels of the mosaic, of
/// `columns` and `rows`, with all figures in pixels.
pub(super) fn camera_of_pixels(fit: &mut CameraFit, columns: usize, rows: usize) {
    let camera = &mut fit.camera;
    (camera.columns, camera.rows) = (columns, rows);
    camera.pixel_width_um *= 0.5;
    camera.pixel_height_um *= 0.5;
    camera.principal_x_px = 2.0 * camera.principal_x_px + 0.5;
    camera.principal_y_px = 2.0 * camera.principal_y_px + 0.5;
    for (power, term) in [2, 4, 6].into_iter().zip(&mut camera.radial) {
        *term *= libm::pow(0.5, f64::from(power));
    }
    camera.tangential.iter_mut().for_each(|term| *term *= 0.5);
    for (term, sigma, _) in &mut fit.sigmas {
        *sigma *= match term {
            Term::FocalLength => 1.0,
            Term::PrincipalX | Term::PrincipalY => 2.0,
            Term::Radial1 => 0.25,
            Term::Radial2 => 0.0625,
            Term::Radial3 => 0.015_625,
            Term::Tangential1 | Term::Tangential2 => 0.5,
        };
    }
    fit.rms_px *= 2.0;
    fit.left_out_rms_px *= 2.0;
    fit.width_px = fit.width_px.map(|width_px| 2.0 * width_px);
    fit.frames.iter_mut().for_each(|frame| frame.rms_px *= 2.0);
    // The mean of two pixels has less noise, and a quarter of the pixels of a star.
    fit.noise_dn *= std::f64::consts::SQRT_2;
    if let Some(light) = &mut fit.photometry {
        light.zero_point[0] += 2.5 * libm::log10(4.0);
    }
    for star in &mut fit.matched {
        star.flux_dn *= 4.0;
        star.position = PixelPoint::new(2.0 * star.position.x + 0.5, 2.0 * star.position.y + 0.5);
        star.residual_px = star.residual_px.map(|residual| 2.0 * residual);
        star.sigma_px *= 2.0;
        star.width_px *= 2.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn green_pixels_are_those_of_the_pattern() {
        let image = GreyImage {
            columns: 5,
            rows: 2,
            values: vec![1.0, 10.0, 2.0, 20.0, 9.0, 30.0, 3.0, 40.0, 4.0, 9.0],
            full_scale: 255.0,
            conversion: PixelConversion::None,
        };
        for (mosaic, expected) in [
            (Mosaic::Rggb, [20.0, 30.0]),
            (Mosaic::Bggr, [20.0, 30.0]),
            (Mosaic::Grbg, [2.0, 3.0]),
            (Mosaic::Gbrg, [2.0, 3.0]),
        ] {
            let green = mosaic.green(&image);
            assert_eq!((green.columns, green.rows, green.values), (2, 1, expected.to_vec()));
        }
    }
}
