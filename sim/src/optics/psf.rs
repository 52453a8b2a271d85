//! The point-spread function, integrated over pixels.

use contract::PixelPoint;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ImagePoint, Stamp};
use crate::SimError;
use crate::error::require;

/// Shape of the image of a point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum PsfConfig {
    /// A circular Gaussian.
    Gaussian {
        /// Standard deviation, px, 0.05 to 100.
        sigma_px: f64,
    },
    /// A circular Gaussian core in a broad Gaussian halo of scattered light.
    GaussianHalo {
        /// Standard deviation of the core, px, 0.05 to 100.
        sigma_px: f64,
        /// Standard deviation of the halo, px, 0.05 to 100, not below that of the core.
        halo_sigma_px: f64,
        /// Fraction of the light that is in the halo, 0 to 1.
        halo_fraction: f64,
    },
}

impl PsfConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// [`SimError::Parameter`] for the first field outside its range.
    pub fn check(&self) -> Result<(), SimError> {
        let side = |v: f64| (0.05..=100.0).contains(&v);
        match *self {
            Self::Gaussian { sigma_px } => require("psf.sigma_px", sigma_px, "0.05 to 100", side),
            Self::GaussianHalo { sigma_px, halo_sigma_px, halo_fraction } => {
                require("psf.sigma_px", sigma_px, "0.05 to 100", side)?;
                require("psf.halo_sigma_px", halo_sigma_px, "from psf.sigma_px to 100", |v| {
                    side(v) && v >= sigma_px
                })?;
                require("psf.halo_fraction", halo_fraction, "0 to 1", |v| (0.0..=1.0).contains(&v))
            }
        }
    }
}

/// A point-spread function: a sum of circular Gaussians, each integrated exactly over every pixel.
///
/// A Gaussian over a rectangle is the product of two differences of error functions, one a column and one a row,
/// so a stamp costs as many error functions as it has columns and rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Psf {
    /// In order of growing width.
    components: Vec<Component>,
    /// Shares of flux a column and a row, reused from stamp to stamp.
    profile_x: Vec<f64>,
    profile_y: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Component {
    weight: f64,
    sigma_px: f64,
}

impl Psf {
    /// Below this many electrons a pixel of a stamp is left out, unless a caller asks for more: a thousandth of the
    /// noise of any detector that tracks stars.
    pub const FLOOR_E: f64 = 0.01;

    /// The point-spread function of a configuration.
    ///
    /// # Errors
    /// Those of [`PsfConfig::check`].
    pub fn new(config: &PsfConfig) -> Result<Self, SimError> {
        config.check()?;
        let components = match *config {
            PsfConfig::Gaussian { sigma_px } => vec![Component { weight: 1.0, sigma_px }],
            PsfConfig::GaussianHalo { sigma_px, halo_sigma_px, halo_fraction } => vec![
                Component { weight: 1.0 - halo_fraction, sigma_px },
                Component { weight: halo_fraction, sigma_px: halo_sigma_px },
            ],
        };
        Ok(Self { components, profile_x: Vec::new(), profile_y: Vec::new() })
    }

    /// The image of a point of `electrons` at `centre`: [`Psf::stamp_extended`] of that one point.
    pub fn stamp(
        &mut self,
        centre: PixelPoint,
        electrons: f64,
        floor_e: f64,
        detector: (usize, usize),
        stamp: &mut Stamp,
    ) {
        self.stamp_extended(
            &[ImagePoint { position: centre, share: 1.0 }],
            electrons,
            floor_e,
            detector,
            stamp,
        );
    }

