//! Detection probability of an image: the probability that at least one of its pixels is above the threshold.
//!
//! Pixels are independent, hence P = 1 − Π P(DN_i ≤ T | μ_i), the product over the pixels of the image, with
//! μ_i = B + E f_i for the background B, the electrons E and the fraction f_i of the point-spread function in
//! the pixel, smeared by the motion. The position of an image within a pixel is random: P is the mean over a
//! grid of positions. The probability that the same pixels have without the image is subtracted: a threshold
//! within the noise, or a background above it, detects nothing. Nor is an image detected separately where so
//! many empty pixels are above I1 that clusters merge over the whole frame.

use contract::PixelPoint;
use sim::optics::{ImagePoint, Stamp};

use super::pixel::{PixelThreshold, readout_e};
use crate::camera::{CameraModel, moving_point};
use crate::requirement::DetectionRule;

/// Number of positions within a pixel along each axis.
const POSITIONS_PER_AXIS: usize = 4;
/// Smallest fraction of the brightest pixel's signal at which a pixel is included: when the brightest pixel
/// is at the threshold, fainter pixels add nothing to the probability of the background.
const MIN_FRACTION_OF_PEAK: f64 = 4e-3;
/// Smallest fraction of the total signal for which a pixel is evaluated.
const MIN_FRACTION_OF_TOTAL: f64 = 1e-6;
/// Fraction of empty pixels above I1 at which they form an unbounded cluster: the threshold of site
/// percolation on a square lattice with eight neighbours (Malarz & Galam 2005, Phys. Rev. E 71, 016125).
const PERCOLATION: f64 = 0.407;
/// Number of table nodes of a curve for each factor of e in electrons.
const NODES_PER_E: f64 = 24.0;

/// Thresholds of a frame, DN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameThresholds {
    /// I1, DN.
    pub low_dn: f64,
    /// I2, DN.
    pub high_dn: f64,
}

impl DetectionRule {
    /// Returns the thresholds of a frame of a camera whose pixels expect `background_e` electrons, dark
    /// current included. Thresholds in standard deviations are the far-range method's automatic ones: b + k
    /// σ_DN, σ_DN² = (B + σ²)/g² + 1/12, rounded down to integers.
    pub fn thresholds(&self, camera: &CameraModel, background_e: f64) -> FrameThresholds {
        match *self {
            Self::Dn { low_dn, high_dn } => {
                FrameThresholds { low_dn: f64::from(low_dn), high_dn: f64::from(high_dn) }
            }
            Self::Sigmas { low, high } => {
                let sensor = &camera.config.sensor;
                let (gain_e, read_e) = (sensor.gain_e_per_dn, readout_e(sensor));
                let shot_e2 = sensor.noise.shot.apply(background_e);
                let sigma_dn = ((shot_e2 + read_e * read_e) / (gain_e * gain_e) + 1.0 / 12.0).sqrt();
                let base_dn = sensor.bias_dn + background_e / gain_e;
                let at = |sigmas: f64| (base_dn + sigmas * sigma_dn).floor();
                FrameThresholds { low_dn: at(low), high_dn: at(high) }
            }
        }
    }
}

/// Returns true if the empty pixels of a frame, which expect `background_e` electrons, merge above I1.
pub fn is_flooded(camera: &CameraModel, rule: &DetectionRule, background_e: f64) -> bool {
    camera.threshold(rule.thresholds(camera, background_e).low_dn).above(background_e) >= PERCOLATION
}

/// Fractions of an image's signal in its pixels, at several positions within a pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageShares {
    positions: Vec<Vec<f64>>,
}

impl ImageShares {
    /// Computes the fractions of a star that moves by `trail_px` along x. If the point-spread function grows
    /// over the field, a third of the positions each have the width of one third of the field's area.
    pub fn from_star(camera: &CameraModel, trail_px: f64) -> Self {
        let (columns, rows) = camera.projection.detector();
        let growth = camera.config.optics.psf_growth;
        // Fractions of the distance to the corner: the midpoints of three rings of equal area.
        let radii: &[f64] = if growth == 0.0 { &[0.0] } else { &[0.408, 0.707, 0.913] };
        let middle = PixelPoint::new((columns as f64 - 1.0) / 2.0, (rows as f64 - 1.0) / 2.0);
        let mut positions = Vec::new();
        for radius in radii {
            let ring = PixelPoint::new(middle.x * (1.0 + 0.9 * radius), middle.y * (1.0 + 0.9 * radius));
            let points = moving_point(PixelPoint::new(ring.x.floor(), ring.y.floor()), trail_px);
            positions.extend(Self::from_points(camera, &points).positions);
        }
        Self { positions }
    }

