//! Point-spread function, integrated over pixels.

mod airy;
mod condense;
mod config;
mod cumulative_flux;
mod defocus;
mod error_function;
mod gaussians;
mod moffat;
mod pixels_within;
mod sampled;
mod share_table;
#[cfg(test)]
mod witness;

use std::path::Path;

use contract::{Camera, PixelPoint};
use pulp::Simd;

pub use config::PsfConfig;

use cumulative_flux::{CumulativeFlux, Edges};
use gaussians::{Gaussians, Profiles};
use pixels_within::pixels_within;
use truth::SimError;

use super::field::FieldRadius;
use super::{ImagePoint, Stamp};
use crate::simd_kernel::{F64x8, LANES, SimdKernel, run_widest};

/// Point-spread function, prepared for drawing: distributes the flux of a point over pixels, each of which
/// integrates the incident light. The flux over the whole plane is 1.
///
/// ```
/// use boresight_optics::{Psf, PsfConfig, Stamp};
/// use contract::PixelPoint;
/// let mut psf = Psf::new(&PsfConfig::Moffat { fwhm_px: 1.8, beta: 3.0 })?;
/// let mut stamp = Stamp::new();
/// psf.stamp(PixelPoint::new(50.2, 49.7), 1e5, Psf::FLOOR_E, (100, 100), &mut stamp);
/// let drawn: f64 = stamp.rows().flat_map(|(_, _, row)| row).sum();
/// assert!(drawn > 0.999e5 && drawn < 1e5);
/// # Ok::<(), truth::SimError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Psf {
    shape: Shape,
    growth: Option<Growth>,
    profiles: Profiles,
    edges: Edges,
}

#[derive(Debug, Clone, PartialEq)]
enum Shape {
    Gaussians(Gaussians),
    CumulativeFlux(CumulativeFlux),
}

/// Growth of the width over the field: by the factor 1 + aρ².
#[derive(Debug, Clone, Copy, PartialEq)]
struct Growth {
    a: f64,
    radius: FieldRadius,
}

impl Psf {
    /// Electrons below which a pixel of a stamp is omitted, unless a caller requests a lower floor: a
    /// thousandth of the noise of any detector that tracks stars.
    pub const FLOOR_E: f64 = 0.01;

    /// Creates the point-spread function of a configuration; a relative path in it starts at the current
    /// directory.
    ///
    /// # Errors
    /// Those of [`Psf::load`].
    pub fn new(config: &PsfConfig) -> Result<Self, SimError> {
        Self::load(config, Path::new(""))
    }

    /// Creates the point-spread function of a configuration; a relative path in it starts at `folder`.
    ///
    /// # Errors
    /// Those of [`PsfConfig::check`]; [`SimError::PsfFile`] if the file of [`PsfConfig::Sampled`] cannot be
    /// used.
    pub fn load(config: &PsfConfig, folder: &Path) -> Result<Self, SimError> {
        config.check()?;
        let shape = match config {
            &PsfConfig::Gaussian { sigma_px } => Shape::Gaussians(Gaussians::single(sigma_px)),
            &PsfConfig::GaussianHalo { sigma_px, halo_sigma_px, halo_fraction } => {
                Shape::Gaussians(Gaussians::halo(sigma_px, halo_sigma_px, halo_fraction))
            }
            &PsfConfig::Moffat { fwhm_px, beta } => Shape::Gaussians(moffat::moffat(fwhm_px, beta)),
            &PsfConfig::Airy { lambda_n_px, obscuration } => {
                Shape::CumulativeFlux(airy::airy(lambda_n_px, obscuration))
            }
            &PsfConfig::Defocus { radius_px, sigma_px } => {
                Shape::CumulativeFlux(defocus::defocus(radius_px, sigma_px))
            }
            PsfConfig::Sampled { path, oversampling } => {
                Shape::CumulativeFlux(sampled::sampled(&folder.join(path), *oversampling)?)
            }
        };
        Ok(Self { shape, growth: None, profiles: Profiles::default(), edges: Edges::default() })
    }

    /// Returns this function with a width 1 + `growth` ρ² times as large at a distance ρ from the principal
    /// point of `camera`, in units of the distance of its farthest corner
    /// ([`super::OpticsConfig::psf_growth`]). An image has the width of its centre throughout.
    pub fn with_growth(mut self, growth: f64, camera: &Camera) -> Self {
        self.growth = (growth != 0.0).then(|| Growth { a: growth, radius: FieldRadius::new(camera) });
        self
    }

    /// Draws the image of a point of `electrons` at `centre`: [`Psf::stamp_extended`] with a single point.
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