    /// The image of an object of `electrons` whose undisturbed image is made of `points` (a trail, a resolved body), on a
    /// detector of `detector` = (columns, rows). The centre of the stamp is the mean of the points by their shares.
    ///
    /// Pixels with fewer than `floor_e` electrons (greater than 0) are left at zero. A Gaussian of width σ thereby
    /// loses at most about 2πσ² `floor_e` electrons; the truth is taken from the stamp, so that truth and image
    /// stay the same.
    pub fn stamp_extended(
        &mut self,
        points: &[ImagePoint],
        electrons: f64,
        floor_e: f64,
        detector: (usize, usize),
        stamp: &mut Stamp,
    ) {
        let reach_px = self
            .components
            .iter()
            .map(|component| component.reach_px(electrons, floor_e))
            .fold(0.0, f64::max);
        let extent = Extent::of(points);
        let x = pixels_within(extent.x, reach_px, detector.0);
        let y = pixels_within(extent.y, reach_px, detector.1);
        stamp.reset(extent.centre, x, y);
        if stamp.electrons.is_empty() || reach_px == 0.0 {
            return;
        }
        for component in &self.components {
            let own_px = component.reach_px(electrons, floor_e);
            for point in points {
                let PixelPoint { x: px, y: py } = point.position;
                let own_x = pixels_within((px, px), own_px, detector.0);
                let own_y = pixels_within((py, py), own_px, detector.1);
                if own_px == 0.0 || own_x.0 >= own_x.1 || own_y.0 >= own_y.1 {
                    continue;
                }
                component.profile(px, own_x, &mut self.profile_x);
                component.profile(py, own_y, &mut self.profile_y);
                let flux = electrons * component.weight * point.share;
                let (left, width) = (own_x.0 - x.0, own_x.1 - own_x.0);
                let rows = stamp.electrons.chunks_exact_mut(stamp.columns).skip(own_y.0 - y.0);
                for (row, share_y) in rows.zip(&self.profile_y) {
                    let row_flux = flux * share_y;
                    for (pixel, share_x) in row[left..left + width].iter_mut().zip(&self.profile_x) {
                        *pixel += row_flux * share_x;
                    }
                }
            }
        }
        for pixel in &mut stamp.electrons {
            if *pixel < floor_e {
                *pixel = 0.0;
            }
        }
    }

    /// How far off the detector an object may be and still be drawn, px: five standard deviations of the widest
    /// component, beyond which less than 1e-6 of the light falls.
    pub fn margin_px(&self) -> f64 {
        self.components.iter().map(|component| 5.0 * component.sigma_px).fold(0.0, f64::max)
    }

    /// The share of the light that falls in the pixel under the centre of the image, at best: when the image is
    /// centred on the pixel. The shutter control takes it for the brightest pixel.
    pub fn peak_share(&self) -> f64 {
        self.components
            .iter()
            .map(|component| {
                let along = component.share(-0.5, 0.5);
                component.weight * along * along
            })
            .sum()
    }
}

impl Component {
    /// Distance from the centre beyond which, along a column or a row, no pixel holds `floor_e`, px; 0 when no
    /// pixel at all does. A pixel whose nearer edge is d away holds at most flux · n(d) · share(±0.5), with the
    /// normal density n.
    fn reach_px(&self, electrons: f64, floor_e: f64) -> f64 {
        let density = 1.0 / (self.sigma_px * (2.0 * std::f64::consts::PI).sqrt());
        let brightest = electrons * self.weight * density * self.share(-0.5, 0.5);
        if brightest > floor_e {
            0.5 + self.sigma_px * (2.0 * libm::log(brightest / floor_e)).sqrt()
        } else {
            0.0
        }
    }

    /// Share of the flux between two distances from the centre along one axis.
    fn share(&self, from_px: f64, to_px: f64) -> f64 {
        let scale = 1.0 / (self.sigma_px * std::f64::consts::SQRT_2);
        0.5 * (libm::erf(to_px * scale) - libm::erf(from_px * scale))
    }