    /// Computes the fractions of an image composed of `points`, shifted over the positions within a pixel.
    pub fn from_points(camera: &CameraModel, points: &[ImagePoint]) -> Self {
        let mut psf = camera.psf.clone();
        let mut stamp = Stamp::new();
        let mut moved = points.to_vec();
        let detector = camera.projection.detector();
        let mut positions = Vec::new();
        for place in 0..POSITIONS_PER_AXIS * POSITIONS_PER_AXIS {
            let offset = |i: usize| (i as f64 + 0.5) / POSITIONS_PER_AXIS as f64 - 0.5;
            let (dx, dy) = (offset(place % POSITIONS_PER_AXIS), offset(place / POSITIONS_PER_AXIS));
            for (moved, point) in moved.iter_mut().zip(points) {
                moved.position = PixelPoint::new(point.position.x + dx, point.position.y + dy);
            }
            psf.stamp_extended(&moved, 1.0, MIN_FRACTION_OF_TOTAL, detector, &mut stamp);
            let shares = || stamp.rows().flat_map(|(_, _, row)| row.iter().copied());
            let least = MIN_FRACTION_OF_PEAK * shares().fold(0.0, f64::max);
            positions.push(shares().filter(|share| *share > least).collect());
        }
        Self { positions }
    }

    /// Returns the probability that an image of `electrons` over a background of `background_e` per pixel is
    /// detected.
    pub fn chance(&self, threshold: &PixelThreshold, electrons: f64, background_e: f64) -> f64 {
        let dark = threshold.ln_below(background_e);
        let gained: f64 = self
            .positions
            .iter()
            .map(|shares| {
                let lit: f64 =
                    shares.iter().map(|share| threshold.ln_below(background_e + electrons * share)).sum();
                libm::exp(shares.len() as f64 * dark) - libm::exp(lit)
            })
            .sum();
        (gained / self.positions.len().max(1) as f64).max(0.0)
    }
}

/// Detection probability of a star as a function of its electrons, at one exposure and background.
#[derive(Debug, Clone, PartialEq)]
pub struct DetectionCurve {
    /// Probabilities at equal steps of the logarithm of electrons, from one electron on.
    chances: Vec<f64>,
}

impl DetectionCurve {
    /// Computes the curve of a camera with an exposure, over a background of `background_e_per_s` in addition
    /// to the flat sky and the dark current.
    pub fn new(
        camera: &CameraModel,
        rule: &DetectionRule,
        trail_px: f64,
        exposure_s: f64,
        background_e_per_s: f64,
    ) -> Self {
        let background_e = background_e(camera, exposure_s, background_e_per_s);
        if is_flooded(camera, rule, background_e) {
            return Self { chances: vec![0.0] };
        }
        let threshold = camera.threshold(rule.thresholds(camera, background_e).high_dn);
        Self::from_shares(&ImageShares::from_star(camera, trail_px), &threshold, background_e)
    }

    fn from_shares(shares: &ImageShares, threshold: &PixelThreshold, background_e: f64) -> Self {
        // From a star of one electron on; the table ends where brighter stars have no higher probability.
        let surest = shares.chance(threshold, f64::MAX.sqrt(), background_e);
        let mut chances = Vec::new();
        loop {
            let electrons = libm::exp(chances.len() as f64 / NODES_PER_E);
            let chance = shares.chance(threshold, electrons, background_e);
            chances.push(chance);
            if chance >= surest - 1e-12 || electrons > 1e9 {
                return Self { chances };
            }
        }
    }

    /// Returns the probability that a star of exp(`ln_electrons`) electrons is detected.
    #[inline]
    pub fn probability_at_ln(&self, ln_electrons: f64) -> f64 {
        let at = ln_electrons * NODES_PER_E;
        if at.is_nan() || at <= 0.0 {
            return self.chances.first().copied().unwrap_or(0.0);
        }
        let node = at as usize;
        match self.chances.get(node..) {
            Some([low, high, ..]) => low + (at - node as f64) * (high - low),
            _ => self.chances.last().copied().unwrap_or(0.0),
        }
    }

    /// Returns the probability that a star of `electrons` is detected.
    pub fn probability(&self, electrons: f64) -> f64 {
        self.probability_at_ln(libm::log(electrons.max(1e-30)))
    }

    /// Returns the smallest number of electrons at which a star is detected with `probability`; `None` when
    /// no star is.
    pub fn electrons_for(&self, probability: f64) -> Option<f64> {
        let node = self.chances.iter().position(|chance| *chance >= probability)?;
        let Some(before) = node.checked_sub(1) else { return Some(1.0) };
        let (low, high) = (self.chances[before], self.chances[node]);
        Some(libm::exp((before as f64 + (probability - low) / (high - low)) / NODES_PER_E))
    }
}

/// Returns the electrons of the background in a pixel: the given background flux, the flat sky of the
/// detector's description, dark current.
pub fn background_e(camera: &CameraModel, exposure_s: f64, background_e_per_s: f64) -> f64 {
    (background_e_per_s + camera.config.sensor.background_e_per_s + camera.dark_e_per_s) * exposure_s
}