    /// Draws the image of an object of `electrons` whose geometric image consists of `points` (a trail, a
    /// resolved body), on a detector of `detector` = (columns, rows). The centre of the stamp is the mean of
    /// the points, weighted by their shares.
    ///
    /// Pixels with fewer than `floor_e` electrons (greater than 0) and pixels beyond the reach of the shape
    /// are left at zero: a Gaussian of width σ thereby loses at most about 2πσ² `floor_e` electrons, a shape
    /// with wings more. The truth is derived from the stamp, so truth and image agree.
    pub fn stamp_extended(
        &mut self,
        points: &[ImagePoint],
        electrons: f64,
        floor_e: f64,
        detector: (usize, usize),
        stamp: &mut Stamp,
    ) {
        let extent = Extent::of(points);
        let scale = self.growth.map_or(1.0, |growth| growth.scale(extent.centre));
        let reach_px = self.shape.reach_px(electrons, floor_e, scale);
        let x = pixels_within(extent.x, reach_px, detector.0);
        let y = pixels_within(extent.y, reach_px, detector.1);
        stamp.reset(extent.centre, x, y);
        if stamp.electrons.is_empty() || reach_px == 0.0 {
            return;
        }
        match &self.shape {
            Shape::Gaussians(shape) => {
                shape.draw(points, electrons, floor_e, scale, &mut self.profiles, stamp);
            }
            Shape::CumulativeFlux(shape) => {
                shape.draw(points, electrons, reach_px, scale, &mut self.edges, stamp);
            }
        }
        run_widest(FloorClip { pixels: &mut stamp.electrons, below: floor_e });
    }

    /// Largest distance from the detector at which an object of `electrons` still leaves `floor_e` electrons
    /// in a pixel of it, px; 0 if the object reaches the floor in no pixel. The wings of a Moffat profile are
    /// cut at 200 px, the rings of an Airy pattern at some tens of pixels.
    pub fn reach_px(&self, electrons: f64, floor_e: f64) -> f64 {
        match self.growth {
            None => self.shape.reach_px(electrons, floor_e, 1.0),
            // Off the detector the width is that of the corner, or has not yet reached it beyond the shorter
            // sides.
            Some(growth) => {
                let steps =
                    (0..=Growth::STEPS).map(|i| 1.0 + growth.a * f64::from(i) / f64::from(Growth::STEPS));
                steps.map(|scale| self.shape.reach_px(electrons, floor_e, scale)).fold(0.0, f64::max)
            }
        }
    }

    /// Maximum fraction of the flux in the pixel under the centre of the image: at the principal point, when
    /// the image is centred on the pixel. The shutter control uses it for the brightest pixel.
    pub fn peak_share(&self) -> f64 {
        match &self.shape {
            Shape::Gaussians(shape) => shape.peak_share(),
            Shape::CumulativeFlux(shape) => shape.peak_share(),
        }
    }
}

impl Shape {
    /// Distance from a point beyond which, along a column or a row, no pixel holds `floor_e`, px; 0 if no
    /// pixel does.
    fn reach_px(&self, electrons: f64, floor_e: f64, scale: f64) -> f64 {
        match self {
            Self::Gaussians(shape) => shape.reach_px(electrons, floor_e, scale),
            Self::CumulativeFlux(shape) => shape.reach_px(electrons, floor_e, scale),
        }
    }
}

impl Growth {
    /// Number of widths tried for the largest reach, between those of the principal point and of the corner.
    const STEPS: u32 = 8;

    fn scale(&self, at: PixelPoint) -> f64 {
        1.0 + self.a * self.radius.normalised_radius_squared(at)
    }
}

/// Rectangle that the points of an image span, and their mean.
struct Extent {
    x: (f64, f64),
    y: (f64, f64),
    centre: PixelPoint,
}

impl Extent {
    fn of(from_points: &[ImagePoint]) -> Self {
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        let mut extent = Self { x: nothing, y: nothing, centre: PixelPoint::default() };
        let mut shares = 0.0;
        for ImagePoint { position, share } in from_points {
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

/// Sets the pixels of a stamp that are below a floor to 0.
struct FloorClip<'a> {
    pixels: &'a mut [f64],
    below: f64,
}

impl SimdKernel for FloorClip<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let below = F64x8::splat(simd, self.below);
        for pixels in self.pixels.as_chunks_mut::<LANES>().0 {
            F64x8::from_array(simd, pixels).zero_below(below).store(pixels);
        }
    }
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
        let peak = stamp.truth(0.0, 1.0, f64::INFINITY).peak_electrons;
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
                // Twice the bound, because it holds for a density and pixels straddle the ring.
                assert!(lost > 0.0 && lost < 2.0 * bound, "{lost} e⁻ lost, bound {bound}");
            }
        }
    }

    /// The centroid of pixel-integrated samples differs from the centre: by Poisson's summation formula it is
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
                // Omitted below the floor: some hundred pixels of 1e-15 at some ten px.
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
                        rough.electrons[(y - window.y) * rough.stride + x + i - window.x]
                    } else {
                        0.0
                    };
                    // Two components omitted in one pixel may together reach twice the floor.
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
    fn objects_below_the_floor_have_no_stamp() {
        let stamp = stamp_of(&gaussian(0.8), PixelPoint::new(100.0, 100.0), 0.01, 0.01);
        assert_eq!(sum(&stamp), 0.0);
    }

    #[test]
    fn a_halo_narrower_than_its_core_is_refused() {
        let config = PsfConfig::GaussianHalo { sigma_px: 2.0, halo_sigma_px: 1.0, halo_fraction: 0.1 };
        assert!(config.check().unwrap_err().to_string().contains("psf.halo_sigma_px"));
    }
}