    /// Shares of the flux in each pixel of a range along one axis.
    fn profile(&self, centre: f64, range: (usize, usize), shares: &mut Vec<f64>) {
        let scale = 1.0 / (self.sigma_px * std::f64::consts::SQRT_2);
        let edge = |i: usize| libm::erf((i as f64 - 0.5 - centre) * scale);
        shares.clear();
        let mut left = edge(range.0);
        for i in range.0..range.1 {
            let right = edge(i + 1);
            shares.push(0.5 * (right - left));
            left = right;
        }
    }
}

/// The rectangle that the points of an image span, and their mean.
struct Extent {
    x: (f64, f64),
    y: (f64, f64),
    centre: PixelPoint,
}

impl Extent {
    fn of(points: &[ImagePoint]) -> Self {
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        let mut extent = Self { x: nothing, y: nothing, centre: PixelPoint::default() };
        let mut shares = 0.0;
        for ImagePoint { position, share } in points {
            extent.x = (extent.x.0.min(position.x), extent.x.1.max(position.x));
            extent.y = (extent.y.0.min(position.y), extent.y.1.max(position.y));
            extent.centre.x += position.x * share;
            extent.centre.y += position.y * share;
            shares += share;
        }
        if shares > 0.0 {
            extent.centre = PixelPoint::new(extent.centre.x / shares, extent.centre.y / shares);
        }
        extent
    }
}

