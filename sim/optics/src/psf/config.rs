//! Point-spread function of a scenario.

use contract::OutOfRange;
use contract::bounds::{self, require};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shape of the image of a point, before it is integrated over pixels.
///
/// Sizes are in pixels and equal along columns and rows, except for `airy`, which has one size for each
/// direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum PsfConfig {
    /// Circular Gaussian.
    Gaussian {
        /// Standard deviation, px, 0.05 to 100.
        #[schemars(range(min = 0.05, max = 100))]
        sigma_px: f64,
    },
    /// Circular Gaussian core in a broad Gaussian halo of scattered light.
    GaussianHalo {
        /// Standard deviation of the core, px, 0.05 to 100.
        #[schemars(range(min = 0.05, max = 100))]
        sigma_px: f64,
        /// Standard deviation of the halo, px, 0.05 to 100, not below that of the core.
        #[schemars(range(min = 0.05, max = 100))]
        halo_sigma_px: f64,
        /// Fraction of the flux that is in the halo, 0 to 1.
        #[schemars(range(min = 0, max = 1))]
        halo_fraction: f64,
    },
    /// Moffat profile: a core with wings that fall as the power −2β of the radius.
    Moffat {
        /// Full width at half maximum, px, 0.1 to 100.
        #[schemars(range(min = 0.1, max = 100))]
        fwhm_px: f64,
        /// Exponent β, 1.2 to 20: 2.5 to 5 is usual, and a smaller β puts more flux into the wings.
        #[schemars(range(min = 1.2, max = 20))]
        beta: f64,
    },
    /// Monochromatic diffraction image of a circular aperture.
    Airy {
        /// Wavelength times focal ratio over the pixel's width and over its height, px, 0.1 to 20 each: the
        /// first dark ring of an unobscured aperture is at 1.22 times this value.
        #[schemars(inner(range(min = 0.1, max = 20)))]
        lambda_n_px: [f64; 2],
        /// Diameter of the central obscuration over that of the aperture, 0 to 0.9.
        #[serde(default)]
        #[schemars(range(min = 0, max = 0.9))]
        obscuration: f64,
    },
    /// Lens out of focus: a uniform disk with an edge softened by a Gaussian.
    Defocus {
        /// Radius of the disk, px, 0.1 to 50.
        #[schemars(range(min = 0.1, max = 50))]
        radius_px: f64,
        /// Standard deviation of the Gaussian, px, 0.05 to 10 and at least a hundredth of the radius.
        #[schemars(range(min = 0.05, max = 10))]
        sigma_px: f64,
    },
    /// Table of the user: measured, or from an optical design program.
    Sampled {
        /// CSV file without a header: the relative flux in each cell of a fine grid, 0 or more, one line per
        /// row, from the top; at least 3 × 3 cells, at most 2048 × 2048. The table is normalised, and its
        /// centroid is placed at the point's position. A relative path starts at the scenario.
        path: String,
        /// Number of cells per pixel, along columns and along rows, 1 to 100.
        #[schemars(range(min = 1, max = 100))]
        oversampling: f64,
    },
}

impl PsfConfig {
    /// Checks the ranges of all values.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "psf")?;
        match *self {
            Self::GaussianHalo { sigma_px, halo_sigma_px, .. } => {
                require("psf.halo_sigma_px", halo_sigma_px, "from psf.sigma_px to 100", |v| v >= sigma_px)
            }
            Self::Defocus { radius_px, sigma_px } => {
                let expected = "0.05 to 10, and at least a hundredth of psf.radius_px";
                require("psf.sigma_px", sigma_px, expected, |v| v >= 0.01 * radius_px)
            }
            _ => Ok(()),
        }
    }
}
