//! Lens out of focus: a uniform disk convolved with a Gaussian.
//!
//! In geometrical optics a point becomes a disk (Born & Wolf 1999, Sec. 8.8 states the range of validity:
//! several waves out of focus); the remaining diffraction and aberrations soften its edge. Along a line
//! through the centre, I(r) = 1/(πR²) ∫ n((r − R sin φ)/σ)/σ · erf(R cos φ/(σ√2)) R cos φ dφ over ±π/2, n the
//! normal density. Chords across the line are integrated in closed form, and along the line by the
//! trapezoidal rule, whose integrand is flat to first order at both ends.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use super::cumulative_flux::CumulativeFlux;

/// Extent of the table beyond the edge, in standard deviations of the Gaussian.
const REACH_SIGMAS: f64 = 7.0;
/// Number of table nodes per standard deviation.
const NODES: f64 = 4.0;

/// Creates the shape for a disk of `radius_px` and a Gaussian of `sigma_px`.
pub(super) fn defocus(radius_px: f64, sigma_px: f64) -> CumulativeFlux {
    // A sixth of a standard deviation along the line, and at least 32 points for small disks.
    let points = (6.0 * PI * radius_px / sigma_px).ceil().max(32.0) as usize;
    let step = PI / points as f64;
    let nodes: Vec<(f64, f64)> = (1..points)
        .map(|i| {
            let (sin, cos) = libm::sincos(i as f64 * step - 0.5 * PI);
            let half_chord = radius_px * cos;
            let weight = libm::erf(half_chord / sigma_px * FRAC_1_SQRT_2) * half_chord * step;
            (radius_px * sin, weight)
        })
        .collect();
    let norm = 1.0 / ((2.0 * PI).sqrt() * sigma_px * PI * radius_px * radius_px);
    let density = |radius: f64| {
        let sum: f64 = nodes
            .iter()
            .map(|(at, weight)| {
                let deviation = (radius - at) / sigma_px;
                weight * libm::exp(-0.5 * deviation * deviation)
            })
            .sum();
        norm * sum
    };
    CumulativeFlux::radial(density, sigma_px / NODES, radius_px + REACH_SIGMAS * sigma_px, [1.0, 1.0])
}