/// The range of pixels of an axis of `count` whose centres lie within `reach_px` of the interval `span`.
fn pixels_within(span: (f64, f64), reach_px: f64, count: usize) -> (usize, usize) {
    let last = count as f64;
    // A cast of a float saturates, and NaN gives 0: an empty range.
    (
        (span.0 - reach_px).ceil().clamp(0.0, last) as usize,
        (span.1 + reach_px + 1.0).floor().clamp(0.0, last) as usize,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const DETECTOR: (usize, usize) = (200, 200);

    fn stamp_of(config: &PsfConfig, centre: PixelPoint, electrons: f64, floor_e: f64) -> Stamp {
        let mut stamp = Stamp::new();
        Psf::new(config).unwrap().stamp(centre, electrons, floor_e, DETECTOR, &mut stamp);
        stamp
    }

    fn gaussian(sigma_px: f64) -> PsfConfig {
        PsfConfig::Gaussian { sigma_px }
    }

    fn sum(stamp: &Stamp) -> f64 {
        stamp.rows().flat_map(|(_, _, row)| row).sum()
    }

    #[test]
    fn the_peak_pixel_holds_the_closed_form_fraction() {
        // erf(0.5 / (0.8 √2))² = 0.46803²: from a table of the error function.
        let stamp = stamp_of(&gaussian(0.8), PixelPoint::new(100.0, 100.0), 1.0, 1e-12);
        let peak = stamp.truth(0.0, 1.0).peak_electrons;
        assert!((peak - 0.468_028_6 * 0.468_028_6).abs() < 1e-6, "{peak}");
        assert!((Psf::new(&gaussian(0.8)).unwrap().peak_share() - peak).abs() < 1e-15);
    }

    #[test]
    fn all_the_energy_is_inside_but_for_the_floor() {
        for (config, width) in [
            (gaussian(0.8), 0.8),
            (PsfConfig::GaussianHalo { sigma_px: 0.7, halo_sigma_px: 5.0, halo_fraction: 0.1 }, 5.0),
        ] {
            for floor_e in [0.01, 1e-4] {
                let lost = 1e5 - sum(&stamp_of(&config, PixelPoint::new(90.3, 101.8), 1e5, floor_e));
                let bound = 2.0 * std::f64::consts::PI * width * width * floor_e;
                // Twice: the bound is of a density, pixels straddle the ring.
                assert!(lost > 0.0 && lost < 2.0 * bound, "{lost} e⁻ lost, bound {bound}");
            }
        }
    }

    /// The centroid of pixel-integrated samples is not the centre: by Poisson's summation formula it is
    /// c + Σ (−1)^m/(πm) exp(−2π²σ²m²) sin(2πmc), the S-curve. At σ = 0.8 px its amplitude is 1.0e-6 px.
    #[test]
    fn the_centroid_follows_the_s_curve_at_every_phase() {
        use std::f64::consts::PI;
        for sigma_px in [0.3, 0.5, 0.8, 1.5] {
            for phase in 0..100 {
                let c = f64::from(phase) / 100.0 - 0.5;
                let stamp = stamp_of(&gaussian(sigma_px), PixelPoint::new(100.0 + c, 100.0 - c), 1.0, 1e-15);
                let moment: f64 = stamp
                    .rows()
                    .flat_map(|(x, _, row)| {
                        row.iter().enumerate().map(move |(i, s)| s * ((x + i) as f64 - 100.0))
                    })
                    .sum();
                let s_curve: f64 = (1..20)
                    .map(|m| {
                        let m = f64::from(m);
                        let sign = if m % 2.0 == 0.0 { 1.0 } else { -1.0 };
                        let damping = libm::exp(-2.0 * PI * PI * sigma_px * sigma_px * m * m);
                        sign / (PI * m) * damping * libm::sin(2.0 * PI * m * c)
                    })
                    .sum();
                let error = moment / sum(&stamp) - c - s_curve;
                // Left out below the floor: some hundred pixels of 1e-15 at some ten px.
                assert!(error.abs() < 1e-11, "σ {sigma_px}, phase {c}: {error}");
                if sigma_px >= 0.8 {
                    assert!((moment / sum(&stamp) - c).abs() < 1.1e-6);
                }
            }
        }
    }

    #[test]
    fn no_pixel_above_the_floor_is_left_out() {
        for config in [
            gaussian(0.8),
            PsfConfig::GaussianHalo { sigma_px: 0.8, halo_sigma_px: 4.0, halo_fraction: 0.05 },
        ] {
            let centre = PixelPoint::new(100.37, 99.81);
            let rough = stamp_of(&config, centre, 3e4, 0.01);
            let fine = stamp_of(&config, centre, 3e4, 1e-9);
            let window = rough.window().unwrap();
            for (x, y, row) in fine.rows() {
                for (i, &value) in row.iter().enumerate() {
                    let got = if window.contains(x + i, y) {
                        rough.electrons[(y - window.y) * window.columns + x + i - window.x]
                    } else {
                        0.0
                    };
                    // Two components left out in the same pixel may together reach twice the floor.
                    assert!((got - value).abs() < 0.02, "at ({}, {y}): {got}, expected {value}", x + i);
                }
            }
        }
    }

    #[test]
    fn an_image_at_the_border_is_clipped() {
        let whole = stamp_of(&gaussian(1.0), PixelPoint::new(100.0, 100.0), 1000.0, 1e-6);
        let half = stamp_of(&gaussian(1.0), PixelPoint::new(-0.5, 100.0), 1000.0, 1e-6);
        assert!((sum(&half) / sum(&whole) - 0.5).abs() < 1e-6);
        for (x, y) in [(-50.0, 100.0), (1e300, 0.0), (f64::NAN, 5.0), (100.0, f64::NEG_INFINITY)] {
            assert_eq!(stamp_of(&gaussian(1.0), PixelPoint::new(x, y), 1000.0, 0.01).window(), None);
        }
    }

    #[test]
    fn what_is_fainter_than_the_floor_leaves_no_stamp_worth_drawing() {
        let stamp = stamp_of(&gaussian(0.8), PixelPoint::new(100.0, 100.0), 0.01, 0.01);
        assert_eq!(sum(&stamp), 0.0);
    }

    #[test]
    fn a_halo_narrower_than_its_core_is_refused() {
        let config = PsfConfig::GaussianHalo { sigma_px: 2.0, halo_sigma_px: 1.0, halo_fraction: 0.1 };
        assert!(config.check().unwrap_err().to_string().contains("psf.halo_sigma_px"));
    }
}
